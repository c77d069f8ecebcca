//! The camera: angles to matrices, in f64.

use super::file::CameraTable;
use crate::math::bounds::bounds;
use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

/// Share of the picture's half-width or half-height that a fitted model may fill.
const FIT_FILL: f64 = 0.94;
/// The near plane as a share of the distance to the target.
const NEAR_SHARE: f64 = 1e-3;
/// Height of a model that lies flat, as a share of the smaller of its other two extents.
const FLAT_SHARE: f64 = 0.2;

/// A placed camera. World space is relative to the scene's origin, in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where the eye is.
    pub eye_world: DVec3,
    /// What it looks at.
    pub target_world: DVec3,
    /// Columns: right, up, and backward.
    pub world_from_view: DMat3,
    /// Tangents of half the horizontal and vertical field of view.
    pub half_extent: DVec2,
    /// Distance of the near plane in mm.
    pub near_mm: f64,
}

impl Camera {
    /// Places the camera for a picture of `size` pixels around `points` (relative to the origin, as
    /// `origin_mm` is to the file), each with a margin of `radius_mm`.
    pub fn new(
        table: &CameraTable,
        size: [u32; 2],
        origin_mm: DVec3,
        points: impl Iterator<Item = DVec3> + Clone,
        radius_mm: f64,
    ) -> Self {
        let pitch_deg = pitch_deg(table, points.clone());
        let (yaw, pitch) = (table.yaw_deg.to_radians(), pitch_deg.to_radians());
        let world_from_view = DMat3::from_rotation_y(yaw) * DMat3::from_rotation_x(-pitch);
        let tan_y = (0.5 * table.fov_y_deg.to_radians()).tan();
        let half_extent = DVec2::new(tan_y * f64::from(size[0]) / f64::from(size[1]), tan_y);
        let given = table.target_mm.filter(|_| !table.fit);
        let target_world = match given {
            Some(target) => DVec3::from_array(target) - origin_mm,
            None => view_center(world_from_view, points.clone()),
        };
        let distance = match table.distance_mm.filter(|_| !table.fit) {
            Some(distance) => distance,
            None => fit_distance(world_from_view, target_world, half_extent, points, radius_mm),
        };
        Self {
            eye_world: target_world + world_from_view.z_axis * distance,
            target_world,
            world_from_view,
            half_extent,
            near_mm: NEAR_SHARE * distance,
        }
    }

    /// The table of the same camera with nothing left to be fitted, so that it stays where it is when the cloth moves.
    pub fn fitted(
        table: &CameraTable,
        size: [u32; 2],
        origin_mm: DVec3,
        points: impl Iterator<Item = DVec3> + Clone,
        radius_mm: f64,
    ) -> CameraTable {
        let camera = Self::new(table, size, origin_mm, points.clone(), radius_mm);
        CameraTable {
            pitch_deg: Some(pitch_deg(table, points)),
            distance_mm: Some(camera.near_mm / NEAR_SHARE),
            target_mm: Some((camera.target_world + origin_mm).to_array()),
            fit: false,
            ..table.clone()
        }
    }

    /// Clip from world space: reversed Z (near plane 1, infinitely far 0), Y down in the picture as
    /// Vulkan has it. `jitter` moves the picture by that many pixels of `size`.
    pub fn clip_from_world(&self, size: [u32; 2], jitter: DVec2) -> DMat4 {
        let view_from_world = self.world_from_view.transpose();
        let translation = -(view_from_world * self.eye_world);
        let view = DMat4::from_cols(
            view_from_world.x_axis.extend(0.0),
            view_from_world.y_axis.extend(0.0),
            view_from_world.z_axis.extend(0.0),
            translation.extend(1.0),
        );
        let shift = 2.0 * jitter / DVec2::new(f64::from(size[0]), f64::from(size[1]));
        let clip_from_view = DMat4::from_cols(
            DVec4::new(1.0 / self.half_extent.x, 0.0, 0.0, 0.0),
            DVec4::new(0.0, -1.0 / self.half_extent.y, 0.0, 0.0),
            DVec4::new(-shift.x, -shift.y, 0.0, -1.0),
            DVec4::new(0.0, 0.0, self.near_mm, 0.0),
        );
        clip_from_view * view
    }

    /// Size of a pixel at distance 1.
    pub fn pixel_tangent(&self, size: [u32; 2]) -> f64 {
        2.0 * self.half_extent.y / f64::from(size[1])
    }

    /// Inward planes of the view: left, right, bottom, top, near; n . x + w >= 0 inside, |n| = 1.
    /// The sides are moved out by one pixel of `size`, so that jittered frames are covered.
    pub fn frustum_world(&self, size: [u32; 2]) -> [DVec4; 5] {
        let pixel = 2.0 / DVec2::new(f64::from(size[0]), f64::from(size[1]));
        let edge = self.half_extent * (DVec2::ONE + pixel);
        let plane = |normal_view: DVec3, offset: f64| {
            let normal = (self.world_from_view * normal_view).normalize();
            normal.extend(offset - normal.dot(self.eye_world))
        };
        [
            plane(DVec3::new(1.0, 0.0, -edge.x), 0.0),
            plane(DVec3::new(-1.0, 0.0, -edge.x), 0.0),
            plane(DVec3::new(0.0, 1.0, -edge.y), 0.0),
            plane(DVec3::new(0.0, -1.0, -edge.y), 0.0),
            plane(DVec3::new(0.0, 0.0, -1.0), -self.near_mm),
        ]
    }
}

/// The pitch that a table states, or the one that suits the points.
fn pitch_deg(table: &CameraTable, points: impl Iterator<Item = DVec3>) -> f64 {
    table.pitch_deg.unwrap_or_else(|| if lies_flat(points) { 90.0 } else { 0.0 })
}

/// Whether the points lie like a cloth on the ground, which a level camera would see edge on.
fn lies_flat(points: impl Iterator<Item = DVec3>) -> bool {
    let (low, high) = bounds(points);
    let size = high - low;
    size.y < FLAT_SHARE * size.x.min(size.z)
}

/// Centre of the points' box in view axes, given in world space.
fn view_center(world_from_view: DMat3, points: impl Iterator<Item = DVec3>) -> DVec3 {
    let view_from_world = world_from_view.transpose();
    let (low, high) = bounds(points.map(|p| view_from_world * p));
    if low.is_finite() { world_from_view * (0.5 * (low + high)) } else { DVec3::ZERO }
}

/// Smallest distance from the target at which every point lies inside the picture's margin.
fn fit_distance(
    world_from_view: DMat3,
    target: DVec3,
    half_extent: DVec2,
    points: impl Iterator<Item = DVec3>,
    radius_mm: f64,
) -> f64 {
    let view_from_world = world_from_view.transpose();
    let edge = half_extent * FIT_FILL;
    let needed = |p: DVec3| {
        let v = view_from_world * (p - target);
        // A ball touches a side plane at radius / cos of that plane's tilt.
        let reach = |offset: f64, tan: f64| (offset.abs() + radius_mm * tan.hypot(1.0)) / tan;
        v.z + reach(v.x, edge.x).max(reach(v.y, edge.y))
    };
    points.map(needed).fold(1e-6_f64.max(radius_mm), f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [640, 480];

    fn corners() -> impl Iterator<Item = DVec3> + Clone {
        (0..8).map(|i| {
            DVec3::new(f64::from(i & 1) * 40.0, f64::from(i >> 1 & 1) * 90.0, f64::from(i >> 2) * 9.0)
        })
    }

    fn project(camera: &Camera, p: DVec3) -> DVec3 {
        let clip = camera.clip_from_world(SIZE, DVec2::ZERO) * p.extend(1.0);
        clip.truncate() / clip.w
    }

    #[test]
    fn looks_along_minus_z_at_angles_zero_with_y_up() {
        let camera = Camera::new(&CameraTable::default(), SIZE, DVec3::ZERO, corners(), 1.0);
        assert!((camera.world_from_view.z_axis - DVec3::Z).length() < 1e-15);
        let target = camera.target_world;
        assert!(
            project(&camera, target + DVec3::Y).y < project(&camera, target).y,
            "up is smaller y in Vulkan"
        );
        assert!(project(&camera, target + DVec3::X).x > 0.0);
    }

    #[test]
    fn a_cloth_on_the_ground_is_seen_from_above_unless_told_otherwise() {
        let flat = (0..8)
            .map(|i| DVec3::new(f64::from(i & 1) * 40.0, f64::from(i >> 1 & 1), f64::from(i >> 2) * 60.0));
        let camera = Camera::new(&CameraTable::default(), SIZE, DVec3::ZERO, flat.clone(), 1.0);
        assert!((camera.world_from_view.z_axis - DVec3::Y).length() < 1e-15);
        let level = CameraTable { pitch_deg: Some(0.0), ..Default::default() };
        let camera = Camera::new(&level, SIZE, DVec3::ZERO, flat, 1.0);
        assert!((camera.world_from_view.z_axis - DVec3::Z).length() < 1e-15);
    }

    #[test]
    fn a_fitted_model_is_whole_and_fills_the_picture() {
        for (yaw_deg, pitch_deg) in [(0.0, 0.0), (35.0, 20.0), (170.0, -60.0)] {
            let table = CameraTable { yaw_deg, pitch_deg: Some(pitch_deg), ..Default::default() };
            let camera = Camera::new(&table, SIZE, DVec3::ZERO, corners(), 1.0);
            let largest =
                corners().map(|p| project(&camera, p)).fold(0.0, |m: f64, p| m.max(p.x.abs()).max(p.y.abs()));
            assert!(largest < FIT_FILL && largest > 0.8, "{yaw_deg} {pitch_deg}: {largest}");
        }
    }

    #[test]
    fn depth_is_reversed_and_planes_agree_with_the_projection() {
        let table = CameraTable { yaw_deg: 20.0, distance_mm: Some(100.0), ..Default::default() };
        let camera = Camera::new(&table, SIZE, DVec3::ZERO, corners(), 1.0);
        let view = |v: DVec3| camera.eye_world + camera.world_from_view * v;
        assert!((project(&camera, view(DVec3::new(0.0, 0.0, -camera.near_mm))).z - 1.0).abs() < 1e-9);
        assert!(project(&camera, view(DVec3::new(0.0, 0.0, -1e9))).z < 1e-9);
        let planes = camera.frustum_world(SIZE);
        let inside = |p: DVec3| planes.iter().all(|plane| plane.truncate().dot(p) + plane.w >= 0.0);
        for (x, expected) in [(0.0, true), (0.99, true), (1.02, false), (-1.02, false)] {
            let p = view(DVec3::new(x * camera.half_extent.x, 0.0, -1.0) * 50.0);
            assert_eq!(inside(p), expected, "at {x}");
        }
        assert!(!inside(view(DVec3::Z)), "behind the camera");
    }

    #[test]
    fn jitter_moves_by_pixels() {
        let camera = Camera::new(&CameraTable::default(), SIZE, DVec3::ZERO, corners(), 1.0);
        let clip = camera.clip_from_world(SIZE, DVec2::new(0.25, -0.5)) * camera.target_world.extend(1.0);
        let pixel = clip.truncate() / clip.w * DVec3::new(320.0, 240.0, 1.0);
        assert!((pixel.x - 0.25).abs() < 1e-12 && (pixel.y + 0.5).abs() < 1e-12, "{pixel}");
    }
}
