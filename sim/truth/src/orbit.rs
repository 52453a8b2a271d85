//! Orbit: Keplerian elements that drift due to the Earth's oblateness, and the corresponding state.
//!
//! Positions and velocities are geocentric and their axes are treated as ICRS. Three simplifications:
//! - the elements are mean elements used as osculating elements: secular drift, no short-period terms. The
//!   short-period terms move each satellite by a few kilometres and, because they are nearly equal for the
//!   two satellites, the line of sight by about 1e-3 rad. This changes the path of the target through the
//!   image, but is no error in it: image and truth share the path;
//! - the equator is that of ICRS and not that of date (the pole moved by 0.07° from 2000 to 2012);
//! - the velocity is the Keplerian velocity of the elements at that instant. It differs from the derivative
//!   of the position by the drift rates, about 1e-3 of the orbital velocity: 0.005″ of aberration.

use contract::bounds::{self, require};
use contract::{Icrs, OutOfRange, Rotation};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::kepler::{MAX_ECCENTRICITY, eccentric_anomaly, wrap};

/// Gravitational parameter of the Earth, km³/s² (EGM96: Lemoine et al., NASA/TP-1998-206861).
pub const EARTH_GM_KM3_S2: f64 = 398_600.441_5;

/// Reference radius of the gravity field, km (EGM96): for use with [`EARTH_J2`] only. For the radius of the
/// body see [`super::shadow::EARTH_RADIUS_KM`].
pub const EGM96_RADIUS_KM: f64 = 6_378.136_3;

/// Oblateness of the Earth: J2 = −√5 C̄20 with C̄20 = −4.841 653 717 36e-4 (EGM96).
pub const EARTH_J2: f64 = 1.082_626_683_5e-3;

/// Smallest perigee radius, km: 100 km above the equator.
const MIN_PERIGEE_KM: f64 = EGM96_RADIUS_KM + 100.0;

/// Largest semi-major axis, km; beyond it the Moon and the Sun dominate.
const MAX_SEMI_MAJOR_AXIS_KM: f64 = 100_000.0;

/// Smallest sine of the inclination; below it the node is undefined.
const MIN_SIN_INCLINATION: f64 = 1e-4;

/// Orbital frame at an instant: R along the position, N along the angular momentum, T = N × R (along the
/// velocity on a circular orbit). Vector components are (R, T, N).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rtn {}

/// Keplerian elements in a scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElementsConfig {
    /// Semi-major axis, km; at most 100000, perigee radius at least 6478.1363.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100000))]
    pub semi_major_axis_km: f64,
    /// Eccentricity, 0 to 0.9.
    #[schemars(range(min = 0, max = MAX_ECCENTRICITY))]
    pub eccentricity: f64,
    /// Inclination, degrees, 0.01 to 179.99.
    #[schemars(range(min = 0.01, max = 179.99))]
    pub inclination_deg: f64,
    /// Right ascension of the ascending node, degrees, −360 to 360.
    #[schemars(range(min = -360, max = 360))]
    pub raan_deg: f64,
    /// Argument of perigee, degrees, −360 to 360.
    #[schemars(range(min = -360, max = 360))]
    pub argument_of_perigee_deg: f64,
    /// Mean anomaly at the epoch, degrees, −360 to 360.
    #[schemars(range(min = -360, max = 360))]
    pub mean_anomaly_deg: f64,
}

impl ElementsConfig {
    /// Checks every number.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "orbit.target")?;
        let perigee_km = self.semi_major_axis_km * (1.0 - self.eccentricity);
        let expected = format!(
            "with an eccentricity of {} at least {}, so that the perigee radius is {MIN_PERIGEE_KM:.4} km or more",
            self.eccentricity,
            MIN_PERIGEE_KM / (1.0 - self.eccentricity)
        );
        require("orbit.target.semi_major_axis_km", self.semi_major_axis_km, expected, |_| {
            perigee_km >= MIN_PERIGEE_KM
        })
    }

    /// Converts the elements to radians.
    ///
    /// # Errors
    /// See [`ElementsConfig::check`].
    pub fn elements(&self) -> Result<Elements, OutOfRange> {
        self.check()?;
        Ok(Elements {
            semi_major_axis_km: self.semi_major_axis_km,
            eccentricity: self.eccentricity,
            inclination_rad: self.inclination_deg.to_radians(),
            raan_rad: self.raan_deg.to_radians(),
            argument_of_perigee_rad: self.argument_of_perigee_deg.to_radians(),
            mean_anomaly_rad: self.mean_anomaly_deg.to_radians(),
        })
    }
}

/// Position and velocity relative to the Earth, ICRS axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Position relative to the Earth's centre, km.
    pub position_km: Vector3<f64>,
    /// Velocity relative to the Earth's centre, km/s.
    pub velocity_km_s: Vector3<f64>,
}

impl State {
    /// Returns the rotation from ICRS to the orbital frame at this instant.
    pub fn rtn_from_icrs(&self) -> Rotation<Rtn, Icrs> {
        let radial = self.position_km.normalize();
        let normal = self.position_km.cross(&self.velocity_km_s).normalize();
        Rotation::from_axes(&radial, &normal.cross(&radial), &normal)
    }
}

/// Keplerian elements of a geocentric orbit at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elements {
    /// Semi-major axis, km.
    pub semi_major_axis_km: f64,
    /// Eccentricity, in [0, 0.9].
    pub eccentricity: f64,
    /// Inclination, rad.
    pub inclination_rad: f64,
    /// Right ascension of the ascending node Ω, rad.
    pub raan_rad: f64,
    /// Argument of perigee ω, rad.
    pub argument_of_perigee_rad: f64,
    /// Mean anomaly M, rad.
    pub mean_anomaly_rad: f64,
}

/// Secular rates of an orbit's angles, rad/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SecularRates {
    /// Rate of the right ascension of the ascending node.
    pub raan_rad_s: f64,
    /// Rate of the argument of perigee.
    pub argument_of_perigee_rad_s: f64,
    /// Rate of the mean anomaly, mean motion included.
    pub mean_anomaly_rad_s: f64,
}

impl Elements {
    /// Keplerian mean motion n = √(GM/a³), rad/s.
    pub fn mean_motion_rad_s(&self) -> f64 {
        let a = self.semi_major_axis_km;
        (EARTH_GM_KM3_S2 / (a * a * a)).sqrt()
    }

    /// Mean argument of latitude u = ω + M, rad, not wrapped.
    pub fn mean_argument_of_latitude_rad(&self) -> f64 {
        self.argument_of_perigee_rad + self.mean_anomaly_rad
    }

    /// First-order secular rates under J2 (Vallado, *Fundamentals of Astrodynamics and Applications*, 4th
    /// edition, section 9.6). With γ = 3/2 J2 (R/p)² n, p = a(1 − e²): Ω' = −γ cos i, ω' = γ (2 − 5/2 sin²
    /// i), M' = n + γ √(1 − e²) (1 − 3/2 sin² i).
    pub fn secular_rates(&self) -> SecularRates {
        let n = self.mean_motion_rad_s();
        let one_minus_e2 = 1.0 - self.eccentricity * self.eccentricity;
        let radius_over_p = EGM96_RADIUS_KM / (self.semi_major_axis_km * one_minus_e2);
        let gamma = 1.5 * EARTH_J2 * radius_over_p * radius_over_p * n;
        let (sin_i, cos_i) = libm::sincos(self.inclination_rad);
        SecularRates {
            raan_rad_s: -gamma * cos_i,
            argument_of_perigee_rad_s: gamma * (2.0 - 2.5 * sin_i * sin_i),
            mean_anomaly_rad_s: n + gamma * one_minus_e2.sqrt() * (1.0 - 1.5 * sin_i * sin_i),
        }
    }

    /// Returns the elements `seconds` later (earlier if negative): Ω, ω and M drift, the other elements are
    /// constant.
    pub fn propagate(&self, seconds: f64) -> Self {
        let rates = self.secular_rates();
        Self {
            raan_rad: wrap(self.raan_rad + rates.raan_rad_s * seconds),
            argument_of_perigee_rad: wrap(
                self.argument_of_perigee_rad + rates.argument_of_perigee_rad_s * seconds,
            ),
            mean_anomaly_rad: wrap(self.mean_anomaly_rad + rates.mean_anomaly_rad_s * seconds),
            ..*self
        }
    }

    /// Returns the position and the Keplerian velocity.
    pub fn state(&self) -> State {
        let (a, e) = (self.semi_major_axis_km, self.eccentricity);
        let (sin_anomaly, cos_anomaly) = libm::sincos(eccentric_anomaly(self.mean_anomaly_rad, e));
        let eta = (1.0 - e * e).sqrt();
        let anomaly_rate = self.mean_motion_rad_s() / (1.0 - e * cos_anomaly);

        // Axes of the orbit: P towards the perigee, Q 90° ahead in the direction of motion.
        let (sin_raan, cos_raan) = libm::sincos(self.raan_rad);
        let (sin_argp, cos_argp) = libm::sincos(self.argument_of_perigee_rad);
        let (sin_i, cos_i) = libm::sincos(self.inclination_rad);
        let node = Vector3::new(cos_raan, sin_raan, 0.0);
        let across = Vector3::new(-sin_raan * cos_i, cos_raan * cos_i, sin_i);
        let p = node * cos_argp + across * sin_argp;
        let q = across * cos_argp - node * sin_argp;

        State {
            position_km: (p * (cos_anomaly - e) + q * (eta * sin_anomaly)) * a,
            velocity_km_s: (q * (eta * cos_anomaly) - p * sin_anomaly) * (a * anomaly_rate),
        }
    }

    /// Returns the elements of a state; `None` if they are not supported: not an ellipse, e above 0.9,
    /// perigee height below 100 km, a above 100000 km, or an equatorial orbit.
    pub fn from_state(state: &State) -> Option<Self> {
        let (r, v) = (&state.position_km, &state.velocity_km_s);
        let distance = r.norm();
        let momentum = r.cross(v);
        let normal = momentum / momentum.norm();
        let sin_i = libm::hypot(normal.x, normal.y);
        let node = Vector3::new(-normal.y, normal.x, 0.0) / sin_i;
        let across = normal.cross(&node);

        // The eccentricity vector relative to the node is also defined for a circular orbit.
        let eccentricity_vector = v.cross(&momentum) / EARTH_GM_KM3_S2 - r / distance;
        let (e_x, e_y) = (eccentricity_vector.dot(&node), eccentricity_vector.dot(&across));
        let e = libm::hypot(e_x, e_y);
        let argument_of_perigee_rad = libm::atan2(e_y, e_x);
        let true_anomaly = libm::atan2(r.dot(&across), r.dot(&node)) - argument_of_perigee_rad;
        let (sin_nu, cos_nu) = libm::sincos(true_anomaly);
        let anomaly = libm::atan2((1.0 - e * e).max(0.0).sqrt() * sin_nu, e + cos_nu);

        let elements = Self {
            semi_major_axis_km: 1.0 / (2.0 / distance - v.norm_squared() / EARTH_GM_KM3_S2),
            eccentricity: e,
            inclination_rad: libm::atan2(sin_i, normal.z),
            raan_rad: libm::atan2(node.y, node.x),
            argument_of_perigee_rad,
            mean_anomaly_rad: wrap(anomaly - e * libm::sin(anomaly)),
        };
        elements.is_supported().then_some(elements)
    }

    /// Returns true if the orbit is supported; false if any element is NaN.
    pub(crate) fn is_supported(&self) -> bool {
        let (a, e) = (self.semi_major_axis_km, self.eccentricity);
        (0.0..=MAX_ECCENTRICITY).contains(&e)
            && a <= MAX_SEMI_MAJOR_AXIS_KM
            && a * (1.0 - e) >= MIN_PERIGEE_KM
            && libm::sin(self.inclination_rad) >= MIN_SIN_INCLINATION
            && self.raan_rad.is_finite()
            && self.argument_of_perigee_rad.is_finite()
            && self.mean_anomaly_rad.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn elements(a: f64, e: f64, i_deg: f64, angles_deg: [f64; 3]) -> Elements {
        let [raan_deg, argument_of_perigee_deg, mean_anomaly_deg] = angles_deg;
        ElementsConfig {
            semi_major_axis_km: a,
            eccentricity: e,
            inclination_deg: i_deg,
            raan_deg,
            argument_of_perigee_deg,
            mean_anomaly_deg,
        }
        .elements()
        .unwrap()
    }

    proptest! {
        #[test]
        fn a_state_comes_back_through_its_elements(
            perigee in 6500.0_f64..9000.0, e in 0.0_f64..0.9, i in 0.1_f64..179.9,
            raan in -180.0_f64..180.0, argp in -180.0_f64..180.0, m in -180.0_f64..180.0,
        ) {
            let state = elements(perigee / (1.0 - e), e, i, [raan, argp, m]).state();
            let back = Elements::from_state(&state).unwrap().state();
            // Positions of 1e4..1e5 km have rounding errors of 1e-11 km; a small sin i and 1/(1 − e) amplify
            // them by up to a thousand.
            prop_assert!((back.position_km - state.position_km).norm() < 1e-7);
            prop_assert!((back.velocity_km_s - state.velocity_km_s).norm() < 1e-10);
        }

        #[test]
        fn energy_and_angular_momentum_are_those_of_the_elements(
            perigee in 6500.0_f64..9000.0, e in 0.0_f64..0.9, m in -180.0_f64..180.0,
        ) {
            let orbit = elements(perigee / (1.0 - e), e, 98.28, [120.0, 40.0, m]);
            let State { position_km: r, velocity_km_s: v } = orbit.state();
            let energy = 0.5 * v.norm_squared() - EARTH_GM_KM3_S2 / r.norm();
            let expected = -0.5 * EARTH_GM_KM3_S2 / orbit.semi_major_axis_km;
            // At the perigee of an eccentric orbit the energy is a difference of terms up to 20 times larger
            // than the energy.
            prop_assert!((energy / expected - 1.0).abs() < 1e-13);
            let momentum = r.cross(&v);
            let p = orbit.semi_major_axis_km * (1.0 - e * e);
            prop_assert!((momentum.norm() / (EARTH_GM_KM3_S2 * p).sqrt() - 1.0).abs() < 1e-13);
            prop_assert!((momentum.z / momentum.norm() - libm::cos(orbit.inclination_rad)).abs() < 1e-14);
        }
    }

    /// Curtis, *Orbital Mechanics for Engineering Students*, 3rd edition, example 4.3: from r = (−6045,
    /// −3490, 2500) km and v = (−3.457, 6.618, 2.533) km/s to h = 58310 km²/s, i = 153.2°, Ω = 255.3°, e =
    /// 0.1712, ω = 20.07°, θ = 28.45°, with μ = 398600.
    #[test]
    fn the_example_of_curtis_is_met() {
        let state = State {
            position_km: Vector3::new(-6045.0, -3490.0, 2500.0),
            velocity_km_s: Vector3::new(-3.457, 6.618, 2.533),
        };
        // The perigee is 7284 km; the values are compared to the digits printed.
        let got = Elements::from_state(&state).unwrap();
        assert!((got.eccentricity - 0.1712).abs() < 1e-4);
        assert!((got.inclination_rad.to_degrees() - 153.2).abs() < 0.06);
        assert!((got.raan_rad.to_degrees() + 360.0 - 255.3).abs() < 0.06);
        assert!((got.argument_of_perigee_rad.to_degrees() - 20.07).abs() < 0.006);
        assert!((got.semi_major_axis_km - 8788.0).abs() < 1.0);
    }

    /// In closed form, the node of a circular orbit follows the mean Sun, 360° in a tropical year of 365.2422
    /// days, for cos i = −Ω'/(3/2 J2 (R/a)² n). Textbooks give 98.6° for a height of 800 km.
    #[test]
    fn a_sun_synchronous_orbit_keeps_pace_with_the_sun() {
        let sun_rad_s = 360.0_f64.to_radians() / (365.2422 * 86400.0);
        let a = EGM96_RADIUS_KM + 800.0;
        let n = (EARTH_GM_KM3_S2 / (a * a * a)).sqrt();
        let cos_i = -sun_rad_s / (1.5 * EARTH_J2 * (EGM96_RADIUS_KM / a) * (EGM96_RADIUS_KM / a) * n);
        let i_deg = libm::acos(cos_i).to_degrees();
        assert!((i_deg - 98.6).abs() < 0.05, "{i_deg}");
        let rate = elements(a, 0.0, i_deg, [0.0; 3]).secular_rates().raan_rad_s;
        assert!((rate / sun_rad_s - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_perigee_stands_still_at_the_critical_inclination() {
        // sin² i = 4/5.
        let critical = libm::asin((0.8_f64).sqrt()).to_degrees();
        let rates = elements(26_600.0, 0.7, critical, [0.0; 3]).secular_rates();
        assert!(rates.argument_of_perigee_rad_s.abs() < 1e-20);
    }

    /// Without J2 the velocity is the derivative of the position: checked along the ellipse, with constant Ω
    /// and ω.
    #[test]
    fn the_velocity_is_the_derivative_of_the_position_along_the_ellipse() {
        let orbit = elements(7130.0, 0.003, 98.28, [120.0, 40.0, 200.0]);
        let at = |seconds: f64| {
            let mean_anomaly_rad = orbit.mean_anomaly_rad + orbit.mean_motion_rad_s() * seconds;
            Elements { mean_anomaly_rad, ..orbit }.state().position_km
        };
        let derivative = (at(0.5) - at(-0.5)) / 1.0;
        // Error of the central difference: n³ a h²/6 with h = 0.5 s is 3.4e-7 km/s.
        assert!((derivative - orbit.state().velocity_km_s).norm() < 4e-7);
    }

    #[test]
    fn rtn_is_right_handed_and_follows_the_orbit() {
        let state = elements(7130.0, 0.0, 98.28, [120.0, 40.0, 200.0]).state();
        let rtn_from_icrs = state.rtn_from_icrs();
        let velocity = rtn_from_icrs.rotate(&state.velocity_km_s);
        assert!((rtn_from_icrs.rotate(&state.position_km).x - 7130.0).abs() < 1e-9);
        assert!(velocity.y > 7.0 && velocity.x.abs() < 1e-12 && velocity.z.abs() < 1e-12);
    }

    #[test]
    fn an_unusable_state_has_no_elements() {
        let position_km = Vector3::new(7000.0, 0.0, 0.0);
        for velocity_km_s in [
            Vector3::zeros(),                 // falls
            Vector3::new(0.0, 1.0, 12.0),     // leaves
            Vector3::new(0.0, 7.5, 0.0),      // lies in the equator
            Vector3::new(0.0, f64::NAN, 1.0), // is nowhere
            Vector3::new(3.0, 0.0, 6.0),      // meets the Earth
        ] {
            assert_eq!(Elements::from_state(&State { position_km, velocity_km_s }), None);
        }
    }

    #[test]
    fn elements_outside_their_range_are_refused_by_name() {
        let good = ElementsConfig {
            semi_major_axis_km: 7130.0,
            eccentricity: 0.003,
            inclination_deg: 98.28,
            raan_deg: 0.0,
            argument_of_perigee_deg: 0.0,
            mean_anomaly_deg: 0.0,
        };
        assert!(good.check().is_ok());
        let bad = [
            (ElementsConfig { semi_major_axis_km: f64::NAN, ..good.clone() }, "semi_major_axis_km"),
            (ElementsConfig { eccentricity: 0.95, ..good.clone() }, "eccentricity"),
            (ElementsConfig { eccentricity: 0.2, ..good.clone() }, "perigee"),
            (ElementsConfig { inclination_deg: 0.0, ..good.clone() }, "inclination_deg"),
            (ElementsConfig { mean_anomaly_deg: 400.0, ..good.clone() }, "mean_anomaly_deg"),
        ];
        for (config, name) in bad {
            let message = config.check().unwrap_err().to_string();
            assert!(message.contains(name), "{message}");
        }
    }
}
