//! Pieces of yarn packed for the device, in parts that storage buffers have room for.

use crate::gpu_types::{Curve, LENGTH_STRIPE, Piece};
use crate::yarn::packed::{MOST_CURVES, PackedCurve, length_units, packed_phase, packed_piece, packed_rate};
use crate::yarn::strand::Strands;
use rayon::prelude::*;
use std::ops::Range;

/// Some of a fabric's pieces, in a row, and the control points they read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Of [`Strands::pieces`].
    pub pieces: Range<usize>,
    /// Of [`Strands::points`].
    pub points: Range<usize>,
}

/// A fabric's pieces in parts of at most `most_points` control points, or one piece where it has more; a fabric without
/// pieces is one part.
pub fn parts(strands: &Strands, most_points: usize) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    let mut first_curve = 0;
    for (index, piece) in strands.pieces.iter().enumerate() {
        let end = piece.first_point + 4;
        match parts.last_mut() {
            // The last curve's place stands behind all pieces.
            Some(part)
                if end - part.points.start <= most_points && piece.curve - first_curve < MOST_CURVES - 1 =>
            {
                part.pieces.end = index + 1;
                part.points.end = end;
            }
            _ => {
                first_curve = piece.curve;
                parts.push(Part { pieces: index..index + 1, points: piece.first_point..end });
            }
        }
    }
    if parts.is_empty() {
        parts.push(Part { pieces: 0..0, points: 0..strands.points.len() });
    }
    parts
}

/// The curve whose place in a part's table is 0.
fn first_curve(strands: &Strands, part: &Part) -> usize {
    strands.pieces.get(part.pieces.start).map_or(0, |piece| piece.curve)
}

/// A part's pieces, and one more, so that each has a next.
pub fn pieces(strands: &Strands, part: &Part) -> Vec<Piece> {
    let first_curve = first_curve(strands, part);
    let last_curve = part.pieces.end.checked_sub(1).map(|last| strands.pieces[last].curve);
    let words = |index: usize| match strands.pieces.get(index) {
        Some(piece) if index < part.pieces.end || Some(piece.curve) == last_curve => {
            let units = length_units(piece.length_start_mm, strands.curves[piece.curve].length_mm);
            packed_piece(units, (piece.curve - first_curve) as u32)
        }
        _ => packed_piece(0, MOST_CURVES as u32 - 1),
    };
    let packed = |index| {
        let [length_low, length_high_curve] = words(index);
        Piece { length_low, length_high_curve }
    };
    (part.pieces.start..part.pieces.end + 1).into_par_iter().map(packed).collect()
}

/// A part's curves, from that of its first piece on.
pub fn curves(strands: &Strands, part: &Part) -> Vec<Curve> {
    packed_curves(strands, part).iter().map(curve).collect()
}

/// The same in the twin's words.
pub fn packed_curves(strands: &Strands, part: &Part) -> Vec<PackedCurve> {
    let (first_curve, stride) = (first_curve(strands, part), strands.basis.point_stride() as u32);
    let mut curves = Vec::new();
    for (index, piece) in strands.pieces[part.pieces.clone()].iter().enumerate() {
        let place = piece.curve - first_curve;
        if place < curves.len() {
            continue;
        }
        curves.resize(place, PackedCurve::default());
        let of_curve = &strands.curves[piece.curve];
        let point = (piece.first_point - part.points.start) as u32;
        curves.push(PackedCurve {
            first_point: point.wrapping_sub(stride * index as u32),
            curve: piece.curve as u32,
            migration_period_count: strands.period_counts[piece.curve],
            phases: of_curve.phases.map(packed_phase),
            rates: of_curve.rates.map(|rate| packed_rate(rate * of_curve.length_mm)),
            stripe_rate: packed_rate(of_curve.length_mm / f64::from(LENGTH_STRIPE)),
            length_mm: of_curve.length_mm,
        });
    }
    curves
}

fn curve(packed: &PackedCurve) -> Curve {
    let words = |rate: i64| [rate as u32, (rate >> 32) as u32];
    let [ply_phase, fiber_phase, migration_phase] = packed.phases;
    let [ply_rate, fiber_rate, migration_rate] = packed.rates.map(words);
    Curve {
        first_point: packed.first_point,
        curve: packed.curve,
        migration_period_count: packed.migration_period_count,
        ply_phase,
        fiber_phase,
        migration_phase,
        ply_rate,
        fiber_rate,
        migration_rate,
        stripe_rate: words(packed.stripe_rate),
        length_mm: packed.length_mm as f32,
        padding: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::curve::{self, Basis};
    use crate::yarn::packed::unpacked_segment;
    use crate::yarn::params::YarnParams;
    use crate::yarn::presets;
    use crate::yarn::strand::strands;
    use glam::DVec3;

    fn yarns(basis: Basis, yarn: &YarnParams) -> Strands {
        let at = |i: u32| DVec3::new(f64::from(i), f64::from(i).sin(), f64::from(i % 3));
        let curve = |count: u32, closed| curve::Curve { points: (0..count).map(at).collect(), closed };
        strands(&[curve(13, false), curve(1, false), curve(31, false), curve(12, true)], basis, yarn, 5)
    }

    /// Every piece of a fabric, unpacked by the twin, against the f64 truth.
    fn hold(strands: &Strands, most_points: usize) -> usize {
        let all = parts(strands, most_points);
        let mut next = 0;
        for part in &all {
            assert_eq!(part.pieces.start, next, "every piece once");
            next = part.pieces.end;
            let (pieces, curves) = (pieces(strands, part), packed_curves(strands, part));
            assert_eq!(pieces.len(), part.pieces.len() + 1);
            for (index, truth) in strands.pieces[part.pieces.clone()].iter().enumerate() {
                let words = |index: usize| [pieces[index].length_low, pieces[index].length_high_curve];
                let curve = &curves[words(index)[1] as usize >> 10];
                assert_eq!(curve.curve as usize, truth.curve);
                let stride = strands.basis.point_stride() as u32;
                let found = unpacked_segment(words(index), words(index + 1), curve, index as u32, stride);
                assert_eq!(found.first_point as usize + part.points.start, truth.first_point);
                assert!(part.points.end >= truth.first_point + 4);
                let (found_turns, true_turns) = (found.turns, truth.turns);
                let reduced = |turns: f64| turns - turns.floor();
                for (a, b) in [(found_turns.ply, true_turns.ply), (found_turns.fiber, true_turns.fiber)] {
                    let apart = (a.start - reduced(b.start)).abs();
                    assert!(apart.min(1.0 - apart) < 1e-6, "{a:?} {b:?}");
                    assert!((a.delta - b.delta).abs() < 1e-6);
                }
                let migration = f64::from(found.migration_period) + found_turns.migration.start;
                assert!((migration - true_turns.migration.start).abs() < 1e-6);
                assert!((found.length_mm - truth.length_mm).abs() < 1e-9 * curve.length_mm);
                let start_mm = found.stripes_start * f64::from(LENGTH_STRIPE);
                let apart = (truth.length_start_mm - start_mm).rem_euclid(f64::from(LENGTH_STRIPE));
                assert!(apart.min(f64::from(LENGTH_STRIPE) - apart) < 1e-6, "{apart}");
            }
        }
        assert_eq!(next, strands.pieces.len());
        all.len()
    }

    #[test]
    fn pieces_come_out_as_they_went_in_whole_and_in_parts() {
        let yarn = presets::yarn("cotton1").unwrap();
        for basis in [Basis::CatmullRom, Basis::BSpline, Basis::Bezier] {
            let strands = yarns(basis, &yarn);
            assert_eq!(hold(&strands, usize::MAX), 1);
            for most in [4, 7, 20] {
                assert!(hold(&strands, most) > 1, "{basis:?} {most}");
            }
        }
    }

    #[test]
    fn a_pitch_changes_what_is_held_by_the_curve_alone() {
        let yarn = presets::yarn("cotton1").unwrap();
        let mut other = yarn.clone();
        (other.ply_pitch_mm, other.fiber_pitch_mm) = (Some(3.1), Some(7.7));
        let (before, after) = (yarns(Basis::CatmullRom, &yarn), yarns(Basis::CatmullRom, &other));
        let part = &parts(&before, usize::MAX)[0];
        assert_eq!(pieces(&before, part), pieces(&after, part));
        assert_eq!((&before.points, &before.normals), (&after.points, &after.normals));
        assert_ne!(curves(&before, part), curves(&after, part));
    }

    #[test]
    fn a_fabric_of_long_yarns_takes_little_over_24_bytes_a_control_point() {
        use crate::gpu_types::ControlPoint;
        let yarn = presets::yarn("cotton1").unwrap();
        let points = (0..4000).map(|i| DVec3::X * f64::from(i)).collect();
        let strands = strands(&[curve::Curve { points, closed: false }], Basis::CatmullRom, &yarn, 0);
        let part = &parts(&strands, usize::MAX)[0];
        let bytes = size_of_val(&pieces(&strands, part)[..])
            + size_of_val(&curves(&strands, part)[..])
            + size_of::<ControlPoint>() * strands.points.len();
        // And 8 where other yarns hide the sky.
        assert!(bytes <= 24 * 4000 + 256, "{bytes}");
    }
}
