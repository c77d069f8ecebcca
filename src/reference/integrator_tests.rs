use super::*;
use crate::reference::accel::Accel;
use crate::reference::fibers::{RealiseSettings, realise};
use crate::reference::geometry::FiberGeometry;
use crate::reference::test_scene::{scene_of, straight, yarn};

fn tracer(text: &str, settings: TraceSettings) -> Tracer<f32> {
    let scene = scene_of(text, &[straight(0.0, 8.0, 0.0)], &yarn("cotton1", 20));
    let fibers = realise(&scene, &RealiseSettings::default()).unwrap();
    let accel = Accel::new(FiberGeometry::new(fibers, scene.origin_mm)).unwrap();
    Tracer::new(&scene, accel, [24, 24], settings)
}

fn mean(tracer: &Tracer<f32>, samples: u64) -> (DVec3, f64) {
    let (mut radiance, mut covered, mut count) = (DVec3::ZERO, 0.0, 0.0);
    for y in 0..24 {
        for x in 0..24 {
            for index in 0..samples {
                let seen = tracer.sample([x, y], index);
                assert!(seen.radiance.is_finite() && seen.rays > 0);
                radiance += seen.radiance;
                covered += f64::from(u8::from(seen.covered));
                count += 1.0;
            }
        }
    }
    (radiance / count, covered / count)
}

const CLOSE: &str = "[camera]\ndistance_mm = 3\n";

#[test]
fn the_camera_looks_through_the_pixels_that_the_fast_path_draws() {
    let tracer = tracer("[camera]\ndistance_mm = 30\nyaw_deg = 20\npitch_deg = 10", Default::default());
    let size = DVec2::splat(24.0);
    let clip_from_world = tracer.camera.clip_from_world(tracer.size, DVec2::ZERO);
    for place in [DVec2::new(0.0, 0.0), DVec2::new(20.5, 3.25), DVec2::new(12.0, 24.0)] {
        let ray = tracer.camera_ray(place);
        let clip = clip_from_world * (ray.origin + 17.0 * ray.direction).extend(1.0);
        let pixel = 0.5 * size * (DVec2::new(clip.x, clip.y) / clip.w + 1.0);
        assert!((pixel - place).length() < 1e-9, "{place} became {pixel}");
        let near = clip_from_world * ray.origin.extend(1.0);
        assert!((near.z / near.w - 1.0).abs() < 1e-9, "it starts on the near plane");
    }
}

#[test]
fn fibers_take_light_from_one_another_and_bounces_give_some_back() {
    let lit = |text: &str, settings| mean(&tracer(&format!("{text}\n{CLOSE}"), settings), 8);
    let (default, text) = (TraceSettings::default(), "[ambient]\nradiance = [0.5, 0.5, 0.5]");
    let (shadowed, covered) = lit(text, default);
    let (unshadowed, same) = lit(text, TraceSettings { shadows: false, ..default });
    let (bounced, _) = lit(text, TraceSettings { bounces: 4, ..default });
    assert!(covered == same && covered > 0.2);
    assert!(shadowed.x < 0.9 * unshadowed.x, "{shadowed} {unshadowed}");
    assert!(shadowed.x * 1.05 < bounced.x, "{shadowed} {bounced}");
    let (dark, _) = lit("light = []\n[ambient]\nradiance = [0, 0, 0]", default);
    assert_eq!(dark, DVec3::ZERO);
}

#[test]
fn a_wide_light_gives_what_faces_it_its_irradiance() {
    let middle = DVec3::new(0.6, 0.0, 0.8);
    let count = 20_000;
    let half_angle = 0.5f64;
    let (mut facing, mut least) = (0.0, 1.0f64);
    for k in 0..count {
        let (direction, factor) = toward(middle, half_angle, &mut Rng::new(1, &[k]));
        assert!(direction.is_normalized());
        least = least.min(direction.dot(middle));
        facing += factor * direction.dot(middle) / count as f64;
    }
    assert!((facing - 1.0).abs() < 1e-9 && least >= half_angle.cos() - 1e-12, "{facing} {least}");
    assert!(least < half_angle.cos() + 1e-3, "the whole disk");
    assert_eq!(toward(middle, 0.0, &mut Rng::new(1, &[])), (middle, 1.0));
}
