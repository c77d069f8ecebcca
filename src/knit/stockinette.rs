//! Stockinette (plain jersey) knit flat from one serpentine yarn.
//!
//! One loop of the endless cloth is relaxed until its strands rest on each other (`unit_cell.rs`), half
//! circles join the courses at the edges (`selvedge.rs`), and a swatch of any size repeats the two. The
//! cloth lies in the XY plane, courses along X and wales along Y, centred at the origin, its technical face
//! (the V stitches) toward +Z. The last course is off the needle, not bound off, as the first is not cast
//! on.
//!
//! Gauge. A loop that just touches itself and its neighbours needs about 4.1 yarn diameters from wale to
//! wale and 2.2 from course to course, whatever the other spacing is: Peirce's jammed cloth of round
//! yarn has four strands side by side, 4 diameters (F. T. Peirce, "Geometrical principles applicable to
//! the design of functional fabrics", Textile Research Journal 17, 1947). The default of 4.2 by 2.9
//! diameters is close to that limit, so that little shows through, and its loop of about 15 diameters
//! gives Munden's products loop length / course spacing = 5.2 and loop length / wale spacing = 3.6, where
//! relaxed wool jersey measures 5.0 to 5.3 and 3.8 to 4.1 (D. L. Munden, "The geometry and dimensional
//! properties of plain-knit fabrics", Journal of the Textile Institute 50, 1959).

use glam::DVec3;

use crate::io::curves::{Basis, Curve, CurveSet, UpAxis};

use super::error::KnitError;
use super::interlock::check_interlock;
use super::layout::Layout;
use super::params::KnitParams;
use super::selvedge::{Turn, turn};
use super::unit_cell::UnitCell;

/// Centre lines keep at least this part of two yarn radii from each other.
pub const KEPT_DISTANCE: f64 = 0.995;

/// Fewest courses and wales.
const LEAST_COUNTS: [u32; 2] = [1, 1];

/// Knits the swatch: one open Catmull-Rom curve in millimetres, Y up.
///
/// # Errors
/// The first parameter outside its range, with the range in millimetres at this yarn radius, and
/// [`KnitError::Unsound`] should a gauge inside the allowed range fail to relax to a cloth whose strands
/// keep clear of each other.
pub fn stockinette(params: &KnitParams) -> Result<CurveSet, KnitError> {
    params.validate(LEAST_COUNTS)?;
    let layout = Layout::new(params);
    params.check_size(layout.point_count(), "swatch")?;
    let cell = params.cell();
    let turn = turn(&cell, layout.turn_points as usize);
    if !(cell.is_sound() && turn.is_sound()) {
        return Err(params.too_close(cell.clearance.min(turn.clearance)));
    }
    // A corner of the swatch holds every kind of stitch and turn.
    let corner = Layout { courses: layout.courses.min(4), wales: layout.wales.min(3), ..layout };
    let sample = one_yarn(swatch(&cell, &turn, &corner));
    check_interlock(&sample, &corner).map_err(|fault| params.unsound(fault.to_string()))?;
    let mut points = swatch(&cell, &turn, &layout);
    points.iter_mut().for_each(|p| *p *= params.diameter_mm());
    Ok(one_yarn(points))
}

fn one_yarn(points: Vec<DVec3>) -> CurveSet {
    let curves = vec![Curve { points, closed: false }];
    CurveSet { basis: Basis::CatmullRom, up_axis: Some(UpAxis::Y), curves }
}

/// The control points of a whole swatch in yarn diameters, centred, in the layout's order.
fn swatch(cell: &UnitCell, turn: &Turn, layout: &Layout) -> Vec<DVec3> {
    let last_wale = f64::from(layout.wales - 1) * cell.wale_spacing;
    let left = -i64::from(layout.points_per_loop / 2);
    let right = left + layout.course_points() as i64 - 1;
    let mut points = Vec::with_capacity(layout.point_count() as usize);
    for course in 0..i64::from(layout.courses) {
        let rightward = course % 2 == 0;
        if rightward {
            points.extend((left..=right).map(|i| cell.point(course, i)));
        } else {
            points.extend((left..=right).rev().map(|i| cell.point(course, i)));
        }
        if course + 1 < i64::from(layout.courses) {
            let lift = course as f64 * cell.course_spacing;
            points.extend(turn.points.iter().map(|p| {
                // The cloth is its own mirror image, and so is the turn at the left edge.
                DVec3::new(if rightward { last_wale + p.x } else { -p.x }, p.y + lift, p.z)
            }));
        }
    }
    let step = cell.loop_length() / f64::from(layout.points_per_loop);
    let outward = if layout.courses % 2 == 1 { step } else { -step };
    let tail =
        |from: DVec3, step: f64| (1..=layout.tail_points).map(move |k| from + DVec3::X * step * f64::from(k));
    let before: Vec<DVec3> = points.first().map_or(Vec::new(), |&p| tail(p, -step).collect());
    let after: Vec<DVec3> = points.last().map_or(Vec::new(), |&p| tail(p, outward).collect());
    let height = f64::from(layout.courses - 1) * cell.course_spacing;
    let centre = 0.5 * DVec3::new(last_wale, height, 0.0);
    before.into_iter().rev().chain(points).chain(after).map(|p| p - centre).collect()
}
