//! Lights that change their kind, and new ones: they give as much light at what they shine on as before.

use crate::scene::light::{LightKind, LightTable};
use glam::DVec3;

/// How far from what it shines on a light is put.
const DISTANCE_MM: f64 = 300.0;
/// Digits that are kept of what is worked out.
const DIGITS: usize = 4;

/// The kind of that name, or `None`.
pub fn kind_named(name: &str) -> Option<LightKind> {
    [LightKind::Directional, LightKind::Point, LightKind::Spot].into_iter().find(|kind| kind.name() == name)
}

/// The light as one of another kind that shines on `center_mm` from the same side and as brightly.
pub fn as_kind(light: &LightTable, kind: LightKind, center_mm: DVec3) -> LightTable {
    let offset_mm = match light.position_mm {
        Some(position) if light.is_local() => DVec3::from_array(position) - center_mm,
        _ => -DISTANCE_MM * light.direction().normalize_or(DVec3::NEG_Y),
    };
    let squared_m = (1e-3 * offset_mm.length()).powi(2).max(1e-6);
    let at_center = if light.is_local() { light.strength() / squared_m } else { light.strength() };
    let position_mm = match light.position_mm {
        Some(position) if light.is_local() => position,
        _ => rounded(center_mm + offset_mm),
    };
    let has = |key: &str| kind.keys().contains(&key);
    let direction = match light.kind {
        LightKind::Point => rounded((-offset_mm).normalize_or(DVec3::NEG_Y)),
        LightKind::Directional | LightKind::Spot => light.direction().to_array(),
    };
    LightTable {
        kind,
        direction: has("direction").then_some(direction),
        irradiance: has("irradiance").then(|| rounded(at_center)),
        intensity: has("intensity").then(|| {
            if light.is_local() { light.strength().to_array() } else { rounded(at_center * squared_m) }
        }),
        position_mm: has("position_mm").then_some(position_mm),
        inner_angle_deg: light.inner_angle_deg.filter(|_| has("inner_angle_deg")),
        outer_angle_deg: light.outer_angle_deg.filter(|_| has("outer_angle_deg")),
        angular_size_deg: light.angular_size_deg,
    }
}

/// A light beside those that are there: dimmer than the default one, from the other side.
pub fn added(kind: LightKind, center_mm: DVec3) -> LightTable {
    let fill = LightTable {
        direction: Some([-0.6, -0.5, -0.6]),
        irradiance: Some([1.0, 1.0, 1.0]),
        ..LightTable::default()
    };
    as_kind(&fill, kind, center_mm)
}

/// A number with so many digits, as a person would type it.
pub fn to_digits(number: f64, digits: usize) -> f64 {
    format!("{number:.*e}", digits.max(1) - 1).parse().unwrap_or(number)
}

fn rounded(vector: DVec3) -> [f64; 3] {
    vector.to_array().map(|c| to_digits(c, DIGITS))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::light::{Light, check_lights, light_at};

    #[test]
    fn every_kind_gives_the_center_the_same_light() {
        let center = DVec3::new(10.0, -40.0, 7.0);
        let kinds = [LightKind::Directional, LightKind::Point, LightKind::Spot];
        for from in kinds {
            for to in kinds {
                let light = as_kind(&LightTable::default(), from, center);
                let other = as_kind(&light, to, center);
                check_lights(&[light.clone(), other.clone(), added(to, center)]).unwrap();
                let [a, b] = [light, other].map(|table| light_at(&Light::new(&table, DVec3::ZERO), center));
                assert!((a.irradiance / b.irradiance - 1.0).abs().max_element() < 2e-3, "{from:?} {to:?}");
                assert!(a.to_light.dot(b.to_light) > 0.9999, "{from:?} {to:?}");
            }
        }
        assert_eq!(to_digits(0.123_456, 4), 0.1235);
        assert_eq!(to_digits(-0.0, 4), 0.0);
        assert_eq!(["spot", "lamp"].map(kind_named), [Some(LightKind::Spot), None]);
    }
}
