//! Tests of bias and noise: simulated pictures whose bias and variance are known.

use super::*;
use crate::io::picture::LinearImage;
use crate::math::rng::Rng;

const SIDE: u32 = 48;
const PIXELS: usize = (SIDE * SIDE) as usize;
/// Samples a pixel.
const SAMPLES: usize = 32;

/// A picture of noisy samples around `truth`, with the variance of its means, as a path tracer states them.
fn simulated(seed: u64, truth: impl Fn(usize) -> [f64; 3]) -> MeasuredImage {
    let (mut image, mut variance) = (LinearImage::filled(SIDE, SIDE, [0.0, 0.0, 0.0, 1.0]), Vec::new());
    let mut rng = Rng::new(seed, &[]);
    for (index, pixel) in image.pixels.iter_mut().enumerate() {
        let wanted = truth(index);
        let (mut sum, mut squares) = ([0.0; 3], [0.0; 3]);
        for _ in 0..SAMPLES {
            // As skewed as radiance is: most samples dark, few bright; the channels together.
            let bright = 3.0 * rng.uniform().powi(2);
            for channel in 0..3 {
                let sample = wanted[channel] * bright;
                sum[channel] += sample;
                squares[channel] += sample * sample;
            }
        }
        let n = SAMPLES as f64;
        for channel in 0..3 {
            pixel[channel] = (sum[channel] / n) as f32;
        }
        variance.push(std::array::from_fn(|c| {
            ((squares[c] - sum[c] * sum[c] / n).max(0.0) / (n - 1.0) / n) as f32
        }));
    }
    MeasuredImage { mean: image, variance: Some(variance) }
}

fn scene(index: usize) -> [f64; 3] {
    let x = (index % SIDE as usize) as f64;
    let value = 0.3 + 0.2 * (0.7 * x).sin();
    [value, 0.5 * value, 0.1]
}

fn noise_of(test: &MeasuredImage, reference: &MeasuredImage) -> Noise {
    separate(test, reference).unwrap().unwrap()
}

/// A picture of one color that says nothing of its noise.
fn flat(color: [f32; 3]) -> MeasuredImage {
    let [r, g, b] = color;
    MeasuredImage { mean: LinearImage::filled(4, 2, [r, g, b, 1.0]), variance: None }
}

#[test]
fn two_pictures_of_one_scene_differ_by_noise_alone() {
    let mut alarms = 0;
    for seed in 0..12 {
        let noise = noise_of(&simulated(seed, scene), &simulated(1000 + seed, scene));
        let RegionNoise { variance, bias_squared, bias_squared_error } = noise.covered;
        println!(
            "bias squared {bias_squared:.2e} +- {bias_squared_error:.1e}, noise {variance:.2e}, {:?}",
            noise.blocks
        );
        assert!(bias_squared.abs() < 4.0 * bias_squared_error, "seed {seed}: {noise:?}");
        assert!(bias_squared_error < 0.1 * variance, "seed {seed}: an error that says nothing");
        assert!(noise.blocks.beyond_3 < 0.02, "seed {seed}: {:?}", noise.blocks);
        alarms += u32::from(noise.blocks.differs);
    }
    assert!(alarms <= 1, "{alarms} of 12 pairs that differ by noise alone were called different");
}

#[test]
fn a_bias_below_the_noise_is_found_and_measured() {
    // 3% brighter: a tenth of a pixel's noise.
    let brighter = |index| scene(index).map(|v| 1.03 * v);
    let truth = (0..PIXELS).flat_map(scene).map(|v| (0.03 * v).powi(2)).sum::<f64>() / (3 * PIXELS) as f64;
    let noise = noise_of(&simulated(5, brighter), &simulated(6, scene));
    let RegionNoise { variance, bias_squared, bias_squared_error } = noise.covered;
    assert!(truth < 0.1 * variance, "the test wants more noise than bias: {truth} {variance}");
    assert!((bias_squared - truth).abs() < 3.0 * bias_squared_error, "{truth}: {noise:?}");
    // Unseen in the squared error, plain in the sum over blocks: brighter everywhere.
    assert!(noise.blocks.largest_z.abs() > 3.0, "{noise:?}");
}

#[test]
fn wrong_pictures_are_called_different_at_once() {
    let good = simulated(7, scene);
    let swapped = |index| {
        let [r, g, b] = scene(index);
        [b, g, r]
    };
    let moved = |index| scene(index + 2);
    let dark_corner = |index: usize| {
        let inside = index % (SIDE as usize) < 8 && index / (SIDE as usize) < 8;
        scene(index).map(|v| if inside { 0.6 * v } else { v })
    };
    for (name, truth) in [
        ("swapped channels", &swapped as &dyn Fn(usize) -> [f64; 3]),
        ("moved", &moved),
        ("a dark corner", &dark_corner),
    ] {
        let noise = noise_of(&simulated(8, truth), &good);
        assert!(noise.blocks.differs, "{name}: {noise:?}");
        if name == "a dark corner" {
            assert_eq!(noise.blocks.largest_at, [0, 0]);
            assert!(noise.blocks.largest_z < 0.0, "{noise:?}");
        } else {
            assert!(
                noise.covered.bias_squared > 10.0 * noise.covered.bias_squared_error,
                "{name}: {noise:?}"
            );
        }
    }
}

#[test]
fn a_constant_bias_without_noise_is_exact() {
    let reference = MeasuredImage { variance: Some(vec![[0.01, 0.0, 0.02]; 8]), ..flat([0.5; 3]) };
    let noise = noise_of(&flat([0.75, 0.5, 0.5]), &reference);
    assert!((noise.covered.variance - 0.01).abs() < 1e-8, "{noise:?}");
    assert!((noise.covered.bias_squared - (0.0625 - 0.03) / 3.0).abs() < 1e-8, "{noise:?}");
    assert!(noise.covered.bias_squared_error < 1e-12);
    assert!((noise.blocks.largest_z - 0.25 * 8_f64.sqrt() / 0.1).abs() < 1e-4, "{noise:?}");
}

#[test]
fn only_covered_pixels_count_for_blocks() {
    let [mut image, mut other] = [9, 10].map(|seed| simulated(seed, scene));
    image.mean.pixels.iter_mut().chain(&mut other.mean.pixels).for_each(|p| p[3] = 0.0);
    image.mean.pixels[0][3] = 1.0;
    // A difference that no yarn covers.
    image.mean.pixels[40][0] += 10.0;
    let noise = noise_of(&image, &other);
    assert_eq!(noise.blocks.count, 1);
    assert!(noise.blocks.largest_z.abs() < 6.0 && noise.whole.bias_squared > 1e-3, "{noise:?}");
}

#[test]
fn without_a_variance_there_is_nothing_to_tell() {
    assert_eq!(separate(&flat([0.5; 3]), &flat([0.1; 3])).unwrap(), None);
}

#[test]
fn senseless_variances_are_refused_and_named() {
    let good = simulated(1, scene);
    let refusal = |variance: Vec<[f32; 3]>| {
        let bad = MeasuredImage { variance: Some(variance), ..good.clone() };
        let as_test = separate(&bad, &good).unwrap_err().to_string();
        let as_reference = separate(&good, &bad).unwrap_err().to_string();
        assert!(as_test.starts_with("test picture:"), "{as_test}");
        assert!(as_reference.starts_with("reference picture:"), "{as_reference}");
        as_test
    };
    let variance = good.variance.clone().unwrap();
    assert!(refusal(variance[1..].to_vec()).contains("2304"));
    for bad in [-1e-9, f32::NAN, f32::INFINITY] {
        let mut wrong = variance.clone();
        wrong[SIDE as usize * 3 + 5][2] = bad;
        assert!(refusal(wrong).contains("pixel (5, 3)"));
    }
}
