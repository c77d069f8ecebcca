//! From radiance to what is shown, from 1e-6 to 1e6: the curves, and whole pictures in dim and in glaring light.

use super::cases::{Case, set};
use super::geometry::scene_of;
use super::sweep::{Effort, sweep};
use super::verdict::{Collector, Row};
use crate::error::Error;
use crate::frame::sampling::Sampling;
use crate::frame::{Picture, Renderer, Request};
use crate::math::color::srgb_from_linear;
use crate::math::curve::Basis;
use crate::math::tone::{tone_filmic, tone_neutral};
use crate::probe::Kernel;
use crate::probe::fields::{Domain, SHARE, field};
use crate::probe::function::{Function, OnDevice, Shape, any, as_given, words};
use crate::vulkan::Device;
use glam::DVec3;
use std::sync::Arc;

const GROUP: &str = "exposure";
/// Brightest radiance that is tried.
const BRIGHTEST: f64 = 1e6;
/// Most that a pixel may differ from the same one in usual light, as a share of it or of a thousandth of the brightest:
/// half floats hold 1 in 2048.
const PICTURE_LIMIT: f64 = 2e-3;
const FLOOR: f64 = 1e-3;
/// Irradiances of the lamp, of which the middle one is usual.
const IRRADIANCES: [f64; 6] = [1e-6, 1e-3, 0.03, 40.0, 1e3, 1e6];

const RADIANCE: Domain = Domain::Numbers(3, 0.0, BRIGHTEST);

const TONE_NEUTRAL: Function = Function {
    name: "tone_neutral",
    about: "the neutral tone curve",
    fields: &[field("radiance", RADIANCE)],
    results: &[("shown", Shape::Vector)],
    check: any,
    exact: |mut query| tone_neutral(query.vec3()).to_array().into(),
    device: OnDevice {
        kernel: "test/functions/tone_neutral.comp",
        given: 3,
        words: |mut query, _| words(query.vec3().to_array()),
        finish: as_given,
        table: None,
    },
};

const TONE_FILMIC: Function = Function {
    name: "tone_filmic",
    about: "the filmic tone curve",
    exact: |mut query| tone_filmic(query.vec3()).to_array().into(),
    device: OnDevice { kernel: "test/functions/tone_filmic.comp", ..TONE_NEUTRAL.device },
    ..TONE_NEUTRAL
};

const SRGB: Function = Function {
    name: "srgb_from_linear",
    about: "the display's transfer function",
    fields: &[field("linear", SHARE)],
    results: &[("encoded", Shape::Number)],
    check: any,
    exact: |mut query| vec![srgb_from_linear(query.real())],
    device: OnDevice {
        kernel: "test/functions/srgb_from_linear.comp",
        given: 1,
        words: |mut query, _| words([query.real()]),
        finish: as_given,
        table: None,
    },
};

static CURVES: [Function; 3] = [TONE_NEUTRAL, TONE_FILMIC, SRGB];

/// All rows.
///
/// # Errors
/// Those of the device.
pub fn rows(device: &Arc<Device>, effort: Effort, quick: bool) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for function in &CURVES {
        rows.extend(sweep(Kernel::new(device, function)?, function, GROUP, effort)?);
    }
    for kind in if quick { vec!["lamp"] } else { vec!["lamp", "sky"] } {
        let usual = picture(device, kind, 1.0)?;
        for irradiance in IRRADIANCES.into_iter().step_by(if quick { IRRADIANCES.len() - 1 } else { 1 }) {
            rows.push(against(&usual, &picture(device, kind, irradiance)?, kind, irradiance));
        }
    }
    Ok(rows)
}

/// A strand in light of one strength: from a lamp, or from everywhere.
fn picture(device: &Arc<Device>, kind: &str, strength: f64) -> Result<Picture, Error> {
    let points = (0..8).map(|i| DVec3::new(f64::from(i) - 3.5, 0.4 * f64::from(i % 3), 0.0)).collect();
    let case = Case {
        name: format!("{kind} of {strength:e}"),
        domain: String::new(),
        yarn: String::new(),
        curves: set(Basis::CatmullRom, points, false),
        smooth: true,
    };
    let lit = |lamp: f64, sky: f64| {
        format!(
            "ambient.radiance = [{sky:?}, {sky:?}, {sky:?}]\nlight = [{{irradiance = [{lamp:?}, {lamp:?}, {lamp:?}]}}]"
        )
    };
    let light = if kind == "lamp" { lit(strength, 0.0) } else { lit(0.0, strength) };
    let scene = scene_of(&case, &light)?;
    let request = Request {
        size: [64, 48],
        sampling: Sampling::new(4).map_err(Error::Failed)?,
        statistics: false,
        profile: false,
    };
    Ok(Renderer::new(device, scene, request)?.render(&|_| ())?)
}

/// A picture is that of usual light, so many times brighter.
fn against(usual: &Picture, found: &Picture, kind: &str, strength: f64) -> Row {
    let mut c = Collector::default();
    let brightest =
        usual.linear.iter().flat_map(|p| p[..3].iter()).map(|v| f64::from(*v)).fold(0.0, f64::max);
    c.demand(brightest > 0.0, || "the usual picture is black".to_owned());
    for (index, (a, b)) in usual.linear.iter().zip(&found.linear).enumerate() {
        let at = || format!("pixel {}, {}", index as u32 % usual.size[0], index as u32 / usual.size[0]);
        c.points(1);
        c.numbers(&b.map(f64::from), false, at);
        c.demand(a[3] == b[3], || format!("coverage differs at {}", at()));
        for k in 0..3 {
            let (a, b) = (f64::from(a[k]), f64::from(b[k]) / strength);
            c.error((a - b).abs() / a.max(FLOOR * brightest), PICTURE_LIMIT, at);
        }
    }
    c.row(GROUP, "a picture", &format!("{kind} of {strength:e}"), "light of 1e-6 to 1e6")
}
