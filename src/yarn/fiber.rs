//! The one function that places a fiber; twin of `glsl/yarn/fiber.glsl`.

use super::params::YarnParams;
use super::period::FiberShape;
use super::table::Fiber;
use crate::math::curve::bezier_point;
use crate::math::frame::{direction_of, direction_or, normal_perpendicular_to};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Turns at the start of a piece of yarn and what the piece adds to them. Not reduced: f64 carries
/// the whole count.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turns {
    /// At the piece's start.
    pub start: f64,
    /// Added over the piece.
    pub delta: f64,
}

/// The three rotations of a piece of yarn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PieceTurns {
    /// Plies about the yarn.
    pub ply: Turns,
    /// Fibers inside the ply's frame.
    pub fiber: Turns,
    /// Phase of the fiber's radius R.
    pub migration: Turns,
}

/// Rotations at one point of a yarn in radians, and their derivatives by t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    /// Plies about the yarn.
    pub ply: f64,
    /// Fibers inside the ply's frame.
    pub fiber: f64,
    /// Phase of R.
    pub migration: f64,
    /// d ply / dt.
    pub ply_rate: f64,
    /// d fiber / dt.
    pub fiber_rate: f64,
    /// d migration / dt.
    pub migration_rate: f64,
}

/// The yarn's centre and orthonormal frame at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct YarnPoint {
    /// Position of the centre line.
    pub center: DVec3,
    /// Unit tangent.
    pub tangent: DVec3,
    /// Unit normal.
    pub normal: DVec3,
    /// |d center / dt|.
    pub speed: f64,
    /// d^2 center / dt^2.
    pub bend: DVec3,
}

/// A point of one fiber.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiberPoint {
    /// The yarn's centre at the same t.
    pub yarn_center: DVec3,
    /// The yarn's unit normal there.
    pub yarn_normal: DVec3,
    /// The ply's centre at the same t.
    pub ply_center: DVec3,
    /// Unit, from the yarn's centre to the ply's.
    pub ply_normal: DVec3,
    /// Unit, around the yarn.
    pub ply_binormal: DVec3,
    /// The fiber's own centre.
    pub position: DVec3,
    /// Unit direction of the fiber.
    pub tangent: DVec3,
    /// Distance from the yarn's centre line in the cross-section.
    pub center_distance: f64,
    /// Share of the fiber's full width.
    pub width: f64,
    /// R: distance from the ply's centre as a share of its ellipse.
    pub radius: f64,
}

/// Rotations at t of a piece.
pub fn twist_at(turns: &PieceTurns, t: f64) -> Twist {
    let angle = |turns: Turns| TAU * (turns.start + t * turns.delta).rem_euclid(1.0);
    Twist {
        ply: angle(turns.ply),
        fiber: angle(turns.fiber),
        migration: angle(turns.migration),
        ply_rate: TAU * turns.ply.delta,
        fiber_rate: TAU * turns.fiber.delta,
        migration_rate: TAU * turns.migration.delta,
    }
}

/// Unit tangent of the Bezier piece `b` where its derivative is `derivative`. A cusp or a zero-length
/// piece has none: the chord stands in, then the legs.
pub fn piece_tangent(b: &[DVec3; 4], derivative: DVec3) -> DVec3 {
    direction_of(derivative)
        .or_else(|| direction_of(b[3] - b[0]))
        .or_else(|| direction_of(b[2] - b[1]))
        .unwrap_or(DVec3::X)
}

/// The unit `normal` turned by the smallest rotation that takes the unit tangent `from` to `to`, times
/// 1 + from . to: no division, so no pole where the yarn doubles back. What of it lies along `from` comes to lie along
/// `to`: packed normals are not quite perpendicular.
pub fn turned_normal(from: DVec3, to: DVec3, normal: DVec3) -> DVec3 {
    let (more, along) = (1.0 + from.dot(to), normal.dot(from));
    more * (normal + 2.0 * along * to) - (along + normal.dot(to)) * (from + to)
}

/// Centre and frame at t of the Bezier piece `b` whose knots carry the given unit normals. Both
/// normals are turned to the tangent at t and blended, the nearer one and the less turned one first.
pub fn yarn_point(b: &[DVec3; 4], normals: [DVec3; 2], t: f64) -> YarnPoint {
    let c = bezier_point(b, t);
    let tangent = piece_tangent(b, c.derivative);
    let start = turned_normal(piece_tangent(b, b[1] - b[0]), tangent, normals[0]);
    let end = turned_normal(piece_tangent(b, b[3] - b[2]), tangent, normals[1]);
    YarnPoint {
        center: c.position,
        tangent,
        normal: normal_perpendicular_to(tangent, (1.0 - t) * start + t * end),
        speed: c.derivative.length(),
        bend: c.second_derivative,
    }
}

/// Wu & Yuksel 2019, Sec. 3.1: ply centre, then the fiber inside the ply's rotating elliptical frame.
pub fn fiber_point(
    yarn_at: &YarnPoint,
    twist: &Twist,
    yarn: &YarnParams,
    fiber: &Fiber,
    shape: &FiberShape,
) -> FiberPoint {
    let ply_angle = TAU * f64::from(fiber.ply) / f64::from(yarn.ply_count) + twist.ply;
    let (sin_fiber, cos_fiber) = (fiber.angle + twist.fiber + shape.angle).sin_cos();
    let fiber_rate = twist.fiber_rate + shape.angle_rate;

    // Offsets in the ply's frame: x away from the yarn's centre, y around it.
    let axes = DVec2::new(yarn.ellipse_short_mm, yarn.ellipse_long_mm);
    let (outward, around) = (DVec2::new(cos_fiber, sin_fiber), DVec2::new(-sin_fiber, cos_fiber));
    // What lies beyond the ply's surface stands out by a length of its own where the ply is flat.
    let beyond = (shape.radius - yarn.surface_radius()).max(0.0);
    let beyond_rate = if beyond > 0.0 { shape.radius_rate } else { 0.0 };
    let more = yarn.beyond_mm() - axes;
    let offset = (shape.radius * axes + beyond * more) * outward;
    let rate = (shape.radius_rate * axes + beyond_rate * more) * outward
        + (shape.radius * axes + beyond * more) * fiber_rate * around;

    let binormal = yarn_at.tangent.cross(yarn_at.normal);
    let normal_ply = ply_angle.cos() * yarn_at.normal + ply_angle.sin() * binormal;
    let binormal_ply = yarn_at.tangent.cross(normal_ply);
    let away = yarn.ply_offset_mm() + offset.x;
    let from_center = away * normal_ply + offset.y * binormal_ply;

    // On the inside of a bend the fiber advances less than the centre line.
    let bend_speed = from_center.dot(yarn_at.bend) / yarn_at.speed.max(1e-12);
    let velocity = (yarn_at.speed - bend_speed) * yarn_at.tangent
        + (rate.x - twist.ply_rate * offset.y) * normal_ply
        + (rate.y + twist.ply_rate * away) * binormal_ply;
    FiberPoint {
        yarn_center: yarn_at.center,
        yarn_normal: yarn_at.normal,
        ply_normal: normal_ply,
        ply_binormal: binormal_ply,
        ply_center: yarn_at.center + yarn.ply_offset_mm() * normal_ply,
        position: yarn_at.center + from_center,
        tangent: direction_or(velocity, yarn_at.tangent),
        center_distance: away.hypot(offset.y),
        width: shape.width,
        radius: shape.radius,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yarn::period::migration_shape;
    use crate::yarn::presets;

    fn migrating(y: &YarnPoint, twist: &Twist, yarn: &YarnParams, fiber: &Fiber) -> FiberPoint {
        fiber_point(
            y,
            twist,
            yarn,
            fiber,
            &migration_shape(fiber, twist.migration, twist.migration_rate, yarn),
        )
    }

    fn straight(turns_per_mm: f64) -> ([DVec3; 4], PieceTurns) {
        let p = [0.0, 0.4, 0.8, 1.2].map(|x| DVec3::new(x, 0.0, 0.0));
        let turns = |delta| Turns { start: 0.3, delta };
        let pieces = PieceTurns {
            ply: turns(turns_per_mm),
            fiber: turns(-1.3 * turns_per_mm),
            migration: turns(0.7 * turns_per_mm),
        };
        (p, pieces)
    }

    #[test]
    fn tangent_matches_a_finite_difference_on_a_straight_yarn() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let fiber = Fiber { radius: 0.8, angle: 1.0, migration_phase: 2.0, ply: 2 };
        let (p, turns) = straight(0.2);
        let at = |t| {
            let y = yarn_point(&p, [DVec3::Y, DVec3::Y], t);
            migrating(&y, &twist_at(&turns, t), &yarn, &fiber)
        };
        let h = 1e-6;
        let slope = (at(0.4 + h).position - at(0.4 - h).position).normalize();
        assert!((slope - at(0.4).tangent).length() < 1e-8);
    }

    #[test]
    fn tangent_matches_a_finite_difference_on_a_planar_bend() {
        // In a plane the constant binormal is rotation-minimising, so the formula must be exact.
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let fiber = Fiber { radius: 0.9, angle: 0.4, migration_phase: 2.0, ply: 1 };
        let p = [(0.0, 0.0), (0.8, -0.3), (1.6, -0.2), (2.0, 0.5)].map(|(x, y)| DVec3::new(x, y, 0.0));
        let (_, turns) = straight(0.1);
        let at = |t| {
            let y = yarn_point(&p, [DVec3::Z, DVec3::Z], t);
            migrating(&y, &twist_at(&turns, t), &yarn, &fiber)
        };
        let h = 1e-6;
        let slope = (at(0.6 + h).position - at(0.6 - h).position).normalize();
        assert!((slope - at(0.6).tangent).length() < 1e-8);
    }

    #[test]
    fn what_stands_out_of_a_flat_ply_does_so_by_its_own_length_on_all_sides() {
        let flat = YarnParams {
            ellipse_short_mm: 0.007,
            ellipse_long_mm: 0.7,
            migration_max: 1.0,
            ..presets::yarn("worsted_3ply").unwrap()
        };
        let y = yarn_point(&[0.0, 1.0, 2.0, 3.0].map(|x| DVec3::X * x), [DVec3::Y; 2], 0.5);
        let twist = twist_at(&PieceTurns::default(), 0.5);
        let at = |angle: f64, radius: f64| {
            let fiber = Fiber { radius: 1.0, angle, migration_phase: 0.0, ply: 0 };
            let shape = FiberShape { radius, radius_rate: 1.0, angle: 0.0, angle_rate: 2.0, width: 1.0 };
            fiber_point(&y, &twist, &flat, &fiber, &shape).position
        };
        for i in 0..32 {
            let angle = f64::from(i) * TAU / 32.0;
            // 0.07 mm is the radius of the circle of the same area.
            let out = at(angle, 5.0).distance(at(angle, 1.0)) / (4.0 * 0.07);
            assert!((0.8..1.25).contains(&out), "{angle}: {out}");
            assert!(at(angle, 1.0 + 1e-9).distance(at(angle, 1.0)) < 1e-9, "no step at the surface");
        }
    }

    #[test]
    fn tangent_matches_a_finite_difference_in_and_beyond_a_flat_ply() {
        let flat = YarnParams {
            ellipse_short_mm: 0.02,
            ellipse_long_mm: 0.7,
            ..presets::yarn("worsted_3ply").unwrap()
        };
        let fiber = Fiber { radius: 0.8, angle: 1.0, migration_phase: 2.0, ply: 2 };
        let (p, turns) = straight(0.2);
        for radius in [0.5, 3.0] {
            let at = |t: f64| {
                let y = yarn_point(&p, [DVec3::Y, DVec3::Y], t);
                let shape = FiberShape {
                    radius: radius + 0.4 * t,
                    radius_rate: 0.4,
                    angle: 1.1 * t,
                    angle_rate: 1.1,
                    width: 1.0,
                };
                fiber_point(&y, &twist_at(&turns, t), &flat, &fiber, &shape)
            };
            let h = 1e-6;
            let slope = (at(0.4 + h).position - at(0.4 - h).position).normalize();
            assert!((slope - at(0.4).tangent).length() < 1e-8, "{radius}");
        }
    }

    #[test]
    fn degenerate_pieces_stay_finite() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let fiber = Fiber { radius: 0.8, angle: 1.0, migration_phase: 2.0, ply: 2 };
        let hairpin = [DVec3::ZERO, DVec3::X, DVec3::X, DVec3::ZERO];
        for p in [[DVec3::ZERO; 4], hairpin] {
            for normals in [[DVec3::Y, -DVec3::Y], [DVec3::X, DVec3::X]] {
                let y = yarn_point(&p, normals, 0.5);
                let f = migrating(&y, &twist_at(&PieceTurns::default(), 0.5), &yarn, &fiber);
                assert!(f.position.is_finite() && (f.tangent.length() - 1.0).abs() < 1e-12);
            }
        }
    }
}
