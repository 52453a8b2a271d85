//! State of the sequential filter with its two updates (Kalman 1960).
//!
//! The drift of the elements is linear to 1e-6, so its covariance moves with the transition matrix. Lines of
//! sight are replaced by linear functions ([`crate::linearisation`]) about a centre that measurements do not
//! move: if each measurement were linearised about the latest estimate, its slopes would belong to different
//! ranges, and their differences would act as information about the range (Huang, Mourikis, Roumeliotis 2010,
//! IJRR 29, 502).

use contract::navigation::{ManoeuvreReport, PriorOrbit, RelativeElements, Use};
use nalgebra::{DMatrix, Matrix2, Matrix2xX, Matrix6, MatrixXx2, SMatrix, Vector2, Vector6};

use crate::layout::Layout;
use crate::linearisation::Linearisation;
use crate::orbit::Orbit;
use crate::path::{Drift, applied};
use crate::relative::{DriftPartials, control_matrix, target};
use crate::short_period::Osculation;
use crate::sight::Sight;
use crate::transition::Transition;

/// Longest step over which process noise is treated as an impulse in its middle, s.
const NOISE_STEP_S: f64 = 300.0;

/// State of the filter at an instant.
#[derive(Debug, Clone)]
pub(crate) struct FilterState {
    /// Time, s since the epoch.
    pub(crate) seconds: f64,
    /// Elements about which the next measurements are linearised.
    pub(crate) centre: Vector6<f64>,
    /// Mean, one column.
    pub(crate) mean: DMatrix<f64>,
    pub(crate) covariance: DMatrix<f64>,
}

/// Update by a used measurement.
#[derive(Debug, Clone)]
pub(crate) struct Update {
    /// Derivatives of the angles with respect to the state, 2 × states.
    pub(crate) design: Matrix2xX<f64>,
    /// Gain, states × 2.
    pub(crate) gain: MatrixXx2<f64>,
    /// Inverse covariance of the innovation.
    pub(crate) inverse: Matrix2<f64>,
    pub(crate) innovation: Vector2<f64>,
}

impl FilterState {
    /// Creates the state from a prior of the elements at a time.
    pub(crate) fn new(layout: &Layout, seconds: f64, prior: &PriorOrbit) -> Self {
        let n = layout.count();
        let centre = prior.elements.vector();
        let mut mean = DMatrix::zeros(n, 1);
        mean.fixed_view_mut::<6, 1>(0, 0).copy_from(&centre);
        let mut covariance = DMatrix::zeros(n, n);
        covariance.view_mut((0, 0), (6, 6)).copy_from(prior.covariance.matrix());
        layout.variances.iter().enumerate().for_each(|(k, variance)| covariance[(6 + k, 6 + k)] = *variance);
        Self { seconds, centre, mean, covariance }
    }

    /// Relative elements.
    pub(crate) fn elements(&self) -> RelativeElements {
        RelativeElements::from_vector(&self.vector())
    }

    /// Relative elements as a vector.
    pub(crate) fn vector(&self) -> Vector6<f64> {
        self.mean.fixed_view::<6, 1>(0, 0).into_owned()
    }

    fn set_vector(&mut self, vector: &Vector6<f64>) {
        self.mean.fixed_view_mut::<6, 1>(0, 0).copy_from(vector);
    }

    /// Covariance of the elements, m².
    pub(crate) fn elements_covariance(&self) -> Matrix6<f64> {
        self.covariance.fixed_view::<6, 6>(0, 0).into_owned()
    }

    /// Moves the state to a time without an event between; `chaser` is the chaser's orbit at the time of the
    /// state. Returns the transition, `None` for an unsupported orbit.
    pub(crate) fn propagate(&mut self, layout: &Layout, chaser: &Orbit, to_s: f64) -> Option<Transition> {
        let whole = Transition::new(layout, chaser, &self.elements(), to_s - self.seconds);
        if layout.acceleration == [0.0; 3] {
            self.step(layout, chaser, &whole, to_s)?;
            return Some(whole);
        }
        let from_s = self.seconds;
        while self.seconds != to_s {
            let chaser = chaser.propagate(self.seconds - from_s);
            let dt = (to_s - self.seconds).clamp(-NOISE_STEP_S, NOISE_STEP_S);
            let part = Transition::new(layout, &chaser, &self.elements(), dt);
            let partials = DriftPartials::new(&target(&chaser, &self.elements()));
            let next_s = if dt.abs() < NOISE_STEP_S { to_s } else { self.seconds + dt };
            self.step(layout, &chaser, &part, next_s)?;
            let control = partials.transition(0.5 * dt) * control_matrix(&chaser.propagate(0.5 * dt));
            let density = nalgebra::Matrix3::from_diagonal(&layout.acceleration.into());
            let noise = control * density * control.transpose() * dt.abs();
            let mut block = self.covariance.view_mut((0, 0), (6, 6));
            block += noise;
        }
        Some(whole)
    }

    fn step(&mut self, layout: &Layout, chaser: &Orbit, transition: &Transition, to_s: f64) -> Option<()> {
        let drag_m_s = layout.drag_mean_m_s + layout.drag.map_or(0.0, |column| self.mean[column]);
        let moved = |vector: &Vector6<f64>| {
            let drift = Drift::new(self.seconds, RelativeElements::from_vector(vector), *chaser)?;
            Some(drift.at(to_s, drag_m_s).vector())
        };
        let (vector, centre) = (moved(&self.vector())?, moved(&self.centre)?);
        self.set_vector(&vector);
        self.centre = centre;
        transition.slow_errors(&mut self.mean);
        transition.covariance(&mut self.covariance);
        self.seconds = to_s;
        Some(())
    }

    /// Applies a manoeuvre at the time of the state; `chaser` is the chaser's orbit before it.
    pub(crate) fn manoeuvre(
        &mut self,
        chaser: &Orbit,
        manoeuvre: &ManoeuvreReport,
        osculation: Osculation,
    ) -> Option<()> {
        let moved = applied(&self.elements(), chaser, &manoeuvre.dv_rtn_m_s, osculation)?.vector();
        self.centre += moved - self.vector();
        self.set_vector(&moved);
        self.add_impulse_error(&control_matrix(chaser), manoeuvre);
        Some(())
    }

    /// Applies a manoeuvre at an earlier time `at_s` by its linear effect; `chaser` is the chaser's orbit
    /// before it.
    pub(crate) fn late_manoeuvre(&mut self, chaser: &Orbit, manoeuvre: &ManoeuvreReport, at_s: f64) {
        let transition = DriftPartials::new(chaser).transition(self.seconds - at_s);
        let control = transition * control_matrix(chaser);
        let change = control * manoeuvre.dv_rtn_m_s;
        self.centre += change;
        let moved = self.vector() + change;
        self.set_vector(&moved);
        self.add_impulse_error(&control, manoeuvre);
    }

    fn add_impulse_error(&mut self, control: &SMatrix<f64, 6, 3>, manoeuvre: &ManoeuvreReport) {
        let sigma = &manoeuvre.sigma_rtn_m_s;
        let variance = nalgebra::Matrix3::from_diagonal(&sigma.component_mul(sigma));
        let mut block = self.covariance.view_mut((0, 0), (6, 6));
        block += control * variance * control.transpose();
    }

    /// Updates the state by a measurement at its time; returns its use, the innovation, rad, and the update
    /// if it is used.
    pub(crate) fn update(
        &mut self,
        layout: &Layout,
        sight: &Sight,
        linearisation: &Linearisation,
        gate: f64,
    ) -> (Use, Vector2<f64>, Option<Update>) {
        let n = self.mean.len();
        let design = layout.design(linearisation, sight.class);
        let others = design.columns(6, n - 6) * self.mean.rows(6, n - 6);
        let innovation = linearisation.residual_at(&self.vector()) - Vector2::new(others[0], others[1]);
        let [xx, xy, yy] = sight.noise;
        let cross = &self.covariance * design.transpose();
        let total = &design * &cross + linearisation.scatter + Matrix2::new(xx, xy, xy, yy);
        let Some(inverse) = total.try_inverse() else { return (Use::Unusable, innovation, None) };
        let squared = innovation.dot(&(inverse * innovation));
        if squared.is_nan() {
            return (Use::Unusable, innovation, None);
        }
        if squared > gate * gate {
            return (Use::Outlier, innovation, None);
        }
        let gain = &cross * inverse;
        self.mean += &gain * innovation;
        self.covariance -= &gain * cross.transpose();
        let symmetric = (&self.covariance + self.covariance.transpose()) * 0.5;
        self.covariance = symmetric;
        (Use::Used, innovation, Some(Update { design, gain, inverse, innovation }))
    }
}
