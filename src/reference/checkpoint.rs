//! Pictures in the making on disk: stopped at any moment, gone on with as if nothing had happened.

use super::integrator::TraceSettings;
use super::rendering::{PixelSums, Rendering, Tally};
use crate::io::error::{FileError, Place};
use crate::io::whole::write_whole;
use crate::math::digest::Digest;
use crate::scene::Scene;
use bytemuck::{Pod, Zeroable, bytes_of, cast_slice};
use std::path::{Path, PathBuf};

/// What a file begins with; the number goes up when anything that it holds, or a sample's value, changes.
const MAGIC: [u8; 16] = *b"worsted part 01\n";

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Header {
    magic: [u8; 16],
    key: u64,
    size: [u32; 2],
    tally: Tally,
    /// Of the pixels.
    checksum: u64,
}

/// What names a picture in the making: everything that decides its samples, but for their number.
pub fn key(scene: &Scene, size: [u32; 2], chord_error: f64, settings: &TraceSettings) -> u64 {
    let mut hash = Digest(0);
    let mut file = scene.file.clone();
    // Neither decides what a sample sees.
    file.display = Default::default();
    file.quality = Default::default();
    hash.text(&format!("{file:?} {size:?} {chord_error:?} {settings:?} {:?}", scene.origin_mm));
    for fabric in &scene.fabrics {
        hash.text(&format!("{:?} {:?} {:?}", fabric.yarn, fabric.fiber, fabric.strands.basis));
        hash.text(&format!("{:?}", fabric.strands.period_counts));
        for (point, normal) in fabric.strands.points.iter().zip(&fabric.strands.normals) {
            hash.words(point.to_array().into_iter().chain(normal.to_array()).map(f64::to_bits));
        }
        for piece in &fabric.strands.pieces {
            let turns = &piece.turns;
            let numbers = [turns.ply, turns.fiber, turns.migration].map(|t| [t.start, t.delta]);
            hash.words(numbers.as_flattened().iter().map(|n| n.to_bits()));
        }
    }
    if let Some(environment) = &scene.environment {
        hash.text(&format!("{} {}", environment.width, environment.height));
        hash.words(environment.pixels.as_flattened().iter().map(|v| u64::from(v.to_bits())));
    }
    hash.0
}

fn checksum(pixels: &[PixelSums]) -> u64 {
    let mut hash = Digest(1);
    hash.words(cast_slice::<PixelSums, u64>(pixels).iter().copied());
    hash.0
}

/// Where the picture in the making is kept that will be at `output`.
pub fn path_beside(output: &Path) -> PathBuf {
    let mut name = output.as_os_str().to_owned();
    name.push(".part");
    name.into()
}

/// Keeps a picture in the making, all of it or as it was.
///
/// # Errors
/// What the file system says.
pub fn save(path: &Path, key: u64, rendering: &Rendering) -> Result<(), FileError> {
    let (size, tally) = (rendering.size, rendering.tally);
    let header = Header { magic: MAGIC, key, size, tally, checksum: checksum(&rendering.pixels) };
    write_whole(path, |out| {
        out.write_all(bytes_of(&header))?;
        out.write_all(cast_slice(&rendering.pixels))
    })
}

/// The picture in the making at `path`, if there is one.
///
/// # Errors
/// A file that is none, is damaged, or is of another scene or other settings.
pub fn load(path: &Path, key: u64, size: [u32; 2]) -> Result<Option<Rendering>, FileError> {
    let wrong = |message: &str| {
        let advice = "remove it, or start afresh with --fresh";
        FileError::new(path, Place::File, format!("{message}: {advice}"))
    };
    let pixel_count = size[0] as usize * size[1] as usize;
    let expected = size_of::<Header>() + pixel_count * size_of::<PixelSums>();
    let found = match std::fs::metadata(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(FileError::io(path, "read", &error)),
        Ok(facts) => facts.len(),
    };
    let another = "expected the unfinished picture of this scene with these settings, found another";
    if found != expected as u64 {
        return Err(wrong(another));
    }
    let bytes = std::fs::read(path).map_err(|e| FileError::io(path, "read", &e))?;
    let Some((head, body)) = bytes.split_at_checked(size_of::<Header>()) else { return Err(wrong(another)) };
    let header: Header = bytemuck::pod_read_unaligned(head);
    if header.magic != MAGIC || header.key != key || header.size != size {
        return Err(wrong(another));
    }
    let pixels: Vec<PixelSums> =
        body.chunks_exact(size_of::<PixelSums>()).map(bytemuck::pod_read_unaligned).collect();
    if checksum(&pixels) != header.checksum || pixels.len() != pixel_count {
        return Err(wrong("expected the unfinished picture whole, found it damaged"));
    }
    Ok(Some(Rendering { size, pixels, tally: header.tally }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::accel::Accel;
    use crate::reference::fibers::realise;
    use crate::reference::geometry::FiberGeometry;
    use crate::reference::integrator::Tracer;
    use crate::reference::test_scene::{scene_of, straight, yarn};

    const SIZE: [u32; 2] = [40, 24];
    const SAMPLES: u64 = 10;

    fn scene(text: &str) -> Scene {
        scene_of(text, &[straight(0.0, 4.0, 0.0)], &yarn("cotton1", 12))
    }

    fn tracer(scene: &Scene) -> Tracer<f32> {
        let fibers = realise(scene, &Default::default()).unwrap();
        let accel = Accel::new(FiberGeometry::new(fibers, scene.origin_mm)).unwrap();
        Tracer::new(scene, accel, SIZE, TraceSettings::default())
    }

    fn finish(rendering: &mut Rendering, tracer: &Tracer<f32>, tiles: u64) {
        while !rendering.is_done(SAMPLES) {
            rendering.advance(tracer, SAMPLES, tiles);
        }
    }

    #[test]
    fn stopping_anywhere_and_going_on_gives_the_same_bytes() {
        let (folder, scene) = (tempfile::tempdir().unwrap(), scene("[camera]\ndistance_mm = 5"));
        let tracer = tracer(&scene);
        let key = key(&scene, SIZE, 0.1, &TraceSettings::default());
        let mut whole = Rendering::new(SIZE);
        finish(&mut whole, &tracer, 1000);
        assert_eq!((whole.samples(), whole.passes()), (SAMPLES, 3));
        let bytes = |rendering: &Rendering, name: &str| {
            let path = folder.path().join(name);
            rendering.measured().write(&path).unwrap();
            std::fs::read(path).unwrap()
        };
        let expected = bytes(&whole, "whole.exr");
        for stop in [1, 5, 6, 7, 17] {
            let path = folder.path().join("a.exr.part");
            let mut first = Rendering::new(SIZE);
            while first.tally.tiles < stop {
                first.advance(&tracer, SAMPLES, 1);
            }
            save(&path, key, &first).unwrap();
            let mut rest = load(&path, key, SIZE).unwrap().unwrap();
            assert_eq!(rest, first);
            finish(&mut rest, &tracer, 4);
            assert_eq!(rest, whole, "stopped after {stop} tiles");
            assert_eq!(bytes(&rest, "rest.exr"), expected, "stopped after {stop} tiles");
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let mut alone = Rendering::new(SIZE);
        pool.install(|| finish(&mut alone, &tracer, 3));
        assert_eq!(alone, whole, "one thread gives what all give");
    }

    #[test]
    fn what_decides_the_samples_decides_the_key_and_nothing_else() {
        let of = |text: &str, size: [u32; 2], chord: f64, settings: TraceSettings| {
            key(&scene(text), size, chord, &settings)
        };
        let default = TraceSettings::default();
        let usual = of("", SIZE, 0.1, default);
        assert_eq!(usual, of("", SIZE, 0.1, default));
        assert_eq!(usual, of("[display]\nexposure_stops = 2", SIZE, 0.1, default));
        let others = [
            of("seed = 2", SIZE, 0.1, default),
            of("[camera]\nyaw_deg = 1", SIZE, 0.1, default),
            of("", [40, 25], 0.1, default),
            of("", SIZE, 0.2, default),
            of("", SIZE, 0.1, TraceSettings { bounces: 1, ..default }),
            of("", SIZE, 0.1, TraceSettings { shadows: false, ..default }),
            key(&scene_of("", &[straight(0.0, 4.1, 0.0)], &yarn("cotton1", 12)), SIZE, 0.1, &default),
            key(&scene_of("", &[straight(0.0, 4.0, 0.0)], &yarn("cotton1", 13)), SIZE, 0.1, &default),
        ];
        assert!(others.iter().all(|other| *other != usual), "{others:?}");
    }

    #[test]
    fn what_is_another_picture_or_damaged_is_refused_in_one_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = path_beside(&folder.path().join("a.exr"));
        assert!(path.ends_with("a.exr.part") && load(&path, 7, SIZE).unwrap().is_none());
        save(&path, 7, &Rendering::new(SIZE)).unwrap();
        let good = std::fs::read(&path).unwrap();
        assert!(load(&path, 7, SIZE).unwrap().is_some());
        let refused = |key: u64, size: [u32; 2], bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            let error = load(&path, key, size).unwrap_err().to_string();
            assert!(error.contains("--fresh") && !error.contains('\n'), "{error}");
            error
        };
        assert!(refused(8, SIZE, &good).contains("found another"));
        assert!(refused(7, [24, 40], &good).contains("found another"));
        assert!(refused(7, [20, 40], &good).contains("found another"));
        assert!(refused(7, SIZE, &good[..good.len() - 8]).contains("found another"));
        assert!(refused(7, SIZE, b"").contains("found another"));
        let mut damaged = good.clone();
        damaged[good.len() / 2] ^= 1;
        assert!(refused(7, SIZE, &damaged).contains("damaged"));
    }
}
