//! Where a piece of yarn turns much within little of itself, and where its fibers are cut then: at a hairpin what stands
//! out swings around half a circle in a hundredth of a piece. Twin of `glsl/yarn/turning.glsl`.

use super::level::turning_angle;
use super::strand::{Piece, Strands};
use crate::math::angle::angle_of;
use crate::math::curve::bezier_point;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::PI;

/// The two places of a piece at which it turns fastest. A cubic in a plane turns by atan((t - place) / width), of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning {
    /// Where, as t; may lie outside of the piece.
    pub places: DVec2,
    /// Over how much of t.
    pub widths: DVec2,
    /// 0 where the piece turns evenly enough to be cut evenly, 1 where cuts must follow its turns.
    pub swift: f64,
}

/// How a fiber is cut over a piece of yarn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// Straight pieces.
    pub pieces: u32,
    /// Share of the cuts that goes to turns.
    pub share: f64,
}

/// Radians per piece from which on cuts follow turns, and from which on wholly: a quarter turn in an eighth and in a
/// sixteenth of the piece. Cloth as it is knitted stays below.
const SWIFT_TURN: f64 = 4.0 * PI;
const SWIFTEST_TURN: f64 = 8.0 * PI;
/// Most of the cuts that turns get.
const MOST_TURNED: f64 = 0.75;
/// Width of a turn that is none, and the least one: at a cusp it would be 0.
const WIDEST_TURN: f64 = 1e3;
const NARROWEST_TURN: f64 = 1e-4;
/// Steps toward the place where the piece is slowest; each squares what is missing where that is a sharp turn.
const SPOT_STEPS: u32 = 6;
/// Halvings of a piece after which a cut is found.
const BREAK_STEPS: u32 = 24;
/// Cuts that a table holds, between which others lie evenly.
pub const TABLED_BREAKS: usize = 16;

/// Place and width of the turn that is found from t: where the curve's derivative, taken as linear, is least.
pub fn turn_spot(b: &[DVec3; 4], mut t: f64) -> DVec2 {
    let (mut q, mut a, mut along) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for _ in 0..=SPOT_STEPS {
        t = (t - along).clamp(0.0, 1.0);
        let c = bezier_point(b, t);
        (q, a) = (c.derivative, c.second_derivative);
        if a.length_squared() * WIDEST_TURN * WIDEST_TURN <= q.length_squared() {
            return DVec2::new(t, WIDEST_TURN);
        }
        along = q.dot(a) / a.length_squared();
    }
    let width = q.cross(a).length() / a.length_squared();
    DVec2::new(t - along, width.clamp(NARROWEST_TURN, WIDEST_TURN))
}

/// How the Bezier piece `b` turns.
pub fn turning_of(b: &[DVec3; 4]) -> Turning {
    let (first, second) = (turn_spot(b, 0.0), turn_spot(b, 1.0));
    let (places, widths) = (DVec2::new(first.x, second.x), DVec2::new(first.y, second.y));
    let beyond = (-places).max(places - 1.0).max(DVec2::ZERO);
    let rates = widths / (widths * widths + beyond * beyond);
    let swift = ((rates.max_element() - SWIFT_TURN) / (SWIFTEST_TURN - SWIFT_TURN)).clamp(0.0, 1.0);
    Turning { places, widths, swift: swift * swift * (3.0 - 2.0 * swift) }
}

/// Whether any piece of these yarns turns so fast that cuts must follow.
pub fn turns_swiftly(strands: &Strands) -> bool {
    // Written so that what is no number counts.
    let even = |piece: &Piece| turning_of(&strands.bezier(piece)).swift <= 0.0;
    strands.pieces.par_iter().any(|piece| !even(piece))
}

/// Angle in radians that the piece has turned by at t, but for a constant.
pub fn turned_angle(turning: &Turning, t: f64) -> f64 {
    let from = t - turning.places;
    angle_of(from.x, turning.widths.x) + angle_of(from.y, turning.widths.y)
}

/// Share of the cuts that lies before t, where `turned_share` of them goes to turns.
pub fn share_before(turning: &Turning, turned_share: f64, t: f64) -> f64 {
    let start = turned_angle(turning, 0.0);
    let whole = turned_angle(turning, 1.0) - start;
    let turned = (turned_angle(turning, t) - start) / whole.max(1e-6);
    t + (turned - t) * turned_share
}

/// Where the cut lies before which a share of all of them does.
pub fn break_at(turning: &Turning, turned_share: f64, share: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..BREAK_STEPS {
        let middle = 0.5 * (low + high);
        if share_before(turning, turned_share, middle) > share { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// The same from a table of those of 1, 2, ... of [`TABLED_BREAKS`] equal shares. Exactly 0 and 1 at the ends.
pub fn tabled_break(breaks: &[f64; TABLED_BREAKS], share: f64) -> f64 {
    let place = share.clamp(0.0, 1.0) * TABLED_BREAKS as f64;
    let next = (place as usize).min(TABLED_BREAKS - 1);
    let low = if next == 0 { 0.0 } else { breaks[next - 1] };
    low + (breaks[next] - low) * (place - next as f64)
}

/// What decides how an uneven piece is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnevenCutting {
    /// Pieces that would do if it turned evenly.
    pub even: u32,
    /// And if it did not turn.
    pub calm: u32,
    /// How far out the farthest fiber swings around its turns.
    pub reach_mm: f64,
    /// Largest departure of a chord from the curve.
    pub tolerance_mm: f64,
    /// Most pieces.
    pub largest: u32,
}

/// How a fiber is cut over the Bezier piece `b`: enough in its turns for what swings around them to depart by no more
/// than the tolerance, and as many as they would be in between.
pub fn uneven_cut(turning: &Turning, b: &[DVec3; 4], cutting: &UnevenCutting) -> Cut {
    if turning.swift <= 0.0 {
        return Cut { pieces: cutting.even, share: 0.0 };
    }
    let legs = [b[1] - b[0], b[2] - b[1], b[3] - b[2]];
    let bend = turning_angle(legs[0], legs[1]) + turning_angle(legs[1], legs[2]);
    let turned = (bend * (cutting.reach_mm / (8.0 * cutting.tolerance_mm.max(1e-12))).sqrt()).max(1e-3);
    let (even, calm) = (f64::from(cutting.even), f64::from(cutting.calm));
    let share = (turned / (turned + calm)).min(MOST_TURNED);
    let pieces = even + ((turned / share).max(calm / (1.0 - share)) - even) * turning.swift;
    let pieces = pieces.ceil().clamp(1.0, f64::from(cutting.largest)) as u32;
    Cut { pieces, share: turning.swift * share }
}

#[cfg(test)]
#[path = "turning_tests.rs"]
mod tests;
