//! Fibers of a whole fabric, by index; twin of `glsl/yarn/fetch.glsl`, whose buffers this holds in f64.

use super::breaks::{StrandVertex, neighbours, strand_vertex};
use super::fiber::{FiberPoint, fiber_point, twist_at, yarn_point};
use super::flyaway::Flyaways;
use super::params::YarnParams;
use super::period::{CurvePeriods, FiberShape, Period, draw_period, period_rate, period_shape, period_turns};
use super::strand::{Piece, Strands};
use super::table::{Fiber, fiber_table};

/// A fabric's yarns with their fibers: everything that decides where a fiber lies.
#[derive(Clone, Debug)]
pub struct FiberField {
    /// Centre lines.
    pub strands: Strands,
    /// The fibers of the cross-section.
    pub fibers: Vec<Fiber>,
    /// The yarn.
    pub yarn: YarnParams,
    /// Its loops and hairs.
    pub flyaways: Flyaways,
    /// Seed of the periods' types.
    pub seed: u32,
}

impl FiberField {
    /// Draws the fibers of `yarn` for the given centre lines.
    pub fn new(strands: Strands, yarn: &YarnParams, seed: u64) -> Self {
        Self {
            strands,
            fibers: fiber_table(yarn, seed),
            yarn: yarn.clone(),
            flyaways: Flyaways::new(yarn),
            seed: period_seed(seed),
        }
    }

    fn periods(&self, piece: &Piece) -> CurvePeriods {
        let count = self.strands.period_counts.get(piece.curve).copied().unwrap_or(0);
        CurvePeriods { curve: piece.curve as u32, count, seed: self.seed }
    }

    fn shape(&self, piece: &Piece, fiber: &Fiber, period: &Period, x: f64) -> FiberShape {
        let rate = period_rate(&piece.turns, &self.flyaways);
        period_shape(fiber, period, x, rate, (&self.yarn, &self.flyaways))
    }

    /// A fiber in a given shape at t of a piece.
    pub fn fiber_point(&self, piece: &Piece, fiber: &Fiber, t: f64, shape: &FiberShape) -> FiberPoint {
        let yarn_at = yarn_point(&self.strands.bezier(piece), self.strands.knot_normals(piece), t);
        fiber_point(&yarn_at, &twist_at(&piece.turns, t), &self.yarn, fiber, shape)
    }

    /// The fiber with this index at exactly t, whatever it is there.
    pub fn fiber_at(&self, piece: &Piece, fiber_index: usize, t: f64) -> (FiberPoint, Period) {
        let fiber = &self.fibers[fiber_index];
        let u = period_turns(&piece.turns, fiber, t, &self.flyaways);
        let index = u.floor();
        let period =
            draw_period(&self.periods(piece), fiber, fiber_index as u32, index as i32, &self.flyaways);
        let shape = self.shape(piece, fiber, &period, u - index);
        (self.fiber_point(piece, fiber, t, &shape), period)
    }

    /// A vertex of the fiber drawn in `pieces` equal steps, with what joins it to its neighbours.
    pub fn fiber_vertex(
        &self,
        piece: &Piece,
        fiber_index: usize,
        t: f64,
        pieces: u32,
    ) -> (FiberPoint, StrandVertex) {
        let fiber = &self.fibers[fiber_index];
        let periods = self.periods(piece);
        let (index, beside) = (fiber_index as u32, neighbours(t, pieces));
        let vertex = strand_vertex(&piece.turns, fiber, index, t, beside, &periods, &self.flyaways);
        let shape = self.shape(piece, fiber, &vertex.period, vertex.x);
        (self.fiber_point(piece, fiber, vertex.t, &shape), vertex)
    }
}

/// The 32-bit seed of the periods' types.
pub fn period_seed(seed: u64) -> u32 {
    (crate::math::rng::mix64(seed) >> 32) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::curve::{Basis, Curve};
    use crate::yarn::period::Kind;
    use crate::yarn::presets;
    use crate::yarn::strand::strands;
    use glam::DVec3;
    use std::f64::consts::TAU;

    fn wavy_loop(points: u32) -> Curve {
        let at = |i: u32| {
            let u = TAU * f64::from(i) / f64::from(points);
            DVec3::new(
                (10.0 + (4.0 * u).cos()) * u.cos(),
                (10.0 + (4.0 * u).cos()) * u.sin(),
                (7.0 * u).sin(),
            )
        };
        Curve { points: (0..points).map(at).collect(), closed: true }
    }

    fn field(preset: &str, curve: Curve) -> FiberField {
        let yarn = presets::yarn(preset).unwrap();
        FiberField::new(strands(&[curve], Basis::CatmullRom, &yarn, 4), &yarn, 4)
    }

    #[test]
    fn every_fiber_of_a_closed_curve_meets_itself_types_and_identities_included() {
        for preset in ["worsted_3ply", "cotton1", "rayon1", "mohair"] {
            let field = field(preset, wavy_loop(60));
            let (first, last) = (field.strands.pieces[0], field.strands.pieces[59]);
            for index in 0..field.fibers.len() {
                let (begin, begin_period) = field.fiber_at(&first, index, 0.0);
                let (end, end_period) = field.fiber_at(&last, index, 1.0);
                let gap = (begin.position - end.position).length();
                assert!(gap < 1e-3 * field.yarn.ellipse_long_mm, "{preset} fiber {index}: gap {gap}");
                let identity = |p: &Period| (p.kind, p.reach, p.share, p.twist, p.root_first);
                assert_eq!(identity(&begin_period), identity(&end_period), "{preset} fiber {index}");
            }
        }
    }

    #[test]
    fn a_fiber_is_continuous_except_at_the_tips_of_hairs() {
        let field = field("cotton1", wavy_loop(60));
        let steps = 400;
        for index in 0..field.fibers.len() {
            for piece in &field.strands.pieces[..20] {
                for i in 0..steps {
                    let at = |i: u32| field.fiber_at(piece, index, f64::from(i) / f64::from(steps));
                    let ((a, a_period), (b, b_period)) = (at(i), at(i + 1));
                    let jump = (a.position - b.position).length();
                    let hair = a_period.kind == Kind::Hair || b_period.kind == Kind::Hair;
                    // A step of a 400th of a piece of about 1.2 mm, with room for steep hairs and loops.
                    assert!(hair || jump < 0.05, "fiber {index}: {a_period:?} to {b_period:?} jumps {jump}");
                }
            }
        }
    }

    #[test]
    fn flyaways_are_as_many_as_their_densities_say() {
        let curve = Curve { points: (0..401).map(|i| DVec3::X * f64::from(i)).collect(), closed: false };
        for preset in presets::yarn_names() {
            let field = field(preset, curve.clone());
            let yarn = &field.yarn;
            let (Some(pitch), length_mm) = (yarn.fiber_pitch_mm, 400.0) else { continue };
            let per_mm = yarn.migration_rate / pitch * f64::from(field.flyaways.periods_per_migration);
            let periods = (length_mm * per_mm).floor() as i32;
            let lookup = CurvePeriods { curve: 0, count: 0, seed: field.seed };
            let mut counts = [0.0; 3];
            for index in 0..field.fibers.len() as u32 {
                for k in 0..periods {
                    counts[draw_period(&lookup, &field.fibers[index as usize], index, k, &field.flyaways).kind
                        as usize] += 1.0;
                }
            }
            let covered_mm = f64::from(periods) / per_mm * f64::from(yarn.ply_count);
            let total: f64 = counts.iter().sum();
            for (kind, density) in
                [(Kind::Loop, yarn.loop_density_per_mm), (Kind::Hair, yarn.hair_density_per_mm)]
            {
                let expected = density * covered_mm;
                let p = (expected / total).min(1.0);
                // Three standard errors of a binomial count.
                let error = 3.0 * (total * p * (1.0 - p)).sqrt();
                let found = counts[kind as usize];
                assert!(
                    (found - expected).abs() <= error,
                    "{preset} {kind:?}: {found}, expected {expected} +- {error}"
                );
            }
        }
    }

    #[test]
    fn every_count_of_fibers_and_plies_is_finite() {
        for ply_count in 1..=8 {
            for fibers_per_ply in [1, 20, 64, 65, 150, 400] {
                let mut yarn = presets::yarn("cotton2").unwrap();
                yarn.ply_count = ply_count;
                yarn.fibers_per_ply = fibers_per_ply;
                let strands = strands(&[wavy_loop(11)], Basis::CatmullRom, &yarn, 4);
                let field = FiberField::new(strands, &yarn, 4);
                assert_eq!(field.fibers.len() as u32, ply_count * fibers_per_ply);
                for index in 0..field.fibers.len() {
                    let (f, _) = field.fiber_at(&field.strands.pieces[3], index, 0.37);
                    assert!(f.position.is_finite() && (f.tangent.length() - 1.0).abs() < 1e-9);
                }
            }
        }
    }
}
