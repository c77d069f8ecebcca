//! Lights and ambient light as a scene file says them.

use super::*;
use std::f64::consts::FRAC_PI_4;

fn table(text: &str) -> LightTable {
    toml::from_str(text).unwrap()
}

fn refused(text: &str) -> String {
    check_lights(&[LightTable::default(), table(text)]).unwrap_err().to_string()
}

#[test]
fn every_kind_has_its_keys_and_no_others() {
    let place = "position_mm = [1, 2, 3]\n";
    for good in [
        "".to_owned(),
        "direction = [0, -1, 0]\nirradiance = [1, 2, 3]".to_owned(),
        format!("kind = 'point'\n{place}intensity = [1, 2, 3]"),
        format!("kind = 'spot'\n{place}direction = [0, -1, 0]\ninner_angle_deg = 10\nouter_angle_deg = 20"),
        format!("kind = 'spot'\n{place}outer_angle_deg = 90"),
        "angular_size_deg = 60".to_owned(),
        format!("kind = 'point'\n{place}angular_size_deg = 0.5"),
    ] {
        assert_eq!(check_lights(&[table(&good)]), Ok(()), "{good}");
    }
    for (text, expected) in [
        (
            "kind = 'point'\nposition_mm = [0, 0, 0]\nirradiance = [1, 1, 1]",
            "light.1.irradiance: a point light has no such key, only position_mm, intensity",
        ),
        ("kind = 'point'\ndirection = [0, -1, 0]", "light.1.direction: a point light"),
        ("kind = 'spot'\nirradiance = [1, 1, 1]", "light.1.irradiance: a spot light"),
        ("intensity = [1, 1, 1]", "light.1.intensity: a directional light"),
        ("position_mm = [1, 1, 1]", "light.1.position_mm: a directional light"),
        ("outer_angle_deg = 20", "light.1.outer_angle_deg: a directional light"),
        ("kind = 'point'", "light.1.position_mm: expected where the point light is, found nothing"),
        ("irradiance = [1, -1, 1]", "light.1.irradiance = [1.0, -1.0, 1.0]: allowed is 0 to 1000000 each"),
        ("irradiance = [1, nan, 1]", "light.1.irradiance = [1.0, NaN, 1.0]"),
        ("direction = [0, 0, 0]", "light.1.direction = [0.0, 0.0, 0.0]: allowed is any vector but 0"),
        ("direction = [0, inf, 0]", "light.1.direction"),
        ("kind = 'point'\nposition_mm = [0, 0, 2e9]", "light.1.position_mm = 2000000000: allowed is"),
        ("kind = 'spot'\nposition_mm = [0, 0, 0]\nouter_angle_deg = 91", "light.1.outer_angle_deg = 91: "),
        ("kind = 'spot'\nposition_mm = [0, 0, 0]\nouter_angle_deg = 0", "light.1.outer_angle_deg = 0: "),
        (
            "kind = 'spot'\nposition_mm = [0, 0, 0]\ninner_angle_deg = 45",
            "light.1.inner_angle_deg = 45: allowed is 0 to below outer_angle_deg = 45",
        ),
        ("kind = 'spot'\nposition_mm = [0, 0, 0]\ninner_angle_deg = nan", "light.1.inner_angle_deg = NaN"),
        ("angular_size_deg = 61", "light.1.angular_size_deg = 61: allowed is 0 to 60"),
        ("angular_size_deg = -1", "light.1.angular_size_deg = -1: allowed is 0 to 60"),
        ("kind = 'point'\nangular_size_deg = nan", "light.1.angular_size_deg = NaN"),
    ] {
        let message = refused(text);
        assert!(message.starts_with(expected) && !message.contains('\n'), "{message}");
    }
    let many = vec![LightTable::default(); MAX_LIGHTS + 1];
    assert!(check_lights(&many).unwrap_err().to_string().contains("at most 256 [[light]]s, found 257"));
    assert_eq!(check_lights(&many[1..]), Ok(()));
}

#[test]
fn a_light_of_any_size_of_direction_is_a_unit_vector() {
    for direction in ["[0, -1e-8, 0]", "[0, -1e300, 1e300]", "[1e308, 1e308, 1e308]"] {
        let light = Light::new(&table(&format!("direction = {direction}")), DVec3::ZERO);
        assert!((light.toward.length() - 1.0).abs() < 1e-12, "{direction}: {}", light.toward);
    }
}

#[test]
fn a_light_spans_the_angle_it_says_and_has_the_views_of_its_kind() {
    assert_eq!(table("").angular_tangent(), 0.0);
    // Half of what it spans, on either side of the line to its middle.
    assert!((table("angular_size_deg = 60").angular_tangent() - 1.0 / 3.0_f64.sqrt()).abs() < 1e-12);
    let views = |kind: &str| table(&format!("kind = '{kind}'")).shadow_view_count();
    assert_eq!(["directional", "spot", "point"].map(views), [1, 1, 6]);
}

#[test]
fn light_falls_off_with_the_square_of_the_distance_from_a_metre_on() {
    let point = table("kind = 'point'\nposition_mm = [1000, 500, 0]\nintensity = [4, 2, 1]");
    let light = Light::new(&point, DVec3::new(0.0, 500.0, 0.0));
    let at = |x_mm: f64| light_at(&light, DVec3::new(x_mm, 0.0, 0.0));
    let near = |a: DVec3, b: DVec3| (a - b).length() < 1e-12 * b.length();
    assert_eq!(at(0.0).to_light, DVec3::X);
    assert!(near(at(0.0).irradiance, DVec3::new(4.0, 2.0, 1.0)));
    assert!(near(at(-1000.0).irradiance, DVec3::new(1.0, 0.5, 0.25)));
    assert!(near(at(1500.0).irradiance, 4.0 * DVec3::new(4.0, 2.0, 1.0)) && at(1500.0).to_light == -DVec3::X);
    // At the light: as at its radius, from some direction.
    let inside = at(1000.0);
    assert!(near(inside.irradiance, at(999.0).irradiance) && near(inside.irradiance, at(999.9).irradiance));
    assert!((inside.to_light.length() - 1.0).abs() < 1e-12 && inside.irradiance.is_finite());
}

/// KHR_lights_punctual's angular attenuation as its text has it.
fn attenuation(inner: f64, outer: f64, angle: f64) -> f64 {
    let scale = 1.0 / (inner.cos() - outer.cos()).max(1e-12);
    (angle.cos() * scale - outer.cos() * scale).clamp(0.0, 1.0).powi(2)
}

#[test]
fn a_spot_has_the_falloff_of_khr_lights_punctual() {
    for (inner_deg, outer_deg) in [(0.0, 45.0_f64), (20.0, 30.0), (89.0, 90.0), (0.0, 90.0), (0.5, 1.0)] {
        let text = format!(
            "kind = 'spot'\nposition_mm = [0, 1000, 0]\ndirection = [0, -3, 0]\nintensity = [1, 1, 1]\n\
             inner_angle_deg = {inner_deg:?}\nouter_angle_deg = {outer_deg:?}"
        );
        let light = Light::new(&table(&text), DVec3::ZERO);
        for i in 0..200 {
            let angle = f64::from(i) / 199.0 * 1.2 * outer_deg.to_radians();
            let place = DVec3::new(0.0, 1000.0 - 1000.0 * angle.cos(), 1000.0 * angle.sin());
            let expected = attenuation(f64::to_radians(inner_deg), outer_deg.to_radians(), angle);
            let found = light_at(&light, place).irradiance.x;
            assert!((found - expected).abs() < 1e-9, "{inner_deg} to {outer_deg} at {angle}: {found}");
        }
    }
    // The sharpest edges are still finite, bright inside and dark outside.
    for (inner_deg, outer_deg) in [(f64::next_down(45.0), 45.0_f64), (0.0, 0.01)] {
        let text = format!("inner_angle_deg = {inner_deg:?}\nouter_angle_deg = {outer_deg:?}");
        let spot = table(&format!("kind = 'spot'\nposition_mm = [0, 0, 0]\n{text}"));
        assert_eq!(check_lights(std::slice::from_ref(&spot)), Ok(()));
        let light = Light::new(&spot, DVec3::ZERO);
        let across = light.toward.any_orthonormal_vector();
        let share = |angle: f64| {
            light_at(&light, -1e3 * (angle.cos() * light.toward + angle.sin() * across)).irradiance.x
                / light.strength.x
        };
        assert!((share(0.0) - 1.0).abs() < 1e-6 && share(1.01 * outer_deg.to_radians()) == 0.0);
    }
    assert!((attenuation(0.0, 2.0 * FRAC_PI_4, FRAC_PI_4) - 0.5).abs() < 1e-12);
}

#[test]
fn ambient_light_is_one_colour_or_a_picture() {
    let ambient = |text: &str| toml::from_str::<AmbientTable>(text).unwrap();
    assert_eq!(ambient("").radiance(), DVec3::new(0.2, 0.22, 0.26));
    assert_eq!(ambient("radiance = [1, 2, 3]").radiance(), DVec3::new(1.0, 2.0, 3.0));
    let picture = ambient("environment = 'a.exr'");
    assert_eq!((picture.radiance(), picture.picture()), (DVec3::ZERO, Some("a.exr")));
    assert_eq!(ambient("environment = 'a.exr'\nenvironment_scale = 0").picture(), None);
    for (text, expected) in [
        ("environment = 'a.exr'\nradiance = [1, 1, 1]", "ambient.environment: expected this or"),
        ("radiance = [-1, 1, 1]", "ambient.radiance = [-1.0, 1.0, 1.0]: allowed is 0 to 1000000 each"),
        ("environment_scale = -1", "ambient.environment_scale = -1: allowed is 0 to 1000000"),
        ("environment_scale = nan", "ambient.environment_scale = NaN"),
        ("environment_yaw_deg = inf", "ambient.environment_yaw_deg = inf"),
    ] {
        let message = ambient(text).check().unwrap_err().to_string();
        assert!(message.starts_with(expected), "{message}");
    }
}
