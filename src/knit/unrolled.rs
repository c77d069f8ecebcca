//! Whether a tube really is knitted: its crossings seen from the axis outward, all around it.
//!
//! Angle, height and distance from the axis of a tube are the x, y and z of a flat cloth whose technical
//! face looks along +z, so that one check serves both.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::io::curves::CurveSet;

use super::fine::{OnYarn, chains};
use super::interlock::{CHORDS, InterlockFault, check_stitches, chords, crossings};
use super::layout::TubeLayout;

/// Checks that every loop of a tube about the Y axis is a knit stitch in the loop below it and that nothing
/// else crosses, as [`super::interlock::check_interlock`] does; every course has to be one closed curve
/// that goes around the axis once.
pub fn check_tube_interlock(curves: &CurveSet, layout: &TubeLayout) -> Result<(), InterlockFault> {
    let expected = "one closed curve per course";
    let fault = |course: usize, found: String| {
        Err(InterlockFault { course: course as u32, wale: 0, expected, found })
    };
    if curves.curves.len() as u64 != u64::from(layout.courses) {
        return fault(0, format!("{} curves for {} courses", curves.curves.len(), layout.courses));
    }
    for (course, curve) in curves.curves.iter().enumerate() {
        if !curve.closed || curve.points.len() as u64 != layout.course_points() {
            let ends = if curve.closed { "a closed" } else { "an open" };
            return fault(course, format!("{ends} one of {} control points", curve.points.len()));
        }
    }
    check_patch(curves, layout)
}

/// The same for a part of a tube, whose courses may be open.
pub(crate) fn check_patch(curves: &CurveSet, layout: &TubeLayout) -> Result<(), InterlockFault> {
    let place = |at: &OnYarn| layout.place(at.curve, at.parameter);
    check_stitches(&crossings(&unrolled(curves, layout)?), [layout.courses, layout.wales], place)
}

/// A course being unrolled.
struct Course {
    curve: usize,
    /// Where the last point lay, and its angle counted on beyond whole turns.
    last: DVec3,
    angle: f64,
    first_angle: f64,
}

/// The angle about the Y axis by which `to` lies farther than `from`, in [-pi, pi].
fn angle_between(from: DVec3, to: DVec3) -> f64 {
    (to.x * from.z - to.z * from.x).atan2(to.x * from.x + to.z * from.z)
}

impl Course {
    /// Starts where the curve does, within half a turn of angle 0 or of where the course before started.
    fn new(curve: usize, first: DVec3, before: Option<(DVec3, f64)>) -> Self {
        let (from, angle) = before.unwrap_or((DVec3::Z, 0.0));
        let angle = angle + angle_between(from, first);
        Self { curve, last: first, angle, first_angle: angle }
    }

    /// The flat place of the next point.
    fn unroll(&mut self, at: &OnYarn) -> OnYarn {
        self.angle += angle_between(self.last, at.position);
        self.last = at.position;
        let radius = at.position.x.hypot(at.position.z);
        OnYarn { position: DVec3::new(self.angle, at.position.y, radius), ..*at }
    }

    /// Refuses a closed course that did not go around once.
    fn check_once_around(&self) -> Result<(), InterlockFault> {
        let turns = (self.angle - self.first_angle) / TAU;
        // Written so that a NaN is refused too.
        if (turns - 1.0).abs() < 1e-6 {
            return Ok(());
        }
        let expected = "a course that goes around the tube once";
        let found = format!("one that goes around {turns:.3} times");
        Err(InterlockFault { course: self.curve as u32, wale: 0, expected, found })
    }
}

/// The chords of every course, unrolled: x is the angle about the axis, y the height, z the distance from
/// the axis. A closed course goes on with its first wale, so that crossings at the seam are seen.
fn unrolled(curves: &CurveSet, layout: &TubeLayout) -> Result<Vec<[OnYarn; 2]>, InterlockFault> {
    let mut flat: Vec<[OnYarn; 2]> = Vec::new();
    let mut course: Option<Course> = None;
    let mut start: Option<(DVec3, f64)> = None;
    let is_closed = |index: usize| curves.curves.get(index).is_some_and(|c| c.closed);
    for chain in chains(curves, CHORDS) {
        let Some(first) = chain.points.first() else { continue };
        if course.as_ref().is_none_or(|c| c.curve != first.curve) {
            if let Some(done) = course.filter(|c| is_closed(c.curve)) {
                done.check_once_around()?;
            }
            let begun = Course::new(first.curve, first.position, start);
            start = Some((first.position, begun.angle));
            course = Some(begun);
        }
        if let Some(course) = &mut course {
            flat.extend(chords(&chain).map(|chord| chord.map(|at| course.unroll(&at))));
        }
    }
    if let Some(done) = course.filter(|c| is_closed(c.curve)) {
        done.check_once_around()?;
    }
    let around = |at: &OnYarn| OnYarn {
        parameter: at.parameter + layout.course_points() as f64,
        position: at.position + DVec3::X * TAU,
        ..*at
    };
    let first_wale = |[from, _]: &&[OnYarn; 2]| {
        is_closed(from.curve) && from.parameter < f64::from(layout.points_per_loop)
    };
    let seam: Vec<[OnYarn; 2]> =
        flat.iter().filter(first_wale).map(|[from, to]| [around(from), around(to)]).collect();
    flat.extend(seam);
    Ok(flat)
}
