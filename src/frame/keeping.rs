//! What one run leaves to the next: baked tables, and pipelines as the driver compiled them.

use crate::io::kept::{Kept, Key};
use crate::passes::pipelines::{Builder, Building, Pipelines};
use crate::precompute::stored::{BAKERS, Stored};
use crate::shaders::{self, ShaderSet};
use crate::vulkan::{Device, PipelineCache, VulkanError};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Parts of the cache.
const BAKES: &str = "bakes";
const PIPELINES: &str = "pipelines";
const TIMES: &str = "times";

/// What getting one table took.
#[derive(Clone, Debug)]
pub struct Baked {
    /// Its name.
    pub name: String,
    /// How long it took.
    pub taken: Duration,
    /// Whether it was read.
    pub from_cache: bool,
}

/// Bakes tables, or reads those that an earlier run baked of the same inputs.
pub struct Bakery<'a> {
    kept: &'a Kept,
    /// What that took, table by table.
    pub baked: Vec<Baked>,
}

impl<'a> Bakery<'a> {
    /// That keeps there what it bakes.
    pub fn new(kept: &'a Kept) -> Self {
        Self { kept, baked: Vec::new() }
    }

    /// The table called `name`, of what `inputs` adds to its key.
    pub fn table<T: Stored>(
        &mut self,
        name: &str,
        inputs: impl FnOnce(Key) -> Key,
        bake: impl FnOnce() -> T,
    ) -> T {
        let started = Instant::now();
        let key = self.kept.is_on().then(|| inputs(Key::new(name, BAKERS)));
        let found = key.as_ref().and_then(|key| T::from_bytes(&self.kept.get(BAKES, key)?));
        let from_cache = found.is_some();
        let table = found.unwrap_or_else(bake);
        self.baked.push(Baked { name: name.to_owned(), taken: started.elapsed(), from_cache });
        if let Some(key) = key.filter(|_| !from_cache) {
            self.kept.put(BAKES, &key, &table.to_bytes());
            let taken_ms = 1e3 * started.elapsed().as_secs_f64();
            self.kept.put(TIMES, &time_key(name), &taken_ms.to_bytes());
        }
        table
    }
}

/// Of the time that a table of this name last took to bake, whatever it was baked of.
fn time_key(name: &str) -> Key {
    Key::new(name, BAKERS)
}

/// Milliseconds that a table of this name last took to bake on this machine, if any is kept.
pub fn last_bake_ms(kept: &Kept, name: &str) -> Option<f64> {
    f64::from_bytes(&kept.get(TIMES, &time_key(name))?)
}

/// The pipelines of a renderer, and where they are kept.
#[derive(Clone)]
pub struct KeptPipelines {
    /// What passes build theirs with.
    pub builder: Builder,
    /// Where tables are kept as well.
    pub kept: Kept,
    key: Key,
    /// Bytes that an earlier run left.
    pub found_bytes: Option<u64>,
    written: Building,
}

impl KeptPipelines {
    /// Of these shaders, starting from what an earlier run left, if it was by the same driver and embedded shaders. Of
    /// others nothing is kept.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(device: &Arc<Device>, shaders: ShaderSet, kept: &Kept) -> Result<Self, VulkanError> {
        let key = Key::new("pipelines", device.driver()).bytes(device.name().as_bytes());
        let key = match kept.is_on() {
            true => shaders::all().fold(key, |key, (name, words)| {
                key.bytes(name.as_bytes()).bytes(bytemuck::cast_slice(words))
            }),
            false => key,
        };
        let found = kept.get(PIPELINES, &key);
        let cache = || PipelineCache::new(device, found.as_deref().unwrap_or_default());
        let cache = kept.is_on().then(cache).transpose()?;
        let builder = Builder { pipelines: Arc::new(Pipelines::new(device, cache)), shaders };
        let found_bytes = found.map(|bytes| bytes.len() as u64);
        Ok(Self { builder, kept: kept.clone(), key, found_bytes, written: Building::default() })
    }

    /// Keeps what was built since the last time, if anything was.
    ///
    /// # Errors
    /// Those of the device.
    pub fn keep(&mut self) -> Result<(), VulkanError> {
        let pipelines = &self.builder.pipelines;
        let building = pipelines.building();
        let Some(cache) = pipelines.cache().filter(|_| building != self.written) else { return Ok(()) };
        self.written = building;
        let data = cache.data()?;
        // The driver adds to what it was given: as many bytes are the same ones.
        if self.found_bytes != Some(data.len() as u64) {
            self.kept.put(PIPELINES, &self.key, &data);
        }
        Ok(())
    }
}
