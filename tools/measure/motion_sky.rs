//! What it costs that the sky above moving yarn is that of rest, turned with the cloth, and not looked at again.

use crate::report::print_columns;
use crate::stage::{Stage, request, shoot};
use half::f16;
use worsted::error::Error;
use worsted::frame::Renderer;
use worsted::frame::moving::turned_skies;
use worsted::motion::mover::Movers;
use worsted::precompute::optical_depth::CrossSection;
use worsted::precompute::shadow_radius::shadow_radius_mm;
use worsted::precompute::sky::{SkyYarns, bake_skies};
use worsted::scene::{Fabric, Scene};
use worsted::yarn::density::extinction_per_mm;

const SIZE: [u32; 2] = [320, 240];
const SAMPLES: u32 = 4;

/// Prints how far the turned sky of a frame is from one that is baked for it, point by point and in a picture.
///
/// # Errors
/// Those of the scene and the device.
pub fn run(stage: &Stage, scene: &Scene, movers: &mut Movers, frame: u64) -> Result<(), Error> {
    let mut scene = scene.clone();
    movers.fix_camera(&mut scene, SIZE)?;
    let mut put = scene.clone();
    movers.put(&mut put, frame as f64)?;
    let (rest, baked) = (baked(&scene), baked(&put));
    let mover = &mut movers.0[0];
    let pose = mover.pose_at(frame as f64)?;
    let turned = turned_skies(&rest[mover.fabric], &pose.rotations);
    let errors = |skies: &[[f16; 4]]| difference(skies, &baked[mover.fabric]);
    println!("\nThe sky of frame {frame}, against one that is baked for it:\n");
    print_columns(&["sky", "open share, mean", "rms error of it", "rms error of the slope"]);
    for (name, skies) in [("at rest, turned", &turned), ("at rest, not turned", &rest[mover.fabric])] {
        let [mean, share, slope] = errors(skies);
        println!("| {name} | {mean:.4} | {share:.4} | {slope:.4} |");
    }

    let request = request(SIZE, SAMPLES, false)?;
    let mut again = Renderer::new(stage.device(), put, request)?;
    let mut turned = Renderer::new(stage.device(), scene.clone(), request)?;
    let moved = std::mem::take(movers);
    let mut poser = turned.poser(moved, std::iter::once(frame as f64));
    if let Some(mut posed) = poser.next_frame()? {
        turned.pose(&mut posed)?;
    }
    let (ours, truth) = (shoot(&mut turned)?, shoot(&mut again)?);
    let flip = ours.displayed_flip(&truth)?;
    println!(
        "\n- picture of {} x {} pixels, {SAMPLES} samples: FLIP {flip:.4} to one with a sky that is baked for it",
        SIZE[0], SIZE[1]
    );
    Ok(())
}

fn baked(scene: &Scene) -> Vec<Vec<[f16; 4]>> {
    let scale = scene.file.shading.extinction_scale;
    bake_skies(&scene.fabrics.iter().map(|fabric| yarns(fabric, scale)).collect::<Vec<_>>())
}

fn yarns(fabric: &Fabric, extinction_scale: f64) -> SkyYarns<'_> {
    let extinction = extinction_scale * extinction_per_mm(&fabric.yarn);
    SkyYarns {
        strands: &fabric.strands,
        hiding_radius_mm: shadow_radius_mm(&CrossSection::new(&fabric.yarn), extinction),
        outer_radius_mm: fabric.yarn.outer_radius_mm(),
    }
}

/// Mean of what is open in truth, and rms of how far the share and the slope are from it.
fn difference(skies: &[[f16; 4]], truth: &[[f16; 4]]) -> [f64; 3] {
    let count = skies.len() as f64;
    let mut sums = [0.0; 3];
    for (sky, truth) in skies.iter().zip(truth) {
        let apart: [f64; 4] = std::array::from_fn(|i| sky[i].to_f64() - truth[i].to_f64());
        sums[0] += truth[0].to_f64();
        sums[1] += apart[0] * apart[0];
        sums[2] += apart[1..].iter().map(|a| a * a).sum::<f64>();
    }
    [sums[0] / count, (sums[1] / count).sqrt(), (sums[2] / count).sqrt()]
}
