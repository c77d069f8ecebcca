//! Fiber scattering. Angles become what the shader's functions take in f64; the fiber's tangent is the Z axis and
//! the eye lies over the -Y axis, which is where the shader takes directions along the tangent to lie.

use super::entries::{Column, Entries};
use super::fields::{Domain, Field, PHI, SIMPLE_WIDTH, STRENGTH, THETA, Values, WIDTH, field};
use super::function::{Function, OnDevice, Shape, any, as_given, words};
use crate::bsdf::khungurn::tabulated::{ambient_position, normaliser_position};
use crate::bsdf::khungurn::{self, FiberScattering, Lobes};
use crate::bsdf::simple::simple_specular;
use crate::precompute::scattering_table::azimuthal_constants;
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// |cos(phi / 2)|.
fn cos_half(phi: f64) -> f64 {
    (0.5 * phi).cos().abs()
}

/// cos theta; f32's pi/2 lies beyond pi/2.
fn cosine(theta: f64) -> f64 {
    theta.cos().max(0.0)
}

/// Wu & Yuksel's simple lobe.
pub const SIMPLE_SPECULAR: Function = Function {
    name: "simple_specular",
    about: "strength |cos(phi/2)| exp(-theta_h^2 / (2 width^2)) (Wu & Yuksel 2019, Eq. 5)",
    fields: &[
        field("strength", STRENGTH),
        field("theta_h", THETA),
        field("phi", PHI),
        field("width", SIMPLE_WIDTH),
    ],
    results: &[("value", Shape::Number)],
    check: any,
    exact: |mut query| {
        let (strength, theta_h, phi) = (query.real(), query.real(), query.real());
        vec![strength * simple_specular(cos_half(phi), theta_h, query.real(), 0.0)]
    },
    device: OnDevice {
        kernel: "probe/simple_specular.comp",
        given: 1,
        words: |mut query, _| {
            let (strength, theta_h, phi) = (query.real(), query.real(), query.real());
            words([strength, cos_half(phi), theta_h, query.real()])
        },
        finish: as_given,
        table: None,
    },
};

/// G.
pub const LONGITUDINAL_NORMALISER: Function = Function {
    name: "longitudinal_normaliser",
    about: "G(theta, width), the integral of a Gaussian about theta times cos^2; on the device a closed form times a \
            table (Wu & Yuksel 2019, Eq. 9)",
    fields: &[field("theta", THETA), field("width", WIDTH)],
    results: &[("normaliser", Shape::Number)],
    check: any,
    exact: |mut query| vec![khungurn::longitudinal_normaliser(query.real(), query.real())],
    device: OnDevice {
        kernel: "probe/longitudinal_normaliser.comp",
        given: 1,
        words: |mut query, entries| {
            let (cos_theta, width) = (cosine(query.real()), query.real());
            let mut row = words([cos_theta, width]);
            row.extend(entries.around(Column::Normaliser, width, normaliser_position(cos_theta, width)));
            row
        },
        finish: as_given,
        table: None,
    },
};

/// N_TT.
pub const AZIMUTHAL_TT: Function = Function {
    name: "azimuthal_tt",
    about: "N_TT, the transmitted lobe's azimuthal factor, per radian (Khungurn 2017)",
    fields: &[field("phi", PHI), field("width", WIDTH)],
    results: &[("value", Shape::Number)],
    check: any,
    exact: |mut query| vec![khungurn::azimuthal_tt(cos_half(query.real()), query.real())],
    device: OnDevice {
        kernel: "test/functions/azimuthal_tt.comp",
        given: 1,
        words: |mut query, _| {
            let (phi, gamma_tt) = (query.real(), query.real());
            let fiber =
                FiberScattering { c_r: DVec3::ZERO, c_tt: DVec3::ZERO, beta_r: 1.0, beta_tt: 1.0, gamma_tt };
            let (k, n) = azimuthal_constants(&fiber);
            words([cos_half(phi), k, n])
        },
        finish: as_given,
        table: None,
    },
};

const ANGLES_AND_FIBER: &[Field] = &[
    field("theta_i", THETA),
    field("theta_o", THETA),
    field("phi", PHI),
    field("fiber.c_r", Domain::Color),
    field("fiber.beta_r", WIDTH),
    field("fiber.c_tt", Domain::Color),
    field("fiber.beta_tt", WIDTH),
    field("fiber.gamma_tt", WIDTH),
];
const LOBES: &[(&str, Shape)] = &[("r", Shape::Color), ("tt", Shape::Color)];

fn fiber(query: &mut Values<'_>) -> FiberScattering {
    let (c_r, beta_r, c_tt, beta_tt) = (query.color(), query.real(), query.color(), query.real());
    FiberScattering { c_r, c_tt, beta_r, beta_tt, gamma_tt: query.real() }
}

fn both(lobes: Lobes) -> Vec<f64> {
    [lobes.r.to_array(), lobes.tt.to_array()].concat()
}

/// Colors, widths and constants, then the entries of both tables around the places that are read.
fn fiber_words(
    fiber: &FiberScattering,
    entries: &Entries,
    column: Column,
    position: fn(f64, f64) -> f64,
    x: f64,
) -> Vec<u32> {
    let (k_tt, n_tt) = azimuthal_constants(fiber);
    let mut row = words(fiber.c_r.to_array().into_iter().chain(fiber.c_tt.to_array()));
    row.extend(words([fiber.beta_r, fiber.beta_tt, k_tt, n_tt]));
    for width in [fiber.beta_r, fiber.beta_tt] {
        row.extend(entries.around(column, width, position(x, width)));
    }
    row
}

/// [`fiber_words`] where light of one direction is scattered.
fn lit_fiber_words(fiber: &FiberScattering, entries: &Entries, cos_i: f64) -> Vec<u32> {
    fiber_words(fiber, entries, Column::Normaliser, normaliser_position, cos_i)
}

/// S.
pub const BCSDF: Function = Function {
    name: "bcsdf",
    about: "both lobes of the fiber's scattering, per steradian; on the device in the tabulated form (Khungurn 2017)",
    fields: ANGLES_AND_FIBER,
    results: LOBES,
    check: any,
    exact: |mut query| {
        let [theta_i, theta_o, phi] = query.vec3().to_array();
        both(khungurn::bcsdf(theta_i, theta_o, phi, &fiber(&mut query)))
    },
    device: OnDevice {
        kernel: "probe/bcsdf.comp",
        given: 6,
        words: |mut query, entries| {
            let [theta_i, theta_o, phi] = query.vec3().to_array();
            let cos_i = cosine(theta_i);
            let mut row = words([theta_i + theta_o, cos_i, cos_half(phi)]);
            row.extend(lit_fiber_words(&fiber(&mut query), entries, cos_i));
            row
        },
        finish: as_given,
        table: None,
    },
};

/// S cos(theta_i).
pub const BCSDF_COS: Function = Function {
    name: "bcsdf_cos",
    about: "bcsdf times cos(theta_i); on the device from directions, as surfaces are shaded (Khungurn 2017)",
    fields: ANGLES_AND_FIBER,
    results: LOBES,
    check: any,
    exact: |mut query| {
        let [theta_i, theta_o, phi] = query.vec3().to_array();
        both(khungurn::bcsdf_cos(theta_i, theta_o, phi, &fiber(&mut query)))
    },
    device: OnDevice {
        kernel: "probe/bcsdf_cos.comp",
        given: 6,
        words: |mut query, entries| {
            let [theta_i, theta_o, phi] = query.vec3().to_array();
            let directions = [direction(theta_i, phi), direction(theta_o, 0.0)];
            let mut row = words(directions.into_iter().flat_map(|d| d.to_array()));
            let cos_i = cosine(theta_i);
            row.extend(lit_fiber_words(&fiber(&mut query), entries, cos_i));
            row
        },
        finish: as_given,
        table: None,
    },
};

fn direction(theta: f64, phi: f64) -> DVec3 {
    let cos_theta = cosine(theta);
    DVec3::new(cos_theta * phi.sin(), -cos_theta * phi.cos(), theta.sin())
}

/// S cos(theta_i), integrated over all light.
pub const AMBIENT_SCATTERING: Function = Function {
    name: "ambient_scattering",
    about: "integral of bcsdf_cos over uniform light from everywhere; on the device by tables (Wu & Yuksel 2019, Eq. 8)",
    fields: &[
        field("theta_o", THETA),
        field("fiber.c_r", Domain::Color),
        field("fiber.beta_r", WIDTH),
        field("fiber.c_tt", Domain::Color),
        field("fiber.beta_tt", WIDTH),
        field("fiber.gamma_tt", WIDTH),
    ],
    results: LOBES,
    check: any,
    exact: |mut query| both(khungurn::ambient_scattering(query.real(), &fiber(&mut query))),
    device: OnDevice {
        kernel: "probe/ambient_scattering.comp",
        given: 6,
        words: |mut query, entries| {
            let theta_o = query.real();
            let x_o = (FRAC_PI_2 - theta_o.abs()).max(0.0);
            let mut row = words(direction(theta_o, 0.0).to_array());
            row.extend(fiber_words(&fiber(&mut query), entries, Column::Ambient, ambient_position, x_o));
            row
        },
        finish: as_given,
        table: None,
    },
};
