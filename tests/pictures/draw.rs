//! From curves and settings to a picture in process.

use glam::DVec3;
use worsted::frame::sampling::Sampling;
use worsted::frame::stats::Stats;
use worsted::frame::{Renderer, Request};
use worsted::io::bcc::write_bcc;
use worsted::io::curves::{Basis, Curve, CurveSet, UpAxis};
use worsted::io::picture::{DisplayImage, LinearImage};
use worsted::knit::params::KnitParams;
use worsted::knit::stockinette::stockinette;
use worsted::metrics::coverage::Coverage;
use worsted::scene::Scene;
use worsted::vulkan::DeviceChoice;

use crate::device::shared;

/// A swatch of 2 courses of 3 loops.
pub fn swatch() -> CurveSet {
    stockinette(&KnitParams { courses: 2, wales: 3, ..KnitParams::swatch() }).unwrap()
}

/// One open yarn.
pub fn yarn(basis: Basis, points: &[[f64; 3]]) -> CurveSet {
    let points = points.iter().map(|&p| DVec3::from_array(p)).collect();
    CurveSet { basis, up_axis: Some(UpAxis::Y), curves: vec![Curve { points, closed: false }] }
}

/// A curved yarn of few pieces.
pub fn hook() -> CurveSet {
    let points = [
        [-9.0, -6.0, 0.0],
        [-6.0, -1.0, 1.0],
        [-4.0, 4.0, 0.0],
        [0.0, 6.0, -1.0],
        [3.0, 4.0, 0.0],
        [2.0, 1.0, 2.0],
    ];
    yarn(Basis::CatmullRom, &points)
}

/// A scene around `curves`, by way of a file: 1 unit is 1 mm, and `sets` are as after `--set`.
pub fn scene(curves: &CurveSet, sets: &[&str]) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("yarn.bcc");
    write_bcc(&path, curves).unwrap();
    let sets = [&["fabric.mm_per_unit=1"], sets].concat();
    Scene::load(&path, &sets.iter().map(|set| set.to_string()).collect::<Vec<_>>()).unwrap()
}

/// A finished picture as the comparators take it.
pub struct Picture {
    pub linear: LinearImage,
    pub display: DisplayImage,
}

/// The picture and its statistics, both sound: no NaN, nothing clamped, no validation error, not empty.
pub fn draw_counted(scene: Scene, size: [u32; 2], samples: u32, statistics: bool) -> (Picture, Stats) {
    let (picture, stats) = draw_sparse(scene, size, samples, statistics);
    assert!(picture.linear.pixels.iter().any(|pixel| pixel[3] > 0.0), "nothing was drawn");
    (picture, stats)
}

/// The same for a picture that may be empty: a single fiber can fall between all samples.
pub fn draw_sparse(scene: Scene, size: [u32; 2], samples: u32, statistics: bool) -> (Picture, Stats) {
    let device = shared(DeviceChoice::Software);
    let sampling = Sampling::new(samples).unwrap();
    let request = Request { size, sampling, statistics, profile: false };
    let mut renderer = Renderer::new(device, scene, request).unwrap();
    let drawn = renderer.render(&|_| ()).unwrap();
    let [width, height] = drawn.size;
    let picture = Picture {
        linear: LinearImage { width, height, pixels: drawn.linear },
        display: DisplayImage { width, height, pixels: drawn.display },
    };
    device.check_validation().unwrap();
    let stats = renderer.stats().clone();
    assert_eq!((stats.nan_pixels, stats.clamped_pixels), (0, 0));
    picture.linear.check_finite().unwrap();
    (picture, stats)
}

/// [`draw_counted`] without the statistics.
pub fn draw(scene: Scene, size: [u32; 2], samples: u32) -> Picture {
    draw_counted(scene, size, samples, false).0
}

/// Pixels whose values differ at all.
pub fn differing(a: &LinearImage, b: &LinearImage) -> usize {
    assert_eq!((a.width, a.height, a.pixels.len()), (b.width, b.height, b.pixels.len()));
    a.pixels.iter().zip(&b.pixels).filter(|(a, b)| a != b).count()
}

/// Mean over the covered pixels of the RGB radiance.
pub fn mean_radiance(picture: &LinearImage) -> f64 {
    let covered = Coverage::of_linear(picture, picture).unwrap();
    let sum: f64 = covered.indices().flat_map(|i| picture.pixels[i][..3].iter()).map(|&c| f64::from(c)).sum();
    sum / (3 * covered.count()) as f64
}

/// Mean over the covered pixels of a channel's value in the yarn, without the background.
pub fn mean_channel(picture: &LinearImage, channel: usize) -> f64 {
    let (mut sum, mut alpha) = (0.0, 0.0);
    for pixel in &picture.pixels {
        sum += f64::from(pixel[channel]);
        alpha += f64::from(pixel[3]);
    }
    sum / alpha
}

/// Mean row of the yarn, weighted by coverage: 0 is the top, 1 the bottom.
pub fn center_row(picture: &LinearImage) -> f64 {
    let width = picture.width as usize;
    let (mut rows, mut weight) = (0.0, 0.0);
    for (index, pixel) in picture.pixels.iter().enumerate() {
        let alpha = f64::from(pixel[3]);
        rows += alpha * ((index / width) as f64 + 0.5);
        weight += alpha;
    }
    rows / (weight * f64::from(picture.height))
}
