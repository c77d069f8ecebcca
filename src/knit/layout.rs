//! Which control points of a swatch or a tube belong to which loop.

use super::params::KnitParams;

/// Control points of a loose end.
const TAIL_POINTS: u32 = 2;

/// The order of a serpentine swatch's control points: a tail, then course by course from the bottom,
/// even ones to the right and odd ones to the left, with a turn between two courses, then a tail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Number of courses.
    pub courses: u32,
    /// Number of wales.
    pub wales: u32,
    /// Control points of one loop.
    pub points_per_loop: u32,
    /// Control points of a turn.
    pub turn_points: u32,
    /// Control points of a loose end.
    pub tail_points: u32,
}

/// A place in a swatch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopPlace {
    /// The course, counted from 0 at the bottom.
    pub course: u32,
    /// The wale, counted from 0 at the left.
    pub wale: u32,
    /// Control points from the loop's head centre; to the right is positive whichever way the yarn runs.
    pub from_head: f64,
}

impl Layout {
    /// That of the swatch that [`super::stockinette::stockinette`] knits.
    pub fn new(params: &KnitParams) -> Self {
        let [wale, course] = params.spacing_diameters();
        // Peirce's loop length, 2 C + W + 5.94 diameters, says how many of a loop's points a half circle
        // from course to course deserves.
        let share = 0.5 * std::f64::consts::PI * course / (2.0 * course + wale + 5.94);
        let turn_points = (share * f64::from(params.points_per_loop)).round().max(4.0) as u32 - 1;
        let KnitParams { courses, wales, points_per_loop, .. } = *params;
        Self { courses, wales, points_per_loop, turn_points, tail_points: TAIL_POINTS }
    }

    /// Control points of one course: its loops from sinker to sinker, both ends included.
    pub fn course_points(&self) -> u64 {
        u64::from(self.wales) * u64::from(self.points_per_loop) + 1
    }

    /// Control points of the whole yarn (at most `u64::MAX`).
    pub fn point_count(&self) -> u64 {
        let courses = u64::from(self.courses);
        let turns = courses.saturating_sub(1) * u64::from(self.turn_points);
        courses.saturating_mul(self.course_points()).saturating_add(turns + 2 * u64::from(self.tail_points))
    }

    /// The loop at `parameter` (counted in control points); `None` on turns and tails.
    pub fn place(&self, parameter: f64) -> Option<LoopPlace> {
        let along = parameter - f64::from(self.tail_points);
        let period = (self.course_points() + u64::from(self.turn_points)) as f64;
        let course = (along / period).floor();
        let length = (self.course_points() - 1) as f64;
        let run = along - course * period;
        if along < 0.0 || course >= f64::from(self.courses) || run > length {
            return None;
        }
        let from_left = if course % 2.0 == 0.0 { run } else { length - run };
        let size = f64::from(self.points_per_loop);
        let wale = (from_left / size).floor().clamp(0.0, f64::from(self.wales) - 1.0);
        let from_head = from_left - (wale + 0.5) * size;
        Some(LoopPlace { course: course as u32, wale: wale as u32, from_head })
    }
}

/// The order of a tube's control points: one closed curve per course, from the bottom up, each from the
/// sinker before wale 0 around to where it began.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TubeLayout {
    /// Number of courses.
    pub courses: u32,
    /// Number of wales around the tube.
    pub wales: u32,
    /// Control points of one loop.
    pub points_per_loop: u32,
}

impl TubeLayout {
    /// That of the tube that [`super::tube::tube`] knits.
    pub fn new(params: &KnitParams) -> Self {
        let KnitParams { courses, wales, points_per_loop, .. } = *params;
        Self { courses, wales, points_per_loop }
    }

    /// Control points of one course.
    pub fn course_points(&self) -> u64 {
        u64::from(self.wales) * u64::from(self.points_per_loop)
    }

    /// Control points of the whole tube (at most `u64::MAX`).
    pub fn point_count(&self) -> u64 {
        u64::from(self.courses).saturating_mul(self.course_points())
    }

    /// The loop at `parameter` (counted in control points from the course's first) of a course. A second
    /// time around wales count on: the loop after the last one is number `wales`. `None` below 0 and above
    /// the last course.
    pub fn place(&self, course: usize, parameter: f64) -> Option<LoopPlace> {
        let course = u32::try_from(course).ok().filter(|course| *course < self.courses)?;
        let size = f64::from(self.points_per_loop);
        let wale = (parameter / size).floor();
        let from_head = parameter - (wale + 0.5) * size;
        (parameter >= 0.0).then_some(LoopPlace { course, wale: wale as u32, from_head })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_follow_the_serpentine() {
        let l = Layout { courses: 3, wales: 2, points_per_loop: 8, turn_points: 3, tail_points: 2 };
        assert_eq!(l.point_count(), 3 * 17 + 2 * 3 + 2 * 2);
        let at = |p: f64| l.place(p).map(|x| (x.course, x.wale, x.from_head));
        assert_eq!(at(1.9), None);
        assert_eq!(at(2.0), Some((0, 0, -4.0)));
        assert_eq!(at(6.5), Some((0, 0, 0.5)));
        assert_eq!(at(18.0), Some((0, 1, 4.0)));
        assert_eq!(at(19.0), None);
        // Course 1 starts after the turn and runs to the left.
        assert_eq!(at(22.0), Some((1, 1, 4.0)));
        assert_eq!(at(38.0), Some((1, 0, -4.0)));
        assert_eq!(at(42.0), Some((2, 0, -4.0)));
        assert_eq!(at(58.5), None);
        assert_eq!(at(500.0), None);
    }
    #[test]
    fn places_of_a_tube_go_around_it() {
        let l = TubeLayout { courses: 2, wales: 3, points_per_loop: 8 };
        assert_eq!((l.course_points(), l.point_count()), (24, 48));
        let at = |course: usize, p: f64| l.place(course, p).map(|x| (x.course, x.wale, x.from_head));
        assert_eq!(at(0, 0.0), Some((0, 0, -4.0)));
        assert_eq!(at(1, 21.5), Some((1, 2, 1.5)));
        assert_eq!(at(1, 25.0), Some((1, 3, -3.0)));
        assert_eq!(at(0, -0.5), None);
        assert_eq!(at(2, 1.0), None);
    }
}
