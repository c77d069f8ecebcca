//! What leaving something out saves: a scene that needs everything, drawn by turns with it and without.

use super::clock::timed;
use super::cloth::{Cloth, Model};
use super::views::{ViewKind, views};
use crate::error::Error;
use crate::frame::sampling::Sampling;
use crate::frame::{Renderer, Request};
use crate::io::error::FileError;
use crate::math::spread::Spread;
use crate::scene::Scene;
use crate::vulkan::{Device, Taken};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

const YARN: &str = "worsted_3ply";
/// What a scene has that leaves nothing out but a picture of the sky, which is a file, and layers, which are no part of the
/// picture (docs/animation.md has what they cost): a soft light and a point light.
const EVERYTHING: &[&str] = &["light=[{direction=[0.6, -0.7, -0.4], angular_size_deg=2}, \
     {kind='point', position_mm=[40, 60, 80], intensity=[0.02, 0.02, 0.02]}]"];

/// Something that may be left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Omission {
    /// Its name in [`crate::frame::stats::Stats::left_out`].
    pub name: &'static str,
    /// Assignments that leave it out; none where nobody asks for it, as for statistics.
    pub sets: &'static [&'static str],
}

/// Everything that may be left out one by one.
pub const OMISSIONS: &[Omission] = &[
    Omission { name: "statistics", sets: &[] },
    Omission { name: "shadow_map", sets: &["shadow.map=false"] },
    Omission {
        name: "soft_shadows",
        sets: &["light=[{direction=[0.6, -0.7, -0.4]}, \
                 {kind='point', position_mm=[40, 60, 80], intensity=[0.02, 0.02, 0.02]}]"],
    },
    Omission { name: "local_lights", sets: &["light=[{direction=[0.6, -0.7, -0.4], angular_size_deg=2}]"] },
    Omission { name: "self_shadow", sets: &["shadow.self=false"] },
    Omission { name: "ambient", sets: &["shading.ambient=false"] },
    Omission { name: "occlusion", sets: &["occlusion.mode='none'"] },
    Omission { name: "yarn_occlusion", sets: &["occlusion.yarns=false"] },
    Omission { name: "scattering_tables", sets: &["shading.model='simple'"] },
    Omission { name: "specular", sets: &["shading.specular=false"] },
    Omission { name: "diffuse", sets: &["shading.diffuse=false"] },
    Omission { name: "flyaways", sets: &["yarn.hair_density_per_mm=0", "yarn.loop_density_per_mm=0"] },
    Omission { name: "core_fibers", sets: &["debug.fibers='every'"] },
    Omission { name: "level_of_detail", sets: &["quality.level_of_detail=false"] },
    Omission { name: "vertex_shading", sets: &["quality.vertex_shaded_samples=0.0"] },
    Omission { name: "culling", sets: &["quality.culling=false"] },
];

/// A scene that is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subject {
    /// What it is called.
    pub name: &'static str,
    cloth: Cloth,
    view: ViewKind,
}

/// The three scenes.
pub const SUBJECTS: [Subject; 3] = [
    Subject { name: "a yarn, close", cloth: Cloth::Straight, view: ViewKind::Close },
    Subject {
        name: "a swatch, close",
        cloth: Cloth::Stockinette { wales: 8, courses: 10 },
        view: ViewKind::Close,
    },
    Subject { name: "a tube, whole", cloth: Cloth::Tube { wales: 24, courses: 16 }, view: ViewKind::Full },
];

/// What one omission was measured to save in one scene; below 0 it costs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Saving {
    /// The scene.
    pub scene: &'static str,
    /// What is left out.
    pub omission: &'static str,
    /// Time of a picture with everything, ms: the device's own, or processor time on a CPU device.
    pub with_ms: Spread,
    /// Time of a picture without it, ms.
    pub without_ms: Spread,
    /// Time without it as a share of the time with everything, of pictures drawn in turns.
    pub ratio: Spread,
    /// Device memory, bytes.
    pub saved_bytes: i64,
    /// Time to bake the tables that it alone needs, ms.
    pub saved_bake_ms: f64,
}

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Pictures of either kind, after one to warm up.
    pub frames: u32,
}

/// A renderer with the device memory that it takes and the time that each of its tables took.
struct Built {
    renderer: Renderer,
    bytes: u64,
    bake_ms: BTreeMap<String, f64>,
}

fn build(
    device: &Arc<Device>,
    path: &Path,
    sets: &[String],
    size: [u32; 2],
    statistics: bool,
) -> Result<Built, Error> {
    let held = |device: &Device| device.memory_bytes().values().sum::<u64>();
    let before = held(device);
    let sampling = Sampling::new(1).map_err(Error::Failed)?;
    let request = Request { size, sampling, statistics, profile: false };
    let mut renderer = Renderer::new(device, Scene::load(path, sets)?, request)?;
    // Pipelines are built, and the driver's own caches filled.
    renderer.render(&|_| ())?;
    let bake_ms = renderer.stats().precompute_ms.clone();
    Ok(Built { bytes: held(device).saturating_sub(before), renderer, bake_ms })
}

/// Milliseconds of one picture.
fn picture_ms(renderer: &mut Renderer) -> Result<f64, Error> {
    let (_, seconds) = timed(|| renderer.render(&|_| ()))?;
    let taken = renderer.stats().last_frame().unwrap_or(Taken::NOTHING);
    let own = taken.device.map(|device| 1e3 * device.as_secs_f64());
    let cpu = if seconds.cpu.is_finite() { seconds.cpu } else { seconds.wall };
    Ok(own.unwrap_or(1e3 * cpu))
}

/// Measures every omission in every scene; `progress` is told the share done and what is next.
///
/// # Errors
/// Those of the device and of files.
pub fn ablate(
    device: &Arc<Device>,
    effort: Effort,
    omissions: &[Omission],
    progress: &mut dyn FnMut(f64, &str),
) -> Result<Vec<Saving>, Error> {
    let folder = tempfile::tempdir().map_err(|e| FileError::io(&std::env::temp_dir(), "write", &e))?;
    let all = (SUBJECTS.len() * omissions.len()) as f64;
    let mut savings = Vec::new();
    for subject in SUBJECTS {
        let model = Model::write(folder.path(), YARN, subject.cloth, toml::Table::new())?;
        let everything: Vec<String> = EVERYTHING.iter().map(|set| (*set).to_owned()).collect();
        let mut sets = everything.clone();
        let views = views(&model.path, &everything, effort.size, &[subject.view])?;
        sets.extend(views.into_iter().flat_map(|view| view.sets));
        let mut with = build(device, &model.path, &sets, effort.size, true)?;
        for omission in omissions {
            progress(savings.len() as f64 / all, &format!("{} without {}", subject.name, omission.name));
            savings.push(saving(device, effort, (subject.name, &model.path, &sets), omission, &mut with)?);
        }
    }
    Ok(savings)
}

fn saving(
    device: &Arc<Device>,
    effort: Effort,
    (scene, path, sets): (&'static str, &Path, &[String]),
    omission: &Omission,
    with: &mut Built,
) -> Result<Saving, Error> {
    let more = omission.sets.iter().map(|set| (*set).to_owned());
    let sets: Vec<String> = sets.iter().cloned().chain(more).collect();
    let statistics = !omission.sets.is_empty();
    let mut without = build(device, path, &sets, effort.size, statistics)?;
    if !without.renderer.stats().left_out.contains_key(omission.name) {
        return Err(Error::Failed(format!("{scene}: {} is not left out", omission.name)));
    }
    let (mut with_ms, mut without_ms, mut ratio) = (Vec::new(), Vec::new(), Vec::new());
    for frame in 0..effort.frames {
        // Neither is always the first.
        let (a, b) = if frame % 2 == 0 {
            let a = picture_ms(&mut with.renderer)?;
            (a, picture_ms(&mut without.renderer)?)
        } else {
            let b = picture_ms(&mut without.renderer)?;
            (picture_ms(&mut with.renderer)?, b)
        };
        with_ms.push(a);
        without_ms.push(b);
        ratio.push(b / a);
    }
    // Of the same tables the times differ by chance alone.
    let baked = with.bake_ms.iter().filter(|(name, _)| !without.bake_ms.contains_key(*name));
    let spread = |measured: &[f64]| Spread::of(measured).unwrap_or_default();
    Ok(Saving {
        scene,
        omission: omission.name,
        with_ms: spread(&with_ms),
        without_ms: spread(&without_ms),
        ratio: spread(&ratio),
        saved_bytes: with.bytes as i64 - without.bytes as i64,
        saved_bake_ms: baked.fold(0.0, |sum, (_, ms)| sum + ms),
    })
}

/// The savings as a Markdown table.
pub fn table(savings: &[Saving]) -> String {
    let mut lines = vec![
        "| scene | left out | ms with everything | ms without | saved ms | time without / with | saved bytes | saved ms of baking |"
            .to_owned(),
        "|---|---|---|---|---|---|---|---|".to_owned(),
    ];
    lines.extend(savings.iter().map(|saving| {
        let Saving { with_ms, without_ms, ratio, .. } = saving;
        format!(
            "| {} | {} | {:.1} | {:.1} | {:.1} | {:.2} ({:.2} to {:.2}) | {} | {:.1} |",
            saving.scene,
            saving.omission,
            with_ms.median,
            without_ms.median,
            with_ms.median - without_ms.median,
            ratio.median,
            ratio.min,
            ratio.max,
            saving.saved_bytes,
            saving.saved_bake_ms,
        )
    }));
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::features::Features;

    fn left_out(sets: &[&str], statistics: bool) -> Vec<&'static str> {
        let folder = tempfile::tempdir().unwrap();
        let cloth = Cloth::Stockinette { wales: 2, courses: 2 };
        let model = Model::write(folder.path(), YARN, cloth, toml::Table::new()).unwrap();
        let sets: Vec<String> = EVERYTHING.iter().chain(sets).map(|set| (*set).to_owned()).collect();
        let scene = Scene::load(&model.path, &sets).unwrap();
        Features::new(&scene.file, &scene.fabrics[0], statistics).left_out().into_keys().collect()
    }

    #[test]
    fn everything_is_there_and_each_omission_leaves_out_what_it_says() {
        assert_eq!(left_out(&[], true), ["environment", "id_layer", "motion_layer", "swift_turns"]);
        for omission in OMISSIONS {
            let out = left_out(omission.sets, !omission.sets.is_empty());
            assert!(out.contains(&omission.name), "{}: {out:?}", omission.name);
        }
    }

    #[test]
    fn the_table_has_a_row_for_each() {
        let spread = |median| Spread { median, min: median, max: median, frames: 3 };
        let saving = Saving {
            scene: "a yarn",
            omission: "shadow_map",
            with_ms: spread(10.0),
            without_ms: spread(4.0),
            ratio: spread(0.4),
            saved_bytes: -8,
            saved_bake_ms: 1.25,
        };
        let table = table(&[saving]);
        let expected = "| a yarn | shadow_map | 10.0 | 4.0 | 6.0 | 0.40 (0.40 to 0.40) | -8 | 1.2 |";
        assert_eq!(table.lines().last(), Some(expected));
        assert_eq!(table.lines().count(), 3);
    }
}
