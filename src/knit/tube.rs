//! Stockinette knit in the round: a tube of closed courses.
//!
//! The relaxed loop of the flat cloth (`unit_cell.rs`) is rolled about the Y axis, technical face outward.
//! Every course is one closed curve. (A knitter's tube is one helix; closed courses have no step at the
//! seam, and stand for rounds as they are in garments.)
//!
//! Radius. Rolling keeps heights and distances from the face, so that only distances around the tube change.
//! The innermost centre lines lie at the radius at which two places that are one yarn diameter apart in the
//! flat cloth are so on the tube as well, measured straight: `1 / (2 sin(pi / n))` diameters for a course
//! of n diameters. There, neighbouring wales are a little over their flat spacing apart; everything
//! farther out is stretched in proportion to its radius. A chord as a share of its arc falls with the
//! arc, so that nearer places are no closer than they were and farther ones are no nearer than a diameter:
//! no strands enter each other that did not in the flat cloth, however few wales there are.
//!
//! What limits their number is how tightly the yarn bends where it rounds the tube's inside: no tighter than
//! 1.1 of its radii, as in the flat cloth and as the clearance check relies on. 10 wales keep that at
//! every gauge, 8 do not.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::io::curves::{Basis, Curve, CurveSet, UpAxis};

use super::clearance::min_clearance;
use super::error::KnitError;
use super::layout::TubeLayout;
use super::params::KnitParams;
use super::stockinette::KEPT_DISTANCE;
use super::unit_cell::{ARC_SKIP, UnitCell};
use super::unrolled::check_patch;

/// Fewest courses and wales: see the top of this file.
const LEAST_COUNTS: [u32; 2] = [1, 10];
/// Courses and wales of the part that is checked: every kind of neighbour of a stitch.
const CHECKED: [u32; 2] = [4, 6];

/// Knits the tube: one closed Catmull-Rom curve per course, from the bottom up, in millimetres, Y up,
/// centred at the origin. Seen from above, courses run counter-clockwise; they begin opposite +Z.
///
/// # Errors
/// The first parameter outside its range, with the range in millimetres at this yarn radius, and
/// [`KnitError::Unsound`] should a gauge inside the allowed range fail to give a tube whose strands keep
/// clear of each other.
pub fn tube(params: &KnitParams) -> Result<CurveSet, KnitError> {
    params.validate(LEAST_COUNTS)?;
    let whole = TubeLayout::new(params);
    params.check_size(whole.point_count(), "tube")?;
    let cell = params.cell();
    if !cell.is_sound() {
        return Err(params.too_close(cell.clearance));
    }
    let roll = Roll::new(&cell, params.wales);
    check(&cell, &roll, &whole, params)?;
    let mut curves = rounds(&cell, &roll, &whole, true);
    for curve in &mut curves.curves {
        curve.points.iter_mut().for_each(|p| *p *= params.diameter_mm());
    }
    Ok(curves)
}

/// Distance of the innermost centre lines of a tube from its axis, in millimetres.
pub fn inner_radius_mm(params: &KnitParams) -> f64 {
    let [wale, _] = params.spacing_diameters();
    inner_radius(params.wales, wale) * params.diameter_mm()
}

/// The same with lengths in yarn diameters.
fn inner_radius(wales: u32, wale_spacing: f64) -> f64 {
    0.5 / (PI / (f64::from(wales) * wale_spacing)).sin()
}

/// Takes the flat cloth to the tube; lengths in yarn diameters.
struct Roll {
    /// Angle about the axis per diameter along a course.
    radians_per_diameter: f64,
    /// Distance from the axis of the flat cloth's z = 0.
    radius: f64,
}

impl Roll {
    fn new(cell: &UnitCell, wales: u32) -> Self {
        let innermost = cell.quarter.iter().fold(f64::INFINITY, |low, p| low.min(p.z));
        Self {
            radians_per_diameter: TAU / (f64::from(wales) * cell.wale_spacing),
            radius: inner_radius(wales, cell.wale_spacing) - innermost,
        }
    }

    /// Where a point of the flat cloth lies; that at x = 0 faces +Z.
    fn at(&self, flat: DVec3) -> DVec3 {
        let (sin, cos) = (flat.x * self.radians_per_diameter).sin_cos();
        let radius = self.radius + flat.z;
        DVec3::new(radius * sin, flat.y, radius * cos)
    }
}

/// The courses of `layout` on the roll, in yarn diameters, centred; `closed` where its wales go all around.
fn rounds(cell: &UnitCell, roll: &Roll, layout: &TubeLayout, closed: bool) -> CurveSet {
    let to_middle = DVec3::new(
        0.5 * f64::from(layout.wales - 1) * cell.wale_spacing,
        0.5 * f64::from(layout.courses - 1) * cell.course_spacing,
        0.0,
    );
    let first = -i64::from(layout.points_per_loop / 2);
    let count = layout.course_points() as i64 + i64::from(!closed);
    let course = |course: i64| Curve {
        points: (first..first + count).map(|i| roll.at(cell.point(course, i) - to_middle)).collect(),
        closed,
    };
    let curves = (0..i64::from(layout.courses)).map(course).collect();
    CurveSet { basis: Basis::CatmullRom, up_axis: Some(UpAxis::Y), curves }
}

/// Refuses a tube whose strands come too close or do not knit, judged by a part of it as everything
/// repeats around the axis and along it.
fn check(cell: &UnitCell, roll: &Roll, whole: &TubeLayout, params: &KnitParams) -> Result<(), KnitError> {
    let [courses, wales] = CHECKED;
    let part = TubeLayout { courses: whole.courses.min(courses), wales: whole.wales.min(wales), ..*whole };
    let sample = rounds(cell, roll, &part, part.wales == whole.wales);
    if let Some(clearance) = min_clearance(&sample, ARC_SKIP).filter(|c| c.distance < KEPT_DISTANCE) {
        return Err(params.too_close(clearance.distance));
    }
    check_patch(&sample, &part).map_err(|fault| params.unsound(fault.to_string()))
}
