//! Attitude of the target.

use contract::bounds::require;
use contract::{Angle, Icrs, OutOfRange, Rotation, Target};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::orbit::Rtn;
use super::states::States;

/// Attitude of the target's body frame as a function of time. Angles are Euler angles 123 from the stated
/// axes to the body axes, degrees, −360 to 360.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "mode", rename_all = "snake_case", deny_unknown_fields)]
pub enum TargetAttitudeConfig {
    /// Constant in ICRS.
    Inertial {
        /// φ from the ICRS axes, degrees.
        #[serde(default)]
        #[schemars(range(min = -360, max = 360))]
        phi_deg: f64,
        /// θ, degrees.
        #[serde(default)]
        #[schemars(range(min = -360, max = 360))]
        theta_deg: f64,
        /// ψ, degrees.
        #[serde(default)]
        #[schemars(range(min = -360, max = 360))]
        psi_deg: f64,
    },
    /// Constant in the target's orbital frame.
    Orbital {
        /// φ from the axes R, T, N of the target's orbit, degrees.
        #[serde(default)]
        #[schemars(range(min = -360, max = 360))]
        phi_deg: f64,
        /// θ, degrees.
        #[serde(default)]
        #[schemars(range(min = -360, max = 360))]
        theta_deg: f64,
        /// ψ, degrees.
        #[serde(default)]
        #[schemars(range(min = -360, max = 360))]
        psi_deg: f64,
    },
    /// Rotation at a constant rate about an axis that is fixed in the body and in ICRS.
    Tumbling {
        /// φ at the orbit's epoch, from the ICRS axes, degrees.
        #[serde(default)]
        #[schemars(range(min = -360, max = 360))]
        phi_deg: f64,
        /// θ at the orbit's epoch, degrees.
        #[serde(default)]
        #[schemars(range(min = -360, max = 360))]
        theta_deg: f64,
        /// ψ at the orbit's epoch, degrees.
        #[serde(default)]
        #[schemars(range(min = -360, max = 360))]
        psi_deg: f64,
        /// Rotation axis in the body frame, of any length but 0.
        #[schemars(inner(range(min = -1e6, max = 1e6)))]
        axis: [f64; 3],
        /// Rotation rate, right-handed about the axis, degrees per second, −360 to 360.
        #[schemars(range(min = -360, max = 360))]
        rate_deg_per_s: f64,
    },
}

impl Default for TargetAttitudeConfig {
    fn default() -> Self {
        Self::Orbital { phi_deg: 0.0, theta_deg: 0.0, psi_deg: 0.0 }
    }
}

impl TargetAttitudeConfig {
    /// Checks the length of the axis of a tumbling target.
    ///
    /// # Errors
    /// [`OutOfRange`] for a length outside 1e-9 to 1e9.
    pub fn check(&self) -> Result<(), OutOfRange> {
        let Self::Tumbling { axis, .. } = *self else { return Ok(()) };
        let length = Vector3::from(axis).norm();
        require("target.attitude.axis", length, "a length from 1e-9 to 1e9", |n| (1e-9..=1e9).contains(&n))
    }

    /// Returns the attitude at the time of `states`. Assumes checked angles.
    pub fn target_from_icrs(&self, states: &States) -> Rotation<Target, Icrs> {
        match *self {
            Self::Inertial { phi_deg, theta_deg, psi_deg } => euler(phi_deg, theta_deg, psi_deg),
            Self::Orbital { phi_deg, theta_deg, psi_deg } => {
                euler::<Rtn>(phi_deg, theta_deg, psi_deg) * states.target.rtn_from_icrs()
            }
            Self::Tumbling { phi_deg, theta_deg, psi_deg, axis, rate_deg_per_s } => {
                // Full turns are removed first: after months a large angle has lost digits.
                let angle_deg = rate_deg_per_s * states.time_s % 360.0;
                let axis = Vector3::from(axis).normalize();
                // The body turns by +angle; a direction fixed in ICRS therefore turns by −angle in the body
                // frame.
                let turn = Rotation::<Target, Target>::from_rotation_vector(-axis * angle_deg.to_radians());
                turn * euler::<Icrs>(phi_deg, theta_deg, psi_deg)
            }
        }
    }
}

fn euler<From>(phi_deg: f64, theta_deg: f64, psi_deg: f64) -> Rotation<Target, From> {
    let [phi, theta, psi] = [phi_deg, theta_deg, psi_deg].map(Angle::from_degrees);
    Rotation::from_euler_123(phi, theta, psi)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::State;

    fn states(time_s: f64) -> States {
        let target =
            State { position_km: Vector3::new(0.0, 7000.0, 0.0), velocity_km_s: Vector3::new(0.0, 0.0, 7.5) };
        States { time_s, chaser: target, target }
    }

    #[test]
    fn an_orbital_attitude_has_its_axes_along_r_t_n() {
        let turn = TargetAttitudeConfig::default().target_from_icrs(&states(0.0));
        assert!((turn.rotate(&Vector3::y()) - Vector3::x()).norm() < 1e-15, "R is x");
        assert!((turn.rotate(&Vector3::z()) - Vector3::y()).norm() < 1e-15, "T is y");
    }

    #[test]
    fn an_attitude_at_rest_is_independent_of_time() {
        let attitude = TargetAttitudeConfig::Inertial { phi_deg: 90.0, theta_deg: 0.0, psi_deg: 0.0 };
        assert_eq!(attitude.target_from_icrs(&states(0.0)), attitude.target_from_icrs(&states(1e6)));
        let turned = attitude.target_from_icrs(&states(0.0)).rotate(&Vector3::z());
        assert!((turned - Vector3::y()).norm() < 1e-15);
    }

    #[test]
    fn a_tumbling_body_turns_by_the_right_hand_rule_and_returns() {
        let tumbling = TargetAttitudeConfig::Tumbling {
            phi_deg: 10.0,
            theta_deg: 20.0,
            psi_deg: 30.0,
            axis: [0.0, 0.0, 2.0],
            rate_deg_per_s: 0.5,
        };
        let at = |time_s| tumbling.target_from_icrs(&states(time_s));
        // After a quarter turn, 180 s, the body's x axis points along the previous direction of its y axis.
        let (start, later) = (at(0.0).inverse(), at(180.0).inverse());
        assert!((later.rotate(&Vector3::x()) - start.rotate(&Vector3::y())).norm() < 1e-14);
        assert!((later.rotate(&Vector3::z()) - start.rotate(&Vector3::z())).norm() < 1e-14);
        assert!(at(720_000.0).angle_to(&at(0.0)).radians() < 1e-12);
    }

    #[test]
    fn an_axis_of_no_length_is_refused() {
        let tumbling = TargetAttitudeConfig::Tumbling {
            phi_deg: 0.0,
            theta_deg: 0.0,
            psi_deg: 0.0,
            axis: [0.0; 3],
            rate_deg_per_s: 0.5,
        };
        assert!(tumbling.check().unwrap_err().to_string().contains("target.attitude.axis"));
    }
}
