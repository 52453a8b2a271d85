//! State of the sequential filter with its two updates.
//!
//! State: the six relative elements at the time of the state, the rate of aδa, constant rotations of both
//! classes of measurements, and the states of their slow errors (Gauss–Markov). The drift of the elements is
//! linear to 1e-6, so its covariance moves with the transition matrix; lines of sight are not linear in the
//! range, so they are handled by the unscented transformation (Julier and Uhlmann 2004, Proc. IEEE 92, 401),
//! applied to the elements alone, in which the measurement is nonlinear (Morelande and Moran 2007, ICASSP;
//! statistical linear regression: Lefebvre, Bruyninckx, De Schutter 2002, IEEE Trans. AC 47, 1406).

use std::f64::consts::TAU;

use contract::navigation::{ManoeuvreReport, NavigationSetup, PriorOrbit, RelativeElements, Use};
use nalgebra::{DMatrix, DVector, Matrix2, Matrix2x6, Matrix6, SMatrix, Vector2, Vector6};

use crate::parameters::DAY_S;
use crate::path::{Drift, applied};
use crate::reference::Reference;
use crate::relative::{DriftPartials, control_matrix, target};
use crate::sight::{ErrorClass, Sight, radians_from_arcsec};

/// Longest step over which process noise is treated as an impulse in its middle, s.
const NOISE_STEP_S: f64 = 300.0;

/// Weight of the central sigma point times seven: λ = 1 of the unscented transformation in six dimensions,
/// whose points are at √7 σ.
const LAMBDA: f64 = 1.0;

/// Slow error on one axis.
#[derive(Debug, Clone, Copy)]
struct Slow {
    class: ErrorClass,
    axis: usize,
    variance: f64,
    memory_s: f64,
    rate_rad_s: f64,
    state: usize,
    is_periodic: bool,
}

/// Order of the state and its noise, constant over a campaign.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    drag: Option<usize>,
    drag_mean_m_s: f64,
    bias: [[Option<usize>; 3]; 2],
    slow: Vec<Slow>,
    /// Prior variances of the states after the elements.
    variances: Vec<f64>,
    /// Spectral density of the relative acceleration along R, T, N, m²/s³.
    acceleration: [f64; 3],
}

impl Layout {
    /// Orders the states of a setup.
    pub(crate) fn new(setup: &NavigationSetup, velocity_noise_m_s_per_hour: [f64; 3]) -> Self {
        let mut variances = Vec::new();
        let mut add = |sigma: f64| {
            (sigma > 0.0).then(|| {
                variances.push(sigma * sigma);
                5 + variances.len()
            })
        };
        let drag = add(setup.drag.sigma_m_per_day / DAY_S);
        let classes = [
            (ErrorClass::WithStars, &setup.errors.with_stars),
            (ErrorClass::WithoutStars, &setup.errors.without_stars),
        ];
        let bias =
            classes.map(|(_, errors)| errors.constant_arcsec.map(|sigma| add(radians_from_arcsec(sigma))));
        let mut slow = Vec::new();
        for (class, errors) in classes {
            for error in &errors.slow {
                for axis in 0..2 {
                    let sigma = radians_from_arcsec(error.sigma_arcsec[axis]);
                    let Some(state) = add(sigma) else { continue };
                    let is_periodic = error.period_s.is_some();
                    if is_periodic {
                        add(sigma);
                    }
                    slow.push(Slow {
                        class,
                        axis,
                        variance: sigma * sigma,
                        memory_s: error.memory_s,
                        rate_rad_s: error.period_s.map_or(0.0, |period| TAU / period),
                        state,
                        is_periodic,
                    });
                }
            }
        }
        let drag_mean_m_s = setup.drag.a_da_rate_m_per_day / DAY_S;
        let acceleration = velocity_noise_m_s_per_hour.map(|sigma| sigma * sigma / 3600.0);
        Self { drag, drag_mean_m_s, bias, slow, variances, acceleration }
    }
}

/// State of the filter at an instant.
#[derive(Debug, Clone)]
pub(crate) struct FilterState {
    /// Time, s since the epoch.
    pub(crate) seconds: f64,
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
}

impl FilterState {
    /// Creates the state from a prior of the elements at a time.
    pub(crate) fn new(layout: &Layout, seconds: f64, prior: &PriorOrbit) -> Self {
        let n = 6 + layout.variances.len();
        let mut mean = DVector::zeros(n);
        mean.rows_mut(0, 6).copy_from(&prior.elements.vector());
        let mut covariance = DMatrix::zeros(n, n);
        covariance.view_mut((0, 0), (6, 6)).copy_from(prior.covariance.matrix());
        layout.variances.iter().enumerate().for_each(|(k, variance)| covariance[(6 + k, 6 + k)] = *variance);
        Self { seconds, mean, covariance }
    }

    /// Relative elements.
    pub(crate) fn elements(&self) -> RelativeElements {
        RelativeElements::from_vector(&self.mean.fixed_rows::<6>(0).into_owned())
    }

    /// Covariance of the elements, m².
    pub(crate) fn elements_covariance(&self) -> Matrix6<f64> {
        self.covariance.fixed_view::<6, 6>(0, 0).into_owned()
    }

    /// Moves the state to a time without an event between. `None` where the chaser's orbit is unknown.
    pub(crate) fn propagate(&mut self, layout: &Layout, reference: &Reference, to_s: f64) -> Option<()> {
        while self.seconds != to_s {
            let dt = (to_s - self.seconds).clamp(-NOISE_STEP_S, NOISE_STEP_S);
            // Without process noise of the elements, one step suffices.
            let is_exact = layout.acceleration == [0.0; 3];
            self.step(layout, reference, if is_exact { to_s } else { self.seconds + dt })?;
        }
        Some(())
    }

    fn step(&mut self, layout: &Layout, reference: &Reference, to_s: f64) -> Option<()> {
        let (dt, n) = (to_s - self.seconds, self.mean.len());
        let chaser = reference.orbit(self.seconds)?;
        let elements = self.elements();
        let drag_m_s = layout.drag_mean_m_s + layout.drag.map_or(0.0, |column| self.mean[column]);
        let moved = Drift::new(self.seconds, elements, chaser)?.at(to_s, drag_m_s);
        let partials = DriftPartials::new(&target(&chaser, &elements));
        self.mean.rows_mut(0, 6).copy_from(&moved.vector());
        let transition = partials.transition(dt);
        let drag = layout.drag.map(|column| (column, partials.drag(dt)));
        // Rows, then columns: P ← F P Fᵀ.
        for side in 0..2 {
            if side == 1 {
                self.covariance.transpose_mut();
            }
            let top = self.covariance.rows(0, 6).into_owned();
            let mut moved = transition * top;
            if let Some((column, by_drag)) = drag {
                moved += by_drag * self.covariance.row(column);
            }
            self.covariance.rows_mut(0, 6).copy_from(&moved);
            for slow in &layout.slow {
                let decay = libm::exp(-dt.abs() / slow.memory_s);
                let (sin, cos) = libm::sincos(slow.rate_rad_s * dt);
                for column in 0..n {
                    let x = self.covariance[(slow.state, column)];
                    if slow.is_periodic {
                        let y = self.covariance[(slow.state + 1, column)];
                        self.covariance[(slow.state, column)] = decay * (cos * x - sin * y);
                        self.covariance[(slow.state + 1, column)] = decay * (sin * x + cos * y);
                    } else {
                        self.covariance[(slow.state, column)] = decay * x;
                    }
                }
            }
        }
        for slow in &layout.slow {
            let decay = libm::exp(-dt.abs() / slow.memory_s);
            let (sin, cos) = libm::sincos(slow.rate_rad_s * dt);
            let noise = slow.variance * (1.0 - decay * decay);
            let x = self.mean[slow.state];
            self.covariance[(slow.state, slow.state)] += noise;
            if slow.is_periodic {
                let y = self.mean[slow.state + 1];
                self.mean[slow.state] = decay * (cos * x - sin * y);
                self.mean[slow.state + 1] = decay * (sin * x + cos * y);
                self.covariance[(slow.state + 1, slow.state + 1)] += noise;
            } else {
                self.mean[slow.state] = decay * x;
            }
        }
        if layout.acceleration != [0.0; 3] {
            let control = partials.transition(0.5 * dt) * control_matrix(&chaser.propagate(0.5 * dt));
            let density = nalgebra::Matrix3::from_diagonal(&layout.acceleration.into());
            let noise = control * density * control.transpose() * dt.abs();
            let mut block = self.covariance.view_mut((0, 0), (6, 6));
            block += noise;
        }
        self.seconds = to_s;
        Some(())
    }

    /// Applies a manoeuvre at the time of the state.
    pub(crate) fn manoeuvre(&mut self, reference: &Reference, manoeuvre: &ManoeuvreReport) -> Option<()> {
        let chaser = reference.orbit_before(self.seconds)?;
        let moved = applied(&self.elements(), &chaser, &manoeuvre.dv_rtn_m_s, reference)?;
        self.mean.rows_mut(0, 6).copy_from(&moved.vector());
        self.add_impulse_error(&control_matrix(&chaser), manoeuvre);
        Some(())
    }

    /// Applies a manoeuvre at an earlier time `at_s` by its linear effect.
    pub(crate) fn late_manoeuvre(
        &mut self,
        reference: &Reference,
        manoeuvre: &ManoeuvreReport,
        at_s: f64,
    ) -> Option<()> {
        let chaser = reference.orbit_before(at_s)?;
        let transition = DriftPartials::new(&chaser).transition(self.seconds - at_s);
        let control = transition * control_matrix(&chaser);
        let moved = self.elements().vector() + control * manoeuvre.dv_rtn_m_s;
        self.mean.rows_mut(0, 6).copy_from(&moved);
        self.add_impulse_error(&control, manoeuvre);
        Some(())
    }

    fn add_impulse_error(&mut self, control: &SMatrix<f64, 6, 3>, manoeuvre: &ManoeuvreReport) {
        let sigma = &manoeuvre.sigma_rtn_m_s;
        let variance = nalgebra::Matrix3::from_diagonal(&sigma.component_mul(sigma));
        let mut block = self.covariance.view_mut((0, 0), (6, 6));
        block += control * variance * control.transpose();
    }

    /// Updates the state by a measurement at its time; returns its use and the innovation, rad.
    pub(crate) fn update(
        &mut self,
        layout: &Layout,
        reference: &Reference,
        sight: &Sight,
        gate: f64,
    ) -> (Use, [f64; 2]) {
        let n = self.mean.len();
        let osculation = reference.osculation();
        let centre = self.elements();
        let prediction = sight.predict(&centre, osculation);
        let residual = Vector2::from(sight.residual(&prediction));
        let Some(factor) = self.elements_covariance().cholesky().map(|factor| factor.l()) else {
            return (Use::Unusable, residual.into());
        };
        // Sigma points of the elements; the angles relative to those of the centre.
        let scale = (6.0 + LAMBDA).sqrt();
        let weight = 0.5 / (6.0 + LAMBDA);
        let angle = |offset: &Vector6<f64>| {
            let elements = RelativeElements::from_vector(&(centre.vector() + offset));
            residual - Vector2::from(sight.residual(&sight.predict(&elements, osculation)))
        };
        let mut sum = Vector2::zeros();
        let mut squares = Matrix2::zeros();
        let mut slopes = Matrix2x6::zeros();
        for k in 0..6 {
            let offset = factor.column(k) * scale;
            let (plus, minus) = (angle(&offset), angle(&-offset));
            sum += (plus + minus) * weight;
            squares += (plus * plus.transpose() + minus * minus.transpose()) * weight;
            // E[h xᵀ] P⁻¹ with x = L e: a column of H L.
            slopes.set_column(k, &((plus - minus) * (weight * scale)));
        }
        let nonlinear = squares - sum * sum.transpose() - slopes * slopes.transpose();
        let Some(inverse) = factor.solve_lower_triangular(&Matrix6::identity()) else {
            return (Use::Unusable, residual.into());
        };
        let by_elements = slopes * inverse;
        let mut design = SMatrix::<f64, 2, 6>::zeros().resize_horizontally(n, 0.0);
        design.columns_mut(0, 6).copy_from(&by_elements);
        let by_rotation = prediction.by_rotation();
        let class = usize::from(sight.class == ErrorClass::WithoutStars);
        for (k, column) in layout.bias[class].iter().enumerate() {
            if let Some(column) = column {
                design.set_column(*column, &by_rotation.column(k));
            }
        }
        for slow in layout.slow.iter().filter(|slow| slow.class == sight.class) {
            design[(slow.axis, slow.state)] = 1.0;
        }
        let others = design.columns(6, n - 6) * self.mean.rows(6, n - 6);
        let innovation = residual - sum - others;
        let [xx, xy, yy] = sight.noise;
        let cross = &self.covariance * design.transpose();
        let predicted = &design * &cross;
        let predicted =
            Matrix2::new(predicted[(0, 0)], predicted[(0, 1)], predicted[(1, 0)], predicted[(1, 1)]);
        // The scatter about the regression is positive but for rounding.
        let total = predicted
            + nonlinear.map_with_location(|i, j, x| if i == j { x.max(0.0) } else { x })
            + Matrix2::new(xx, xy, xy, yy);
        let Some(inverse) = total.try_inverse() else { return (Use::Unusable, residual.into()) };
        let squared = (innovation.transpose() * inverse * innovation)[0];
        if squared.is_nan() {
            return (Use::Unusable, residual.into());
        }
        if squared > gate * gate {
            return (Use::Outlier, innovation.into());
        }
        let gain = &cross * inverse;
        self.mean += &gain * innovation;
        self.covariance -= &gain * cross.transpose();
        let symmetric = (&self.covariance + self.covariance.transpose()) * 0.5;
        self.covariance = symmetric;
        (Use::Used, innovation.into())
    }
}
