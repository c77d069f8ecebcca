//! The judge and the fast path read the same scene file alike: where the fast path is asked to draw every fiber
//! whole and unshadowed, it draws what the judge traces without shadows.

use glam::DVec4;
use worsted::frame::sampling::Sampling;
use worsted::frame::{Renderer, Request};
use worsted::io::measured::MeasuredImage;
use worsted::knit::params::KnitParams;
use worsted::reference::accel::Accel;
use worsted::reference::fibers::realise;
use worsted::reference::geometry::FiberGeometry;
use worsted::reference::integrator::{TraceSettings, Tracer};
use worsted::reference::rendering::Rendering;
use worsted::scene::Scene;
use worsted::vulkan::DeviceChoice;

#[path = "support/device.rs"]
mod device;
use device::shared;

const SIZE: [u32; 2] = [64, 64];
const SAMPLES: u64 = 64;
/// Loops and hairs are left out: the fast path draws their taper in steps.
const EVERY_FIBER: &str = "
    yarn = { preset = 'rayon1', fibers_per_ply = 24, loop_density_per_mm = 0, hair_density_per_mm = 0 }
    quality = { level_of_detail = false, subdivision_tolerance_px = 0.02, max_subdivisions = 64 }
    debug = { fibers = 'every' }
    occlusion = { mode = 'none' }
    shadow = { map = false, self = false }
    camera = { distance_mm = 8, yaw_deg = 25, pitch_deg = 15 }
";

fn scene(more: &str) -> Scene {
    let file = toml::from_str(&format!("{more}\n{EVERY_FIBER}")).expect("a scene");
    let knit = KnitParams { courses: 3, wales: 3, ..KnitParams::swatch() };
    Scene::stockinette(file, &knit).expect("a swatch")
}

fn fast(scene: &Scene) -> DVec4 {
    let sampling = Sampling::new(SAMPLES as u32).expect("a number of samples");
    let request = Request { size: SIZE, sampling, statistics: false, profile: false };
    let mut renderer = Renderer::new(shared(DeviceChoice::Auto), scene.clone(), request).expect("a renderer");
    sum(&renderer.render(&|_| ()).expect("a picture").linear)
}

fn sum(pixels: &[[f32; 4]]) -> DVec4 {
    pixels.iter().map(|p| DVec4::from_array(p.map(f64::from))).sum()
}

/// The sums of the traced picture, and the standard error of its red.
fn traced(scene: &Scene) -> (DVec4, f64) {
    let fibers = realise(scene, &Default::default()).expect("fibers");
    let accel = Accel::new(FiberGeometry::<f32>::new(fibers, scene.origin_mm)).expect("a tree");
    let settings = TraceSettings { shadows: false, ..Default::default() };
    let tracer = Tracer::new(scene, accel, SIZE, settings);
    let mut rendering = Rendering::new(SIZE);
    while !rendering.is_done(SAMPLES) {
        rendering.advance(&tracer, SAMPLES, 64);
    }
    let MeasuredImage { mean, variance } = rendering.measured();
    let variance = variance.expect("more than one sample").iter().map(|v| f64::from(v[0])).sum::<f64>();
    (sum(&mean.pixels), variance.sqrt())
}

#[test]
fn every_fiber_without_shadows_is_the_same_picture_in_every_part_of_its_light() {
    for more in [
        "",
        "shading = { model = 'simple' }",
        "shading = { specular = false, ambient = false }",
        "shading = { diffuse = false, ambient = false }",
        "shading = { diffuse = false }\nlight = []",
    ] {
        let scene = scene(more);
        let (fast, (traced, error)) = (fast(&scene), traced(&scene));
        assert!((fast.w / traced.w - 1.0).abs() < 3e-3, "{more}: coverage {} and {}", fast.w, traced.w);
        for channel in 0..3 {
            // Tables and straight pieces are within 0.5%; the rest is noise.
            let off = (fast[channel] - traced[channel]).abs() / traced[channel];
            let allowed = 5e-3 + 4.0 * error / traced.x;
            assert!(off < allowed, "{more}: {fast}, traced {traced}: {off} of {allowed}");
            assert!(allowed < 0.04, "{more}: too noisy to tell");
        }
    }
}
