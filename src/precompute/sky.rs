//! How much of the sky other yarns leave open: what Wu & Yuksel 2019, Sec. 4.2 leaves out, whose occlusion is that of
//! a yarn by itself. Reading it is the twin of `glsl/shading/sky.glsl`.

use crate::math::curve::{Basis, bezier_point};
use crate::yarn::strand::Strands;
use glam::{DVec3, DVec4, Vec4Swizzles};
use half::f16;
use obvhs::aabb::Aabb;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use obvhs::ray::Ray as BoxRay;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Directions that are looked along from each place.
const DIRECTIONS: u32 = 32;
/// Along the yarn to either side, in its outer radii: its own tube, which other tables are about.
const OWN: f64 = 4.0;
/// How closely yarns are looked at.
#[derive(Clone, Copy, Debug)]
struct Detail {
    /// Most between two places along the yarn that are looked from, in its outer radii.
    apart: f64,
    /// Length in outer radii above which two straight parts stand for a piece of yarn; up to it, one.
    part: f64,
}

/// As closely as so few directions are worth: of a generated tube of 64 points a loop the root mean square error is 0.067,
/// 0.076 from every point, and 0.088 with places twice as far apart.
const DETAIL: Detail = Detail { apart: 2.0, part: 2.0 };
/// Share of the search tree that is put in better order: little more makes looks faster.
const REINSERTED: f32 = 0.05;
/// Levels that the search tree's stack has room for, fewer by one for safety.
const DEEPEST: usize = 31;
/// What boxes are wider by, as a share of the scene's size: they are tested in f32.
const MARGIN: f64 = 1e-6;

/// An open sky: 1 in every direction.
pub const OPEN_SKY: DVec4 = DVec4::X;

/// Yarns as the sky sees them.
#[derive(Clone, Copy, Debug)]
pub struct SkyYarns<'a> {
    /// Their centre lines.
    pub strands: &'a Strands,
    /// Radius in mm of the opaque tube that hides as much as one of them: [`super::shadow_radius::shadow_radius_mm`].
    pub hiding_radius_mm: f64,
    /// Radius in mm of the circle around their plies.
    pub outer_radius_mm: f64,
}

/// Share of the sky that is open toward a unit direction or, of a mean of directions, around it; in [0, 1]. `sky` is
/// a constant and a slope by direction.
pub fn sky_toward(sky: DVec4, direction: DVec3) -> f64 {
    (sky.x + sky.yzw().dot(direction)).clamp(0.0, 1.0)
}

/// Mean of the directions from which a fiber gathers light that it reflects: R's azimuthal lobe, cos(phi / 2) about the
/// unit vector `toward` the viewer across the fiber, has a third of it; its yarn leaves a fiber at the rim, at
/// `outward` = 1, the half toward there, and with that two thirds. `outward` is the place in the cross-section, from
/// the yarn's centre, as a share of the outer radius.
pub fn sky_gathered(toward: DVec3, outward: DVec3) -> DVec3 {
    (toward + outward) / 3.0
}

/// For every control point of every fabric what is open above it, fitted by least squares to what is visible along
/// rays from the centre line: constant, and slope by direction in world space. Of tubes so many in one
/// place that no search tree holds them nothing is hidden.
pub fn bake_skies(fabrics: &[SkyYarns<'_>]) -> Vec<Vec<[f16; 4]>> {
    baked(fabrics, DETAIL, DIRECTIONS)
}

fn baked(fabrics: &[SkyYarns<'_>], detail: Detail, directions: u32) -> Vec<Vec<[f16; 4]>> {
    let Some(tubes) = Tubes::new(fabrics, detail.part) else {
        let open = |yarns: &SkyYarns<'_>| vec![halves(OPEN_SKY); yarns.strands.points.len()];
        return fabrics.iter().map(open).collect();
    };
    let directions: Vec<DVec3> = (0..directions).map(|index| direction(index, directions)).collect();
    let of_fabric = |(fabric, yarns): (usize, &SkyYarns<'_>)| {
        let places = places(fabric, yarns);
        let looked = looked_from(&places, detail.apart * yarns.outer_radius_mm);
        let skies: Vec<DVec4> =
            looked.par_iter().map(|&place| tubes.sky(&places[place], &directions)).collect();
        between(&places, &looked, &skies).into_iter().map(halves).collect()
    };
    fabrics.iter().enumerate().map(of_fabric).collect()
}

fn halves(sky: DVec4) -> [f16; 4] {
    sky.to_array().map(f16::from_f64)
}

/// One of `count` that are evenly spread over the sphere (the golden spiral).
fn direction(index: u32, count: u32) -> DVec3 {
    let z = 1.0 - (2.0 * f64::from(index) + 1.0) / f64::from(count);
    let azimuth = (f64::from(index) + 0.5) * PI * (3.0 - 5f64.sqrt());
    let across = (1.0 - z * z).sqrt();
    // Half a step ahead, so that none is at right angles to an axis: where a part is 0 the search tree misses.
    DVec3::new(across * azimuth.cos(), across * azimuth.sin(), z)
}

/// A place on a yarn.
#[derive(Clone, Copy, Debug)]
struct Place {
    position: DVec3,
    fabric: usize,
    curve: usize,
    length_mm: f64,
    /// Within which along the curve it is its own tube; and the curve's length where it is closed.
    own_mm: f64,
    closed_mm: Option<f64>,
}

/// One for each control point. Points that no piece touches are at their curve's start.
fn places(fabric: usize, yarns: &SkyYarns<'_>) -> Vec<Place> {
    let strands = yarns.strands;
    let lengths = strands.pieces.iter().fold(vec![0.0; strands.closed.len()], |mut sums, piece| {
        sums[piece.curve] += piece.length_mm;
        sums
    });
    let at = |position: &DVec3| Place {
        position: *position,
        fabric,
        curve: 0,
        length_mm: 0.0,
        own_mm: OWN * yarns.outer_radius_mm,
        closed_mm: None,
    };
    let mut places: Vec<Place> = strands.points.iter().map(at).collect();
    // Where the window's four points lie along the piece. The inner ones are nearer to it: they have the last word.
    let shares = match strands.basis {
        Basis::Bezier => [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0],
        _ => [-1.0, 0.0, 1.0, 2.0],
    };
    for window in [[0, 3], [1, 2]] {
        for piece in &strands.pieces {
            for k in window {
                let place = &mut places[piece.first_point + k];
                place.curve = piece.curve;
                place.length_mm = piece.length_start_mm + shares[k] * piece.length_mm;
                place.closed_mm = strands.closed[piece.curve].then_some(lengths[piece.curve]);
            }
        }
    }
    places
}

/// Places, `apart_mm` apart at most, that are looked from: the first and last of each run along a curve among
/// them. The sky changes little between two of them, and looking takes long.
fn looked_from(places: &[Place], apart_mm: f64) -> Vec<usize> {
    let mut looked: Vec<usize> = Vec::new();
    for (index, place) in places.iter().enumerate() {
        let goes_on = |other: &Place| other.curve == place.curve && other.length_mm >= place.length_mm;
        let next_is_near = places.get(index + 1).is_some_and(|next| {
            let last = looked.last().map(|last| &places[*last]);
            let since = last.map_or(f64::INFINITY, |last| next.length_mm - last.length_mm);
            goes_on(next) && last.is_some_and(|last| last.curve == place.curve) && since <= apart_mm
        });
        let starts = index == 0 || {
            let before = &places[index - 1];
            before.curve != place.curve || before.length_mm > place.length_mm
        };
        if starts || !next_is_near {
            looked.push(index);
        }
    }
    looked
}

/// The skies of all places, by their distance along the yarn from those that were looked from.
fn between(places: &[Place], looked: &[usize], skies: &[DVec4]) -> Vec<DVec4> {
    let mut all = vec![OPEN_SKY; places.len()];
    for (&at, &sky) in looked.iter().zip(skies) {
        all[at] = sky;
    }
    for (ends, skies) in looked.windows(2).zip(skies.windows(2)) {
        let [from, to] = [ends[0], ends[1]].map(|end| places[end].length_mm);
        for index in ends[0] + 1..ends[1] {
            let share = ((places[index].length_mm - from) / (to - from).max(1e-300)).clamp(0.0, 1.0);
            all[index] = skies[0].lerp(skies[1], share);
        }
    }
    all
}

/// A straight part of a yarn: opaque, with round ends.
#[derive(Clone, Copy, Debug)]
struct Tube {
    start: DVec3,
    along: DVec3,
    radius: f64,
    fabric: u32,
    curve: u32,
    /// Along the curve: its middle, and half of it.
    middle_mm: f64,
    half_mm: f64,
}

impl Tube {
    fn is_of(&self, place: &Place) -> bool {
        if (self.fabric, self.curve) != (place.fabric as u32, place.curve as u32) {
            return false;
        }
        let apart = (self.middle_mm - place.length_mm).abs();
        let apart = place.closed_mm.map_or(apart, |length| apart.min((length - apart).abs()));
        apart < place.own_mm + self.half_mm
    }

    /// Whether a ray comes within the radius of its axis. One that starts there does not: yarns that lie in one
    /// another would be black.
    fn hides(&self, origin: DVec3, direction: DVec3) -> bool {
        let from_start = origin - self.start;
        let (length_squared, along) = (self.along.length_squared().max(1e-300), self.along.dot(direction));
        let place_on_axis = |p: DVec3| (p.dot(self.along) / length_squared).clamp(0.0, 1.0);
        let off = |t: f64| {
            let p = from_start + t * direction;
            (p - place_on_axis(p) * self.along).length_squared()
        };
        let squared = self.radius * self.radius;
        if off(0.0) <= squared {
            return false;
        }
        // Nearest to the axis' line, and nearest to each end: one of them is nearest to the part between.
        let across = length_squared - along * along;
        let toward_line = (from_start.dot(self.along) * along - from_start.dot(direction) * length_squared)
            / across.max(1e-300);
        let ends = [self.start, self.start + self.along].map(|end| (end - origin).dot(direction));
        [toward_line, ends[0], ends[1]].into_iter().any(|t| t > 0.0 && t.is_finite() && off(t) <= squared)
    }
}

/// All yarns, ready to be looked at.
struct Tubes {
    tubes: Vec<Tube>,
    tree: CwBvh,
    low: DVec3,
    size: f64,
}

impl Tubes {
    fn new(fabrics: &[SkyYarns<'_>], part: f64) -> Option<Self> {
        let of_fabric = |(fabric, yarns)| tubes_of(fabric, yarns, part * yarns.outer_radius_mm);
        let tubes: Vec<Tube> = (0..).zip(fabrics).flat_map(of_fabric).collect();
        let corners = |tube: &Tube| {
            let (end, radius) = (tube.start + tube.along, DVec3::splat(tube.radius));
            (tube.start.min(end) - radius, tube.start.max(end) + radius)
        };
        let (low, high) = tubes.iter().map(corners).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let size = (high - low).max_element().max(1e-3);
        let margin = DVec3::splat(MARGIN * size);
        let boxed = |tube: &Tube| {
            let (from, to) = corners(tube);
            Aabb::new((from - margin - low).as_vec3a(), (to + margin - low).as_vec3a())
        };
        let boxes: Vec<Aabb> = tubes.iter().map(boxed).collect();
        let indices = (0..boxes.len() as u32).collect();
        let builder = PlocBuilder::with_capacity(boxes.len());
        let mut binary = { builder }.build(PlocSearchDistance::Low, &boxes, indices, SortPrecision::U64, 0);
        ReinsertionOptimizer::default().run(&mut binary, REINSERTED, None);
        let tree = bvh2_to_cwbvh(&binary, 2, true, false);
        (depth(&tree) <= DEEPEST).then_some(Self { tubes, tree, low, size })
    }

    fn is_hidden(&self, place: &Place, direction: DVec3) -> bool {
        let origin = (place.position - self.low).as_vec3a();
        let ray = BoxRay::new(origin, direction.as_vec3a(), 0.0, (4.0 * self.size) as f32);
        !self.tree.ray_traverse_miss(ray, |_, slot| {
            let tube = &self.tubes[self.tree.primitive_indices[slot] as usize];
            let hides = !tube.is_of(place) && tube.hides(place.position, direction);
            if hides { 0.0 } else { f32::INFINITY }
        })
    }

    /// The fit: over the sphere 1 and the directions are orthogonal, with mean squares of 1 and of a third.
    fn sky(&self, place: &Place, directions: &[DVec3]) -> DVec4 {
        let open = directions.iter().filter(|direction| !self.is_hidden(place, **direction));
        let (count, sum) =
            open.fold((0.0, DVec3::ZERO), |(count, sum), direction| (count + 1.0, sum + *direction));
        let slope = 3.0 * sum;
        DVec4::new(count, slope.x, slope.y, slope.z) / directions.len() as f64
    }
}

/// The yarns of a fabric, a piece longer than `part_mm` in two.
fn tubes_of<'a>(fabric: u32, yarns: &SkyYarns<'a>, part_mm: f64) -> impl Iterator<Item = Tube> + use<'a> {
    let (strands, radius) = (yarns.strands, yarns.hiding_radius_mm);
    strands.pieces.iter().flat_map(move |piece| {
        let bezier = strands.bezier(piece);
        let parts = if piece.length_mm > part_mm { 2 } else { 1 };
        let knot = move |i: usize| bezier_point(&bezier, i as f64 / parts as f64).position;
        let half_mm = 0.5 * piece.length_mm / parts as f64;
        (0..parts).map(move |i| Tube {
            start: knot(i),
            along: knot(i + 1) - knot(i),
            radius,
            fabric,
            curve: piece.curve as u32,
            middle_mm: piece.length_start_mm + (2 * i + 1) as f64 * half_mm,
            half_mm,
        })
    })
}

/// Levels of the tree.
fn depth(tree: &CwBvh) -> usize {
    let (mut deepest, mut open) = (0, vec![(0usize, 1usize)]);
    while let Some((index, level)) = open.pop() {
        let Some(node) = tree.nodes.get(index) else { continue };
        deepest = deepest.max(level);
        open.extend(
            (0..node.imask.count_ones() as usize).map(|k| (node.child_base_idx as usize + k, level + 1)),
        );
    }
    deepest
}

#[cfg(test)]
#[path = "sky_tests.rs"]
mod tests;
