//! A small dense symmetric system, as the relaxation's Newton step needs it (a few dozen unknowns).

/// A symmetric positive definite system `matrix * x = rhs`, gathered term by term.
#[derive(Clone, Debug)]
pub(crate) struct SymmetricSystem {
    size: usize,
    /// Row-major; only the lower triangle is read.
    matrix: Vec<f64>,
    /// The right-hand side.
    pub(crate) rhs: Vec<f64>,
}

impl SymmetricSystem {
    /// The system of `size` unknowns with every coefficient zero.
    pub(crate) fn new(size: usize) -> Self {
        Self { size, matrix: vec![0.0; size * size], rhs: vec![0.0; size] }
    }

    /// Adds to the coefficient of row `i`, column `j`; the caller adds the mirrored one as well.
    pub(crate) fn add(&mut self, i: usize, j: usize, value: f64) {
        self.matrix[i * self.size + j] += value;
    }

    /// Solves by Cholesky's factorisation; `None` where the matrix is not positive definite.
    pub(crate) fn solve(mut self) -> Option<Vec<f64>> {
        let n = self.size;
        for j in 0..n {
            for i in j..n {
                let (row_i, row_j) = (i * n, j * n);
                let dot: f64 = (0..j).map(|k| self.matrix[row_i + k] * self.matrix[row_j + k]).sum();
                let rest = self.matrix[row_i + j] - dot;
                // Written so that a NaN is refused too.
                if i == j && !(rest > 0.0 && rest.is_finite()) {
                    return None;
                }
                self.matrix[row_i + j] = if i == j { rest.sqrt() } else { rest / self.matrix[row_j + j] };
            }
        }
        let mut x = self.rhs;
        for i in 0..n {
            let dot: f64 = (0..i).map(|k| self.matrix[i * n + k] * x[k]).sum();
            x[i] = (x[i] - dot) / self.matrix[i * n + i];
        }
        for i in (0..n).rev() {
            let dot: f64 = (i + 1..n).map(|k| self.matrix[k * n + i] * x[k]).sum();
            x[i] = (x[i] - dot) / self.matrix[i * n + i];
        }
        Some(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn system(entries: &[[f64; 3]; 3], rhs: [f64; 3]) -> SymmetricSystem {
        let mut s = SymmetricSystem::new(3);
        for (i, row) in entries.iter().enumerate() {
            for (j, &v) in row.iter().enumerate() {
                s.add(i, j, v);
            }
        }
        s.rhs = rhs.to_vec();
        s
    }

    #[test]
    fn solution_satisfies_the_system() {
        let a = [[4.0, 1.0, -2.0], [1.0, 3.0, 0.5], [-2.0, 0.5, 5.0]];
        let b = [1.0, -2.0, 3.0];
        let x = system(&a, b).solve().unwrap();
        for (row, want) in a.iter().zip(b) {
            let got: f64 = row.iter().zip(&x).map(|(a, x)| a * x).sum();
            assert!((got - want).abs() < 1e-13, "{got} {want}");
        }
    }

    #[test]
    fn indefinite_and_not_finite_systems_are_refused() {
        let indefinite = [[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(system(&indefinite, [1.0; 3]).solve().is_none());
        let nan = [[f64::NAN, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(system(&nan, [1.0; 3]).solve().is_none());
    }
}
