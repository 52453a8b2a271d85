//! Motion as shown to the operator at the end of a portion: the seven parameters of the docking paper (3.2).

use contract::docking::{Motion, Pose};
use nalgebra::{SVector, Vector3, Vector6};

/// Range, range rate, passive pitch and yaw, and the three active angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ApproachParameters {
    /// Range ρ = |d|, m.
    pub rho_m: f64,
    /// Range rate u = dρ/dt, m/s; negative while approaching.
    pub u_m_s: f64,
    /// Passive pitch α = atan2(d2, √(d1² + d3²)), rad.
    pub alpha_rad: f64,
    /// Passive yaw β = atan2(d1, d3), rad.
    pub beta_rad: f64,
    /// Active angles φ, rad.
    pub phi_rad: Vector3<f64>,
}

impl ApproachParameters {
    /// Computes the parameters of a pose that changes at `velocity_m_s`.
    pub fn from_motion(pose: &Pose, velocity_m_s: &Vector3<f64>) -> Self {
        let d = &pose.position_m;
        let rho_m = d.norm();
        // At the target's origin the range has no direction in which to change; its rate is set to 0.
        let u_m_s = if rho_m > 0.0 { d.dot(velocity_m_s) / rho_m } else { 0.0 };
        Self {
            rho_m,
            u_m_s,
            alpha_rad: libm::atan2(d.y, across(d)),
            beta_rad: libm::atan2(d.x, d.z),
            phi_rad: pose.phi_rad,
        }
    }

    /// Standard deviations of the seven parameters, in the order of the fields, propagated from the
    /// covariances of a motion with the gradients at its values; `None` if d is on the axis y2, where β is
    /// undefined.
    pub fn sigmas(motion: &Motion) -> Option<[f64; 7]> {
        let (d, v) = (&motion.pose.position_m, &motion.velocity_m_s);
        let (rho, s) = (d.norm(), across(d));
        if s <= 0.0 {
            return None;
        }
        let none = Vector3::zeros();
        let gradients = [
            (d / rho, none),
            (v / rho - d * (d.dot(v) / (rho * rho * rho)), d / rho),
            (Vector3::new(-d.x * d.y, s * s, -d.z * d.y) / (s * rho * rho), none),
            (Vector3::new(d.z, 0.0, -d.x) / (s * s), none),
        ];
        let covariance = &motion.position_covariance;
        let mut sigmas = [0.0; 7];
        for (sigma, (by_position, by_velocity)) in sigmas.iter_mut().zip(gradients) {
            let gradient = Vector6::new(
                by_position.x,
                by_position.y,
                by_position.z,
                by_velocity.x,
                by_velocity.y,
                by_velocity.z,
            );
            *sigma = (covariance * gradient).dot(&gradient).max(0.0).sqrt();
        }
        for axis in 0..3 {
            sigmas[4 + axis] = motion.attitude_covariance[(axis, axis)].max(0.0).sqrt();
        }
        Some(sigmas)
    }

    /// Returns the differences of the seven parameters from those of `truth`, in the order of the fields.
    pub fn difference(&self, truth: &Self) -> SVector<f64, 7> {
        let phi = self.phi_rad - truth.phi_rad;
        SVector::from([
            self.rho_m - truth.rho_m,
            self.u_m_s - truth.u_m_s,
            self.alpha_rad - truth.alpha_rad,
            self.beta_rad - truth.beta_rad,
            phi.x,
            phi.y,
            phi.z,
        ])
    }
}

/// Returns √(d1² + d3²), the distance from the y2 axis.
fn across(d: &Vector3<f64>) -> f64 {
    (d.x * d.x + d.z * d.z).sqrt()
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Matrix6};

    use super::*;

    fn motion() -> Motion {
        Motion {
            time_s: 1.0,
            pose: Pose { position_m: Vector3::new(0.8, -0.5, 9.0), phi_rad: Vector3::new(0.01, -0.02, 0.03) },
            velocity_m_s: Vector3::new(0.03, 0.01, -0.2),
            phi_rate_rad_s: Vector3::zeros(),
            position_covariance: Matrix6::from_fn(|i, j| if i == j { 0.01 * (1 + i) as f64 } else { 0.002 }),
            attitude_covariance: Matrix6::from_diagonal_element(4e-6),
            cross_covariance: Matrix3::zeros(),
            fields: 10,
        }
    }

    #[test]
    fn an_approach_along_the_axis_has_its_speed_as_range_rate() {
        let pose = Pose { position_m: Vector3::new(0.0, 0.0, 5.0), phi_rad: Vector3::zeros() };
        let shown = ApproachParameters::from_motion(&pose, &Vector3::new(0.1, 0.0, -0.2));
        assert_eq!((shown.rho_m, shown.u_m_s, shown.alpha_rad, shown.beta_rad), (5.0, -0.2, 0.0, 0.0));
    }

    #[test]
    fn at_the_targets_centre_the_range_changes_in_no_direction() {
        let pose = Pose { position_m: Vector3::zeros(), phi_rad: Vector3::zeros() };
        let shown = ApproachParameters::from_motion(&pose, &Vector3::new(0.1, 0.0, -0.2));
        assert_eq!((shown.rho_m, shown.u_m_s), (0.0, 0.0));
    }

    /// Compares the gradients with central differences of the parameters.
    #[test]
    fn sigmas_are_those_of_differences_of_the_parameters() {
        let motion = motion();
        let sigmas = ApproachParameters::sigmas(&motion).unwrap();
        let at = |step: &Vector6<f64>| {
            let position_m = motion.pose.position_m + step.fixed_rows::<3>(0);
            let velocity = motion.velocity_m_s + step.fixed_rows::<3>(3);
            ApproachParameters::from_motion(&Pose { position_m, ..motion.pose }, &velocity)
        };
        let h = 1e-5;
        let gradients: Vec<SVector<f64, 7>> = (0..6)
            .map(|i| {
                let step = Vector6::from_fn(|j, _| if i == j { h } else { 0.0 });
                at(&step).difference(&at(&-step)) / (2.0 * h)
            })
            .collect();
        for (k, sigma) in sigmas.iter().take(4).enumerate() {
            let gradient = Vector6::from_fn(|i, _| gradients[i][k]);
            let expected = (motion.position_covariance * gradient).dot(&gradient).sqrt();
            // Error of central differences with step h: h² times the third derivatives, which are below 1;
            // 1e-10 here.
            assert!((sigma - expected).abs() < 1e-8, "parameter {k}: {sigma}, expected {expected}");
        }
        assert_eq!(sigmas[4..], [0.002; 3]);
    }
}
