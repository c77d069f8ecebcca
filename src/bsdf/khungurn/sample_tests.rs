//! The sampler against its density and against quadrature.

use super::super::tests::fiber;
use super::super::{ambient_scattering, bcsdf_cos};
use super::*;
use crate::math::quadrature::integrate;
use crate::math::rng::Rng;

const FIBERS: [(f64, f64, [f64; 3]); 5] = [
    (0.3, 0.6, [7.5, 18.9, 38.5]),
    (0.05, 0.9, [0.5, 3.0, 0.5]),
    (0.0, 1.0, [60.0, 40.0, 60.0]),
    (1.0, 0.5, [20.0, 5.0, 12.0]),
    (0.5, 0.0, [2.0, 5.0, 12.0]),
];
const THETAS: [f64; 5] = [0.0, 0.7, -1.3, 1.56, FRAC_PI_2];

fn draws(seed: u64, n: u32) -> impl Iterator<Item = [f64; 3]> {
    let mut rng = Rng::new(seed, &[]);
    (0..n).map(move |_| std::array::from_fn(|_| rng.uniform()))
}

#[test]
fn the_density_integrates_to_one() {
    for (c_r, c_tt, widths) in FIBERS {
        let fiber = fiber(c_r, c_tt, widths);
        for theta_o in THETAS {
            let over_phi = |theta: f64| {
                let f = |phi: f64| [pdf(theta, theta_o, phi, &fiber) * cosine(theta)];
                integrate([0.0, TAU], 160, 1e-5, &f)
            };
            let range = gaussian_range(-theta_o, fiber.beta_r.max(fiber.beta_tt));
            let [all] = integrate(range, 24, 1e-5, &over_phi);
            assert!((all - 1.0).abs() < 1e-7, "{fiber:?} {theta_o}: {all}");
        }
    }
}

#[test]
fn sampled_light_agrees_with_quadrature_and_its_weights_are_bounded() {
    for (seed, (c_r, c_tt, widths)) in FIBERS.into_iter().enumerate() {
        let fiber = fiber(c_r, c_tt, widths);
        for theta_o in THETAS {
            let n = 4000;
            let (mut sum, mut squares, mut largest) = (0.0, 0.0, 0.0_f64);
            for u in draws(seed as u64, n) {
                let s = sample(theta_o, &fiber, u);
                assert!(s.theta_i.abs() <= FRAC_PI_2 && (0.0..=TAU).contains(&s.phi) && s.pdf > 0.0);
                let weight = bcsdf_cos(s.theta_i, theta_o, s.phi, &fiber).sum().x / s.pdf;
                largest = largest.max(weight);
                sum += weight;
                squares += weight * weight;
            }
            let n = f64::from(n);
            let mean = sum / n;
            let error = ((squares / n - mean * mean).max(0.0) / n).sqrt();
            let exact = ambient_scattering(theta_o, &fiber).sum().x;
            // The quadrature's own error and that of a mean without variance.
            let allowed = 4.0 * error + 1e-7;
            assert!((mean - exact).abs() < allowed, "{fiber:?} {theta_o}: {mean} vs {exact}, {error}");
            // cos^2 / G is below 3, and each lobe has at least a tenth of the samples.
            assert!(largest < 30.0, "{fiber:?} {theta_o}: a weight of {largest}");
        }
    }
}

const BINS: usize = 12;

/// Chi-squared of samples in cells of equal width over theta_i and phi against what `density` gives each, and its
/// degrees of freedom; cells of less than five expected samples are pooled.
fn chi_squared(theta_o: f64, fiber: &FiberScattering, density: &impl Fn(f64, f64) -> f64) -> (f64, f64) {
    let n = 20_000;
    let widest = 4.0 * fiber.beta_r.max(fiber.beta_tt);
    let low = (-theta_o - widest).max(-FRAC_PI_2);
    let high = (-theta_o + widest).min(FRAC_PI_2);
    let phi_low = PI - (5.0 * fiber.gamma_tt).min(PI);
    let (step, phi_step) = ((high - low) / BINS as f64, 2.0 * (PI - phi_low) / BINS as f64);
    let mut counts = vec![0.0; BINS * BINS + 1];
    for u in draws(7, n) {
        let s = sample(theta_o, fiber, u);
        let place =
            |v: f64, low: f64, step: f64| Some((v - low) / step).filter(|p| *p >= 0.0 && *p < BINS as f64);
        let cell = place(s.theta_i, low, step).zip(place(s.phi, phi_low, phi_step));
        counts[cell.map_or(BINS * BINS, |(i, j)| i as usize * BINS + j as usize)] += 1.0;
    }
    let expected = |cell: usize| {
        let (i, j) = ((cell / BINS) as f64, (cell % BINS) as f64);
        let row = |theta: f64| {
            let f = |phi: f64| [density(theta, phi) * cosine(theta)];
            integrate([phi_low + j * phi_step, phi_low + (j + 1.0) * phi_step], 1, 1e-5, &f)
        };
        f64::from(n) * integrate([low + i * step, low + (i + 1.0) * step], 1, 1e-5, &row)[0]
    };
    let mut expectations: Vec<f64> = (0..BINS * BINS).map(expected).collect();
    expectations.push(f64::from(n) - expectations.iter().sum::<f64>());
    let (mut pooled, mut sum, mut cells) = ((0.0, 0.0), 0.0, 0.0);
    for (count, expectation) in counts.into_iter().zip(expectations) {
        if expectation < 5.0 {
            pooled = (pooled.0 + count, pooled.1 + expectation);
        } else {
            sum += (count - expectation).powi(2) / expectation;
            cells += 1.0;
        }
    }
    if pooled.1 > 1.0 {
        sum += (pooled.0 - pooled.1).powi(2) / pooled.1;
        cells += 1.0;
    }
    (sum, cells - 1.0)
}

/// Whether chi-squared is within 4.5 standard deviations of its mean (Wilson and Hilferty's cube root).
fn is_likely((sum, freedom): (f64, f64)) -> bool {
    let spread = 2.0 / (9.0 * freedom);
    let z = ((sum / freedom).cbrt() - (1.0 - spread)) / spread.sqrt();
    z < 4.5
}

#[test]
fn samples_are_distributed_as_their_density_says_and_not_as_others_do() {
    for (c_r, c_tt, widths) in FIBERS {
        let fiber = fiber(c_r, c_tt, widths);
        for theta_o in [0.0, 0.7, -1.3, 1.56] {
            let right = chi_squared(theta_o, &fiber, &|theta, phi| pdf(theta, theta_o, phi, &fiber));
            assert!(is_likely(right), "{fiber:?} {theta_o}: {right:?}");
        }
    }
    let (c_r, c_tt, widths) = FIBERS[0];
    let fiber = fiber(c_r, c_tt, widths);
    let wrong: [&dyn Fn(f64, f64) -> f64; 3] = [
        &|theta, phi| pdf(theta, 0.75, phi, &fiber),
        &|theta, phi| pdf(theta, 0.7, phi, &FiberScattering { gamma_tt: 1.1 * fiber.gamma_tt, ..fiber }),
        &|theta, phi| pdf(theta, 0.7, phi, &FiberScattering { beta_tt: 0.9 * fiber.beta_tt, ..fiber }),
    ];
    for (index, wrong) in wrong.into_iter().enumerate() {
        let found = chi_squared(0.7, &fiber, &wrong);
        assert!(!is_likely(found), "wrong density {index} passed: {found:?}");
    }
}
