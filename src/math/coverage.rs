//! Coverage by samples in place of blending; twin of `glsl/lib/coverage.glsl`.

use super::hash::uniform_from_word;

/// Mask of the samples of a pixel that something covering `alpha` of it takes: as many as alpha asks for, the
/// last by chance, from a random one on, so that two things of the same alpha hide each other no more than by
/// chance. `samples` is 1 to 32.
pub fn coverage_mask(alpha: f64, samples: u32, word: u32) -> u32 {
    let wanted = alpha.clamp(0.0, 1.0) * f64::from(samples);
    let taken = ((wanted + uniform_from_word(word)) as u32).min(samples);
    let ones = |count: u32| if count == 0 { 0 } else { u32::MAX >> (32 - count) };
    let (all, run, shift) = (ones(samples), ones(taken), word % samples);
    if shift == 0 { run } else { ((run << shift) | (run >> (samples - shift))) & all }
}

/// The edge of a magnified texture: `texels` per pixel below 1 make its coverage as steep as its texels are
/// large, about one half.
pub fn sharpened_coverage(alpha: f64, texels: f64) -> f64 {
    if texels >= 1.0 { alpha } else { (0.5 + (alpha - 0.5) / texels.max(1e-3)).clamp(0.0, 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::mix64;

    #[test]
    fn as_many_samples_as_alpha_asks_for_on_average_and_none_preferred() {
        for samples in [1, 4] {
            for alpha in [0.0, 0.1, 0.5, 0.77, 1.0] {
                let mut counts = vec![0u32; samples as usize];
                let draws = 40_000;
                for i in 0..draws {
                    let mask = coverage_mask(alpha, samples, mix64(i) as u32);
                    assert!(u64::from(mask) < 1 << samples);
                    for (sample, count) in counts.iter_mut().enumerate() {
                        *count += mask >> sample & 1;
                    }
                }
                for count in counts {
                    let share = f64::from(count) / draws as f64;
                    assert!((share - alpha).abs() < 0.012, "alpha {alpha}, {samples} samples: {share}");
                }
            }
        }
    }

    #[test]
    fn an_edge_is_as_steep_as_its_texels_are_large() {
        assert_eq!(sharpened_coverage(0.3, 2.0), 0.3);
        assert_eq!(sharpened_coverage(0.5, 0.1), 0.5);
        assert!((sharpened_coverage(0.6, 0.5) - 0.7).abs() < 1e-12);
        assert_eq!(sharpened_coverage(0.6, 0.1), 1.0);
        assert_eq!(sharpened_coverage(0.4, 0.0), 0.0);
    }
}
