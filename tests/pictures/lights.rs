//! Lights, the environment, and how a picture is shown.

use glam::{DVec2, DVec3};
use worsted::frame::sampling::Sampling;
use worsted::frame::{Renderer, Request, camera};
use worsted::io::picture::{LinearImage, write_exr};
use worsted::math::color::srgb_from_linear;
use worsted::math::tone::Display;
use worsted::math::tone::{tone_filmic, tone_neutral};
use worsted::metrics::error::compare;
use worsted::scene::SceneFile;
use worsted::scene::light::LightTable;
use worsted::vulkan::DeviceChoice;

use crate::device::shared;
use crate::draw::{Picture, draw, hook, mean_channel, mean_radiance, scene};

const SMALL: [u32; 2] = [96, 72];
const DARK: &str = "ambient.radiance=[0, 0, 0]";
/// A warm directional light, a cool point light near the yarn, and a spot on a part of it.
const SUN: &str = "{irradiance = [2, 1.5, 1]}";
const LAMP: &str = "{kind = 'point', position_mm = [10, 20, 15], intensity = [4e-4, 6e-4, 1e-3]}";
const SPOT: &str = "{kind = 'spot', position_mm = [-4, 4, 60], direction = [0, 0, -1], \
                    intensity = [5e-3, 5e-3, 5e-3], inner_angle_deg = 2, outer_angle_deg = 4}";

fn lit(lights: &[&str], more: &[&str], samples: u32) -> LinearImage {
    let lights = format!("light=[{}]", lights.join(", "));
    draw(scene(&hook(), &[&[lights.as_str(), DARK], more].concat()), SMALL, samples).linear
}

/// Pixels whose radiance is not the sum of the others', but for half floats' rounding.
fn unsummed(parts: &[LinearImage], whole: &LinearImage) -> usize {
    let off = |(index, whole): &(usize, &[f32; 4])| {
        (0..3).any(|c| {
            let sum: f32 = parts.iter().map(|part| part.pixels[*index][c]).sum();
            (sum - whole[c]).abs() > 1e-3 * whole[c] + 1e-6
        })
    };
    whole.pixels.iter().enumerate().filter(off).count()
}

#[test]
fn lights_add_up() {
    let alone = [SUN, LAMP, SPOT].map(|light| lit(&[light], &[], 1));
    assert!(alone.iter().all(|part| mean_radiance(part) > 0.003), "each gives light");
    let all = lit(&[SUN, LAMP, SPOT], &[], 1);
    assert_eq!(unsummed(&alone, &all), 0);
    assert!(unsummed(&alone[..2], &all) > 100 && unsummed(&alone[1..], &all) > 500, "the check is blind");
    // Dark lights among them change nothing, not even the last bit; nor does their order, but for rounding.
    let unlit = "{kind = 'point', position_mm = [0, 0, 0], intensity = [0, 0, 0]}";
    assert_eq!(lit(&[SUN, unlit, LAMP, SPOT], &[], 1), all);
    assert_eq!(unsummed(&[lit(&[SPOT, SUN, LAMP], &[], 1)], &all), 0);
}

#[test]
fn a_point_light_far_away_is_a_directional_one() {
    let metres = 100.0;
    let from = DVec3::new(0.3, 0.8, 0.5).normalize();
    let vector = |v: DVec3| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z);
    let sun = format!("{{direction = {}, irradiance = [3, 2, 1]}}", vector(-from));
    let far = |place_m: DVec3| {
        let place = vector(1e3 * place_m);
        let strength = vector(DVec3::new(3.0, 2.0, 1.0) * metres * metres);
        lit(&[&format!("{{kind = 'point', position_mm = {place}, intensity = {strength}}}")], &[], 4)
    };
    let directional = lit(&[&sun], &[], 4);
    let flip =
        |other: &LinearImage| compare(&directional, other, &Display::PLAIN).unwrap().error.covered.flip_mean;
    let (same, aside) =
        (flip(&far(metres * from)), flip(&far(metres * DVec3::new(0.5, 0.8, 0.3).normalize())));
    println!("100 m away: mean FLIP {same:.5}; from elsewhere {aside:.5}");
    assert!(same <= 0.002 && aside > 0.01, "{same}, {aside}");
}

/// Where each pixel's middle meets the plane z = 0 of the hook's file, in mm.
fn places() -> Vec<DVec2> {
    let scene = scene(&hook(), &[]);
    let camera = camera(&scene, SMALL);
    let eye = camera.eye_world + scene.origin_mm;
    let [width, height] = SMALL.map(f64::from);
    let place = |row: u32, column: u32| {
        let across = 2.0 * (f64::from(column) + 0.5) / width - 1.0;
        let down = 2.0 * (f64::from(row) + 0.5) / height - 1.0;
        eye.truncate() + eye.z * camera.half_extent * DVec2::new(across, -down)
    };
    (0..SMALL[1]).flat_map(|row| (0..SMALL[0]).map(move |column| place(row, column))).collect()
}

#[test]
fn outside_of_a_spot_it_is_black_and_inside_as_under_a_point_light() {
    let spot = lit(&[SPOT], &[], 1);
    let bare = "{kind = 'point', position_mm = [-4, 4, 60], intensity = [5e-3, 5e-3, 5e-3]}";
    let point = lit(&[bare], &[], 1);
    let radius = |angle_deg: f64| 60.0 * angle_deg.to_radians().tan();
    // The yarn is up to 3 mm before and behind the plane: so far off its places may seem.
    let margin = 1.0;
    let (mut inside, mut outside) = (0, 0);
    let pixels = spot.pixels.iter().zip(&point.pixels).zip(places());
    for ((spot, point), place) in pixels.filter(|((_, point), _)| point[1] > 0.0) {
        let distance = place.distance(DVec2::new(-4.0, 4.0));
        if distance > radius(4.0) + margin {
            outside += 1;
            assert_eq!(spot[..3], [0.0; 3], "{distance} mm from the axis");
        } else if distance < radius(2.0) - margin {
            inside += 1;
            assert!((0..3).all(|c| (spot[c] / point[c] - 1.0).abs() < 2e-3), "{spot:?}, not {point:?}");
        }
    }
    println!("{inside} pixels inside, {outside} outside");
    assert!(inside > 20 && outside > 200, "{inside}, {outside}");
}

#[test]
fn a_light_is_where_the_file_says_however_far_that_is() {
    // Moved with the yarn, nothing changes.
    let away: Vec<LinearImage> = [DVec3::ZERO, DVec3::new(1e5, -2e5, 3e5)]
        .map(|by| {
            let mut moved = hook();
            moved.curves.iter_mut().flat_map(|c| &mut c.points).for_each(|p| *p += by);
            let place = by + DVec3::new(-4.0, 4.0, 60.0);
            let place = format!("position_mm = [{:?}, {:?}, {:?}]", place.x, place.y, place.z);
            let light = format!("light=[{}]", SPOT.replace("position_mm = [-4, 4, 60]", &place));
            draw(scene(&moved, &[&light, DARK]), SMALL, 1).linear
        })
        .into();
    let moved = compare(&away[0], &away[1], &Display::PLAIN).unwrap().error.covered.flip_mean;
    assert!(moved < 0.005, "mean FLIP {moved} for the same scene elsewhere");
}

#[test]
fn a_fiber_at_a_light_is_bright_and_finite() {
    let at = "{kind = 'point', position_mm = [-4, 4, 0], intensity = [1e6, 1e6, 1e6]}";
    let device = shared(DeviceChoice::Software);
    let sets = [format!("light=[{at}]"), "display.tone=filmic".into()];
    let scene = scene(&hook(), &sets.each_ref().map(String::as_str));
    let request =
        Request { size: SMALL, sampling: Sampling::new(4).unwrap(), statistics: false, profile: false };
    let mut renderer = Renderer::new(device, scene, request).unwrap();
    let picture = renderer.render(&|_| ()).unwrap();
    assert_eq!(renderer.stats().nan_pixels, 0);
    assert_eq!(renderer.stats().clamped_pixels, 0, "light is scaled to what frames can hold");
    assert!(picture.display.contains(&[255; 4]));
}

#[test]
fn a_light_turns_between_pictures_without_a_new_renderer() {
    let tables = |lights: &[&str]| -> Vec<LightTable> {
        let text = format!("light = [{}]", lights.join(", "));
        toml::from_str::<SceneFile>(&text).unwrap().light.unwrap()
    };
    let request =
        Request { size: SMALL, sampling: Sampling::new(1).unwrap(), statistics: false, profile: false };
    let both = scene(&hook(), &[&format!("light=[{SUN}, {LAMP}]"), DARK, "shadow.map=true"]);
    let mut renderer = Renderer::new(shared(DeviceChoice::Software), both, request).unwrap();
    let mut after = |lights: &[&str]| {
        renderer.set_lights(tables(lights)).map_err(|error| error.to_string())?;
        Ok::<_, String>(renderer.render(&|_| ()).unwrap().linear)
    };
    let turned = SUN.replace("{", "{direction = [-1, -0.2, 0], ");
    for lights in [&[SUN, LAMP][..], &[&turned, LAMP], &[SPOT], &[], &[LAMP]] {
        assert_eq!(after(lights).unwrap(), lit(lights, &["shadow.map=true"], 1).pixels, "{lights:?}");
    }
    let refused = |result: Result<_, String>, expected: &str| {
        let message = result.map(|_: Vec<[f32; 4]>| ()).unwrap_err();
        assert!(message.contains(expected), "{message}");
    };
    refused(after(&[LAMP, LAMP]), "at most 7 shadow views, as at first, found 12");
    refused(after(&[SUN, SUN, SUN]), "at most 2 that shine, as at first, found 3");
    refused(after(&["{irradiance = [-1, 0, 0]}"]), "light.0.irradiance");
    let sun = scene(&hook(), &[&format!("light=[{SUN}]"), DARK]);
    let mut directional = Renderer::new(shared(DeviceChoice::Software), sun, request).unwrap();
    let error = directional.set_lights(tables(&[LAMP])).unwrap_err().to_string();
    assert!(error.contains("directional lights alone"), "{error}");
}

/// The hook lit by an environment picture alone.
fn in_environment(picture: &LinearImage, more: &[&str]) -> LinearImage {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("environment.exr");
    write_exr(&path, picture).unwrap();
    let environment = format!("ambient.environment={}", path.display());
    draw(scene(&hook(), &[&["light=[]", environment.as_str()], more].concat()), SMALL, 4).linear
}

#[test]
fn a_constant_environment_is_the_same_ambient_light() {
    let constant = LinearImage::filled(16, 8, [0.4, 0.5, 0.25, 1.0]);
    let flat = draw(scene(&hook(), &["light=[]", "ambient.radiance=[0.8, 1, 0.5]"]), SMALL, 4).linear;
    let picture = in_environment(&constant, &["ambient.environment_scale=2"]);
    let flip = |other: &LinearImage| compare(&flat, other, &Display::PLAIN).unwrap().error.covered.flip_mean;
    assert!(flip(&picture) < 0.002, "mean FLIP {}", flip(&picture));
    assert!(flip(&in_environment(&constant, &[])) > 0.05, "the scale is seen");
}

#[test]
fn an_environment_turns_with_the_camera() {
    // Bright on the right of the middle.
    let mut side = LinearImage::filled(32, 16, [0.05, 0.05, 0.05, 1.0]);
    side.pixels.iter_mut().skip(4 * 32).take(8 * 32).enumerate().for_each(|(i, pixel)| {
        if (20..28).contains(&(i % 32)) {
            *pixel = [4.0, 4.0, 4.0, 1.0];
        }
    });
    let from = |yaw_deg: f64| {
        let yaw = format!("ambient.environment_yaw_deg={yaw_deg:?}");
        in_environment(&side, &[&yaw, "occlusion.mode=none", "shading.specular=false", "shadow.self=false"])
    };
    let [right, behind, left] = [0.0, -90.0, 180.0].map(from);
    // Of a directional light from the same side it is a soft likeness, and not of one from the other.
    let sun = |direction: &str| {
        lit(&[&format!("{{direction = {direction}}}")], &["shading.specular=false", "shadow.self=false"], 4)
    };
    let (from_right, from_left) = (sun("[-1, 0, 0]"), sun("[1, 0, 0]"));
    let likeness = |a: &LinearImage, b: &LinearImage| {
        let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
        let (mean_a, mean_b) = (mean_channel(a, 1), mean_channel(b, 1));
        for (a, b) in a.pixels.iter().zip(&b.pixels).filter(|(a, _)| a[3] == 1.0) {
            let (a, b) = (f64::from(a[1]) - mean_a, f64::from(b[1]) - mean_b);
            (ab, aa, bb) = (ab + a * b, aa + a * a, bb + b * b);
        }
        ab / (aa * bb).sqrt()
    };
    let [same, other] = [&from_right, &from_left].map(|sun| likeness(&right, sun));
    let [turned, wrong] = [&from_left, &from_right].map(|sun| likeness(&left, sun));
    println!(
        "likeness to a light from the same side {same:.3}, {turned:.3}, from the other {other:.3}, {wrong:.3}"
    );
    assert!(same > 0.5 && turned > 0.5 && other < 0.0 && wrong < 0.0);
    // Turned by -90 degrees, what was on the right is behind the camera and lights all that is seen.
    let [on_the_right, from_behind] = [&right, &behind].map(mean_radiance);
    assert!(from_behind > 1.3 * on_the_right, "{from_behind}, {on_the_right}");
}

#[test]
fn fibers_let_the_light_behind_them_through_and_reflect_what_is_before() {
    // Bright in the middle, which is behind the cloth.
    let mut window = LinearImage::filled(32, 16, [0.05, 0.05, 0.05, 1.0]);
    window.pixels.iter_mut().enumerate().for_each(|(i, pixel)| {
        if (12..20).contains(&(i % 32)) && (4..12).contains(&(i / 32)) {
            *pixel = [4.0, 4.0, 4.0, 1.0];
        }
    });
    let from = |yaw_deg: f64, c_tt: &str, c_r: &str| {
        let yaw = format!("ambient.environment_yaw_deg={yaw_deg:?}");
        let (c_tt, c_r) = (format!("fiber.c_tt={c_tt}"), format!("fiber.c_r={c_r}"));
        let sets = [&yaw, "occlusion.mode=none", "shadow.self=false", "shading.diffuse=false", &c_tt, &c_r];
        mean_radiance(&in_environment(&window, &sets))
    };
    let (none, all) = ("[0, 0, 0]", "[1, 1, 1]");
    let [through, back] = [0.0, 180.0].map(|yaw| from(yaw, all, none));
    assert!(through > 3.0 * back, "transmitted: {through} from behind, {back} from before");
    // What is reflected comes from all azimuths of the cone that mirrors the view, which runs through the middle of
    // the window and past its opposite.
    let [behind, before] = [0.0, 180.0].map(|yaw| from(yaw, none, all));
    assert!((1.0..2.0).contains(&(behind / before)), "reflected: {behind} from behind, {before} from before");
}

/// What a display shows of linear radiance, worked out in f64.
fn shown(linear: DVec3, tone: fn(DVec3) -> DVec3) -> [f64; 3] {
    tone(linear).to_array().map(|c| 255.0 * srgb_from_linear(c))
}

/// Largest difference of the display's bytes from `expected` of each linear pixel.
fn worst_byte(picture: &Picture, expected: impl Fn([f64; 4]) -> [f64; 4]) -> f64 {
    let pairs = picture.linear.pixels.iter().zip(&picture.display.pixels);
    let differences = pairs.flat_map(|(linear, bytes)| {
        let expected = expected(linear.map(f64::from));
        (0..4).map(move |c| (expected[c] - f64::from(bytes[c])).abs())
    });
    differences.fold(0.0, f64::max)
}

fn display_of(sets: &[&str]) -> Picture {
    draw(scene(&hook(), sets), SMALL, 4)
}

#[test]
fn the_tone_curve_is_the_one_asked_for() {
    let over = |background: DVec3, tone: fn(DVec3) -> DVec3| {
        move |[r, g, b, a]: [f64; 4]| {
            let [r, g, b] = shown(2.0 * (DVec3::new(r, g, b) + (1.0 - a) * background), tone);
            [r, g, b, 255.0]
        }
    };
    let background = DVec3::new(0.055, 0.06, 0.07);
    let neutral = display_of(&["display.exposure_stops=1"]);
    let filmic = display_of(&["display.exposure_stops=1", "display.tone=filmic"]);
    assert!(worst_byte(&neutral, over(background, tone_neutral)) < 0.6);
    assert!(worst_byte(&filmic, over(background, tone_filmic)) < 0.6);
    assert!(worst_byte(&filmic, over(background, tone_neutral)) > 5.0, "the curves differ");
    assert_eq!(filmic.linear, neutral.linear, "a curve is for the display alone");
}

#[test]
fn a_transparent_picture_is_the_yarn_alone() {
    let straight = |[r, g, b, a]: [f64; 4]| {
        let yarn = if a > 0.0 { DVec3::new(r, g, b) / a } else { DVec3::ZERO };
        let [r, g, b] = shown(yarn, tone_neutral);
        [r, g, b, 255.0 * a]
    };
    let transparent = display_of(&["display.transparent=true"]);
    assert!(worst_byte(&transparent, straight) < 0.6);
    let partly = transparent.linear.pixels.iter().filter(|p| p[3] > 0.0 && p[3] < 1.0).count();
    assert!(partly > 100, "{partly} pixels are partly covered");
    // Nothing of the background, and the opaque picture is another.
    let white = display_of(&["display.transparent=true", "display.background=[1, 1, 1]"]);
    assert_eq!(white.display, transparent.display);
    assert!(worst_byte(&display_of(&[]), straight) > 50.0);
}
