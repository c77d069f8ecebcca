//! Whether fibers keep their places on yarns that move: what motion adds to their turns about the yarn.

use crate::animation_memory::scene_of;
use crate::motion_sky;
use crate::report::{Verdicts, print_columns, print_head};
use crate::stage::Stage;
use glam::{DQuat, DVec3};
use std::path::PathBuf;
use worsted::error::Error;
use worsted::knit::motion::{Dance, danced};
use worsted::math::rng::Rng;
use worsted::motion::coherence::{phase_steps, twists, wrapped};
use worsted::motion::mover::{Mover, Movers};
use worsted::motion::pose::{Pose, RestPose, knots};
use worsted::yarn::pose::PointMap;
use worsted::yarn::strand::Strands;

/// Most that a rigid motion adds to the turn of a normal about its yarn, and a cycle to that of a cyclic one, rad.
const MOST_ADDED: f64 = 1e-3;
/// Most twist that motion adds between neighbouring control points, rad: a quarter of a turn would show as a kink.
const MOST_TWIST: f64 = std::f64::consts::FRAC_PI_4;
/// Rigid motions that are tried, and cycles after which a cyclic motion is looked at again.
const RIGID: usize = 20;
const CYCLES: f64 = 100.0;
/// Rows of the table.
const ROWS: u64 = 12;

/// `measure motion`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// The model at rest.
    model: PathBuf,
    /// Frames of its motion: raw (`frames.f32`) or numbered files.
    #[arg(long, value_name = "FILE")]
    motion: Option<PathBuf>,
    /// Set a scene key. May be given more than once.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// Measures, prints the tables and whether the limits hold.
///
/// # Errors
/// Those of the scene and the device; a limit that does not hold.
pub fn run(stage: &Stage, options: &Options) -> Result<(), Error> {
    let scene = scene_of(&options.model, options.motion.as_ref(), &options.set)?;
    let mut movers = Movers::open(&scene)?;
    let mover = movers.0.first_mut();
    let mover = mover.ok_or_else(|| Error::Arguments("expected a model that moves, found none".into()))?;
    let strands = &scene.fabrics[mover.fabric].strands;
    let count = mover.frame_count();
    let lines = [format!("{} control points, {count} frames", strands.control_point_count)];
    print_head("Turns of fibers on yarn that moves", stage.device(), &lines);
    let mut verdicts = Verdicts::default();
    let rigid = rigid_motions(strands, mover.rest())?;
    verdicts.at_most("phase that a rigid motion adds, rad", rigid, MOST_ADDED);
    println!("- most phase that {RIGID} rigid motions add: {rigid:.2e} rad (at most {MOST_ADDED})");
    for dance in [Dance::Stretch, Dance::Wave] {
        let cycles = cycles(strands, mover.rest(), dance)?;
        verdicts.at_most("phase after 100 cycles, rad", cycles, MOST_ADDED);
        println!(
            "- {dance:?}, normals after {CYCLES} more cycles: {cycles:.2e} rad apart (at most {MOST_ADDED})"
        );
    }
    frames(strands, mover, &mut verdicts)?;
    motion_sky::run(stage, &scene, &mut movers, count - 1)?;
    verdicts.finish()
}

fn given(strands: &Strands) -> Vec<DVec3> {
    PointMap::new(strands).map(|map| map.given(&strands.points)).unwrap_or_default()
}

/// The pose of points as files hold them.
fn pose(rest: &RestPose, points: impl Iterator<Item = DVec3>) -> Result<Pose, Error> {
    let points: Vec<DVec3> = points.map(|p| p.as_vec3().as_dvec3()).collect();
    rest.pose(&points).ok_or_else(|| Error::Failed("expected a pose of as many points".into()))
}

/// The largest angle at a knot between two sets of normals.
fn apart(knots: &[bool], a: &[DVec3], b: impl Fn(usize) -> DVec3) -> f64 {
    let angle = |i: usize| a[i].cross(b(i)).length().atan2(a[i].dot(b(i)));
    (0..a.len()).filter(|i| knots[*i]).map(angle).fold(0.0, f64::max)
}

fn rigid_motions(strands: &Strands, rest: &RestPose) -> Result<f64, Error> {
    let (given, knots) = (given(strands), knots(strands));
    let mut rng = Rng::new(1, &[]);
    let mut worst: f64 = 0.0;
    for _ in 0..RIGID {
        let mut number = || 2.0 * rng.uniform() - 1.0;
        let axis = DVec3::new(number(), number(), number()).normalize();
        let turn = DQuat::from_axis_angle(axis, std::f64::consts::PI * number());
        let shift = 500.0 * DVec3::new(number(), number(), number());
        let pose = pose(rest, given.iter().map(|p| turn * *p + shift))?;
        worst = worst.max(apart(&knots, &pose.normals, |i| turn * strands.normals[i]));
    }
    Ok(worst)
}

fn cycles(strands: &Strands, rest: &RestPose, dance: Dance) -> Result<f64, Error> {
    let (given, knots) = (given(strands), knots(strands));
    let mut worst: f64 = 0.0;
    for share in [0.0, 0.13, 0.5, 0.77] {
        let at = |cycles: f64| pose(rest, danced(&given, dance, cycles).into_iter());
        let (now, later) = (at(share)?, at(share + CYCLES)?);
        worst = worst.max(apart(&knots, &now.normals, |i| later.normals[i]));
    }
    Ok(worst)
}

/// The table of added twist by frame, and the largest step from one frame to the next.
fn frames(strands: &Strands, mover: &mut Mover, verdicts: &mut Verdicts) -> Result<(), Error> {
    let rest = twists(strands, &strands.normals, &strands.knot_tangents());
    let knots = knots(strands);
    let count = mover.frame_count();
    println!("\nTwist added to a piece of yarn, from one control point to the next, against rest:\n");
    print_columns(&[
        "frame",
        "rms rad",
        "99% within",
        "99.9% within",
        "most",
        "piece",
        "curve",
        "at mm",
        "holds",
    ]);
    let mut before: Option<Pose> = None;
    let mut step = (0.0, 0, 0);
    for frame in 0..count {
        let pose = mover.pose_at(frame as f64)?;
        if let Some(before) = &before {
            for (place, angle) in phase_steps(&knots, before, &pose) {
                if angle > step.0 {
                    step = (angle, place, frame);
                }
            }
        }
        let now = twists(strands, &pose.normals, &pose.tangents);
        let added: Vec<f64> = now.iter().zip(&rest).map(|(now, rest)| wrapped(now - rest).abs()).collect();
        let worst = added.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        if let Some((piece, most)) = worst.map(|(piece, most)| (piece, *most)) {
            let holds = verdicts.at_most(&format!("added twist of frame {frame}, rad"), most, MOST_TWIST);
            if frame % count.div_ceil(ROWS) == 0 || frame + 1 == count {
                print_row(strands, frame, &added, piece, holds);
            }
        }
        before = Some(pose);
    }
    let (angle, place, frame) = step;
    let [start, _] = strands.knot_offsets();
    let piece = strands.pieces.iter().position(|piece| piece.first_point + start >= place);
    let piece = &strands.pieces[piece.unwrap_or(strands.pieces.len() - 1)];
    println!(
        "\n- largest turn of a normal about its yarn from one frame to the next, the cloth's own with it: {angle:.4} rad, \
         from frame {} to {frame}, curve {} at {:.1} mm",
        frame.saturating_sub(1),
        piece.curve,
        piece.length_start_mm
    );
    Ok(())
}

fn print_row(strands: &Strands, frame: u64, added: &[f64], worst: usize, holds: &str) {
    let mut sorted = added.to_vec();
    sorted.sort_by(f64::total_cmp);
    let within = |share: f64| sorted[((sorted.len() - 1) as f64 * share) as usize];
    let rms = (added.iter().map(|a| a * a).sum::<f64>() / added.len() as f64).sqrt();
    let piece = &strands.pieces[worst];
    println!(
        "| {frame} | {rms:.5} | {:.5} | {:.5} | {:.5} | {worst} | {} | {:.1} | {holds} |",
        within(0.99),
        within(0.999),
        within(1.0),
        piece.curve,
        piece.length_start_mm
    );
}
