//! What a picture of a scene will cost, from counts that the scene has before anything is drawn.

use crate::scene::Scene;
use crate::scene::camera::Camera;
use glam::DVec3;

/// Pixels that cost as much as one pixel of a fiber's length.
const PIXELS_PER_FIBER_PIXEL: f64 = 4.0;
/// A fiber is never drawn narrower than about this in pixels: of thinner ones fewer are drawn.
const THIN_PX: f64 = 0.5;

/// Work of a picture of `size` pixels in pixels of fibers' length: the projected length of every piece of yarn in the
/// picture times its fibers, fewer where level of detail drops them, and a share of the pixels themselves. Relative:
/// meant to be compared with that of another picture drawn with the same settings.
pub fn work(scene: &Scene, size: [u32; 2]) -> f64 {
    let camera = scene.camera(size);
    let planes = camera.frustum_world(size);
    let fibers: f64 = scene
        .fabrics
        .iter()
        .map(|fabric| {
            let fiber_mm = 2.0 * fabric.yarn.fiber_radius_mm();
            let reach_mm = fabric.yarn.outer_radius_mm();
            let count = f64::from(fabric.yarn.fiber_count());
            let pieces = fabric.strands.pieces.iter().map(|piece| {
                let hull = fabric.strands.bezier(piece).map(|p| p - scene.origin_mm);
                let outside =
                    |plane: &glam::DVec4| hull.iter().all(|p| plane.truncate().dot(*p) + plane.w < -reach_mm);
                if planes.iter().any(outside) { 0.0 } else { length_px(&hull, &camera, size, fiber_mm) }
            });
            count * pieces.sum::<f64>()
        })
        .sum();
    fibers + f64::from(size[0]) * f64::from(size[1]) / PIXELS_PER_FIBER_PIXEL
}

/// Length in pixels that is drawn of each of a piece's fibers, on average.
fn length_px(hull: &[DVec3; 4], camera: &Camera, size: [u32; 2], fiber_mm: f64) -> f64 {
    let middle = 0.25 * hull.iter().sum::<DVec3>();
    let depth_mm = (camera.eye_world - middle).dot(camera.world_from_view.z_axis).max(camera.near_mm);
    let pixel_mm = camera.pixel_tangent(size) * depth_mm;
    let length_mm: f64 = hull.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let kept = (fiber_mm / pixel_mm / THIN_PX).min(1.0);
    length_mm / pixel_mm * kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::cloth::{Cloth, Model};

    #[test]
    fn nearer_means_more_until_yarn_leaves_the_picture_and_size_matters() {
        let folder = tempfile::tempdir().unwrap();
        let cloth = Cloth::Stockinette { wales: 3, courses: 3 };
        let model = Model::write(folder.path(), "worsted_3ply", cloth, Default::default()).unwrap();
        let of = |distance_mm: f64, size: [u32; 2]| {
            let sets = [format!("camera.distance_mm={distance_mm:?}"), "camera.target_mm=[0, 0, 0]".into()];
            work(&Scene::load(&model.path, &sets).unwrap(), size)
        };
        let size = [160, 120];
        let [near, middle, far] = [20.0, 60.0, 600.0].map(|mm| of(mm, size));
        assert!(middle > far && far >= 160.0 * 120.0 / PIXELS_PER_FIBER_PIXEL, "{near} {middle} {far}");
        assert!(of(60.0, [320, 240]) > 2.0 * middle);
        let away = ["camera.distance_mm=20.0".to_owned(), "camera.target_mm=[900, 0, 0]".to_owned()];
        let empty = work(&Scene::load(&model.path, &away).unwrap(), size);
        assert_eq!(empty, 160.0 * 120.0 / PIXELS_PER_FIBER_PIXEL);
    }
}
