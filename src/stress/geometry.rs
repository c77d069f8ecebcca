//! Whole yarns through the library, and the renderer's own buffers and function against f64.

use super::cases::{Case, cases, long_yarn};
use super::measure::BY_FORMULA;
use super::placed::{Query, ask_device};
use super::verdict::{Collector, Row};
use crate::error::Error;
use crate::frame::sampling::Sampling;
use crate::frame::{Renderer, Request};
use crate::math::rng::Rng;
use crate::scene::features::Features;
use crate::scene::{Scene, SceneFile};
use crate::vulkan::Device;
use crate::yarn::fetch::FiberField;
use crate::yarn::fiber::FiberPoint;
use crate::yarn::strand::Piece;
use glam::DVec3;
use std::sync::Arc;

const GROUP: &str = "geometry";
/// How far beyond the reach of its fibers f64 may put one, as a share.
const OUT_OF_REACH: f64 = 1e-6;
/// Gap between pieces of a smooth yarn, in reaches.
const GAP: f64 = 1e-6;
/// A step along a piece, and how far a fiber that is where it is to 1e-4 may move over it, in reaches and in lengths
/// of the piece: at cusps and at the tips of hairs it moves farther, and f32 cannot know where it is.
const STEP: f64 = 1e-5;
const SETTLED: f64 = 1e-2;
/// Most of the places that may be unsettled.
const MOST_UNSETTLED: f64 = 0.2;
/// Without tables: what is asked is where fibers are.
const BARE: &str = "shading.model = \"simple\"\nshadow.map = false\nshadow.self = false\nocclusion.mode = \"none\"\n\
                    quality.level_of_detail = false\ndebug.fibers = \"every\"\n";

/// All rows of whole yarns.
///
/// # Errors
/// Those of the device, and scenes that cannot be.
pub fn rows(device: &Arc<Device>, quick: bool) -> Result<Vec<Row>, Error> {
    let places = if quick { 300 } else { 20_000 };
    let stride = if quick { 3 } else { 1 };
    let cases = cases();
    let mut rows: Vec<Row> =
        cases.iter().step_by(stride).map(|case| row(device, case, places)).collect::<Result<_, _>>()?;
    let (kilometres, name) = if quick { (10, "10 km of yarn") } else { (100, "100 km of yarn") };
    rows.push(row(
        device,
        &Case {
            name: name.into(),
            domain: "pieces of 100 mm, pitch 5 mm".into(),
            yarn: "ply_pitch_mm = 5\nfiber_pitch_mm = 4\nmigration_rate = 1".into(),
            curves: long_yarn(1e6 * f64::from(kilometres), 100.0),
            smooth: true,
        },
        places,
    )?);
    Ok(rows)
}

/// A scene of a case with more lines of TOML.
///
/// # Errors
/// What a scene file may not say.
pub fn scene_of(case: &Case, more: &str) -> Result<Scene, Error> {
    let text = format!("{more}\n[yarn]\n{}\n", case.yarn);
    let file: SceneFile =
        toml::from_str(&text).map_err(|e| Error::Failed(format!("{}: {}", case.name, e.message())))?;
    Ok(Scene::of_curves(file, case.curves.clone(), &case.name)?)
}

fn row(device: &Arc<Device>, case: &Case, places: u64) -> Result<Row, Error> {
    let scene = scene_of(case, BARE)?;
    let fabric = &scene.fabrics[0];
    let field = FiberField::new(fabric.strands.clone(), &fabric.yarn, scene.file.seed);
    let mut c = Collector::default();
    on_the_host(&mut c, &field, case.smooth);
    // Both get what f32 has of the points.
    let mut field = field;
    for point in &mut field.strands.points {
        *point = scene.origin_mm + (*point - scene.origin_mm).as_vec3().as_dvec3();
    }
    let queries = queries(&field, places);
    let features = Features::new(&scene.file, fabric, false);
    let request = Request {
        size: [16, 16],
        sampling: Sampling::new(1).map_err(Error::Failed)?,
        statistics: false,
        profile: false,
    };
    let renderer = Renderer::new(device, scene.clone(), request)?;
    let answers = ask_device(device, &renderer, &features, &queries)?;
    let size = fabric.hull_points().map(|p| (p - scene.origin_mm).length()).fold(0.0, f64::max);
    let scale = size.max(field.flyaways.reach_mm);
    let mut unsettled = 0.0;
    for (query, answer) in queries.iter().zip(&answers) {
        let at = || format!("piece {}, fiber {}, t {:e}", query.segment, query.fiber, query.t);
        let found = DVec3::from_array(answer.position.map(f64::from));
        c.points(1);
        c.numbers(&found.to_array(), true, at);
        c.numbers(&answer.tangent.map(f64::from), true, at);
        match settled(&field, query) {
            Some(exact) => {
                let off = (found - (exact.position - scene.origin_mm)).length();
                c.error(off / scale, BY_FORMULA, at);
            }
            None => unsettled += 1.0,
        }
    }
    c.demand(!case.smooth || unsettled <= MOST_UNSETTLED * places as f64, || {
        format!("{unsettled} of {places} places are not settled in f64")
    });
    Ok(c.row(GROUP, "fibers of a yarn", &case.name, &case.domain))
}

/// Random places, every eighth an end of its piece.
fn queries(field: &FiberField, count: u64) -> Vec<Query> {
    let (pieces, fibers) = (field.strands.pieces.len() as f64, field.fibers.len() as f64);
    let query = |index: u64| {
        let mut rng = Rng::new(19, &[index]);
        let mut below = |count: f64| (rng.uniform() * count) as u32;
        let (segment, fiber, special) = (below(pieces), below(fibers), below(16.0));
        let t = if special < 2 { special as f32 } else { rng.uniform() as f32 };
        Query { segment, fiber, t, padding: 0 }
    };
    (0..count).map(query).collect()
}

fn point(field: &FiberField, piece: &Piece, fiber: usize, t: f64) -> FiberPoint {
    field.fiber_at(piece, fiber, t).0
}

/// Where f64 has the fiber; `None` where it would be somewhere else a hair's breadth along the piece.
fn settled(field: &FiberField, query: &Query) -> Option<FiberPoint> {
    let piece = &field.strands.pieces[query.segment as usize];
    let at = |t: f64| point(field, piece, query.fiber as usize, t.clamp(0.0, 1.0));
    let t = f64::from(query.t);
    let here = at(t);
    let most = SETTLED * (field.flyaways.reach_mm + piece.length_mm);
    let near = |t: f64| (at(t).position - here.position).length() <= most;
    (near(t - STEP) && near(t + STEP)).then_some(here)
}

/// What must hold in f64 already: finite, unit and perpendicular frames; fibers within their reach; smooth yarns
/// without gaps.
fn on_the_host(c: &mut Collector, field: &FiberField, smooth: bool) {
    let reach = field.flyaways.reach_mm;
    let pieces = &field.strands.pieces;
    let stride = (pieces.len() / 500).max(1);
    for (index, piece) in pieces.iter().enumerate().step_by(stride) {
        let at = || format!("piece {index} in f64");
        for normal in field.strands.knot_normals(piece) {
            c.numbers(&normal.to_array(), true, at);
            c.error((normal.length() - 1.0).abs(), 1e-9, at);
        }
        for fiber in [0, field.fibers.len() / 2, field.fibers.len() - 1] {
            for step in 0..=8 {
                let found = point(field, piece, fiber, f64::from(step) / 8.0);
                c.points(1);
                c.numbers(&found.position.to_array(), true, at);
                let away = (found.position - found.yarn_center).length();
                c.error((away / reach - 1.0).max(0.0), OUT_OF_REACH, at);
            }
        }
        if let Some(next) = pieces.get(index + 1).filter(|next| smooth && next.curve == piece.curve) {
            let ends = |fiber| (point(field, piece, fiber, 1.0), point(field, next, fiber, 0.0));
            let (end, start) = ends(field.fibers.len() / 2);
            let gap = (end.position - start.position).length();
            // What f64 has of the yarn's length, and of its place.
            let rounding = 1e-12 * (end.position.length() + piece.length_start_mm);
            if gap > GAP * reach + rounding {
                c.jump(|| format!("gap of {gap:e} mm behind piece {index}"));
            }
        }
    }
}
