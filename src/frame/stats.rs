//! What `--stats` reports. The keys are stable.

use super::savings::saved_bakes;
use super::{Milliseconds, Request, ms};
use crate::gpu_types::{RADIANCE_MAX, Statistics};
pub use crate::math::spread::Spread;
use crate::passes::pipelines::Building;
use crate::scene::Scene;
use crate::scene::features::Features;
use crate::vulkan::{Device, Taken};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;
use std::time::Duration;

/// A picture's statistics, in the units of the keys' names.
#[derive(Clone, Debug, Serialize)]
pub struct Stats {
    /// Device name.
    pub device: String,
    /// Driver and version.
    pub driver: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel.
    pub samples: u32,
    /// Control points of all fabrics, as given.
    pub control_points: u64,
    /// Cubic pieces of yarn.
    pub yarn_segments: u64,
    /// Fibers of every piece of yarn: pieces times fibers.
    pub fiber_curves: u64,
    /// Straight pieces of fiber drawn in one frame; only when counted.
    pub fiber_segments: Option<u64>,
    /// Triangles drawn in one frame.
    pub triangles: Option<u64>,
    /// Pieces of yarn drawn in one frame.
    pub patches_drawn: Option<u64>,
    /// Pieces of yarn outside the picture.
    pub patches_culled: Option<u64>,
    /// Of those drawn, how many have fibers that are cut less finely than `quality.subdivision_tolerance_px` asks for:
    /// `quality.max_subdivisions` limits them.
    pub patches_coarse: Option<u64>,
    /// Of those drawn, how many lie so nearly along a light with a shadow (within atan 1/24) that their own yarn's tube may
    /// shadow them.
    pub patches_along_light: Option<u64>,
    /// Of those drawn, how many are so far from where a wide light's shadow begins that its edge may be wider than the 24
    /// texels over which it is looked up.
    pub patches_softer_than_searched: Option<u64>,
    /// Wall time of whole pictures on the device.
    pub frame_ms: Spread,
    /// The same by the device's own clock, where it has one.
    pub device_ms: Option<Spread>,
    /// Mean time of each pass per picture; only when profiled.
    pub passes: Milliseconds,
    /// How `passes` was timed.
    pub timing_method: Option<&'static str>,
    /// Loading the scene's fabrics: reading, finding out the unit, making yarns ready, and the upload.
    pub load_ms: Milliseconds,
    /// Work done once before the first picture.
    pub precompute_ms: Milliseconds,
    /// What of that was read from the cache.
    pub precompute_from_cache: BTreeSet<String>,
    /// Time that building pipelines took.
    pub pipelines_ms: f64,
    /// Pipelines built.
    pub pipelines_built: u64,
    /// What the driver was given of an earlier run, in bytes; none where nothing was kept.
    pub pipelines_from_cache_bytes: Option<u64>,
    /// Device memory by name.
    pub gpu_bytes: BTreeMap<String, u64>,
    /// The most memory that the process held so far, what a CPU device holds included; where the system says it.
    pub host_peak_bytes: Option<u64>,
    /// What the scene does not need, and why.
    pub left_out: BTreeMap<String, String>,
    /// Bytes of device memory that it would take, where it is more than code.
    pub left_out_bytes: BTreeMap<String, u64>,
    /// Milliseconds that its tables would take to bake, as others of their kind last did on this machine; only where the
    /// cache knows.
    pub left_out_bake_ms: Milliseconds,
    /// What the last picture did without, and why.
    pub left_out_of_frame: BTreeMap<String, String>,
    /// Pixels that are not a number or infinite.
    pub nan_pixels: u64,
    /// Pixels with a value that was clamped on its way.
    pub clamped_pixels: u64,
    #[serde(skip)]
    frames: Vec<Taken>,
}

impl Stats {
    /// What is known before the first picture.
    pub fn new(device: &Arc<Device>, scene: &Scene, request: &Request) -> Self {
        let sum = |count: &dyn Fn(&crate::scene::Fabric) -> u64| scene.fabrics.iter().map(count).sum();
        Self {
            device: device.name().to_owned(),
            driver: device.driver().to_owned(),
            size: request.size,
            samples: request.sampling.count(),
            control_points: sum(&|f| f.strands.control_point_count as u64),
            yarn_segments: sum(&|f| f.strands.pieces.len() as u64),
            fiber_curves: sum(&|f| f.strands.pieces.len() as u64 * u64::from(f.yarn.fiber_count())),
            fiber_segments: None,
            triangles: None,
            patches_drawn: None,
            patches_culled: None,
            patches_coarse: None,
            patches_along_light: None,
            patches_softer_than_searched: None,
            frame_ms: Spread::default(),
            device_ms: None,
            passes: BTreeMap::new(),
            timing_method: None,
            load_ms: load_ms(scene),
            precompute_ms: BTreeMap::new(),
            precompute_from_cache: BTreeSet::new(),
            pipelines_ms: 0.0,
            pipelines_built: 0,
            pipelines_from_cache_bytes: None,
            gpu_bytes: BTreeMap::new(),
            host_peak_bytes: None,
            left_out: BTreeMap::new(),
            left_out_bytes: BTreeMap::new(),
            left_out_bake_ms: BTreeMap::new(),
            left_out_of_frame: BTreeMap::new(),
            nan_pixels: 0,
            clamped_pixels: 0,
            frames: Vec::new(),
        }
    }

    /// Takes note of a table; where several fabrics have one, it is from the cache if all are.
    pub(super) fn add_precompute(&mut self, name: &str, taken: Duration, from_cache: bool) {
        let first = !self.precompute_ms.contains_key(name);
        *self.precompute_ms.entry(name.to_owned()).or_default() += ms(taken);
        if !from_cache {
            self.precompute_from_cache.remove(name);
        } else if first {
            self.precompute_from_cache.insert(name.to_owned());
        }
    }

    /// Takes note of what pictures are to be.
    pub(super) fn set_request(&mut self, request: &Request) {
        (self.size, self.samples) = (request.size, request.sampling.count());
    }

    /// Forgets the times of earlier pictures, for those of the next alone.
    pub fn forget_pictures(&mut self) {
        self.frames.clear();
        self.passes.clear();
    }

    /// Takes note of the upload of a fabric.
    pub(super) fn add_upload(&mut self, taken: Duration) {
        *self.load_ms.entry("upload".to_owned()).or_default() += ms(taken);
    }

    /// Takes note of the pipelines.
    pub(super) fn set_pipelines(&mut self, building: Building, found_bytes: Option<u64>) {
        self.pipelines_ms = ms(building.taken);
        self.pipelines_built = building.count;
        self.pipelines_from_cache_bytes = found_bytes;
    }

    /// Takes note of what a fabric of these features leaves out; `saved` knows the bytes.
    pub(super) fn add_left_out(&mut self, features: &Features, saved: impl Fn(&str) -> Option<u64>) {
        for (what, why) in features.left_out() {
            self.left_out.insert(what.to_owned(), why.to_owned());
            if let Some(bytes) = saved(what) {
                let sum = self.left_out_bytes.entry(what.to_owned()).or_default();
                // Each fabric has its own, but for what the frame has once.
                let shared = matches!(what, "shadow_map" | "statistics");
                *sum = if shared { bytes } else { *sum + bytes };
            }
        }
    }

    /// Takes note of how long the tables that are left out took when they were last baked; `last_ms` knows.
    pub(super) fn add_left_out_bakes(&mut self, last_ms: impl Fn(&str) -> Option<f64>) {
        let known = |what: &String| {
            let sum: f64 = saved_bakes(what).iter().filter_map(|name| last_ms(name)).sum();
            (sum > 0.0).then(|| (what.clone(), sum))
        };
        self.left_out_bake_ms = self.left_out.keys().filter_map(known).collect();
    }

    /// Takes note of what the last picture does without.
    pub(super) fn add_left_out_of_frame(&mut self, entries: impl Iterator<Item = (String, String)>) {
        self.left_out_of_frame.extend(entries);
    }

    /// Takes note of what was counted; `unseen` pieces of yarn never came to the device.
    pub(super) fn set_counts(&mut self, counted: Vec<Statistics>, unseen: u64) {
        let Some(counted) = counted.first() else { return };
        let segments = counted.fiber_segments();
        self.fiber_segments = Some(segments);
        // The geometry stage widens each straight piece into a strip of two triangles.
        self.triangles = Some(2 * segments);
        self.patches_drawn = Some(counted.patches_drawn.into());
        self.patches_culled = Some(u64::from(counted.patches_culled) + unseen);
        self.patches_coarse = Some(counted.patches_coarse.into());
        self.patches_along_light = Some(counted.patches_along_light.into());
        self.patches_softer_than_searched = Some(counted.patches_softer_than_searched.into());
    }

    pub(super) fn add_frame(&mut self, taken: Taken, passes: HashMap<&'static str, Duration>) {
        self.frames.push(taken);
        let wall: Vec<f64> = self.frames.iter().map(|taken| ms(taken.wall)).collect();
        let device: Option<Vec<f64>> = self.frames.iter().map(|taken| taken.device.map(ms)).collect();
        self.frame_ms = Spread::of(&wall).unwrap_or_default();
        self.device_ms = device.and_then(|device| Spread::of(&device));
        let count = self.frames.len();
        for (name, taken) in passes {
            let mean = self.passes.entry(name.to_owned()).or_default();
            *mean += (ms(taken) - *mean) / count as f64;
            self.timing_method = Some("one submission per pass, wall time to its fence");
        }
    }

    /// What the last picture took.
    pub fn last_frame(&self) -> Option<Taken> {
        self.frames.last().copied()
    }

    /// Counts what must not be in a picture's linear pixels, whose light was drawn `light_scale` times as strong.
    pub fn inspect(&mut self, pixels: &[[f32; 4]], light_scale: f64) {
        let most = (f64::from(RADIANCE_MAX) / light_scale) as f32;
        let bad = |p: &[f32; 4]| !p.iter().all(|c| c.is_finite());
        let clamped = |p: &[f32; 4]| p.iter().any(|c| !c.is_nan() && !(0.0..most).contains(c));
        (self.nan_pixels, self.clamped_pixels) = (0, 0);
        // All but a few pixels, if any, are neither: one look is enough for those. What is no number is in no range.
        let odd = |p: &&[f32; 4]| !p.iter().fold(true, |all, c| all & (0.0..most).contains(c));
        for pixel in pixels.iter().filter(odd) {
            self.nan_pixels += u64::from(bad(pixel));
            self.clamped_pixels += u64::from(clamped(pixel));
        }
    }

    /// Takes note of the device's memory.
    pub fn set_gpu_bytes(&mut self, device: &Device) {
        self.gpu_bytes = device.memory_bytes();
    }
}

/// What loading each of a scene's fabrics took, together.
fn load_ms(scene: &Scene) -> Milliseconds {
    let mut sums = Milliseconds::new();
    for load in scene.fabrics.iter().map(|fabric| fabric.load) {
        for (what, taken) in [("read", load.read), ("unit", load.unit), ("yarns", load.yarns)] {
            *sums.entry(what.to_owned()).or_default() += ms(taken);
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_and_clamped_pixels_are_counted() {
        let pixels = vec![
            [0.0; 4],
            [f32::NAN, 0.0, 0.0, 1.0],
            [f32::INFINITY, 0.0, 0.0, 1.0],
            [-0.1, 0.0, 0.0, 1.0],
            [7e4, 0.0, 0.0, 1.0],
            [1.0; 4],
        ];
        let mut stats = Stats::for_tests();
        stats.inspect(&pixels, 1.0);
        assert_eq!((stats.nan_pixels, stats.clamped_pixels), (2, 3));
        // Drawn an eighth as strong, eight times as much fits.
        stats.inspect(&pixels, 0.125);
        assert_eq!((stats.nan_pixels, stats.clamped_pixels), (2, 2));
    }

    #[test]
    fn frame_times_give_median_and_spread() {
        let mut stats = Stats::for_tests();
        for milliseconds in [30, 10, 20, 40] {
            let wall = Duration::from_millis(milliseconds);
            stats.add_frame(Taken { wall, device: Some(wall / 2) }, HashMap::new());
        }
        assert_eq!(stats.frame_ms, Spread { median: 25.0, min: 10.0, max: 40.0, frames: 4 });
        assert_eq!(stats.device_ms, Some(Spread { median: 12.5, min: 5.0, max: 20.0, frames: 4 }));
        stats.add_frame(Taken { wall: Duration::ZERO, device: None }, HashMap::new());
        assert_eq!(stats.device_ms, None, "of some pictures only");
    }

    impl Stats {
        fn for_tests() -> Self {
            Self {
                device: String::new(),
                driver: String::new(),
                size: [6, 1],
                samples: 1,
                control_points: 0,
                yarn_segments: 0,
                fiber_curves: 0,
                fiber_segments: None,
                triangles: None,
                patches_drawn: None,
                patches_culled: None,
                patches_coarse: None,
                patches_along_light: None,
                patches_softer_than_searched: None,
                frame_ms: Spread::default(),
                device_ms: None,
                passes: BTreeMap::new(),
                timing_method: None,
                load_ms: BTreeMap::new(),
                precompute_ms: BTreeMap::new(),
                precompute_from_cache: BTreeSet::new(),
                pipelines_ms: 0.0,
                pipelines_built: 0,
                pipelines_from_cache_bytes: None,
                gpu_bytes: BTreeMap::new(),
                host_peak_bytes: None,
                left_out: BTreeMap::new(),
                left_out_bytes: BTreeMap::new(),
                left_out_bake_ms: BTreeMap::new(),
                left_out_of_frame: BTreeMap::new(),
                nan_pixels: 0,
                clamped_pixels: 0,
                frames: Vec::new(),
            }
        }
    }
}
