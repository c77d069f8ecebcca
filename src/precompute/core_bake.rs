//! Draws the fibers that a core fiber stands for, through one turn, as their viewer sees them.

use super::core_texture::Moments;
use crate::yarn::migration::migration_radius;
use crate::yarn::params::YarnParams;
use crate::yarn::table::Fiber;
use std::f64::consts::TAU;

/// Samples of a texel along and across the core.
const SAMPLES: [usize; 2] = [2, 4];
/// Steepest fiber, mm across per mm along, whose strip is still widened to its true width.
const STEEPEST: f64 = 4.0;

/// The texture's grid and the measures that all plies share.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// Texels along the core, over one turn.
    pub columns: usize,
    /// Texels across.
    pub rows: usize,
    /// Distance from the ply's centre that the rows span, as a share of the ellipse.
    pub extent: f64,
    /// Half of a fiber's width, likewise.
    pub fiber_radius: f64,
    /// How far in mm the ply's surface moves across for each mm along, at R = 1.
    pub slope_per_radian: f64,
}

/// Texels along a turn of the core, for each across it.
pub const COLUMNS_PER_ROW: u32 = 4;

impl Grid {
    /// The grid for a yarn whose fibers reach no farther than `most_radius`.
    pub fn new(yarn: &YarnParams, rows: u32, most_radius: f64) -> Self {
        let fiber_radius = yarn.fiber_radius_mm() / yarn.round_ply_radius_mm();
        let turns_per_mm = yarn.ply_turns_per_mm() + yarn.fiber_turns_per_mm();
        Self {
            columns: (COLUMNS_PER_ROW * rows) as usize,
            rows: rows as usize,
            extent: (most_radius + fiber_radius).max(1e-6),
            fiber_radius,
            slope_per_radian: TAU * turns_per_mm * yarn.round_ply_radius_mm(),
        }
    }
}

/// A fiber at one place of the turn: across and height in shares of the ellipse, and their slopes per radian.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    across: f64,
    height: f64,
    across_slope: f64,
    height_slope: f64,
}

/// s = 1: the radius goes through its period in one turn, so that the texture tiles.
fn seen(fiber: &Fiber, yarn: &YarnParams, turn: f64) -> Seen {
    let phase = TAU * turn;
    let (radius, slope) =
        migration_radius(fiber.radius, fiber.migration_phase + phase, yarn.migration_min, yarn.migration_max);
    let (sin, cos) = (fiber.angle + phase).sin_cos();
    Seen {
        across: radius * cos,
        height: radius * sin,
        across_slope: slope * cos - radius * sin,
        height_slope: slope * sin + radius * cos,
    }
}

/// What one sample shows: the nearest fiber and where across its strip.
#[derive(Clone, Copy, Debug)]
struct Sample {
    height: f64,
    rank: u32,
    across: f32,
}

const NOTHING: Sample = Sample { height: f64::NEG_INFINITY, rank: u32::MAX, across: 0.0 };

/// The surface of one ply, to which fibers are added one by one.
pub struct PlySurface<'a> {
    grid: Grid,
    yarn: &'a YarnParams,
    fibers: &'a [Fiber],
    samples: Vec<Sample>,
}

impl<'a> PlySurface<'a> {
    /// An empty surface for the fibers of one ply, the outermost first.
    pub fn new(grid: Grid, yarn: &'a YarnParams, fibers: &'a [Fiber]) -> Self {
        let samples = vec![NOTHING; grid.columns * SAMPLES[0] * grid.rows * SAMPLES[1]];
        Self { grid, yarn, fibers, samples }
    }

    /// Adds a fiber as the strip that faces the viewer, at the depth of its centre, as single fibers are
    /// drawn.
    pub fn add(&mut self, rank: usize) {
        let columns = self.grid.columns * SAMPLES[0];
        let rows = self.grid.rows * SAMPLES[1];
        let row_size = 2.0 * self.grid.extent / rows as f64;
        for column in 0..columns {
            let at = seen(&self.fibers[rank], self.yarn, (column as f64 + 0.5) / columns as f64);
            let slope = (at.across_slope * self.grid.slope_per_radian).clamp(-STEEPEST, STEEPEST);
            let half = self.grid.fiber_radius * slope.hypot(1.0);
            let place = |v: f64| ((v + self.grid.extent) / row_size - 0.5).clamp(-1.0, rows as f64);
            let (low, high) = (place(at.across - half).ceil(), place(at.across + half).floor());
            for row in low.max(0.0) as usize..(high + 1.0).clamp(0.0, rows as f64) as usize {
                let sample = &mut self.samples[column * rows + row];
                if at.height > sample.height {
                    let v = (row as f64 + 0.5) * row_size - self.grid.extent;
                    let across = ((v - at.across) / half).clamp(-1.0, 1.0) as f32;
                    *sample = Sample { height: at.height, rank: rank as u32, across };
                }
            }
        }
    }

    /// Share of what is seen of the ply that is each rank's.
    pub fn visible_shares(&self) -> Vec<f64> {
        let mut shares = vec![0.0; self.fibers.len()];
        let mut total = 0.0;
        for sample in self.samples.iter().filter(|sample| sample.rank != u32::MAX) {
            shares[sample.rank as usize] += 1.0;
            total += 1.0;
        }
        shares.iter_mut().for_each(|share| *share /= f64::max(total, 1.0));
        shares
    }

    /// Mean height of what is seen over that of a circle of radius `thickness`.
    pub fn height_share(&self, thickness: f64) -> f64 {
        let rows = self.grid.rows * SAMPLES[1];
        let (mut found, mut round) = (0.0, 0.0);
        for (index, sample) in self.samples.iter().enumerate().filter(|(_, s)| s.rank != u32::MAX) {
            let v = ((index % rows) as f64 + 0.5) * 2.0 * self.grid.extent / rows as f64 - self.grid.extent;
            found += sample.height;
            round += (thickness * thickness - v * v).max(0.0).sqrt();
        }
        if round > 0.0 { (found / round).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Of two heights that stand for all that is seen at one place across, weighted so that mean, deviation and
    /// skewness are theirs: how far the upper one lies above the mean, as a share of the deviation (the two-point
    /// Gauss rule). Heights are shares of the round's, their deviation and skewness means over places.
    pub fn height_above(&self) -> f64 {
        let mut rows = vec![Vec::new(); self.grid.rows * SAMPLES[1]];
        self.for_each_shown(|[_, row], sample, fiber| {
            rows[row].push(height_share(sample, fiber, self.grid.extent));
        });
        let (mut squares, mut cubes, mut count) = (0.0, 0.0, 0.0);
        for heights in rows.iter().filter(|heights| !heights.is_empty()) {
            let mean = heights.iter().sum::<f64>() / heights.len() as f64;
            squares += heights.iter().map(|h| (h - mean).powi(2)).sum::<f64>();
            cubes += heights.iter().map(|h| (h - mean).powi(3)).sum::<f64>();
            count += heights.len() as f64;
        }
        let deviation = (squares / f64::max(count, 1.0)).sqrt();
        // Nothing seen, or all of it as high.
        if deviation < 1e-9 {
            return 1.0;
        }
        let skewness = cubes / count / deviation.powi(3);
        0.5 * (skewness.hypot(2.0) + skewness)
    }

    /// Calls back for each sample that shows a fiber: its column, row, and the fiber at its place of the turn.
    fn for_each_shown(&self, mut call: impl FnMut([usize; 2], &Sample, &Seen)) {
        let rows = self.grid.rows * SAMPLES[1];
        let columns = (self.grid.columns * SAMPLES[0]) as f64;
        for (column, samples) in self.samples.chunks_exact(rows).enumerate() {
            let turn = (column as f64 + 0.5) / columns;
            let fibers: Vec<Seen> = self.fibers.iter().map(|fiber| seen(fiber, self.yarn, turn)).collect();
            for (row, sample) in samples.iter().enumerate().filter(|(_, s)| s.rank != u32::MAX) {
                call([column, row], sample, &fibers[sample.rank as usize]);
            }
        }
    }

    /// The texels, row by row.
    pub fn texels(&self) -> Vec<Moments> {
        let [along, across] = SAMPLES;
        let mut texels = vec![Moments::default(); self.grid.columns * self.grid.rows];
        self.for_each_shown(|[column, row], sample, fiber| {
            let texel = &mut texels[row / across * self.grid.columns + column / along];
            *texel = *texel + moments(sample, fiber, self.grid.extent);
        });
        texels.into_iter().map(|texel| texel * (1.0 / (along * across) as f64)).collect()
    }
}

/// Height of what a sample shows as a share of the ply's round above the fiber's place across, -1 to 1.
fn height_share(sample: &Sample, fiber: &Seen, extent: f64) -> f64 {
    let round = (extent * extent - fiber.across * fiber.across).max(0.0).sqrt();
    if round > 0.0 { (sample.height / round).clamp(-1.0, 1.0) } else { 0.0 }
}

/// What hardly depends on the place across, so that a texel of a coarse level, which spans the whole ply, says at
/// each place what is seen there: the height as a share of the round's, -1 to 1, and of the slopes what migration
/// adds to those of a circle, which are the height's opposite and the place across.
fn moments(sample: &Sample, fiber: &Seen, extent: f64) -> Moments {
    let height = height_share(sample, fiber, extent);
    let [s, d] = [fiber.across_slope + fiber.height, fiber.height_slope - fiber.across];
    let mut one = Moments::round(f64::from(sample.across));
    one.shape = [1.0, height, s, d];
    one.spread = [s * s, d * d, s * d, height * height];
    one
}
