//! Impulsive manoeuvres of the chaser.

use contract::{OutOfRange, bounds};
use hifitime::Epoch;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::clock::parse_utc_field;
use super::orbit::{Elements, State};

/// Impulse of the chaser.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ManoeuvreConfig {
    /// Time, UTC, for example 2012-04-24T00:31:07; after the orbit's epoch and after the preceding manoeuvre
    /// of the list.
    pub time_utc: String,
    /// Change of velocity along the chaser's own radial, transverse and normal axes, m/s, each −100 to 100.
    #[schemars(inner(range(min = -100, max = 100)))]
    pub dv_rtn_m_s: [f64; 3],
}

impl ManoeuvreConfig {
    /// Checks text and numbers; `index` is the index in the list, counted from 0, for the message.
    ///
    /// # Errors
    /// [`OutOfRange`] for an invalid time or a change of velocity outside its range.
    pub fn check(&self, index: usize) -> Result<(), OutOfRange> {
        self.time().map_err(|error| error.in_entry(index))?;
        bounds::check(self, &format!("orbit.manoeuvres[{index}]"))
    }

    /// Time of the manoeuvre.
    pub(crate) fn time(&self) -> Result<Epoch, OutOfRange> {
        parse_utc_field("orbit.manoeuvres[].time_utc", &self.time_utc)
    }

    /// Returns the orbit after the impulse, from the orbit just before: the position is unchanged, the
    /// velocity changes exactly. `None` if the resulting orbit is not supported.
    pub(crate) fn apply(&self, before: &Elements) -> Option<Elements> {
        let state = before.state();
        let icrs_from_rtn = state.rtn_from_icrs().inverse();
        let dv_km_s = icrs_from_rtn.rotate(&(Vector3::from(self.dv_rtn_m_s) * 1e-3));
        Elements::from_state(&State { velocity_km_s: state.velocity_km_s + dv_km_s, ..state })
    }

    /// Returns the error for an impulse, with its index in the list.
    pub(crate) fn refused_impulse(&self, index: usize, expected: &'static str) -> OutOfRange {
        OutOfRange::new("orbit.manoeuvres[].dv_rtn_m_s", format!("{:?}", self.dv_rtn_m_s), expected)
            .in_entry(index)
    }

    /// Returns the error for a time, with its index in the list.
    pub(crate) fn refused_time(&self, index: usize, expected: &'static str) -> OutOfRange {
        OutOfRange::new("orbit.manoeuvres[].time_utc", self.time_utc.clone(), expected).in_entry(index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::relative::RelativeElements;

    const CIRCULAR: Elements = Elements {
        semi_major_axis_km: 7130.0,
        eccentricity: 0.0,
        inclination_rad: 1.7153,
        raan_rad: 2.0,
        argument_of_perigee_rad: 0.0,
        mean_anomaly_rad: 0.7,
    };

    fn impulse(dv_rtn_m_s: [f64; 3]) -> RelativeElements {
        let manoeuvre = ManoeuvreConfig { time_utc: "2012-04-23T00:00:00Z".into(), dv_rtn_m_s };
        RelativeElements::between(&manoeuvre.apply(&CIRCULAR).unwrap(), &CIRCULAR)
    }

    /// Compares with the linear theory. The second order is Δv/v = 1e-6 of an effect of at most 20 m, and
    /// δi's second order through cot i is equally small: a tenth of a millimetre.
    fn check(got: RelativeElements, expected: [f64; 6]) {
        let got = [got.a_da_m, got.a_dlambda_m, got.a_dex_m, got.a_dey_m, got.a_dix_m, got.a_diy_m];
        for (g, e) in got.iter().zip(expected) {
            assert!((g - e).abs() < 1e-4, "{got:?} {expected:?}");
        }
    }

    // Effects of an impulse on the relative elements in linear theory (D'Amico 2010, chapter 2), evaluated at
    // u = 0.7 rad.

    #[test]
    fn a_radial_impulse_moves_lambda_and_the_eccentricity_vector() {
        let (sin, cos) = libm::sincos(0.7);
        let unit = 0.01 / CIRCULAR.mean_motion_rad_s();
        check(impulse([0.01, 0.0, 0.0]), [0.0, -2.0 * unit, unit * sin, -unit * cos, 0.0, 0.0]);
    }

    #[test]
    fn a_transverse_impulse_moves_the_axis_and_the_eccentricity_vector() {
        let (sin, cos) = libm::sincos(0.7);
        let unit = 0.01 / CIRCULAR.mean_motion_rad_s();
        check(impulse([0.0, 0.01, 0.0]), [2.0 * unit, 0.0, 2.0 * unit * cos, 2.0 * unit * sin, 0.0, 0.0]);
    }

    #[test]
    fn a_normal_impulse_moves_the_inclination_vector() {
        let (sin, cos) = libm::sincos(0.7);
        let unit = 0.01 / CIRCULAR.mean_motion_rad_s();
        check(impulse([0.0, 0.0, 0.01]), [0.0, 0.0, 0.0, 0.0, unit * cos, unit * sin]);
    }

    #[test]
    fn an_impulse_leaves_the_position_where_it_was() {
        let manoeuvre =
            ManoeuvreConfig { time_utc: "2012-04-23T00:00:00Z".into(), dv_rtn_m_s: [1.0, -2.0, 3.0] };
        let before = Elements { eccentricity: 0.003, ..CIRCULAR };
        let after = manoeuvre.apply(&before).unwrap();
        // Rounding of 7130 km: 1e-12 km, accumulated through several angles.
        assert!((after.state().position_km - before.state().position_km).norm() < 1e-10);
        let dv = after.state().velocity_km_s - before.state().velocity_km_s;
        assert!((dv.norm() - 14.0_f64.sqrt() * 1e-3).abs() < 1e-13);
    }

    #[test]
    fn an_impulse_that_is_not_a_number_is_refused_by_its_index() {
        let manoeuvre =
            ManoeuvreConfig { time_utc: "2012-04-23T00:00:00Z".into(), dv_rtn_m_s: [f64::NAN, 0.0, 0.0] };
        let message = manoeuvre.check(3).unwrap_err().to_string();
        assert!(message.contains("orbit.manoeuvres[3].dv_rtn_m_s[0] is NaN"), "{message}");
    }
}
