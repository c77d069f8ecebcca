//! Centre lines and one cubic piece of them; `curve_point` is the twin of `glsl/lib/curve.glsl`.

use glam::DVec3;

/// How a curve's control points become a continuous centre line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Basis {
    /// Uniform cubic Catmull-Rom: the curve passes through every point (BCC `C0`).
    CatmullRom,
    /// Uniform cubic B-spline (BCC `BS`).
    BSpline,
    /// Piecewise cubic Bezier: points 0, 3, 6, ... lie on the curve (BCC `BZ`).
    Bezier,
    /// Straight segments through every point (BCC `PL`, OBJ `l`).
    Polyline,
}

impl Basis {
    /// From one piece's first control point to the next one's; `POINT_STRIDE` in GLSL.
    pub fn point_stride(self) -> usize {
        if self == Self::Bezier { 3 } else { 1 }
    }
}

/// One yarn's control points.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Control points in the file's units and axes, in order along the yarn.
    pub points: Vec<DVec3>,
    /// Whether the last point joins the first again. The first point is not repeated.
    pub closed: bool,
}

/// A point of a cubic piece with its derivatives by t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Position at t.
    pub position: DVec3,
    /// First derivative by t.
    pub derivative: DVec3,
    /// Second derivative by t.
    pub second_derivative: DVec3,
}

/// Evaluates one cubic piece of any basis at `t` in [0, 1].
pub fn curve_point(p: &[DVec3; 4], basis: Basis, t: f64) -> CurvePoint {
    bezier_point(&bezier_from_basis(p, basis), t)
}

/// Evaluates the Bezier piece `b` at `t` in [0, 1].
pub fn bezier_point(b: &[DVec3; 4], t: f64) -> CurvePoint {
    let s = 1.0 - t;
    let [d0, d1, d2] = [b[1] - b[0], b[2] - b[1], b[3] - b[2]];
    CurvePoint {
        position: b[0] * (s * s * s)
            + b[1] * (3.0 * s * s * t)
            + b[2] * (3.0 * s * t * t)
            + b[3] * (t * t * t),
        derivative: 3.0 * (s * s * d0 + 2.0 * s * t * d1 + t * t * d2),
        second_derivative: 6.0 * (s * (d1 - d0) + t * (d2 - d1)),
    }
}

/// The same piece as a Bezier curve, whose control points bound it.
pub fn bezier_from_basis(p: &[DVec3; 4], basis: Basis) -> [DVec3; 4] {
    match basis {
        Basis::CatmullRom => [p[1], p[1] + (p[2] - p[0]) / 6.0, p[2] - (p[3] - p[1]) / 6.0, p[2]],
        Basis::BSpline => {
            let b1 = p[1].lerp(p[2], 1.0 / 3.0);
            let b2 = p[1].lerp(p[2], 2.0 / 3.0);
            [(p[0].lerp(p[1], 2.0 / 3.0) + b1) * 0.5, b1, b2, (b2 + p[2].lerp(p[3], 1.0 / 3.0)) * 0.5]
        }
        Basis::Bezier => *p,
        Basis::Polyline => [p[1], p[1].lerp(p[2], 1.0 / 3.0), p[1].lerp(p[2], 2.0 / 3.0), p[2]],
    }
}

/// Most that a leg of a piece's control polygon may go less far along the chord than its longest leg is long, as a share
/// of that, where one rule spans the whole piece.
const GENTLE: f64 = 0.1;

/// Arc length of a cubic piece from t = `start` to t = `end`, in the points' unit. Gauss-Legendre
/// quadrature, on two halves where the piece bends much; relative error below 1e-6 for pieces without a cusp.
pub fn arc_length(p: &[DVec3; 4], basis: Basis, start: f64, end: f64) -> f64 {
    let b = bezier_from_basis(p, basis);
    let [d0, d1, d2] = [b[1] - b[0], b[2] - b[1], b[3] - b[2]];
    // The derivative as a polynomial: it is asked for often, by the million pieces.
    let [constant, linear, square] = [3.0 * d0, 6.0 * (d1 - d0), 3.0 * (d0 - 2.0 * d1 + d2)];
    let speed = |t: f64| (constant + t * (linear + t * square)).length();
    let longest = d0.length().max(d1.length()).max(d2.length());
    let shortest_along = [d0, d1, d2].map(|d| d.dot(b[3] - b[0])).into_iter().fold(f64::INFINITY, f64::min);
    let gentle = shortest_along >= (1.0 - GENTLE) * longest * (b[3] - b[0]).length();
    if gentle {
        return super::quadrature::gauss_legendre(start, end, speed);
    }
    let middle = 0.5 * (start + end);
    super::quadrature::gauss_legendre(start, middle, speed)
        + super::quadrature::gauss_legendre(middle, end, speed)
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [DVec3; 4] = [
        DVec3::new(0.3, -1.0, 0.2),
        DVec3::new(1.0, 0.5, -0.4),
        DVec3::new(2.2, 0.1, 0.9),
        DVec3::new(2.5, -2.0, 1.5),
    ];
    const ALL: [Basis; 4] = [Basis::CatmullRom, Basis::BSpline, Basis::Bezier, Basis::Polyline];

    /// Textbook weights of the four control points at t.
    fn weights(basis: Basis, t: f64) -> [f64; 4] {
        let (s, t2, t3) = (1.0 - t, t * t, t * t * t);
        match basis {
            Basis::CatmullRom => [
                0.5 * (-t3 + 2.0 * t2 - t),
                0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
                0.5 * (-3.0 * t3 + 4.0 * t2 + t),
                0.5 * (t3 - t2),
            ],
            Basis::BSpline => {
                [s * s * s, 3.0 * t3 - 6.0 * t2 + 4.0, -3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0, t3]
                    .map(|w| w / 6.0)
            }
            Basis::Bezier => [s * s * s, 3.0 * s * s * t, 3.0 * s * t2, t3],
            Basis::Polyline => [0.0, s, t, 0.0],
        }
    }

    #[test]
    fn every_basis_has_its_textbook_weights() {
        for basis in ALL {
            for i in 0..=10 {
                let t = f64::from(i) / 10.0;
                let expected: DVec3 = POINTS.iter().zip(weights(basis, t)).map(|(p, w)| *p * w).sum();
                let found = curve_point(&POINTS, basis, t).position;
                assert!((found - expected).length() < 1e-13, "{basis:?} at {t}");
            }
        }
    }

    #[test]
    fn derivatives_match_finite_differences() {
        let h = 1e-5;
        for basis in ALL {
            let at = |t| curve_point(&POINTS, basis, t);
            let slope = (at(0.4 + h).position - at(0.4 - h).position) / (2.0 * h);
            assert!((slope - at(0.4).derivative).length() < 1e-8, "{basis:?}");
            let bend = (at(0.4 + h).derivative - at(0.4 - h).derivative) / (2.0 * h);
            assert!((bend - at(0.4).second_derivative).length() < 1e-8, "{basis:?}");
        }
    }

    #[test]
    fn arc_length_agrees_with_a_fine_polyline() {
        for basis in ALL {
            let n = 100_000;
            let at = |i: usize| curve_point(&POINTS, basis, i as f64 / n as f64).position;
            let polyline: f64 = (0..n).map(|i| (at(i + 1) - at(i)).length()).sum();
            let length = arc_length(&POINTS, basis, 0.0, 1.0);
            assert!((length - polyline).abs() < 1e-6 * polyline, "{basis:?}: {length} vs {polyline}");
        }
    }
}
