//! The frame, top to bottom: what is built for a scene, and what one picture runs.

mod bake;
mod cloth;
mod edit;
mod keeping;
mod layers;
pub mod lighting;
pub mod moving;
pub mod packing;
mod plan;
pub mod sampling;
mod savings;
pub mod stats;
pub mod tables;
mod textures;
pub mod upload;

use crate::gpu_types::{Frame, Statistics, TUBE_CORNERS};
use crate::graph::{Graph, Pass};
use crate::io::kept::Kept;
use crate::io::layers::Layers;
use crate::passes::fiber_sets::FrameBuffers;
use crate::passes::fibers::FibersPass;
use crate::passes::layers::LayersPass;
use crate::passes::resolve::ResolvePass;
use crate::passes::shadow_map::{ShadowMap, ShadowMapPass};
use crate::passes::targets::Targets;
use crate::passes::tonemap::TonemapPass;
use crate::precompute::environment::Environment;
use crate::scene::Scene;
use crate::scene::camera::Camera;
use crate::scene::needs::{Need, any_needs};
use crate::shaders::ShaderSet;
use crate::vulkan::{Buffer, Device, MemoryKind, Taken, VulkanError, vk};
use crate::yarn::table::fiber_table;
pub use bake::check_tables;
use cloth::Cloth;
use keeping::KeptPipelines;
use lighting::{LightRoom, light_scale, lights_that_reach};
use sampling::Sampling;
use stats::Stats;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;
use std::time::{Duration, Instant};
use tables::Tables;

/// What a picture is asked to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Request {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel: 1, 4, or jittered frames of 4.
    pub sampling: Sampling,
    /// Count what is drawn.
    pub statistics: bool,
    /// Time every pass in a submission of its own.
    pub profile: bool,
}

/// A finished picture, row 0 on top.
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Linear radiance, rgb; alpha is the share of samples that hit yarn.
    pub linear: Vec<[f32; 4]>,
    /// sRGB as shown on a display, over the scene's background; without one, rgb is that of the yarn alone and
    /// alpha its coverage, not multiplied in.
    pub display: Vec<[u8; 4]>,
    /// What the scene asks for besides.
    pub layers: Option<Layers>,
}

/// Everything a scene needs on the device.
pub struct Renderer {
    device: Arc<Device>,
    scene: Scene,
    request: Request,
    targets: Targets,
    environment: Environment,
    frame: Buffer,
    statistics: Option<Buffer>,
    lights: Option<Buffer>,
    shadow_views: Option<Buffer>,
    /// What the pipelines, the buffers and the shadow map have room for.
    light_room: LightRoom,
    cloth: Cloth,
    moving: moving::Moving,
    /// Fabric and number of pieces of each part that the fiber pass draws.
    parts: Vec<(usize, u32)>,
    shadow_map: Option<ShadowMapPass>,
    fibers: FibersPass,
    tables: Tables,
    layers: Option<LayersPass>,
    resolve: ResolvePass,
    tonemap: TonemapPass,
    pipelines: KeptPipelines,
    graph: Graph,
    stats: Stats,
}

impl Renderer {
    /// Uploads the scene and builds the passes it needs.
    ///
    /// # Errors
    /// Those of the device: too large, out of memory, lost; what [`check_tables`] refuses.
    pub fn new(device: &Arc<Device>, scene: Scene, request: Request) -> Result<Self, VulkanError> {
        Self::keeping(device, scene, request, &Kept::NOTHING)
    }

    /// The same, with baked tables and compiled pipelines of earlier runs where `kept` has them; those that it has not
    /// are kept there.
    ///
    /// # Errors
    /// As [`Self::new`]; none of the cache, without which all is done anew.
    pub fn keeping(
        device: &Arc<Device>,
        scene: Scene,
        request: Request,
        kept: &Kept,
    ) -> Result<Self, VulkanError> {
        Self::built(device, scene, request, ShaderSet::default(), kept)
    }

    /// The same with other shaders.
    ///
    /// # Errors
    /// Those of the device.
    #[doc(hidden)]
    pub fn with_shaders(
        device: &Arc<Device>,
        scene: Scene,
        request: Request,
        shaders: ShaderSet,
    ) -> Result<Self, VulkanError> {
        Self::built(device, scene, request, shaders, &Kept::NOTHING)
    }

    fn built(
        device: &Arc<Device>,
        scene: Scene,
        request: Request,
        shaders: ShaderSet,
        kept: &Kept,
    ) -> Result<Self, VulkanError> {
        let pipelines = KeptPipelines::new(device, shaders, kept)?;
        let tables = Tables::bake(&scene, &request, kept)?;
        Self::assembled(device, scene, request, pipelines, tables)
    }

    /// Uploads the scene with tables that are there, and builds the passes that it needs.
    fn assembled(
        device: &Arc<Device>,
        scene: Scene,
        request: Request,
        pipelines: KeptPipelines,
        tables: Tables,
    ) -> Result<Self, VulkanError> {
        let building = &pipelines.builder;
        let samples = request.sampling.multisampling();
        let targets = Targets::new(device, request.size, samples)?;
        let uniform = vk::BufferUsageFlags::UNIFORM_BUFFER;
        let frame_bytes = size_of::<crate::gpu_types::Frame>() as u64;
        let frame = Buffer::new(device, "frame", frame_bytes, uniform, MemoryKind::Upload)?;
        let features = tables::features(&scene, &request);
        let counted = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_SRC;
        let count = || Buffer::upload(device, "statistics", counted, &[Statistics::default()]);
        let statistics = any_needs(&features, Need::Statistics).then(count).transpose()?;
        let light_room = LightRoom::of(&scene.file.light(), &features);
        let [lights, shadow_views] = light_room.buffers(device)?;
        let map = || ShadowMap::new(device, scene.file.shadow.resolution, light_room.views);
        let map = any_needs(&features, Need::ShadowMap).then(map).transpose()?;

        let mut layers = LayersPass::new(building, &frame, &features, request.size)?;
        let buffers = FrameBuffers {
            frame: frame.clone(),
            statistics: statistics.clone(),
            lights: lights.clone(),
            shadow_views: shadow_views.clone(),
            shadow_map: map.as_ref().map(|map| map.image.clone()),
        };
        let views = shadow_views.clone();
        let shadows = |(map, views)| ShadowMapPass::new(building, map, views, TUBE_CORNERS);
        let mut shadow_map = map.zip(views).map(shadows);
        let mut fibers = FibersPass::new(building, buffers, &features, samples)?;
        let mut stats = Stats::new(device, &scene, &request);
        let started = Instant::now();
        let environment = upload::environment(&scene);
        if scene.environment.is_some() {
            stats.add_precompute("environment", started.elapsed(), false);
        }
        for table in &tables.baked {
            stats.add_precompute(&table.name, table.taken, table.from_cache);
        }
        let mut first_piece = 0;
        let (mut parts, mut moving) = (Vec::new(), moving::Moving::default());
        for (index, (fabric, features)) in scene.fabrics.iter().zip(features).enumerate() {
            let baked = upload::FabricBakes {
                cross_section: &fiber_table(&fabric.yarn, scene.file.seed),
                bakes: &tables.bakes[index],
                skies: tables.skies.as_ref().map(|skies| &skies[index][..]),
                neighbours: features.needs(Need::Neighbours),
            };
            let started = Instant::now();
            let uploaded = upload::fabric_buffers(device, &scene, fabric, &baked, first_piece)?;
            stats.add_upload(started.elapsed());
            moving.add(index, fabric, scene.file.quality.points_per_buffer as usize, &uploaded);
            for (buffers, pieces) in uploaded {
                fibers.add_fabric(&buffers, features)?;
                let read_by = fibers.layouts(parts.len()).zip(fibers.sets(parts.len()));
                if let Some((pass, (layouts, sets))) = shadow_map.as_mut().zip(read_by) {
                    pass.add_fabric(&features, layouts, sets, pieces);
                }
                if let Some((pass, (layouts, sets))) = layers.as_mut().zip(read_by) {
                    pass.add_fabric(index, &features, layouts, sets);
                }
                parts.push((index, pieces));
                first_piece += pieces;
            }
            stats.add_left_out(&features, |what| savings::saved_bytes(&scene, fabric, what));
        }
        moving.keep_skies(tables.skies.clone());
        stats.add_left_out_bakes(|name| keeping::last_bake_ms(&pipelines.kept, name));
        Ok(Self {
            resolve: ResolvePass::new(building, &targets)?,
            tonemap: TonemapPass::new(building, &targets, &scene.file.display)?,
            cloth: Cloth::new(&scene),
            device: device.clone(),
            graph: Graph::default(),
            scene,
            request,
            targets,
            environment,
            frame,
            statistics,
            lights,
            shadow_views,
            light_room,
            moving,
            parts,
            shadow_map,
            fibers,
            tables,
            layers,
            pipelines,
            stats,
        })
    }

    /// The fiber pass, for kernels that read the same buffers.
    pub fn fibers_pass(&self) -> &FibersPass {
        &self.fibers
    }

    /// What is known of the pictures so far.
    pub fn stats(&self) -> &Stats {
        &self.stats
    }

    /// Draws one picture. `progress` is told the share done.
    ///
    /// # Errors
    /// Those of the device.
    pub fn render(&mut self, progress: &dyn Fn(f64)) -> Result<Picture, VulkanError> {
        let goes_on = |share| {
            progress(share);
            true
        };
        let picture = self.render_while(&goes_on)?;
        picture.ok_or_else(|| VulkanError::misuse("a picture was given up that nobody stopped"))
    }

    /// Draws one picture, or none if `goes_on`, which is told the share done, says to stop.
    ///
    /// # Errors
    /// Those of the device.
    pub fn render_while(&mut self, goes_on: &dyn Fn(f64) -> bool) -> Result<Option<Picture>, VulkanError> {
        let camera = self.camera();
        self.stats.left_out_of_frame.clear();
        let unseen = self.plan(&camera)?;
        self.pipelines.keep()?;
        self.stats.set_pipelines(self.pipelines.builder.pipelines.building(), self.pipelines.found_bytes);
        let frames = self.request.sampling.frames();
        let mut taken = Taken::NOTHING;
        let mut passes = HashMap::new();
        if let Some(statistics) = &self.statistics {
            statistics.replace(&[Statistics::default()])?;
        }
        let near = self.cloth.near(&camera, None);
        let light_scale = light_scale(&self.scene, &self.environment, near);
        let (reaching, missing) = lights_that_reach(&self.scene, near);
        self.stats.add_left_out_of_frame(
            missing
                .into_iter()
                .map(|index| (format!("light {index}"), "its cone misses the cloth".to_owned())),
        );
        let lights = self.light_room.lights(&reaching, self.scene.origin_mm, light_scale);
        if let Some(buffer) = &self.lights {
            buffer.write(0, &lights)?;
        }
        let views = self.light_room.views(&self.scene, &reaching, &camera, &self.cloth);
        if let Some(buffer) = &self.shadow_views {
            buffer.write(0, &views)?;
        }
        if let Some(pass) = self.shadow_map.as_ref().and_then(|map| map.pass(views.len() as u32)) {
            let timings = self.request.profile.then_some(&mut passes);
            taken += run(&mut self.graph, &self.device, &[pass], timings)?;
        }
        for index in 0..frames {
            let light = (&self.environment, light_scale);
            let light_count = reaching.len().min(self.light_room.lights) as u32;
            let frame = upload::frame(&self.scene, &camera, light, &self.request, index);
            let frame = Frame { light_count, ..frame };
            self.frame.write(0, &[frame])?;
            let timings = self.request.profile.then_some(&mut passes);
            match self.draw_frame((index, frames), light_scale, timings, goes_on)? {
                Some(time) => taken += time,
                None => return Ok(None),
            }
            if let Some(statistics) = self.statistics.as_ref().filter(|_| index == 0) {
                self.stats.set_counts(statistics.read_staged()?, unseen);
            }
        }
        taken += self.draw_layers(&camera, self.request.profile.then_some(&mut passes))?;
        self.stats.add_frame(taken, passes);
        let picture = self.read_picture()?;
        self.stats.inspect(&picture.linear, light_scale);
        Ok(Some(picture))
    }

    /// Draws jittered frame `index` of `count` and adds it to the picture; none if `goes_on` says to stop.
    fn draw_frame(
        &mut self,
        (index, count): (usize, usize),
        light_scale: f64,
        mut timings: Option<&mut HashMap<&'static str, Duration>>,
        goes_on: &dyn Fn(f64) -> bool,
    ) -> Result<Option<Taken>, VulkanError> {
        let parts = self.fibers.parts(self.scene.file.quality.curves_per_submission);
        let mut taken = Taken::NOTHING;
        for part in 0..parts {
            let fibers = self.fibers.pass(&self.targets, part, parts);
            taken += run(&mut self.graph, &self.device, &[fibers], timings.as_deref_mut())?;
            if !goes_on((index as f64 + (part + 1) as f64 / parts as f64) / count as f64) {
                return Ok(None);
            }
        }
        let mut finish = vec![self.resolve.pass(&self.targets, (index, count), light_scale)];
        if index + 1 == count {
            finish.push(self.tonemap.pass(&self.targets));
        }
        Ok(Some(taken + run(&mut self.graph, &self.device, &finish, timings)?))
    }
}

fn run(
    graph: &mut Graph,
    device: &Arc<Device>,
    passes: &[Pass<'_>],
    timings: Option<&mut HashMap<&'static str, Duration>>,
) -> Result<Taken, VulkanError> {
    match timings {
        Some(timings) => graph.run_timed(device, passes, timings),
        None => graph.run(device, "frame", passes),
    }
}

/// The camera a scene asks for, at a picture size.
pub fn camera(scene: &Scene, size: [u32; 2]) -> Camera {
    scene.camera(size)
}

/// Milliseconds of a duration.
fn ms(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1e3
}

/// Named milliseconds, sorted.
type Milliseconds = BTreeMap<String, f64>;
