//! How what is seen moves from one frame to another; twin of `glsl/lib/motion.glsl`.

use glam::{DVec2, DVec3, DVec4, Vec4Swizzles};

/// From where a point is seen to where it is seen in another frame, both in clip space; in halves of the picture's sides,
/// y down. What is nearer than the near plane counts as on it.
pub fn seen_motion(clip: DVec4, clip_then: DVec4, near: f64) -> DVec2 {
    clip_then.xy() / clip_then.w.max(near) - clip.xy() / clip.w.max(near)
}

/// A vector that turns with a frame, of which two axes, unit and perpendicular, are given now and then.
pub fn carried_vector(
    v: DVec3,
    [normal, binormal]: [DVec3; 2],
    [normal_then, binormal_then]: [DVec3; 2],
) -> DVec3 {
    v.dot(normal) * normal_then
        + v.dot(binormal) * binormal_then
        + v.dot(normal.cross(binormal)) * normal_then.cross(binormal_then)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    #[test]
    fn what_turns_with_a_frame_turns_as_the_frame_does() {
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 1.1);
        let axes = [DVec3::new(0.6, 0.8, 0.0), DVec3::Z];
        for v in [DVec3::X, DVec3::Y, DVec3::new(-3.0, 0.2, 7.0)] {
            let found = carried_vector(v, axes, axes.map(|axis| turn * axis));
            assert!((found - turn * v).length() < 1e-14, "{found}");
        }
    }

    #[test]
    fn motion_is_toward_where_it_is_then_and_finite_behind_the_eye() {
        let (here, there) = (DVec4::new(1.0, 2.0, 0.1, 4.0), DVec4::new(2.0, 1.0, 0.1, 4.0));
        assert_eq!(seen_motion(here, there, 0.1), DVec2::new(0.25, -0.25));
        assert_eq!(seen_motion(there, here, 0.1), DVec2::new(-0.25, 0.25));
        assert_eq!(seen_motion(here, here, 0.1), DVec2::ZERO);
        assert_eq!(seen_motion(here, DVec4::new(1.0, 0.0, 0.0, -3.0), 0.5), DVec2::new(1.75, -0.5));
    }
}
