//! Short-period variations due to J2: the map between mean and osculating elements.
//!
//! First order in J2 and in the eccentricity: Gauss's equations of variation with the acceleration of J2 are
//! expanded in e, their mean over the mean argument of latitude u is the secular drift, and the integral of
//! the remainder, with zero mean over u, is the variation (Brouwer 1959, AJ 64, 378, in the nonsingular
//! variables of Lyddane 1963, AJ 68, 555). `golden/navigation/short_period.py` derives the coefficients.
//! Omitted: terms of relative size e² J2 and J2², for e = 0.003 five metres of the absolute position with
//! half and four metres with a quarter of the period of the orbit, 0.1 to 0.2 m of a relative position at
//! 30 km, which is 1″.

use crate::orbit::{J2, Orbit, RADIUS_KM, State, wrap};

/// Iterations of the inverse map; each reduces the error by a factor of about J2.
const INVERSE_ITERATIONS: usize = 6;

/// Relation between the elements that drift secularly and the state.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum Osculation {
    /// Short-period variations of first order in J2 are added to the mean elements: for a real or
    /// numerically integrated orbit.
    #[default]
    FirstOrder,
    /// Mean elements are used as osculating elements: for a simulated orbit without short-period variations.
    None,
}

impl Osculation {
    /// Returns the state of mean elements.
    pub fn state(self, mean: &Orbit) -> State {
        self.osculating(mean).state()
    }

    /// Returns the osculating elements of mean elements.
    pub fn osculating(self, mean: &Orbit) -> Orbit {
        match self {
            Self::None => *mean,
            Self::FirstOrder => sum(mean, &variations(mean), 1.0),
        }
    }

    /// Returns the mean elements of a state; `None` for a state without a supported orbit.
    pub fn mean(self, state: &State) -> Option<Orbit> {
        let osculating = Orbit::from_state(state)?;
        match self {
            Self::None => Some(osculating),
            Self::FirstOrder => {
                let mut mean = osculating;
                for _ in 0..INVERSE_ITERATIONS {
                    mean = sum(&osculating, &variations(&mean), -1.0);
                }
                mean.is_supported().then_some(mean)
            }
        }
    }
}

/// Adds `sign` times the variations to elements.
fn sum(orbit: &Orbit, [a_km, u, ex, ey, i, raan]: &[f64; 6], sign: f64) -> Orbit {
    Orbit {
        a_km: orbit.a_km + sign * a_km,
        u: wrap(orbit.u + sign * u),
        ex: orbit.ex + sign * ex,
        ey: orbit.ey + sign * ey,
        i: orbit.i + sign * i,
        raan: wrap(orbit.raan + sign * raan),
    }
}

/// Osculating minus mean elements (a in km, u, ex, ey, i, Ω), a function of the mean elements.
fn variations(mean: &Orbit) -> [f64; 6] {
    let Orbit { a_km, u, ex: k, ey: h, i, .. } = *mean;
    let over_a = RADIUS_KM / a_km;
    let kappa = J2 * over_a * over_a;
    let (s, c) = libm::sincos(i);
    let (s2, c2) = (s * s, c * c);
    let (sin1, cos1) = libm::sincos(u);
    let (sin2, cos2) = (2.0 * sin1 * cos1, cos1 * cos1 - sin1 * sin1);
    let (sin3, cos3) = (sin2 * cos1 + cos2 * sin1, cos2 * cos1 - sin2 * sin1);
    let (sin4, cos4) = (2.0 * sin2 * cos2, cos2 * cos2 - sin2 * sin2);
    let of_a = 1.5 * s2 * cos2
        + 0.75 * ((4.0 - 5.0 * s2) * h * sin1 + (4.0 - 7.0 * s2) * k * cos1)
        + 5.25 * s2 * (h * sin3 + k * cos3);
    let of_u = 0.375 * (3.0 * s2 - 2.0 * c2) * sin2
        + 1.3125 * (4.0 + 4.0 * c2 - 7.0 * s2) * k * sin1
        + 0.1875 * (35.0 * s2 - 20.0 * c2 - 28.0) * h * cos1
        + 0.4375 * (7.0 * s2 - 4.0 * c2) * (k * sin3 - h * cos3);
    let of_ex = 0.375 * (4.0 - 5.0 * s2) * cos1
        + 0.875 * s2 * cos3
        + 0.75 * ((3.0 + c2 - 2.0 * s2) * h * sin2 + (3.0 - 5.0 * s2) * k * cos2)
        + 3.1875 * s2 * (h * sin4 + k * cos4);
    let of_ey = 0.375 * (4.0 - 7.0 * s2) * sin1
        + 0.875 * s2 * sin3
        + 0.75 * ((3.0 - c2 - 7.0 * s2) * k * sin2 + (4.0 * s2 - 3.0) * h * cos2)
        + 3.1875 * s2 * (k * sin4 - h * cos4);
    let of_i = 0.75 * s * c * (cos2 + h * sin1 - k * cos1) + 1.75 * s * c * (h * sin3 + k * cos3);
    let of_raan = 0.75 * c * (sin2 - 7.0 * k * sin1 + 5.0 * h * cos1) + 1.75 * c * (k * sin3 - h * cos3);
    [a_km * of_a, of_u, of_ex, of_ey, of_i, of_raan].map(|variation| variation * kappa)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MEAN: Orbit = Orbit { a_km: 7130.0, u: 0.7, ex: 0.001, ey: 0.0028, i: 1.7153, raan: 2.2 };

    #[test]
    fn the_inverse_map_inverts_the_map() {
        for step in 0..12 {
            let mean = Orbit { u: wrap(0.5 * f64::from(step)), ..MEAN };
            let back = Osculation::FirstOrder.mean(&Osculation::FirstOrder.state(&mean)).unwrap();
            assert!((back.a_km - mean.a_km).abs() < 1e-8, "{back:?}");
            assert!(wrap(back.u - mean.u).abs() < 1e-11 && (back.ex - mean.ex).abs() < 1e-12);
            assert_eq!(Osculation::None.osculating(&mean), mean);
        }
    }

    /// The energy with the potential of J2 is constant along an orbit: with osculating elements, the
    /// Keplerian energy varies by thousands of times more than their sum.
    #[test]
    fn the_energy_of_the_oblate_earth_is_nearly_constant() {
        let energy = |step: i32, osculation: Osculation| {
            let mean = Orbit { u: wrap(0.1 * f64::from(step)), ..MEAN };
            let state = osculation.state(&mean);
            let r = state.position_km.norm();
            let sin_latitude = state.position_km.z / r;
            let over_r = RADIUS_KM / r;
            let potential = crate::orbit::GM_KM3_S2 / r
                * (1.0 - 0.5 * J2 * over_r * over_r * (3.0 * sin_latitude * sin_latitude - 1.0));
            0.5 * state.velocity_km_s.norm_squared() - potential
        };
        let spread = |osculation| {
            let energies = (0..63).map(|step| energy(step, osculation));
            let (low, high) = energies.fold((f64::MAX, f64::MIN), |(l, h), e| (l.min(e), h.max(e)));
            high - low
        };
        let (with, without) = (spread(Osculation::FirstOrder), spread(Osculation::None));
        // Left over: J2² and J2 e².
        assert!(with < 3e-3 * without, "{with} {without}");
    }
}
