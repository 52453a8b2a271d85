//! What the operator is shown at the end of a portion, with standard deviations (docking paper, 3.2, Figs. 5 and 6).

use contract::docking::Motion;
use nalgebra::Vector6;

/// A value with its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Indicator {
    /// The value.
    pub value: f64,
    /// Its standard deviation, to first order from the covariance of the motion.
    pub sigma: f64,
}

/// The paper's parameters of the motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Indicators {
    /// ρ = |d|: range, m.
    pub range_m: Indicator,
    /// u = dρ/dt: range rate, m/s; negative in an approach.
    pub range_rate_m_s: Indicator,
    /// α = arctan(d2/√(d1² + d3²)): passive pitch, rad.
    pub passive_pitch_rad: Indicator,
    /// β = arctan(d1/d3): passive yaw, rad.
    pub passive_yaw_rad: Indicator,
    /// φ1, φ2, φ3: active pitch, yaw, roll, rad.
    pub active_rad: [Indicator; 3],
}

impl Indicators {
    /// The parameters of a motion; `None` where they are not defined (the camera at the target's centre, or on its y2 axis).
    pub fn of(motion: &Motion) -> Option<Self> {
        let (d, v) = (&motion.pose.position_m, &motion.velocity_m_s);
        let range = d.norm();
        let across = libm::hypot(d.x, d.z);
        if !(range > 0.0 && across > 0.0) {
            return None;
        }
        let rate = d.dot(v) / range;
        let indicator = |value: f64, slope: Vector6<f64>| Indicator {
            value,
            sigma: (slope.transpose() * motion.position_covariance * slope)[0].max(0.0).sqrt(),
        };
        // Of ρ and u, u = d·v/ρ.
        let towards = d / range;
        let by_d = (v - towards * rate) / range;
        let pitch =
            Vector6::new(-d.x * d.y / across, across, -d.z * d.y / across, 0.0, 0.0, 0.0) / (range * range);
        let yaw = Vector6::new(d.z, 0.0, -d.x, 0.0, 0.0, 0.0) / (across * across);
        Some(Self {
            range_m: indicator(range, Vector6::new(towards.x, towards.y, towards.z, 0.0, 0.0, 0.0)),
            range_rate_m_s: indicator(
                rate,
                Vector6::new(by_d.x, by_d.y, by_d.z, towards.x, towards.y, towards.z),
            ),
            passive_pitch_rad: indicator(libm::atan2(d.y, across), pitch),
            passive_yaw_rad: indicator(libm::atan2(d.x, d.z), yaw),
            active_rad: [0, 1, 2].map(|i| Indicator {
                value: motion.pose.phi_rad[i],
                sigma: motion.attitude_covariance[(i, i)].max(0.0).sqrt(),
            }),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use contract::docking::Pose;
    use nalgebra::{Matrix3, Matrix6, Vector3};

    fn motion(x: &Vector6<f64>) -> Motion {
        Motion {
            time_s: 0.0,
            pose: Pose { position_m: x.fixed_rows::<3>(0).into(), phi_rad: Vector3::new(0.1, 0.2, 0.3) },
            velocity_m_s: x.fixed_rows::<3>(3).into(),
            phi_rate_rad_s: Vector3::zeros(),
            position_covariance: Matrix6::from_diagonal(&Vector6::new(0.04, 0.09, 0.01, 1e-4, 4e-4, 9e-4)),
            attitude_covariance: Matrix6::identity() * 4e-6,
            cross_covariance: Matrix3::zeros(),
            fields: 10,
        }
    }

    fn values(x: &Vector6<f64>) -> [f64; 4] {
        let shown = Indicators::of(&motion(x)).unwrap();
        [shown.range_m, shown.range_rate_m_s, shown.passive_pitch_rad, shown.passive_yaw_rad].map(|i| i.value)
    }

    #[test]
    fn on_the_axis_they_are_those_of_the_third_coordinate() {
        let shown = Indicators::of(&motion(&Vector6::new(0.0, 0.0, 5.0, 0.3, 0.2, -0.1))).unwrap();
        assert_eq!((shown.range_m.value, shown.range_m.sigma), (5.0, 0.1));
        assert!((shown.range_rate_m_s.value + 0.1).abs() < 1e-15);
        // u = v3 to first order in d3, and a lateral error turns the line of sight against the lateral velocity.
        let sigma = (9e-4 + 0.04 * 0.06 * 0.06 + 0.09 * 0.04 * 0.04f64).sqrt();
        assert!((shown.range_rate_m_s.sigma - sigma).abs() < 1e-12);
        assert!((shown.passive_pitch_rad.sigma - 0.3 / 5.0).abs() < 1e-15);
        assert!((shown.passive_yaw_rad.sigma - 0.2 / 5.0).abs() < 1e-15);
        assert_eq!(shown.active_rad[1], Indicator { value: 0.2, sigma: 0.002 });
    }

    #[test]
    fn standard_deviations_are_those_of_finite_differences() {
        let at = Vector6::new(1.0, -2.0, 6.0, 0.05, -0.02, -0.3);
        let shown = Indicators::of(&motion(&at)).unwrap();
        let sigmas = [shown.range_m, shown.range_rate_m_s, shown.passive_pitch_rad, shown.passive_yaw_rad];
        let covariance = motion(&at).position_covariance;
        for (k, told) in sigmas.into_iter().enumerate() {
            let slope = Vector6::from_fn(|i, _| {
                let step = Vector6::ith(i, 1e-6);
                (values(&(at + step))[k] - values(&(at - step))[k]) / 2e-6
            });
            let sigma = (slope.transpose() * covariance * slope)[0].sqrt();
            assert!((told.sigma - sigma).abs() < 1e-8, "{k}: {} and {sigma}", told.sigma);
        }
    }

    #[test]
    fn at_the_targets_centre_there_is_no_direction() {
        assert_eq!(Indicators::of(&motion(&Vector6::zeros())), None);
    }
}
