//! Tests of the picture error: known values, and wrong pictures that must be told from right ones.

use super::*;
use crate::math::rng::Rng;

const SIDE: u32 = 64;

/// A disc of coloured, noisy stripes on an empty background: the kind of picture the figures are for.
fn yarn_disc() -> LinearImage {
    let mut rng = Rng::new(3, &[]);
    let pixel = |index: u32| {
        let (x, y) = (f64::from(index % SIDE), f64::from(index / SIDE));
        let stripe = 0.35 + 0.25 * ((x + 0.5 * y) * 0.9).sin();
        let noise = 0.04 * rng.uniform();
        let inside = (x - 32.0).hypot(y - 32.0) < 22.0;
        let color = [stripe + noise, 0.6 * stripe + noise, 0.2 * stripe + noise];
        if inside { [color[0] as f32, color[1] as f32, color[2] as f32, 1.0] } else { [0.0; 4] }
    };
    LinearImage { width: SIDE, height: SIDE, pixels: (0..SIDE * SIDE).map(pixel).collect() }
}

fn changed(change: impl Fn([f32; 4]) -> [f32; 4]) -> LinearImage {
    let mut image = yarn_disc();
    image.pixels.iter_mut().for_each(|pixel| *pixel = change(*pixel));
    image
}

fn covered_error(test: &LinearImage) -> RegionError {
    compare(test, &yarn_disc(), &Display::PLAIN).unwrap().error.covered
}

#[test]
fn equal_pictures_have_no_error() {
    let error = compare(&yarn_disc(), &yarn_disc(), &Display::PLAIN).unwrap().error;
    for region in [error.covered, error.whole] {
        assert_eq!(
            (region.flip_mean, region.flip_max, region.mse, region.relative_mse),
            (0.0, 0.0, 0.0, 0.0)
        );
        assert_eq!(region.psnr_db, f64::INFINITY);
    }
    assert_eq!(error.whole.pixels, (SIDE * SIDE) as usize);
    let area = std::f64::consts::PI * 22.0 * 22.0;
    assert!((error.covered.pixels as f64 / area - 1.0).abs() < 0.02);
}

#[test]
fn a_constant_offset_has_the_squared_error_of_the_formula() {
    // 0.25 apart on half of the picture, in one channel of three.
    let mut reference = LinearImage::filled(4, 2, [0.5, 0.5, 0.5, 0.0]);
    let mut test = reference.clone();
    for index in 0..4 {
        reference.pixels[index][3] = 1.0;
        test.pixels[index][1] += 0.25;
    }
    let error = compare(&test, &reference, &Display::PLAIN).unwrap().error;
    let mse = 0.25 * 0.25 / 3.0;
    assert!((error.covered.mse - mse).abs() < 1e-15);
    assert!((error.whole.mse - mse / 2.0).abs() < 1e-15);
    assert!((error.covered.relative_mse - mse / (0.51 * 0.51)).abs() < 1e-15);
    assert!((error.covered.psnr_db - 10.0 * (1.0 / mse).log10()).abs() < 1e-12);
    assert_eq!((error.covered.pixels, error.whole.pixels), (4, 8));
}

#[test]
fn decibels_are_those_of_the_formula() {
    assert_eq!(psnr_db(1.0), 0.0);
    assert!((psnr_db(1e-3) - 30.0).abs() < 1e-12 && (psnr_db(100.0) + 20.0).abs() < 1e-12);
}

#[test]
fn extreme_radiance_stays_finite() {
    let bright = LinearImage::filled(2, 2, [f32::MAX, 0.0, 0.0, 1.0]);
    let error = compare(&bright, &LinearImage::filled(2, 2, [-f32::MAX, 0.0, 0.0, 1.0]), &Display::PLAIN)
        .unwrap()
        .error;
    assert!(error.covered.mse.is_finite() && error.covered.relative_mse.is_finite());
}

#[test]
fn empty_background_hides_error_in_the_whole_but_not_in_the_covered() {
    let error = compare(&changed(|[r, g, b, a]| [b, g, r, a]), &yarn_disc(), &Display::PLAIN).unwrap().error;
    assert!(error.covered.flip_mean > 1.8 * error.whole.flip_mean, "{error:?}");
    assert!((error.covered.mse / error.whole.mse - 4096.0 / error.covered.pixels as f64).abs() < 1e-9);
}

#[test]
fn wrong_pictures_are_told_from_right_ones() {
    // What independent noise of about one display code value costs: the floor that wrong pictures must exceed.
    let mut rng = Rng::new(8, &[]);
    let mut noisy = yarn_disc();
    noisy.pixels.as_flattened_mut().iter_mut().for_each(|v| *v *= 1.0 + 0.004 * rng.uniform() as f32);
    let floor = covered_error(&noisy);
    assert!(floor.flip_mean < 0.015 && floor.psnr_db > 55.0, "{floor:?}");

    let mut shifted = yarn_disc();
    shifted.pixels.rotate_right(3);
    let wrong = [
        ("swapped channels", changed(|[r, g, b, a]| [b, g, r, a]), 0.5),
        ("shifted by 3 px", shifted, 0.4),
        ("brightness x 1.1", changed(|[r, g, b, a]| [1.1 * r, 1.1 * g, 1.1 * b, a]), 0.1),
        ("black", changed(|[_, _, _, a]| [0.0, 0.0, 0.0, a]), 0.9),
        ("black and uncovered", changed(|_| [0.0; 4]), 0.9),
    ];
    for (name, picture, least_flip) in wrong {
        let error = covered_error(&picture);
        assert!(error.flip_mean > least_flip, "{name}: {error:?}");
        assert!(error.psnr_db < 40.0 && error.relative_mse > 50.0 * floor.relative_mse, "{name}: {error:?}");
    }
}

#[test]
fn every_kind_of_non_finite_value_is_refused_on_either_side_and_named() {
    let good = yarn_disc();
    for bad_value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for channel in 0..4 {
            let mut bad = yarn_disc();
            bad.pixels[(7 * SIDE + 5) as usize][channel] = bad_value;
            bad.pixels[(9 * SIDE + 1) as usize][channel] = bad_value;
            let as_test = compare(&bad, &good, &Display::PLAIN).unwrap_err().to_string();
            let as_reference = compare(&good, &bad, &Display::PLAIN).unwrap_err().to_string();
            assert!(as_test.starts_with("test picture: pixel (5, 7):"), "{as_test}");
            assert!(as_reference.starts_with("reference picture: pixel (5, 7):"), "{as_reference}");
        }
    }
}

#[test]
fn what_cannot_be_judged_is_an_error() {
    let good = yarn_disc();
    let turned = LinearImage { width: SIDE * 2, height: SIDE / 2, ..yarn_disc() };
    let short = LinearImage { pixels: vec![[1.0; 4]; 5], ..yarn_disc() };
    let uncovered = LinearImage::filled(8, 8, [0.3, 0.3, 0.3, 0.0]);
    let empty = LinearImage { width: 0, height: 0, pixels: Vec::new() };
    assert!(matches!(compare(&turned, &good, &Display::PLAIN), Err(MetricError::Sizes { .. })));
    assert!(matches!(compare(&short, &good, &Display::PLAIN), Err(MetricError::Shape(Side::Test, _))));
    assert!(matches!(compare(&good, &short, &Display::PLAIN), Err(MetricError::Shape(Side::Reference, _))));
    assert!(matches!(compare(&uncovered, &uncovered, &Display::PLAIN), Err(MetricError::NothingCovered)));
    assert!(matches!(compare(&empty, &empty, &Display::PLAIN), Err(MetricError::Shape(..))));
    for exposure in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(
            matches!(
                compare(&good, &good, &Display { exposure, ..Display::PLAIN }),
                Err(MetricError::Exposure(_))
            ),
            "{exposure}"
        );
    }
}

#[test]
fn a_difference_in_coverage_alone_widens_the_covered_set() {
    let mut wider = yarn_disc();
    wider.pixels[0][3] = 0.5;
    assert_eq!(covered_error(&wider).pixels, covered_error(&yarn_disc()).pixels + 1);
}
