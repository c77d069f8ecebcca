//! Traced references, kept by what decides them: made once, never half-written, rebuilt where damaged.

use super::truth::{Floor, Progress, Truth, TruthSettings, trace};
use crate::error::Error;
use crate::io::cache::Cache;
use crate::io::error::FileError;
use crate::io::measured::MeasuredImage;
use crate::io::whole::write_whole;
use crate::math::digest::Digest;
use crate::reference::checkpoint;
use crate::reference::integrator::TraceSettings;
use crate::scene::Scene;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Goes up when references of the same key would differ from earlier ones.
const VERSION: u64 = 1;
/// The cache's part for references.
const PART: &str = "references";

/// What is kept beside the picture, and written after it.
#[derive(Debug, Serialize, Deserialize)]
struct Beside {
    size: [u32; 2],
    chord_error: f64,
    floors: Vec<Floor>,
    /// Of the picture.
    checksum: u64,
}

/// What names a reference: everything that decides its samples, and their numbers.
pub fn key(scene: &Scene, size: [u32; 2], settings: &TruthSettings) -> u64 {
    let mut bare = scene.clone();
    // What the tracer does not read, or reads as the fabrics' own parameters: the rest is in the key.
    let file = &mut bare.file;
    (file.shadow, file.occlusion, file.debug) = Default::default();
    (file.fabric, file.yarn, file.fiber) = Default::default();
    file.shading.extinction_scale = 1.0;
    let traced = checkpoint::key(&bare, size, 0.0, &TraceSettings::default());
    let mut digest = Digest(VERSION);
    digest.words([traced, settings.samples]);
    digest.words(settings.floors.iter().copied());
    digest.0
}

fn checksum(picture: &MeasuredImage) -> u64 {
    let mut digest = Digest(2);
    let bits = |values: &[f32]| values.iter().map(|v| u64::from(v.to_bits())).collect::<Vec<_>>();
    digest.words(bits(picture.mean.pixels.as_flattened()));
    digest.words(bits(picture.variance.as_deref().unwrap_or_default().as_flattened()));
    digest.0
}

/// Whether the reference is there already, and whole.
pub fn is_kept(cache: &Cache, key: u64) -> bool {
    read(cache, key).is_some()
}

/// The reference of the scene, from the cache or traced.
///
/// # Errors
/// Too many fibers; files that cannot be written; those of `progress`: the next time it goes on from there.
pub fn reference(
    cache: &Cache,
    scene: &Scene,
    size: [u32; 2],
    settings: &TruthSettings,
    progress: &mut Progress<'_>,
) -> Result<Truth, Error> {
    let key = key(scene, size, settings);
    if let Some(kept) =
        read(cache, key).filter(|kept| [kept.picture.mean.width, kept.picture.mean.height] == size)
    {
        return Ok(kept);
    }
    let part = cache.file(PART, &format!("{key:016x}.part"))?;
    let truth = trace(scene, size, settings, &part, progress)?;
    write(cache, key, &truth)?;
    remove(&part)?;
    Ok(truth)
}

fn names(key: u64) -> [String; 2] {
    ["exr", "json"].map(|extension| format!("{key:016x}.{extension}"))
}

fn read(cache: &Cache, key: u64) -> Option<Truth> {
    let [picture, beside] = names(key).map(|name| cache.path(PART, &name));
    let beside: Beside = serde_json::from_slice(&std::fs::read(beside).ok()?).ok()?;
    let picture = MeasuredImage::read(&picture).ok()?;
    let whole =
        checksum(&picture) == beside.checksum && [picture.mean.width, picture.mean.height] == beside.size;
    whole.then_some(Truth { picture, floors: beside.floors, chord_error: beside.chord_error })
}

fn write(cache: &Cache, key: u64, truth: &Truth) -> Result<(), Error> {
    let [picture, beside] = names(key);
    truth.picture.write(&cache.file(PART, &picture)?)?;
    let kept = Beside {
        size: [truth.picture.mean.width, truth.picture.mean.height],
        chord_error: truth.chord_error,
        floors: truth.floors.clone(),
        checksum: checksum(&truth.picture),
    };
    let text = serde_json::to_string_pretty(&kept).map_err(|e| Error::Failed(format!("reference: {e}")))?;
    Ok(write_whole(&cache.file(PART, &beside)?, |out| writeln!(out, "{text}"))?)
}

/// Removes what was kept of a reference that is done.
fn remove(part: &Path) -> Result<(), Error> {
    match std::fs::remove_file(part) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(FileError::io(part, "remove", &error).into())
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::cloth::{Cloth, Model};

    const SIZE: [u32; 2] = [32, 24];
    const SETTINGS: TruthSettings = TruthSettings { samples: 4, floors: Vec::new() };

    struct Place {
        folder: tempfile::TempDir,
        model: Model,
    }

    impl Place {
        fn new() -> Self {
            let folder = tempfile::tempdir().unwrap();
            let cloth = Cloth::Stockinette { wales: 2, courses: 2 };
            let model = Model::write(folder.path(), "worsted_3ply", cloth, Default::default()).unwrap();
            Self { folder, model }
        }

        fn scene(&self, sets: &[&str]) -> Scene {
            let thin = ["yarn.fibers_per_ply=4".to_owned()];
            let sets: Vec<String> = thin.into_iter().chain(sets.iter().map(|s| (*s).to_owned())).collect();
            Scene::load(&self.model.path, &sets).unwrap()
        }

        fn cache(&self) -> Cache {
            Cache::new(Some(&self.folder.path().join("cache"))).unwrap()
        }
    }

    #[test]
    fn what_changes_the_picture_changes_the_key_and_nothing_else_does() {
        let place = Place::new();
        let of = |sets: &[&str]| key(&place.scene(sets), SIZE, &SETTINGS);
        let usual = of(&[]);
        let same: [&[&str]; 8] = [
            &["shadow.map=false"],
            &["shadow.resolution=256"],
            &["occlusion.mode=none"],
            &["quality.level_of_detail=false"],
            &["debug.fibers=every"],
            &["display.exposure_stops=1"],
            &["shading.extinction_scale=2"],
            &["yarn.fibers_per_ply=4"],
        ];
        for sets in same {
            assert_eq!(of(sets), usual, "{sets:?}");
        }
        let others: [&[&str]; 9] = [
            &["seed=1"],
            &["yarn.fibers_per_ply=5"],
            &["fiber.c_r=[0.1, 0.1, 0.1]"],
            &["camera.yaw_deg=1"],
            &["light=[]"],
            &["ambient.radiance=[0.1, 0.1, 0.1]"],
            &["shading.diffuse=false"],
            &["shading.model=simple"],
            &["fabric.mm_per_unit=1.1"],
        ];
        for sets in others {
            assert_ne!(of(sets), usual, "{sets:?}");
        }
        let scene = place.scene(&[]);
        assert_ne!(key(&scene, [32, 25], &SETTINGS), usual);
        assert_ne!(key(&scene, SIZE, &TruthSettings { samples: 8, ..SETTINGS }), usual);
        assert_ne!(key(&scene, SIZE, &TruthSettings { floors: vec![1], ..SETTINGS }), usual);
    }

    #[test]
    fn a_reference_is_traced_once_and_a_damaged_one_again() {
        let (place, settings) = (Place::new(), TruthSettings { samples: 4, floors: vec![1, 4] });
        let (scene, cache) = (place.scene(&[]), place.cache());
        let get = || {
            let mut told = 0;
            let mut tell = |_| {
                told += 1;
                Ok(())
            };
            let truth = reference(&cache, &scene, SIZE, &settings, &mut tell).unwrap();
            (truth, told)
        };
        let (first, told) = get();
        assert!(told > 0 && is_kept(&cache, key(&scene, SIZE, &settings)));
        assert_eq!(first.floors.len(), 2);
        assert!(
            first.floors[0].flip > first.floors[1].flip && first.floors[1].flip > 0.0,
            "{:?}",
            first.floors
        );
        let (again, told) = get();
        assert_eq!((&again, told), (&first, 0));
        let [picture, beside] = names(key(&scene, SIZE, &settings)).map(|name| cache.path(PART, &name));
        for (file, bytes) in [(&picture, &b"no EXR"[..]), (&beside, b"{}"), (&beside, b"")] {
            std::fs::write(file, bytes).unwrap();
            let (rebuilt, told) = get();
            assert_eq!(rebuilt, first);
            assert!(told > 0, "{} was damaged", file.display());
        }
        // Another picture of the right size is not what was written.
        let mut other = first.picture.clone();
        other.mean.pixels[0][0] += 1.0;
        other.write(&picture).unwrap();
        assert!(get().1 > 0);
        assert_eq!(std::fs::read_dir(picture.parent().unwrap()).unwrap().count(), 2, "no part is left");
    }

    #[test]
    fn one_that_is_stopped_goes_on_where_it_was() {
        let (place, settings) = (Place::new(), TruthSettings { samples: 512, floors: Vec::new() });
        let (scene, cache) = (place.scene(&[]), place.cache());
        let mut stop = |share| if share > 0.4 { Err(Error::Failed("stopped".into())) } else { Ok(()) };
        let stopped = reference(&cache, &scene, SIZE, &settings, &mut stop).unwrap_err();
        assert_eq!(stopped.to_string(), "stopped");
        let mut shares = Vec::new();
        let mut tell = |share| {
            shares.push(share);
            Ok(())
        };
        let gone_on = reference(&cache, &scene, SIZE, &settings, &mut tell).unwrap();
        assert!(shares.first().is_some_and(|share| *share > 0.4), "{shares:?}");
        let other = Cache::new(Some(&place.folder.path().join("other"))).unwrap();
        assert_eq!(gone_on, reference(&other, &scene, SIZE, &settings, &mut |_| Ok(())).unwrap());
    }
}
