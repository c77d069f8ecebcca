//! Playing: `src/frame/moving.rs` and `src/motion/mover.rs`, on the device.

#![expect(clippy::unwrap_used, reason = "the helpers of a test may fail it")]

#[path = "support/device.rs"]
mod device;

use glam::{DMat3, DVec3};
use half::f16;
use worsted::frame::moving::turned_skies;
use worsted::frame::sampling::Sampling;
use worsted::frame::{Renderer, Request};
use worsted::io::bcc::write_bcc;
use worsted::io::curves::CurveSet;
use worsted::io::layers::Layers;
use worsted::knit::params::KnitParams;
use worsted::knit::stockinette::stockinette;
use worsted::math::rng::Rng;
use worsted::motion::mover::Movers;
use worsted::motion::pose::RestPose;
use worsted::precompute::sky::sky_toward;
use worsted::scene::Scene;
use worsted::vulkan::DeviceChoice;

const FRAMES: usize = 6;
const REQUEST: [u32; 2] = [64, 48];

/// A small swatch that is bent and carried along.
fn bent(set: &CurveSet, frame: f64) -> Vec<DVec3> {
    let at = |p: &DVec3| {
        let turn = DMat3::from_rotation_y(0.1 * frame * (1.0 + 0.02 * p.x));
        turn * *p + DVec3::new(0.5 * frame, 0.3 * frame * (0.3 * p.x + frame).sin(), 0.0)
    };
    set.curves.iter().flat_map(|curve| &curve.points).map(at).collect()
}

fn raw(frames: impl Iterator<Item = Vec<DVec3>>) -> Vec<u8> {
    frames.flatten().flat_map(|p| p.as_vec3().to_array()).flat_map(f32::to_le_bytes).collect()
}

/// A scene of the swatch with frames beside it; the files are gone with the folder.
fn moving(sets: &[&str]) -> (tempfile::TempDir, Scene) {
    let folder = tempfile::tempdir().unwrap();
    let set = stockinette(&KnitParams { courses: 3, wales: 3, ..KnitParams::swatch() }).unwrap();
    let model = folder.path().join("swatch.bcc");
    write_bcc(&model, &set).unwrap();
    std::fs::write(folder.path().join("frames.f32"), raw((0..FRAMES).map(|f| bent(&set, f as f64)))).unwrap();
    let motion = format!("fabric.motion={}", folder.path().join("frames.f32").display());
    let sets = [&["fabric.mm_per_unit=1", "yarn.fibers_per_ply=8", &motion][..], sets].concat();
    let scene = Scene::load(&model, &sets.iter().map(|set| set.to_string()).collect::<Vec<_>>()).unwrap();
    (folder, scene)
}

fn renderer(scene: &Scene) -> (Renderer, Movers) {
    let device = device::shared(DeviceChoice::Software);
    let sampling = Sampling::new(4).unwrap();
    let request = Request { size: REQUEST, sampling, statistics: false, profile: false };
    let mut scene = scene.clone();
    let mut movers = Movers::open(&scene).unwrap();
    movers.fix_camera(&mut scene, REQUEST).unwrap();
    (Renderer::new(device, scene, request).unwrap(), movers)
}

/// Pictures of some times, in that order, by one renderer: light and layers.
fn played(scene: &Scene, times: &[f64]) -> Vec<(Vec<[f32; 4]>, Option<Layers>)> {
    let (mut renderer, movers) = renderer(scene);
    let all = times.to_vec();
    let mut poser = renderer.poser(movers, all.into_iter());
    let mut pictures = Vec::new();
    while let Some(mut posed) = poser.next_frame().unwrap() {
        assert_eq!(posed.frame, times[pictures.len()]);
        renderer.pose(&mut posed).unwrap();
        poser.give_back(posed);
        let picture = renderer.render(&|_| ()).unwrap();
        pictures.push((picture.linear, picture.layers));
    }
    device::shared(DeviceChoice::Software).check_validation().unwrap();
    assert_eq!(pictures.len(), times.len());
    pictures
}

/// In parts of few points too, for each part has buffers of its own.
#[test]
fn frames_in_any_order_are_the_frames_in_sequence_bit_for_bit() {
    for sets in [
        &[][..],
        &["quality.points_per_buffer=90", "animation.interpolation=catmull_rom"],
        &["layers.motion=true", "layers.id=true", "animation.speed=0.5"],
        &["layers.motion=true", "quality.points_per_buffer=90", "animation.repeat=true"],
    ] {
        let (_folder, scene) = moving(sets);
        let times: Vec<f64> = (0..11).map(|i| 0.5 * f64::from(i)).collect();
        let sequence = played(&scene, &times);
        for (i, picture) in sequence.iter().enumerate() {
            assert_eq!(picture.1.is_some(), scene.file.layers.any());
            assert!(picture.0.iter().any(|pixel| pixel[3] > 0.0), "picture {i} is empty");
            assert!(sequence[..i].iter().all(|other| other.0 != picture.0), "picture {i} shows another time");
        }
        let mut rng = Rng::new(11, &[]);
        let order: Vec<usize> = (0..24).map(|_| (rng.uniform() * times.len() as f64) as usize).collect();
        let shuffled: Vec<f64> = order.iter().map(|i| times[*i]).collect();
        for (place, picture) in order.iter().zip(played(&scene, &shuffled)) {
            assert!(picture == sequence[*place], "time {} differs", times[*place]);
        }
    }
}

#[test]
fn at_rest_nothing_changes() {
    let (folder, scene) =
        moving(&["camera.distance_mm=40", "camera.target_mm=[0, 0, 0]", "camera.pitch_deg=0"]);
    let rest = RestPose::new(&scene.fabrics[0].strands).unwrap();
    assert_eq!(rest.given_count(), scene.fabrics[0].strands.control_point_count);
    let (mut unmoved, _) = renderer(&scene);
    let expected = unmoved.render(&|_| ()).unwrap().linear;
    // Frame 0 is the model itself as f32, which is what the file holds too.
    assert!(played(&scene, &[3.0, 0.0])[1].0 == expected);
    drop(folder);
}

#[test]
fn between_two_frames_points_lie_between_and_smooth_motion_has_no_corner() {
    let (_folder, scene) = moving(&[]);
    let at = |scene: &Scene, time: f64| Movers::open(scene).unwrap().0[0].given_at(time).unwrap();
    let (from, to, half) = (at(&scene, 2.0), at(&scene, 3.0), at(&scene, 2.5));
    for ((from, to), half) in from.iter().zip(&to).zip(&half) {
        assert!((0.5 * (*from + *to) - *half).length() < 1e-9);
    }
    let (_other, smooth) = moving(&["animation.interpolation=catmull_rom"]);
    let speed = |scene: &Scene, time: f64, step: f64| -> Vec<DVec3> {
        let (from, to) = (at(scene, time), at(scene, time + step));
        from.iter().zip(&to).map(|(from, to)| (*to - *from) / step).collect()
    };
    // Speed just before and just behind a frame.
    let bend = |scene: &Scene| {
        let (before, behind) = (speed(scene, 2.0 - 1e-6, 1e-6), speed(scene, 2.0, 1e-6));
        before.iter().zip(&behind).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max)
    };
    assert!(bend(&smooth) < 1e-3 && bend(&scene) > 0.05, "{} {}", bend(&smooth), bend(&scene));
    assert_eq!(at(&smooth, 3.0), at(&scene, 3.0));
    for time in [0.3, 4.7] {
        let apart = |(a, b): (&DVec3, &DVec3)| (*a - *b).length();
        let (a, b) = (at(&smooth, time), at(&scene, time));
        assert!(a.iter().zip(&b).map(apart).fold(0.0, f64::max) < 1.0, "at the ends");
    }
}

#[test]
fn a_motion_that_repeats_begins_again() {
    for interpolation in ["linear", "catmull_rom"] {
        let (_folder, scene) =
            moving(&["animation.repeat=true", &format!("animation.interpolation={interpolation}")]);
        let at = |time: f64| Movers::open(&scene).unwrap().0[0].given_at(time).unwrap();
        let cycle = FRAMES as f64;
        for time in [0.0, 0.25, 3.0, 5.5] {
            assert_eq!(at(time), at(time + 100.0 * cycle), "{interpolation} {time}");
        }
    }
    let (_folder, scene) = moving(&[]);
    let behind = |time| Movers::open(&scene).unwrap().0[0].given_at(time).unwrap_err().to_string();
    assert!(behind(5.01).contains("frame 5: expected a frame of 0 to 5, found 5.01"));
    assert!(behind(7.0).contains("frame 7"));
}

#[test]
fn a_camera_that_is_fitted_sees_all_of_the_motion_and_stays() {
    let (_folder, scene) = moving(&["camera.yaw_deg=20"]);
    let (mut fixed, mut movers) = (scene.clone(), Movers::open(&scene).unwrap());
    movers.fix_camera(&mut fixed, REQUEST).unwrap();
    let camera = fixed.camera(REQUEST);
    let clip = camera.clip_from_world(REQUEST, glam::DVec2::ZERO);
    for frame in 0..FRAMES {
        for point in movers.0[0].given_at(frame as f64).unwrap() {
            let p = clip * (point - fixed.origin_mm).extend(1.0);
            assert!(p.x.abs() < p.w && p.y.abs() < p.w, "frame {frame}");
        }
        let mut posed = fixed.clone();
        movers.put(&mut posed, frame as f64).unwrap();
        assert_eq!(posed.camera(REQUEST), camera, "frame {frame}");
    }
    assert!(
        scene.camera(REQUEST).target_world.distance(camera.target_world) > 1.0,
        "the motion goes elsewhere"
    );
}

#[test]
fn skies_turn_with_the_cloth() {
    let mut rng = Rng::new(3, &[]);
    let mut number = || 2.0 * rng.uniform() - 1.0;
    for _ in 0..100 {
        let sky = [0.5, 0.3 * number(), 0.3 * number(), 0.3 * number()].map(f16::from_f64);
        let rotation =
            glam::DQuat::from_axis_angle(DVec3::new(number(), number(), number()).normalize(), number());
        let turned = turned_skies(&[sky], &[rotation])[0];
        let direction = DVec3::new(number(), number(), number()).normalize();
        let seen = |sky: [f16; 4], direction| sky_toward(sky.map(f16::to_f64).into(), direction);
        assert!((seen(sky, direction) - seen(turned, rotation * direction)).abs() < 1e-3);
    }
}
