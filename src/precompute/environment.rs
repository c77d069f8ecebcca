//! Light from everywhere as real spherical harmonics up to order 2; twin of `glsl/shading/environment.glsl`.

use crate::io::picture::LinearImage;
use glam::{DVec2, DVec3, DVec4};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Linear RGB coefficients of 1, x, y, z, xy, yz, zx, 3 y^2 - 1 and x^2 - z^2 (Y is up), the norms of the
/// spherical harmonics included: their sum is the radiance in the unit direction (x, y, z).
pub type Environment = [DVec3; 9];

/// Squared norms of the spherical harmonics that go with an [`Environment`]'s coefficients.
const SQUARED_NORMS: [f64; 9] = [
    1.0 / (4.0 * PI),
    3.0 / (4.0 * PI),
    3.0 / (4.0 * PI),
    3.0 / (4.0 * PI),
    15.0 / (4.0 * PI),
    15.0 / (4.0 * PI),
    15.0 / (4.0 * PI),
    5.0 / (16.0 * PI),
    15.0 / (16.0 * PI),
];

/// Integrals over a column's azimuths of 1, sin, cos, sin cos and cos 2 of the angle from -Z toward +X.
fn column_integrals(low: f64, high: f64) -> [f64; 5] {
    let ((s0, c0), (s1, c1)) = (low.sin_cos(), high.sin_cos());
    [high - low, c0 - c1, s1 - s0, 0.5 * (s1 * s1 - s0 * s0), s1 * c1 - s0 * c0]
}

/// Integrals over a row's angles from +Y, the sine of the solid angle included, of each harmonic's part.
fn row_integrals(low: f64, high: f64) -> [f64; 9] {
    // With s and c the sine and cosine, the integrals of s, s c, s^2, s^2 c, s^3 and s (3 c^2 - 1).
    let indefinite = |angle: f64| {
        let (s, c) = angle.sin_cos();
        let (cc, sss) = (c * c, s * s * s);
        [-c, 0.5 * s * s, 0.5 * (angle - s * c), sss / 3.0, c * cc / 3.0 - c, c - c * cc]
    };
    let (at_low, at_high) = (indefinite(low), indefinite(high));
    let [s, sc, ss, ssc, sss, pole] = std::array::from_fn(|i| at_high[i] - at_low[i]);
    // x = s sin, y = c, z = -s cos of the azimuth; cos 2 = cos^2 - sin^2 turns the last one's sign.
    [s, ss, sc, -ss, ssc, -ssc, -sss, pole, -sss]
}

/// Which of [`column_integrals`] goes with each harmonic.
const COLUMN_OF: [usize; 9] = [0, 1, 0, 2, 1, 2, 3, 0, 4];

/// Projects a latitude-longitude picture (row 0 up, its middle toward -Z, columns toward +X), turned by
/// `yaw_deg` about the vertical as a camera is, with its radiance times `scale`. Every pixel is taken as one value
/// over its own solid angle, and integrated exactly: a picture of one value has that value in every direction.
pub fn project_environment(image: &LinearImage, scale: f64, yaw_deg: f64) -> Environment {
    let (width, height) = (image.width as usize, image.height as usize);
    // A turn to the left moves what was ahead to smaller azimuths.
    let azimuth = |column: usize| TAU * (column as f64 / width as f64 - 0.5) - yaw_deg.to_radians();
    let columns: Vec<[f64; 5]> =
        (0..width).map(|column| column_integrals(azimuth(column), azimuth(column + 1))).collect();
    let row_sums = |pixels: &[[f32; 4]]| {
        let mut sums = [DVec3::ZERO; 5];
        for (&[r, g, b, _], integrals) in pixels.iter().zip(&columns) {
            let radiance = DVec3::new(r.into(), g.into(), b.into());
            sums.iter_mut().zip(integrals).for_each(|(sum, integral)| *sum += *integral * radiance);
        }
        sums
    };
    let rows: Vec<_> = image.pixels.par_chunks(width).map(row_sums).collect();
    let mut environment = [DVec3::ZERO; 9];
    for (row, sums) in rows.iter().enumerate() {
        let angle = |row: usize| PI * row as f64 / height as f64;
        let integrals = row_integrals(angle(row), angle(row + 1));
        for k in 0..9 {
            environment[k] += scale * SQUARED_NORMS[k] * integrals[k] * sums[COLUMN_OF[k]];
        }
    }
    environment
}

/// Mean over directions whose mean is `first`, with mean products `squares` (xx, yy, zz, of sum 1) and `products`
/// (xy, yz, zx); bands 1 and 2 are multiplied by `bands`. Never below 0, which order 2 can ring to.
pub fn environment_mean(
    environment: &Environment,
    first: DVec3,
    squares: DVec3,
    products: DVec3,
    bands: DVec2,
) -> DVec3 {
    let [zero, x, y, z, xy, yz, zx, pole, sides] = *environment;
    let one = x * first.x + y * first.y + z * first.z;
    let two = xy * products.x
        + yz * products.y
        + zx * products.z
        + pole * (2.0 * squares.y - squares.x - squares.z)
        + sides * (squares.x - squares.z);
    (zero + bands.x * one + bands.y * two).max(DVec3::ZERO)
}

/// Products xy, yz and zx of two vectors, each one's first component with the other's second.
fn mixed(a: DVec3, b: DVec3) -> DVec3 {
    a * DVec3::new(b.y, b.z, b.x)
}

/// Mean of irradiance / pi over normals in a fiber's cross-section, given as in [`crate::bsdf::simple`] by the
/// means of sin phi, cos phi, sin 2 phi and cos 2 phi. Irradiance is a quadratic form of the normal (Ramamoorthi
/// & Hanrahan 2001, Eq. 11 to 13), hence linear in these means: one normal or a core's many, nothing more is lost.
pub fn environment_diffuse(environment: &Environment, normals: DVec4, side: DVec3, toward: DVec3) -> DVec3 {
    let first = normals.x * side + normals.y * toward;
    let (sine_squared, cosine_squared) = (0.5 - 0.5 * normals.w, 0.5 + 0.5 * normals.w);
    let squares = sine_squared * side * side + cosine_squared * toward * toward + normals.z * side * toward;
    let products = sine_squared * mixed(side, side)
        + cosine_squared * mixed(toward, toward)
        + 0.5 * normals.z * (mixed(side, toward) + mixed(toward, side));
    environment_mean(environment, first, squares, products, DVec2::new(2.0 / 3.0, 0.25))
}

/// Radiance in a unit direction, blurred by a Gaussian of `variance` (radians squared, along each axis): what a
/// forward lobe gathers. The blur is the heat kernel's, exp(-l (l + 1) variance / 2) in band l.
pub fn environment_toward(environment: &Environment, direction: DVec3, variance: f64) -> DVec3 {
    let bands = DVec2::new((-variance).exp(), (-3.0 * variance).exp());
    environment_mean(environment, direction, direction * direction, mixed(direction, direction), bands)
}

/// Mean radiance over the circle of directions whose angle to the cross-section of a fiber with unit `tangent` has
/// sine `sin_theta`, blurred likewise: what a lobe gathers that is the same all around the fiber. Averaging over
/// the circle multiplies band l by P_l(sin theta) (Funk-Hecke).
pub fn environment_cone(environment: &Environment, tangent: DVec3, sin_theta: f64, variance: f64) -> DVec3 {
    let legendre = DVec2::new(sin_theta, 1.5 * sin_theta * sin_theta - 0.5);
    let bands = legendre * DVec2::new((-variance).exp(), (-3.0 * variance).exp());
    environment_mean(environment, tangent, tangent * tangent, mixed(tangent, tangent), bands)
}

#[cfg(test)]
#[path = "environment_tests.rs"]
mod tests;
