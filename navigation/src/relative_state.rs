//! Position and velocity of the chaser in the target's R, T, N axes, from relative elements.

use contract::navigation::{Answer, Covariance6, NoEstimate, RelativeElements, RelativeEstimate};
use hifitime::Epoch;
use nalgebra::{Matrix6, Vector6};

use crate::orbit::Orbit;
use crate::relative;
use crate::short_period::Osculation;

/// Step of the difference quotients, m: rounding is 1e-9 m, the second order 1e-7 of the step.
const STEP_M: f64 = 1.0;

/// Returns position, m, and velocity in the rotating frame, m/s, of the chaser relative to the target.
pub(crate) fn relative_state(
    elements: &RelativeElements,
    chaser: &Orbit,
    osculation: Osculation,
) -> Vector6<f64> {
    let (c, t) = (osculation.state(chaser), osculation.state(&relative::target(chaser, elements)));
    let axes = t.rtn_axes();
    let offset = (c.position_km - t.position_km) * 1000.0;
    let velocity = (c.velocity_km_s - t.velocity_km_s) * 1000.0;
    let rate = t.position_km.cross(&t.velocity_km_s).norm() / t.position_km.norm_squared();
    let [r, along, n] = axes.map(|axis| axis.dot(&offset));
    let [v_r, v_t, v_n] = axes.map(|axis| axis.dot(&velocity));
    // ω × ρ with ω = rate N.
    Vector6::new(r, along, n, v_r + rate * along, v_t - rate * r, v_n)
}

/// Creates the estimate for elements with a covariance, m². The `accuracy` of the dynamics, relative to the
/// distance, is added to both covariances as an independent error of each component: angles determine some
/// combinations of elements to micrometres, but the model is exact only to second order in J2.
pub(crate) fn estimate(
    time: Epoch,
    elements: &RelativeElements,
    covariance: &Matrix6<f64>,
    chaser: &Orbit,
    osculation: Osculation,
    accuracy: f64,
) -> Answer {
    let at =
        |vector: &Vector6<f64>| relative_state(&RelativeElements::from_vector(vector), chaser, osculation);
    let centre = elements.vector();
    let state = at(&centre);
    let mut slopes = Matrix6::zeros();
    for column in 0..6 {
        let mut step = Vector6::zeros();
        step[column] = STEP_M;
        slopes.set_column(column, &((at(&(centre + step)) - at(&(centre - step))) / (2.0 * STEP_M)));
    }
    let distance_m = centre.norm();
    let (of_position, of_velocity) = (accuracy * distance_m, accuracy * distance_m * chaser.mean_motion());
    let floor = Vector6::from_fn(|k, _| if k < 3 { of_position } else { of_velocity });
    let of_state =
        slopes * covariance * slopes.transpose() + Matrix6::from_diagonal(&floor.component_mul(&floor));
    let covariance = covariance + Matrix6::identity() * (of_position * of_position);
    let refused = |_| NoEstimate::NoConvergence;
    let estimate = RelativeEstimate {
        time,
        position_m: state.fixed_rows::<3>(0).into_owned(),
        velocity_m_s: state.fixed_rows::<3>(3).into_owned(),
        covariance: Covariance6::from_matrix(of_state).map_err(refused)?,
        elements: *elements,
        elements_covariance: Covariance6::from_matrix(covariance).map_err(refused)?,
    };
    if state.iter().all(|x| x.is_finite()) { Ok(estimate) } else { Err(NoEstimate::NoConvergence) }
}
