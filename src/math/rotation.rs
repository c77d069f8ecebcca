//! The rotation nearest to a matrix: the orthogonal factor of its polar decomposition, and where that would mirror, the
//! best proper rotation.

use glam::{DMat3, DQuat, DVec3};

/// Sweeps over all pairs of axes; three or four reach f64's own precision.
const SWEEPS: usize = 12;

/// The rotation R that makes the trace of R^T `m` greatest: of `m` = sum of moved times rest^T, the one that takes the
/// rest vectors nearest to the moved ones (Horn 1987, by unit quaternions). It exists for every `m`, singular and mirroring
/// ones as well, and is unique unless `m`'s two smallest singular values cancel or all vanish; then it is one of the
/// best. The identity where `m` is zero or not finite.
pub fn nearest_rotation(m: DMat3) -> DQuat {
    let largest = m.to_cols_array().iter().fold(0.0f64, |most, v| most.max(v.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return DQuat::IDENTITY;
    }
    let m = m * largest.recip();
    // s(a, b) is the sum of rest_a times moved_b; columns of m are by rest.
    let s = |a: usize, b: usize| m.col(a)[b];
    let [xx, yy, zz] = [s(0, 0), s(1, 1), s(2, 2)];
    let [x, y, z] = [s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0)];
    let [xy, yz, zx] = [s(0, 1) + s(1, 0), s(1, 2) + s(2, 1), s(2, 0) + s(0, 2)];
    let n = [
        [xx + yy + zz, x, y, z],
        [x, xx - yy - zz, xy, zx],
        [y, xy, yy - xx - zz, yz],
        [z, zx, yz, zz - xx - yy],
    ];
    let [w, x, y, z] = greatest_eigenvector(n);
    let q = DQuat::from_xyzw(x, y, z, w).normalize();
    // Of two quaternions that are one rotation always the same.
    if w < 0.0 { -q } else { q }
}

/// Unit eigenvector of the greatest eigenvalue of a symmetric matrix, by Jacobi's rotations.
fn greatest_eigenvector(mut n: [[f64; 4]; 4]) -> [f64; 4] {
    let mut vectors =
        [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
    for _ in 0..SWEEPS {
        let mut off = 0.0;
        for p in 0..3 {
            for q in p + 1..4 {
                off += n[p][q] * n[p][q];
                rotate(&mut n, &mut vectors, p, q);
            }
        }
        if off < 1e-34 {
            break;
        }
    }
    let greatest = (1..4).fold(0, |best, k| if n[k][k] > n[best][best] { k } else { best });
    std::array::from_fn(|row| vectors[row][greatest])
}

/// Makes `n[p][q]` zero, and turns the columns of `vectors` along.
fn rotate(n: &mut [[f64; 4]; 4], vectors: &mut [[f64; 4]; 4], p: usize, q: usize) {
    let off = n[p][q];
    if off == 0.0 {
        return;
    }
    let theta = 0.5 * (n[q][q] - n[p][p]) / off;
    // Where theta overflows the tangent is 0, as it should be.
    let t = 1f64.copysign(theta) / (theta.abs() + theta.hypot(1.0));
    let c = t.hypot(1.0).recip();
    let s = t * c;
    for row in n.iter_mut() {
        let (a, b) = (row[p], row[q]);
        (row[p], row[q]) = (c * a - s * b, s * a + c * b);
    }
    let (above, below) = (n[p], n[q]);
    n[p] = std::array::from_fn(|k| c * above[k] - s * below[k]);
    n[q] = std::array::from_fn(|k| s * above[k] + c * below[k]);
    for row in vectors {
        let (a, b) = (row[p], row[q]);
        (row[p], row[q]) = (c * a - s * b, s * a + c * b);
    }
}

/// `moved` times `rest`^T: what [`nearest_rotation`] takes the sum of.
pub fn outer(moved: DVec3, rest: DVec3) -> DMat3 {
    DMat3::from_cols(moved * rest.x, moved * rest.y, moved * rest.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::Rng;

    fn vector(rng: &mut Rng) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| 2.0 * rng.uniform() - 1.0))
    }

    fn rotation(rng: &mut Rng) -> DQuat {
        DQuat::from_scaled_axis(3.1 * vector(rng).normalize() * rng.uniform())
    }

    fn apart(a: DQuat, b: DQuat) -> f64 {
        2.0 * (a.inverse() * b).xyz().length()
    }

    #[test]
    fn rigidly_moved_points_give_their_rotation_even_in_a_plane() {
        let mut rng = Rng::new(1, &[]);
        for round in 0..2000 {
            let expected = rotation(&mut rng);
            let flat = DVec3::new(1.0, 1.0, if round % 2 == 0 { 1.0 } else { 0.0 });
            let scale = 10f64.powi(round % 40 - 20);
            let points: Vec<DVec3> = (0..4).map(|_| scale * vector(&mut rng) * flat).collect();
            let sum: DMat3 = points.iter().map(|p| outer(expected * *p, *p)).sum();
            let error = apart(nearest_rotation(sum), expected);
            assert!(error < 1e-10, "round {round}: {error}");
        }
    }

    #[test]
    fn no_small_turn_of_it_is_better() {
        let mut rng = Rng::new(2, &[]);
        let quality = |m: DMat3, q: DQuat| (DMat3::from_quat(q).transpose() * m).to_cols_array();
        let trace = |a: [f64; 9]| a[0] + a[4] + a[8];
        for _ in 0..500 {
            let m: DMat3 = (0..3).map(|_| outer(vector(&mut rng), vector(&mut rng))).sum();
            let best = nearest_rotation(m);
            let found = trace(quality(m, best));
            for _ in 0..10 {
                let turned = best * DQuat::from_scaled_axis(0.3 * vector(&mut rng));
                assert!(trace(quality(m, turned)) <= found + 1e-12);
            }
        }
    }

    #[test]
    fn matrices_without_a_rotation_give_some() {
        let nan = DMat3::from_diagonal(DVec3::splat(f64::NAN));
        for m in [DMat3::ZERO, nan, DMat3::from_diagonal(DVec3::splat(f64::INFINITY))] {
            assert_eq!(nearest_rotation(m), DQuat::IDENTITY);
        }
        for m in
            [-DMat3::IDENTITY, outer(DVec3::X, DVec3::Y), DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0))]
        {
            let q = nearest_rotation(m);
            assert!((q.length() - 1.0).abs() < 1e-12 && q.is_finite());
        }
        let turned = nearest_rotation(outer(DVec3::Y, DVec3::X)) * DVec3::X;
        assert!((turned - DVec3::Y).length() < 1e-12, "a single vector is taken where it went");
    }
}
