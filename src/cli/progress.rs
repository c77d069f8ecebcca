//! Bars with the time left, on a terminal only.

use super::args::Common;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;

/// Steps of a bar of shares.
const STEPS: f64 = 1000.0;

/// Whether a bar is to be seen.
fn is_shown(common: &Common) -> bool {
    !common.quiet && std::io::stderr().is_terminal()
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

/// A bar for [`set_share`].
pub fn share_bar(common: &Common) -> ProgressBar {
    if !is_shown(common) {
        return ProgressBar::hidden();
    }
    ProgressBar::new(STEPS as u64).with_style(style("{bar:40} {percent}% {elapsed} (left: {eta}) {msg}"))
}

/// Moves a [`share_bar`] to `share` of the whole, 0 to 1.
pub fn set_share(bar: &ProgressBar, share: f64) {
    bar.set_position((share * STEPS) as u64);
}

/// A bar that says what is done, or where nobody knows how much there is to do, a sign of life.
pub fn task_bar(common: &Common, doing: &'static str, length: Option<u64>) -> ProgressBar {
    if !is_shown(common) {
        return ProgressBar::hidden();
    }
    let (template, bar) = match length {
        Some(length) => ("{msg} {bar:40} {percent}% {elapsed} (left: {eta})", ProgressBar::new(length)),
        None => ("{msg} {spinner} {elapsed}", ProgressBar::new_spinner()),
    };
    let bar = bar.with_style(style(template)).with_message(doing);
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    bar
}
