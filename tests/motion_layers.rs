//! The layers of pictures against what rigid motions and yarns apart must give: `src/passes/layers.rs`,
//! `src/frame/layers.rs`, on the device.

#![expect(clippy::unwrap_used, reason = "the helpers of a test may fail it")]

#[path = "support/device.rs"]
mod device;

use glam::{DQuat, DVec2, DVec3};
use std::path::Path;
use worsted::frame::sampling::Sampling;
use worsted::frame::{Picture, Renderer, Request};
use worsted::io::bcc::write_bcc;
use worsted::io::curves::CurveSet;
use worsted::knit::params::KnitParams;
use worsted::knit::stockinette::stockinette;
use worsted::motion::mover::Movers;
use worsted::scene::Scene;
use worsted::vulkan::DeviceChoice;

const FRAMES: usize = 5;
const SIZE: [u32; 2] = [96, 72];
/// From in front, its middle in the picture's middle.
const CAMERA: [&str; 3] = ["camera.target_mm=[0, 0, 0]", "camera.pitch_deg=0", "camera.yaw_deg=0"];

/// Raw frames of points that move.
fn write_frames(path: &Path, points: &[DVec3], moved: impl Fn(DVec3, f64) -> DVec3) {
    let frames = (0..FRAMES).flat_map(|frame| points.iter().map(move |p| (*p, frame as f64)));
    let numbers = frames.flat_map(|(p, frame)| moved(p, frame).as_vec3().to_array());
    std::fs::write(path, numbers.flat_map(f32::to_le_bytes).collect::<Vec<u8>>()).unwrap();
}

/// A swatch around the origin that moves, with both layers.
fn swatch(moved: impl Fn(DVec3, f64) -> DVec3, sets: &[&str]) -> (tempfile::TempDir, Scene) {
    let folder = tempfile::tempdir().unwrap();
    let mut set = stockinette(&KnitParams { courses: 2, wales: 2, ..KnitParams::swatch() }).unwrap();
    center(&mut set);
    let model = folder.path().join("swatch.bcc");
    write_bcc(&model, &set).unwrap();
    let points: Vec<DVec3> = set.curves.iter().flat_map(|curve| curve.points.clone()).collect();
    write_frames(&folder.path().join("frames.f32"), &points, moved);
    let motion = format!("fabric.motion={}", folder.path().join("frames.f32").display());
    let layers = ["fabric.mm_per_unit=1", "layers.motion=true", "layers.id=true", &motion];
    let sets = [&CAMERA[..], &layers, sets].concat();
    let scene = Scene::load(&model, &sets.iter().map(|set| set.to_string()).collect::<Vec<_>>()).unwrap();
    (folder, scene)
}

fn center(set: &mut CurveSet) {
    let points = || set.curves.iter().flat_map(|curve| &curve.points);
    let low = points().fold(DVec3::INFINITY, |low, p| low.min(*p));
    let high = points().fold(DVec3::NEG_INFINITY, |high, p| high.max(*p));
    let middle = 0.5 * (low + high);
    set.curves.iter_mut().flat_map(|curve| &mut curve.points).for_each(|p| *p -= middle);
}

/// One picture of a frame.
fn drawn(scene: &Scene, frame: f64, samples: u32) -> Picture {
    let device = device::shared(DeviceChoice::Software);
    let sampling = Sampling::new(samples).unwrap();
    let request = Request { size: SIZE, sampling, statistics: false, profile: false };
    let movers = Movers::open(scene).unwrap();
    let mut renderer = Renderer::new(device, scene.clone(), request).unwrap();
    let mut poser = renderer.poser(movers, std::iter::once(frame));
    let mut posed = poser.next_frame().unwrap().unwrap();
    renderer.pose(&mut posed).unwrap();
    let picture = renderer.render(&|_| ()).unwrap();
    device.check_validation().unwrap();
    picture
}

fn layers(picture: &Picture) -> (&[[f32; 4]], &[[u32; 2]]) {
    let layers = picture.layers.as_ref().unwrap();
    (layers.motion.as_ref().unwrap(), layers.ids.as_ref().unwrap())
}

/// The centre of a pixel from the picture's middle, in pixels, y up.
fn place_px(index: usize) -> DVec2 {
    let [width, height] = SIZE.map(f64::from);
    let (x, y) = ((index % SIZE[0] as usize) as f64 + 0.5, (index / SIZE[0] as usize) as f64 + 0.5);
    DVec2::new(x - 0.5 * width, 0.5 * height - y)
}

/// Largest departure in pixels from what motion should be at a place: backward and forward; where there is no yarn it
/// should be 0. And how many pixels have yarn.
fn worst(motion: &[[f32; 4]], ids: &[[u32; 2]], expected: impl Fn(DVec2) -> [DVec2; 2]) -> (f64, usize) {
    let mut worst: f64 = 0.0;
    for (index, (found, id)) in motion.iter().zip(ids).enumerate() {
        let expected = if *id == [0; 2] { [DVec2::ZERO; 2] } else { expected(place_px(index)) };
        let found = found.map(f64::from);
        for (place, expected) in expected.into_iter().enumerate() {
            let apart = (DVec2::new(found[2 * place], found[2 * place + 1]) - expected).length();
            // What is no number is as wrong as can be.
            worst = if apart.is_nan() { f64::INFINITY } else { worst.max(apart) };
        }
    }
    (worst, ids.iter().filter(|id| **id != [0; 2]).count())
}

/// Every kind of mistake in signs, axes, order and scale that can be made of a right answer.
fn mistaken(motion: &[[f32; 4]]) -> Vec<(&'static str, Vec<[f32; 4]>)> {
    type Mistake = fn([f32; 4]) -> [f32; 4];
    let mistakes: [(&str, Mistake); 6] = [
        ("the other way", |[a, b, c, d]| [-a, -b, -c, -d]),
        ("before and after swapped", |[a, b, c, d]| [c, d, a, b]),
        ("y down", |[a, b, c, d]| [a, -b, c, -d]),
        ("x to the left", |[a, b, c, d]| [-a, b, -c, d]),
        ("x and y swapped", |[a, b, c, d]| [b, a, d, c]),
        ("halves of pixels", |pixel| pixel.map(|value| 0.5 * value)),
    ];
    mistakes.map(|(name, mistake)| (name, motion.iter().map(|pixel| mistake(*pixel)).collect())).to_vec()
}

/// Motion parallel to the picture, so far away that depth hardly matters.
#[test]
fn a_cloth_that_is_carried_along_moves_by_the_projected_distance() {
    let step = DVec3::new(0.35, 0.2, 0.0);
    let (_folder, scene) =
        swatch(|p, frame| p + (frame - 2.0) * step, &["camera.distance_mm=2000", "camera.fov_y_deg=1"]);
    let px_per_mm = 1.0 / (2000.0 * scene.camera(SIZE).pixel_tangent(SIZE));
    let forward = px_per_mm * step.truncate();
    let picture = drawn(&scene, 2.0, 4);
    let (motion, ids) = layers(&picture);
    let (error, covered) = worst(motion, ids, |_| [-forward, forward]);
    println!("{forward} px, {covered} pixels, worst {error:.2e} px");
    assert!(forward.length() > 0.5 && covered > 500, "{forward} {covered}");
    assert!(error < 1e-2, "{error}");
    for (name, wrong) in mistaken(motion) {
        let (error, _) = worst(&wrong, ids, |_| [-forward, forward]);
        assert!(error > 0.1, "{name}: {error}");
    }
}

/// Cores, cores and fibers, fibers shaded at their vertices, every fiber: all of what pictures are drawn with.
const MANNERS: [&[&str]; 6] = [
    &["camera.distance_mm=14"],
    &["camera.distance_mm=60"],
    &["camera.distance_mm=150", "yarn.hair_density_per_mm=3"],
    &["camera.distance_mm=40", "debug.fibers=core"],
    &["camera.distance_mm=40", "debug.fibers=every", "yarn.fibers_per_ply=12"],
    &["camera.distance_mm=60", "quality.points_per_buffer=60", "quality.curves_per_submission=500"],
];

#[test]
fn a_cloth_that_turns_in_the_picture_turns_exactly_and_is_where_the_picture_shows_it() {
    let angle = 0.04;
    let turn = |p: DVec3, frame: f64| DQuat::from_rotation_z(angle * (frame - 2.0)) * p;
    for sets in MANNERS {
        let (_folder, scene) = swatch(turn, sets);
        let picture = drawn(&scene, 2.0, 1);
        let (motion, ids) = layers(&picture);
        let field =
            |place: DVec2| [-angle, angle].map(|angle| DVec2::from_angle(angle).rotate(place) - place);
        let (error, covered) = worst(motion, ids, field);
        println!("{sets:?}: {covered} pixels, worst {error:.2e} px");
        assert!(error < 2e-2 && covered > 60, "{sets:?}: {error} {covered}");
        for (index, (pixel, id)) in picture.linear.iter().zip(ids).enumerate() {
            assert_eq!(pixel[3] > 0.0, *id != [0; 2], "{sets:?}: pixel {index}");
        }
        for (name, wrong) in mistaken(motion) {
            let (error, _) = worst(&wrong, ids, field);
            assert!(error > 0.1, "{sets:?}, {name}: {error}");
        }
    }
}

#[test]
fn what_begins_or_ends_does_not_move_beyond_unless_it_repeats() {
    let step = DVec3::new(0.3, 0.0, 0.0);
    let moved = |p: DVec3, frame: f64| p + (frame - 2.0) * step;
    let far = ["camera.distance_mm=2000", "camera.fov_y_deg=1"];
    let px = |scene: &Scene| step.x / (2000.0 * scene.camera(SIZE).pixel_tangent(SIZE));
    // Of which frame, with what else: steps to the frame before and to the frame after.
    for (frame, sets, [before, after]) in [
        (0.0, &[][..], [0.0, 1.0]),
        (4.0, &[], [-1.0, 0.0]),
        (3.75, &[], [-1.0, 0.25]),
        (0.0, &["animation.repeat=true"], [4.0, 1.0]),
        (4.0, &["animation.repeat=true"], [-1.0, -4.0]),
        (1.0, &["animation.speed=0.5"], [-0.5, 0.5]),
        (1.0, &["animation.speed=3", "animation.interpolation=catmull_rom"], [-1.0, 3.0]),
    ] {
        let (_folder, scene) = swatch(moved, &[&far[..], sets].concat());
        let picture = drawn(&scene, frame, 4);
        let (motion, ids) = layers(&picture);
        let expected = [before, after].map(|steps| DVec2::new(steps * px(&scene), 0.0));
        let (error, covered) = worst(motion, ids, |_| expected);
        assert!(error < 2e-2 && covered > 500, "frame {frame} {sets:?}: {error} px, {covered} pixels");
    }
}

/// Yarn across at a height in mm.
fn across(y_mm: f64) -> [DVec3; 5] {
    [-6.0, -3.0, 0.0, 3.0, 6.0].map(|x| DVec3::new(x, y_mm, 0.0))
}

fn obj(yarns: &[[DVec3; 5]]) -> String {
    let points = yarns.iter().flatten().map(|p| format!("v {} {} {}\n", p.x, p.y, p.z)).collect::<String>();
    let line =
        |yarn: usize| format!("l {}\n", (1..6).map(|k| (5 * yarn + k).to_string() + " ").collect::<String>());
    points + &(0..yarns.len()).map(line).collect::<String>()
}

/// Two yarns of a fabric that moves up, and one of another that does not.
#[test]
fn ids_say_which_yarn_is_where_and_what_stands_still_does_not_move() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let moving = [across(2.0), across(-3.0)];
    write("moving.obj", &obj(&moving));
    write("still.obj", &obj(&[across(0.0)]));
    write_frames(&folder.path().join("frames.f32"), moving.as_flattened(), |p, frame| {
        p + DVec3::Y * 0.2 * frame
    });
    write(
        "scene.toml",
        "[[fabric]]\nmodel = 'still.obj'\nmm_per_unit = 1\n\
         [[fabric]]\nmodel = 'moving.obj'\nmm_per_unit = 1\nmotion = 'frames.f32'\n",
    );
    let sets = ["camera.distance_mm=24", "yarn.hair_density_per_mm=0", "yarn.loop_density_per_mm=0"];
    let sets = [&CAMERA[..], &sets, &["layers.motion=true", "layers.id=true"]].concat();
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    let scene = Scene::load(&folder.path().join("scene.toml"), &sets).unwrap();
    let mm_per_px = 24.0 * scene.camera(SIZE).pixel_tangent(SIZE);
    for frame in [0.0, 3.0] {
        let picture = drawn(&scene, frame, 1);
        let (motion, ids) = layers(&picture);
        let yarns = [(0.0, [1, 1]), (2.0 + 0.2 * frame, [2, 1]), (-3.0 + 0.2 * frame, [2, 2])];
        let mut seen = [0; 3];
        for (index, (id, motion)) in ids.iter().zip(motion).enumerate() {
            if *id == [0; 2] {
                assert_eq!(*motion, [0.0; 4]);
                continue;
            }
            let y_mm = place_px(index).y * mm_per_px;
            let apart = |place: &usize| (yarns[*place].0 - y_mm).abs();
            let nearest = (0..3).min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap();
            assert_eq!(*id, yarns[nearest].1, "pixel {index}, {y_mm} mm, frame {frame}");
            seen[nearest] += 1;
            let moves = motion.iter().any(|value| *value != 0.0);
            assert_eq!(moves, id[0] == 2, "pixel {index}: {motion:?} of {id:?}");
            assert!(!moves || motion[3] > 0.1 && motion[1] < 1e-3, "{motion:?} moves up");
        }
        assert!(seen.iter().all(|pixels| *pixels > 100), "{seen:?}");
    }
}

#[test]
fn light_is_the_same_with_layers_and_without_and_each_comes_alone() {
    let turn = |p: DVec3, frame: f64| DQuat::from_rotation_y(0.05 * frame) * p;
    let draw = |sets: &[&str]| {
        let (_folder, scene) = swatch(turn, &[&["camera.distance_mm=60"], sets].concat());
        drawn(&scene, 2.5, 16)
    };
    let both = draw(&[]);
    let (motion, ids) = layers(&both);
    let none = draw(&["layers.motion=false", "layers.id=false"]);
    assert!(none.layers.is_none() && none.linear == both.linear && none.display == both.display);
    let only_motion = draw(&["layers.id=false"]);
    let found = only_motion.layers.as_ref().unwrap();
    assert!(
        found.ids.is_none() && found.motion.as_deref() == Some(motion) && only_motion.linear == both.linear
    );
    let only_ids = draw(&["layers.motion=false"]);
    let found = only_ids.layers.as_ref().unwrap();
    assert!(found.motion.is_none() && found.ids.as_deref() == Some(ids) && only_ids.linear == both.linear);
}
