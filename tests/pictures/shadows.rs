//! Shadows between yarns and inside of them.

use crate::draw::{draw, draw_counted, mean_channel, scene, swatch};
use glam::DVec3;
use worsted::io::curves::{Basis, Curve, CurveSet, UpAxis};
use worsted::io::picture::LinearImage;
use worsted::math::tone::Display;
use worsted::metrics::error::compare;
use worsted::yarn::presets;

const SIZE: [u32; 2] = [160, 96];
const BARE: [&str; 2] = ["yarn.loop_density_per_mm=0", "yarn.hair_density_per_mm=0"];
/// Yarn whose tube hides all that lies behind its outline, and which its own fibers do not shadow.
const OPAQUE: [&str; 2] = ["shading.extinction_scale=1000", "shadow.self=false"];
const DARK: &str = "ambient.radiance=[0, 0, 0]";

/// Straight yarns along X, each through one of `places` (y, z).
fn straight(places: &[[f64; 2]]) -> CurveSet {
    let curve = |&[y, z]: &[f64; 2]| Curve {
        points: (-12..=12).map(|i| DVec3::new(1.5 * f64::from(i), y, z)).collect(),
        closed: false,
    };
    let curves = places.iter().map(curve).collect();
    CurveSet { basis: Basis::CatmullRom, up_axis: Some(UpAxis::Y), curves }
}

fn outer_radius_mm() -> f64 {
    presets::yarn(presets::DEFAULT_YARN).unwrap().outer_radius_mm()
}

/// From straight ahead, about two yarns high.
fn ahead(curves: &CurveSet, sets: &[&str]) -> LinearImage {
    let view = [
        "shadow.map=true",
        "shadow.self=true",
        "camera.yaw_deg=0",
        "camera.pitch_deg=0",
        "camera.distance_mm=60",
        "camera.fov_y_deg=7",
        "camera.target_mm=[0, 0, 0]",
    ];
    draw(scene(curves, &[&view[..], sets].concat()), SIZE, 4).linear
}

fn light(direction: DVec3) -> String {
    format!("light=[{{direction = {:?}}}]", direction.to_array())
}

fn flip(a: &LinearImage, b: &LinearImage) -> f64 {
    compare(a, b, &Display::PLAIN).unwrap().error.covered.flip_mean
}

/// Mean red, over what is covered, of the rows in a part of the picture's height, from the top.
fn rows(image: &LinearImage, from: f64, to: f64) -> f64 {
    let height = f64::from(image.height);
    let width = image.width as usize;
    let (start, end) = ((from * height) as usize * width, (to * height) as usize * width);
    let covered: Vec<f64> =
        image.pixels[start..end].iter().filter(|p| p[3] > 0.0).map(|p| f64::from(p[0] / p[3])).collect();
    covered.iter().sum::<f64>() / covered.len().max(1) as f64
}

#[test]
fn a_straight_yarn_is_not_shadowed_by_its_own_tube() {
    let yarn = straight(&[[0.0, 0.0]]);
    for (degrees, across) in [
        (90.0, DVec3::NEG_Z),
        (60.0, DVec3::NEG_Y),
        (30.0, DVec3::NEG_Z),
        (12.0, DVec3::NEG_Y),
        (4.0, DVec3::new(0.0, -0.6, -0.8)),
        (-20.0, DVec3::Y),
        (45.0, DVec3::Z),
        (0.0, DVec3::NEG_Z),
    ] {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let light = light(sin * across + cos * DVec3::X);
        let both = ["shadow.map=true", "shadow.map=false"].map(|map| ahead(&yarn, &[&light, map]));
        let error = flip(&both[0], &both[1]);
        println!("light at {degrees} degrees to the yarn: FLIP {error:.5}");
        assert!(error <= 0.002, "at {degrees} degrees: {error}");
    }
    // Another yarn between it and the light is seen at once.
    let sky = light(DVec3::NEG_Y);
    let two = straight(&[[0.0, 0.0], [2.5, 0.0]]);
    let both = ["shadow.map=true", "shadow.map=false"].map(|map| ahead(&two, &[&sky, map]));
    assert!(flip(&both[0], &both[1]) > 0.05);
}

#[test]
fn what_another_yarn_hides_is_black_up_to_where_they_touch() {
    let radius = outer_radius_mm();
    for apart in [2.0 * radius, 3.0 * radius] {
        let pair = straight(&[[0.5 * apart, 0.0], [-0.5 * apart, 0.0]]);
        let above = light(DVec3::NEG_Y);
        let seen = |sets: &[&str]| ahead(&pair, &[&BARE[..], &[DARK, &above], sets].concat());
        let lit = seen(&[&OPAQUE[..], &["shadow.map=false"]].concat());
        let shadowed = seen(&OPAQUE);
        // Below what the upper yarn's last fibers reach down to.
        let [mean, unshadowed] = [&shadowed, &lit].map(|image| rows(image, 0.56, 1.0));
        println!("{apart:.2} mm apart: below {mean:.6} of {unshadowed:.4}");
        assert!(unshadowed > 0.02, "the lower yarn is lit without the map: {unshadowed}");
        // Single fibers at the rim: plies reach farther out there than the upper ones hide on average over a turn.
        assert!(mean < 0.01 * unshadowed, "light leaks: {mean} of {unshadowed}");
        // The upper yarn is as it was.
        let upper = |image: &LinearImage| rows(image, 0.0, 0.48);
        assert!((upper(&shadowed) / upper(&lit) - 1.0).abs() < 0.01);
        // Through the thin rim of a yarn as it is some light passes: little of it.
        let [lit, shadowed] =
            ["shadow.map=false", "shadow.map=true"].map(|map| rows(&seen(&[map]), 0.52, 1.0));
        assert!(shadowed > 0.0 && shadowed < 0.15 * lit, "{apart:.2} mm apart: {shadowed} of {lit}");
    }
}

#[test]
fn point_and_spot_lights_cast_the_shadows_of_a_sun_in_the_same_place() {
    let pair = straight(&[[1.4, 0.0], [-1.4, 0.0]]);
    let sets =
        |light: &str| [&BARE[..], &OPAQUE, &[DARK, "shadow.resolution=4096", light]].concat().join(";");
    let shot = |light: &str| {
        let sets = sets(light);
        let sets: Vec<&str> = sets.split(';').collect();
        ahead(&pair, &sets)
    };
    let sun = shot("light=[{direction = [0, -1, 0], irradiance = [3, 3, 3]}]");
    let spot =
        "kind = \"spot\", position_mm = [0, 200, 0], direction = [0, -1, 0], intensity = [0.12, 0.12, 0.12]";
    let point = "kind = \"point\", position_mm = [0, 200, 0], intensity = [0.12, 0.12, 0.12]";
    for (name, light) in [
        ("spot", format!("light=[{{{spot}, outer_angle_deg = 6}}]")),
        ("point", format!("light=[{{{point}}}]")),
    ] {
        let found = shot(&light);
        let error = flip(&found, &sun);
        println!("{name}: FLIP {error:.4} to a sun");
        // A light this near is not quite a sun: its rays go apart by half a degree.
        assert!(error < 0.04, "{name}: {error}");
        assert!(rows(&found, 0.52, 1.0) < 0.01 * rows(&found, 0.0, 0.48), "{name}: the lower yarn is lit");
    }
}

#[test]
fn a_wide_light_casts_soft_shadows_of_the_same_strength() {
    // A yarn well above a swatch, so that its shadow has room to widen.
    let cloth = |size_deg: &str| {
        let light = format!("light=[{{direction = [0.3, -0.4, -1], angular_size_deg = {size_deg}}}]");
        draw(scene(&swatch(), &[DARK, "shadow.map=true", "shadow.self=true", &light]), SIZE, 16).linear
    };
    let [sharp, soft, softer] = ["0", "2", "12"].map(cloth);
    let brightness = [&sharp, &soft, &softer].map(|image| mean_channel(image, 0));
    println!("brightness under lights 0, 2 and 12 degrees wide: {brightness:.4?}");
    assert!((brightness[1] / brightness[0] - 1.0).abs() < 0.05, "{brightness:?}");
    assert!((brightness[2] / brightness[0] - 1.0).abs() < 0.2, "{brightness:?}");
    assert!(flip(&softer, &sharp) > flip(&soft, &sharp), "a wider light blurs more");
}

/// Share of light that the shadow map leaves at each pixel, and which pixels it is known of.
fn left_by_the_map(sets: &[&str], resolution: &str) -> (Vec<f64>, LinearImage) {
    let shot = |map: &str| {
        draw(scene(&swatch(), &[sets, &[DARK, "shadow.self=true", map, resolution]].concat()), SIZE, 4).linear
    };
    let [on, off] = ["shadow.map=true", "shadow.map=false"].map(shot);
    let share = |(on, off): (&[f32; 4], &[f32; 4])| f64::from(on[0]) / f64::from(off[0]).max(1e-6);
    (on.pixels.iter().zip(&off.pixels).map(share).collect(), off)
}

#[test]
fn shadow_edges_stay_where_they_are_as_the_camera_moves() {
    // Narrow, so that moving sideways moves the picture and changes nothing else; a pixel is this wide.
    let pixel_mm = 2.0 * 400.0 * f64::to_radians(0.5 * 1.6).tan() / f64::from(SIZE[1]);
    let at = |pixels: u32, resolution: &str| {
        let target = format!("camera.target_mm=[{}, 0, 0]", f64::from(pixels) * pixel_mm);
        let sets = [
            "camera.distance_mm=400",
            "camera.fov_y_deg=1.6",
            "camera.yaw_deg=0",
            "camera.pitch_deg=0",
            &target,
        ];
        left_by_the_map(&sets, resolution)
    };
    let (start, surface) = at(0, "shadow.resolution=512");
    let difference = |pixels: u32, resolution: &str| {
        let (moved, moved_surface) = at(pixels, resolution);
        let width = SIZE[0] as usize;
        let (mut sum, mut count) = (0.0, 0.0);
        for i in (0..start.len()).filter(|i| i % width + (pixels as usize) < width) {
            // What was at i + pixels is at i now. Where the same thing is seen, and all of a pixel is covered.
            let (a, b) = (&surface.pixels[i + pixels as usize], &moved_surface.pixels[i]);
            if a[3] == 1.0 && b[3] == 1.0 && a[0] > 0.01 && (a[0] / b[0] - 1.0).abs() < 0.02 {
                sum += (start[i + pixels as usize] - moved[i]).abs();
                count += 1.0;
            }
        }
        assert!(count > 500.0, "too little of the cloth is comparable: {count}");
        sum / count
    };
    for pixels in [1, 3, 8, 21] {
        let found = difference(pixels, "shadow.resolution=512");
        println!("moved by {pixels} pixels: shadow edges change by {found:.5}");
        assert!(found < 0.01, "{pixels}: {found}");
    }
    // Texels that lie elsewhere are seen.
    assert!(difference(3, "shadow.resolution=90") > 0.01);
}

#[test]
fn pieces_on_which_a_limit_of_shadows_acts_are_counted() {
    let yarn = straight(&[[0.0, 0.0], [3.0, 2.0]]);
    let counted = |degrees: f64, spread_deg: f64, map: &str| {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let light = format!("light=[{{direction = [{cos}, {}, 0], angular_size_deg = {spread_deg}}}]", -sin);
        let (_, stats) = draw_counted(scene(&yarn, &[&light, map]), SIZE, 1, true);
        let limits = [stats.patches_along_light, stats.patches_softer_than_searched].map(Option::unwrap);
        (limits, stats.patches_drawn.unwrap())
    };
    let shadowed = "shadow.map=true";
    let (usual, drawn) = counted(40.0, 1.0, shadowed);
    assert!(usual == [0, 0] && drawn > 5, "{usual:?} of {drawn}");
    // 24 is the cotangent of 2.4 degrees.
    assert_eq!(counted(2.6, 0.0, shadowed).0, [0, 0]);
    let (along, drawn) = counted(2.2, 0.0, shadowed);
    assert!(along == [drawn, 0] && drawn > 5, "{along:?} of {drawn}");
    let (wide, drawn) = counted(40.0, 60.0, shadowed);
    assert!(wide[0] == 0 && wide[1] > 5 && wide[1] <= drawn, "{wide:?} of {drawn}");
    assert_eq!(counted(2.2, 60.0, "shadow.map=false").0, [0, 0]);
}
