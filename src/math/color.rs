//! The sRGB transfer functions of IEC 61966-2-1: linear light to display code values and back.

/// Linear value below which the sRGB curve is a straight line.
const LINEAR_TOE: f64 = 0.003_130_8;
/// Encoded value below which the sRGB curve is a straight line.
const ENCODED_TOE: f64 = 0.040_45;

/// The sRGB code value in [0, 1] of a linear-light value in [0, 1].
///
/// Outside that range the curve goes on (odd in its argument, so that negative values keep their sign), and
/// NaN stays NaN: whoever needs a displayable value clamps, and says so.
pub fn srgb_from_linear(linear: f64) -> f64 {
    let magnitude = linear.abs();
    let encoded =
        if magnitude <= LINEAR_TOE { 12.92 * magnitude } else { 1.055 * magnitude.powf(1.0 / 2.4) - 0.055 };
    encoded.copysign(linear)
}

/// The linear-light value in [0, 1] of an sRGB code value in [0, 1]: the inverse of [`srgb_from_linear`], with
/// the same behaviour outside the range.
pub fn linear_from_srgb(encoded: f64) -> f64 {
    let magnitude = encoded.abs();
    let linear =
        if magnitude <= ENCODED_TOE { magnitude / 12.92 } else { ((magnitude + 0.055) / 1.055).powf(2.4) };
    linear.copysign(encoded)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values_of_the_standard() {
        // 18 % grey and the two ends; the middle code value 0.5 is 21.4 % linear.
        assert_eq!(srgb_from_linear(0.0), 0.0);
        assert!((srgb_from_linear(1.0) - 1.0).abs() < 1e-12);
        assert!((srgb_from_linear(0.18) - 0.461_356_129_500_441_5).abs() < 1e-12);
        assert!((linear_from_srgb(0.5) - 0.214_041_140_482_232_6).abs() < 1e-12);
    }

    #[test]
    fn inverse_of_each_other_and_strictly_rising() {
        let mut last = f64::NEG_INFINITY;
        for step in -2_000..=4_000 {
            let linear = f64::from(step) / 1_000.0;
            let encoded = srgb_from_linear(linear);
            assert!(encoded > last, "not rising at {linear}");
            last = encoded;
            // The standard rounds its constants, so the two pieces miss each other by some 1e-8 at the toe.
            assert!((linear_from_srgb(encoded) - linear).abs() < 1e-7, "at {linear}");
        }
    }

    #[test]
    fn every_byte_survives_a_round_trip() {
        for byte in 0..=255_u8 {
            let linear = linear_from_srgb(f64::from(byte) / 255.0);
            assert_eq!((srgb_from_linear(linear) * 255.0).round() as u8, byte);
        }
    }

    #[test]
    fn not_a_number_stays_so() {
        assert!(srgb_from_linear(f64::NAN).is_nan() && linear_from_srgb(f64::NAN).is_nan());
    }
}
