//! Error against run time: scenes drawn by a grid of settings, each timed and compared with the traced reference.
//!
//! [`cloth`] and [`views`] say what is drawn, [`settings`] how, [`references`] keeps what it is compared with,
//! [`run`] goes through all of it and [`report`] holds what came out; [`page`] shows it. [`budget`] picks settings
//! from what was measured, which [`fronts`] keeps, and [`verify`] measures what they promised. [`ablate`] measures what
//! leaving something out saves.

pub mod ablate;
pub mod blame;
pub mod budget;
pub mod clock;
pub mod cloth;
pub mod fronts;
pub mod measure;
pub mod page;
pub mod references;
pub mod report;
pub mod run;
pub mod settings;
pub mod truth;
pub mod verify;
pub mod views;
pub mod work;

use crate::error::Error;
use crate::io::picture::LinearImage;
use crate::math::tone::Display;
use crate::metrics::error::{Comparison, compare};

/// The errors that the design quotes: on radiance at exposure 1, without a tone curve.
///
/// # Errors
/// Pictures that cannot be compared.
pub fn against(test: &LinearImage, reference: &LinearImage) -> Result<Comparison, Error> {
    compare(test, reference, &Display::PLAIN).map_err(|e| Error::Failed(e.to_string()))
}
