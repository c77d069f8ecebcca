//! What of a fabric a picture may need at most, before the device decides for each piece of yarn.

use super::{Renderer, Request};
use crate::passes::draw_plan::DrawPlan;
use crate::passes::shadow_map::ShadowMapPass;
use crate::passes::strand_pipeline::{Manner, Strands};
use crate::scene::camera::Camera;
use crate::scene::features::Features;
use crate::scene::{Fabric, Scene};
use crate::vulkan::VulkanError;
use crate::yarn::detail::{share_kept, slots_kept};
use crate::yarn::flyaway::Flyaways;
use crate::yarn::level::outside_frustum;
use glam::DVec4;
use rayon::prelude::*;

/// More than half of `VERTEX_SHADED_FADE` in `glsl/passes/level.glsl`, by which pieces differ in the width at which
/// they change from one way to be shaded to the other.
const FADE: f64 = 0.25;

impl Renderer {
    /// Decides on the draws of a picture and returns how many pieces of yarn are in none of them.
    pub(super) fn plan(&mut self, camera: &Camera) -> Result<u64, VulkanError> {
        let scene = &self.scene;
        let planned = Planned::new(scene, camera, &self.request, self.device.is_cpu());
        let parts = &self.parts;
        let draws = |part: usize, strands, manner| planned.draws(parts[part], strands, manner);
        self.fibers.plan(draws)?;
        self.layers.as_mut().map_or(Ok(()), |layers| layers.plan(draws))?;
        self.shadow_map.as_mut().map_or(Ok(()), ShadowMapPass::plan)?;
        let left_out = || scene.fabrics.iter().enumerate().filter(|(index, _)| planned.unseen(*index));
        self.stats.add_left_out_of_frame(left_out().map(|(index, fabric)| {
            (format!("fabric {index} ({})", fabric.name), "all of it is outside the picture".to_owned())
        }));
        Ok(left_out().map(|(_, fabric)| fabric.strands.pieces.len() as u64).sum())
    }
}

/// What a picture shows of one fabric.
struct Seen {
    features: Features,
    /// Width of a ply in pixels where the fabric is nearest.
    nearest_ply_px: f64,
    /// Where what is in view of it is farthest.
    farthest_ply_px: f64,
}

/// What one picture shows, by fabric; none of one that is out of view.
pub struct Planned<'a> {
    scene: &'a Scene,
    seen: Vec<Option<Seen>>,
    spacing_px: f64,
    is_cpu: bool,
}

impl<'a> Planned<'a> {
    /// Looks at every piece of yarn.
    pub fn new(scene: &'a Scene, camera: &Camera, request: &Request, is_cpu: bool) -> Self {
        let seen = scene.fabrics.iter().map(|fabric| seen(scene, fabric, camera, request)).collect();
        Self { scene, seen, spacing_px: request.sampling.spacing_px(), is_cpu }
    }

    /// Whether no piece of a fabric is in view.
    pub fn unseen(&self, fabric: usize) -> bool {
        self.seen[fabric].is_none()
    }

    /// Draws of the strands of `pieces` pieces of one fabric, fit for the device. What the picture cannot hold is not
    /// drawn at all.
    pub fn draws(&self, (fabric, pieces): (usize, u32), strands: Strands, manner: Manner) -> DrawPlan {
        let quality = &self.scene.file.quality;
        let Some(seen) = &self.seen[fabric] else { return DrawPlan::default() };
        let fabric = &self.scene.fabrics[fabric];
        let fiber_share = fabric.yarn.fiber_radius_mm() / fabric.yarn.round_ply_radius_mm();
        let whole = seen.features.may_be_whole()
            && fiber_share * seen.farthest_ply_px >= quality.lod_threshold_samples * self.spacing_px;
        let shaded_px = quality.vertex_shaded_samples * self.spacing_px;
        let wide = seen.nearest_ply_px > shaded_px * (1.0 - FADE);
        let thin = seen.farthest_ply_px < shaded_px * (1.0 + FADE);
        let anything = match manner {
            Manner::AtPixels => !whole && (wide || !seen.features.vertex_shading || strands == Strands::Core),
            Manner::AtVertices => !whole && thin,
            Manner::Whole => whole,
        };
        if !anything {
            return DrawPlan::default();
        }
        let all = fabric.yarn.fiber_count();
        let fibers = match strands {
            Strands::Core => fabric.yarn.ply_count,
            Strands::Regular if seen.features.level_of_detail && !whole => {
                let thin_px = quality.thin_fiber_samples * self.spacing_px;
                let ply_px = seen.nearest_ply_px;
                slots_kept(share_kept(fiber_share * ply_px, ply_px, thin_px), all)
            }
            Strands::Regular => all,
        };
        DrawPlan::new(pieces, fibers, quality.max_subdivisions, self.is_cpu, quality.patches_per_draw)
    }
}

/// Depths along the view axis of the fabric's yarns, hairs included.
fn seen(scene: &Scene, fabric: &Fabric, camera: &Camera, request: &Request) -> Option<Seen> {
    let features = Features::new(&scene.file, fabric, request.statistics);
    let reach_mm = Flyaways::new(&fabric.yarn).reach_mm;
    let planes = camera.frustum_world(request.size);
    let axis = -camera.world_from_view.z_axis;
    let depth = DVec4::from((axis, -axis.dot(camera.eye_world)));
    let strands = &fabric.strands;
    let of_piece = |piece| {
        let hull = strands.bezier(piece).map(|p| p - scene.origin_mm);
        let culled = features.culling && outside_frustum(&hull, reach_mm, &planes);
        (!culled).then(|| {
            let depths = hull.map(|p| depth.dot(p.extend(1.0)));
            [
                depths.into_iter().fold(f64::INFINITY, f64::min),
                depths.into_iter().fold(f64::NEG_INFINITY, f64::max),
            ]
        })
    };
    let wider = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
    let [nearest_mm, farthest_mm] = strands.pieces.par_iter().filter_map(of_piece).reduce_with(wider)?;
    let ply_px = |depth_mm: f64| {
        let pixel_mm = camera.pixel_tangent(request.size) * depth_mm.max(camera.near_mm);
        2.0 * fabric.yarn.round_ply_radius_mm() / pixel_mm
    };
    Some(Seen {
        features,
        nearest_ply_px: ply_px(nearest_mm - reach_mm),
        farthest_ply_px: ply_px(farthest_mm + reach_mm),
    })
}
