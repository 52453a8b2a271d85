//! Relative elements between two orbits, their drift and the effect of an impulse.

use contract::navigation::RelativeElements;
use nalgebra::{Matrix3x6, Matrix6, Matrix6x3, Vector6};

use crate::orbit::{Orbit, wrap};
use crate::short_period::Osculation;

/// Metres per kilometre.
const M_PER_KM: f64 = 1000.0;

/// Returns the relative elements of `chaser` with respect to `target`, m (D'Amico 2010, chapter 2; exact).
pub fn between(chaser: &Orbit, target: &Orbit) -> RelativeElements {
    let a_m = target.a_km * M_PER_KM;
    let (sin_i, cos_i) = libm::sincos(target.i);
    let raan = wrap(chaser.raan - target.raan);
    RelativeElements {
        a_da_m: (chaser.a_km - target.a_km) * M_PER_KM,
        a_dlambda_m: a_m * (wrap(chaser.u - target.u) + raan * cos_i),
        a_dex_m: a_m * (chaser.ex - target.ex),
        a_dey_m: a_m * (chaser.ey - target.ey),
        a_dix_m: a_m * (chaser.i - target.i),
        a_diy_m: a_m * raan * sin_i,
    }
}

/// Returns the target's orbit from the chaser's orbit and the relative elements: the inverse of [`between`]
/// for a known chaser. The equations are solved in the order a, i, Ω, u, e, each in closed form.
pub fn target(chaser: &Orbit, relative: &RelativeElements) -> Orbit {
    let a_km = chaser.a_km - relative.a_da_m / M_PER_KM;
    let a_m = a_km * M_PER_KM;
    let i = chaser.i - relative.a_dix_m / a_m;
    let (sin_i, cos_i) = libm::sincos(i);
    let raan = relative.a_diy_m / (a_m * sin_i);
    Orbit {
        a_km,
        u: wrap(chaser.u - relative.a_dlambda_m / a_m + raan * cos_i),
        ex: chaser.ex - relative.a_dex_m / a_m,
        ey: chaser.ey - relative.a_dey_m / a_m,
        i,
        raan: wrap(chaser.raan - raan),
    }
}

/// Step of u in the difference quotient of the short-period variations, rad: rounding is 1e-8 km/rad.
const U_STEP: f64 = 1e-4;

/// Returns the partial derivatives of the target's position, km, with respect to the relative elements, m,
/// for a known chaser: the chain rule through [`target`]. The derivative by u includes the short-period
/// variations: aδλ moves the target almost along the line of sight, so that its transverse motion, a
/// thousandth, is the information about the range.
pub(crate) fn position_partials(
    target: &Orbit,
    relative: &RelativeElements,
    osculation: Osculation,
) -> Matrix3x6<f64> {
    let by_orbit = target.position_partials();
    let per_m = -1.0 / (target.a_km * M_PER_KM);
    let (sin_i, cos_i) = libm::sincos(target.i);
    let [by_a, mut by_u, by_ex, by_ey, by_i, by_raan] =
        [0, 1, 2, 3, 4, 5].map(|column| by_orbit.column(column).into_owned());
    if osculation != Osculation::None {
        let at = |step: f64| osculation.state(&Orbit { u: target.u + step, ..*target }).position_km;
        by_u = (at(U_STEP) - at(-U_STEP)) / (2.0 * U_STEP);
    }
    Matrix3x6::from_columns(&[
        by_a * (-1.0 / M_PER_KM) + by_u * (relative.a_dlambda_m * per_m * -per_m),
        by_u * per_m,
        by_ex * per_m,
        by_ey * per_m,
        by_i * per_m,
        (by_raan - by_u * cos_i) * (per_m / sin_i),
    ])
}

/// Secular rates of the relative elements with respect to each other at an orbit: partial derivatives of the
/// drift, 1/s (Koenig, Guffanti, D'Amico 2017, JGCD 40, 1749, quasi-nonsingular elements).
#[derive(Debug, Clone, Copy)]
pub(crate) struct DriftPartials {
    /// Rate of δλ by (δa, δex, δey, δix).
    lambda: [f64; 4],
    /// Rate of ω by (δa, δex, δey, δix).
    perigee: [f64; 4],
    /// Rate of δiy by (δa, δex, δey, δix).
    node: [f64; 4],
    /// Rate of ω.
    perigee_rate: f64,
    ex: f64,
    ey: f64,
}

impl DriftPartials {
    /// Computes the partial derivatives at an orbit.
    pub(crate) fn new(orbit: &Orbit) -> Self {
        let gamma = orbit.gamma();
        let (sin_i, cos_i) = libm::sincos(orbit.i);
        let (sin2, sin_cos) = (sin_i * sin_i, sin_i * cos_i);
        let eta2 = 1.0 - orbit.ex * orbit.ex - orbit.ey * orbit.ey;
        let eta = eta2.sqrt();
        let (perigee_rate, node_rate) = (gamma * (2.0 - 2.5 * sin2), -gamma * cos_i);
        let anomaly_j2 = gamma * eta * (1.0 - 1.5 * sin2);
        // By δa: γ ∝ a^(−7/2) and n ∝ a^(−3/2). By δe, with η dη = −(ex δex + ey δey): γ ∝ η^(−4) for Ω and
        // ω, γ η ∝ η^(−3) for M.
        let by_e = |rate: f64, power: f64| rate * power / eta2;
        let node = |factor: f64| node_rate * factor;
        let of_node =
            [node(-3.5), by_e(node_rate, 4.0) * orbit.ex, by_e(node_rate, 4.0) * orbit.ey, gamma * sin_i];
        let of_perigee = [
            -3.5 * perigee_rate,
            by_e(perigee_rate, 4.0) * orbit.ex,
            by_e(perigee_rate, 4.0) * orbit.ey,
            -5.0 * gamma * sin_cos,
        ];
        let of_anomaly = [
            -1.5 * orbit.mean_motion() - 3.5 * anomaly_j2,
            by_e(anomaly_j2, 3.0) * orbit.ex,
            by_e(anomaly_j2, 3.0) * orbit.ey,
            -3.0 * gamma * eta * sin_cos,
        ];
        let combine = |k: usize| of_perigee[k] + of_anomaly[k] + of_node[k] * cos_i;
        Self {
            lambda: [combine(0), combine(1), combine(2), combine(3)],
            perigee: of_perigee,
            node: of_node.map(|rate| rate * sin_i),
            perigee_rate,
            ex: orbit.ex,
            ey: orbit.ey,
        }
    }

    /// State transition matrix of the relative elements over `seconds`, for elements multiplied by a.
    pub(crate) fn transition(&self, seconds: f64) -> Matrix6<f64> {
        const OF: [usize; 4] = [0, 2, 3, 4];
        let mut phi = Matrix6::identity();
        let (sin, cos) = libm::sincos(self.perigee_rate * seconds);
        // (ex, ey) after the drift of the perigee, turned by 90°: the direction in which δω moves δe.
        let (ex, ey) = (cos * self.ex - sin * self.ey, sin * self.ex + cos * self.ey);
        phi[(2, 2)] = cos;
        phi[(2, 3)] = -sin;
        phi[(3, 2)] = sin;
        phi[(3, 3)] = cos;
        for (k, column) in OF.into_iter().enumerate() {
            phi[(1, column)] += self.lambda[k] * seconds;
            phi[(2, column)] -= ey * self.perigee[k] * seconds;
            phi[(3, column)] += ex * self.perigee[k] * seconds;
            phi[(5, column)] += self.node[k] * seconds;
        }
        phi
    }

    /// Effect of a constant rate of aδa, 1 m/s, on the elements after `seconds`, m (Gaias, Ardaens, D'Amico
    /// 2015, CEAS Space Journal 7, 211, density-model-free for near-circular orbits, first term).
    pub(crate) fn drag(&self, seconds: f64) -> Vector6<f64> {
        let half = 0.5 * seconds * seconds;
        Vector6::new(seconds, self.lambda[0] * half, 0.0, 0.0, 0.0, self.node[0] * half)
    }
}

/// Effect of an impulse of 1 m/s along the chaser's R, T, N axes on the relative elements, m (D'Amico 2010,
/// chapter 2; Gaias, D'Amico, Ardaens 2014, JGCD 37, 440; near-circular orbits).
pub(crate) fn control_matrix(orbit: &Orbit) -> Matrix6x3<f64> {
    let (sin, cos) = libm::sincos(orbit.u);
    let per_n = 1.0 / orbit.mean_motion();
    Matrix6x3::new(
        0.0,
        2.0,
        0.0, //
        -2.0,
        0.0,
        0.0, //
        sin,
        2.0 * cos,
        0.0, //
        -cos,
        2.0 * sin,
        0.0, //
        0.0,
        0.0,
        cos, //
        0.0,
        0.0,
        sin,
    ) * per_n
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::Drift;
    use crate::reference::kicked;
    use nalgebra::Vector3;

    const CHASER: Orbit = Orbit { a_km: 7130.0, u: 0.7, ex: 0.001, ey: 0.0028, i: 1.7153, raan: 2.2 };

    fn elements() -> Vector6<f64> {
        Vector6::new(30.0, -20_000.0, 120.0, 350.0, -80.0, 300.0)
    }

    #[test]
    fn the_target_of_relative_elements_has_them() {
        let relative = RelativeElements::from_vector(&elements());
        let back = between(&CHASER, &target(&CHASER, &relative)).vector();
        // Angles of a rad are rounded to 4e-16 rad; times 7e6 m, these are 3 nm, several times.
        assert!((back - elements()).abs().max() < 1e-7, "{back}");
    }

    /// The drift of relative elements is the difference of two secular drifts, `Orbit::propagate`.
    #[test]
    fn the_drift_is_that_of_the_two_orbits() {
        let relative = RelativeElements::from_vector(&elements());
        let of_target = target(&CHASER, &relative);
        let drift = Drift::new(0.0, relative, CHASER).unwrap();
        for seconds in [-50_000.0, 3000.0, 432_000.0] {
            let expected = between(&CHASER.propagate(seconds), &of_target.propagate(seconds)).vector();
            let got = drift.at(seconds, 0.0).vector();
            // Rates of 1e-3 rad/s over 4e5 s are rounded to 1e-13 rad, 1 µm.
            assert!((got - expected).abs().max() < 1e-5, "{seconds}: {got} {expected}");
        }
    }

    /// The part of the derivative by aδλ across the orbit counts, a thousandth of the part along it.
    #[test]
    fn position_partials_by_the_distance_include_short_period_variations() {
        for osculation in [Osculation::None, Osculation::FirstOrder] {
            let position = |step: f64| {
                let mut moved = elements();
                moved[1] += step;
                let of_target = target(&CHASER, &RelativeElements::from_vector(&moved));
                osculation.state(&of_target).position_km
            };
            let slope = (position(10.0) - position(-10.0)) / 20.0;
            let relative = RelativeElements::from_vector(&elements());
            let partials = position_partials(&target(&CHASER, &relative), &relative, osculation);
            // 1e-3 km/m along the orbit; the part without short-period variations errs by 2e-6.
            let error = (partials.column(1) - slope).norm();
            assert!(error < 1e-9, "{osculation:?}: {error}");
        }
    }

    #[test]
    fn the_transition_matrix_is_the_slope_of_the_drift() {
        let of_target = target(&CHASER, &RelativeElements::from_vector(&elements()));
        let seconds = 200_000.0;
        let phi = DriftPartials::new(&of_target).transition(seconds);
        for column in 0..6 {
            let at = |sign: f64| {
                let mut moved = elements();
                moved[column] += sign;
                let drift = Drift::new(0.0, RelativeElements::from_vector(&moved), CHASER).unwrap();
                drift.at(seconds, 0.0).vector()
            };
            let slope = (at(1.0) - at(-1.0)) / 2.0;
            // The scale of the elements, the target's a, varies with aδa: 1e-3 of the drifts at 20 km.
            let error = (phi.column(column) - slope).abs().max() / slope.abs().max();
            assert!(error < 2e-3, "{column}: {error}");
        }
    }

    #[test]
    fn the_control_matrix_is_the_slope_of_an_impulse() {
        let of_target = target(&CHASER, &RelativeElements::from_vector(&elements()));
        let control = control_matrix(&CHASER);
        for axis in 0..3 {
            let mut dv = Vector3::zeros();
            dv[axis] = 0.01;
            let at = |dv: &Vector3<f64>| {
                between(&kicked(&CHASER, dv, Osculation::None).unwrap(), &of_target).vector()
            };
            let slope = (at(&dv) - at(&-dv)) / 0.02;
            // Omitted terms are of the order of e = 0.003; the largest factor of e is 2, of e cot i less.
            let error = (control.column(axis) - slope).abs().max() / slope.abs().max();
            assert!(error < 0.008, "{axis}: {error}");
        }
    }

    /// A constant rate of aδa changes aδλ by half its product with the drift per aδa and the time squared.
    #[test]
    fn drag_moves_the_chaser_quadratically() {
        let (rate, day) = (1e-4, 86_400.0);
        let moved = DriftPartials::new(&CHASER).drag(day) * rate;
        assert!((moved[0] - rate * day).abs() < 1e-12);
        let expected = -0.75 * CHASER.mean_motion() * rate * day * day;
        assert!((moved[1] / expected - 1.0).abs() < 0.01, "{moved}");
    }
}
