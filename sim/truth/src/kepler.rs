//! Kepler's equation.

use std::f64::consts::PI;

/// Largest supported eccentricity. The error of Newton's method is divided by 1 − e, so a bound is needed.
pub(crate) const MAX_ECCENTRICITY: f64 = 0.9;

/// Wraps an angle to [−π, π].
pub(crate) fn wrap(angle_rad: f64) -> f64 {
    angle_rad - 2.0 * PI * (angle_rad / (2.0 * PI)).round()
}

/// Returns the eccentric anomaly E, rad, that solves M = E − e sin E for an eccentricity in [0, 0.9]; in [−π,
/// π] and accurate to 1e-14 rad.
///
/// Newton's method. On [0, π] the function E − e sin E − M is convex and increasing, and it is not negative
/// at E = min(M + e, π): from there every step moves down towards the root and never past it, so no safeguard
/// is needed.
pub(crate) fn eccentric_anomaly(mean_anomaly_rad: f64, eccentricity: f64) -> f64 {
    let wrapped = wrap(mean_anomaly_rad);
    let mean = wrapped.abs();
    let mut anomaly = (mean + eccentricity).min(PI);
    // A few steps are sufficient; the bound only prevents an endless loop due to rounding.
    for _ in 0..20 {
        let (sin, cos) = libm::sincos(anomaly);
        let step = (anomaly - eccentricity * sin - mean) / (1.0 - eccentricity * cos);
        anomaly -= step;
        if step.abs() < 1e-15 {
            break;
        }
    }
    anomaly.copysign(wrapped)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The mean anomaly is computed from the eccentric anomaly in closed form, so the expected result is
        /// exact.
        #[test]
        fn the_eccentric_anomaly_round_trips(anomaly in -PI..PI, e in 0.0_f64..=0.9) {
            let mean = anomaly - e * libm::sin(anomaly);
            // The function guarantees 1e-14; M itself is accurate to 2e-16·π, which 1/(1 − e) amplifies to
            // 7e-15 at most.
            prop_assert!(wrap(eccentric_anomaly(mean, e) - anomaly).abs() < 1e-14);
        }
    }

    #[test]
    fn a_circular_orbit_has_equal_anomalies() {
        for mean in [-3.0, -1e-9, 0.0, 0.5, 3.0] {
            assert_eq!(eccentric_anomaly(mean, 0.0), mean);
        }
    }

    /// Meeus, Astronomical Algorithms, 2nd edition, example 30.b: e = 0.1, M = 5°, E = 5.554 589 253 869°… to
    /// the nine decimals printed.
    #[test]
    fn the_example_of_meeus_is_met() {
        let anomaly = eccentric_anomaly(5.0_f64.to_radians(), 0.1).to_degrees();
        assert!((anomaly - 5.554_589_254).abs() < 1e-9, "{anomaly}");
    }

    #[test]
    fn apogee_and_perigee_are_fixed_points() {
        for e in [0.0, 0.003, 0.5, 0.9] {
            // Newton's method stops at most a step of 1e-15 from the root.
            assert!(eccentric_anomaly(0.0, e).abs() < 1e-15);
            // π as a double differs from π by its rounding error, 1.2e-16; only this may remain.
            assert!((eccentric_anomaly(PI, e).abs() - PI).abs() < 1e-15);
        }
    }
}
