//! Lights of which nothing arrives at the cloth.

use super::light::{LightKind, LightTable};
use crate::math::bounds::Bounds;
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// Whether a light may reach something in a box, both relative to what `origin_mm` is in the light's coordinates: only
/// spot lights have an edge. Not tight: the sphere around the box stands for it.
pub fn reaches(light: &LightTable, origin_mm: DVec3, (low, high): Bounds) -> bool {
    if light.kind != LightKind::Spot {
        return true;
    }
    let position = DVec3::from_array(light.position_mm.unwrap_or_default()) - origin_mm;
    let to_middle = 0.5 * (low + high) - position;
    let (distance, radius) = (to_middle.length(), 0.5 * (high - low).length());
    if distance <= radius {
        return true;
    }
    let [_, outer_deg] = light.angles_deg();
    let from_axis = light.direction().angle_between(to_middle);
    let spans = (radius / distance).asin().min(FRAC_PI_2);
    // Written so that what is no number reaches.
    let misses = from_axis - spans > outer_deg.to_radians();
    !misses
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spot_reaches_what_its_cone_meets() {
        let spot = |direction: [f64; 3]| LightTable {
            kind: LightKind::Spot,
            position_mm: Some([0.0, 0.0, 100.0]),
            direction: Some(direction),
            outer_angle_deg: Some(10.0),
            ..Default::default()
        };
        let cube = |center: DVec3| (center - DVec3::ONE, center + DVec3::ONE);
        let down = spot([0.0, 0.0, -2.0]);
        assert!(reaches(&down, DVec3::ZERO, cube(DVec3::ZERO)));
        // The cone is 17.6 mm wide there, the sphere around the box 1.7.
        assert!(reaches(&down, DVec3::ZERO, cube(DVec3::X * 19.0)));
        assert!(!reaches(&down, DVec3::ZERO, cube(DVec3::X * 20.0)));
        assert!(reaches(&down, DVec3::X * -20.0, cube(DVec3::X * 20.0)), "the origin counts");
        assert!(!reaches(&spot([0.0, 0.0, 1.0]), DVec3::ZERO, cube(DVec3::ZERO)), "it shines the other way");
        assert!(reaches(&spot([0.0, 0.0, 1.0]), DVec3::ZERO, cube(DVec3::Z * 100.0)), "it is inside");
        assert!(reaches(&LightTable::default(), DVec3::ZERO, cube(DVec3::X * 1e9)));
    }
}
