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

#[cfg(test)]
mod tests {
    use super::*;

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
