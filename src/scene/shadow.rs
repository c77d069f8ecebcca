//! What a light sees: the views from which the shadow map is drawn, fitted to what the camera sees of the cloth.

use super::camera::Camera;
use super::light::{LightKind, LightTable};
use crate::math::bounds::Bounds;
use crate::math::frame::any_perpendicular;
use glam::{DMat4, DVec2, DVec3, DVec4};
use serde::{Deserialize, Serialize};

/// Steps between the widths a directional light's view may have: so that a moving camera seldom changes it.
const WIDTH_STEP: f64 = std::f64::consts::SQRT_2;
/// The nearest that a point or spot light sees, as a share of the farthest.
const NEAR_SHARE: f64 = 1e-3;
/// Directions in which a point light looks.
const FACES: [DVec3; 6] = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];

/// Shadows (Wu & Yuksel 2019, Sec. 4.1).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ShadowTable {
    /// Between yarns.
    pub map: bool,
    /// Inside the yarn.
    #[serde(rename = "self")]
    pub inside: bool,
    /// Texels of the shadow map along a side, for each light (six times for a point light), 16 to 8192.
    pub resolution: u32,
}

impl Default for ShadowTable {
    fn default() -> Self {
        Self { map: true, inside: true, resolution: 1024 }
    }
}

/// One view from a light, filling one layer of the shadow map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowView {
    /// Clip from world space; depth 1 near the light, 0 far away.
    pub clip_from_world: DMat4,
    /// Depth in mm away from the light is `depth_axis.xyz . p + depth_axis.w`.
    pub depth_axis: DVec4,
    /// Width of a texel: mm for a directional light, mm per mm of depth for another.
    pub texel: f64,
    /// Toward the light from p: xyz - w p.
    pub toward: DVec4,
}

fn corners((low, high): Bounds) -> [DVec3; 8] {
    std::array::from_fn(|i| {
        let pick = |bit: usize, low: f64, high: f64| if i >> bit & 1 == 0 { low } else { high };
        DVec3::new(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z))
    })
}

/// The views of a light of the scene whose cloth lies in `cloth`; positions are relative to `origin_mm`.
pub fn shadow_views(
    light: &LightTable,
    origin_mm: DVec3,
    camera: &Camera,
    cloth: Bounds,
    resolution: u32,
) -> Vec<ShadowView> {
    let position = || DVec3::from_array(light.position_mm.unwrap_or_default()) - origin_mm;
    let far = |eye: DVec3| corners(cloth).iter().map(|c| c.distance(eye)).fold(1e-3, f64::max);
    match light.kind {
        LightKind::Directional => {
            vec![directional(-light.direction().normalize(), camera, cloth, resolution)]
        }
        LightKind::Spot => {
            let half_angle = light.angles_deg()[1].to_radians().min(1.5);
            let axis = light.direction().normalize();
            vec![perspective(position(), axis, half_angle.tan(), far(position()), resolution)]
        }
        LightKind::Point => {
            // One texel more on each side, so that filtering finds what it needs.
            let tangent = 1.0 + 4.0 / f64::from(resolution);
            FACES
                .iter()
                .map(|&face| perspective(position(), face, tangent, far(position()), resolution))
                .collect()
        }
    }
}

/// The part of the cloth's box that the camera may see, in the axes of `across`: low and high corner.
fn visible_rect(across: [DVec3; 2], camera: &Camera, cloth: Bounds) -> (DVec2, DVec2) {
    let place = |p: DVec3| DVec2::new(p.dot(across[0]), p.dot(across[1]));
    let rect = |points: &mut dyn Iterator<Item = DVec3>| {
        let nothing = (DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY));
        points.map(place).fold(nothing, |(low, high), p| (low.min(p), high.max(p)))
    };
    let all = rect(&mut corners(cloth).into_iter());
    let depth = |p: DVec3| -camera.world_from_view.z_axis.dot(p - camera.eye_world);
    let farthest = corners(cloth).into_iter().map(depth).fold(0.0, f64::max);
    let edges = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];
    let ray = |[x, y]: [f64; 2]| {
        let extent = camera.half_extent;
        camera.world_from_view * DVec3::new(x * extent.x, y * extent.y, -1.0)
    };
    let seen = rect(
        &mut edges
            .into_iter()
            .flat_map(|edge| [camera.near_mm, farthest].map(|depth| camera.eye_world + depth * ray(edge))),
    );
    let (low, high) = (all.0.max(seen.0), all.1.min(seen.1));
    // Where the camera sees none of it any view will do.
    if low.cmple(high).all() { (low, high) } else { all }
}

fn directional(to_light: DVec3, camera: &Camera, cloth: Bounds, resolution: u32) -> ShadowView {
    let right = any_perpendicular(to_light).normalize();
    let up = to_light.cross(right);
    let (low, high) = visible_rect([right, up], camera, cloth);
    let size = (high - low).max_element().max(1e-3);
    // Room for one texel of rounding and for the filter, on either side.
    let steps = (size.ln() / WIDTH_STEP.ln()).ceil();
    let texel = WIDTH_STEP.powf(steps) / (f64::from(resolution) - 8.0).max(1.0);
    // Texels stay where they are when the camera moves.
    let center = (0.5 * (low + high) / texel).round() * texel;
    let half = 0.5 * texel * f64::from(resolution);
    let heights = corners(cloth).map(|p| p.dot(to_light));
    let top = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let depth_range = (top - heights.iter().copied().fold(f64::INFINITY, f64::min)).max(1e-3);
    let row = |axis: DVec3, offset: f64, scale: f64| (axis * scale).extend(-offset * scale);
    let rows = [
        row(right, center.x, 1.0 / half),
        row(up, center.y, 1.0 / half),
        // A margin, as a yarn's own thickness is not in a box of centre lines.
        row(to_light, top - 1.5 * depth_range, 0.5 / depth_range),
        DVec4::W,
    ];
    ShadowView {
        clip_from_world: DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose(),
        depth_axis: (-to_light).extend(top),
        texel,
        toward: to_light.extend(0.0),
    }
}

fn perspective(eye: DVec3, axis: DVec3, tangent: f64, far: f64, resolution: u32) -> ShadowView {
    let right = any_perpendicular(axis).normalize();
    let up = axis.cross(right);
    let near = NEAR_SHARE * far;
    let row = |v: DVec3, scale: f64| (v * scale).extend(-v.dot(eye) * scale);
    let rows =
        [row(right, 1.0 / tangent), row(up, 1.0 / tangent), DVec4::new(0.0, 0.0, 0.0, near), row(axis, 1.0)];
    ShadowView {
        clip_from_world: DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose(),
        depth_axis: row(axis, 1.0),
        texel: 2.0 * tangent / f64::from(resolution),
        toward: eye.extend(1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::file::CameraTable;

    const CLOTH: Bounds = (DVec3::new(-50.0, -40.0, -3.0), DVec3::new(50.0, 40.0, 3.0));
    const RESOLUTION: u32 = 512;

    fn camera(target: [f64; 3], distance_mm: f64) -> Camera {
        let table = CameraTable {
            target_mm: Some(target),
            distance_mm: Some(distance_mm),
            pitch_deg: Some(10.0),
            ..Default::default()
        };
        Camera::new(&table, [400, 300], DVec3::ZERO, corners(CLOTH).into_iter(), 1.0)
    }

    fn view(camera: &Camera) -> ShadowView {
        let views = shadow_views(&LightTable::default(), DVec3::ZERO, camera, CLOTH, RESOLUTION);
        assert_eq!(views.len(), 1);
        views[0]
    }

    #[test]
    fn what_the_camera_sees_lies_in_the_map() {
        for (target, distance) in [([0.0; 3], 400.0), ([20.0, -10.0, 0.0], 30.0), ([-49.0, 39.0, 2.0], 10.0)]
        {
            let camera = camera(target, distance);
            let view = view(&camera);
            let clip = view.clip_from_world.project_point3(DVec3::from_array(target));
            assert!(clip.truncate().abs().max_element() < 1.0 && (0.0..1.0).contains(&clip.z), "{clip}");
        }
        // Close up the same texels cover less cloth: what is seen, and what of it the slanting light stretches.
        let texel = |distance_mm| view(&camera([0.0; 3], distance_mm)).texel;
        assert!(texel(30.0) < 0.4 * texel(400.0) && texel(10.0) < 0.2 * texel(400.0));
    }

    #[test]
    fn texels_stay_where_they_are_when_the_camera_moves() {
        let start = view(&camera([0.0; 3], 40.0));
        for i in 1..40 {
            let moved = view(&camera([0.07 * f64::from(i), 0.03 * f64::from(i), 0.0], 40.0));
            assert_eq!(moved.texel, start.texel, "step {i}");
            let texels = |view: &ShadowView| {
                0.5 * f64::from(RESOLUTION) * view.clip_from_world.project_point3(DVec3::ONE).truncate()
            };
            let shift = texels(&moved) - texels(&start);
            assert!((shift - shift.round()).length() < 1e-6, "step {i}: {shift}");
        }
    }

    #[test]
    fn depth_grows_away_from_the_light_and_the_nearer_thing_wins() {
        let camera = camera([0.0; 3], 400.0);
        let spot = LightTable {
            kind: LightKind::Spot,
            position_mm: Some([10.0, 80.0, 100.0]),
            direction: Some([0.0, -0.6, -0.8]),
            ..Default::default()
        };
        let point =
            LightTable { kind: LightKind::Point, position_mm: Some([0.0, 0.0, 90.0]), ..Default::default() };
        for light in [LightTable::default(), spot, point] {
            let views = shadow_views(&light, DVec3::ZERO, &camera, CLOTH, RESOLUTION);
            let view = if views.len() == 6 { &views[5] } else { &views[0] };
            let direction =
                if light.kind == LightKind::Point { DVec3::NEG_Z } else { light.direction().normalize() };
            let (a, b) = (DVec3::ZERO, 2.0 * direction);
            let depth = |p: DVec3| view.depth_axis.truncate().dot(p) + view.depth_axis.w;
            assert!((depth(b) - depth(a) - 2.0).abs() < 1e-9 && depth(a) > 0.0, "{:?}", light.kind);
            let clip = |p: DVec3| view.clip_from_world.project_point3(p);
            assert!(clip(a).z > clip(b).z && clip(b).z > 0.0 && clip(a).z < 1.0, "{:?}", light.kind);
            assert!(clip(a).truncate().abs().max_element() < 1.0, "{:?}", light.kind);
        }
    }

    #[test]
    fn a_point_light_looks_everywhere() {
        let light =
            LightTable { kind: LightKind::Point, position_mm: Some([1.0, 2.0, 3.0]), ..Default::default() };
        let camera = camera([0.0; 3], 400.0);
        let views = shadow_views(&light, DVec3::ZERO, &camera, CLOTH, RESOLUTION);
        for i in 0..200 {
            let golden = f64::from(i) * 2.399_963;
            let z = 1.0 - (f64::from(i) + 0.5) / 100.0;
            let r = (1.0 - z * z).sqrt();
            let p = DVec3::new(1.0, 2.0, 3.0) + 9.0 * DVec3::new(r * golden.cos(), r * golden.sin(), z);
            let seen = views.iter().filter(|view| {
                let in_front = view.depth_axis.truncate().dot(p) + view.depth_axis.w > 0.0;
                in_front && view.clip_from_world.project_point3(p).truncate().abs().max_element() <= 1.0
            });
            assert!(seen.count() >= 1, "{p}");
        }
    }
}
