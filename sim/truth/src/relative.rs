//! Relative orbital elements of the chaser with respect to the target.
//!
//! Definition: S. D'Amico, *Autonomous Formation Flying in Low Earth Orbit*, PhD thesis, TU Delft 2010,
//! chapter 2: δa = (a_c − a)/a, δλ = (u_c − u) + (Ω_c − Ω) cos i, δex = e_c cos ω_c − e cos ω, δey = e_c sin
//! ω_c − e sin ω, δix = i_c − i, δiy = (Ω_c − Ω) sin i, with u = ω + M the mean argument of latitude; letters
//! without index are the target's. All are multiplied by the target's a and given in metres. The conversion
//! to the chaser's own elements is exact, without linearisation.

use contract::{OutOfRange, bounds};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::kepler::wrap;
use super::orbit::Elements;

/// Relative orbital elements, metres (D'Amico 2010): of the chaser with respect to the target.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RelativeElements {
    /// aδa: difference of the semi-major axes, m, −1e6 to 1e6; negative: the chaser is lower and catches up.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub a_da_m: f64,
    /// aδλ: mean along-track separation, m, −1e6 to 1e6; negative: the chaser is behind.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub a_dlambda_m: f64,
    /// aδex: relative eccentricity vector towards the node, m, −1e6 to 1e6.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub a_dex_m: f64,
    /// aδey: relative eccentricity vector 90° from the node, m, −1e6 to 1e6.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub a_dey_m: f64,
    /// aδix: relative inclination vector, difference of the inclinations, m, −1e6 to 1e6.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub a_dix_m: f64,
    /// aδiy: relative inclination vector, difference of the nodes times sin i, m, −1e6 to 1e6.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub a_diy_m: f64,
}

impl RelativeElements {
    /// Checks every number.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "orbit.relative")
    }

    /// Returns the relative elements of `chaser` with respect to `target`. Differences of angles are wrapped
    /// to [−π, π].
    pub fn between(chaser: &Elements, target: &Elements) -> Self {
        let a_m = target.semi_major_axis_km * 1000.0;
        let (sin_i, cos_i) = libm::sincos(target.inclination_rad);
        let raan = wrap(chaser.raan_rad - target.raan_rad);
        let latitude = wrap(chaser.mean_argument_of_latitude_rad() - target.mean_argument_of_latitude_rad());
        let (chaser_ex, chaser_ey) = eccentricity_vector(chaser);
        let (target_ex, target_ey) = eccentricity_vector(target);
        Self {
            a_da_m: (chaser.semi_major_axis_km - target.semi_major_axis_km) * 1000.0,
            a_dlambda_m: a_m * (latitude + raan * cos_i),
            a_dex_m: a_m * (chaser_ex - target_ex),
            a_dey_m: a_m * (chaser_ey - target_ey),
            a_dix_m: a_m * (chaser.inclination_rad - target.inclination_rad),
            a_diy_m: a_m * raan * sin_i,
        }
    }

    /// Returns the chaser's elements for the target's elements `target`: the inverse of
    /// [`RelativeElements::between`].
    pub fn chaser(&self, target: &Elements) -> Elements {
        let a_m = target.semi_major_axis_km * 1000.0;
        let (sin_i, cos_i) = libm::sincos(target.inclination_rad);
        let raan = self.a_diy_m / a_m / sin_i;
        let latitude = target.mean_argument_of_latitude_rad() + self.a_dlambda_m / a_m - raan * cos_i;
        let (target_ex, target_ey) = eccentricity_vector(target);
        let (ex, ey) = (target_ex + self.a_dex_m / a_m, target_ey + self.a_dey_m / a_m);
        let argument_of_perigee_rad = libm::atan2(ey, ex);
        Elements {
            semi_major_axis_km: target.semi_major_axis_km + self.a_da_m / 1000.0,
            eccentricity: libm::hypot(ex, ey),
            inclination_rad: target.inclination_rad + self.a_dix_m / a_m,
            raan_rad: target.raan_rad + raan,
            argument_of_perigee_rad,
            mean_anomaly_rad: wrap(latitude - argument_of_perigee_rad),
        }
    }
}

/// Eccentricity vector (e cos ω, e sin ω).
fn eccentricity_vector(elements: &Elements) -> (f64, f64) {
    let (sin, cos) = libm::sincos(elements.argument_of_perigee_rad);
    (elements.eccentricity * cos, elements.eccentricity * sin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    /// Circular target, as assumed by the linear theory.
    const TARGET: Elements = Elements {
        semi_major_axis_km: 7130.0,
        eccentricity: 0.0,
        inclination_rad: 1.7153,
        raan_rad: 2.0,
        argument_of_perigee_rad: 0.0,
        mean_anomaly_rad: 0.4,
    };

    /// Position of the chaser relative to the target in the target's RTN, m, `seconds` after the epoch of the
    /// elements.
    fn offset_m(relative: &RelativeElements, seconds: f64) -> Vector3<f64> {
        let chaser = relative.chaser(&TARGET).propagate(seconds).state();
        let target = TARGET.propagate(seconds).state();
        target.rtn_from_icrs().rotate(&(chaser.position_km - target.position_km)) * 1000.0
    }

    fn period_s() -> f64 {
        2.0 * PI / TARGET.mean_motion_rad_s()
    }

    proptest! {
        #[test]
        fn the_chaser_comes_back_through_its_elements(
            da in -500.0_f64..500.0, dl in -4e4_f64..4e4, ex in -900.0_f64..900.0,
            ey in -900.0_f64..900.0, ix in -900.0_f64..900.0, iy in -900.0_f64..900.0,
            e in 0.0_f64..0.5, argp in -3.0_f64..3.0, m in -3.0_f64..3.0,
        ) {
            let target = Elements {
                semi_major_axis_km: 14_000.0, eccentricity: e, argument_of_perigee_rad: argp,
                mean_anomaly_rad: m, ..TARGET
            };
            let relative = RelativeElements {
                a_da_m: da, a_dlambda_m: dl, a_dex_m: ex, a_dey_m: ey, a_dix_m: ix, a_diy_m: iy,
            };
            let back = RelativeElements::between(&relative.chaser(&target), &target);
            // Angles of a few rad have rounding errors of 4e-16 rad; times 1.4e7 m these are 6 nm,
            // accumulated several times.
            for (got, expected) in [
                (back.a_da_m, da), (back.a_dlambda_m, dl), (back.a_dex_m, ex),
                (back.a_dey_m, ey), (back.a_dix_m, ix), (back.a_diy_m, iy),
            ] {
                prop_assert!((got - expected).abs() < 1e-7, "{got} {expected}");
            }
        }
    }

    /// D'Amico 2010, chapter 2, near-circular: R = aδa − aδe cos(u − φ), T = aδλ + 2 aδe sin(u − φ), N = aδi
    /// sin(u − θ).
    #[test]
    fn the_relative_orbit_is_the_ellipse_of_the_linear_theory() {
        let relative = RelativeElements { a_dey_m: 400.0, a_diy_m: 300.0, ..Default::default() };
        for k in 0..24 {
            let seconds = period_s() * f64::from(k) / 24.0;
            let u = TARGET.propagate(seconds).mean_argument_of_latitude_rad();
            // δe along +y: φ = 90°; δi along +y: θ = 90°.
            let expected = Vector3::new(-400.0 * libm::sin(u), -800.0 * libm::cos(u), -300.0 * libm::cos(u));
            let got = offset_m(&relative, seconds);
            // δe rotates with the perigee, −3.0° per day or 0.21° per orbit: 2.9 m of the 800 m along T. The
            // second order is (2 aδe)²/2a = 0.05 m.
            assert!((got - expected).norm() < 3.0, "{got} {expected}");
        }
    }

    #[test]
    fn amplitudes_are_those_of_the_eccentricity_and_inclination_vectors() {
        let relative = RelativeElements { a_dex_m: 300.0, a_dix_m: 250.0, ..Default::default() };
        let mut most = Vector3::zeros();
        for k in 0..3600 {
            most = offset_m(&relative, period_s() * f64::from(k) / 3600.0).abs().sup(&most);
        }
        // For the second order see above. aδix changes the rate of the node: 3/2 J2 (R/a)² n sin²i aδix gives
        // 2 m per orbit, and less than half a metre at the last extreme of N; cot i couples it into T.
        for (got, expected, tolerance) in [(most.x, 300.0, 0.1), (most.y, 600.0, 3.0), (most.z, 250.0, 2.1)] {
            assert!((got - expected).abs() < tolerance, "{got} {expected}");
        }
    }

    #[test]
    fn a_chaser_behind_is_at_negative_t() {
        let offset = offset_m(&RelativeElements { a_dlambda_m: -30_000.0, ..Default::default() }, 0.0);
        // Chord of an arc: T = −a sin δλ, R = −a(1 − cos δλ) = −aδλ²/2 = −63.1 m.
        assert!((offset.y + 30_000.0).abs() < 0.1, "{offset}");
        assert!((offset.x + 63.1).abs() < 0.1, "{offset}");
    }

    /// In one orbit T changes by −3π aδa (δλ' = −3/2 n δa).
    #[test]
    fn a_lower_chaser_catches_up_by_three_pi_a_delta_a_an_orbit() {
        let relative = RelativeElements { a_da_m: -40.0, a_dlambda_m: -5_000.0, ..Default::default() };
        let moved = offset_m(&relative, period_s()).y - offset_m(&relative, 0.0).y;
        // The oblateness changes the slope of n by 7/2·3/2 J2 (R/a)² ≈ 0.5 %.
        assert!((moved / (3.0 * PI * 40.0) - 1.0).abs() < 0.01, "{moved}");
    }

    #[test]
    fn a_relative_element_that_is_not_finite_is_refused_by_name() {
        let relative = RelativeElements { a_dey_m: f64::INFINITY, ..Default::default() };
        assert!(relative.check().unwrap_err().to_string().contains("orbit.relative.a_dey_m"));
    }
}
