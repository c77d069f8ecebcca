//! Where a ray enters a rounded cone: two balls and the cone that touches both, a fiber's straight piece.

use glam::DVec3;

/// A straight piece of a fiber.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundedCone {
    /// Centres of the two balls.
    pub ends: [DVec3; 2],
    /// Their radii, at least 0.
    pub radii: [f64; 2],
}

/// Below this share of the squared length a ray counts as one along the cone's side: its quadratic has no square.
const PARALLEL: f64 = 1e-12;

/// The least t at which `origin + t direction` (unit) enters the cone from outside; negative behind the origin.
pub fn enter(cone: &RoundedCone, origin: DVec3, direction: DVec3) -> Option<f64> {
    let ([a, b], [ra, rb]) = (cone.ends, cone.radii);
    // From the ray's point nearest to the middle: a far-off origin would cost digits.
    let near = (0.5 * (a + b) - origin).dot(direction);
    let origin = origin + near * direction;
    let (axis, from_a) = (b - a, origin - a);
    let shrink = ra - rb;
    let length_squared = axis.length_squared();
    let side_squared = length_squared - shrink * shrink;
    let from_start = if side_squared <= 0.0 {
        // One ball holds the other.
        if shrink > 0.0 { enter_ball(from_a, ra, direction) } else { enter_ball(origin - b, rb, direction) }
    } else {
        enter_side([axis, from_a, direction], [ra, shrink], [length_squared, side_squared])
            .or_else(|| enter_balls([from_a, origin - b], cone.radii, direction))
    };
    from_start.map(|t| t + near)
}

/// Entry through the cone's side, between the circles on which it touches the balls. A point of the side obeys
/// |p - a|^2 side^2 = (...)^2, a quadratic in t; `side_squared` is its squared length.
fn enter_side(
    [axis, from_a, direction]: [DVec3; 3],
    [ra, shrink]: [f64; 2],
    [length_squared, side_squared]: [f64; 2],
) -> Option<f64> {
    let (along_origin, along_direction) = (axis.dot(from_a), axis.dot(direction));
    let k2 = side_squared - along_direction * along_direction;
    let k1 =
        side_squared * direction.dot(from_a) - along_origin * along_direction + along_direction * shrink * ra;
    let k0 = side_squared * from_a.length_squared() - along_origin * along_origin
        + 2.0 * along_origin * shrink * ra
        - length_squared * ra * ra;
    let discriminant = k1 * k1 - k0 * k2;
    if discriminant < 0.0 || k2.abs() <= PARALLEL * length_squared {
        return None;
    }
    let root = discriminant.sqrt();
    let between = |t: f64| (0.0..=side_squared).contains(&(along_origin - ra * shrink + t * along_direction));
    if k2 > 0.0 {
        let t = (-k1 - root) / k2;
        return between(t).then_some(t);
    }
    // Steeper than the side: one root enters and the other is of the mirrored cone, or leaves.
    let enters = |t: f64| {
        let p = from_a + t * direction;
        let along = axis.dot(p) / length_squared;
        let slope = shrink / length_squared.sqrt();
        let outward =
            (p - along * axis).normalize_or_zero() * (1.0 - slope * slope).sqrt() + axis.normalize() * slope;
        outward.dot(direction) < 0.0
    };
    let roots = [(-k1 - root) / k2, (-k1 + root) / k2];
    roots.into_iter().filter(|&t| between(t) && enters(t)).min_by(f64::total_cmp)
}

fn enter_ball(from_center: DVec3, radius: f64, direction: DVec3) -> Option<f64> {
    let b = from_center.dot(direction);
    // The distance of the line from the centre, without the difference of two large squares.
    let off = (from_center - b * direction).length_squared();
    let discriminant = radius * radius - off;
    (discriminant > 0.0).then(|| -b - discriminant.sqrt())
}

fn enter_balls(from: [DVec3; 2], radii: [f64; 2], direction: DVec3) -> Option<f64> {
    let entries = [0, 1].map(|end| enter_ball(from[end], radii[end], direction));
    entries.into_iter().flatten().min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::Rng;

    /// How far `p` is outside the cone, by the definition: the least over all balls between the two.
    fn outside(cone: &RoundedCone, p: DVec3) -> f64 {
        let at = |s: f64| {
            p.distance(cone.ends[0].lerp(cone.ends[1], s))
                - (cone.radii[0] + s * (cone.radii[1] - cone.radii[0]))
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..200 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if at(a) < at(b) { high = b } else { low = a }
        }
        at(low)
    }

    fn random_direction(rng: &mut Rng) -> DVec3 {
        loop {
            let v = DVec3::from_array(std::array::from_fn(|_| 2.0 * rng.uniform() - 1.0));
            if (1e-3..=1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    #[test]
    fn rays_enter_where_they_first_come_inside_and_miss_what_stays_outside() {
        let (mut hits, mut misses) = (0, 0);
        for case in 0..3000 {
            let mut rng = Rng::new(8, &[case]);
            let a = random_direction(&mut rng) * 3.0;
            let length = [2.0, 0.3, 0.05][case as usize % 3];
            let radii = [[0.2, 0.2], [0.2, 0.05], [0.0, 0.2], [0.2, 0.0]][case as usize / 3 % 4];
            let cone = RoundedCone { ends: [a, a + random_direction(&mut rng) * length], radii };
            let aim = cone.ends[0].lerp(cone.ends[1], rng.uniform()) + random_direction(&mut rng) * 0.25;
            // Some along the axis.
            let along = (cone.ends[1] - cone.ends[0]).normalize();
            let mixed = along + random_direction(&mut rng) * [1.5, 0.05, 0.0][case as usize % 5 % 3];
            let direction = mixed.normalize_or(DVec3::X) * if rng.uniform() < 0.5 { 1.0 } else { -1.0 };
            let origin = aim - 20.0 * direction;
            match enter(&cone, origin, direction) {
                Some(t) => {
                    hits += 1;
                    let at = outside(&cone, origin + t * direction);
                    assert!(at.abs() < 1e-7, "case {case}: {at} off the surface");
                    for k in 1..200 {
                        let before = t * f64::from(k) / 200.0 - 1e-6;
                        let inside = outside(&cone, origin + before * direction);
                        assert!(inside > -1e-7, "case {case}: inside by {inside} before");
                    }
                }
                None => {
                    misses += 1;
                    for k in 0..400 {
                        let p = origin + (17.0 + 6.0 * f64::from(k) / 400.0) * direction;
                        assert!(outside(&cone, p) > -1e-7, "case {case}: missed");
                    }
                }
            }
        }
        assert!(hits > 500 && misses > 200, "{hits} {misses}");
    }

    #[test]
    fn a_far_origin_costs_no_digits_and_an_origin_inside_enters_behind() {
        let cone = RoundedCone { ends: [DVec3::ZERO, DVec3::X * 0.05], radii: [0.008, 0.008] };
        let t = enter(&cone, DVec3::new(0.02, 0.001, 1e4), DVec3::NEG_Z).unwrap();
        let exact = 1e4 - (0.008f64.powi(2) - 1e-6).sqrt();
        assert!((t - exact).abs() < 1e-11, "{}", t - exact);
        let inside = enter(&cone, DVec3::new(0.02, 0.001, 0.0), DVec3::Z).unwrap();
        assert!(inside < 0.0, "{inside}");
    }
}
