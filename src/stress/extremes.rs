//! Ten pictures at the ends of what can be drawn: for the eye, and for what can be counted of a picture.

use super::cases::{Case, set};
use super::geometry::scene_of;
use super::verdict::{Collector, Row};
use crate::error::Error;
use crate::frame::sampling::Sampling;
use crate::frame::{Renderer, Request};
use crate::io::curves::CurveSet;
use crate::knit::params::KnitParams;
use crate::knit::stockinette::stockinette;
use crate::math::curve::Basis;
use crate::scene::Scene;
use crate::vulkan::Device;
use glam::DVec3;
use std::sync::Arc;

/// One picture.
pub struct Extreme {
    /// What is extreme about it.
    pub name: &'static str,
    /// What the scene file says besides the yarn.
    pub scene: &'static str,
    /// What its `[yarn]` table says.
    pub yarn: &'static str,
    curves: fn() -> Result<CurveSet, Error>,
    /// Shares of the picture between which what is covered must lie.
    pub covered: [f64; 2],
}

fn swatch() -> Result<CurveSet, Error> {
    Ok(stockinette(&KnitParams { courses: 3, wales: 4, ..KnitParams::swatch() })?)
}

fn far_swatch() -> Result<CurveSet, Error> {
    let mut far = swatch()?;
    far.curves.iter_mut().flat_map(|curve| &mut curve.points).for_each(|p| *p += DVec3::new(1e6, 0.0, 0.0));
    Ok(far)
}

fn strand() -> Result<CurveSet, Error> {
    let points =
        (0..12).map(|i| DVec3::new(1.5 * f64::from(i) - 8.0, (0.6 * f64::from(i)).sin(), 0.0)).collect();
    Ok(set(Basis::CatmullRom, points, false))
}

fn hairpins() -> Result<CurveSet, Error> {
    let at = |i: u32| DVec3::new(f64::from(i % 2) * 9.0 - 4.5, 1.6 * f64::from(i / 2) - 4.0, 0.0);
    let mut points: Vec<DVec3> = (0..12).map(at).collect();
    points.push(points[11]);
    Ok(set(Basis::CatmullRom, points, false))
}

fn cusps() -> Result<CurveSet, Error> {
    let v = DVec3::new;
    let points = vec![
        v(-6.0, -2.0, 0.0),
        v(6.0, 5.0, 0.0),
        v(-6.0, 5.0, 0.0),
        v(6.0, -2.0, 0.0),
        v(6.0, -2.0, 0.0),
        v(6.0, -2.0, 0.0),
        v(0.0, -4.0, 0.0),
    ];
    Ok(set(Basis::Bezier, points, false))
}

fn coil() -> Result<CurveSet, Error> {
    let at = |i: u32| {
        let a = 0.6 * f64::from(i);
        DVec3::new(0.12 * f64::from(i) - 4.0, 0.4 * a.cos(), 0.4 * a.sin())
    };
    Ok(set(Basis::CatmullRom, (0..70).map(at).collect(), false))
}

/// Pieces of 9 and 17 mm hold as many turns of their fibers as twenty of a usual model.
const LONG_PIECES: &str = "quality.max_subdivisions = 64";

/// The ten.
pub static EXTREMES: [Extreme; 10] = [
    Extreme {
        name: "fibers at the threshold of level of detail",
        scene: "camera.distance_mm = 60\ncamera.target_mm = [0, 0, 0]\nquality.lod_threshold_samples = 0.4",
        yarn: "",
        curves: swatch,
        covered: [0.1, 1.0],
    },
    Extreme {
        name: "the camera inside a yarn",
        scene: "camera.distance_mm = 0.3\ncamera.target_mm = [0, 0, 0]\ncamera.yaw_deg = 80\ncamera.fov_y_deg = 90",
        yarn: "",
        curves: strand,
        covered: [0.2, 1.0],
    },
    Extreme {
        name: "the near plane through a loop",
        scene: "camera.distance_mm = 2.5\ncamera.target_mm = [0, 0, 0]\ncamera.pitch_deg = 50\ncamera.fov_y_deg = 100",
        yarn: "",
        curves: swatch,
        covered: [0.2, 1.0],
    },
    Extreme {
        name: "hairpins of 180 degrees",
        scene: LONG_PIECES,
        yarn: "",
        curves: hairpins,
        covered: [0.05, 0.9],
    },
    Extreme {
        name: "a cusp and a repeated point",
        scene: LONG_PIECES,
        yarn: "",
        curves: cusps,
        covered: [0.02, 0.9],
    },
    Extreme { name: "bends tighter than the yarn", scene: "", yarn: "", curves: coil, covered: [0.02, 0.9] },
    Extreme {
        name: "ellipses 100:1",
        scene: "",
        yarn: "ellipse_short_mm = 0.007\nellipse_long_mm = 0.7",
        curves: strand,
        covered: [0.02, 0.9],
    },
    Extreme {
        name: "1 km from the origin",
        scene: "camera.yaw_deg = 18\ncamera.pitch_deg = 12\ncamera.distance_mm = 30\ncamera.target_mm = [1e6, 0, 0]",
        yarn: "",
        curves: far_swatch,
        covered: [0.3, 1.0],
    },
    Extreme {
        name: "lobes of half a degree, light along the fibers",
        scene: "camera.pitch_deg = 20\nfiber.beta_r_deg = 0.5\nfiber.beta_tt_deg = 0.5\nfiber.gamma_tt_deg = 0.5\nlight = [{direction = [-1, -0.05, -0.02], irradiance = [3, 3, 3]}]",
        yarn: "",
        curves: strand,
        covered: [0.02, 0.9],
    },
    Extreme {
        name: "radiance of 1e6 at -20 stops",
        scene: "display.exposure_stops = -20\nambient.radiance = [1e5, 1e5, 1e5]\nlight = [{direction = [-0.5, -0.7, -0.5], irradiance = [1e6, 1e6, 1e6]}]",
        yarn: "",
        curves: swatch,
        covered: [0.2, 1.0],
    },
];

impl Extreme {
    /// Its scene.
    ///
    /// # Errors
    /// What a scene file may not say, fabric that cannot be knitted.
    pub fn scene(&self) -> Result<Scene, Error> {
        let case = Case {
            name: self.name.to_owned(),
            domain: String::new(),
            yarn: self.yarn.to_owned(),
            curves: (self.curves)()?,
            smooth: false,
        };
        let close = if self.scene.contains("camera.") { "" } else { "camera.fit = true\n" };
        scene_of(&case, &format!("{close}{}", self.scene))
    }
}

/// All rows: small pictures, no pixel of which is not finite, covered as they should be.
///
/// # Errors
/// Those of the device.
pub fn rows(device: &Arc<Device>, quick: bool) -> Result<Vec<Row>, Error> {
    let (size, stride) = if quick { ([32, 24], 3) } else { ([96, 72], 1) };
    EXTREMES.iter().step_by(stride).map(|extreme| row(device, extreme, size)).collect()
}

fn row(device: &Arc<Device>, extreme: &Extreme, size: [u32; 2]) -> Result<Row, Error> {
    let request = Request {
        size,
        sampling: Sampling::new(4).map_err(Error::Failed)?,
        statistics: false,
        profile: false,
    };
    let picture = Renderer::new(device, extreme.scene()?, request)?.render(&|_| ())?;
    let mut c = Collector::default();
    judge_picture(&mut c, &picture.linear, extreme.covered);
    Ok(c.row(
        "pictures",
        extreme.name,
        &format!("{} x {} pixels", size[0], size[1]),
        "finite, covered as expected",
    ))
}

/// Counts pixels that cannot be, and demands a coverage.
fn judge_picture(c: &mut Collector, pixels: &[[f32; 4]], [least, most]: [f64; 2]) {
    for (index, pixel) in pixels.iter().enumerate() {
        c.points(1);
        c.numbers(&pixel.map(f64::from), false, || format!("pixel {index}"));
    }
    let covered = pixels.iter().map(|p| f64::from(p[3])).sum::<f64>() / pixels.len() as f64;
    c.demand((least..=most).contains(&covered), || format!("{covered:.3} of the picture is covered"));
    let light = pixels.iter().map(|p| f64::from(p[1])).fold(0.0, f64::max);
    c.demand(light > 0.0, || "all is black".to_owned());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_that_cannot_be_are_rejected() {
        let judged = |pixels: &[[f32; 4]]| {
            let mut c = Collector::default();
            judge_picture(&mut c, pixels, [0.2, 0.8]);
            c.row("pictures", "", "", "").faults
        };
        let (lit, empty) = ([0.5, 0.5, 0.5, 1.0], [0.0; 4]);
        assert!(judged(&[lit, empty]).is_empty());
        assert!(judged(&[empty, empty]).len() == 2, "nothing is there");
        assert!(judged(&[lit, lit])[0].contains("1.000 of the picture"));
        assert!(judged(&[[0.0, 0.0, 0.0, 1.0], empty])[0].contains("black"));
        for wrong in [f32::NAN, f32::INFINITY, -0.1] {
            assert!(!judged(&[[wrong, 0.5, 0.5, 1.0], empty]).is_empty(), "{wrong}");
        }
    }

    #[test]
    fn every_extreme_is_a_scene() {
        for extreme in &EXTREMES {
            extreme.scene().unwrap_or_else(|error| panic!("{}: {error}", extreme.name));
        }
    }
}
