//! What moves, what is compared, and what is dropped on the window.

use super::session::{Session, Shot};
use super::{MIDDLE, SIZE, rendered};
use std::path::Path;
use std::process::Command;
use worsted::io::picture::read_png;

/// The button that plays, and the line of frames about the middle and at its end, where something moves.
const PLAY: [u32; 2] = [24, 33];
const FRAMES: [[u32; 2]; 2] = [[300, 33], [626, 33]];
/// Buttons of the bar.
const KEEP: [u32; 2] = [422, 11];
const ALONE: [u32; 2] = [547, 11];
const HEATMAP: [u32; 2] = [635, 11];
const COMPARE_NO_MORE: [u32; 2] = [796, 11];
const COMPARE_NO_MORE_WITH_IT: [u32; 2] = [783, 11];
/// The menu of references, and in it: 16 samples, a quarter of the sides, compare.
const REFERENCE: [u32; 2] = [497, 11];
const FEW_SAMPLES: [[u32; 2]; 3] = [[92, 54], [172, 75], [165, 97]];
/// Yarn on either side of a wipe in the middle of the picture, and what is looked at of it.
const LEFT: [u32; 2] = [430, 350];
const RIGHT: [u32; 2] = [560, 350];
const REACH: u32 = 50;
/// Where the wipe is, and where it is dragged to.
const EDGE: [u32; 2] = [495, 500];
const BEYOND: [u32; 2] = [640, 500];

/// Fabric that waves.
fn waving(home: &Path) -> std::path::PathBuf {
    let path = home.join("waving.gltf");
    let knit = Command::new(env!("CARGO_BIN_EXE_worsted"))
        .args(["knit", "stockinette", "--wales", "3", "--courses", "3", "--animate", "wave", "-o"])
        .arg(&path)
        .status();
    assert!(knit.unwrap().success());
    path
}

/// Whether the yarn there is the same in both.
fn same(a: &Shot, b: &Shot, at: [u32; 2]) -> bool {
    a.differing(b, at, REACH) == 0.0
}

#[test]
fn what_moves_plays_and_is_scrubbed() {
    let mut session = Session::open_what(SIZE, &["--samples", "4"], &[], waving);
    session.until_settled();
    let rest = session.shot();
    assert!(rest.is_varied(LEFT, REACH) && rest.is_varied(RIGHT, REACH), "the cloth is shown");

    session.click(PLAY);
    let played = session.for_a_while();
    assert!(played.small >= 5, "it plays: {played:?}");
    let ended = if played.settled { played } else { session.until_settled() };
    assert!(ended.settled && ended.small < 200, "it ends by itself at the last frame");
    let last = session.shot();

    // Scrubbed back and forth, the same frame is the same picture.
    session.click(FRAMES[0]);
    session.until_settled();
    assert!(!same(&last, &session.shot(), LEFT), "frames differ");
    session.click(FRAMES[1]);
    session.until_settled();
    assert!(same(&session.shot(), &last, LEFT) && same(&session.shot(), &last, RIGHT));

    // A turntable turns until it is stopped; the keys do what the buttons do.
    session.press("t");
    let turning = session.for_a_while();
    assert!(turning.small >= 3 && !turning.settled, "it turns: {turning:?}");
    session.press("t");
    session.until_settled();
    assert!(!same(&session.shot(), &last, RIGHT), "it has turned");
    session.close_by_button();
}

#[test]
fn two_pictures_are_compared() {
    let mut session = Session::open_what(SIZE, &["--samples", "4"], &[], waving);
    session.until_settled();
    let kept = session.shot();
    session.click(KEEP);
    session.drag(RIGHT, [RIGHT[0] + 50, RIGHT[1]]);
    session.until_settled();
    let wiped = session.shot();
    assert!(same(&wiped, &kept, LEFT) && !same(&wiped, &kept, RIGHT), "A is left of the edge and B right");

    // The edge is dragged, and nothing is turned by that.
    session.drag(EDGE, BEYOND);
    let moved = session.shot();
    assert!(same(&moved, &kept, LEFT) && same(&moved, &kept, RIGHT), "A is shown up to the edge");
    session.click(ALONE);
    let alone = session.shot();
    assert!(same(&alone, &wiped, RIGHT) && !same(&alone, &kept, LEFT), "B alone is the picture as it was");
    session.click(HEATMAP);
    let heatmap = session.shot();
    assert!(!same(&heatmap, &alone, LEFT) && !same(&heatmap, &kept, LEFT) && heatmap.is_varied(LEFT, REACH));
    session.click(COMPARE_NO_MORE);
    assert!(same(&session.shot(), &alone, LEFT) && same(&session.shot(), &alone, RIGHT));

    // With a reference that is traced now, and pictures of its size.
    session.click(REFERENCE);
    FEW_SAMPLES.iter().for_each(|place| session.click(*place));
    session.until_said("reference: ");
    let small = session.until_settled();
    assert_eq!(small.size, [78, 149], "a quarter of the sides");
    let traced = session.shot();
    assert!(traced.is_varied(LEFT, REACH) && !same(&traced, &alone, LEFT) && !same(&traced, &alone, RIGHT));
    session.click(COMPARE_NO_MORE_WITH_IT);
    session.until_settled();
    assert!(same(&session.shot(), &alone, LEFT) && same(&session.shot(), &alone, RIGHT));

    // Off the screen and back it shows the same.
    session.hide_and_show();
    assert!(same(&session.shot(), &alone, LEFT) && same(&session.shot(), &alone, RIGHT));
    session.close();
}

#[test]
fn files_that_are_dropped_are_opened() {
    let mut session = Session::open_what(SIZE, &["--samples", "4"], &[], waving);
    let moving = session.until_settled();
    let before = session.shot();
    let folder = tempfile::tempdir().unwrap();
    for file in ["demo.toml", "stockinette.bcc"] {
        std::fs::copy(format!("models/{file}"), folder.path().join(file)).unwrap();
    }
    session.drop_file(&folder.path().join("demo.toml"));
    let demo = session.until_settled();
    assert!(demo.revision > moving.revision && demo.size[1] > moving.size[1], "without the line of frames");
    assert!(!same(&session.shot(), &before, MIDDLE));
    // A file that is none is said, and nothing else changes.
    let shown = session.shot();
    let none = folder.path().join("none.toml");
    std::fs::write(&none, "no scene").unwrap();
    session.drop_file(&none);
    assert!(same(&session.shot(), &shown, RIGHT));
    session.close();
}

#[test]
fn on_a_fine_screen_all_is_larger_and_the_picture_as_fine_as_the_screen() {
    let home = tempfile::tempdir().unwrap();
    let picture = home.path().join("shot.png");
    let options = ["--samples", "4", "--exit-after-frames", "100", "--screenshot", picture.to_str().unwrap()];
    let fine = [("WINIT_X11_SCALE_FACTOR", "1.25")];
    let mut session = Session::open_what(SIZE, &options, &fine, waving);
    session.ends();
    let taken = read_png(&picture).unwrap();
    // Panels of 340 and 250 points beside it.
    let beside = SIZE[0] - taken.width;
    assert!((720..760).contains(&beside), "{beside} pixels beside the picture");
    let again = rendered(&home.path().join("shot.toml"), [taken.width, taken.height]);
    assert!(again.pixels == taken.pixels, "what is rendered is what was seen");
}
