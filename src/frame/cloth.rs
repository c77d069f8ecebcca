//! Where cloth is, for lights: one box, or where it is spread wider than f32 has digits for, one for each stretch of
//! yarn, of which lights then see those that the camera does.

use crate::math::bounds::{Bounds, bounds};
use crate::math::frame::any_perpendicular;
use crate::scene::Scene;
use crate::scene::camera::Camera;
use crate::scene::light::{LightKind, LightTable};
use crate::scene::load::NEAR_TOGETHER_MM;
use glam::{DVec2, DVec3, DVec4};

/// Pieces of yarn to a stretch.
const PIECES: usize = 128;
/// Any size of picture will do for what a camera sees, but for a pixel.
const PIXELS: [u32; 2] = [64, 64];

/// Boxes around all yarns of a scene, their thickness included, relative to its origin.
pub struct Cloth {
    all: Bounds,
    /// Those of stretches; empty where all lies near together.
    stretches: Vec<Bounds>,
}

impl Cloth {
    /// Of a scene's fabrics.
    pub fn new(scene: &Scene) -> Self {
        let stretches: Vec<Bounds> = scene
            .fabrics
            .iter()
            .flat_map(|fabric| {
                let radius = DVec3::splat(fabric.yarn.outer_radius_mm());
                fabric.strands.pieces.chunks(PIECES).map(move |pieces| {
                    let points = pieces.iter().flat_map(|piece| fabric.strands.bezier(piece));
                    let (low, high) = bounds(points.map(|p| p - scene.origin_mm));
                    (low - radius, high + radius)
                })
            })
            .collect();
        let all = union(stretches.iter().copied());
        let spread = 0.5 * (all.1 - all.0).length() > NEAR_TOGETHER_MM;
        Self { all, stretches: if spread { stretches } else { Vec::new() } }
    }

    /// The box around what the camera may see, and what may stand between that and a light; around all where nothing
    /// is seen or all lies near together.
    pub fn near(&self, camera: &Camera, light: Option<&LightTable>) -> Bounds {
        let planes = camera.frustum_world(PIXELS);
        let seen = |b: &&Bounds| planes.iter().all(|plane| reaches(**b, *plane));
        let near = union(self.stretches.iter().filter(seen).copied());
        if near.0.cmpgt(near.1).any() {
            return self.all;
        }
        let Some(light) = light.filter(|light| light.kind == LightKind::Directional) else { return near };
        let toward = -light.direction().normalize();
        let right = any_perpendicular(toward).normalize();
        let axes = [right, toward.cross(right)];
        let shadow = across(near, axes);
        let over = |b: &&Bounds| {
            let (low, high) = across(**b, axes);
            low.cmple(shadow.1).all() && high.cmpge(shadow.0).all()
        };
        union(self.stretches.iter().filter(over).copied())
    }
}

fn union(boxes: impl Iterator<Item = Bounds>) -> Bounds {
    bounds(boxes.flat_map(|(low, high)| [low, high]))
}

/// Whether some of a box lies on the side of a plane where n . x + w >= 0.
fn reaches((low, high): Bounds, plane: DVec4) -> bool {
    let n = plane.truncate();
    let farthest = DVec3::select(n.cmpge(DVec3::ZERO), high, low);
    n.dot(farthest) + plane.w >= 0.0
}

/// A box's extent along two axes.
fn across((low, high): Bounds, axes: [DVec3; 2]) -> (DVec2, DVec2) {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let place = DVec2::from_array(axes.map(|axis| middle.dot(axis)));
    let reach = DVec2::from_array(axes.map(|axis| half.dot(axis.abs())));
    (place - reach, place + reach)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::file::CameraTable;

    fn cube(center: DVec3) -> Bounds {
        (center - DVec3::ONE, center + DVec3::ONE)
    }

    #[test]
    fn lights_see_what_the_camera_sees_and_what_shadows_it() {
        let down = LightTable { direction: Some([0.0, -1.0, 0.0]), ..Default::default() };
        let (here, above, far) = (DVec3::ZERO, DVec3::Y * 500.0, DVec3::X * 1e6);
        let stretches = vec![cube(here), cube(above), cube(far)];
        let cloth = Cloth { all: union(stretches.iter().copied()), stretches };
        let camera = |target_mm: DVec3| {
            let table = CameraTable {
                target_mm: Some(target_mm.to_array()),
                distance_mm: Some(30.0),
                pitch_deg: Some(0.0),
                ..Default::default()
            };
            Camera::new(&table, [40, 30], DVec3::ZERO, std::iter::empty(), 1.0)
        };
        assert_eq!(cloth.near(&camera(here), None), cube(here));
        assert_eq!(cloth.near(&camera(here), Some(&down)), (-DVec3::ONE, above + DVec3::ONE));
        assert_eq!(cloth.near(&camera(far), Some(&down)), cube(far));
        assert_eq!(cloth.near(&camera(DVec3::NEG_Z * 1e5), None), cloth.all, "where nothing is seen");
        let near_together = Cloth { all: cube(here), stretches: Vec::new() };
        assert_eq!(near_together.near(&camera(far), Some(&down)), cube(here));
    }
}
