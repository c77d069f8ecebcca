//! Why a fabric cannot be made, as one line.

use thiserror::Error;

/// Knitting parameters that give no sound fabric: the parameter, what is allowed, what was found.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum KnitError {
    /// A value outside its range, or not a number.
    #[error("{name}: expected {expected}, found {found}")]
    Parameter {
        /// The parameter, spelled as the field is.
        name: &'static str,
        /// The allowed range.
        expected: String,
        /// The value at fault.
        found: String,
    },
    /// A gauge so tight that yarns of this thickness would enter each other.
    #[error(
        "{name}: expected at least {smallest_mm:.4} mm for yarn_radius_mm = {yarn_radius_mm}, below which \
         strands enter each other, found {found_mm}"
    )]
    TooTight {
        /// The spacing that has to grow.
        name: &'static str,
        /// The smallest allowed value, in millimetres.
        smallest_mm: f64,
        /// The value found, in millimetres.
        found_mm: f64,
        /// The yarn's outer radius, in millimetres.
        yarn_radius_mm: f64,
    },
    /// A gauge inside the allowed range that did not relax to a sound cloth.
    #[error(
        "wale_spacing_mm and course_spacing_mm: no sound cloth at {wale_spacing_mm:.4} by \
         {course_spacing_mm:.4} mm ({reason}); raise both"
    )]
    Unsound {
        /// The wale spacing, in millimetres.
        wale_spacing_mm: f64,
        /// The course spacing, in millimetres.
        course_spacing_mm: f64,
        /// What is wrong with it, without line breaks.
        reason: String,
    },
}
