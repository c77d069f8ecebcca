//! A pipeline that draws one kind of scene: nothing of it is decided when it runs.

use crate::glsl;
use bytemuck::{Pod, Zeroable};
use std::path::Path;
use std::sync::Arc;
use worsted::error::Error;
use worsted::frame::lighting::LightRoom;
use worsted::frame::{Request, upload};
use worsted::gpu_types::{Frame, Yarn};
use worsted::graph::{Graph, Pass, Use};
use worsted::passes::draw_plan::DrawPlan;
use worsted::passes::targets::{DEPTH_FORMAT, RADIANCE_FORMAT};
use worsted::scene::features::Features;
use worsted::scene::{Fabric, Scene};
use worsted::vulkan::{
    Access, Binding, Buffer, ColorTarget, Commands, DepthState, DepthTarget, DescriptorLayout, DescriptorSet,
    Device, GraphicsPipelineInfo, Image, ImageInfo, ImageState, MemoryKind, Pipeline, Rendering, Resource,
    ShaderStage, SpecializationConstants, vk,
};
use worsted::yarn::flyaway::Flyaways;
use worsted::yarn::table::fiber_table;

/// `LookBlock` of tools/minimal/yarn.glsl.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Look {
    to_light: [f32; 4],
    irradiance: [f32; 4],
    diffuse: [f32; 4],
    specular: [f32; 4],
    reach: f32,
    padding: [f32; 3],
}

/// `PieceTurns` of tools/minimal/yarn.glsl.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Turns {
    starts: [f32; 3],
    deltas: [f32; 3],
    first_point: u32,
    padding: u32,
}

/// The pipeline with its scene.
pub struct HandCut {
    device: Arc<Device>,
    scene: Scene,
    request: Request,
    frame: Buffer,
    color: Image,
    depth: Image,
    pipeline: Pipeline,
    set: DescriptorSet,
    plan: DrawPlan,
    graph: Graph,
}

impl HandCut {
    /// Uploads the first fabric and builds the pipeline.
    ///
    /// # Errors
    /// Those of the device; shaders that do not compile.
    pub fn new(device: &Arc<Device>, scene: &Scene, request: &Request) -> Result<Self, Error> {
        let fabric = &scene.fabrics[0];
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let uniform = vk::BufferUsageFlags::UNIFORM_BUFFER;
        let frame = Buffer::new(device, "frame", size_of::<Frame>() as u64, uniform, MemoryKind::Upload)?;
        let points = upload::control_points(fabric, scene.origin_mm);
        let points = Buffer::upload(device, "points", storage, &points)?;
        let pieces = Buffer::upload(device, "pieces", storage, &turns(fabric))?;
        let fibers = upload::fibers(&fiber_table(&fabric.yarn, scene.file.seed));
        let fibers = Buffer::upload(device, "fibers", storage, &fibers)?;
        let yarn = Buffer::upload(device, "yarn", storage, &[yarn(scene, fabric)])?;
        let look = Buffer::upload(device, "look", uniform, &[look(scene, fabric)])?;
        let stages = vk::ShaderStageFlags::ALL_GRAPHICS;
        let (in_storage, in_uniform) =
            (vk::DescriptorType::STORAGE_BUFFER, vk::DescriptorType::UNIFORM_BUFFER);
        let kinds = [in_uniform, in_storage, in_storage, in_storage, in_storage, in_uniform];
        let bindings: Vec<Binding> =
            (0..).zip(kinds).map(|(binding, kind)| Binding { binding, kind, stages }).collect();
        let layout = DescriptorLayout::new(device, "minimal", &bindings)?;
        let bound = [
            (0, Resource::Uniform(&frame)),
            (1, Resource::Storage(&points)),
            (2, Resource::Storage(&pieces)),
            (3, Resource::Storage(&fibers)),
            (4, Resource::Storage(&yarn)),
            (5, Resource::Uniform(&look)),
        ];
        let set = DescriptorSet::new(&layout, "minimal", &bound)?;
        let image = |name, format, usage| {
            let extent = [request.size[0], request.size[1], 1];
            Image::new(device, &ImageInfo { name, format, extent, usage, ..Default::default() })
        };
        use vk::ImageUsageFlags as Usage;
        let most = scene.file.quality.max_subdivisions;
        let count = fabric.strands.pieces.len() as u32;
        Ok(Self {
            device: device.clone(),
            scene: scene.clone(),
            request: *request,
            frame,
            color: image("radiance", RADIANCE_FORMAT, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC)?,
            depth: image("depth", DEPTH_FORMAT, Usage::DEPTH_STENCIL_ATTACHMENT)?,
            pipeline: pipeline(device, &layout)?,
            set,
            plan: DrawPlan::new(count, fabric.yarn.fiber_count(), most, device.is_cpu(), None),
            graph: Graph::default(),
        })
    }

    /// Draws a picture: linear radiance and coverage.
    ///
    /// # Errors
    /// Those of the device.
    pub fn render(&mut self) -> Result<Vec<[f32; 4]>, Error> {
        let camera = self.scene.camera(self.request.size);
        let environment = upload::environment(&self.scene);
        self.frame.write(0, &[upload::frame(&self.scene, &camera, (&environment, 1.0), &self.request, 0)])?;
        let rendering_extent = self.request.size;
        let record = |commands: &Commands<'_>| {
            let color =
                ColorTarget { view: self.color.view(), resolve: None, clear: Some([0.0; 4]), store: true };
            let depth = DepthTarget { view: self.depth.view(), clear: Some(0.0), store: false };
            let rendering = Rendering { extent: rendering_extent, color: &[color], depth: Some(depth) };
            commands.render(&rendering, || {
                commands.bind_pipeline(&self.pipeline);
                commands.bind_sets(&self.pipeline, &[&self.set]);
                for draw in self.plan.draws() {
                    commands.draw(draw.patches, draw.groups, draw.first_patch, draw.first_group);
                }
            });
            Ok(())
        };
        let uses = vec![
            Use::Discard(&self.color, ImageState::COLOR_TARGET),
            Use::Discard(&self.depth, ImageState::DEPTH_TARGET),
            Use::Buffer(&self.frame, Access::GRAPHICS_READ),
        ];
        let pass = Pass { name: "minimal", uses, record: Box::new(record) };
        self.graph.run(&self.device, "minimal", &[pass])?;
        let halves: Vec<[half::f16; 4]> = self.color.read(ImageState::COLOR_TARGET)?;
        Ok(halves.iter().map(|pixel| pixel.map(f32::from)).collect())
    }
}

fn pipeline(device: &Arc<Device>, layout: &DescriptorLayout) -> Result<Pipeline, Error> {
    use vk::ShaderStageFlags as Stage;
    let files = [
        (Stage::VERTEX, "vert"),
        (Stage::TESSELLATION_CONTROL, "tesc"),
        (Stage::TESSELLATION_EVALUATION, "tese"),
        (Stage::GEOMETRY, "geom"),
        (Stage::FRAGMENT, "frag"),
    ];
    let words = files.map(|(stage, extension)| compiled(extension).map(|words| (stage, words)));
    let words = words.into_iter().collect::<Result<Vec<_>, Error>>()?;
    let constants = SpecializationConstants::new();
    let stages: Vec<_> = words
        .iter()
        .map(|(stage, spirv)| ShaderStage { stage: *stage, spirv, constants: &constants })
        .collect();
    let depth = DepthState { format: DEPTH_FORMAT, compare: vk::CompareOp::GREATER, write: true, bias: None };
    let info = GraphicsPipelineInfo {
        name: "minimal",
        stages: &stages,
        topology: vk::PrimitiveTopology::PATCH_LIST,
        patch_control_points: 1,
        color_formats: &[RADIANCE_FORMAT],
        depth: Some(depth),
        set_layouts: &[layout],
        ..Default::default()
    };
    Ok(Pipeline::graphics(device, &info)?)
}

/// Its own shaders are beside this file; what they include of the renderer's is under `glsl/`.
fn compiled(extension: &str) -> Result<Vec<u32>, Error> {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |path: &str| {
        let folder = if path.starts_with("minimal/") { "tools" } else { "glsl" };
        std::fs::read_to_string(repository.join(folder).join(path)).map_err(|e| e.to_string())
    };
    let path = format!("minimal/yarn.{extension}");
    let stage = glsl::stage_of(&path).ok_or_else(|| Error::Failed(format!("{path}: no stage")))?;
    glsl::compile(&path, stage, &read).map_err(Error::Failed)
}

fn turns(fabric: &Fabric) -> Vec<Turns> {
    let piece = |piece: &worsted::yarn::strand::Piece| {
        let all = [piece.turns.ply, piece.turns.fiber, piece.turns.migration];
        Turns {
            starts: all.map(|turns| turns.start.rem_euclid(1.0) as f32),
            deltas: all.map(|turns| turns.delta as f32),
            first_point: piece.first_point as u32,
            padding: 0,
        }
    };
    fabric.strands.pieces.iter().map(piece).collect()
}

/// What the functions that place a fiber read of a yarn.
fn yarn(scene: &Scene, fabric: &Fabric) -> Yarn {
    let params = &fabric.yarn;
    Yarn {
        ply_count: params.ply_count,
        fiber_count: params.fiber_count(),
        ply_offset: params.ply_offset_mm() as f32,
        ellipse_short: params.ellipse_short_mm as f32,
        ellipse_long: params.ellipse_long_mm as f32,
        migration_min: params.migration_min as f32,
        migration_max: params.migration_max as f32,
        fiber_radius: params.fiber_radius_mm() as f32,
        max_subdivisions: scene.file.quality.max_subdivisions,
        ..Yarn::zeroed()
    }
}

fn look(scene: &Scene, fabric: &Fabric) -> Look {
    let tables = scene.file.light();
    let features = [Features::new(&scene.file, fabric, false)];
    let lights = LightRoom::of(&tables, &features).lights(&tables, scene.origin_mm, 1.0);
    let four = |[x, y, z]: [f32; 3], w: f32| [x, y, z, w];
    let fiber = &fabric.fiber;
    let rgb = |rgb: [f64; 3]| rgb.map(|c| c as f32);
    Look {
        to_light: four(lights[0].toward, 0.0),
        irradiance: four(lights[0].strength, 0.0),
        diffuse: four(rgb(fiber.diffuse()), 0.0),
        specular: four(rgb(fiber.specular()), fiber.specular_width() as f32),
        reach: Flyaways::new(&fabric.yarn).reach_mm as f32,
        padding: [0.0; 3],
    }
}
