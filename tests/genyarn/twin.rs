//! Fibers by the twin: a straight strand along Z.

use glam::DVec3;
use worsted::math::curve::{Basis, Curve};
use worsted::yarn::fiber::{fiber_point, twist_at, yarn_point};
use worsted::yarn::params::YarnParams;
use worsted::yarn::period::migration_shape;
use worsted::yarn::strand::{Strands, strands};
use worsted::yarn::table::Fiber;

/// The strand reaches this far to both sides of z = 0, with a control point every mm.
const REACH_MM: i32 = 16;

/// How a fiber's migration phase is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reading {
    /// m_i is each fiber's own.
    FreePhase,
    /// Wu & Yuksel 2019, Eq. 2 as printed: the fiber's angle stands in its place.
    AngleAsPhase,
}

/// What is fitted to one fiber: R_i, theta_i, m_i, and the angle of ply 0 at z = 0.
pub type Unknowns = [f64; 4];

/// A straight yarn whose turns are all zero at z = 0.
pub struct StraightTwin {
    yarn: YarnParams,
    strands: Strands,
    reading: Reading,
}

impl StraightTwin {
    pub fn new(yarn: &YarnParams, reading: Reading) -> Self {
        let points = (-REACH_MM..=REACH_MM).map(|z| DVec3::Z * f64::from(z)).collect();
        let mut strands = strands(&[Curve { points, closed: false }], Basis::CatmullRom, yarn, 0);
        // On a straight line any constant normal is rotation-minimising; this one puts ply 0 toward +X.
        strands.normals.fill(DVec3::X);
        let middle = strands.pieces[REACH_MM as usize].turns;
        for piece in &mut strands.pieces {
            piece.turns.ply.start -= middle.ply.start;
            piece.turns.fiber.start -= middle.fiber.start;
            piece.turns.migration.start -= middle.migration.start;
        }
        Self { yarn: yarn.clone(), strands, reading }
    }

    /// Where the twin puts the fiber with these unknowns at `z`, |z| < 16 mm.
    pub fn position(&self, ply: u32, unknowns: &Unknowns, z: f64) -> DVec3 {
        let [radius, angle, own_phase, ply_start] = *unknowns;
        let along = z + f64::from(REACH_MM);
        let index = (along as usize).min(self.strands.pieces.len() - 1);
        let (piece, t) = (&self.strands.pieces[index], along - index as f64);
        let yarn_at = yarn_point(&self.strands.bezier(piece), self.strands.knot_normals(piece), t);
        let mut twist = twist_at(&piece.turns, t);
        twist.ply += ply_start;
        let migration_phase = if self.reading == Reading::FreePhase { own_phase } else { angle };
        let fiber = Fiber { radius, angle, migration_phase, ply };
        let shape = migration_shape(&fiber, twist.migration, twist.migration_rate, &self.yarn);
        fiber_point(&yarn_at, &twist, &self.yarn, &fiber, &shape).position
    }

    /// What one period of R and one turn of a fiber take at `z`, in radians: the phases without a fiber's own.
    pub fn phases(&self, z: f64) -> [f64; 2] {
        let turns = self.yarn.fiber_turns_per_mm() * z;
        [turns, self.yarn.migration_rate * turns].map(|turns| std::f64::consts::TAU * turns)
    }
}
