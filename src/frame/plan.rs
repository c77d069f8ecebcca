//! How many fibers a picture may need at most, before the device decides for each piece of yarn.

use super::Request;
use crate::passes::draw_plan::DrawPlan;
use crate::passes::strand_pipeline::Strands;
use crate::scene::camera::Camera;
use crate::scene::features::Features;
use crate::scene::{Fabric, Scene};
use crate::yarn::detail::{share_kept, slots_kept};
use crate::yarn::flyaway::Flyaways;
use glam::{DVec3, DVec4};

/// Whether all of the fabric's yarns, hairs included, lie outside one side of the picture: then none of its draws is
/// made. Curves lie within the hull of their points.
pub fn out_of_view(scene: &Scene, fabric: &Fabric, (camera, request): (&Camera, &Request)) -> bool {
    let reach = Flyaways::new(&fabric.yarn).reach_mm + fabric.yarn.fiber_radius_mm();
    let beyond = |plane: &DVec4| {
        fabric.hull_points().all(|p| plane.truncate().dot(p - scene.origin_mm) + plane.w < -reach)
    };
    scene.file.quality.culling && camera.frustum_world(request.size).iter().any(beyond)
}

/// Draws of one fabric's strands, fit for the device. Groups of fibers that level of detail keeps nowhere in the
/// picture are not drawn at all.
pub fn draw_plan(
    scene: &Scene,
    fabric: &Fabric,
    (camera, request): (&Camera, &Request),
    strands: Strands,
    is_cpu: bool,
) -> DrawPlan {
    let quality = &scene.file.quality;
    let features = Features::new(&scene.file, fabric, request.statistics);
    let all = fabric.yarn.fiber_count();
    let fibers = match strands {
        Strands::Core => fabric.yarn.ply_count,
        Strands::Regular if features.level_of_detail => {
            let pixel_mm = camera.pixel_tangent(request.size) * nearest_depth_mm(scene, fabric, camera);
            let fiber_px = 2.0 * fabric.yarn.fiber_radius_mm() / pixel_mm;
            let ply_px = 2.0 * fabric.yarn.round_ply_radius_mm() / pixel_mm;
            let thin_px = quality.thin_fiber_samples * request.sampling.spacing_px();
            slots_kept(share_kept(fiber_px, ply_px, thin_px), all)
        }
        Strands::Regular => all,
    };
    let pieces = fabric.strands.pieces.len() as u32;
    DrawPlan::new(pieces, fibers, quality.max_subdivisions, is_cpu, quality.patches_per_draw)
}

/// Depth of the point of the fabric's yarns, hairs included, that is nearest along the view axis.
fn nearest_depth_mm(scene: &Scene, fabric: &Fabric, camera: &Camera) -> f64 {
    let depth = |p: DVec3| (camera.eye_world - (p - scene.origin_mm)).dot(camera.world_from_view.z_axis);
    let nearest = fabric.hull_points().map(depth).fold(f64::INFINITY, f64::min);
    (nearest - Flyaways::new(&fabric.yarn).reach_mm).max(camera.near_mm)
}
