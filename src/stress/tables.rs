//! Tables of the yarn's inside on the device against the integrals they stand for: usual yarns, cross-sections as
//! flat and as far apart as they may be, extinction from 0 to its end, the smallest and the largest sizes.

use super::verdict::{Collector, Row};
use crate::error::Error;
use crate::precompute::chord_shadow::{CHORD_LIMIT, Plies};
use crate::precompute::occlusion_size::occlusion_across;
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
use crate::yarn::inside::fits_table;
use crate::yarn::params::{MOST_THIN, YarnParams};
use crate::yarn::presets;
use glam::DVec2;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::sync::Arc;

const GROUP: &str = "tables";
/// The largest extinction per mm and density that a query may ask for, and some up to it.
const MOST_EXTINCTION: f64 = 1e3;
const EXTINCTIONS: [f64; 7] = [0.0, 1e-3, 0.1, 1.0, 10.0, 100.0, MOST_EXTINCTION];
/// Entries of scattering tables that a scene may ask for.
const SCATTERING_SIZES: [u32; 3] = [4, 128, 1024];

/// A yarn with its name.
type Named = (String, YarnParams);

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
        for thin in [30.0, 900.0] {
            let side = 0.3 * yarn.yarn_radius_mm;
            all.push(with(&format!("{thin} times thinner than the yarn"), &|y| {
                (y.ply_count, y.ellipse_short_mm, y.ellipse_long_mm) = (2, 2.0 * side / thin, side)
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
        rows.push(shadow.depths(name, yarn, count)?);
        let extinction = extinction_per_mm(yarn).min(MOST_EXTINCTION);
        rows.push(occlusion.visibilities(name, yarn, extinction, count / 4)?);
    }
    if let Some((name, yarn)) = yarns.first() {
        for extinction in EXTINCTIONS.into_iter().step_by(stride) {
            let name = format!("{name}, extinction {extinction:.0e} per mm");
            rows.push(occlusion.visibilities(&name, yarn, extinction, count / 4)?);
        }
        rows.push(too_thin(yarn, &shadow, &occlusion));
        rows.extend(sizes(yarn, quick));
        rows.extend(
            yarns.iter().take(presets::yarn_names().count()).step_by(stride).map(|yarn| drawn(yarn, count)),
        );
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

    /// The device's numbers, or why there is no table that is good enough.
    fn found(&mut self, queries: &[Value]) -> Result<Result<Vec<f64>, String>, Error> {
        let numbers: Result<Vec<Vec<f64>>, String> =
            queries.iter().map(|query| parse(self.function, &query.to_string())).collect();
        let numbers = numbers.map_err(Error::Failed)?;
        let slices: Vec<&[f64]> = numbers.iter().map(Vec::as_slice).collect();
        let answers: Result<Vec<Vec<f64>>, String> = self.kernel.answers(&slices)?.into_iter().collect();
        Ok(answers.map(|numbers| numbers.concat()))
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
    fn depths(&mut self, name: &str, yarn: &YarnParams, count: u32) -> Result<Row, Error> {
        let query = |(place, toward): (DVec2, DVec2)| json!({"yarn": section(yarn), "position": place.to_array(), "light_angle": toward.to_angle()});
        let queries: Vec<Value> = inside(yarn, count).map(query).collect();
        let exact = self.exact(&queries)?;
        let range = exact.iter().copied().fold(0.0, f64::max);
        let (limit, promise) = if fits_table(&without_migration(yarn)) {
            (SELF_SHADOW_LIMIT, "by place, as the table promises")
        } else {
            (CHORD_LIMIT, "ply by ply, as the table promises")
        };
        let found = self.found(&queries)?.map_err(Error::Failed)?;
        Ok(table_row("self_shadow_depth", (name, promise), &queries, (&found, &exact), range, &limit))
    }

    /// Shares of light all over the cross-section; where no table shows them well enough, that it is refused.
    fn visibilities(
        &mut self,
        name: &str,
        yarn: &YarnParams,
        extinction: f64,
        count: u32,
    ) -> Result<Row, Error> {
        let query = |(place, _): (DVec2, DVec2)| json!({"yarn": section(yarn), "position": (place * (1.0 - 1e-6)).to_array(), "extinction": extinction});
        let queries: Vec<Value> = inside(yarn, count).map(query).collect();
        let limit = TableError { rms: OCCLUSION_LIMIT, p99: OCCLUSION_LIMIT, worst: OCCLUSION_LIMIT };
        let what = "ambient_occlusion";
        Ok(match self.found(&queries)? {
            Ok(found) => {
                let exact = self.exact(&queries)?;
                let name = (name, "as the table promises");
                table_row(what, name, &queries, (&found, &exact), 1.0, &limit)
            }
            Err(why) => {
                let mut c = Collector::default();
                c.points(queries.len() as u64);
                c.refusal(Some(&why), "extinction", || queries[0].to_string());
                // A table that would do must not be refused.
                let left = occlusion_across(&without_migration(yarn), extinction).err();
                let beyond = left.is_some_and(|left| left > 0.5 * OCCLUSION_LIMIT);
                c.demand(beyond, || format!("refused with an error of {left:?}"));
                c.row(GROUP, what, name, "no table is good enough: refused")
            }
        })
    }
}

/// Places of a yarn's outer circle in mm, every other one in a ply, with directions toward light.
fn inside(yarn: &YarnParams, count: u32) -> impl Iterator<Item = (DVec2, DVec2)> {
    let (radius, plies) = (yarn.outer_radius_mm(), Plies::new(yarn));
    (0..count).zip(places(count)).map(move |(index, (place, light))| {
        let turn = DVec2::from_angle(TAU * f64::from(index / 2 % plies.count) / f64::from(plies.count));
        let in_ply = turn.rotate(DVec2::new(plies.offset, 0.0) + plies.axes * place);
        (radius * if index % 2 == 0 { place } else { in_ply }, light)
    })
}

/// The yarn as a query knows it.
fn without_migration(yarn: &YarnParams) -> YarnParams {
    YarnParams { migration_min: 1.0, migration_max: 1.0, ..yarn.clone() }
}

/// Plies thinner than f32 has place for, in queries and in a scene's yarn.
fn too_thin(yarn: &YarnParams, shadow: &OnDevice, occlusion: &OnDevice) -> Row {
    let mut c = Collector::default();
    let least = yarn.outer_radius_mm() / MOST_THIN;
    for (thin, key) in [(0.7, "ellipse_short"), (1e-3, "ellipse_short"), (0.9, "ellipse_long")] {
        let mut yarn = yarn.clone();
        let axis =
            if key == "ellipse_short" { &mut yarn.ellipse_short_mm } else { &mut yarn.ellipse_long_mm };
        *axis = thin * least;
        let query = json!({"yarn": section(&yarn), "position": [0, 0], "light_angle": 0, "extinction": 1});
        let of_query = |side: &OnDevice| parse(side.function, &query.to_string()).err();
        let of_yarn = yarn.validate().err().map(|error| error.to_string());
        for why in [of_query(shadow), of_query(occlusion), of_yarn] {
            c.points(1);
            c.refusal(why.as_deref(), key, || query.to_string());
        }
    }
    c.row(GROUP, "plies too thin", "both half-axes", "1/1000 of the yarn's outer radius and up")
}

/// A preset's table of self-shadows as pictures read it, fibers migrating, which queries do not know.
fn drawn((name, yarn): &Named, count: u32) -> Row {
    let (table, section) = (bake_self_shadow(yarn, SelfShadowSize::default()), CrossSection::new(yarn));
    let read = |(place, toward): (DVec2, DVec2)| {
        let at = self_shadow_place(place, toward, yarn.ply_count, table.size);
        (self_shadow_depth(&table, at), exact_self_shadow_depth(&section, place, toward))
    };
    let all: Vec<(f64, f64)> = places(count).collect::<Vec<_>>().into_par_iter().map(read).collect();
    let swept = format!("{name} as drawn");
    pairs_row("self_shadow_depth", (&swept, "by place, with migration; read in f64"), &all, SELF_SHADOW_LIMIT)
}

fn section(yarn: &YarnParams) -> Value {
    json!({"ply_count": yarn.ply_count, "ply_offset": yarn.ply_offset_mm(), "ellipse_short": yarn.ellipse_short_mm,
        "ellipse_long": yarn.ellipse_long_mm, "beta": yarn.density_beta, "epsilon": yarn.density_epsilon})
}

fn table_row(
    what: &str,
    (name, promise): (&str, &str),
    queries: &[Value],
    (found, exact): (&[f64], &[f64]),
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
    let swept = format!("{across} texels");
    pairs_row(what, (&swept, "8 to 512, or 1024 for occlusion; read in f64"), pairs, limit)
}

fn pairs_row(what: &str, (swept, domain): (&str, &str), pairs: &[(f64, f64)], limit: TableError) -> Row {
    let (found, exact): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
    let range = exact.iter().copied().fold(0.0, f64::max);
    let mut c = Collector::default();
    for (index, (found, exact)) in pairs.iter().enumerate() {
        c.points(1);
        c.numbers(&[*found], false, || format!("place {index}"));
        c.error((found - exact).abs() / range, limit.worst, || format!("place {index}"));
    }
    judge_table(&mut c, &found, &exact, range, &limit);
    c.row(GROUP, what, swept, domain)
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
