//! The yarn's inside: density, and what tables hold of the light in it.

use super::fields::{Domain, EXTINCTION, PHI, PLACE, SHARE, Values, field};
use super::function::{Function, OnDevice, Shape, Table, TableOf, any, as_given, words};
use super::yarn::bare_yarn;
use crate::precompute::chord_shadow::{Plies, bake_chord_shadow};
use crate::precompute::occlusion_size::occlusion_across;
use crate::precompute::occlusion_table::{OCCLUSION_LIMIT, bake_occlusion_table, exact_occlusion};
use crate::precompute::optical_depth::CrossSection;
use crate::precompute::self_shadow::{SelfShadowSize, bake_self_shadow, exact_self_shadow_depth};
use crate::yarn::density::fiber_density;
use crate::yarn::inside::fits_table;
use crate::yarn::params::{MOST_THIN, YarnParams};
use glam::DVec2;

/// p(R).
pub const FIBER_DENSITY: Function = Function {
    name: "fiber_density",
    about: "area density of fibers at a share of the ply's ellipse (Zhao et al. 2016)",
    fields: &[
        field("radius", SHARE),
        field("beta", Domain::Yarn("density_beta")),
        field("epsilon", Domain::Yarn("density_epsilon")),
    ],
    results: &[("density", Shape::Number)],
    check: any,
    exact: |mut query| vec![fiber_density(query.real(), query.real(), query.real())],
    device: OnDevice {
        kernel: "test/functions/fiber_density.comp",
        given: 1,
        words: |mut query, _| words([query.real(), query.real(), query.real()]),
        finish: as_given,
        table: None,
    },
};

/// Numbers of a query that say what the yarn is.
const YARN_NUMBERS: usize = 6;

/// The yarn of a query whose first fields are the yarn's.
fn yarn(query: &mut Values<'_>) -> YarnParams {
    let (ply_count, ply_offset, ellipse) = (query.whole(), query.real(), query.vec2());
    YarnParams {
        yarn_radius_mm: 2.0 * ply_offset,
        density_beta: query.real(),
        density_epsilon: query.real(),
        ..bare_yarn(ply_count, ellipse)
    }
}

/// Optical depth toward a light across the yarn.
pub const SELF_SHADOW_DEPTH: Function = Function {
    name: "self_shadow_depth",
    about: "integral of all plies' densities from a place in the cross-section, ply 0 centred at (ply_offset, 0), \
            toward light at light_angle across the yarn, in the lengths' unit, of plies no thinner than a \
            thousandth of the yarn; on the device by the table that the renderer takes for the yarn (Wu & Yuksel \
            2019, Sec. 4.1)",
    fields: &[
        field("yarn.ply_count", Domain::Yarn("ply_count")),
        field("yarn.ply_offset", Domain::Yarn("yarn_radius_mm")),
        field("yarn.ellipse_short", Domain::Yarn("ellipse_short_mm")),
        field("yarn.ellipse_long", Domain::Yarn("ellipse_long_mm")),
        field("yarn.beta", Domain::Yarn("density_beta")),
        field("yarn.epsilon", Domain::Yarn("density_epsilon")),
        field("position", PLACE),
        field("light_angle", PHI),
    ],
    results: &[("optical_depth", Shape::Number)],
    check: |mut query| thick_enough(&yarn(&mut query)),
    exact: |mut query| {
        let yarn = yarn(&mut query);
        let radius = yarn.outer_radius_mm();
        let (position, light) = (query.vec2() / radius, DVec2::from_angle(query.real()));
        vec![radius * exact_self_shadow_depth(&CrossSection::new(&yarn), position, light)]
    },
    device: OnDevice {
        kernel: "probe/self_shadow_depth.comp",
        given: 1,
        words: |mut query, _| {
            let yarn = yarn(&mut query);
            let (position, light) = (query.vec2() / yarn.outer_radius_mm(), DVec2::from_angle(query.real()));
            let plies = Plies::new(&yarn);
            let mut row = words([position.x, position.y, light.x, light.y]);
            row.extend([u32::from(!fits_table(&yarn)), plies.count]);
            row.extend(words([plies.offset, plies.axes.x, plies.axes.y, plies.turn.x, plies.turn.y]));
            row
        },
        finish: |mut query, given| {
            let radius = yarn(&mut query).outer_radius_mm();
            given.iter().map(|depth| radius * f64::from(*depth)).collect()
        },
        table: Some(TableOf {
            numbers: YARN_NUMBERS,
            bake: |mut query| {
                let yarn = yarn(&mut query);
                Ok(if fits_table(&yarn) {
                    Table::SelfShadow(bake_self_shadow(&yarn, SelfShadowSize::default()))
                } else {
                    Table::Chords(bake_chord_shadow(&yarn))
                })
            },
        }),
    },
};

/// Share of ambient light.
pub const AMBIENT_OCCLUSION: Function = Function {
    name: "ambient_occlusion",
    about: "mean over directions across the yarn of exp(-extinction x optical depth), extinction per unit of length \
            and density, from a place no farther out, either way, than the yarn's outer radius, of plies no thinner \
            than a thousandth of the yarn; on the device by the table, an error where none is within 0.01 (Wu & \
            Yuksel 2019, Sec. 4.2)",
    fields: &[
        field("yarn.ply_count", Domain::Yarn("ply_count")),
        field("yarn.ply_offset", Domain::Yarn("yarn_radius_mm")),
        field("yarn.ellipse_short", Domain::Yarn("ellipse_short_mm")),
        field("yarn.ellipse_long", Domain::Yarn("ellipse_long_mm")),
        field("yarn.beta", Domain::Yarn("density_beta")),
        field("yarn.epsilon", Domain::Yarn("density_epsilon")),
        field("extinction", EXTINCTION),
        field("position", PLACE),
    ],
    results: &[("visibility", Shape::Number)],
    check: |query| in_reach(query),
    exact: |mut query| {
        let (yarn, extinction) = (yarn(&mut query), query.real());
        vec![exact_occlusion(&CrossSection::new(&yarn), extinction, query.vec2() / yarn.outer_radius_mm())]
    },
    device: OnDevice {
        kernel: "probe/ambient_occlusion.comp",
        given: 1,
        words: |mut query, _| {
            let (yarn, _extinction) = (yarn(&mut query), query.real());
            words((query.vec2() / yarn.outer_radius_mm()).to_array())
        },
        finish: as_given,
        table: Some(TableOf {
            numbers: YARN_NUMBERS + 1,
            bake: |mut query| {
                let (yarn, extinction) = (yarn(&mut query), query.real());
                let across = occlusion_across(&yarn, extinction).map_err(|left| {
                    format!(
                        "yarn, extinction = {extinction}: expected what a table shows to {OCCLUSION_LIMIT}, \
                         found an error of {left:.3}"
                    )
                })?;
                Ok(Table::Occlusion(bake_occlusion_table(&yarn, extinction, across)))
            },
        }),
    },
};

/// Whether the place lies in the square around the yarn's outer circle: beyond it the table, and with it the
/// renderer, takes the value at its edge.
fn in_reach(mut query: Values<'_>) -> Result<(), String> {
    let (yarn, _extinction) = (yarn(&mut query), query.real());
    thick_enough(&yarn)?;
    let radius = yarn.outer_radius_mm();
    let place = query.vec2();
    // What lies on the edge may have been rounded beyond it.
    if place.abs().max_element() <= radius * (1.0 + f64::from(f32::EPSILON)) {
        return Ok(());
    }
    Err(format!("position = {place}: expected at most the yarn's outer radius, {radius}, either way"))
}

/// Whether f32 has place for the yarn's plies in its cross-section.
fn thick_enough(yarn: &YarnParams) -> Result<(), String> {
    let ((key, thinnest), radius) = (yarn.thinnest(), yarn.outer_radius_mm());
    let key = key.trim_end_matches("_mm");
    // What lies on the edge may have been rounded beyond it.
    if thinnest * MOST_THIN * (1.0 + f64::from(f32::EPSILON)) >= radius {
        return Ok(());
    }
    Err(format!(
        "yarn.{key} = {thinnest}: expected at least 1/{MOST_THIN} of the yarn's outer radius, {radius}"
    ))
}
