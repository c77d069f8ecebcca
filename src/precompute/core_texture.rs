//! The texture of a core fiber: what is seen of the fibers that it stands for (Wu & Yuksel 2019, Sec. 3.2 and
//! Fig. 5).

use super::core_bake::{COLUMNS_PER_ROW, Grid, PlySurface};
use crate::math::strip::strip_normals;
use crate::yarn::detail::{CORE_LEVELS, ranks_at_level};
use crate::yarn::params::YarnParams;
use crate::yarn::table::Fiber;
use rayon::prelude::*;
use std::ops::{Add, Mul};

/// What is seen at one texel, averaged over all of it, bare parts counting as 0: so that averages of texels are
/// right, whatever their coverage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// sin phi, cos phi, sin 2 phi, cos 2 phi of the normal's azimuth about its fiber; 0 faces the viewer, pi/2
    /// points up the rows. (The 2D normal of the paper is the first two.)
    pub normals: [f64; 4],
    /// Coverage; height above the ply's centre as a share of the round's at the same place across; what migration
    /// adds to how fast the fiber moves up the rows and toward the viewer per radian of turn, as shares of the
    /// ellipse. (The last two are the paper's 3D direction, for any twist.)
    pub shape: [f64; 4],
    /// Squares of the last two, their product, and the square of the height.
    pub spread: [f64; 4],
}

impl Moments {
    /// A round fiber at `across` in [-1, 1] of its strip.
    pub fn round(across: f64) -> Self {
        let normals = strip_normals(across).to_array();
        Self { normals, shape: [1.0, 0.0, 0.0, 0.0], spread: [0.0; 4] }
    }
}

impl Add for Moments {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let sum = |a: [f64; 4], b: [f64; 4]| std::array::from_fn(|i| a[i] + b[i]);
        Self {
            normals: sum(self.normals, other.normals),
            shape: sum(self.shape, other.shape),
            spread: sum(self.spread, other.spread),
        }
    }
}

impl Mul<f64> for Moments {
    type Output = Self;
    fn mul(self, by: f64) -> Self {
        let scaled = |a: [f64; 4]| a.map(|v| v * by);
        Self { normals: scaled(self.normals), shape: scaled(self.shape), spread: scaled(self.spread) }
    }
}

/// One mip level of every layer.
#[derive(Clone, Debug)]
pub struct CoreMip {
    /// Texels along the core.
    pub columns: u32,
    /// Texels across it.
    pub rows: u32,
    /// Layer by layer, row by row.
    pub texels: Vec<Moments>,
}

/// Rows of the coarsest level of the core's texture.
const FEWEST_ROWS: u32 = 8;

/// The baked texture. Layer `ply * CORE_LEVELS + level` is the surface of the fibers of a ply that are not drawn
/// one by one at a level.
#[derive(Clone, Debug)]
pub struct CoreTexture {
    /// Array layers.
    pub layers: u32,
    /// From whole size down to one texel.
    pub mips: Vec<CoreMip>,
    /// Distance from the ply's centre that the rows span to both sides, as a share of the ellipse.
    pub extent: f64,
    /// Of each level: the farthest fiber's outer edge, likewise; 0 where the core stands for none.
    pub thickness: [f64; CORE_LEVELS as usize],
    /// Fibers of each ply that are drawn one by one at full detail.
    pub ranks: u32,
    /// Mean height of the whole ply's surface over that of a circle as thick.
    pub height_share: f64,
    /// Of two heights that stand for all at a place, the upper one above their mean, as a share of the heights'
    /// deviation: 1 where they are not skewed, less where a few lie far below the rest.
    pub height_above: f64,
}

/// Bakes the texture of a yarn. `fibers` is its table, `rows` a power of two, and the innermost fibers that
/// together make up at most `visible_share` of what is seen of their ply are never drawn one by one.
pub fn bake_core(yarn: &YarnParams, fibers: &[Fiber], rows: u32, visible_share: f64) -> CoreTexture {
    let most = |fibers: &[Fiber]| fibers.iter().map(|f| f.radius * yarn.migration_max).fold(0.0, f64::max);
    let grid = Grid::new(yarn, rows, most(fibers));
    let of_ply = |ply: u32| fibers.iter().filter(|f| f.ply == ply).copied().collect::<Vec<_>>();
    let plies: Vec<Vec<Fiber>> = (0..yarn.ply_count).map(of_ply).collect();

    let whole = |fibers: &Vec<Fiber>| {
        let mut surface = PlySurface::new(grid, yarn, fibers);
        (0..fibers.len()).for_each(|rank| surface.add(rank));
        (surface.visible_shares(), surface.height_share(grid.extent), surface.height_above())
    };
    let seen: Vec<(Vec<f64>, f64, f64)> = plies.par_iter().map(whole).collect();
    let ranks = seen.iter().map(|(shares, ..)| ranks_drawn(shares, visible_share)).max().unwrap_or(0);
    let height_share = seen.iter().map(|(_, height, _)| height).sum::<f64>() / f64::from(yarn.ply_count);
    let height_above = seen.iter().map(|(.., above)| above).sum::<f64>() / f64::from(yarn.ply_count);

    let layers: Vec<Vec<Moments>> =
        plies.par_iter().flat_map_iter(|fibers| ply_levels(grid, yarn, fibers, ranks)).collect();
    let thickness = std::array::from_fn(|level| {
        let first = first_rank(level as u32, ranks);
        let inner = plies.iter().map(|fibers| most(&fibers[first.min(fibers.len())..])).fold(0.0, f64::max);
        if inner > 0.0 { inner + grid.fiber_radius } else { 0.0 }
    });
    let base = CoreMip { columns: grid.columns as u32, rows, texels: layers.concat() };
    CoreTexture {
        layers: layers.len() as u32,
        mips: mip_chain(base, layers.len()),
        extent: grid.extent,
        thickness,
        ranks,
        height_share,
        height_above,
    }
}

/// Fewest ranks, from the outermost, such that the others make up at most `visible_share`.
fn ranks_drawn(shares: &[f64], visible_share: f64) -> u32 {
    let mut hidden = 0.0;
    let inner = shares.iter().rev().take_while(|share| {
        hidden += **share;
        hidden <= visible_share
    });
    (shares.len() - inner.count()) as u32
}

/// The outermost rank that the core stands for at a level.
fn first_rank(level: u32, ranks: u32) -> usize {
    ranks_at_level(level, f64::from(ranks)).round() as usize
}

/// The levels of one ply: each stands for more of its fibers than the one before, so they are drawn from the
/// inside out and read off on the way.
fn ply_levels(grid: Grid, yarn: &YarnParams, fibers: &[Fiber], ranks: u32) -> Vec<Vec<Moments>> {
    let mut surface = PlySurface::new(grid, yarn, fibers);
    let mut end = fibers.len();
    let level = |level: u32| {
        let first = first_rank(level, ranks).min(end);
        (first..end).for_each(|rank| surface.add(rank));
        end = first;
        surface.texels()
    };
    (0..CORE_LEVELS).map(level).collect()
}

/// Halves both sides until as few rows are left as tell a ply's edges from its middle: from far away, a picture's
/// samples see single places across it.
fn mip_chain(base: CoreMip, layers: usize) -> Vec<CoreMip> {
    let mut mips = vec![base];
    while let Some(last) = mips.last().filter(|mip| mip.rows > FEWEST_ROWS) {
        let mip = halved(last, layers);
        mips.push(mip);
    }
    mips
}

/// Texels of all mips and layers of a core texture of so many rows, for a yarn of so many plies.
pub fn core_texels(rows: u32, plies: u32) -> u64 {
    let layers = u64::from(plies * CORE_LEVELS);
    let [mut columns, mut rows] = [COLUMNS_PER_ROW * rows, rows].map(u64::from);
    let mut texels = columns * rows;
    while rows > u64::from(FEWEST_ROWS) {
        [columns, rows] = [columns, rows].map(|side| (side / 2).max(1));
        texels += columns * rows;
    }
    layers * texels
}

fn halved(mip: &CoreMip, layers: usize) -> CoreMip {
    let (columns, rows) = ((mip.columns / 2).max(1), (mip.rows / 2).max(1));
    let (along, across) = (mip.columns / columns, mip.rows / rows);
    let mut texels = Vec::with_capacity(layers * (columns * rows) as usize);
    for layer in mip.texels.chunks_exact((mip.columns * mip.rows) as usize) {
        for place in 0..columns * rows {
            let (column, row) = (place % columns * along, place / columns * across);
            let parts = (0..along * across)
                .map(|k| layer[((row + k / along) * mip.columns + column + k % along) as usize]);
            texels.push(parts.fold(Moments::default(), Add::add) * (1.0 / f64::from(along * across)));
        }
    }
    CoreMip { columns, rows, texels }
}

#[cfg(test)]
#[path = "core_texture_tests.rs"]
mod tests;
