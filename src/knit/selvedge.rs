//! The turn at the cloth's edge, where the yarn leaves one course and comes back as the next.

use std::f64::consts::PI;

use glam::DVec3;

use super::relax::{Cloth, Image, closest};
use super::unit_cell::{ARC_SKIP, SOUND, UnitCell};

/// A turn at the right edge, from course 0 up to course 1.
#[derive(Clone, Debug)]
pub(crate) struct Turn {
    /// Control points between the last of course 0 and the first of course 1 (both half a wale right
    /// of the last wale's centre), in yarn diameters, x from that centre.
    pub(crate) points: Vec<DVec3>,
    /// Smallest sampled distance from any other strand, in yarn diameters.
    pub(crate) clearance: f64,
}

impl Turn {
    /// Whether it enters no other strand.
    pub(crate) fn is_sound(&self) -> bool {
        self.clearance >= SOUND
    }
}

/// A half circle of `points` control points, level with the sinker loops that it continues: slack
/// yarn, as selvedges are knit, that stays behind and beside the last wale. Measured against the last
/// wales of its courses and of those above and below, with their own turns.
pub(crate) fn turn(cell: &UnitCell, points: usize) -> Turn {
    let quarter = cell.quarter_segments();
    let edge = 2 * quarter as i64;
    let radius = 0.5 * cell.course_spacing;
    let pieces = points + 1;
    let start = cell.point(0, edge);
    let mut base = cell.quarter.clone();
    let first = base.len();
    base.extend((1..pieces).map(|k| {
        let angle = PI * k as f64 / pieces as f64;
        start + radius * DVec3::new(angle.sin(), 1.0 - angle.cos(), 0.0)
    }));

    let inner_end = -6 * quarter as i64;
    let mut own: Vec<Image> = (inner_end..=edge).map(|i| cell.image(0, i)).collect();
    let active = own.len() - 1..own.len() - 1 + pieces;
    own.extend((first..base.len()).map(|base| Image { base, sign: DVec3::ONE, shift: DVec3::ZERO }));
    own.extend((inner_end..=edge).rev().map(|i| cell.image(1, i)));
    // Turns of one edge repeat every two courses.
    let repeat = DVec3::Y * 2.0 * cell.course_spacing;
    let copy = |by: DVec3| own.iter().map(|i| Image { shift: i.shift + by, ..*i }).collect::<Vec<_>>();
    let strands = vec![copy(DVec3::ZERO), copy(-repeat), copy(repeat)];
    let free = vec![[false; 3]; base.len()];
    let mut cloth = Cloth { base, free, strands, active };
    let clearance = closest(&cloth, 2.0, ARC_SKIP);
    Turn { points: cloth.base.split_off(first), clearance }
}
