//! Every fiber of every closed curve meets itself at the closing point: where it is, where it goes, and
//! what it is.
//!
//! Where it goes: a Catmull-Rom curve bends at its knots with a jump, and turns are spread evenly over a
//! piece's parameter, so that off the centre line fibers have corners at every knot whose pieces bend
//! differently or differ in length, the closing one included. On the generated tube, whose courses close
//! where both sides are mirror images, the fibers' own tangents must agree; on other models those of the
//! yarn, and the turns per mm.

use glam::{DQuat, DVec3};
use std::path::{Path, PathBuf};
use worsted::frame::sampling::Sampling;
use worsted::frame::{Renderer, Request};
use worsted::io::bcc::write_bcc;
use worsted::knit::params::KnitParams;
use worsted::knit::tube::tube;
use worsted::scene::Scene;
use worsted::scene::features::Features;
use worsted::stress::placed::{Query, ask_device};
use worsted::vulkan::DeviceChoice;
use worsted::yarn::fetch::FiberField;
use worsted::yarn::fiber::yarn_point;
use worsted::yarn::params::YarnParams;
use worsted::yarn::period::{Kind, Period};
use worsted::yarn::strand::{Piece, Strands};

#[path = "support/device.rs"]
mod device;
use device::shared;

/// Yarns of one, two and three plies, in both senses, with few and many periods to a turn; a migration of
/// silk1 and of mohair holds several periods.
const YARNS: [&str; 5] = ["worsted_3ply", "cotton1", "rayon1", "silk1", "mohair"];
/// Largest gap, in radii of a ply.
const BOUND_RADII: f64 = 1e-3;
/// Largest angle between the tangents, in radians.
const BOUND_RADIANS: f64 = 1e-2;

/// A fiber at a closing point.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Side {
    position: DVec3,
    tangent: DVec3,
    kind: Kind,
    /// Everything drawn for the period that the point is in: reach, share, twist and which end is the root.
    /// Not on the device, whose positions have it in them.
    drawn: Option<([f64; 3], bool)>,
}

/// The first and the last piece of every closed curve, by index.
fn closing_pieces(strands: &Strands) -> Vec<[usize; 2]> {
    let mut ends: Vec<Option<[usize; 2]>> = vec![None; strands.period_counts.len()];
    for (index, piece) in strands.pieces.iter().enumerate() {
        ends[piece.curve].get_or_insert([index, index])[1] = index;
    }
    let closed = |[first, last]: &[usize; 2]| {
        let (first, last) = (&strands.pieces[*first], &strands.pieces[*last]);
        (strands.bezier(first)[0] - strands.bezier(last)[3]).length() < 1e-9
    };
    ends.into_iter().flatten().filter(closed).collect()
}

/// What is found at the closing points: how many fibers, the largest gap and angle.
#[derive(Debug, Default)]
struct Worst {
    fibers: usize,
    /// Loops and hairs among them.
    flyaways: usize,
    radii: f64,
    radians: f64,
}

/// Holds both sides of closing points to each other; `sides` are begin and end of one fiber each.
fn compare(yarn: &YarnParams, sides: impl Iterator<Item = [Side; 2]>) -> Result<Worst, String> {
    let radius_mm = yarn.round_ply_radius_mm();
    let mut worst = Worst::default();
    for [begin, end] in sides {
        let fail = |what: String| Err(format!("fiber {}: {what}: {begin:?} and {end:?}", worst.fibers));
        if (begin.kind, begin.drawn) != (end.kind, end.drawn) {
            return fail("another fiber".into());
        }
        let gap = (begin.position - end.position).length() / radius_mm;
        let turned = begin.tangent.cross(end.tangent).length().atan2(begin.tangent.dot(end.tangent));
        // Written so that a NaN fails.
        let within = gap < BOUND_RADII && turned < BOUND_RADIANS;
        if !within {
            return fail(format!("{gap} ply radii and {turned} radians apart"));
        }
        worst.radii = worst.radii.max(gap);
        worst.radians = worst.radians.max(turned);
        worst.fibers += 1;
        worst.flyaways += usize::from(begin.kind != Kind::Migration);
    }
    if worst.fibers == 0 {
        return Err("no closed curve".into());
    }
    Ok(worst)
}

/// Whose directions are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Direction {
    Fiber,
    Yarn,
}

/// Largest difference of the turns per mm of two pieces, as a share of them.
fn rate_difference(a: &Piece, b: &Piece) -> f64 {
    let rates = |p: &Piece| [p.turns.ply, p.turns.fiber, p.turns.migration].map(|t| t.delta / p.length_mm);
    let off = |(a, b): (f64, f64)| (a - b).abs() / a.abs().max(b.abs()).max(1e-12);
    rates(a).into_iter().zip(rates(b)).map(off).fold(0.0, f64::max)
}

/// Compares in f64.
fn compare_twin(field: &FiberField, direction: Direction) -> Result<Worst, String> {
    let pieces = &field.strands.pieces;
    let side = |piece: usize, fiber: usize, t: f64| {
        let piece = &pieces[piece];
        let (mut point, Period { kind, reach, share, twist, root_first, .. }) =
            field.fiber_at(piece, fiber, t);
        if direction == Direction::Yarn {
            point.tangent =
                yarn_point(&field.strands.bezier(piece), field.strands.knot_normals(piece), t).tangent;
        }
        let drawn = Some(([reach, share, twist], root_first));
        Side { position: point.position, tangent: point.tangent, kind, drawn }
    };
    let fibers = field.fibers.len();
    let closing = closing_pieces(&field.strands);
    for [first, last] in &closing {
        let off = rate_difference(&pieces[*first], &pieces[*last]);
        if off > 1e-9 {
            return Err(format!("turns per mm differ by {off} of them between pieces {last} and {first}"));
        }
    }
    let both = closing.into_iter().flat_map(|[first, last]| {
        (0..fibers).map(move |fiber| [side(first, fiber, 0.0), side(last, fiber, 1.0)])
    });
    compare(&field.yarn, both)
}

/// Compares on the device.
fn compare_device(scene: &Scene) -> Result<Worst, String> {
    let fabric = &scene.fabrics[0];
    let queries: Vec<Query> = closing_pieces(&fabric.strands)
        .into_iter()
        .flat_map(|[first, last]| (0..fabric.yarn.fiber_count()).map(move |fiber| (first, last, fiber)))
        .flat_map(|(first, last, fiber)| {
            [(first, 0.0), (last, 1.0)].map(|(piece, t)| Query {
                segment: piece as u32,
                fiber,
                t,
                padding: 0,
            })
        })
        .collect();
    let features = Features::new(&scene.file, fabric, false);
    let sampling = Sampling::new(1).expect("one sample is allowed");
    let request = Request { size: [64, 48], sampling, statistics: false, profile: false };
    let renderer = Renderer::new(shared(DeviceChoice::Auto), scene.clone(), request).expect("a renderer");
    let answers = ask_device(shared(DeviceChoice::Auto), &renderer, &features, &queries)
        .expect("answers without validation errors");
    assert_eq!(answers.len(), queries.len());
    let kinds = [Kind::Migration, Kind::Loop, Kind::Hair];
    let sides = answers.chunks_exact(2).map(|pair| {
        [&pair[0], &pair[1]].map(|answer| Side {
            position: DVec3::from_array(answer.position.map(f64::from)),
            tangent: DVec3::from_array(answer.tangent.map(f64::from)),
            kind: kinds[answer.kind as usize],
            drawn: None,
        })
    });
    compare(&fabric.yarn, sides)
}

fn load(model: &Path, yarn: &str) -> Scene {
    Scene::load(model, &[format!("yarn.preset={yarn}")]).expect("a scene that loads")
}

fn field(scene: &Scene) -> FiberField {
    let fabric = &scene.fabrics[0];
    FiberField::new(fabric.strands.clone(), &fabric.yarn, scene.file.seed)
}

/// A small tube on disk, as `worsted knit tube` writes it.
fn tube_file(folder: &tempfile::TempDir) -> PathBuf {
    let path = folder.path().join("tube.bcc");
    let knit = tube(&KnitParams { courses: 5, wales: 12, ..KnitParams::tube() }).expect("a sound tube");
    write_bcc(&path, &knit).expect("the temporary folder is ours to use");
    path
}

fn temporary_folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("the temporary folder is ours to use")
}

#[test]
fn fibers_of_the_glove_meet_themselves() {
    let glove = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/yuksel-bcc/glove.bcc");
    if !glove.exists() {
        println!("skipped: no model at {}", glove.display());
        return;
    }
    for yarn in YARNS {
        let field = field(&load(&glove, yarn));
        let worst = compare_twin(&field, Direction::Yarn).unwrap_or_else(|fault| panic!("{yarn}: {fault}"));
        println!("glove in {yarn}: {worst:?}");
        assert_eq!(worst.fibers, 70 * field.fibers.len());
        assert!(worst.flyaways > 0);
        assert!(yarn != "silk1" || field.flyaways.periods_per_migration > 1, "as YARNS says");
    }
}

#[test]
fn fibers_of_a_tube_meet_themselves() {
    let folder = temporary_folder();
    let model = tube_file(&folder);
    for yarn in YARNS {
        let field = field(&load(&model, yarn));
        let worst = compare_twin(&field, Direction::Fiber).unwrap_or_else(|fault| panic!("{yarn}: {fault}"));
        println!("tube in {yarn}: {worst:?}");
        assert_eq!(worst.fibers, 5 * field.fibers.len());
        assert!(worst.flyaways > 0);
    }
}

#[test]
fn fibers_of_a_tube_meet_themselves_on_the_device() {
    let folder = temporary_folder();
    let model = tube_file(&folder);
    for yarn in YARNS {
        let scene = load(&model, yarn);
        let worst = compare_device(&scene).unwrap_or_else(|fault| panic!("{yarn}: {fault}"));
        println!("tube on the device in {yarn}: {worst:?}");
        assert_eq!(worst.fibers as u32, 5 * scene.fabrics[0].yarn.fiber_count());
    }
}

/// Spoils `strands` as code that forgets something about closed curves would.
#[derive(Clone, Copy, Debug)]
enum Spoil {
    /// Plies, fibers or migration keep the turns per mm of an open curve.
    Open(usize),
    /// Periods have identities of their own on each side.
    Identities,
    /// The frame comes back turned.
    Frame,
    /// The first piece turns faster than the last.
    Rate,
}

const SPOILS: [Spoil; 6] =
    [Spoil::Open(0), Spoil::Open(1), Spoil::Open(2), Spoil::Identities, Spoil::Frame, Spoil::Rate];

impl Spoil {
    fn apply(self, strands: &mut Strands, yarn: &YarnParams) {
        match self {
            Self::Open(which) => leave_open(strands, yarn, which),
            Self::Identities => strands.period_counts.fill(0),
            Self::Rate => {
                for [first, _] in closing_pieces(strands) {
                    strands.pieces[first].turns.ply.delta *= 1.5;
                }
            }
            Self::Frame => {
                for [_, last] in closing_pieces(strands) {
                    let piece = strands.pieces[last];
                    let [.., a, b] = strands.bezier(&piece);
                    let turn = DQuat::from_axis_angle((b - a).normalize(), 0.01);
                    let normal = &mut strands.normals[piece.first_point + 2];
                    *normal = turn * *normal;
                }
            }
        }
    }
}

/// Gives every piece the turns that it would have on an open curve: of plies (0), fibers (1) or
/// migration (2).
fn leave_open(strands: &mut Strands, yarn: &YarnParams, which: usize) {
    let fiber = yarn.fiber_turns_per_mm();
    let per_mm = [yarn.ply_turns_per_mm(), fiber, yarn.migration_rate * fiber][which];
    // What the device has of it.
    strands.curves.iter_mut().for_each(|curve| curve.rates[which] = per_mm);
    let mut start = 0.0;
    for piece in &mut strands.pieces {
        let turns = match which {
            0 => &mut piece.turns.ply,
            1 => &mut piece.turns.fiber,
            _ => &mut piece.turns.migration,
        };
        if piece.length_start_mm == 0.0 {
            start = turns.start;
        }
        turns.start = start + per_mm * piece.length_start_mm;
        turns.delta = per_mm * piece.length_mm;
    }
}

#[test]
fn curves_that_do_not_close_are_refused() {
    let folder = temporary_folder();
    let model = tube_file(&folder);
    for yarn in YARNS {
        let sound = field(&load(&model, yarn));
        assert!(compare_twin(&sound, Direction::Yarn).is_ok());
        for spoil in SPOILS {
            let mut spoiled = sound.clone();
            spoil.apply(&mut spoiled.strands, &sound.yarn);
            let fault = compare_twin(&spoiled, Direction::Yarn).expect_err(&format!("{yarn}, {spoil:?}"));
            println!("{yarn}, {spoil:?}: {}", fault.split(": Side").next().unwrap_or_default());
        }
    }
}

#[test]
fn curves_that_do_not_close_on_the_device_are_refused() {
    let folder = temporary_folder();
    let sound = load(&tube_file(&folder), "silk1");
    // On the device no piece has a rate of its own.
    for spoil in SPOILS.into_iter().filter(|spoil| !matches!(spoil, Spoil::Rate)) {
        let mut spoiled = sound.clone();
        spoil.apply(&mut spoiled.fabrics[0].strands, &sound.fabrics[0].yarn);
        let fault = compare_device(&spoiled).expect_err(&format!("{spoil:?}"));
        println!("{spoil:?}: {}", fault.split(": Side").next().unwrap_or_default());
    }
}

#[test]
fn the_comparison_refuses_what_is_just_beyond_its_bounds() {
    let yarn = worsted::yarn::presets::yarn("cotton1").expect("a preset");
    let side = Side {
        position: DVec3::new(3.0, 4.0, 5.0),
        tangent: DVec3::Y,
        kind: Kind::Hair,
        drawn: Some(([1.5, 0.5, 0.2], true)),
    };
    let verdict = |edit: &dyn Fn(&mut Side)| {
        let mut other = side;
        edit(&mut other);
        compare(&yarn, [[side, side], [side, other]].into_iter())
    };
    assert_eq!(verdict(&|_| {}).expect("the same").flyaways, 2);
    let radius_mm = yarn.round_ply_radius_mm();
    assert!(verdict(&|s| s.position.z += 0.9e-3 * radius_mm).is_ok());
    assert!(verdict(&|s| s.position.z += 1.1e-3 * radius_mm).is_err());
    assert!(verdict(&|s| s.position.z = f64::NAN).is_err());
    assert!(verdict(&|s| s.tangent = DQuat::from_rotation_x(0.9e-2) * s.tangent).is_ok());
    assert!(verdict(&|s| s.tangent = DQuat::from_rotation_x(1.1e-2) * s.tangent).is_err());
    assert!(verdict(&|s| s.tangent = -s.tangent).is_err());
    assert!(verdict(&|s| s.kind = Kind::Loop).is_err());
    assert!(verdict(&|s| s.drawn = Some(([1.5, 0.5, 0.3], true))).is_err());
    assert!(verdict(&|s| s.drawn = Some(([1.5, 0.5, 0.2], false))).is_err());
    assert!(compare(&yarn, std::iter::empty()).is_err());
}
