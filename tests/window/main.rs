//! `worsted view` in a real window: an X server without a screen, and input as a user gives it.
//!
//! What the window shows is read off the server; what the painter drew, and of what, off the log that `-v` writes.
#![expect(clippy::unwrap_used, clippy::panic, reason = "the helpers of a test may fail it")]
#![cfg(feature = "viewer")]

mod desktop;
mod moving;
#[cfg(feature = "hot-reload")]
mod reload;
mod session;

use session::{Session, Shot};
use std::path::Path;
use std::process::Command;
use worsted::io::picture::{DisplayImage, read_png, write_png};
use worsted::metrics::coverage::Coverage;
use worsted::metrics::flip::FlipMap;

/// Size of the window at first, and after it was resized, in pixels.
const SIZE: [u32; 2] = [900, 640];
const LARGER: [u32; 2] = [1000, 700];
/// Where parameters are searched for, and where the only row that is found for [`SEARCHED`] has its number.
const SEARCH: [u32; 2] = [150, 55];
const SEARCHED: &str = "hair density";
const NUMBER: [u32; 2] = [244, 107];
/// Width of the panel beside the picture.
const PANEL: u32 = 340;
/// A place of the picture.
const MIDDLE: [u32; 2] = [500, 350];

#[test]
fn a_window_opens_is_edited_dragged_resized_and_closed() {
    let mut session = Session::open(SIZE, &["--samples", "4"]);
    let first = session.until_settled();
    assert!(first.settled);
    let before = session.shot();
    assert!(before.is_varied(MIDDLE, 60), "the cloth is shown");

    // A drag of the picture turns the camera, and only that.
    session.drag(MIDDLE, [MIDDLE[0] + 60, MIDDLE[1] + 10]);
    let turned = session.until_settled();
    assert!(
        turned.revision > first.revision && turned.small > 0,
        "small pictures come while it is dragged: {turned:?}"
    );
    let after_drag = session.shot();
    assert!(after_drag.differing(&before, MIDDLE, 150) > 0.2, "the cloth turned");

    // A value is searched for and typed.
    session.click(SEARCH);
    session.type_text(SEARCHED);
    session.settle_ui();
    session.click(NUMBER);
    session.press("ctrl+a");
    session.type_text("30");
    session.press("Return");
    let edited = session.until_settled();
    assert!(edited.revision > turned.revision, "an edit is drawn");
    let after_edit = session.shot();
    assert!(after_edit.differing(&after_drag, MIDDLE, 150) > 0.1, "hairs are seen");

    // Undone, the picture is the one before, to the byte.
    session.click(MIDDLE);
    session.press("ctrl+z");
    session.until_settled();
    assert_eq!(session.shot().differing(&after_drag, MIDDLE, 150), 0.0, "what is undone leaves no trace");

    // Saved, the scene is what `render` draws the same picture from.
    session.press("ctrl+y");
    let edited = session.until_settled();
    session.press("ctrl+s");
    session.wait_for_words();
    let scene = std::fs::read_to_string(&session.scene).unwrap();
    assert!(scene.contains("hair_density_per_mm = 30") && scene.contains("# The README's demo"), "{scene}");
    let rendered = rendered(&session.scene, edited.size);
    let seen = session.shot().cut(PANEL, edited.size);
    let everywhere = Coverage::everywhere(seen.pixels.len()).unwrap();
    let (flip, _) = FlipMap::new(&seen, &rendered).unwrap().mean_and_max(&everywhere).unwrap();
    if flip > 0.002 {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
        write_png(&folder.join("window-seen.png"), &seen).unwrap();
        write_png(&folder.join("window-rendered.png"), &rendered).unwrap();
    }
    assert!(flip <= 0.002, "FLIP {flip} between what is seen and what is rendered");

    session.resize(LARGER);
    let larger = session.until_settled();
    assert!(larger.size[0] > turned.size[0] && larger.size[1] > turned.size[1], "{larger:?}");
    assert_eq!(session.shot().size(), LARGER);
    session.close();
}

/// What `worsted render` draws of a scene.
fn rendered(scene: &Path, [width, height]: [u32; 2]) -> DisplayImage {
    let picture = scene.with_extension("png");
    let size = format!("{width}x{height}");
    let status = Command::new(env!("CARGO_BIN_EXE_worsted"))
        .args(["render", "--device", "software", "--size", &size, "--samples", "4", "--no-cache", "-q", "-o"])
        .args([&picture, scene])
        .status();
    assert!(status.unwrap().success());
    read_png(&picture).unwrap()
}

#[test]
fn a_script_takes_the_picture_that_render_draws_from_the_scene_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("shot.png");
    let mut session = Session::open(
        SIZE,
        &[
            "--samples",
            "4",
            "--exit-after-frames",
            "100",
            "--screenshot",
            picture.to_str().unwrap(),
            "--set",
            "yarn.hair_density_per_mm=9",
        ],
    );
    session.ends();
    let taken = read_png(&picture).unwrap();
    let scene = std::fs::read_to_string(folder.path().join("shot.toml")).unwrap();
    let size = format!("{}x{}", taken.width, taken.height);
    assert!(scene.starts_with("# worsted render shot.toml") && scene.contains(&size), "{scene}");
    let again = rendered(&folder.path().join("shot.toml"), [taken.width, taken.height]);
    assert!(again.pixels == taken.pixels, "what is rendered is what was seen");
}

#[test]
fn without_a_display_it_says_what_needs_none() {
    let output = Command::new(env!("CARGO_BIN_EXE_worsted"))
        .args(["view", "models/demo.toml", "--device", "software"])
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.lines().count() == 1 && said.contains("`worsted render` needs none"), "{said}");
}

#[test]
fn shots_that_differ_are_told_apart() {
    let gray = Shot::filled([40, 30], [90, 90, 90]);
    let mut other = gray.clone();
    other.paint([10, 10], 5, [255, 0, 0]);
    assert_eq!(gray.differing(&gray, [20, 15], 8), 0.0);
    assert!(other.differing(&gray, [12, 12], 4) > 0.3);
    assert!(!gray.is_varied([20, 15], 8) && other.is_varied([12, 12], 8));
}
