//! What `measure budgets` fits a front to, and the scenes that it holds the promises against.

use crate::stage::{Cloth, Model, Stage, pixel_tangent};
use std::path::PathBuf;
use worsted::error::Error;

/// Yarn of what the front is fitted to.
pub const YARN: &str = "worsted_3ply";
/// What the front is fitted to.
pub const FITTED: Cloth = Cloth::Stockinette { wales: 8, courses: 10 };
const FOV_Y_DEG: f64 = 35.0;

/// A scene that the front was not fitted to.
pub struct Other {
    /// What it is called.
    pub name: &'static str,
    /// Preset of its yarn.
    pub yarn: &'static str,
    /// What is knitted.
    pub cloth: Cloth,
    /// Yaw and pitch.
    pub angles_deg: [f64; 2],
    /// Width of a fiber at the cloth's front; all of the cloth where there is none.
    pub fiber_px: Option<f64>,
    /// Height as a share of the fitted pictures'.
    pub height: f64,
    /// Scene keys that are set.
    pub sets: &'static [&'static str],
}

/// Like what was fitted, but for cloth, camera, size and fly-aways: here a promise must be made and kept. The margin of
/// errors was set by the first, and by nothing else here; that of times by the first and the second. The last two are of another yarn, and farther away than
/// anything fitted: here it must be refused.
pub const OTHERS: [Other; 6] = [
    Other {
        name: "tube, near",
        yarn: YARN,
        cloth: Cloth::Tube { wales: 12, courses: 9 },
        angles_deg: [-35.0, 8.0],
        fiber_px: Some(0.95),
        height: 1.0,
        sets: &["seed=5"],
    },
    Other {
        name: "tube, nearer",
        yarn: YARN,
        cloth: Cloth::Tube { wales: 14, courses: 7 },
        angles_deg: [40.0, -15.0],
        fiber_px: Some(1.1),
        height: 1.0,
        sets: &["seed=15"],
    },
    Other {
        name: "looser swatch, between",
        yarn: YARN,
        cloth: Cloth::Loose { wales: 8, courses: 10 },
        angles_deg: [-30.0, 20.0],
        fiber_px: Some(0.5),
        height: 1.2,
        sets: &["seed=16"],
    },
    Other {
        name: "looser swatch, whole",
        yarn: YARN,
        cloth: Cloth::Loose { wales: 7, courses: 8 },
        angles_deg: [-55.0, -20.0],
        fiber_px: None,
        height: 1.2,
        sets: &["seed=17"],
    },
    Other {
        name: "swatch of rayon1",
        yarn: "rayon1",
        cloth: FITTED,
        angles_deg: [20.0, 15.0],
        fiber_px: None,
        height: 1.0,
        sets: &[],
    },
    Other {
        name: "swatch, far",
        yarn: YARN,
        cloth: FITTED,
        angles_deg: [20.0, 15.0],
        fiber_px: Some(0.01),
        height: 1.0,
        sets: &[],
    },
];
/// How many of them must get promises.
pub const PROMISED: usize = 4;

/// Width and height of a picture of that height.
pub fn size(height: u32) -> [u32; 2] {
    [height * 4 / 3, height]
}

/// Size of the scene's pictures where fitted ones are so high.
pub fn other_size(height: u32, other: &Other) -> [u32; 2] {
    size((f64::from(height) * other.height).round() as u32)
}

/// The scene's file is written, and what must be set of it is returned. Fitted pictures are `height` pixels high.
///
/// # Errors
/// Files that cannot be written.
pub fn camera(stage: &Stage, height: u32, other: &Other) -> Result<(PathBuf, Vec<String>), Error> {
    let Model { path, yarn, front_mm, .. } = stage.model(other.yarn, other.cloth)?;
    let [yaw_deg, pitch_deg] = other.angles_deg;
    let mut sets = vec![
        format!("camera.fov_y_deg={FOV_Y_DEG:?}"),
        format!("camera.yaw_deg={yaw_deg:?}"),
        format!("camera.pitch_deg={pitch_deg:?}"),
    ];
    match other.fiber_px {
        None => sets.push("camera.fit=true".into()),
        Some(fiber_px) => {
            let [_, height_px] = other_size(height, other);
            let fiber_mm = 2.0 * yarn.fiber_radius_mm();
            let distance_mm = fiber_mm / fiber_px / pixel_tangent(FOV_Y_DEG, height_px);
            sets.push(format!("camera.distance_mm={distance_mm:?}"));
            sets.push(format!("camera.target_mm=[0.0, 0.0, {front_mm:?}]"));
        }
    }
    sets.extend(other.sets.iter().map(|set| (*set).to_owned()));
    Ok((path, sets))
}
