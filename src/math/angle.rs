//! Angles of directions about a fiber; twin of `glsl/lib/angle.glsl`.

use super::frame::normal_perpendicular_to;
use glam::DVec3;

/// atan2(y, x) in radians, 0 where both are 0.
pub fn angle_of(y: f64, x: f64) -> f64 {
    // Adding 0 makes 0 of -0, whose sign would choose between 0 and pi.
    (y + 0.0).atan2(x + 0.0)
}

/// theta, in [-pi/2, pi/2]: angle of unit `w` out of the plane perpendicular to the unit `tangent`.
pub fn longitudinal_angle(tangent: DVec3, w: DVec3) -> f64 {
    angle_of(w.dot(tangent), w.cross(tangent).length())
}

/// |cos(phi / 2)|, phi the azimuth between two unit directions about the unit `tangent`. Where a
/// direction is parallel to the tangent its azimuth is undefined and one fixed perpendicular stands
/// for it.
pub fn cos_half_azimuth(tangent: DVec3, a: DVec3, b: DVec3) -> f64 {
    let u = normal_perpendicular_to(tangent, a);
    let v = normal_perpendicular_to(tangent, b);
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
