//! What several test binaries share.

// Each test binary compiles this module for itself and uses only some of it.
#[allow(dead_code)]
pub mod golden;
