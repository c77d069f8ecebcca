//! What to knit: size, spacings, yarn thickness and detail, checked alike for every pattern made of one loop.

use super::error::KnitError;
use super::unit_cell::{ARC_SKIP, UnitCell, unit_cell};

/// Allowed wale spacing, in yarn diameters.
const WALE_DIAMETERS: [f64; 2] = [4.15, 6.5];
/// Allowed course spacing, in yarn diameters.
const COURSE_DIAMETERS: [f64; 2] = [2.2, 4.5];
/// Wale and course spacing where none is given, in yarn diameters.
const DEFAULT_DIAMETERS: [f64; 2] = [4.2, 2.9];
/// Outer radii of real yarns lie well inside, in millimetres.
const RADIUS_MM: [f64; 2] = [0.001, 1000.0];
/// Fewer control points cut the bends off, more only cost.
const POINTS_PER_LOOP: [u32; 2] = [16, 64];
/// Control points of a whole fabric: 400 MB of them.
const MOST_POINTS: u64 = 1 << 24;
/// A spacing short of its limit by no more than this part of it is taken as the limit itself.
const ROUNDING: f64 = 1e-9;

/// What to knit, whatever the pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnitParams {
    /// Rows, or rounds, of loops: at least 1.
    pub courses: u32,
    /// Loops of a course: at least 1, around a tube at least 10.
    pub wales: u32,
    /// The yarn's OUTER radius in millimetres, 0.001 to 1000: strands keep twice that apart.
    pub yarn_radius_mm: f64,
    /// Distance between loops of a course, along a tube's inside: 4.15 to 6.5 yarn diameters; 4.2 where not
    /// given.
    pub wale_spacing_mm: Option<f64>,
    /// Distance between courses, 2.2 to 4.5 yarn diameters; 2.9 where not given.
    pub course_spacing_mm: Option<f64>,
    /// Control points of one loop: a multiple of 4 from 16 to 64.
    pub points_per_loop: u32,
}

/// Refuses a value outside `[low, high]`, NaN included.
fn check_range(name: &'static str, value: f64, [low, high]: [f64; 2], unit: &str) -> Result<(), KnitError> {
    if value >= low * (1.0 - ROUNDING) && value <= high * (1.0 + ROUNDING) {
        return Ok(());
    }
    let expected = format!("{low} to {high} {unit}");
    Err(KnitError::Parameter { name, expected, found: format!("{value}") })
}

/// Refuses fewer courses or wales than the least.
fn check_count(name: &'static str, count: u32, least: u32) -> Result<(), KnitError> {
    if count >= least {
        return Ok(());
    }
    Err(KnitError::Parameter { name, expected: format!("at least {least}"), found: count.to_string() })
}

impl KnitParams {
    /// A flat swatch: 12 courses of 10 loops in yarn of 0.75 mm outer radius, 20 points a loop (1.5 radii
    /// apart).
    pub const fn swatch() -> Self {
        Self {
            courses: 12,
            wales: 10,
            yarn_radius_mm: 0.75,
            wale_spacing_mm: None,
            course_spacing_mm: None,
            points_per_loop: 20,
        }
    }

    /// A tube: 16 courses of 24 loops, otherwise as [`KnitParams::swatch`].
    pub const fn tube() -> Self {
        Self { courses: 16, wales: 24, ..Self::swatch() }
    }

    /// Checks every value against its range; the least courses and wales are the pattern's.
    pub(crate) fn validate(&self, [least_courses, least_wales]: [u32; 2]) -> Result<(), KnitError> {
        check_count("courses", self.courses, least_courses)?;
        check_count("wales", self.wales, least_wales)?;
        let [least, most] = POINTS_PER_LOOP;
        check_range("yarn_radius_mm", self.yarn_radius_mm, RADIUS_MM, "mm")?;
        if !(least..=most).contains(&self.points_per_loop) || !self.points_per_loop.is_multiple_of(4) {
            return Err(KnitError::Parameter {
                name: "points_per_loop",
                expected: format!("a multiple of 4 from {least} to {most}"),
                found: self.points_per_loop.to_string(),
            });
        }
        self.check_spacing("wale_spacing_mm", self.wale_spacing_mm, WALE_DIAMETERS)?;
        self.check_spacing("course_spacing_mm", self.course_spacing_mm, COURSE_DIAMETERS)
    }

    /// Refuses a fabric of more control points than memory is meant for; `fabric` names it.
    pub(crate) fn check_size(&self, points: u64, fabric: &str) -> Result<(), KnitError> {
        if points <= MOST_POINTS {
            return Ok(());
        }
        let Self { courses, wales, .. } = self;
        Err(KnitError::Parameter {
            name: "courses and wales",
            expected: format!("a {fabric} of at most {MOST_POINTS} control points"),
            found: format!("{courses} courses of {wales} loops, {points} control points"),
        })
    }

    /// Refuses a spacing outside its range of yarn diameters.
    fn check_spacing(
        &self,
        name: &'static str,
        mm: Option<f64>,
        diameters: [f64; 2],
    ) -> Result<(), KnitError> {
        let Some(found_mm) = mm else { return Ok(()) };
        let range_mm = diameters.map(|d| d * self.diameter_mm());
        if found_mm < range_mm[0] * (1.0 - ROUNDING) {
            let (smallest_mm, yarn_radius_mm) = (range_mm[0], self.yarn_radius_mm);
            return Err(KnitError::TooTight { name, smallest_mm, found_mm, yarn_radius_mm });
        }
        check_range(name, found_mm, range_mm, &format!("mm at yarn_radius_mm = {}", self.yarn_radius_mm))
    }

    /// The yarn's outer diameter.
    pub(crate) fn diameter_mm(&self) -> f64 {
        2.0 * self.yarn_radius_mm
    }

    /// Wale and course spacing in yarn diameters, defaults filled in.
    pub(crate) fn spacing_diameters(&self) -> [f64; 2] {
        let [wale, course] = DEFAULT_DIAMETERS;
        let of = |mm: Option<f64>, default| mm.map_or(default, |mm| mm / self.diameter_mm());
        [of(self.wale_spacing_mm, wale), of(self.course_spacing_mm, course)]
    }

    /// Wale and course spacing in millimetres, defaults filled in.
    pub fn spacing_mm(&self) -> [f64; 2] {
        self.spacing_diameters().map(|d| d * self.diameter_mm())
    }

    /// Arc length along the yarn, in millimetres, within which two places are neighbours and not
    /// distinct strands: what [`super::clearance::min_clearance`] should skip.
    pub fn arc_skip_mm(&self) -> f64 {
        ARC_SKIP * self.diameter_mm()
    }

    /// The relaxed loop, which may be unsound: see [`UnitCell::is_sound`].
    pub(crate) fn cell(&self) -> UnitCell {
        let [wale, course] = self.spacing_diameters();
        unit_cell(wale, course, self.points_per_loop as usize / 4)
    }

    /// The error for a gauge whose cloth is not what it should be.
    pub(crate) fn unsound(&self, reason: String) -> KnitError {
        let [wale_spacing_mm, course_spacing_mm] = self.spacing_mm();
        KnitError::Unsound { wale_spacing_mm, course_spacing_mm, reason }
    }

    /// The same where strands come too close to each other.
    pub(crate) fn too_close(&self, clearance_diameters: f64) -> KnitError {
        self.unsound(format!("strands come within {clearance_diameters:.4} yarn diameters of each other"))
    }
}
