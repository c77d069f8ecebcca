//! Shaders that are edited while the window is open.

use crate::session::{Session, Shot};
use std::path::{Path, PathBuf};

const SIZE: [u32; 2] = [900, 640];
/// A place of the picture where cloth is, and one at its upper edge, where messages are.
const CLOTH: [u32; 2] = [480, 440];
const MESSAGE: [u32; 2] = [420, 60];
const TONEMAP: &str = "passes/tonemap.comp";

/// A copy of what the picture's last pass is made of: all other shaders are the build's own.
fn copied(folder: &Path) -> PathBuf {
    let shaders = folder.join("shaders");
    for path in [TONEMAP, "lib/tone.glsl"] {
        let to = shaders.join(path);
        std::fs::create_dir_all(to.parent().unwrap()).unwrap();
        std::fs::copy(Path::new("glsl").join(path), to).unwrap();
    }
    shaders
}

fn edit(shaders: &Path, from: &str, to: &str) {
    let path = shaders.join(TONEMAP);
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains(from), "{from}");
    std::fs::write(path, text.replace(from, to)).unwrap();
}

#[test]
fn edited_shaders_are_drawn_with_and_broken_ones_are_not() {
    let home = tempfile::tempdir().unwrap();
    let shaders = copied(home.path());
    let option = shaders.to_str().unwrap().to_owned();
    let mut session = Session::open(SIZE, &["--samples", "4", "--shaders", &option]);
    let first = session.until_settled();
    session.until_said("in place of this build's: none");
    let before = session.shot();
    assert!(before.is_varied(CLOTH, 60), "the cloth is shown");

    edit(&shaders, "vec4(encoded, alpha)", "vec4(encoded.bgr, alpha)");
    session.until_said("in place of this build's: passes/tonemap.comp");
    let drawn = session.until_settled();
    assert!(drawn.revision > first.revision);
    let swapped = session.shot();
    assert!(swapped.differing(&before, CLOTH, 60) > 0.9, "red is blue");

    // Broken, the picture stays, and the window says what the compiler does.
    edit(&shaders, "linear *= exposure_scale;", "linear *= exposure;");
    let said = session.until_said("not drawn with");
    assert!(said.contains("passes/tonemap.comp:27: 'exposure' : undeclared identifier"), "{said}");
    let broken = session.shot();
    assert_eq!(broken.differing(&swapped, CLOTH, 60), 0.0, "the picture stays");
    assert!(broken.differing(&swapped, MESSAGE, 20) > 0.5, "the message is over it");

    // Another interface is named likewise, and so is a folder that is gone.
    edit(&shaders, "linear *= exposure;", "linear *= exposure_scale;");
    edit(&shaders, "binding = 1, rgba8", "binding = 2, rgba8");
    assert!(session.until_said("not drawn with").contains("set 0, binding 2: expected none"));
    std::fs::remove_dir_all(&shaders).unwrap();
    session.until_said("expected a folder of shaders, found none");
    assert_eq!(session.shot().differing(&swapped, CLOTH, 60), 0.0);

    // As it was at first, to the byte.
    copied(home.path());
    session.until_said("in place of this build's: none");
    session.until_settled();
    let mended = session.shot();
    assert_same(&mended, &before);
    session.close();
}

/// Nothing differs, the message's place included.
fn assert_same(found: &Shot, expected: &Shot) {
    for at in [CLOTH, MESSAGE] {
        assert_eq!(found.differing(expected, at, 60), 0.0, "around {at:?}");
    }
}

#[test]
fn a_folder_that_is_not_there_is_said_before_a_window_opens() {
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_worsted"))
        .args(["view", "models/demo.toml", "--shaders", "nowhere"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert_eq!(said, "worsted: --shaders nowhere: expected a folder of shaders, found none\n");
}
