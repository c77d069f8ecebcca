//! Level of detail and core fibers against every fiber.

use worsted::io::picture::LinearImage;
use worsted::math::tone::Display;
use worsted::metrics::error::compare;

use crate::draw::{draw, draw_counted, mean_channel, scene, swatch};

const SIZE: [u32; 2] = [96, 72];
/// The samples at which pictures are compared.
const SAMPLES: u32 = 16;
const CLOSE: [&str; 2] = ["camera.distance_mm=8", "camera.target_mm=[0, 2, 1]"];
/// Most FLIP close up, and most change of the mean colour.
const MOST_FLIP: f64 = 0.06;
const MOST_COLOR_CHANGE: f64 = 0.03;
/// Far beyond any width: only cores are left.
const CORE_ALONE: &str = "quality.lod_threshold_samples=10000";
const EVERY: &str = "debug.fibers=\"every\"";

fn pictured(sets: &[&str]) -> LinearImage {
    draw(scene(&swatch(), sets), SIZE, SAMPLES).linear
}

fn flip(a: &LinearImage, b: &LinearImage) -> f64 {
    compare(a, b, &Display::PLAIN).unwrap().error.covered.flip_mean
}

fn color_change(a: &LinearImage, b: &LinearImage) -> f64 {
    (0..3).map(|c| (mean_channel(a, c) / mean_channel(b, c) - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn close_up_core_and_true_fibers_are_not_told_apart() {
    let every = pictured(&[&CLOSE[..], &[EVERY]].concat());
    let default = pictured(&CLOSE);
    let (error, change) = (flip(&default, &every), color_change(&default, &every));
    println!("FLIP {error:.4}, colour changes by {change:.4}");
    assert!(error <= MOST_FLIP && change <= MOST_COLOR_CHANGE);
    // What must be seen: fewer fibers with no core behind them, a core alone, another draw of the fibers.
    for wrong in ["debug.fibers=\"regular\"", "debug.fibers=\"core\"", "seed=2"] {
        let hidden = "quality.core_visible_share=0.5";
        let wrong_error = flip(&pictured(&[&CLOSE[..], &[hidden, wrong]].concat()), &every);
        assert!(wrong_error > MOST_FLIP, "{wrong}: FLIP only {wrong_error:.4}");
    }
}

#[test]
fn cores_alone_keep_the_mean_color_of_every_fiber() {
    // A core has no hairs; a hair is out in the light, so that without them the mean would be darker.
    let bare = ["yarn.hair_density_per_mm=0", "yarn.loop_density_per_mm=0"];
    for (preset, shadow) in
        [("worsted_3ply", "true"), ("cotton1", "true"), ("worsted_3ply", "false"), ("cotton1", "false")]
    {
        let yarn = format!("yarn.preset=\"{preset}\"");
        let (map, inside) = (format!("shadow.map={shadow}"), format!("shadow.self={shadow}"));
        let pictured = |sets: &[&str]| pictured(&[&bare[..], &[&map, &inside], sets].concat());
        let every = pictured(&[&yarn, EVERY]);
        let change = color_change(&pictured(&[&yarn, CORE_ALONE]), &every);
        println!("{preset}: colour changes by {change:.4}");
        assert!(change <= MOST_COLOR_CHANGE, "{preset}: {change:.4}");
        let darker = color_change(&pictured(&[&yarn, CORE_ALONE, "occlusion.mode=\"none\""]), &every);
        assert!(darker > MOST_COLOR_CHANGE, "missing occlusion changes the colour by only {darker:.4}");
    }
}

#[test]
fn fewer_pieces_of_fiber_are_drawn_where_they_are_small() {
    let count = |sets: &[&str]| {
        let (_, stats) = draw_counted(scene(&swatch(), sets), SIZE, 4, true);
        stats.fiber_segments.unwrap()
    };
    let pair = |sets: &[&str]| (count(sets), count(&[sets, &[EVERY]].concat()));
    let (far, far_every) = pair(&["camera.distance_mm=200"]);
    // A fiber is more than a pixel wide, twice what level of detail leaves alone.
    let (close, close_every) = pair(&["camera.distance_mm=3", CLOSE[1]]);
    println!("far {far} of {far_every}, close {close} of {close_every}");
    assert!(16 * far < far_every, "{far} of {far_every}");
    assert!(2 * close > close_every && close <= close_every + close_every / 20, "{close} of {close_every}");
}

#[test]
fn a_picture_of_cores_is_that_of_both_without_the_regular_fibers() {
    let core = pictured(&["debug.fibers=\"core\"", CORE_ALONE]);
    let both = pictured(&[CORE_ALONE, "yarn.hair_density_per_mm=0", "yarn.loop_density_per_mm=0"]);
    assert!(flip(&core, &both) < 1e-3, "regular fibers are drawn where none is kept");
    let regular = pictured(&["debug.fibers=\"regular\""]);
    assert!(flip(&core, &regular) > MOST_FLIP);
}
