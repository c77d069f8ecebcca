//! From linear radiance to what a display shows; twin of `glsl/lib/tone.glsl`.

use glam::DVec3;

/// Above this the neutral curve bends; below it is the identity.
pub const TONE_KNEE: f64 = 0.8;

/// Identity up to the knee, then a hyperbola with the same slope that reaches 1 at infinity; scales
/// the colour by its largest component, so that hue is kept. Negative components become 0.
pub fn tone_neutral(linear: DVec3) -> DVec3 {
    let peak = linear.max_element();
    if peak <= TONE_KNEE {
        return linear.max(DVec3::ZERO);
    }
    let room = 1.0 - TONE_KNEE;
    let bent = 1.0 - room * room / (peak + room - TONE_KNEE);
    linear.max(DVec3::ZERO) * (bent / peak)
}

/// Above this the filmic curve is past 1.
pub const FILMIC_END: f64 = 8.0;

/// Narkowicz 2015's fit of ACES' reference and sRGB output transforms ("ACES Filmic Tone Mapping Curve"),
/// component by component: contrast in the middle, highlights that fade to white. 18% grey becomes 0.267, 1.0
/// becomes 0.804, 7.24 and more becomes 1. Negative components become 0.
pub fn tone_filmic(linear: DVec3) -> DVec3 {
    let x = linear.clamp(DVec3::ZERO, DVec3::splat(FILMIC_END));
    (x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)).min(DVec3::ONE)
}

/// Curves from linear radiance, exposed, to the light that a display gives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tone {
    /// Cut at 1: the plainest, which shows every bright difference as none.
    Clamp,
    /// [`tone_neutral`]: a scene's default.
    #[default]
    Neutral,
    /// [`tone_filmic`].
    Filmic,
}

impl Tone {
    /// The light shown, every component in [0, 1].
    pub fn apply(self, linear: DVec3) -> DVec3 {
        let curved = match self {
            Self::Clamp => linear,
            Self::Neutral => tone_neutral(linear),
            Self::Filmic => tone_filmic(linear),
        };
        curved.clamp(DVec3::ZERO, DVec3::ONE)
    }
}

/// How radiance is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Display {
    /// Factor on radiance, above 0; 1 = as it is.
    pub exposure: f64,
    /// The tone curve after it.
    pub tone: Tone,
}

impl Display {
    /// As it is, cut at 1.
    pub const PLAIN: Self = Self { exposure: 1.0, tone: Tone::Clamp };
}

impl Default for Display {
    /// As a scene is shown that says nothing of it.
    fn default() -> Self {
        Self { exposure: 1.0, tone: Tone::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_filmic_curve_rises_from_0_to_1_through_its_stated_values() {
        let curve = |x: f64| tone_filmic(DVec3::splat(x)).x;
        for (x, y) in [(0.0, 0.0), (-3.0, 0.0), (0.18, 0.267), (1.0, 0.804), (7.25, 1.0), (1e30, 1.0)] {
            assert!((curve(x) - y).abs() < 5e-4, "{x}: {}", curve(x));
        }
        assert!((1..=724).all(|i| curve(f64::from(i) * 0.01) > curve(f64::from(i - 1) * 0.01)));
        assert!(curve(7.24) < 1.0);
        // Bright red fades toward white; the neutral curve keeps its hue.
        let red = DVec3::new(20.0, 2.0, 2.0);
        assert!(tone_filmic(red).y > 0.9 && tone_neutral(red).y < 0.11);
    }

    #[test]
    fn every_curve_gives_what_a_display_can_show() {
        let bright = DVec3::new(0.9, 40.0, -2.0);
        for tone in [Tone::Clamp, Tone::Neutral, Tone::Filmic] {
            let shown = tone.apply(bright);
            assert!(shown.min_element() >= 0.0 && shown.max_element() <= 1.0 && shown.z == 0.0, "{tone:?}");
        }
        assert_eq!(Tone::Clamp.apply(bright), DVec3::new(0.9, 1.0, 0.0));
        assert_eq!(Tone::default().apply(bright), tone_neutral(bright));
        assert_eq!(Tone::Filmic.apply(bright), tone_filmic(bright));
    }

    #[test]
    fn identity_below_the_knee_smooth_at_it_and_below_one_above() {
        let curve = |x: f64| tone_neutral(DVec3::splat(x)).x;
        assert_eq!(curve(0.5), 0.5);
        let h = 1e-6;
        assert!((curve(TONE_KNEE + h) - curve(TONE_KNEE) - h).abs() < 1e-10);
        let mut last = 0.0;
        for i in 1..1000 {
            let y = curve(f64::from(i) * 0.1);
            assert!(y > last && y < 1.0);
            last = y;
        }
    }
}
