//! The projection and its three lookups against direct quadrature.

use super::*;
use crate::bsdf::simple::filtered_cosine;
use crate::math::quadrature::gauss_legendre;
use crate::math::strip::strip_normals;

/// A picture of a function of the direction.
fn picture(height: u32, radiance: impl Fn(DVec3) -> DVec3) -> LinearImage {
    let mut image = LinearImage::filled(2 * height, height, [0.0, 0.0, 0.0, 1.0]);
    for (index, pixel) in (0_u32..).zip(&mut image.pixels) {
        let (row, column) = (f64::from(index / (2 * height)) + 0.5, f64::from(index % (2 * height)) + 0.5);
        let (s, c) = (PI * row / f64::from(height)).sin_cos();
        let (sin, cos) = (TAU * (column / f64::from(2 * height) - 0.5)).sin_cos();
        let [r, g, b] = radiance(DVec3::new(s * sin, c, -s * cos)).to_array().map(|c| c as f32);
        *pixel = [r, g, b, 1.0];
    }
    image
}

/// Directions all over the sphere, alike in solid angle.
fn directions(count: u32) -> impl Iterator<Item = DVec3> {
    let golden = PI * (3.0 - 5_f64.sqrt());
    (0..count).map(move |i| {
        let y = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let (sin, cos) = (golden * f64::from(i)).sin_cos();
        (1.0 - y * y).sqrt() * DVec3::X * cos + y * DVec3::Y + (1.0 - y * y).sqrt() * DVec3::Z * sin
    })
}

/// A bright warm window, a blue sky and a dark ground, soft.
fn room(d: DVec3) -> DVec3 {
    let window = 3.0 * (4.0 * (d.dot(DVec3::new(0.8, 0.0, -0.6)) - 1.0)).exp();
    DVec3::new(0.3, 0.4, 0.6) * (1.0 + d.y) + window * DVec3::new(1.0, 0.8, 0.5)
}

fn frames() -> impl Iterator<Item = (DVec3, DVec3)> {
    directions(40).map(|tangent| {
        let side = tangent.any_orthonormal_vector();
        (side, tangent.cross(side))
    })
}

#[test]
fn a_picture_of_one_value_is_that_value_everywhere() {
    let value = DVec3::new(0.25, 1.5, 7.0);
    for (height, yaw_deg) in [(1, 0.0), (2, 10.0), (37, -123.0)] {
        let constant = project_environment(&picture(height, |_| value), 2.0, yaw_deg);
        for (side, toward) in frames() {
            let tangent = side.cross(toward);
            for phi in [-1.5_f64, 0.0, 0.7] {
                let normals = strip_normals(phi.sin());
                let found = environment_diffuse(&constant, normals, side, toward);
                assert!((found - 2.0 * value).abs().max_element() < 1e-5, "{found}");
            }
            for (sin_theta, variance) in [(0.0, 0.0), (-0.9, 0.1), (1.0, 3.0)] {
                let cone = environment_cone(&constant, tangent, sin_theta, variance);
                let seen = environment_toward(&constant, tangent, variance);
                assert!((cone - 2.0 * value).abs().max_element() < 1e-5, "{cone}");
                assert!((seen - 2.0 * value).abs().max_element() < 1e-5, "{seen}");
            }
        }
    }
}

#[test]
fn order_2_is_kept_and_the_picture_lies_as_it_says() {
    // Every harmonic by itself, from a fine picture.
    let harmonics = |d: DVec3| {
        let (x, y, z) = (d.x, d.y, d.z);
        [1.0, x, y, z, x * y, y * z, z * x, 3.0 * y * y - 1.0, x * x - z * z]
    };
    for k in 0..9 {
        let found = project_environment(&picture(256, |d| DVec3::splat(harmonics(d)[k])), 1.0, 0.0);
        for (i, coefficient) in found.iter().enumerate() {
            let expected = if i == k { 1.0 } else { 0.0 };
            assert!((coefficient.x - expected).abs() < 1e-4, "{k}: coefficient {i} is {coefficient}");
        }
    }
    // The middle toward -Z, the right quarter toward +X, row 0 up; turned, as a camera is.
    let lit = |column: u32, row: u32, yaw_deg: f64| {
        let mut image = LinearImage::filled(64, 32, [0.0; 4]);
        image.pixels[(row * 64 + column) as usize] = [1.0; 4];
        let [_, x, y, z, ..] = project_environment(&image, 1.0, yaw_deg);
        DVec3::new(x.x, y.x, z.x).normalize()
    };
    let turned = |yaw_deg: f64| glam::DMat3::from_rotation_y(yaw_deg.to_radians());
    for (column, row, expected) in
        [(32, 16, -DVec3::Z), (48, 16, DVec3::X), (0, 16, DVec3::Z), (16, 16, -DVec3::X), (20, 0, DVec3::Y)]
    {
        for yaw_deg in [0.0, 90.0, -33.0] {
            let found = lit(column, row, yaw_deg);
            assert!(found.distance(turned(yaw_deg) * expected) < 0.08, "{column}, {row}, {yaw_deg}: {found}");
        }
    }
}

/// Largest difference of a lookup from what it stands for, as a share of the picture's mean radiance.
fn worst(pairs: impl Iterator<Item = (DVec3, DVec3)>, mean: f64) -> f64 {
    pairs.map(|(found, exact)| (found - exact).abs().max_element() / mean).fold(0.0, f64::max)
}

#[test]
fn lookups_of_a_soft_room_are_near_direct_quadrature() {
    let environment = project_environment(&picture(128, room), 1.0, 0.0);
    let around: Vec<DVec3> = directions(4000).collect();
    let mean = around.iter().map(|&d| room(d)).sum::<DVec3>().max_element() / around.len() as f64;
    // Of a single normal, and of a strip's means.
    let irradiance = |side: DVec3, toward: DVec3, azimuths: &[f64]| {
        let of_normal = |phi: &f64| {
            let normal = phi.sin() * side + phi.cos() * toward;
            let lit = around.iter().map(|&d| d.dot(normal).max(0.0) * room(d)).sum::<DVec3>();
            4.0 / around.len() as f64 * lit
        };
        azimuths.iter().map(of_normal).sum::<DVec3>() / azimuths.len() as f64
    };
    for azimuths in [&[0.3_f64][..], &[-1.4, -0.9, 0.1, 0.2, 0.9]] {
        let normals =
            azimuths.iter().map(|phi| strip_normals(phi.sin())).sum::<DVec4>() / azimuths.len() as f64;
        let diffuse = worst(
            frames().map(|(side, toward)| {
                let found = environment_diffuse(&environment, normals, side, toward);
                (found, irradiance(side, toward, azimuths))
            }),
            mean,
        );
        println!("diffuse, {} normals: within {diffuse:.4} of the mean radiance", azimuths.len());
        assert!(diffuse < 0.02, "{diffuse}");
    }
    let few = || frames().step_by(5);
    // Without blur a cone and a direction miss what is finer than order 2; blurred, next to nothing.
    for (deviation, limit) in [(0.0_f64, 0.5), (0.5, 0.1), (0.8, 0.02)] {
        let seen = |d: DVec3| blurred(room, d, deviation);
        let toward = worst(
            few().map(|(d, _)| (environment_toward(&environment, d, deviation * deviation), seen(d))),
            mean,
        );
        let cone = worst(
            few().flat_map(|(side, toward)| {
                let tangent = side.cross(toward);
                [-0.8, 0.0, 0.5].map(|sine: f64| {
                    let found = environment_cone(&environment, tangent, sine, deviation * deviation);
                    let at = |i: u32| {
                        let (s, c) = (TAU * f64::from(i) / 24.0).sin_cos();
                        sine * tangent + (1.0 - sine * sine).sqrt() * (s * side + c * toward)
                    };
                    (found, (0..24).map(|i| seen(at(i))).sum::<DVec3>() / 24.0)
                })
            }),
            mean,
        );
        println!("blurred by {deviation}: toward within {toward:.4}, cone within {cone:.4}");
        assert!(toward < limit && cone < limit, "{deviation}: {toward}, {cone}");
    }
}

/// The heat kernel's blur of a function about a direction: its Legendre series, integrated in the angle from
/// that direction.
fn blurred(radiance: impl Fn(DVec3) -> DVec3, direction: DVec3, deviation: f64) -> DVec3 {
    if deviation == 0.0 {
        return radiance(direction);
    }
    let side = direction.any_orthonormal_vector();
    let other = direction.cross(side);
    let ring = |cosine: f64| {
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let at = |i: u32| {
            let (s, c) = (TAU * f64::from(i) / 32.0).sin_cos();
            radiance(cosine * direction + sine * (c * side + s * other))
        };
        (0..32).map(at).sum::<DVec3>() / 32.0
    };
    let kernel = |cosine: f64| {
        let (mut before, mut legendre, mut sum) = (0.0, 1.0, 0.0);
        for l in 0..40 {
            let l = f64::from(l);
            sum += (l + 0.5) * legendre * (-0.5 * l * (l + 1.0) * deviation * deviation).exp();
            (before, legendre) = (legendre, ((2.0 * l + 1.0) * cosine * legendre - l * before) / (l + 1.0));
        }
        sum
    };
    let component = |pick: fn(DVec3) -> f64| {
        let piece = |i: u32| {
            let (low, high) = (-1.0 + 0.25 * f64::from(i), -0.75 + 0.25 * f64::from(i));
            gauss_legendre(low, high, |cosine| kernel(cosine) * pick(ring(cosine)))
        };
        (0..8).map(piece).sum::<f64>()
    };
    DVec3::new(component(|v| v.x), component(|v| v.y), component(|v| v.z))
}

#[test]
fn one_distant_lamp_is_lit_as_a_directional_light_to_order_2() {
    // A tiny lamp of irradiance 1: the clamped cosine, whose order-2 fit is off by at most 1/16 at the edge.
    let mut image = LinearImage::filled(128, 64, [0.0; 4]);
    let solid_angle = TAU / 128.0 * ((PI * 31.0 / 64.0).cos() - (PI * 32.0 / 64.0).cos());
    image.pixels[31 * 128 + 64] = [(1.0 / solid_angle) as f32; 4];
    let environment = project_environment(&image, 1.0, 0.0);
    for (side, toward) in frames() {
        let facing = DVec4::new(0.0, 1.0, 0.0, 1.0);
        let found = PI * environment_diffuse(&environment, facing, side, toward).x;
        let exact = filtered_cosine(facing, side, toward, -DVec3::Z);
        assert!((found - exact).abs() < 0.1, "{found}, not {exact}");
    }
}

#[test]
fn ringing_below_0_is_cut_off() {
    let mut image = LinearImage::filled(32, 16, [0.0; 4]);
    image.pixels[8 * 32 + 16] = [1000.0; 4];
    let environment = project_environment(&image, 1.0, 0.0);
    let seen: Vec<f64> = directions(500).map(|d| environment_toward(&environment, d, 0.0).x).collect();
    assert!(seen.iter().all(|&c| c >= 0.0) && seen.contains(&0.0));
}
