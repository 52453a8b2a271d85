//! Small systems of normal equations.

/// Largest number of parameters of a fit.
pub(super) const MAX_PARAMETERS: usize = 12;

/// Number of parameters sufficient for most fits.
const USUAL_PARAMETERS: usize = 8;

pub(super) type Vector = [f64; MAX_PARAMETERS];
pub(super) type Matrix = [[f64; MAX_PARAMETERS]; MAX_PARAMETERS];

/// Value added to the unit diagonal of a scaled matrix. With it, parameters that the pixels do not separate
/// share their information instead of making the matrix singular.
const RIDGE: f64 = 1e-10;

/// Fisher information and score of a fit with `n` parameters.
#[derive(Debug, Clone, Copy)]
pub(super) struct NormalEquations {
    pub(super) information: Matrix,
    pub(super) score: Vector,
    pub(super) n: usize,
}

impl NormalEquations {
    pub(super) fn new(n: usize) -> Self {
        Self { information: [[0.0; MAX_PARAMETERS]; MAX_PARAMETERS], score: [0.0; MAX_PARAMETERS], n }
    }

    /// Adds one datum: its residual, its derivatives with respect to the parameters and its weight, the
    /// inverse of its variance.
    #[inline(always)]
    pub(super) fn add(&mut self, residual: f64, by: &Vector, weight: f64) {
        // Full rows of a fixed length, including the half above the diagonal: the compiler keeps them in
        // registers.
        if self.n <= USUAL_PARAMETERS {
            self.add_first::<USUAL_PARAMETERS>(residual, by, weight);
        } else {
            self.add_first::<MAX_PARAMETERS>(residual, by, weight);
        }
    }

    #[inline(always)]
    fn add_first<const N: usize>(&mut self, residual: f64, by: &Vector, weight: f64) {
        for ((row, score), by_row) in self.information.iter_mut().zip(&mut self.score).zip(by).take(N) {
            let weighted = weight * by_row;
            *score += weighted * residual;
            for (element, by) in row.iter_mut().zip(by).take(N) {
                *element += weighted * by;
            }
        }
    }

    /// Adds a normal prior of parameter `i`: its distance `residual` from the current value, and its
    /// variance.
    pub(super) fn add_prior(&mut self, i: usize, residual: f64, variance: f64) {
        self.score[i] += residual / variance;
        self.information[i][i] += 1.0 / variance;
    }

    /// Returns the step that solves (F + λ diag F) s = g by Cholesky's method, with F scaled to a unit
    /// diagonal; `None` unless F is positive definite.
    pub(super) fn step(&self, damping: f64) -> Option<Vector> {
        Some(self.factored(damping)?.solve(&self.score))
    }

    /// Returns variances and covariance of two parameters, as (aa, ab, bb), from columns `first` and `second`
    /// of the inverse of F.
    pub(super) fn covariance(&self, first: usize, second: usize) -> Option<[f64; 3]> {
        let factor = self.factored(0.0)?;
        let column = |i: usize| {
            let mut unit = [0.0; MAX_PARAMETERS];
            unit[i] = 1.0;
            factor.solve(&unit)
        };
        let (a, b) = (column(first), column(second));
        Some([a[first], a[second], b[second]])
    }

    fn factored(&self, damping: f64) -> Option<Factor> {
        let n = self.n;
        let mut factor =
            Factor { lower: [[0.0; MAX_PARAMETERS]; MAX_PARAMETERS], scale: [0.0; MAX_PARAMETERS], n };
        for i in 0..n {
            let diagonal = self.information[i][i];
            if !(diagonal > 0.0 && diagonal.is_finite()) {
                return None;
            }
            factor.scale[i] = 1.0 / diagonal.sqrt();
        }
        for i in 0..n {
            for j in 0..=i {
                let known: f64 = (0..j).map(|k| factor.lower[i][k] * factor.lower[j][k]).sum();
                let damped = if i == j { damping + RIDGE } else { 0.0 };
                let rest = self.information[i][j] * factor.scale[i] * factor.scale[j] + damped - known;
                factor.lower[i][j] = if i > j {
                    rest / factor.lower[j][j]
                } else if rest > 0.0 {
                    rest.sqrt()
                } else {
                    return None;
                };
            }
        }
        Some(factor)
    }
}

/// Cholesky factor of a matrix scaled to a unit diagonal.
struct Factor {
    lower: Matrix,
    scale: Vector,
    n: usize,
}

impl Factor {
    fn solve(&self, right: &Vector) -> Vector {
        let Self { lower, scale, n } = self;
        let mut solution = [0.0; MAX_PARAMETERS];
        for i in 0..*n {
            let known: f64 = (0..i).map(|k| lower[i][k] * solution[k]).sum();
            solution[i] = (right[i] * scale[i] - known) / lower[i][i];
        }
        for i in (0..*n).rev() {
            let known: f64 = (i + 1..*n).map(|k| lower[k][i] * solution[k]).sum();
            solution[i] = (solution[i] - known) / lower[i][i];
        }
        for i in 0..*n {
            solution[i] *= scale[i];
        }
        solution
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_is_fitted_with_the_covariance_of_its_closed_form() {
        // y = 1 + 2 t at t = 0, 1, 2, 3 with unit variance: F = [[4, 6], [6, 14]], det 20.
        let mut equations = NormalEquations::new(2);
        for t in [0.0, 1.0, 2.0, 3.0] {
            let mut by = [0.0; MAX_PARAMETERS];
            (by[0], by[1]) = (1.0, t);
            equations.add(1.0 + 2.0 * t, &by, 1.0);
        }
        let step = equations.step(0.0).unwrap();
        assert!((step[0] - 1.0).abs() < 1e-8 && (step[1] - 2.0).abs() < 1e-8, "{step:?}");
        let [aa, ab, bb] = equations.covariance(0, 1).unwrap();
        assert!(
            (aa - 0.7).abs() < 1e-8 && (ab + 0.3).abs() < 1e-8 && (bb - 0.2).abs() < 1e-8,
            "{aa} {ab} {bb}"
        );
    }

    #[test]
    fn a_prior_counts_as_a_datum() {
        let mut equations = NormalEquations::new(1);
        let mut by = [0.0; MAX_PARAMETERS];
        by[0] = 1.0;
        equations.add(3.0, &by, 1.0);
        equations.add_prior(0, 0.0, 0.5);
        assert!((equations.step(0.0).unwrap()[0] - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_parameter_without_information_has_no_solution() {
        assert!(NormalEquations::new(1).step(0.0).is_none());
    }
}
