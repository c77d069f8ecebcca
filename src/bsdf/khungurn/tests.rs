//! The scattering function against brute sums and published figures.

use super::*;
use crate::math::rng::Rng;
use std::f64::consts::PI;

pub(super) const WIDTHS_DEG: [f64; 8] = [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 60.0];

pub(super) fn fiber(c_r: f64, c_tt: f64, widths_deg: [f64; 3]) -> FiberScattering {
    let [beta_r, beta_tt, gamma_tt] = widths_deg.map(f64::to_radians);
    FiberScattering { c_r: DVec3::splat(c_r), c_tt: DVec3::splat(c_tt), beta_r, beta_tt, gamma_tt }
}

/// Sum of `f` over the middles of `n` equal parts.
fn brute(n: u32, low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let step = (high - low) / f64::from(n);
    (0..n).map(|i| f(low + (f64::from(i) + 0.5) * step)).sum::<f64>() * step
}

#[test]
fn the_normaliser_is_its_integral() {
    for width_deg in WIDTHS_DEG {
        let width = width_deg.to_radians();
        for theta in [0.0, 0.4, -1.2, 1.5, 1.57, FRAC_PI_2, -FRAC_PI_2] {
            let sum = brute(200_000, -FRAC_PI_2, FRAC_PI_2, |t| gaussian(t - theta, width) * t.cos().powi(2));
            let found = longitudinal_normaliser(theta, width);
            assert!((found / sum - 1.0).abs() < 1e-6, "width {width_deg} theta {theta}: {found} vs {sum}");
        }
    }
}

#[test]
fn the_white_furnace_gives_the_known_figures() {
    let known = [(5.0, [1.008, 0.983, 0.875, 0.462, 0.185]), (20.0, [1.100, 0.713, 0.453, 0.286, 0.215])];
    for (width_deg, figures) in known {
        let white = fiber(1.0, 1.0, [width_deg, width_deg, 12.0]);
        for (theta_deg, figure) in [0.0_f64, 60.0, 75.0, 85.0, 90.0].into_iter().zip(figures) {
            let found = ambient_scattering(theta_deg.to_radians(), &white);
            assert!((found.r.x - figure).abs() < 5.1e-4, "width {width_deg} theta {theta_deg}: {found:?}");
            assert_eq!(found.tt, DVec3::ZERO, "all is reflected");
            let [all, grazing, through] = ambient_integrals(theta_deg.to_radians(), white.beta_tt);
            assert!((all - grazing - through).abs() < 1e-10 && grazing > 0.0 && through > 0.0);
        }
    }
}

#[test]
fn what_one_direction_of_light_brings_is_kept_lobe_by_lobe() {
    for widths_deg in [[0.5, 3.0, 0.5], [7.5, 18.9, 38.5], [60.0, 40.0, 60.0]] {
        let fiber = fiber(0.3, 0.6, widths_deg);
        for theta_i in [0.0, -0.7, 1.3, 1.56, FRAC_PI_2] {
            // Both azimuthal factors integrate to 1: R's is 1 / (2 pi) everywhere.
            let forward = azimuthal_tt(0.0, fiber.gamma_tt);
            let f = |theta_o: f64| {
                let lobes = bcsdf(theta_i, theta_o, PI, &fiber).scaled(cosine(theta_o).powi(2));
                [lobes.r.x * TAU, lobes.tt.x / forward]
            };
            let range = gaussian_range(-theta_i, fiber.beta_r.max(fiber.beta_tt));
            let [r, tt] = integrate(range, 12, 1e-4, &f);
            let fresnel = fiber.fresnel(cosine(theta_i)).x;
            assert!((r / fresnel - 1.0).abs() < 1e-5, "{widths_deg:?} {theta_i}: {r} vs {fresnel}");
            let through = (1.0 - fresnel) * 0.6;
            assert!((tt - through).abs() < 1e-5, "{widths_deg:?} {theta_i}: {tt} vs {through}");
        }
    }
}

#[test]
fn the_azimuthal_lobe_integrates_to_one_and_is_even() {
    for gamma_deg in [0.5, 1.0, 6.0, 12.0, 38.5, 60.0] {
        let gamma = f64::to_radians(gamma_deg);
        let [all] = integrate([0.0, TAU], 200, 1e-9, &|phi: f64| [azimuthal_tt((0.5 * phi).cos(), gamma)]);
        assert!((all - 1.0).abs() < 1e-11, "gamma {gamma_deg}: {all}");
    }
    let fiber = fiber(0.1, 0.9, [3.0, 6.0, 20.0]);
    for phi in [0.1, 1.0, 3.0, PI] {
        let (a, b) = (bcsdf(0.3, -0.2, phi, &fiber), bcsdf(0.3, -0.2, -phi, &fiber));
        assert_eq!(a, b);
        let turned = bcsdf(0.3, -0.2, phi + TAU, &fiber);
        assert!((turned.tt - a.tt).length() <= 1e-12 * a.tt.length(), "{phi}");
    }
}

#[test]
fn a_spread_of_tangents_widens_the_lobe_as_averaging_does() {
    let (width, deviation, sum, theta_i) = (0.1, 0.15, 0.2, 0.4);
    let [averaged] = integrate([-1.5, 1.5], 20, 1e-9, &|off: f64| {
        [gaussian(off, deviation) * longitudinal(sum + off, theta_i, width, 0.0)]
    });
    let widened = longitudinal(sum, theta_i, width, deviation * deviation);
    assert!((widened / averaged - 1.0).abs() < 1e-9, "{widened} vs {averaged}");
}

#[test]
fn directions_and_angles_give_the_same() {
    let fiber = fiber(0.2, 0.7, [5.0, 10.0, 20.0]);
    let at = |theta: f64, phi: f64| DVec3::new(theta.cos() * phi.cos(), theta.cos() * phi.sin(), theta.sin());
    for (theta_i, theta_o, phi) in [(0.3, -0.35, 2.9), (-1.2, 1.0, 0.4), (1.5, -1.4, 3.1)] {
        let by_angles = bcsdf_cos(theta_i, theta_o, phi, &fiber);
        let found = bcsdf_cos_of_directions(DVec3::Z, at(theta_i, phi + 0.5), at(theta_o, 0.5), 0.0, &fiber);
        assert!((found.sum() - by_angles.sum()).length() < 1e-9 * by_angles.sum().length());
    }
}

#[test]
fn everything_is_finite_and_not_negative() {
    let beyond = f64::from(std::f32::consts::FRAC_PI_2);
    assert!(beyond > FRAC_PI_2);
    let angles = [-beyond, -FRAC_PI_2, -1.0, 0.0, 1e-9, 1.57, FRAC_PI_2, beyond];
    let mut rng = Rng::new(31, &[]);
    for beta_r in WIDTHS_DEG {
        for beta_tt in [0.5, 7.0, 60.0] {
            for gamma in [0.5, 12.0, 60.0] {
                let fiber = fiber(rng.uniform(), rng.uniform(), [beta_r, beta_tt, gamma]);
                for theta_i in angles {
                    for theta_o in angles {
                        let phi = TAU * (rng.uniform() - 0.5) * 3.0;
                        for lobes in
                            [bcsdf(theta_i, theta_o, phi, &fiber), bcsdf(theta_i, theta_o, PI, &fiber)]
                        {
                            let good = |v: DVec3| v.is_finite() && v.min_element() >= 0.0;
                            assert!(good(lobes.r) && good(lobes.tt), "{fiber:?} {theta_i} {theta_o} {phi}");
                        }
                    }
                }
            }
        }
    }
    let extreme = fiber(0.0, 1.0, [0.5, 0.5, 0.5]);
    for theta_o in angles {
        let lobes = ambient_scattering(theta_o, &extreme);
        assert!(lobes.r.is_finite() && lobes.tt.is_finite() && lobes.r.x >= 0.0 && lobes.tt.x > 0.0);
    }
}
