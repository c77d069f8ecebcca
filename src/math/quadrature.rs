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

/// The same for several functions at once.
fn gauss_legendre_all<const N: usize>([a, b]: [f64; 2], f: &impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let mut sums = [0.0; N];
    for (x, w) in NODES_8 {
        let (left, right) = (f(middle - half * x), f(middle + half * x));
        for (n, sum) in sums.iter_mut().enumerate() {
            *sum += half * w * (left[n] + right[n]);
        }
    }
    sums
}

/// Halvings of a panel after which it is taken as it is.
const DEEPEST: u32 = 24;

/// Integrals over `range` of several functions at once, from `panels` parts, each halved until that changes
/// none of the integrals by more than `tolerance` of its size. The result is better than that by orders of
/// magnitude where the functions are smooth. Zeros where the range is empty.
pub fn integrate<const N: usize>(
    range: [f64; 2],
    panels: u32,
    tolerance: f64,
    f: &impl Fn(f64) -> [f64; N],
) -> [f64; N] {
    let [low, high] = range;
    if low >= high {
        return [0.0; N];
    }
    let cut = |i: u32| low + (high - low) * f64::from(i) / f64::from(panels);
    let parts: Vec<([f64; 2], [f64; N])> =
        (0..panels).map(|i| [cut(i), cut(i + 1)]).map(|part| (part, gauss_legendre_all(part, f))).collect();
    let allowed =
        std::array::from_fn(|n| tolerance * parts.iter().map(|(_, part)| part[n].abs()).sum::<f64>());
    parts
        .into_iter()
        .fold([0.0; N], |sums, (part, whole)| added(sums, refined(part, whole, &allowed, DEEPEST, f)))
}

fn refined<const N: usize>(
    [a, b]: [f64; 2],
    whole: [f64; N],
    allowed: &[f64; N],
    depth: u32,
    f: &impl Fn(f64) -> [f64; N],
) -> [f64; N] {
    let middle = 0.5 * (a + b);
    let (left, right) = (gauss_legendre_all([a, middle], f), gauss_legendre_all([middle, b], f));
    let halves = added(left, right);
    // What is not a number is not worth refining either.
    if depth == 0 || !(0..N).any(|n| (halves[n] - whole[n]).abs() > allowed[n]) {
        return halves;
    }
    let left = refined([a, middle], left, allowed, depth - 1, f);
    added(left, refined([middle, b], right, allowed, depth - 1, f))
}

fn added<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    std::array::from_fn(|n| a[n] + b[n])
}

/// Steps of the search below: bisection alone would reach a double's last bit in so many.
const MOST_STEPS: u32 = 60;
/// Share of the mass by which the answer may be off.
const SHARE_TOLERANCE: f64 = 1e-13;

/// The place in `range` below which lies `share`, 0..1, of the mass of a smooth `density`; `mass` is all of it.
/// Newton's method, with bisection where that would leave the bracket.
pub fn quantile(range: [f64; 2], mass: f64, share: f64, density: &impl Fn(f64) -> f64) -> f64 {
    let [mut low, mut high] = range;
    let mut below_low = 0.0;
    let mut x = 0.5 * (low + high);
    for _ in 0..MOST_STEPS {
        let below = below_low + integrate([low, x], 1, SHARE_TOLERANCE, &|t| [density(t)])[0];
        let excess = below - share * mass;
        if excess.abs() <= SHARE_TOLERANCE * mass {
            break;
        }
        if excess > 0.0 {
            high = x;
        } else {
            (low, below_low) = (x, below);
        }
        let next = x - excess / density(x);
        x = if next > low && next < high { next } else { 0.5 * (low + high) };
    }
    x
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

    #[test]
    fn adaptive_integrals_are_exact_for_narrow_and_for_kinked_functions() {
        for width in [1e-3, 0.1, 10.0] {
            let gaussian = |x: f64| (-0.5 * (x / width).powi(2)).exp();
            let found =
                integrate([-9.0 * width, 9.0 * width], 3, 1e-7, &|x| [gaussian(x), x * x * gaussian(x)]);
            let area = std::f64::consts::TAU.sqrt() * width;
            assert!((found[0] / area - 1.0).abs() < 1e-12, "{width}: {found:?}");
            assert!((found[1] / (area * width * width) - 1.0).abs() < 1e-12, "{width}: {found:?}");
        }
        let [kink] = integrate([-1.0, 2.0], 1, 1e-9, &|x: f64| [(x - 0.3).abs()]);
        assert!((kink - 0.5 * (1.3 * 1.3 + 1.7 * 1.7)).abs() < 1e-9, "{kink}");
        assert_eq!(integrate([1.0, 1.0], 4, 1e-9, &|x| [x]), [0.0]);
        assert!(integrate([0.0, 1.0], 4, 1e-9, &|_| [f64::NAN])[0].is_nan());
    }

    #[test]
    fn quantiles_invert_the_mass_below() {
        let density = |x: f64| (-0.5 * (x / 0.02).powi(2)).exp();
        let range = [-0.1, 1.5];
        let [mass] = integrate(range, 200, 1e-10, &|x| [density(x)]);
        for share in [0.0, 1e-9, 0.2, 0.5, 0.999, 1.0 - 1e-9] {
            let x = quantile(range, mass, share, &density);
            let [below] = integrate([range[0], x], 200, 1e-10, &|x| [density(x)]);
            assert!((below / mass - share).abs() < 1e-11, "{share}: {x}, {}", below / mass);
        }
    }
}
