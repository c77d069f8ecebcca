//! Where a scene is looked at from: close up, at its worst, whole, and from near to far (Wu & Yuksel 2019, Table 1,
//! Figs. 15, 17 and 18).

use super::settings::DEFAULT_SAMPLES;
use crate::error::Error;
use crate::frame::sampling::Sampling;
use crate::scene::camera::Camera;
use crate::scene::file::QualityTable;
use crate::scene::{Fabric, Scene};
use glam::DVec3;
use std::path::Path;

/// Width in pixels of a fiber at the target of a close view: every fiber in the picture is drawn.
const CLOSE_FIBER_PX: f64 = 1.2;
/// Each picture of the sweep is from twice as far as the one before.
const SWEEP_PICTURES: i32 = 5;
const FOV_Y_DEG: f64 = 35.0;
/// Angles of all views: neither along the wales nor along the courses.
const ANGLES_DEG: [f64; 2] = [20.0, 15.0];
/// How far from the line of sight the cloth's front is looked for, in radii of its yarn.
const FRONT_RADII: f64 = 5.0;

/// What can be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum ViewKind {
    /// A fiber is 1.2 pixels wide.
    Close,
    /// A fiber is 1 pixel wide: as far away as nothing is simplified yet.
    Worst,
    /// All of it.
    Full,
    /// Five distances, a fiber 1.2 to 0.075 pixels wide.
    Distance,
}

/// One place to look from.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// What it is called.
    pub name: String,
    /// Its camera, as assignments to scene keys.
    pub sets: Vec<String>,
}

/// The views of the scene at `path` with `sets`, for pictures of `size` pixels.
///
/// # Errors
/// A scene that cannot be had.
pub fn views(path: &Path, sets: &[String], size: [u32; 2], kinds: &[ViewKind]) -> Result<Vec<View>, Error> {
    let angles = [
        format!("camera.fov_y_deg={FOV_Y_DEG:?}"),
        format!("camera.yaw_deg={:?}", ANGLES_DEG[0]),
        format!("camera.pitch_deg={:?}", ANGLES_DEG[1]),
    ];
    let fit = [&angles[..], &["camera.fit=true".to_owned()]].concat();
    let scene = Scene::load(path, &[sets, &fit].concat())?;
    let camera = scene.camera(size);
    let target = front(&scene, &camera) + scene.origin_mm;
    let fiber_mm = 2.0 * first_fabric(&scene)?.yarn.fiber_radius_mm();
    let near = |name: String, fiber_px: f64| {
        let distance_mm = fiber_mm / fiber_px / camera.pixel_tangent(size);
        let place = [
            format!("camera.distance_mm={distance_mm:?}"),
            format!("camera.target_mm=[{:?}, {:?}, {:?}]", target.x, target.y, target.z),
            "camera.fit=false".to_owned(),
        ];
        View { name, sets: [&angles[..], &place].concat() }
    };
    let worst_px = worst_fiber_px()?;
    let of = |kind: &ViewKind| match kind {
        ViewKind::Close => vec![near("close".into(), CLOSE_FIBER_PX)],
        ViewKind::Worst => vec![near("worst".into(), worst_px)],
        ViewKind::Full => vec![View { name: "full".into(), sets: fit.clone() }],
        ViewKind::Distance => (0..SWEEP_PICTURES)
            .map(|i| near(format!("distance {}x", 1 << i), CLOSE_FIBER_PX * 0.5_f64.powi(i)))
            .collect(),
    };
    Ok(kinds.iter().flat_map(of).collect())
}

/// As far away as all fibers are still drawn, at the default number of samples by default settings.
fn worst_fiber_px() -> Result<f64, Error> {
    let sampling = Sampling::new(DEFAULT_SAMPLES).map_err(Error::Failed)?;
    Ok(QualityTable::default().lod_threshold_samples * sampling.spacing_px())
}

/// Width in pixels of a fiber of the scene's first fabric at what the camera looks at.
///
/// # Errors
/// A scene without fabric.
pub fn fiber_px(scene: &Scene, size: [u32; 2]) -> Result<f64, Error> {
    let camera = scene.camera(size);
    let depth_mm = (camera.eye_world - camera.target_world).length();
    let fiber_mm = 2.0 * first_fabric(scene)?.yarn.fiber_radius_mm();
    Ok(fiber_mm / (camera.pixel_tangent(size) * depth_mm))
}

/// The fabric whose yarn stands for all.
///
/// # Errors
/// A scene without fabric.
pub fn first_fabric(scene: &Scene) -> Result<&Fabric, Error> {
    scene.fabrics.first().ok_or_else(|| Error::Failed("expected a fabric, found none".into()))
}

/// Where the line of sight of a camera that sees everything meets the cloth's front, relative to the scene's
/// origin: the nearest point to the eye of those by that line, or where there is a hole, the nearest to the line.
fn front(scene: &Scene, camera: &Camera) -> DVec3 {
    let back = camera.world_from_view.z_axis;
    let radius_mm = scene.thickest_mm();
    let points = || scene.hull_points();
    let aside = |p: DVec3| (p - camera.target_world).reject_from_normalized(back).length();
    let nearest = |p: &DVec3, q: &DVec3| p.dot(back).total_cmp(&q.dot(back));
    let by_the_line = points().filter(|&p| aside(p) < FRONT_RADII * radius_mm).max_by(nearest);
    let found = by_the_line.or_else(|| points().min_by(|&p, &q| aside(p).total_cmp(&aside(q))));
    found.map_or(camera.target_world, |p| p + radius_mm * back)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::cloth::{Cloth, Model};

    const SIZE: [u32; 2] = [120, 90];

    #[test]
    fn fibers_are_as_wide_as_the_view_says_and_the_cloth_is_there() {
        let folder = tempfile::tempdir().unwrap();
        let cloth = Cloth::Tube { wales: 12, courses: 3 };
        let model = Model::write(folder.path(), "worsted_3ply", cloth, Default::default()).unwrap();
        let kinds = [ViewKind::Close, ViewKind::Worst, ViewKind::Full, ViewKind::Distance];
        let views = views(&model.path, &[], SIZE, &kinds).unwrap();
        assert_eq!(views.len(), 8);
        let scenes: Vec<Scene> =
            views.iter().map(|view| Scene::load(&model.path, &view.sets).unwrap()).collect();
        for (index, expected) in [(0, 1.2), (1, 1.0), (3, 1.2), (4, 0.6), (7, 0.075)] {
            let found = fiber_px(&scenes[index], SIZE).unwrap();
            assert!((found - expected).abs() < 1e-9, "{}: {found}", views[index].name);
        }
        let full = fiber_px(&scenes[2], SIZE).unwrap();
        assert!(full < 0.75, "{full}");
        // On the tube's outside, toward the camera.
        let camera = scenes[0].camera(SIZE);
        assert!(camera.target_world.z > 0.5 * model.reach_mm, "{camera:?}");
    }

    #[test]
    fn a_wrong_key_is_refused() {
        let error = views(Path::new("away.bcc"), &[], SIZE, &[ViewKind::Full]).unwrap_err();
        assert_eq!(error.exit_code(), 2);
    }
}
