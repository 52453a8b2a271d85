//! Transition of the state of the sequential filter between two times.

use contract::navigation::RelativeElements;
use nalgebra::{DMatrix, Matrix6, Vector6};

use crate::layout::Layout;
use crate::orbit::Orbit;
use crate::relative::{DriftPartials, target};
use crate::slow_errors::SlowTransition;

/// Linear transition of the state: the drift of the elements, and the decay of slow errors.
#[derive(Debug, Clone)]
pub(crate) struct Transition {
    elements: Matrix6<f64>,
    drag: Option<(usize, Vector6<f64>)>,
    slow: Vec<SlowTransition>,
}

impl Transition {
    /// Computes the transition over `dt` from the elements of a chaser in an orbit.
    pub(crate) fn new(layout: &Layout, chaser: &Orbit, elements: &RelativeElements, dt: f64) -> Self {
        let partials = DriftPartials::new(&target(chaser, elements));
        Self {
            elements: partials.transition(dt),
            drag: layout.drag.map(|column| (column, partials.drag(dt))),
            slow: layout.slow.iter().map(|slow| slow.transition(dt)).collect(),
        }
    }

    /// Multiplies a matrix with the transition from the left.
    pub(crate) fn forward(&self, matrix: &mut DMatrix<f64>) {
        let mut top = self.elements * matrix.rows(0, 6);
        if let Some((column, by_drag)) = &self.drag {
            top += by_drag * matrix.row(*column);
        }
        matrix.rows_mut(0, 6).copy_from(&top);
        self.turn(matrix, 1.0);
    }

    /// Multiplies a matrix with the transposed transition from the left.
    pub(crate) fn backward(&self, matrix: &mut DMatrix<f64>) {
        let top = matrix.rows(0, 6).into_owned();
        if let Some((column, by_drag)) = &self.drag {
            let row = by_drag.transpose() * &top;
            let mut target = matrix.row_mut(*column);
            target += row;
        }
        matrix.rows_mut(0, 6).copy_from(&(self.elements.transpose() * top));
        self.turn(matrix, -1.0);
    }

    /// Returns the inverse transition of the elements.
    #[cfg(test)]
    pub(crate) fn elements_inverse(&self) -> Matrix6<f64> {
        self.elements.try_inverse().expect("a triangular matrix with a unit diagonal")
    }

    fn turn(&self, matrix: &mut DMatrix<f64>, sign: f64) {
        for slow in &self.slow {
            let (cos, sin) = (slow.cos, sign * slow.sin);
            for column in 0..matrix.ncols() {
                let x = matrix[(slow.state, column)];
                if slow.is_periodic {
                    let y = matrix[(slow.state + 1, column)];
                    matrix[(slow.state, column)] = cos * x - sin * y;
                    matrix[(slow.state + 1, column)] = sin * x + cos * y;
                } else {
                    matrix[(slow.state, column)] = cos * x;
                }
            }
        }
    }

    /// Moves a covariance and adds the noise of the slow errors.
    pub(crate) fn covariance(&self, covariance: &mut DMatrix<f64>) {
        self.forward(covariance);
        covariance.transpose_mut();
        self.forward(covariance);
        for slow in &self.slow {
            for state in slow.state..=slow.state + usize::from(slow.is_periodic) {
                covariance[(state, state)] += slow.noise;
            }
        }
    }

    /// Moves the slow errors of a mean state.
    pub(crate) fn slow_errors(&self, mean: &mut DMatrix<f64>) {
        self.turn(mean, 1.0);
    }
}
