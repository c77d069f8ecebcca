//! Pictures of a yarn's cross-section.

use glam::DVec2;
use std::f64::consts::TAU;
use worsted::frame::Picture;
use worsted::precompute::optical_depth::CrossSection;

/// Density that is shown white.
pub const WHITE_DENSITY: f64 = 4.0;

/// A square of `pixels` around the outer circle; `color` is given the place in outer radii, x rightward and y
/// upward, and gives bytes' shares of 255.
pub fn section(pixels: u32, color: impl Fn(DVec2) -> [f64; 3]) -> Picture {
    let place = |i: u32| 2.0 * (f64::from(i) + 0.5) / f64::from(pixels) - 1.0;
    let pixel = |i: u32| {
        let [r, g, b] = color(DVec2::new(place(i % pixels), -place(i / pixels)));
        let byte = |c: f64| (255.0 * c.clamp(0.0, 1.0)).round() as u8;
        [byte(r), byte(g), byte(b), 255]
    };
    Picture {
        size: [pixels; 2],
        linear: Vec::new(),
        display: (0..pixels * pixels).map(pixel).collect(),
        layers: None,
    }
}

/// Sum of all plies' densities, averaged over migration, at `position` in outer radii, ply 0 along x.
pub fn density(section: &CrossSection<'_>, position: DVec2) -> f64 {
    let yarn = section.yarn;
    let position_mm = position * yarn.outer_radius_mm();
    let of_ply = |ply: u32| {
        let turn = DVec2::from_angle(-TAU * f64::from(ply) / f64::from(yarn.ply_count));
        let place = turn.rotate(position_mm) - DVec2::new(yarn.ply_offset_mm(), 0.0);
        let radius = (place / DVec2::new(yarn.ellipse_short_mm, yarn.ellipse_long_mm)).length();
        section.density.at(radius)
    };
    (0..yarn.ply_count).map(of_ply).sum()
}

/// A difference in [-1, 1]: red above 0, blue below.
pub fn signed(difference: f64) -> [f64; 3] {
    [difference.max(0.0), 0.35 * difference.abs(), (-difference).max(0.0)]
}
