//! Numerical integration.

/// Nodes and weights of the 8-point Gauss-Legendre rule on [-1, 1], positive half
/// (Abramowitz and Stegun 1964, Table 25.4).
const NODES_8: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// Integral of `f` from `a` to `b` by the 8-point Gauss-Legendre rule: exact for polynomials up to
/// degree 15.
pub fn gauss_legendre(a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let middle = 0.5 * (a + b);
    let half = 0.5 * (b - a);
    NODES_8.iter().map(|&(x, w)| w * (f(middle - half * x) + f(middle + half * x))).sum::<f64>() * half
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_up_to_degree_15_and_no_further() {
        let power = |n: i32| gauss_legendre(0.0, 2.0, |x| x.powi(n));
        let exact = |n: i32| 2f64.powi(n + 1) / f64::from(n + 1);
        for n in 0..=15 {
            assert!((power(n) / exact(n) - 1.0).abs() < 1e-13, "degree {n}");
        }
        assert!((power(24) / exact(24) - 1.0).abs() > 1e-12);
    }
}
