//! Smoothed elements of a filter's past: modified Bryson–Frazier smoother (Bierman 1977, *Factorization
//! Methods for Discrete Sequential Estimation*, chapter 10), which inverts covariances of innovations alone.

use nalgebra::{DMatrix, Matrix6, Vector6};

use crate::filter::{FilterState, Update};
use crate::transition::Transition;

/// Adjoint state of a smoother: from the last state of the filter backwards.
#[derive(Debug)]
pub(crate) struct Smoother {
    /// One column.
    vector: DMatrix<f64>,
    matrix: DMatrix<f64>,
}

impl Smoother {
    /// Creates the adjoint of the last of the filter's states, which is smoothed already.
    pub(crate) fn new(count: usize) -> Self {
        Self { vector: DMatrix::zeros(count, 1), matrix: DMatrix::zeros(count, count) }
    }

    /// Returns mean and covariance of the elements given all measurements, for the state after the current
    /// event.
    pub(crate) fn elements(&self, state: &FilterState) -> (Vector6<f64>, Matrix6<f64>) {
        let rows = state.covariance.rows(0, 6);
        let mean = state.vector() - rows * &self.vector;
        let change = rows * &self.matrix * rows.transpose();
        let covariance = state.elements_covariance() - change;
        (mean, (covariance + covariance.transpose()) * 0.5)
    }

    /// Goes back before a measurement.
    pub(crate) fn before_update(&mut self, update: &Update) {
        let Update { design, gain, inverse, innovation } = update;
        // λ ← λ − Dᵀ (S⁻¹ y + Kᵀ λ)
        let gained = inverse * innovation + gain.transpose() * &self.vector;
        self.vector -= design.transpose() * gained;
        // Λ ← Dᵀ S⁻¹ D + (I − K D)ᵀ Λ (I − K D)
        let by_gain = &self.matrix * gain;
        let inner = gain.transpose() * &by_gain + inverse;
        let crossed = design.transpose() * by_gain.transpose();
        self.matrix -= &crossed;
        self.matrix -= crossed.transpose();
        self.matrix += design.transpose() * inner * design;
    }

    /// Goes back before a drift.
    pub(crate) fn before_drift(&mut self, transition: &Transition) {
        transition.backward(&mut self.vector);
        transition.backward(&mut self.matrix);
        self.matrix.transpose_mut();
        transition.backward(&mut self.matrix);
        let symmetric = (&self.matrix + self.matrix.transpose()) * 0.5;
        self.matrix = symmetric;
    }
}

#[cfg(test)]
mod tests {
    use contract::Rotation;
    use contract::navigation::{
        AngleErrors, ChaserOrbit, Covariance6, DifferentialDrag, LineOfSightErrors, NavigationSetup,
        PriorOrbit, RelativeElements, SlowError,
    };
    use hifitime::Epoch;
    use nalgebra::{Matrix2, Matrix2xX, MatrixXx2, Vector2};

    use super::*;
    use crate::layout::Layout;
    use crate::orbit::Orbit;
    use crate::path::Drift;

    const CHASER: Orbit = Orbit { a_km: 7130.0, u: 0.7, ex: 0.001, ey: 0.0028, i: 1.7153, raan: 2.2 };

    fn setup() -> NavigationSetup {
        let slow = |period_s| SlowError { sigma_arcsec: [20.0; 2], memory_s: 3000.0, period_s };
        let errors = AngleErrors {
            white_arcsec: [5.0; 2],
            slow: vec![slow(None), slow(Some(6000.0))],
            constant_arcsec: [10.0; 3],
        };
        NavigationSetup {
            epoch: Epoch::from_gregorian_utc_at_midnight(2012, 4, 23),
            chaser_orbit: ChaserOrbit::States(Vec::new()),
            camera_from_body: Rotation::identity(),
            prior: None,
            errors: LineOfSightErrors { with_stars: errors, ..LineOfSightErrors::default() },
            drag: DifferentialDrag { a_da_rate_m_per_day: 0.0, sigma_m_per_day: 5.0 },
        }
    }

    /// Kalman's update by a linear measurement of unit variance.
    fn updated(state: &mut FilterState, design: Matrix2xX<f64>, measured: Vector2<f64>) -> Update {
        let cross: MatrixXx2<f64> = &state.covariance * design.transpose();
        let inverse = (&design * &cross + Matrix2::identity()).try_inverse().unwrap();
        let innovation = measured - &design * &state.mean;
        let gain = &cross * inverse;
        state.mean += &gain * innovation;
        state.covariance -= &gain * cross.transpose();
        Update { design, gain, inverse, innovation: innovation.column(0).into_owned() }
    }

    /// Without noise of the elements' dynamics, smoothed elements and their covariance drift into those of
    /// the last state.
    #[test]
    fn smoothed_elements_drift_into_the_last_ones() {
        let mut setup = setup();
        setup.drag.sigma_m_per_day = 0.0;
        let layout = Layout::new(&setup, [0.0; 3]);
        let elements = RelativeElements { a_dlambda_m: -2e4, a_dey_m: 300.0, ..RelativeElements::default() };
        let covariance = Covariance6::from_sigmas([1.0, 500.0, 30.0, 30.0, 30.0, 30.0]).unwrap();
        let mut state = FilterState::new(&layout, 0.0, &PriorOrbit { elements, covariance });
        let mut steps = Vec::new();
        for k in 0..8 {
            let chaser = CHASER.propagate(state.seconds);
            let transition = state.propagate(&layout, &chaser, state.seconds + 700.0).unwrap();
            let n = layout.count();
            let design = Matrix2xX::from_fn(n, |i, j| {
                let scale = if j < 6 { 0.05 } else { 1e4 };
                scale * libm::sin((1 + i) as f64 * 1.7 + (j * (k + 2)) as f64)
            });
            let predicted = &design * &state.mean;
            let measured = Vector2::new(predicted[0] + 3.0, predicted[1] - 2.0 + k as f64);
            let update = updated(&mut state, design, measured);
            steps.push((transition, update, state.clone()));
        }
        let mut smoother = Smoother::new(layout.count());
        let mut later: Option<(Vector6<f64>, Matrix6<f64>)> = None;
        for (transition, update, after) in steps.iter().rev() {
            let (mean, covariance) = smoother.elements(after);
            if let Some((of_later, cov_later)) = later {
                assert!((mean - of_later).abs().max() < 1e-5, "{mean} {of_later}");
                let sigmas = cov_later.diagonal().map(f64::sqrt);
                let error = (covariance - cov_later).component_div(&(sigmas * sigmas.transpose()));
                assert!(error.abs().max() < 1e-6, "{error}");
            }
            smoother.before_update(update);
            smoother.before_drift(transition);
            // Back over the drift: by the inverse of the transition.
            let back = transition.elements_inverse();
            let drifted = Drift::new(
                after.seconds,
                RelativeElements::from_vector(&mean),
                CHASER.propagate(after.seconds),
            )
            .unwrap();
            let before = drifted.at(after.seconds - 700.0, 0.0).vector();
            later = Some((before, back * covariance * back.transpose()));
        }
    }

    #[test]
    fn the_backward_transition_is_the_transposed_forward_one() {
        let layout = Layout::new(&setup(), [0.0; 3]);
        let elements = RelativeElements { a_dlambda_m: -2e4, ..RelativeElements::default() };
        let transition = Transition::new(&layout, &CHASER, &elements, 2000.0);
        let n = layout.count();
        let (mut forward, mut backward) = (DMatrix::identity(n, n), DMatrix::identity(n, n));
        transition.forward(&mut forward);
        transition.backward(&mut backward);
        assert!((forward.transpose() - backward).abs().max() < 1e-12);
    }
}
