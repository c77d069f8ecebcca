//! Generated fabrics as scene files, so that overrides are read and checked as those of `worsted render` are.

use crate::error::Error;
use crate::io::bcc::write_bcc;
use crate::io::curves::{Basis, Curve, CurveSet};
use crate::io::error::FileError;
use crate::knit::params::KnitParams;
use crate::knit::stockinette::stockinette;
use crate::knit::tube::{inner_radius_mm, tube};
use crate::scene::file::{FabricTable, SceneFile};
use crate::yarn::params::YarnParams;
use crate::yarn::presets;
use glam::DVec3;
use std::path::{Path, PathBuf};

/// How far from the middle of a fabric its front is looked for, in yarn diameters: over half a loop.
const FRONT_DIAMETERS: f64 = 2.5;
/// Wales and courses of a sweater's body and of each of its sleeves: a doll's, since a reference holds every
/// fiber in memory.
const BODY: [u32; 2] = [24, 20];
const SLEEVE: [u32; 2] = [10, 16];
/// Between body and sleeves, in yarn diameters.
const SLEEVE_GAP: f64 = 4.0;
/// Between wales and between courses of loose cloth, in yarn diameters.
const LOOSE: [f64; 2] = [5.4, 3.8];

/// Generated fabric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cloth {
    /// A flat swatch.
    Stockinette {
        /// Loops of a row.
        wales: u32,
        /// Rows of loops.
        courses: u32,
    },
    /// A flat swatch of looser loops, which light goes through.
    Loose {
        /// Loops of a row.
        wales: u32,
        /// Rows of loops.
        courses: u32,
    },
    /// Knit in the round.
    Tube {
        /// Loops around.
        wales: u32,
        /// Rounds of loops.
        courses: u32,
    },
    /// A tube with a sleeve hanging on either side; nothing sews them on.
    Sweater,
    /// One straight yarn, which nothing but its own fibers shadows.
    Straight,
}

impl Cloth {
    /// Its pattern's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stockinette { .. } => "stockinette",
            Self::Loose { .. } => "loose-stockinette",
            Self::Tube { .. } => "tube",
            Self::Sweater => "sweater",
            Self::Straight => "straight-yarn",
        }
    }

    /// Its centre lines in mm, in a yarn of this outer radius.
    ///
    /// # Errors
    /// Fabric that cannot be knitted.
    pub fn knit(self, yarn_radius_mm: f64) -> Result<CurveSet, Error> {
        let flat = |wales, courses| KnitParams { wales, courses, yarn_radius_mm, ..KnitParams::swatch() };
        let round =
            |[wales, courses]: [u32; 2]| KnitParams { wales, courses, yarn_radius_mm, ..KnitParams::tube() };
        Ok(match self {
            Self::Stockinette { wales, courses } => stockinette(&flat(wales, courses))?,
            Self::Loose { wales, courses } => {
                let [wale_spacing_mm, course_spacing_mm] =
                    LOOSE.map(|diameters| Some(diameters * 2.0 * yarn_radius_mm));
                stockinette(&KnitParams { wale_spacing_mm, course_spacing_mm, ..flat(wales, courses) })?
            }
            Self::Tube { wales, courses } => tube(&round([wales, courses]))?,
            Self::Sweater => {
                let (body, sleeve) = (round(BODY), round(SLEEVE));
                let aside_mm =
                    inner_radius_mm(&body) + inner_radius_mm(&sleeve) + 2.0 * SLEEVE_GAP * yarn_radius_mm;
                let mut all = tube(&body)?;
                for x_mm in [-aside_mm, aside_mm] {
                    let mut hanging = tube(&sleeve)?;
                    let shift = DVec3::new(x_mm, top_mm(&all) - top_mm(&hanging), 0.0);
                    hanging.curves.iter_mut().flat_map(|c| &mut c.points).for_each(|p| *p += shift);
                    all.curves.append(&mut hanging.curves);
                }
                all
            }
            Self::Straight => straight(yarn_radius_mm),
        })
    }
}

/// Along X, longer than any close view is wide.
fn straight(yarn_radius_mm: f64) -> CurveSet {
    let points = (-100..=100).map(|i| DVec3::new(f64::from(i) * yarn_radius_mm, 0.0, 0.0)).collect();
    let curve = Curve { points, closed: false };
    CurveSet { basis: Basis::CatmullRom, up_axis: None, curves: vec![curve] }
}

/// Height of the topmost centre line.
fn top_mm(set: &CurveSet) -> f64 {
    let heights = set.curves.iter().flat_map(|curve| &curve.points).map(|p| p.y);
    heights.fold(f64::NEG_INFINITY, f64::max)
}

/// A fabric as a scene file.
pub struct Model {
    /// The scene file.
    pub path: PathBuf,
    /// Its yarn.
    pub yarn: YarnParams,
    /// Height in mm of the fabric's front above the plane through its middle, along +Z.
    pub front_mm: f64,
    /// Largest distance in mm of a centre line from the Y axis.
    pub reach_mm: f64,
}

impl Model {
    /// Knits `cloth` in the preset `yarn`, at that yarn's own outer radius, with fibers as `fiber` says, and writes
    /// it to `folder`.
    ///
    /// # Errors
    /// No such preset; files that cannot be written.
    pub fn write(folder: &Path, yarn: &str, cloth: Cloth, fiber: toml::Table) -> Result<Self, Error> {
        let params =
            presets::yarn(yarn).ok_or_else(|| Error::Arguments(format!("no yarn preset `{yarn}`")))?;
        let curves = cloth.knit(params.outer_radius_mm())?;
        let points = || curves.curves.iter().flat_map(|curve| &curve.points);
        let near_mm = FRONT_DIAMETERS * 2.0 * params.outer_radius_mm();
        let in_the_middle = points().filter(|p| p.x.abs() < near_mm && p.y.abs() < near_mm);
        let front_mm = in_the_middle.fold(0.0, |most: f64, p| most.max(p.z)) + params.outer_radius_mm();
        let reach_mm = points().fold(0.0, |most: f64, p| most.max(p.x.hypot(p.z)));

        let model = format!("{yarn}-{}.bcc", cloth.name());
        write_bcc(&folder.join(&model), &curves)?;
        let mut file = SceneFile { fiber, ..Default::default() };
        file.yarn.insert("preset".into(), yarn.into());
        file.fabric = vec![FabricTable { model, mm_per_unit: Some(1.0), ..Default::default() }];
        let text = toml::to_string(&file).map_err(|e| Error::Failed(format!("scene file: {e}")))?;
        let path = folder.join(format!("{yarn}-{}.toml", cloth.name()));
        std::fs::write(&path, text).map_err(|e| FileError::io(&path, "write", &e))?;
        Ok(Self { path, yarn: params, front_mm, reach_mm })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sleeves_hang_beside_the_body_and_touch_nothing() {
        let radius_mm = 0.75;
        let sweater = Cloth::Sweater.knit(radius_mm).unwrap();
        let [courses, sleeve] = [BODY[1] as usize, SLEEVE[1] as usize];
        assert_eq!(sweater.curves.len(), courses + 2 * sleeve);
        let reach = |curves: &[crate::io::curves::Curve]| {
            let xs = || curves.iter().flat_map(|curve| &curve.points).map(|p| p.x);
            [xs().fold(f64::INFINITY, f64::min), xs().fold(f64::NEG_INFINITY, f64::max)]
        };
        let body = reach(&sweater.curves[..courses]);
        let left = reach(&sweater.curves[courses..courses + sleeve]);
        let right = reach(&sweater.curves[courses + sleeve..]);
        assert!(left[1] + 2.0 * radius_mm < body[0] && body[1] + 2.0 * radius_mm < right[0]);
    }
}
