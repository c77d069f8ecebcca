//! Tables of the yarn's inside on the device against the integrals they stand for: usual yarns, cross-sections as
//! flat and as far apart as they may be, extinction from 0 to its end, the smallest and the largest sizes.

use super::verdict::{Collector, Row};
use crate::error::Error;
use crate::precompute::occlusion_table::{
    OCCLUSION_ACROSS, OCCLUSION_LIMIT, bake_occlusion_table, exact_occlusion, occlusion_place,
    texture_occlusion,
};
use crate::precompute::optical_depth::CrossSection;
use crate::precompute::scattering_table::{ambient_factors, bake_lobe, normaliser_factor};
use crate::precompute::self_shadow::{
    SELF_SHADOW_LIMIT, SelfShadowSize, bake_self_shadow, exact_self_shadow_depth, self_shadow_depth,
    self_shadow_place,
};
use crate::precompute::table_error::{TableError, places};
use crate::probe::{Function, Kernel, find, parse};
use crate::vulkan::Device;
use crate::yarn::density::extinction_per_mm;
use crate::yarn::params::YarnParams;
use crate::yarn::presets;
use glam::DVec2;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::sync::Arc;

const GROUP: &str = "tables";
/// Texels of a table of the default size over half of a ply's short axis, across the yarn and around it, that what
/// [`SELF_SHADOW_LIMIT`] and [`OCCLUSION_LIMIT`] promise needs; every preset has 27 and more.
pub const LEAST_TEXELS_IN_PLY: f64 = 20.0;
/// Least exponent of a density that falls off toward the rim, as all presets' do; and how much larger the largest error
/// is beside the step that a smaller one ends in.
const LEAST_FALLOFF: f64 = 0.1;
const STEP: f64 = 1.5;
/// Extinctions per mm and density.
const EXTINCTIONS: [f64; 7] = [0.0, 1e-3, 0.1, 1.0, 10.0, 100.0, 1e3];
/// Entries of scattering tables that a scene may ask for.
const SCATTERING_SIZES: [u32; 3] = [4, 128, 1024];

/// A yarn with its name.
type Named = (String, YarnParams);

/// Texels of a default self-shadow table over half of a ply's short axis: across the yarn, or from slice to slice where
/// those are farther apart.
fn texels_in_ply(yarn: &YarnParams) -> f64 {
    let size = SelfShadowSize::default();
    let short = yarn.ellipse_short_mm.min(yarn.ellipse_long_mm);
    let across = 2.0 * yarn.outer_radius_mm() / f64::from(size.across - 1);
    let around = yarn.ply_offset_mm() * PI / f64::from(yarn.ply_count * (size.slices - 1));
    short / across.max(around)
}

/// What a yarn's tables keep within: what is promised, or where its plies are thinner than that needs, so much less as
/// they are thinner; the largest errors, beside the outlines of plies, faster.
fn limits(yarn: &YarnParams) -> (TableError, f64) {
    let coarse = (LEAST_TEXELS_IN_PLY / texels_in_ply(yarn)).max(1.0);
    let TableError { rms, p99, worst } = SELF_SHADOW_LIMIT;
    // A density that does not fall off ends in a step.
    let worst = if yarn.density_beta < LEAST_FALLOFF { STEP * worst } else { worst };
    let depth = TableError {
        rms: (rms * coarse).min(1.0),
        p99: (p99 * coarse.powi(2)).min(1.0),
        worst: (worst * coarse.powi(2)).min(1.0),
    };
    (depth, (OCCLUSION_LIMIT * coarse).min(1.0))
}

/// Yarns of all counts and shapes.
fn yarns() -> Vec<Named> {
    let named = presets::yarn_names().filter_map(|name| Some((name.to_owned(), presets::yarn(name)?)));
    let base = presets::yarn(presets::DEFAULT_YARN);
    let mut all: Vec<Named> = named.collect();
    if let Some(yarn) = base {
        let with = |name: &str, edit: &dyn Fn(&mut YarnParams)| {
            let mut yarn = yarn.clone();
            edit(&mut yarn);
            (name.to_owned(), yarn)
        };
        for plies in [1, 2, 4, 8] {
            all.push(with(&format!("{plies} plies"), &|y| y.ply_count = plies));
        }
        for flat in [2.0_f64, 4.0, 10.0, 100.0] {
            let side = flat.sqrt() * 0.3 * yarn.yarn_radius_mm;
            all.push(with(&format!("radial ellipses {flat}:1"), &|y| {
                (y.ellipse_short_mm, y.ellipse_long_mm) = (side, side / flat)
            }));
            all.push(with(&format!("tangential ellipses {flat}:1"), &|y| {
                (y.ellipse_short_mm, y.ellipse_long_mm) = (side / flat, side)
            }));
        }
        for density in [[0.0, 0.0], [0.0, 0.5], [20.0, 0.0], [1e-3, 1e-3]] {
            all.push(with(&format!("beta {}, epsilon {}", density[0], density[1]), &|y| {
                [y.density_beta, y.density_epsilon] = density
            }));
        }
        all.push(with("plies on the axis", &|y| y.yarn_radius_mm = 0.0));
        all.push(with("plies far apart", &|y| y.yarn_radius_mm *= 20.0));
    }
    all
}

/// All rows.
///
/// # Errors
/// Those of the device.
pub fn rows(device: &Arc<Device>, quick: bool) -> Result<Vec<Row>, Error> {
    let (count, stride) = if quick { (200, 9) } else { (10_000, 1) };
    let yarns = yarns();
    let mut shadow = OnDevice::new(device, "self_shadow_depth")?;
    let mut occlusion = OnDevice::new(device, "ambient_occlusion")?;
    let mut rows = Vec::new();
    for (name, yarn) in yarns.iter().step_by(stride) {
        let (depth, light) = limits(yarn);
        rows.push(shadow.depths(name, yarn, count, &depth)?);
        rows.push(occlusion.visibilities(name, yarn, extinction_per_mm(yarn), count / 4, light)?);
    }
    if let Some((name, yarn)) = yarns.first() {
        for extinction in EXTINCTIONS.into_iter().step_by(stride) {
            let name = format!("{name}, extinction {extinction:.0e} per mm");
            // In denser yarns light ends within a texel, the sharper the denser.
            let dense = (extinction / (2.0 * extinction_per_mm(yarn))).max(1.0);
            let limit = (OCCLUSION_LIMIT * dense).min(1.0);
            rows.push(occlusion.visibilities(&name, yarn, extinction, count / 4, limit)?);
        }
        rows.extend(sizes(yarn, quick));
    }
    rows.extend(SCATTERING_SIZES.map(|entries| scattering_size(entries, quick)));
    Ok(rows)
}

/// A probed function that reads a table of the yarn's inside.
struct OnDevice {
    function: &'static Function,
    kernel: Kernel,
}

impl OnDevice {
    fn new(device: &Arc<Device>, name: &str) -> Result<Self, Error> {
        let function = find(name).ok_or_else(|| Error::Failed(format!("no function `{name}`")))?;
        Ok(Self { function, kernel: Kernel::new(device, function)? })
    }

    fn found(&mut self, queries: &[Value]) -> Result<Vec<f64>, Error> {
        let numbers: Result<Vec<Vec<f64>>, String> =
            queries.iter().map(|query| parse(self.function, &query.to_string())).collect();
        let numbers = numbers.map_err(Error::Failed)?;
        let slices: Vec<&[f64]> = numbers.iter().map(Vec::as_slice).collect();
        Ok(self.kernel.answers(&slices)?.concat())
    }

    fn exact(&self, queries: &[Value]) -> Result<Vec<f64>, Error> {
        let exact = |query: &Value| -> Result<Vec<f64>, String> {
            Ok((self.function.exact)(crate::probe::fields::Values::new(&parse(
                self.function,
                &query.to_string(),
            )?)))
        };
        let all: Result<Vec<Vec<f64>>, String> = queries.par_iter().map(exact).collect();
        Ok(all.map_err(Error::Failed)?.concat())
    }

    /// Optical depths all over the cross-section, as shares of the largest.
    fn depths(
        &mut self,
        name: &str,
        yarn: &YarnParams,
        count: u32,
        limit: &TableError,
    ) -> Result<Row, Error> {
        let radius = yarn.outer_radius_mm();
        let query = |(place, toward): (DVec2, DVec2)| json!({"yarn": section(yarn), "position": (place * radius).to_array(), "light_angle": toward.to_angle()});
        let queries: Vec<Value> = places(count).map(query).collect();
        let (found, exact) = (self.found(&queries)?, self.exact(&queries)?);
        let range = exact.iter().copied().fold(0.0, f64::max);
        Ok(table_row("self_shadow_depth", name, &queries, &found, &exact, range, limit))
    }

    /// Shares of light all over the cross-section.
    fn visibilities(
        &mut self,
        name: &str,
        yarn: &YarnParams,
        extinction: f64,
        count: u32,
        limit: f64,
    ) -> Result<Row, Error> {
        let radius = yarn.outer_radius_mm() * (1.0 - 1e-6);
        let query = |(place, _): (DVec2, DVec2)| json!({"yarn": section(yarn), "position": (place * radius).to_array(), "extinction": extinction});
        let queries: Vec<Value> = places(count).map(query).collect();
        let (found, exact) = (self.found(&queries)?, self.exact(&queries)?);
        let limit = TableError { rms: limit, p99: limit, worst: limit };
        Ok(table_row("ambient_occlusion", name, &queries, &found, &exact, 1.0, &limit))
    }
}

fn section(yarn: &YarnParams) -> Value {
    json!({"ply_count": yarn.ply_count, "ply_offset": yarn.ply_offset_mm(), "ellipse_short": yarn.ellipse_short_mm,
        "ellipse_long": yarn.ellipse_long_mm, "beta": yarn.density_beta, "epsilon": yarn.density_epsilon})
}

fn table_row(
    what: &str,
    name: &str,
    queries: &[Value],
    found: &[f64],
    exact: &[f64],
    range: f64,
    limit: &TableError,
) -> Row {
    let mut c = Collector::default();
    for ((query, found), exact) in queries.iter().zip(found).zip(exact) {
        c.points(1);
        c.numbers(&[*found], false, || query.to_string());
        c.error((found - exact).abs() / range, limit.worst, || query.to_string());
    }
    judge_table(&mut c, found, exact, range, limit);
    let promised =
        limit.rms <= if what == "self_shadow_depth" { SELF_SHADOW_LIMIT.rms } else { OCCLUSION_LIMIT };
    let promise =
        if promised { "as tables promise" } else { "plies too thin, or too dense, for the tables' promise" };
    c.row(GROUP, what, name, promise)
}

/// Beside the worst error, the root mean square, the 99th percentile, and that nothing is more than there can be.
fn judge_table(c: &mut Collector, found: &[f64], exact: &[f64], range: f64, limit: &TableError) {
    let pairs: Vec<(f64, f64)> = found.iter().copied().zip(exact.iter().copied()).collect();
    let error = TableError::new(&pairs, range);
    c.demand(error.within(limit), || {
        format!("rms {:.1e} of {:.1e}, 99% {:.1e} of {:.1e}", error.rms, limit.rms, error.p99, limit.p99)
    });
    let most = found.iter().copied().fold(0.0, f64::max);
    c.demand(most <= range * (1.0 + 2.0 * limit.worst), || format!("{most} is more than there can be"));
}

/// Of the coarsest table that a scene may ask for: 8 texels across three plies, and two slices.
const COARSEST_RMS: f64 = 0.1;

/// The smallest and largest tables that a scene may ask for, read as the device reads them. A coarser table's error is
/// that of linear interpolation, which grows as its texels' square, and at most [`COARSEST_RMS`]; its largest errors, at
/// kinks, grow as its texels.
fn sizes(yarn: &YarnParams, quick: bool) -> Vec<Row> {
    let count = if quick { 300 } else { 10_000 };
    let mut rows = Vec::new();
    for across in if quick { vec![8] } else { vec![8, 32, 512] } {
        let size = SelfShadowSize { across, slices: across / 4 };
        let table = bake_self_shadow(yarn, size);
        let coarse = (f64::from(SelfShadowSize::default().across) / f64::from(across)).max(1.0);
        let limit = SELF_SHADOW_LIMIT;
        let limit = TableError {
            rms: (coarse * coarse * limit.rms).min(COARSEST_RMS),
            p99: coarse * limit.p99,
            worst: (coarse * limit.worst).min(1.0),
        };
        let section = CrossSection::new(yarn);
        let all: Vec<(f64, f64)> = places(count)
            .map(|(place, toward)| {
                let at = self_shadow_place(place, toward, yarn.ply_count, size);
                (self_shadow_depth(&table, at), exact_self_shadow_depth(&section, place, toward))
            })
            .collect();
        rows.push(size_row("self_shadow_depth", across, &all, limit));
    }
    for across in if quick { vec![8] } else { vec![8, 64, 1024] } {
        let extinction = extinction_per_mm(yarn);
        let table = bake_occlusion_table(yarn, extinction, across);
        let coarse = (f64::from(OCCLUSION_ACROSS) / f64::from(across)).max(1.0);
        let worst = (coarse * OCCLUSION_LIMIT).min(1.0);
        let section = CrossSection::new(yarn);
        let all: Vec<(f64, f64)> = places(count / 10)
            .map(|(place, _)| {
                (
                    texture_occlusion(&table, occlusion_place(place, across)),
                    exact_occlusion(&section, extinction, place),
                )
            })
            .collect();
        rows.push(size_row("ambient_occlusion", across, &all, TableError { rms: worst, p99: worst, worst }));
    }
    rows
}

fn size_row(what: &str, across: u32, pairs: &[(f64, f64)], limit: TableError) -> Row {
    let (found, exact): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
    let range = exact.iter().copied().fold(0.0, f64::max);
    let mut c = Collector::default();
    for (index, (found, exact)) in pairs.iter().enumerate() {
        c.points(1);
        c.numbers(&[*found], false, || format!("place {index}"));
        c.error((found - exact).abs() / range, limit.worst, || format!("place {index}"));
    }
    judge_table(&mut c, &found, &exact, range, &limit);
    c.row(GROUP, what, &format!("{across} texels"), "8 to 512, or 1024 for occlusion; read in f64")
}

/// Tables of scattering with this many entries, between them, for lobes from the narrowest to the widest.
fn scattering_size(entries: u32, quick: bool) -> Row {
    // Linear between entries: the error falls with their distance squared, down to what 128 are promised.
    let coarse = (128.0 / f64::from(entries)).powi(2).max(1.0);
    let widths = if quick { vec![0.5_f64, 89.0] } else { vec![0.5, 2.0, 10.0, 30.0, 60.0, 89.0] };
    let mut c = Collector::default();
    for width in widths.into_iter().map(f64::to_radians) {
        let table = bake_lobe(width, entries);
        for step in 0..64 {
            let position = (f64::from(step) + 0.5) / 64.0;
            let at = position * f64::from(entries - 1);
            let low = (at as usize).min(entries as usize - 2);
            let [all, grazing, through] = ambient_factors(position, width);
            for (column, exact) in
                [normaliser_factor(position, width), all, grazing, through].into_iter().enumerate()
            {
                let share = at - low as f64;
                let found =
                    (1.0 - share) * f64::from(table[low][column]) + share * f64::from(table[low + 1][column]);
                let place = || format!("width {width}, position {position}, column {column}");
                c.points(1);
                c.numbers(&[found], false, place);
                c.error((found - exact).abs() / exact.abs().max(1e-3), (1e-3 * coarse).min(1.0), place);
            }
        }
    }
    c.row(
        GROUP,
        "scattering",
        &format!("{entries} entries"),
        "4 to 1024; widths 0.5 to 89 degrees; read in f64",
    )
}
