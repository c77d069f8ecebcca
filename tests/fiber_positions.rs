//! Where the device puts fibers, through the renderer's own buffers and its own GLSL function, against the
//! f64 twin on the curves as loaded.

use glam::{DMat4, DVec2, DVec3, Vec3Swizzles};
use std::path::{Path, PathBuf};
use worsted::frame::sampling::Sampling;
use worsted::frame::{Renderer, Request};
use worsted::math::rng::Rng;
use worsted::scene::Scene;
use worsted::scene::features::Features;
use worsted::stress::placed::{Answer, Query, ask_device};
use worsted::vulkan::DeviceChoice;
use worsted::yarn::fetch::FiberField;
use worsted::yarn::fiber::FiberPoint;
use worsted::yarn::period::Kind;

#[path = "support/device.rs"]
mod device;
use device::shared;

const SIZE: [u32; 2] = [1280, 960];
const QUERIES: u64 = 10_000;
/// Largest distance in pixels between the device's and the f64 position of a fiber.
const BOUND_PIXELS: f64 = 0.02;
/// Largest angle in radians between the tangents.
const BOUND_RADIANS: f64 = 1e-3;

fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Random pieces, fibers and places; every eighth place is an end of its piece.
fn queries(scene: &Scene) -> Vec<Query> {
    let fabric = &scene.fabrics[0];
    let (segments, fibers) = (fabric.strands.pieces.len() as f64, f64::from(fabric.yarn.fiber_count()));
    (0..QUERIES)
        .map(|index| {
            let mut rng = Rng::new(11, &[index]);
            let mut below = |count: f64| (rng.uniform() * count) as u32;
            let (segment, fiber, special) = (below(segments), below(fibers), below(16.0));
            let t = if special < 2 { special as f32 } else { rng.uniform() as f32 };
            Query { segment, fiber, t, padding: 0 }
        })
        .collect()
}

/// The same from the curves as loaded, all in f64, and what the fiber is there.
fn twin(field: &FiberField, query: &Query) -> (FiberPoint, Kind) {
    let piece = &field.strands.pieces[query.segment as usize];
    let (point, period) = field.fiber_at(piece, query.fiber as usize, f64::from(query.t));
    (point, period.kind)
}

/// Where a world position lands, in pixels; `None` behind the near plane.
fn pixels(clip_from_world: DMat4, world: DVec3) -> Option<DVec2> {
    let clip = clip_from_world * world.extend(1.0);
    let size = DVec2::new(f64::from(SIZE[0]), f64::from(SIZE[1]));
    (clip.w > 0.0).then(|| 0.5 * size * (clip.truncate().truncate() / clip.w + 1.0))
}

#[derive(Debug, Default)]
struct Worst {
    pixels: f64,
    radians: f64,
    center_distance_mm: f64,
}

/// Holds the device's answers to the f64 ones. `expected` is relative to the scene's origin.
fn compare(
    clip_from_world: DMat4,
    answers: &[Answer],
    expected: impl Fn(usize) -> (FiberPoint, Kind),
) -> Result<Worst, String> {
    let mut worst = Worst::default();
    for (index, answer) in answers.iter().enumerate() {
        let (expected, kind) = expected(index);
        let position = DVec3::from_array(answer.position.map(f64::from));
        let tangent = DVec3::from_array(answer.tangent.map(f64::from));
        let fail = |what: String| Err(format!("query {index}: {what}: {answer:?}, expected {expected:?}"));
        if answer.kind != kind as u32 as f32 {
            return fail(format!("expected {kind:?}"));
        }
        let both = pixels(clip_from_world, position).zip(pixels(clip_from_world, expected.position));
        let Some((found, wanted)) = both else { return fail("behind the camera".into()) };
        let off = (found - wanted).length();
        let turned = tangent.cross(expected.tangent).length().atan2(tangent.dot(expected.tangent));
        let distance = (f64::from(answer.center_distance) - expected.center_distance).abs();
        worst.pixels = worst.pixels.max(off);
        worst.radians = worst.radians.max(turned);
        worst.center_distance_mm = worst.center_distance_mm.max(distance);
        // Written so that a NaN fails.
        let within = off < BOUND_PIXELS;
        if !within {
            return fail(format!("{off} pixels off"));
        }
        let within = turned < BOUND_RADIANS && (tangent.length() - 1.0).abs() < 1e-5;
        if !within {
            return fail(format!("tangent {turned} radians off"));
        }
        let within = distance < 1e-4;
        if !within {
            return fail(format!("distance from the centre line {distance} mm off"));
        }
    }
    Ok(worst)
}

struct Asked {
    scene: Scene,
    queries: Vec<Query>,
    answers: Vec<Answer>,
    clip_from_world: DMat4,
}

impl Asked {
    fn new(path: &Path) -> Self {
        let scene = Scene::load(path, &[]).expect("a scene that loads");
        let features = Features::new(&scene.file, &scene.fabrics[0], false);
        let sampling = Sampling::new(1).expect("one sample is allowed");
        let request = Request { size: SIZE, sampling, statistics: false, profile: false };
        let renderer = Renderer::new(shared(DeviceChoice::Auto), scene.clone(), request).expect("a renderer");
        let clip_from_world = renderer.camera().clip_from_world(SIZE, DVec2::ZERO);
        let queries = queries(&scene);
        let answers = ask_device(shared(DeviceChoice::Auto), &renderer, &features, &queries)
            .expect("answers without validation errors");
        assert_eq!(answers.len() as u64, QUERIES);
        Self { scene, queries, answers, clip_from_world }
    }

    /// Compares with the f64 twin, whose answers `edit` may spoil.
    fn compare(&self, edit: impl Fn(&mut FiberPoint)) -> Result<Worst, String> {
        let fabric = &self.scene.fabrics[0];
        let field = FiberField::new(fabric.strands.clone(), &fabric.yarn, self.scene.file.seed);
        compare(self.clip_from_world, &self.answers, |index| {
            let (mut point, kind) = twin(&field, &self.queries[index]);
            point.position -= self.scene.origin_mm;
            edit(&mut point);
            (point, kind)
        })
    }
}

#[test]
fn fibers_of_the_swatch_are_where_the_f64_twin_has_them() {
    let swatch = Asked::new(&repository().join("models/demo.toml"));
    println!("swatch: {:?}", swatch.compare(|_| {}).unwrap());

    // The comparison must see a shift of less than a hair's breadth, exchanged axes, a turned tangent.
    let wrong: [fn(&mut FiberPoint); 4] = [
        |point| point.position *= 1.001,
        |point| point.position = point.position.yxz(),
        |point| point.tangent = (point.tangent + 2e-3 * point.tangent.any_orthonormal_vector()).normalize(),
        |point| point.center_distance *= 1.01,
    ];
    for (index, edit) in wrong.into_iter().enumerate() {
        assert!(swatch.compare(edit).is_err(), "wrong twin {index} passed");
    }
}

#[test]
fn fibers_of_the_glove_are_where_the_f64_twin_has_them() {
    let glove: PathBuf = repository().join("../shared/data/yuksel-bcc/glove.bcc");
    if !glove.exists() {
        println!("skipped: no model at {}", glove.display());
        return;
    }
    println!("glove: {:?}", Asked::new(&glove).compare(|_| {}).unwrap());
}
