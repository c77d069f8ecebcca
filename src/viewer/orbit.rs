//! A camera, and a light, that are dragged.

use crate::math::frame::direction_or;
use crate::scene::file::CameraTable;
use glam::{DMat3, DQuat, DVec3};

/// Degrees that a drag of one pixel turns by.
const DEG_PER_PX: f64 = 0.4;
/// Share of the distance that a step of the wheel takes away.
const DOLLY_STEP: f64 = 0.12;
/// Nearest and farthest, in mm, as a scene file allows.
const DISTANCES_MM: [f64; 2] = [1e-3, 1e9];

/// Axes of a camera with nothing left to be fitted: right, up and backward.
fn axes(camera: &CameraTable) -> DMat3 {
    let (yaw, pitch) = (camera.yaw_deg.to_radians(), camera.pitch_deg.unwrap_or(0.0).to_radians());
    DMat3::from_rotation_y(yaw) * DMat3::from_rotation_x(-pitch)
}

/// The camera after a drag in pixels, right and down: what it looks at follows the pointer.
#[must_use]
pub fn orbit(camera: &CameraTable, [right_px, down_px]: [f64; 2]) -> CameraTable {
    let yaw_deg = (camera.yaw_deg - DEG_PER_PX * right_px).rem_euclid(360.0);
    let pitch_deg = (camera.pitch_deg.unwrap_or(0.0) + DEG_PER_PX * down_px).clamp(-90.0, 90.0);
    CameraTable { yaw_deg, pitch_deg: Some(pitch_deg), ..camera.clone() }
}

/// The camera moved sideways, so that what lies at its target's distance follows the pointer over a picture of
/// `height_px`.
#[must_use]
pub fn pan(camera: &CameraTable, [right_px, down_px]: [f64; 2], height_px: f64) -> CameraTable {
    let distance_mm = camera.distance_mm.unwrap_or(1.0);
    let pixel_mm = 2.0 * distance_mm * (0.5 * camera.fov_y_deg.to_radians()).tan() / height_px.max(1.0);
    let axes = axes(camera);
    let moved = pixel_mm * (down_px * axes.y_axis - right_px * axes.x_axis);
    let target = DVec3::from_array(camera.target_mm.unwrap_or_default()) + moved;
    CameraTable { target_mm: Some(target.to_array()), ..camera.clone() }
}

/// The camera nearer by so many steps of a wheel.
#[must_use]
pub fn dolly(camera: &CameraTable, steps: f64) -> CameraTable {
    let [nearest, farthest] = DISTANCES_MM;
    let distance_mm = camera.distance_mm.unwrap_or(1.0) * (-DOLLY_STEP * steps).exp();
    CameraTable { distance_mm: Some(distance_mm.clamp(nearest, farthest)), ..camera.clone() }
}

/// The direction from a light to the scene after a drag in pixels: where the light comes from follows the pointer.
#[must_use]
pub fn turn_light(direction: [f64; 3], camera: &CameraTable, [right_px, down_px]: [f64; 2]) -> [f64; 3] {
    let axes = axes(camera);
    let turn = DEG_PER_PX.to_radians();
    let turned = DQuat::from_axis_angle(axes.y_axis, turn * right_px)
        * DQuat::from_axis_angle(axes.x_axis, turn * down_px);
    (turned * direction_or(DVec3::from_array(direction), DVec3::NEG_Y)).to_array()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::camera::Camera;
    use glam::DVec2;

    const SIZE: [u32; 2] = [640, 480];

    fn camera() -> CameraTable {
        CameraTable {
            yaw_deg: 20.0,
            pitch_deg: Some(15.0),
            distance_mm: Some(200.0),
            target_mm: Some([3.0, -2.0, 5.0]),
            ..Default::default()
        }
    }

    /// Where a point is seen, in pixels from the upper left corner.
    fn seen(camera: &CameraTable, p: DVec3) -> DVec2 {
        let placed = Camera::new(camera, SIZE, DVec3::ZERO, std::iter::empty(), 1.0);
        let clip = placed.clip_from_world(SIZE, DVec2::ZERO) * p.extend(1.0);
        let half = 0.5 * DVec2::new(f64::from(SIZE[0]), f64::from(SIZE[1]));
        half + half * clip.truncate().truncate() / clip.w
    }

    #[test]
    fn what_is_panned_follows_the_pointer() {
        let target = DVec3::from_array(camera().target_mm.unwrap());
        let moved = seen(&pan(&camera(), [31.0, -12.0], 480.0), target) - seen(&camera(), target);
        assert!((moved - DVec2::new(31.0, -12.0)).length() < 1e-9, "{moved}");
    }

    #[test]
    fn what_is_nearer_than_the_target_follows_an_orbit() {
        let near = DVec3::from_array(camera().target_mm.unwrap()) + 30.0 * axes(&camera()).z_axis;
        let moved = seen(&orbit(&camera(), [10.0, 0.0]), near) - seen(&camera(), near);
        assert!(moved.x > 1.0 && moved.y.abs() < 2.0, "{moved}");
        let moved = seen(&orbit(&camera(), [0.0, 10.0]), near) - seen(&camera(), near);
        assert!(moved.y > 1.0 && moved.x.abs() < 1e-6, "{moved}");
        let above = orbit(&camera(), [-1e4, 1e6]);
        assert!(above.pitch_deg == Some(90.0) && (0.0..360.0).contains(&above.yaw_deg));
    }

    #[test]
    fn a_dolly_and_back_is_none_and_stays_within_what_a_scene_allows() {
        let there = dolly(&camera(), 3.0);
        assert!(there.distance_mm.unwrap() < 150.0);
        assert!((dolly(&there, -3.0).distance_mm.unwrap() - 200.0).abs() < 1e-9);
        assert_eq!(dolly(&camera(), 1e6).distance_mm, Some(1e-3));
        assert_eq!(dolly(&camera(), -1e6).distance_mm, Some(1e9));
    }

    #[test]
    fn a_light_comes_from_where_it_is_dragged_to() {
        let axes = axes(&camera());
        let ahead = (-axes.z_axis).to_array();
        let toward = |drag| -DVec3::from_array(turn_light(ahead, &camera(), drag));
        assert!(
            toward([40.0, 0.0]).dot(axes.x_axis) > 0.2 && toward([40.0, 0.0]).dot(axes.y_axis).abs() < 1e-9
        );
        assert!(toward([0.0, 40.0]).dot(axes.y_axis) < -0.2);
        assert!(turn_light([0.0; 3], &camera(), [1.0, 1.0]).iter().all(|c| c.is_finite()));
    }
}
