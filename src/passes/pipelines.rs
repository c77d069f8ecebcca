//! Where all passes have their pipelines built: each once, with the driver's cache of compiled ones, and timed.

use crate::shaders::ShaderSet;
use crate::vulkan::{Device, Pipeline, PipelineCache, VulkanError};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Pipelines beyond which those that nothing uses any more are let go.
const MOST_UNUSED: usize = 64;

/// What building has come to so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Building {
    /// Pipelines built.
    pub count: u64,
    /// Time that it took, trimming their shaders included.
    pub taken: Duration,
}

/// A device's pipelines. Renderers that share them build alike ones once.
pub struct Pipelines {
    device: Arc<Device>,
    cache: Option<PipelineCache>,
    building: Mutex<Building>,
    built: Mutex<HashMap<String, Pipeline>>,
}

impl Pipelines {
    /// Built on this device; with a cache where one is given.
    pub fn new(device: &Arc<Device>, cache: Option<PipelineCache>) -> Self {
        Self { device: device.clone(), cache, building: Mutex::default(), built: Mutex::default() }
    }

    /// The device.
    pub fn device(&self) -> &Arc<Device> {
        &self.device
    }

    /// The driver's cache of compiled pipelines.
    pub fn cache(&self) -> Option<&PipelineCache> {
        self.cache.as_ref()
    }

    /// What building has come to so far.
    pub fn building(&self) -> Building {
        *locked(&self.building)
    }

    /// The pipeline called `what`, which says all that decides it; built where it is not there yet.
    fn get(
        &self,
        what: String,
        build: impl FnOnce() -> Result<Pipeline, VulkanError>,
    ) -> Result<Pipeline, VulkanError> {
        if let Some(found) = locked(&self.built).get(&what) {
            return Ok(found.clone());
        }
        let started = Instant::now();
        let pipeline = build()?;
        let mut building = locked(&self.building);
        building.count += 1;
        building.taken += started.elapsed();
        drop(building);
        let mut built = locked(&self.built);
        if built.len() >= MOST_UNUSED {
            built.retain(|_, pipeline| pipeline.is_shared());
        }
        built.insert(what, pipeline.clone());
        Ok(pipeline)
    }
}

/// What passes build their pipelines of, and where. Clones share the pipelines.
#[derive(Clone)]
pub struct Builder {
    /// Those that are there.
    pub pipelines: Arc<Pipelines>,
    /// What they are built of.
    pub shaders: ShaderSet,
}

impl Builder {
    /// The device.
    pub fn device(&self) -> &Arc<Device> {
        self.pipelines.device()
    }

    /// The SPIR-V words of the shader at `path` under `glsl/`.
    ///
    /// # Errors
    /// There is none of that name.
    pub fn words(&self, path: &str) -> Result<&[u32], VulkanError> {
        self.shaders.get(path).ok_or_else(|| VulkanError::misuse(format!("no embedded shader `{path}`")))
    }

    /// The pipeline of the shaders at these paths called `what`, which says all else that decides it; built where it is
    /// not there yet, with the cache that `build` is given.
    ///
    /// # Errors
    /// Those of building it; of shaders that are not embedded [`VulkanError::Shaders`], unless the device was lost.
    pub fn get(
        &self,
        what: &str,
        paths: &[&str],
        build: impl FnOnce(Option<&PipelineCache>) -> Result<Pipeline, VulkanError>,
    ) -> Result<Pipeline, VulkanError> {
        let Some(digest) = self.shaders.digest(paths) else {
            return self.pipelines.get(what.to_owned(), || build(self.pipelines.cache()));
        };
        // What is kept for the next run is of embedded shaders alone: nobody asks for these again.
        let built = self.pipelines.get(format!("{what} {digest:016x}"), || build(None));
        built.map_err(|error| match error {
            lost @ VulkanError::DeviceLost { .. } => lost,
            VulkanError::Misuse { what } => VulkanError::Shaders(what),
            other => VulkanError::Shaders(other.to_string()),
        })
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
