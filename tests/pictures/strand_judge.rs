//! What a picture of one straight yarn shows, in f64: rays against the twins' fibers. Shares no pass, table or
//! shader with the picture that it judges.

use glam::{DVec3, DVec4};
use worsted::frame::camera;
use worsted::math::rng::Rng;
use worsted::math::strip::{strip_normals, strip_side};
use worsted::scene::Scene;
use worsted::yarn::fetch::FiberField;
use worsted::yarn::strand::Piece;

/// Rays, in a jittered grid over the part of the picture that the yarn crosses.
const COLUMNS: u32 = 240;
const ROWS: u32 = 64;

/// What one ray meets.
pub struct Seen {
    pub tangent: DVec3,
    pub side: DVec3,
    pub toward: DVec3,
    /// Of the round fiber's normal, as [`strip_normals`] has them.
    pub normals: DVec4,
    pub to_eye: DVec3,
}

/// A fiber where it crosses a column of the picture, on the plane through the yarn's centre line.
struct Crossing {
    middle: f64,
    half: f64,
    depth: f64,
    tangent: DVec3,
    to_eye: DVec3,
    side: DVec3,
}

/// All that the picture's rays meet of a yarn along X, from an eye on the Z axis.
pub fn seen(scene: &Scene, size: [u32; 2]) -> Vec<Seen> {
    let fabric = &scene.fabrics[0];
    let field = FiberField::new(fabric.strands.clone(), &fabric.yarn, scene.file.seed);
    let camera = camera(scene, size);
    let eye = camera.eye_world;
    assert!(eye.x.abs() < 1e-9 && eye.y.abs() < 1e-9, "the judge looks along -Z: {eye}");
    let half_width = 0.5 * f64::from(size[0]) * camera.pixel_tangent(size) * eye.z;
    let half_height = fabric.yarn.outer_radius_mm() * 1.05;
    let mut random = Rng::new(1, &[]);
    let mut all = Vec::new();
    for column in 0..COLUMNS {
        let place = (f64::from(column) + random.uniform()) / f64::from(COLUMNS);
        let x = (2.0 * place - 1.0) * half_width;
        let crossings: Vec<Crossing> =
            (0..field.fibers.len()).map(|fiber| crossing(&field, fiber, x, eye)).collect();
        for row in 0..ROWS {
            let place = (f64::from(row) + random.uniform()) / f64::from(ROWS);
            let y = (2.0 * place - 1.0) * half_height;
            let hits = crossings.iter().filter(|c| (y - c.middle).abs() <= c.half);
            let nearest = hits.min_by(|a, b| a.depth.total_cmp(&b.depth));
            all.extend(nearest.map(|c| seen_at(c, (y - c.middle) / c.half)));
        }
    }
    all
}

/// The piece that holds the yarn's point at `x`, and its t there: pieces are equally long and straight.
fn at(field: &FiberField, x: f64) -> (&Piece, f64) {
    let pieces = &field.strands.pieces;
    let start = field.strands.bezier(&pieces[0])[0].x;
    let step = field.strands.bezier(&pieces[0])[3].x - start;
    let place = (x - start) / step;
    let piece = (place.floor() as usize).min(pieces.len() - 1);
    (&pieces[piece], place - piece as f64)
}

fn crossing(field: &FiberField, fiber: usize, x: f64, eye: DVec3) -> Crossing {
    // A fiber before the centre line is seen there through a point nearer to the axis: found by substitution.
    let mut nearer = 1.0;
    let mut point = DVec3::ZERO;
    let mut tangent = DVec3::X;
    for _ in 0..3 {
        let (piece, t) = at(field, x * nearer);
        let found = field.fiber_at(piece, fiber, t).0;
        (point, tangent) = (found.position, found.tangent.normalize());
        nearer = (eye.z - point.z) / eye.z;
    }
    let to_eye = (eye - point).normalize();
    let half = field.yarn.fiber_radius_mm() * tangent.truncate().length() / tangent.x.abs();
    let side = strip_side(tangent, to_eye);
    Crossing {
        middle: point.y / nearer,
        half: half / nearer,
        depth: (eye - point).length(),
        tangent,
        to_eye,
        side,
    }
}

fn seen_at(crossing: &Crossing, across: f64) -> Seen {
    let Crossing { tangent, to_eye, side, .. } = *crossing;
    let normals = strip_normals(across * side.y.signum());
    Seen { tangent, side, toward: side.cross(tangent), normals, to_eye }
}
