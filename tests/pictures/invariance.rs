//! What must not change a picture, and how far what may change it does.

use glam::{DMat3, DVec3};
use worsted::io::curves::{CurveSet, UpAxis};
use worsted::io::picture::LinearImage;
use worsted::math::tone::Display;
use worsted::metrics::coverage::Coverage;
use worsted::metrics::error::compare;
use worsted::scene::Scene;

use crate::draw::{
    center_row, differing, draw, draw_counted, draw_sparse, hook, mean_channel, mean_radiance, scene, swatch,
};

const SMALL: [u32; 2] = [96, 72];
/// Where draws of other sizes may differ: fibers at the same depth, and no more.
const MAX_FLIP: f64 = 0.002;
const MAX_DIFFERING: f64 = 0.002;

/// Why two pictures are not the same one, if they are not.
fn difference(a: &LinearImage, b: &LinearImage) -> Option<String> {
    let covered = Coverage::of_linear(a, b).unwrap().count() as f64;
    let flip = compare(a, b, &Display::PLAIN).unwrap().error.covered.flip_mean;
    let share = differing(a, b) as f64 / covered;
    let same = flip <= MAX_FLIP && share <= MAX_DIFFERING;
    (!same).then(|| format!("mean FLIP {flip:.5}, {share:.5} of {covered} covered pixels differ"))
}

/// The scene without every other half of its pieces of yarn.
fn halved(mut scene: Scene) -> Scene {
    for fabric in &mut scene.fabrics {
        let kept = fabric.strands.pieces.len() / 2;
        fabric.strands.pieces.truncate(kept);
    }
    scene
}

/// The same picture is demanded of draws and buffers of any size; `curves` in a yarn of `sets`.
fn any_draw_and_buffer_size_gives_the_same_picture(curves: &CurveSet, sets: &[&str]) {
    let fixed = ["camera.distance_mm=32", "camera.target_mm=[0, 0, 0]"];
    let build = |more: &[&str]| scene(curves, &[&fixed, sets, more].concat());
    let reference = draw(build(&[]), SMALL, 4).linear;
    for cap in [1, 7, 16, 1_000_000] {
        let picture = draw(build(&[&format!("quality.patches_per_draw={cap}")]), SMALL, 4).linear;
        println!("{cap} patches a draw: {} pixels differ", differing(&picture, &reference));
        assert_eq!(difference(&picture, &reference), None, "{cap} patches a draw");
    }
    for points in [5, 50, 400] {
        let picture = draw(build(&[&format!("quality.points_per_buffer={points}")]), SMALL, 4).linear;
        println!("{points} points a buffer: {} pixels differ", differing(&picture, &reference));
        assert_eq!(difference(&picture, &reference), None, "{points} points a buffer");
    }
    for (what, wrong) in [("half the yarn", halved(build(&[]))), ("another seed", build(&["seed=2"]))] {
        let picture = draw(wrong, SMALL, 4).linear;
        assert!(difference(&picture, &reference).is_some(), "{what} is not seen");
    }
}

#[test]
fn the_size_of_draws_and_buffers_does_not_change_a_swatch() {
    any_draw_and_buffer_size_gives_the_same_picture(&swatch(), &["yarn.fibers_per_ply=40"]);
}

#[test]
fn the_size_of_draws_and_buffers_does_not_change_a_yarn_of_many_fibers() {
    // 3200 fibers, 50 instances of 64, are beyond the CPU device's 65,536 vertices in a few patches.
    any_draw_and_buffer_size_gives_the_same_picture(
        &hook(),
        &["yarn.ply_count=8", "yarn.fibers_per_ply=400"],
    );
}

#[test]
fn any_number_of_fibers_is_drawn_the_same_however_it_is_split() {
    for fibers in [1, 20, 64, 65, 150] {
        let sets = [format!("yarn.fibers_per_ply={fibers}"), "yarn.ply_count=2".to_owned()];
        any_draw_and_buffer_size_gives_the_same_picture(&hook(), &[sets[0].as_str(), sets[1].as_str()]);
    }
}

#[test]
fn leaving_out_swift_turns_changes_nothing_where_there_are_none() {
    let left_out = scene(&swatch(), &[]);
    assert!(!left_out.fabrics[0].turns_swiftly);
    let mut looked_for = left_out.clone();
    looked_for.fabrics[0].turns_swiftly = true;
    let [left_out, looked_for] = [left_out, looked_for].map(|scene| draw(scene, SMALL, 4).linear);
    assert_eq!(differing(&left_out, &looked_for), 0);

    // And where there are, the code is what cuts the fibers by them.
    let mut hairpin = hook();
    hairpin.curves[0].points =
        [[-4.5, 0.0], [4.5, 0.0], [-4.5, 1.6], [4.5, 1.6]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
    let turning = scene(&hairpin, &[]);
    assert!(turning.fabrics[0].turns_swiftly);
    let mut cut_evenly = turning.clone();
    cut_evenly.fabrics[0].turns_swiftly = false;
    let [turning, cut_evenly] = [turning, cut_evenly].map(|scene| draw(scene, SMALL, 4).linear);
    assert!(differing(&turning, &cut_evenly) > 0);
}

#[test]
fn the_size_of_submissions_does_not_change_a_picture() {
    for samples in [1, 4, 16] {
        let whole = draw(scene(&swatch(), &[]), SMALL, samples).linear;
        for curves in [1, 1000, 20_000] {
            let set = format!("quality.curves_per_submission={curves}");
            let parts = draw(scene(&swatch(), &[&set]), SMALL, samples).linear;
            assert_eq!(differing(&parts, &whole), 0, "{curves} curves, {samples} samples");
        }
    }
}

#[test]
fn every_preset_at_every_count_is_finite() {
    for preset in worsted::yarn::presets::yarn_names() {
        for (plies, fibers) in [(1, 1), (2, 20), (3, 64), (4, 65), (5, 150), (8, 400)] {
            let sets = [
                format!("yarn.preset={preset}"),
                format!("yarn.ply_count={plies}"),
                format!("yarn.fibers_per_ply={fibers}"),
                "fabric.mm_per_unit=0.5".to_owned(),
            ];
            let scene = scene(&hook(), &sets.iter().map(String::as_str).collect::<Vec<_>>());
            let (_, stats) = draw_sparse(scene, [32, 24], 1, true);
            assert!(stats.fiber_segments.is_some_and(|drawn| drawn > 0), "{sets:?}");
        }
    }
}

#[test]
fn culling_drops_only_what_is_not_seen() {
    for (yaw, target) in [("0", "[6, 3, 0]"), ("35", "[-4, 1, 0]"), ("90", "[2, -2, 0.5]")] {
        let build = |culling: &str| {
            let camera = [format!("camera.yaw_deg={yaw}"), format!("camera.target_mm={target}")];
            let sets = ["camera.distance_mm=7", "yarn.fibers_per_ply=40", culling, &camera[0], &camera[1]];
            scene(&swatch(), &sets)
        };
        let (culled, counted) = draw_counted(build("quality.culling=true"), SMALL, 16, true);
        let (whole, all) = draw_counted(build("quality.culling=false"), SMALL, 16, true);
        let (dropped, drawn) = (counted.patches_culled.unwrap(), counted.patches_drawn.unwrap());
        println!("yaw {yaw}: {dropped} culled, {drawn} drawn");
        assert!(dropped > 20 && drawn > 5, "{dropped} culled, {drawn} drawn");
        assert_eq!((all.patches_culled, all.patches_drawn), (Some(0), Some(dropped + drawn)));
        assert_eq!(differing(&culled.linear, &whole.linear), 0, "yaw {yaw}");
    }
}

#[test]
fn pieces_that_are_cut_too_coarsely_are_counted() {
    let counted = |most: &str, tolerance: &str, core: &str| {
        let sets = [most, tolerance, core, "camera.distance_mm=7", "yarn.fibers_per_ply=40"];
        let (_, stats) = draw_counted(scene(&swatch(), &sets), SMALL, 1, true);
        (stats.patches_coarse.unwrap(), stats.patches_drawn.unwrap())
    };
    let every = "debug.fibers=every";
    let (coarse, drawn) =
        counted("quality.max_subdivisions=1", "quality.subdivision_tolerance_px=0.1", every);
    assert!(coarse == drawn && drawn > 5, "{coarse} of {drawn}: one piece is too few for all");
    let (coarse, drawn) = counted("quality.max_subdivisions=64", "quality.subdivision_tolerance_px=1", every);
    assert!(coarse == 0 && drawn > 5, "{coarse} of {drawn}: 64 are enough for all");
    let core = "debug.fibers=core";
    let (coarse, drawn) = counted("quality.max_subdivisions=1", "quality.subdivision_tolerance_px=0.1", core);
    assert!(coarse > 0 && coarse <= drawn, "{coarse} of {drawn} cores");
}

#[test]
fn radiance_is_linear_in_the_light() {
    let lit = |light: &str, ambient: &str| {
        let light = format!("light=[{{irradiance = {light}}}]");
        draw(scene(&hook(), &[&light, &format!("ambient.radiance={ambient}")]), SMALL, 1).linear
    };
    // One sample and a power of two: not even half floats round.
    let (once, twice) = (lit("[1, 0.5, 0.25]", "[0, 0, 0]"), lit("[2, 1, 0.5]", "[0, 0, 0]"));
    let doubled = |p: &[f32; 4], q: &[f32; 4]| {
        (0..3).all(|c| (2.0 * p[c] - q[c]).abs() <= q[c] * 2e-3 + 1e-6) && p[3] == q[3]
    };
    assert!(once.pixels.iter().zip(&twice.pixels).all(|(p, q)| doubled(p, q)));
    assert!(mean_radiance(&once) > 0.003);
    assert!(!once.pixels.iter().zip(&once.pixels).all(|(p, q)| doubled(p, q)), "the check is blind");
    // The sum of the lights is the light of both.
    let (ambient, both) = (lit("[0, 0, 0]", "[0.5, 0.5, 0.5]"), lit("[1, 0.5, 0.25]", "[0.5, 0.5, 0.5]"));
    for ((a, b), sum) in once.pixels.iter().zip(&ambient.pixels).zip(&both.pixels) {
        for c in 0..3 {
            assert!((a[c] + b[c] - sum[c]).abs() <= 2e-3 * sum[c] + 1e-6, "{a:?} + {b:?} is not {sum:?}");
        }
    }
}

#[test]
fn more_samples_come_closer_to_the_truth() {
    let sampled = |samples| draw(scene(&hook(), &["yarn.fibers_per_ply=40"]), SMALL, samples).linear;
    let truth = sampled(144);
    let mse =
        [1, 4, 16, 64].map(|n| compare(&sampled(n), &truth, &Display::PLAIN).unwrap().error.covered.mse);
    println!("MSE against 144 samples at 1, 4, 16 and 64: {mse:?}");
    assert!(mse[0] > 2.0 * mse[1] && mse[1] > 2.0 * mse[2] && mse[2] > 2.0 * mse[3], "{mse:?}");
}

/// The curves after a turn of all of their points.
fn turned(set: &CurveSet, turn: impl Fn(DVec3) -> DVec3, up_axis: UpAxis) -> CurveSet {
    let mut set = set.clone();
    set.up_axis = Some(up_axis);
    for point in set.curves.iter_mut().flat_map(|curve| &mut curve.points) {
        *point = turn(*point);
    }
    set
}

/// A loaded scene, turned: its yarn with the frames that the plies turn in. (A file's turned points would
/// start the plies at another angle, as a curve's first normal is any perpendicular one.)
fn turned_scene(mut scene: Scene, turn: DMat3) -> Scene {
    for fabric in &mut scene.fabrics {
        for vector in fabric.strands.points.iter_mut().chain(&mut fabric.strands.normals) {
            *vector = turn * *vector;
        }
    }
    scene.origin_mm = turn * scene.origin_mm;
    scene
}

#[test]
fn turning_model_camera_and_light_together_changes_nothing() {
    let light = DVec3::new(-0.55, -0.75, -0.55);
    let turn = DMat3::from_rotation_y(90_f64.to_radians());
    // The sky is looked at along directions that stay: it has a limit of its own.
    let under = |sky: &str, yaw_deg: f64, turn: DMat3, light: DVec3| {
        let yaw = format!("camera.yaw_deg={yaw_deg:?}");
        let light = format!("light=[{{direction = [{:?}, {:?}, {:?}]}}]", light.x, light.y, light.z);
        draw(turned_scene(scene(&hook(), &[&yaw, &light, sky]), turn), SMALL, 16).linear
    };
    let drawn = |yaw_deg, turn, light| under("occlusion.yarns=false", yaw_deg, turn, light);
    let still = drawn(10.0, DMat3::IDENTITY, light);
    let together = drawn(100.0, turn, turn * light);
    let flip = |a, b| compare(a, b, &Display::PLAIN).unwrap().error.covered.flip_mean;
    let (same, brightness) = (flip(&still, &together), mean_radiance(&together) / mean_radiance(&still));
    println!("turned together: mean FLIP {same:.5}, brightness x {brightness:.5}");
    assert!(same < 0.005, "mean FLIP {same}");
    assert!((brightness - 1.0).abs() < 1e-3, "brightness x {brightness}");
    let occluded = "occlusion.yarns=true";
    let (still_occluded, together_occluded) =
        (under(occluded, 10.0, DMat3::IDENTITY, light), under(occluded, 100.0, turn, turn * light));
    let same = flip(&still_occluded, &together_occluded);
    println!("under a sky that yarns hide: mean FLIP {same:.5}");
    assert!(same < 0.02, "mean FLIP {same}");
    // The light, or the camera, left behind is seen.
    let (light_left, camera_left) = (drawn(100.0, turn, light), drawn(10.0, turn, turn * light));
    assert!(flip(&still, &light_left) > 0.02 && flip(&still, &camera_left) > 0.1);
}

#[test]
fn the_files_up_axis_is_up() {
    let camera = ["camera.pitch_deg=0"];
    let upright = draw(scene(&hook(), &camera), SMALL, 4).linear;
    // Most of the hook is its head.
    assert!(center_row(&upright) < 0.47, "{}", center_row(&upright));
    let z_up = turned(&hook(), |p| DVec3::new(p.x, -p.z, p.y), UpAxis::Z);
    let x_up = turned(&hook(), |p| DVec3::new(p.y, -p.x, p.z), UpAxis::X);
    for set in [&z_up, &x_up] {
        let picture = draw(scene(set, &camera), SMALL, 4).linear;
        assert_eq!(differing(&picture, &upright), 0, "{:?}", set.up_axis);
        let fallen = CurveSet { up_axis: Some(UpAxis::Y), ..set.clone() };
        let picture = draw(scene(&fallen, &camera), SMALL, 4).linear;
        assert!(differing(&picture, &upright) > 500, "the axis of {:?} does not matter", set.up_axis);
    }
}

#[test]
fn the_number_of_samples_does_not_change_what_a_thin_fiber_shows() {
    // Fibers of a quarter of a pixel: most lie between the centres of the pixels. Every one is drawn, as level
    // of detail goes by the number of samples.
    let every = ["debug.fibers=\"every\""];
    let sampled =
        |samples, sets: &[&str]| draw(scene(&swatch(), &[&every, sets].concat()), SMALL, samples).linear;
    let mut wrong = Vec::new();
    for (what, sets, channel) in [
        ("normal toward the eye", &["debug.view=normal"][..], 2),
        ("occlusion", &["debug.view=occlusion"], 0),
        ("light", &["ambient.radiance=[0, 0, 0]", "shadow.self=false"], 1),
        ("tangent", &["debug.view=tangent"], 2),
    ] {
        let [one, four, many] = [1, 4, 64].map(|n| mean_channel(&sampled(n, sets), channel));
        println!("{what}: {one:.4} at 1 sample, {four:.4} at 4, {many:.4} at 64");
        // One sample of this small a picture has a standard error of some 1 %.
        if (four / many - 1.0).abs() > 0.02 || (one / many - 1.0).abs() > 0.04 {
            wrong.push(what);
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}
