//! Arguments of fiber scattering: fibers, angles and directions, random and extreme.

use crate::harness::{Args, Row};
use crate::inputs::{Random, RowBuilder, random_rows, row, special_units};
use crate::scattering_tables::{WIDTHS_DEG, table, width};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use worsted::bsdf::khungurn::FiberScattering;
use worsted::bsdf::khungurn::tabulated::{Scattering, TabulatedLobe};
use worsted::math::special::i0e;

/// A fiber as a row holds it.
#[derive(Clone, Copy)]
pub struct FiberArguments {
    pub tables: [u32; 2],
    pub c_r: DVec3,
    pub c_tt: DVec3,
    pub gamma_deg: f64,
}

impl FiberArguments {
    pub fn random(random: &mut Random) -> Self {
        let count = WIDTHS_DEG.len() as u32;
        let mut colour = || match random.below(6) {
            0 => DVec3::ZERO,
            1 => DVec3::ONE,
            _ => DVec3::from_array(std::array::from_fn(|_| random.between(0.0, 1.0))),
        };
        let (c_r, c_tt) = (colour(), colour());
        let tables = [random.below(count), random.below(count)];
        Self { tables, c_r, c_tt, gamma_deg: random.magnitude(0.5, 60.0) }
    }

    /// The wider longitudinal width, radians.
    pub fn widest(&self) -> f64 {
        width(self.tables[0]).max(width(self.tables[1]))
    }

    /// |cos(phi / 2)|, mostly within a few widths of forward.
    pub fn cos_half_phi(&self, random: &mut Random) -> f64 {
        match random.below(4) {
            0 => random.between(0.0, 1.0),
            _ => (0.5 * self.gamma_deg.to_radians() * random.between(0.0, 5.0)).min(1.0),
        }
    }

    pub fn begin(self) -> RowBuilder {
        let k = self.gamma_deg.to_radians().powi(-2) as f32;
        let n = 1.0 / (TAU * i0e(f64::from(k)));
        let row = row().bits(self.tables[0]).bits(self.tables[1]).vec3(self.c_r).vec3(self.c_tt);
        row.real(width(self.tables[0])).real(width(self.tables[1])).real(f64::from(k)).real(n)
    }
}

/// The fiber of a row, for the twin that reads tables and for the truth, which reads none.
pub fn take_fiber(args: &mut Args<'_>) -> (Scattering<'static>, FiberScattering) {
    let [r, tt] = [args.bits(), args.bits()].map(table);
    let (c_r, c_tt) = (args.vec3(), args.vec3());
    let r = TabulatedLobe { width: args.real(), table: r };
    let tt = TabulatedLobe { width: args.real(), table: tt };
    let (k_tt, n_tt) = (args.real(), args.real());
    let truth = FiberScattering { c_r, c_tt, beta_r: r.width, beta_tt: tt.width, gamma_tt: k_tt.powf(-0.5) };
    (Scattering { c_r, c_tt, r, tt, k_tt, n_tt }, truth)
}

/// Distance from the pole: anywhere, or near it by any number of widths.
pub fn pole_distance(random: &mut Random, width: f64) -> f64 {
    match random.below(8) {
        0 => 0.0,
        1 => FRAC_PI_2,
        2 => random.magnitude(1e-7, 1.0),
        3 | 4 => (width * random.between(0.0, 6.0)).min(FRAC_PI_2),
        _ => random.between(0.0, FRAC_PI_2),
    }
}

/// None in a row of two, else of any size that tangents have.
pub fn variance(random: &mut Random) -> f64 {
    if random.below(2) == 0 { 0.0 } else { random.magnitude(1e-6, 1.0) }
}

/// A fiber, theta_i + theta_o, cos theta_i, |cos(phi / 2)| and the variance.
pub fn bcsdf_rows(function: &str) -> Vec<Row> {
    let mut rows = random_rows(function, |random| {
        let fiber = FiberArguments::random(random);
        let spread = variance(random);
        let deviation = (fiber.widest().powi(2) + spread).sqrt();
        let theta_sum = (deviation * random.between(-5.0, 5.0)).clamp(-PI, PI);
        let cos_i = pole_distance(random, fiber.widest()).sin();
        let placed = fiber.begin().real(theta_sum).real(cos_i);
        placed.real(fiber.cos_half_phi(random)).real(spread).end()
    });
    let mut random = Random::of("extreme fibers");
    let last = WIDTHS_DEG.len() as u32 - 1;
    for tables in [[0, 0], [0, last], [last, 0], [last, last]] {
        for gamma_deg in [0.5, 12.0, 60.0] {
            for theta_sum in [0.0, 1e-7, -0.03, PI, -PI] {
                for cos_i in [0.0, 1e-9, 1e-3, 0.5, 1.0] {
                    for cos_half_phi in [0.0, 1e-4, 1.0] {
                        let fiber =
                            FiberArguments { tables, gamma_deg, ..FiberArguments::random(&mut random) };
                        let row = fiber.begin().real(theta_sum).real(cos_i).real(cos_half_phi);
                        rows.push(row.real(variance(&mut random)).end());
                    }
                }
            }
        }
    }
    rows
}

fn at(tangent: DVec3, theta: f64, around: DVec3) -> DVec3 {
    theta.sin() * tangent + theta.cos() * around
}

/// A fiber, its tangent, the directions of light and eye, and the variance.
pub fn bcsdf_cos_rows(function: &str) -> Vec<Row> {
    let mut rows = random_rows(function, |random| {
        let fiber = FiberArguments::random(random);
        let spread = variance(random);
        let deviation = (fiber.widest().powi(2) + spread).sqrt();
        let tangent = random.unit();
        let around = random.unit_around(tangent);
        let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
        let theta_i = sign * (FRAC_PI_2 - pole_distance(random, fiber.widest()));
        let theta_o = (deviation * random.between(-5.0, 5.0) - theta_i).clamp(-FRAC_PI_2, FRAC_PI_2);
        let half_phi = fiber.cos_half_phi(random).acos();
        let (sin, cos) = (2.0 * half_phi).sin_cos();
        let other = cos * around + sin * tangent.cross(around);
        let (light, eye) = match random.below(12) {
            0 => (random.unit_near(tangent), random.unit()),
            1 => (random.unit(), random.unit_near(tangent)),
            2 => (random.unit(), random.unit()),
            _ => (at(tangent, theta_i, around), at(tangent, theta_o, other)),
        };
        fiber.begin().vec3(tangent).vec3(light).vec3(eye).real(spread).end()
    });
    let mut random = Random::of("extreme directions");
    for tangent in special_units() {
        let side = random.unit_around(tangent);
        for light in [tangent, -tangent, side] {
            for eye in [tangent, -tangent, side, -side] {
                for gamma_deg in [0.5, 30.0] {
                    let fiber = FiberArguments { gamma_deg, ..FiberArguments::random(&mut random) };
                    let row = fiber.begin().vec3(tangent).vec3(light).vec3(eye);
                    rows.push(row.real(variance(&mut random)).end());
                }
            }
        }
    }
    rows
}

/// A fiber, its tangent and the direction of the eye.
pub fn ambient_rows(function: &str) -> Vec<Row> {
    let mut rows = random_rows(function, |random| {
        let fiber = FiberArguments::random(random);
        let tangent = random.unit();
        let around = random.unit_around(tangent);
        let theta = FRAC_PI_2 - pole_distance(random, fiber.widest());
        let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
        fiber.begin().vec3(tangent).vec3(at(tangent, sign * theta, around)).end()
    });
    let mut random = Random::of("extreme eyes");
    for tangent in special_units() {
        for eye in [tangent, -tangent, random.unit_around(tangent)] {
            rows.push(FiberArguments::random(&mut random).begin().vec3(tangent).vec3(eye).end());
        }
    }
    rows
}
