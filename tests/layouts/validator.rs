//! Every embedded shader through Khronos' validator.

use std::io::Write;
use std::process::{Command, Stdio};
use worsted::shaders;

/// What `spirv-val` says of a module; `Ok` if it is valid.
fn validate(words: &[u32]) -> Result<(), String> {
    let mut child = Command::new("spirv-val")
        .args(["--target-env", "vulkan1.3", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("spirv-val runs (Debian package spirv-tools; tools/test installs it)");
    // A validator that gives up early closes its end; what it says then is the answer.
    let _ = child.stdin.take().expect("piped").write_all(bytemuck::cast_slice(words));
    let output = child.wait_with_output().expect("spirv-val ends");
    let said =
        format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    output.status.success().then_some(()).ok_or(said)
}

#[test]
fn every_embedded_shader_is_valid() {
    for (path, words) in shaders::all() {
        assert_eq!(validate(words), Ok(()), "{path}");
    }
}

#[test]
fn broken_modules_are_refused() {
    let words = shaders::get("passes/tonemap.comp").expect("embedded");
    let cut_short = &words[..words.len() - 3];
    let mut wrong_bound = words.to_vec();
    wrong_bound[3] = 1;
    for broken in [cut_short, &wrong_bound, &[], &[1, 2, 3]] {
        assert!(validate(broken).is_err(), "a broken module of {} words passed", broken.len());
    }
}
