//! One loop of an endless stockinette cloth, relaxed among its neighbours.
//!
//! Lengths are in yarn DIAMETERS. The loop's head is centred at x = 0, the course's mid-line is
//! y = 0, and the technical face looks along +z.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;

use super::relax::{Cloth, Image, Settings, closest, relax};

/// Distance the solver asks of the sampled centre lines. The samples of two crossing strands miss the
/// nearest points by up to a sixteenth of a segment each, so their distance reads a little long.
const ASKED: f64 = 1.002;

/// A cell counts as sound from this sampled distance on.
pub(crate) const SOUND: f64 = 1.0;

/// Nearer neighbours than this along one yarn are no contact: 2.2 diameters. By Schur's comparison
/// theorem an arc that bends no tighter than 0.55 diameters has a chord of at least one diameter for
/// every arc length from 1.26 to 2.2 diameters, so nothing is missed.
pub(crate) const ARC_SKIP: f64 = 2.2;

/// Tension against bending, per unit of the yarn's parameter (one loop = 1). Tension closes the
/// crossings; bending rounds the loop between them.
const STRETCH: f64 = 1.0;
const BENDING: f64 = 0.01;
/// High enough that tension presses contacts in by about 2 percent, which the asked distance makes up.
const PENALTY: f64 = 20_000.0;

/// A quarter of a relaxed loop, from the head's centre to the middle of the right leg.
#[derive(Clone, Debug)]
pub(crate) struct UnitCell {
    /// Control points of the quarter; `quarter_segments() + 1` of them.
    pub(crate) quarter: Vec<DVec3>,
    /// Distance between neighbouring loops of a course.
    pub(crate) wale_spacing: f64,
    /// Distance between neighbouring courses.
    pub(crate) course_spacing: f64,
    /// Smallest sampled distance between strands; 1 where they just touch.
    pub(crate) clearance: f64,
}

impl UnitCell {
    /// Segments in a quarter of a loop.
    pub(crate) fn quarter_segments(&self) -> usize {
        self.quarter.len() - 1
    }

    /// Control point `index` of `course`; index 0 is the head of wale 0, four quarters make a loop.
    pub(crate) fn image(&self, course: i64, index: i64) -> Image {
        let mut image = loop_image(self.quarter_segments(), self.wale_spacing, index);
        image.shift.y += course as f64 * self.course_spacing;
        image
    }

    /// The control point itself.
    pub(crate) fn point(&self, course: i64, index: i64) -> DVec3 {
        self.image(course, index).at(&self.quarter)
    }

    /// Length of yarn in one loop, by chords.
    pub(crate) fn loop_length(&self) -> f64 {
        4.0 * self.quarter.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>()
    }

    /// Whether no two strands enter each other.
    pub(crate) fn is_sound(&self) -> bool {
        self.clearance >= SOUND
    }
}

/// How control point `index` of a course is made of the quarter's points: the loop is its own mirror
/// image about its wale, and its lower half is its upper half turned by half a turn about the leg's
/// middle (needle loop and sinker loop of plain fabric are alike; Peirce 1947).
fn loop_image(quarter_segments: usize, wale_spacing: f64, index: i64) -> Image {
    let q = quarter_segments as i64;
    let wale = (index + 2 * q).div_euclid(4 * q);
    let within = index - wale * 4 * q;
    let side = if within < 0 { -1.0 } else { 1.0 };
    let centre = wale as f64 * wale_spacing;
    if within.abs() <= q {
        let sign = DVec3::new(side, 1.0, 1.0);
        return Image { base: within.unsigned_abs() as usize, sign, shift: DVec3::X * centre };
    }
    let shift = DVec3::X * (centre + side * 0.5 * wale_spacing);
    let sign = DVec3::new(-side, -1.0, 1.0);
    Image { base: (2 * q - within.abs()) as usize, sign, shift }
}

/// The closed form the relaxation starts from: x = t + a sin 2t, y = h cos t, z = -d cos 2t
/// (K. Crane, "A Simple Parametric Model of Plain-Knit Yarns"), with legs to the front.
fn first_guess(wale_spacing: f64, course_spacing: f64, quarter_segments: usize) -> Vec<DVec3> {
    let half_height = 0.8 * course_spacing.max(1.5);
    (0..=quarter_segments)
        .map(|i| {
            let t = i as f64 / quarter_segments as f64 * FRAC_PI_2;
            let x = (t + 1.3 * (2.0 * t).sin()) * wale_spacing / TAU;
            DVec3::new(x, half_height * t.cos(), -0.8 * (2.0 * t).cos())
        })
        .collect()
}

/// The settings for strands of `points_per_loop` control points a loop.
fn settings(points_per_loop: usize) -> Settings {
    let step = 1.0 / points_per_loop as f64;
    Settings {
        contact: ASKED,
        stretch: STRETCH / step,
        bending: BENDING / step.powi(3),
        penalty: PENALTY * step,
        arc_skip: ARC_SKIP,
        steps: 100,
    }
}

/// Relaxes `cloth`, asking for a little more distance each round until contacts rest at one diameter.
/// Returns the smallest sampled distance.
fn relax_to_contact(cloth: &mut Cloth, mut settings: Settings) -> f64 {
    let mut clearance = 0.0;
    for _ in 0..5 {
        relax(cloth, &settings);
        clearance = closest(cloth, 2.0, ARC_SKIP);
        if (clearance / ASKED - 1.0).abs() < 5e-4 {
            break;
        }
        settings.contact *= (ASKED / clearance.max(0.5)).clamp(0.95, 1.05);
    }
    clearance
}

/// The relaxed loop for spacings in yarn diameters and `quarter_segments` segments a quarter. The
/// result may be unsound: see [`UnitCell::is_sound`].
pub(crate) fn unit_cell(wale_spacing: f64, course_spacing: f64, quarter_segments: usize) -> UnitCell {
    let quarter = first_guess(wale_spacing, course_spacing, quarter_segments);
    let mut cell = UnitCell { quarter, wale_spacing, course_spacing, clearance: 0.0 };
    let q = quarter_segments as i64;
    // By symmetry the head's centre stays on its wale and the leg's middle on its quarter line.
    let mut free = vec![[true; 3]; quarter_segments + 1];
    free[0] = [false, true, true];
    free[quarter_segments] = [false, false, true];
    // A wale and a half to each side, three courses up and down: all that can touch the quarter.
    let strand = |course| (-6 * q - 1..=6 * q + 1).map(|i| cell.image(course, i)).collect::<Vec<_>>();
    let strands = [0, -3, -2, -1, 1, 2, 3].map(strand).to_vec();
    let head = 6 * quarter_segments + 1;
    let mut cloth =
        Cloth { base: cell.quarter.clone(), free, strands, active: head..head + quarter_segments };
    cell.clearance = relax_to_contact(&mut cloth, settings(4 * quarter_segments));
    cell.quarter = cloth.base;
    cell
}
