//! Where all passes have their pipelines built: with the driver's cache of compiled ones, and timed.

use crate::vulkan::{Device, Pipeline, PipelineCache, VulkanError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// What building has come to so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Building {
    /// Pipelines built.
    pub count: u64,
    /// Time that it took, trimming their shaders included.
    pub taken: Duration,
}

/// A device's pipelines.
pub struct Pipelines {
    device: Arc<Device>,
    cache: Option<PipelineCache>,
    building: Mutex<Building>,
}

impl Pipelines {
    /// Built on this device; with a cache where one is given.
    pub fn new(device: &Arc<Device>, cache: Option<PipelineCache>) -> Self {
        Self { device: device.clone(), cache, building: Mutex::default() }
    }

    /// The device.
    pub fn device(&self) -> &Arc<Device> {
        &self.device
    }

    /// What pipelines are to be built with.
    pub fn cache(&self) -> Option<&PipelineCache> {
        self.cache.as_ref()
    }

    /// What building has come to so far.
    pub fn building(&self) -> Building {
        *self.building.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Builds one, and takes note of the time.
    ///
    /// # Errors
    /// Those of building it.
    pub fn timed(
        &self,
        build: impl FnOnce() -> Result<Pipeline, VulkanError>,
    ) -> Result<Pipeline, VulkanError> {
        let started = Instant::now();
        let built = build()?;
        let mut building = self.building.lock().unwrap_or_else(PoisonError::into_inner);
        building.count += 1;
        building.taken += started.elapsed();
        Ok(built)
    }
}
