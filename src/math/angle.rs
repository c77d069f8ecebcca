//! Angles of directions about a fiber; twin of `glsl/lib/angle.glsl`.

use super::frame::{any_perpendicular, direction_or};
use glam::DVec3;

/// theta, in [-pi/2, pi/2]: angle of unit `w` out of the plane perpendicular to the unit `tangent`.
pub fn longitudinal_angle(tangent: DVec3, w: DVec3) -> f64 {
    w.dot(tangent).atan2(w.cross(tangent).length())
}

/// |cos(phi / 2)|, phi the azimuth between two unit directions about the unit `tangent`. Where a
/// direction is parallel to the tangent its azimuth is undefined and one fixed perpendicular stands
/// for it.
pub fn cos_half_azimuth(tangent: DVec3, a: DVec3, b: DVec3) -> f64 {
    let some = any_perpendicular(tangent);
    let u = direction_or(a - tangent * a.dot(tangent), some);
    let v = direction_or(b - tangent * b.dot(tangent), some);
    (0.5 * (u + v).length()).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_of_constructed_directions() {
        for theta in [-1.5, -0.7, 0.0, 1e-4, 1.2, 1.56] {
            for phi in [0.0, 0.5, 2.0, 3.0, std::f64::consts::PI] {
                let at = |theta: f64, phi: f64| {
                    DVec3::new(theta.cos() * phi.cos(), theta.cos() * phi.sin(), theta.sin())
                };
                assert!((longitudinal_angle(DVec3::Z, at(theta, phi)) - theta).abs() < 1e-12);
                let half = cos_half_azimuth(DVec3::Z, at(theta, 0.3), at(0.4, 0.3 + phi));
                assert!((half - (0.5 * phi).cos()).abs() < 1e-9, "theta {theta} phi {phi}: {half}");
            }
        }
    }
}
