//! Least squares in square-root information form.
//!
//! Rows [A | b] are triangularised by Householder reflections in blocks (Bierman, *Factorization Methods for
//! Discrete Sequential Estimation*, 1977, chapter IV): R x = z minimises |A x − b|² without forming AᵀA,
//! which would square the condition number. The range of an angles-only orbit is weakly determined; this
//! matters.

use nalgebra::{DMatrix, DVector};

/// Rows triangularised at a time.
const BLOCK: usize = 96;

/// Square root of an information matrix with its right-hand side.
#[derive(Debug, Clone)]
pub(crate) struct SquareRoot {
    parameters: usize,
    /// [R | z; 0 | ρ], (parameters + 1)², upper triangular.
    triangle: DMatrix<f64>,
    /// Rows that are not yet folded in, a column per parameter and one for b.
    block: DMatrix<f64>,
    filled: usize,
}

impl SquareRoot {
    /// Creates the square root of no information.
    pub(crate) fn new(parameters: usize) -> Self {
        let columns = parameters + 1;
        Self {
            parameters,
            triangle: DMatrix::zeros(columns, columns),
            block: DMatrix::zeros(BLOCK, columns),
            filled: 0,
        }
    }

    /// Adds a row of `parameters` coefficients and the right-hand side, with unit error.
    pub(crate) fn add(&mut self, row: &[f64]) {
        row.iter().enumerate().for_each(|(column, value)| self.block[(self.filled, column)] = *value);
        self.filled += 1;
        if self.filled == BLOCK {
            self.fold();
        }
    }

    /// Folds the block into the triangle: reflections act on a row of the triangle and the rows of the block.
    fn fold(&mut self) {
        let (rows, columns) = (self.filled, self.parameters + 1);
        let data = self.block.as_mut_slice();
        for k in 0..columns {
            let (head, tail) = data.split_at_mut((k + 1) * BLOCK);
            let pivot = &mut head[k * BLOCK..k * BLOCK + rows];
            let below: f64 = pivot.iter().map(|x| x * x).sum();
            if below == 0.0 {
                continue;
            }
            let diagonal = self.triangle[(k, k)];
            let norm = (diagonal * diagonal + below).sqrt();
            let alpha = if diagonal > 0.0 { -norm } else { norm };
            let first = diagonal - alpha;
            // v = (first, pivot); 2/(vᵀv) = −1/(alpha first).
            let factor = -1.0 / (alpha * first);
            self.triangle[(k, k)] = alpha;
            for j in k + 1..columns {
                let column = &mut tail[(j - k - 1) * BLOCK..(j - k - 1) * BLOCK + rows];
                let dot: f64 = column.iter().zip(pivot.iter()).map(|(x, v)| x * v).sum();
                let scale = factor * (dot + first * self.triangle[(k, j)]);
                self.triangle[(k, j)] -= scale * first;
                column.iter_mut().zip(pivot.iter()).for_each(|(x, v)| *x -= scale * v);
            }
        }
        self.filled = 0;
    }

    /// Returns the minimiser with damping: rows λ^½ |column| x = 0 are added (Marquardt 1963, SIAM J. 11,
    /// 431). `None` if a parameter is undetermined.
    pub(crate) fn solve(&mut self, damping: f64) -> Option<DVector<f64>> {
        self.fold();
        let n = self.parameters;
        if damping > 0.0 {
            let mut damped = self.clone();
            let root = damping.sqrt();
            for column in 0..n {
                let mut row = vec![0.0; n + 1];
                row[column] = root * self.triangle.column(column).rows(0, n).norm();
                damped.add(&row);
            }
            return damped.solve(0.0);
        }
        let r = self.triangle.view((0, 0), (n, n));
        let z = self.triangle.view((0, n), (n, 1)).column(0).into_owned();
        let solution = r.solve_upper_triangular(&z)?;
        solution.iter().all(|x| x.is_finite()).then_some(solution)
    }

    /// Returns the covariance (Rᵀ R)⁻¹; `None` if a parameter is undetermined.
    pub(crate) fn covariance(&mut self) -> Option<DMatrix<f64>> {
        self.fold();
        let n = self.parameters;
        let r = self.triangle.view((0, 0), (n, n));
        let inverse = r.solve_upper_triangular(&DMatrix::identity(n, n))?;
        let covariance = &inverse * inverse.transpose();
        covariance.iter().all(|x| x.is_finite()).then_some(covariance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_minimiser_is_that_of_the_normal_equations() {
        let (rows, n) = (3 * BLOCK + 7, 5);
        let value = |i: usize, k: usize| libm::sin(((i * i) as f64 * 0.37 + 0.2) * (1.0 + k as f64));
        let a = DMatrix::from_fn(rows, n, value);
        let b = DVector::from_fn(rows, |i, _| value(i, n));
        let mut root = SquareRoot::new(n);
        (0..rows).for_each(|i| root.add(&(0..=n).map(|k| value(i, k)).collect::<Vec<_>>()));
        let normal = a.transpose() * &a;
        let expected = normal.clone().cholesky().unwrap().solve(&(a.transpose() * &b));
        assert!((root.solve(0.0).unwrap() - &expected).norm() < 1e-12);
        assert!((root.covariance().unwrap() * normal - DMatrix::identity(n, n)).norm() < 1e-12);
        let damped = root.solve(0.5).unwrap();
        let mut with_diagonal = a.transpose() * &a;
        (0..n).for_each(|k| with_diagonal[(k, k)] *= 1.5);
        assert!((damped - with_diagonal.cholesky().unwrap().solve(&(a.transpose() * b))).norm() < 1e-12);
    }

    #[test]
    fn an_undetermined_parameter_has_no_solution() {
        let mut root = SquareRoot::new(2);
        root.add(&[1.0, 0.0, 3.0]);
        assert_eq!(root.solve(0.0), None);
        assert_eq!(root.covariance(), None);
    }
}
