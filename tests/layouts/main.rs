//! What the host and the shaders must agree on without a compiler between them: layouts of structs,
//! constants, bindings and push constants, read from the SPIR-V that is embedded.

#![expect(clippy::panic, reason = "the helpers of a test may fail it")]

mod constants;
#[path = "../support/device.rs"]
mod device;
mod edited;
mod interface;
mod reflection;
mod rust_side;
mod structs;
mod validator;

/// The text of a file of the repository.
fn text_of(path: &str) -> String {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
