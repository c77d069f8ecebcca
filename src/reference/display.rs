//! From linear radiance to what is shown, as the scene's `[display]` says.

use crate::io::picture::{DisplayImage, LinearImage};
use crate::math::color::srgb_from_linear;
use crate::math::tone::{tone_filmic, tone_neutral};
use crate::scene::file::{DisplayTable, ToneCurve};
use glam::DVec3;

/// The picture over its background, or the yarn alone with its coverage as alpha; exposed, bent by the tone curve and
/// encoded in sRGB.
pub fn displayed(image: &LinearImage, display: &DisplayTable) -> DisplayImage {
    let exposure = display.exposure_stops.exp2();
    let background = DVec3::from_array(display.background);
    let byte = |value: f64| (255.0 * value.clamp(0.0, 1.0)).round() as u8;
    let shown = |&[r, g, b, a]: &[f32; 4]| {
        let (radiance, coverage) = (DVec3::new(r.into(), g.into(), b.into()), f64::from(a));
        let (linear, alpha) = match (display.transparent, coverage > 0.0) {
            (false, _) => (radiance + (1.0 - coverage) * background, 255),
            (true, false) => (DVec3::ZERO, 0),
            // Never from above 0 down to 0.
            (true, true) => (radiance / coverage, byte(coverage).max(1)),
        };
        let toned = match display.tone {
            ToneCurve::Neutral => tone_neutral(exposure * linear),
            ToneCurve::Filmic => tone_filmic(exposure * linear),
        };
        let [r, g, b] = toned.to_array().map(|c| byte(srgb_from_linear(c)));
        [r, g, b, alpha]
    };
    let pixels = image.pixels.iter().map(shown).collect();
    DisplayImage { width: image.width, height: image.height, pixels }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn background_exposure_and_coverage_are_as_the_fast_path_shows_them() {
        let image = LinearImage {
            width: 3,
            height: 1,
            pixels: vec![[0.1, 0.1, 0.1, 0.5], [0.0; 4], [0.2, 0.0, 0.0, 1e-4]],
        };
        let display = DisplayTable { exposure_stops: 1.0, background: [0.2, 0.0, 0.0], ..Default::default() };
        let encoded = |linear: f64| (255.0 * srgb_from_linear(linear)).round() as u8;
        let over = displayed(&image, &display).pixels;
        assert_eq!(over[0], [encoded(0.4), encoded(0.2), encoded(0.2), 255]);
        assert_eq!(over[1], [encoded(0.4), 0, 0, 255]);
        let alone = displayed(&image, &DisplayTable { transparent: true, ..display.clone() }).pixels;
        assert_eq!((alone[0], alone[1]), ([encoded(0.4), encoded(0.4), encoded(0.4), 128], [0; 4]));
        assert_eq!(alone[2][3], 1, "thin yarn is not nothing");
        let filmic = displayed(&image, &DisplayTable { tone: ToneCurve::Filmic, ..display }).pixels;
        assert_ne!(filmic[0], over[0]);
    }
}
