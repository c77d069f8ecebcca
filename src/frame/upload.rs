//! The scene in the device's words: f64 truth to GPU structs.

use super::Request;
use super::bake::Bakes;
use super::packing::{self, Part};
use super::textures::DeviceTables;
use crate::gpu_types::{ControlPoint, Fiber, Frame, Yarn};
use crate::math::frame::octahedral_from_normal;
use crate::passes::fiber_sets::{FabricBuffers, SharedBuffers};
use crate::precompute::chord_shadow::Plies;
use crate::precompute::environment::{Environment, project_environment};
use crate::precompute::occlusion_fit::OcclusionFit;
use crate::precompute::scattering_table::azimuthal_constants;
use crate::scene::camera::Camera;
use crate::scene::file::QualityTable;
use crate::scene::{Fabric, Scene};
use crate::vulkan::{Buffer, Device, VulkanError, vk};
use crate::yarn::detail::slot_stride;
use crate::yarn::fetch::period_seed;
use crate::yarn::flyaway::Flyaways;
use crate::yarn::params::Spread;
use crate::yarn::table;
use glam::{DMat4, DVec2, DVec3, DVec4};
use half::f16;
use rayon::prelude::*;
use std::sync::Arc;

/// Control points relative to the scene's origin: subtracted in f64, so that far-off models keep
/// their digits.
pub fn control_points(fabric: &Fabric, origin_mm: DVec3) -> Vec<ControlPoint> {
    let strands = &fabric.strands;
    packed_points(&strands.points, &strands.normals, &strands.knot_tangents(), origin_mm)
}

/// The same of points (mm) with unit normals and tangents.
pub fn packed_points(
    points: &[DVec3],
    normals: &[DVec3],
    tangents: &[DVec3],
    origin_mm: DVec3,
) -> Vec<ControlPoint> {
    let point = |((position, normal), tangent): ((&DVec3, &DVec3), &DVec3)| ControlPoint {
        position: (*position - origin_mm).as_vec3().to_array(),
        normal_octahedral: octahedral_from_normal(*normal, *tangent),
    };
    points.par_iter().zip(normals).zip(tangents).map(point).collect()
}

/// The fibers of a cross-section.
pub fn fibers(cross_section: &[table::Fiber]) -> Vec<Fiber> {
    let fiber = |f: &table::Fiber| Fiber {
        radius: f.radius as f32,
        angle: f.angle as f32,
        migration_phase: f.migration_phase as f32,
        ply: f.ply,
    };
    cross_section.iter().map(fiber).collect()
}

/// What all yarns of a fabric share, for `segment_count` pieces after `first_piece` others.
fn yarn(
    fabric: &Fabric,
    quality: &QualityTable,
    bakes: &Bakes,
    [first_piece, segment_count]: [u32; 2],
    seed: u64,
) -> Yarn {
    let core = bakes.core.as_ref();
    let params = &fabric.yarn;
    let flyaways = Flyaways::new(params);
    let plies = Plies::new(params);
    let beyond = params.beyond_mm() - DVec2::new(params.ellipse_short_mm, params.ellipse_long_mm);
    let spread = |spread: Spread| (spread.mean as f32, spread.deviation as f32);
    let (loop_radius_mean, loop_radius_sd) = spread(flyaways.loop_radius);
    let (hair_start_mean, hair_start_sd) = spread(flyaways.hair_start);
    let (hair_gain_mean, hair_gain_sd) = spread(flyaways.hair_gain);
    let (hair_share_mean, hair_share_sd) = spread(flyaways.hair_share);
    let (hair_angle_mean, hair_angle_sd) = spread(flyaways.hair_angle);
    // Without occlusion nothing reads it; 1 everywhere is what that means.
    let open = OcclusionFit { visibility: DVec4::X, lean: DVec4::ZERO };
    let occlusion = bakes.occlusion.unwrap_or(open);
    let fiber = &fabric.fiber;
    let scattering = fiber.scattering();
    let (k_tt, n_tt) = azimuthal_constants(&scattering);
    let with = |rgb: DVec3, a: f64| rgb.extend(a).as_vec4().to_array();
    Yarn {
        ply_count: params.ply_count,
        fiber_count: params.fiber_count(),
        ply_offset: params.ply_offset_mm() as f32,
        ellipse_short: params.ellipse_short_mm as f32,
        ellipse_long: params.ellipse_long_mm as f32,
        migration_min: params.migration_min as f32,
        migration_max: params.migration_max as f32,
        fiber_radius: params.fiber_radius_mm() as f32,
        outer_radius: params.outer_radius_mm() as f32,
        max_subdivisions: quality.max_subdivisions,
        segment_count,
        seed: period_seed(seed),
        loop_probability: flyaways.loop_probability as f32,
        loop_radius_mean,
        loop_radius_sd,
        hair_probability: flyaways.hair_probability as f32,
        hair_start_mean,
        hair_start_sd,
        hair_gain_mean,
        hair_gain_sd,
        hair_share_mean,
        hair_share_sd,
        hair_angle_mean,
        hair_angle_sd,
        hair_turns_per_period: flyaways.hair_turns_per_period as f32,
        fiber_turns_per_period: flyaways.fiber_turns_per_period as f32,
        hair_taper: flyaways.hair_taper as f32,
        periods_per_migration: flyaways.periods_per_migration,
        ply_radius: params.round_ply_radius_mm() as f32,
        // Without a core every fiber is drawn.
        core_ranks: core.map_or(params.fibers_per_ply, |core| core.ranks) as f32,
        core_extent: core.map_or(1.0, |core| core.extent) as f32,
        core_height: core.map_or(0.0, |core| core.height_share) as f32,
        core_rows: core.map_or(1, |core| core.mips[0].rows),
        core_above: core.map_or(1.0, |core| core.height_above) as f32,
        core_thickness: core.map_or([0.0; 8], |core| core.thickness.map(|t| t as f32)),
        slot_stride: slot_stride(params.fiber_count()),
        reach: flyaways.reach_mm as f32,
        occlusion: occlusion.visibility.as_vec4().to_array(),
        occlusion_lean: occlusion.lean.as_vec4().to_array(),
        k_tt: k_tt as f32,
        n_tt: n_tt as f32,
        scattering_entries: quality.scattering_entries,
        first_piece,
        shadow_radius: bakes.shadow_radius_mm as f32,
        ply_cos: plies.turn.x as f32,
        ply_sin: plies.turn.y as f32,
        beyond_short: beyond.x as f32,
        beyond_long: beyond.y as f32,
        padding_0: 0,
        padding_1: 0,
        padding_2: 0,
        diffuse: with(DVec3::from_array(fiber.diffuse()), bakes.extinction),
        specular: with(DVec3::from_array(fiber.specular()), fiber.specular_width()),
        reflection: with(scattering.c_r, scattering.beta_r),
        transmission: with(scattering.c_tt, scattering.beta_tt),
    }
}

/// The picture of the light from everywhere, projected; 0 without one.
pub fn environment(scene: &Scene) -> Environment {
    let ambient = &scene.file.ambient;
    let project = |image| project_environment(image, ambient.environment_scale, ambient.environment_yaw_deg);
    scene.environment.as_deref().map_or([DVec3::ZERO; 9], project)
}

/// The camera and ambient light of one jittered frame; `light_scale` is [`super::lighting::light_scale`]'s.
pub fn frame(
    scene: &Scene,
    camera: &Camera,
    (environment, light_scale): (&Environment, f64),
    request: &Request,
    index: usize,
) -> Frame {
    let quality = &scene.file.quality;
    let size = request.size;
    let spacing_px = request.sampling.spacing_px();
    let jitter = request.sampling.jitters()[index];
    Frame {
        clip_from_world: columns(camera.clip_from_world(size, jitter)),
        eye_world: camera.eye_world.extend(1.0).as_vec4().to_array(),
        frustum_world: camera.frustum_world(size).map(|plane| plane.as_vec4().to_array()),
        ambient_radiance: rgb((light_scale * scene.file.ambient.radiance()).to_array()),
        environment: environment.map(|rgb| (light_scale * rgb).extend(0.0).as_vec4().to_array()),
        tolerance_px: quality.subdivision_tolerance_px as f32,
        near_mm: camera.near_mm as f32,
        pixel_tangent: camera.pixel_tangent(size) as f32,
        lod_threshold_px: (quality.lod_threshold_samples * spacing_px) as f32,
        thin_fiber_px: (quality.thin_fiber_samples * spacing_px) as f32,
        index: index as u32,
        shading_spacing_px: request.sampling.frame_spacing_px() as f32,
        vertex_shaded_px: (quality.vertex_shaded_samples * spacing_px) as f32,
        // The lights of a picture are known where it is drawn.
        light_count: 0,
        padding_0: 0,
        padding_1: 0,
        padding_2: 0,
    }
}

fn rgb(rgb: [f64; 3]) -> [f32; 4] {
    DVec3::from_array(rgb).extend(1.0).as_vec4().to_array()
}

/// A matrix as the device has it, column by column.
pub fn columns(m: DMat4) -> [[f32; 4]; 4] {
    m.as_mat4().to_cols_array_2d()
}

/// Names of the buffers of control points in the frames before and after.
const NEIGHBOURS: [&str; 2] = ["control points before", "control points after"];

/// What is uploaded with one fabric.
#[derive(Clone, Copy)]
pub struct FabricBakes<'a> {
    /// Its fibers.
    pub cross_section: &'a [table::Fiber],
    /// Its tables.
    pub bakes: &'a Bakes,
    /// What is open of the sky above each of its control points, where something reads it.
    pub skies: Option<&'a [[f16; 4]]>,
    /// Whether something reads where the frames before and after have it.
    pub neighbours: bool,
}

/// Uploads a fabric whose pieces come after `first_piece` others, once: what was baked and nothing in its place where
/// nothing was. In parts that storage buffers have room for, each with its number of pieces; all but control points,
/// pieces and curves is theirs together.
///
/// # Errors
/// Those of the device.
pub fn fabric_buffers(
    device: &Arc<Device>,
    scene: &Scene,
    fabric: &Fabric,
    baked: &FabricBakes<'_>,
    first_piece: u32,
) -> Result<Vec<(FabricBuffers, u32)>, VulkanError> {
    let shared = shared_buffers(device, baked)?;
    let points = control_points(fabric, scene.origin_mm);
    let quality = &scene.file.quality;
    let upload = |part: &Part| -> Result<_, VulkanError> {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let strands = &fabric.strands;
        let count = part.pieces.len() as u32;
        let counts = [first_piece + part.pieces.start as u32, count];
        let yarn = yarn(fabric, quality, baked.bakes, counts, scene.file.seed);
        let sky = |skies: &[[f16; 4]]| Buffer::upload(device, "skies", usage, &skies[part.points.clone()]);
        let pieces = packing::pieces(strands, part);
        // Until it is posed it stands still.
        let still = |name| Buffer::upload(device, name, usage, &points[part.points.clone()]);
        let [before, after] = NEIGHBOURS;
        let neighbours = || Ok::<_, VulkanError>([still(before)?, still(after)?]);
        let buffers = FabricBuffers {
            control_points: Buffer::upload(device, "control points", usage, &points[part.points.clone()])?,
            pieces: Buffer::upload(device, "yarn pieces", usage, &pieces)?,
            curves: Buffer::upload(device, "curves", usage, &packing::curves(strands, part))?,
            yarn: Buffer::upload(device, "yarn parameters", usage, &[yarn])?,
            skies: baked.skies.map(sky).transpose()?,
            neighbours: baked.neighbours.then(neighbours).transpose()?,
            shared: shared.clone(),
        };
        Ok((buffers, count))
    };
    packing::parts(&fabric.strands, quality.points_per_buffer as usize).iter().map(upload).collect()
}

fn shared_buffers(device: &Arc<Device>, baked: &FabricBakes<'_>) -> Result<SharedBuffers, VulkanError> {
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let DeviceTables { core, scattering, self_shadow, occlusion } = baked.bakes.on_device(device)?;
    Ok(SharedBuffers {
        fibers: Buffer::upload(device, "fibers", usage, &fibers(baked.cross_section))?,
        core,
        scattering,
        self_shadow,
        occlusion,
    })
}
