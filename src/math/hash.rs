//! Random numbers from stable indices; twin of `glsl/lib/hash.glsl`, equal bit for bit.

use std::f64::consts::TAU;

/// Four well mixed words from four indices (pcg4d: Jarzynski & Olano 2020).
pub fn hash_words(indices: [u32; 4]) -> [u32; 4] {
    let [mut x, mut y, mut z, mut w] = indices.map(|v| v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    let mix = |x: &mut u32, y: &mut u32, z: &mut u32, w: &mut u32| {
        *x = x.wrapping_add(y.wrapping_mul(*w));
        *y = y.wrapping_add(z.wrapping_mul(*x));
        *z = z.wrapping_add(x.wrapping_mul(*y));
        *w = w.wrapping_add(y.wrapping_mul(*z));
    };
    mix(&mut x, &mut y, &mut z, &mut w);
    for v in [&mut x, &mut y, &mut z, &mut w] {
        *v ^= *v >> 16;
    }
    mix(&mut x, &mut y, &mut z, &mut w);
    [x, y, z, w]
}

/// Uniform in (0, 1), exact in f32: 24 bits and a half.
pub fn uniform_from_word(word: u32) -> f64 {
    (f64::from(word >> 9) + 0.5) / 8_388_608.0
}

/// A standard normal number cut off at three deviations (Box & Muller 1958).
pub fn normal_from_words(a: u32, b: u32) -> f64 {
    let radius = (-2.0 * uniform_from_word(a).ln()).sqrt();
    (radius * (TAU * uniform_from_word(b)).cos()).clamp(-3.0, 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn consecutive_indices_give_independent_uniform_numbers() {
        let n = 200_000u32;
        // Correlation of neighbours along every index, and mean and variance of every word.
        for axis in 0..4 {
            let draw = |i: u32| {
                let mut indices = [7, 11, 13, 17];
                indices[axis] = i;
                hash_words(indices).map(|w| uniform_from_word(w) - 0.5)
            };
            for word in 0..4 {
                let values: Vec<f64> = (0..n).map(|i| draw(i)[word]).collect();
                let mean = values.iter().sum::<f64>() / f64::from(n);
                let variance = values.iter().map(|v| v * v).sum::<f64>() / f64::from(n);
                let neighbours = values.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / f64::from(n);
                // Five standard errors each.
                let root = f64::from(n).sqrt();
                assert!(
                    mean.abs() < 5.0 * (1.0f64 / 12.0).sqrt() / root,
                    "axis {axis} word {word}: mean {mean}"
                );
                assert!((variance - 1.0 / 12.0).abs() < 5.0 * (1.0f64 / 180.0).sqrt() / root);
                assert!(neighbours.abs() < 5.0 / 12.0 / root, "axis {axis} word {word}: {neighbours}");
            }
        }
    }

    #[test]
    fn normal_numbers_have_their_moments() {
        let n = 200_000;
        let values: Vec<f64> = (0..n)
            .map(|i| {
                let w = hash_words([i, 1, 2, 3]);
                normal_from_words(w[0], w[1])
            })
            .collect();
        let mean = values.iter().sum::<f64>() / f64::from(n);
        let variance = values.iter().map(|v| v * v).sum::<f64>() / f64::from(n);
        assert!(mean.abs() < 5.0 / f64::from(n).sqrt());
        // The cut at three deviations takes 0.5% of the variance.
        assert!((variance - 0.9952).abs() < 0.015, "{variance}");
    }
}
