//! Rays against all fibers, through a bounding volume hierarchy.

use super::geometry::{FiberGeometry, Ignored, Place, Stored};
use glam::DVec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
use obvhs::cwbvh::{CwBvh, node::CwBvhNode};
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use obvhs::ray::{Ray as BoxRay, RayHit};

/// A ray with a unit direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// In mm, relative to the scene's origin.
    pub origin: DVec3,
    /// Unit.
    pub direction: DVec3,
}

/// Where a ray met a fiber.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance from the ray's origin in mm.
    pub distance: f64,
    /// Place on the fiber's axis.
    pub place: Place,
}

/// Boxes are tested in f32: their margin and a ray's end, as shares of the scene's size.
const MARGIN: f64 = 1e-6;
/// How hard the builder tries: little more makes rays faster.
const SEARCH_DISTANCE: PlocSearchDistance = PlocSearchDistance::Low;
const REINSERTED: f32 = 0.05;
const PIECES_PER_LEAF: u32 = 2;
/// Levels that a traversal's stack has room for, fewer by one for safety.
const DEEPEST: usize = 31;

/// Fibers that cannot be put into a hierarchy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected fibers that lie apart, found so many in one place that no search tree holds them")]
pub struct TooDeep;

/// All fibers, ready to be hit.
pub struct Accel<T> {
    geometry: FiberGeometry<T>,
    /// Its primitives are the pieces' first points.
    tree: CwBvh,
    low: DVec3,
    high: DVec3,
}

impl<T: Stored> Accel<T> {
    /// Builds the hierarchy. What is hit does not depend on how it came out.
    ///
    /// # Errors
    /// A hierarchy too deep to be searched.
    pub fn new(geometry: FiberGeometry<T>) -> Result<Self, TooDeep> {
        let mut low = DVec3::splat(f64::INFINITY);
        let mut high = DVec3::splat(f64::NEG_INFINITY);
        let pieces: Vec<u32> = geometry.pieces().collect();
        let corners = |point: u32| {
            let cone = geometry.piece(point);
            let [a, b] = [0, 1].map(|end| (cone.ends[end], DVec3::splat(cone.radii[end])));
            ((a.0 - a.1).min(b.0 - b.1), (a.0 + a.1).max(b.0 + b.1))
        };
        for &point in &pieces {
            let (piece_low, piece_high) = corners(point);
            (low, high) = (low.min(piece_low), high.max(piece_high));
        }
        let margin = DVec3::splat(MARGIN * (high - low).max_element().max(1e-3));
        let boxes: Vec<Aabb> = pieces
            .iter()
            .map(|&point| {
                let (low, high) = corners(point);
                Aabb::new((low - margin).as_vec3a(), (high + margin).as_vec3a())
            })
            .collect();
        let mut tree = build(&boxes);
        if depth(&tree) > DEEPEST {
            return Err(TooDeep);
        }
        for index in &mut tree.primitive_indices {
            *index = pieces[*index as usize];
        }
        Ok(Self { geometry, tree, low: low - margin, high: high + margin })
    }

    /// The fibers.
    pub fn geometry(&self) -> &FiberGeometry<T> {
        &self.geometry
    }

    /// Memory that the hierarchy takes.
    pub fn bytes(&self) -> usize {
        self.tree.nodes.len() * size_of::<CwBvhNode>() + self.tree.primitive_indices.len() * size_of::<u32>()
    }

    /// The part of a ray up to `end` that lies in the scene's box.
    fn inside(&self, ray: &Ray, end: f64) -> Option<[f64; 2]> {
        let (mut from, mut to) = (0.0f64, end);
        for axis in 0..3 {
            let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
            if direction == 0.0 {
                if !(self.low[axis]..=self.high[axis]).contains(&origin) {
                    return None;
                }
                continue;
            }
            let [a, b] = [self.low[axis], self.high[axis]].map(|side| (side - origin) / direction);
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
        (from <= to).then_some([from, to])
    }

    /// The ray as boxes are tested against it, from where it comes into the scene: f32 has digits enough there.
    fn box_ray(&self, ray: &Ray, [from, to]: [f64; 2]) -> BoxRay {
        let origin = (ray.origin + from * ray.direction).as_vec3a();
        let size = (self.high - self.low).max_element();
        let direction = ray.direction.map(no_zero).as_vec3a();
        BoxRay::new(origin, direction, 0.0, (to - from + MARGIN * size) as f32)
    }

    /// The first fiber that a ray enters, but for what it ignores.
    pub fn nearest(&self, ray: &Ray, ignored: &Ignored) -> Option<Hit> {
        let span = self.inside(ray, f64::INFINITY)?;
        let mut best: Option<Hit> = None;
        let tree = &self.tree;
        let mut unused = RayHit::none();
        tree.ray_traverse(self.box_ray(ray, span), &mut unused, |_, slot| {
            let entered = self.geometry.enter(tree.primitive_indices[slot], ray.origin, ray.direction);
            match entered {
                Some((distance, place)) if is_nearer(best, distance, place) && !ignored.holds(place) => {
                    best = Some(Hit { distance, place });
                    ((distance - span[0]).max(0.0) as f32).next_up()
                }
                _ => f32::INFINITY,
            }
        });
        best
    }

    /// Whether a ray enters a fiber within `end` mm, but for what it ignores.
    pub fn is_blocked(&self, ray: &Ray, end: f64, ignored: &Ignored) -> bool {
        let Some(span) = self.inside(ray, end) else { return false };
        let tree = &self.tree;
        !tree.ray_traverse_miss(self.box_ray(ray, span), |_, slot| {
            let entered = self.geometry.enter(tree.primitive_indices[slot], ray.origin, ray.direction);
            let blocks = entered.is_some_and(|(distance, place)| distance < end && !ignored.holds(place));
            if blocks { 0.0 } else { f32::INFINITY }
        })
    }
}

/// The hierarchy takes the inverse of a direction's parts, and their signs: where one is 0, and above all where it is
/// -0, rays miss every box. A ray turned by as little as this stays within their margins.
fn no_zero(part: f64) -> f64 {
    if part.abs() < 1e-7 { 1e-7 } else { part }
}

/// Two pieces share the ball at their joint: the first along the fiber has it, in whatever order they are met.
fn is_nearer(best: Option<Hit>, distance: f64, place: Place) -> bool {
    best.is_none_or(|best| {
        distance < best.distance || (distance == best.distance && place.point < best.place.point)
    })
}

fn build(boxes: &[Aabb]) -> CwBvh {
    if boxes.is_empty() {
        return CwBvh::default();
    }
    let indices = (0..boxes.len() as u32).collect();
    let builder = PlocBuilder::with_capacity(boxes.len());
    let mut binary = { builder }.build(SEARCH_DISTANCE, boxes, indices, SortPrecision::U64, 0);
    ReinsertionOptimizer::default().run(&mut binary, REINSERTED, None);
    bvh2_to_cwbvh(&binary, PIECES_PER_LEAF, true, false)
}

/// Levels of the tree.
fn depth(tree: &CwBvh) -> usize {
    let mut deepest = 0;
    let mut open = vec![(0usize, 1usize)];
    while let Some((index, level)) = open.pop() {
        let Some(node) = tree.nodes.get(index) else { continue };
        deepest = deepest.max(level);
        let children = node.imask.count_ones() as usize;
        open.extend((0..children).map(|k| (node.child_base_idx as usize + k, level + 1)));
    }
    deepest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::Rng;
    use crate::reference::fibers::{RealiseSettings, realise};
    use crate::reference::test_scene::{scene_of, straight, yarn};

    fn accel() -> Accel<f32> {
        let scene = scene_of("", &[straight(-3.0, 3.0, 0.0), straight(-3.0, 3.0, 1.5)], &yarn("cotton1", 15));
        let fibers = realise(&scene, &RealiseSettings::default()).unwrap();
        Accel::new(FiberGeometry::new(fibers, scene.origin_mm)).unwrap()
    }

    fn random_ray(index: u64) -> Ray {
        let mut rng = Rng::new(4, &[index]);
        let mut point = |size: f64| DVec3::from_array(std::array::from_fn(|_| size * (rng.uniform() - 0.5)));
        let (target, from) = (point(2.0), point(1.0));
        // Some along axes, or at right angles to one.
        let along = match index % 11 {
            0 => from * DVec3::new(1.0, 0.0, -1.0),
            1 => from * DVec3::new(-0.0, 1.0, 0.0),
            2 => from * DVec3::new(-0.0, -0.0, -1.0),
            _ => from,
        };
        let direction = along.normalize_or(DVec3::X);
        // Some from far away, some from among the fibers.
        Ray { origin: target - [0.0, 5.0, 900.0][index as usize % 3] * direction, direction }
    }

    #[test]
    fn rays_meet_what_a_look_at_every_piece_says() {
        let accel = accel();
        let (mut hits, mut misses) = (0, 0);
        for index in 0..2000 {
            let ray = random_ray(index);
            let entered = |point| accel.geometry.enter(point, ray.origin, ray.direction);
            let exact = accel.geometry.pieces().filter_map(entered).min_by(|a, b| a.0.total_cmp(&b.0));
            let found = accel.nearest(&ray, &Ignored::NONE);
            match (exact, found) {
                (Some((distance, place)), Some(hit)) => {
                    hits += 1;
                    assert_eq!((distance, place), (hit.distance, hit.place), "ray {index}");
                    assert!(!accel.is_blocked(&ray, 0.999 * distance, &Ignored::NONE));
                    assert!(accel.is_blocked(&ray, 1.001 * distance, &Ignored::NONE));
                    // What is ignored does not block, what lies behind it does.
                    let ignored = accel.geometry.around(place, 0.03);
                    let behind = accel.nearest(&ray, &ignored);
                    assert!(behind.is_none_or(|hit| hit.distance > distance && !ignored.holds(hit.place)));
                    assert_eq!(behind.is_some(), accel.is_blocked(&ray, f64::INFINITY, &ignored));
                }
                (None, None) => misses += 1,
                _ => panic!("ray {index}: {exact:?}, found {found:?}"),
            }
        }
        assert!(hits > 300 && misses > 300, "{hits} {misses}");
    }

    #[test]
    fn few_fibers_or_none_are_no_special_case() {
        let empty = Accel::new(FiberGeometry::<f32>::new(Vec::new(), DVec3::ZERO)).unwrap();
        assert_eq!(empty.nearest(&random_ray(1), &Ignored::NONE), None);
        assert!(!empty.is_blocked(&random_ray(1), 9.0, &Ignored::NONE));
        let scene = scene_of("", &[straight(-3.0, 3.0, 0.0)], &yarn("cotton1", 1));
        let mut fibers = realise(&scene, &RealiseSettings::default()).unwrap();
        fibers.truncate(1);
        let fiber = &mut fibers[0];
        fiber.points = vec![DVec3::NEG_X, DVec3::X];
        fiber.tangents.truncate(2);
        fiber.radii_mm = vec![0.5; 2];
        let one = Accel::new(FiberGeometry::<f32>::new(fibers, DVec3::ZERO)).unwrap();
        let hit =
            one.nearest(&Ray { origin: DVec3::Z * 3.0, direction: DVec3::NEG_Z }, &Ignored::NONE).unwrap();
        assert!((hit.distance - 2.5).abs() < 1e-12 && (hit.place.share - 0.5).abs() < 1e-12);
        // Many in one place: searched, or refused.
        let copies = |count: usize| {
            let fibers = vec![realise(&scene, &RealiseSettings::default()).unwrap()[0].clone(); count];
            Accel::new(FiberGeometry::<f32>::new(fibers, DVec3::ZERO))
        };
        let ray = Ray { origin: DVec3::new(0.0, 3.0, 0.0), direction: DVec3::NEG_Y };
        assert!(copies(20).is_ok_and(|accel| !accel.is_blocked(&ray, 1.0, &Ignored::NONE)));
        assert!(copies(1000).is_err_and(|error| !error.to_string().contains('\n')));
    }
}
