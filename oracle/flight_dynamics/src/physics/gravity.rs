//! Motion under gravity between the states of a file.

use hifitime::Epoch;
use nalgebra::Vector3;
use sim::truth::moon::moon_position_km;
use sim::truth::{EARTH_GM_KM3_S2, EARTH_J2, EGM96_RADIUS_KM, State, clock, ephemeris};

/// Gravitational parameters of the Moon and the Sun, km³/s² (JPL DE421).
const MOON_GM_KM3_S2: f64 = 4_902.800_076;
const SUN_GM_KM3_S2: f64 = 132_712_440_040.944;

/// Distance from the Earth beyond which the Moon and the Sun count, km: below it their tides are less than
/// 1e-4 of the Earth's attraction.
const TIDES_FROM_KM: f64 = 20_000.0;

/// Largest change of the angle about the attracting body in a step, rad: the error of a step is below 1e-8 of
/// the distance.
const STEP_RAD: f64 = 0.05;

/// Largest number of steps, about three revolutions.
const MAX_STEPS: usize = 400;

/// Attraction by the Earth with its oblateness, and by the Moon and the Sun, which stand still.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Gravity {
    /// Moon and Sun: gravitational parameter, km³/s², and geocentric position, km.
    bodies: Option<[(f64, Vector3<f64>); 2]>,
}

impl Gravity {
    /// Creates the field at a time, for motion at `distance_km` from the Earth's centre.
    pub(crate) fn new(time: Epoch, distance_km: f64) -> Self {
        if distance_km < TIDES_FROM_KM {
            return Self::default();
        }
        let tdb_s = clock::tdb_j2000_s(time);
        let bodies = ephemeris::earth(tdb_s).map(|earth| {
            [(MOON_GM_KM3_S2, moon_position_km(tdb_s)), (SUN_GM_KM3_S2, earth.sun_geocentric_km())]
        });
        Self { bodies }
    }

    /// Returns the acceleration, km/s², ICRS axes. The Earth's axis is the z axis, which is exact enough for
    /// the small term of the oblateness.
    pub(crate) fn acceleration(&self, position_km: &Vector3<f64>) -> Vector3<f64> {
        let distance = position_km.norm();
        let central = EARTH_GM_KM3_S2 / (distance * distance * distance);
        let flattening = 1.5 * EARTH_J2 * (EGM96_RADIUS_KM / distance) * (EGM96_RADIUS_KM / distance);
        let sin_latitude = position_km.z / distance;
        let square = 5.0 * sin_latitude * sin_latitude;
        let mut sum = Vector3::new(
            -central * position_km.x * (1.0 + flattening * (1.0 - square)),
            -central * position_km.y * (1.0 + flattening * (1.0 - square)),
            -central * position_km.z * (1.0 + flattening * (3.0 - square)),
        );
        for (gm, body_km) in self.bodies.iter().flatten() {
            let to_body = body_km - position_km;
            let (near, far) = (to_body.norm(), body_km.norm());
            sum += (to_body / (near * near * near) - body_km / (far * far * far)) * *gm;
        }
        sum
    }

    /// Returns the step within which the direction to no attracting body turns by more than [`STEP_RAD`], s.
    fn step_s(&self, position_km: &Vector3<f64>) -> f64 {
        let step = |gm: f64, distance: f64| STEP_RAD * (distance * distance * distance / gm).sqrt();
        let moon = self.bodies.iter().flatten().map(|(gm, body)| step(*gm, (body - position_km).norm()));
        moon.fold(step(EARTH_GM_KM3_S2, position_km.norm()), f64::min)
    }

    /// Returns the state `seconds` later, earlier if negative (fourth-order Runge-Kutta); `None` after more
    /// than [`MAX_STEPS`] steps.
    pub(crate) fn propagate(&self, state: &State, seconds: f64) -> Option<State> {
        let (mut state, mut left_s) = (*state, seconds);
        for _ in 0..MAX_STEPS {
            let longest = self.step_s(&state.position_km);
            if left_s.abs() <= longest {
                return Some(self.step(&state, left_s));
            }
            let step_s = longest.copysign(left_s);
            state = self.step(&state, step_s);
            left_s -= step_s;
        }
        None
    }

    fn step(&self, state: &State, step_s: f64) -> State {
        let (r, v) = (&state.position_km, &state.velocity_km_s);
        let half_s = 0.5 * step_s;
        let a1 = self.acceleration(r);
        let v2 = v + a1 * half_s;
        let a2 = self.acceleration(&(r + v * half_s));
        let v3 = v + a2 * half_s;
        let a3 = self.acceleration(&(r + v2 * half_s));
        let v4 = v + a3 * step_s;
        let a4 = self.acceleration(&(r + v3 * step_s));
        State {
            position_km: r + (v + v2 * 2.0 + v3 * 2.0 + v4) * (step_s / 6.0),
            velocity_km_s: v + (a1 + a2 * 2.0 + a3 * 2.0 + a4) * (step_s / 6.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ellipse_returns_to_its_start_but_for_the_oblateness() {
        let distance_km = 7_000.0_f64;
        let speed = (EARTH_GM_KM3_S2 / distance_km).sqrt();
        let start = State {
            position_km: Vector3::new(distance_km, 0.0, 0.0),
            velocity_km_s: Vector3::new(0.0, speed, 0.0),
        };
        let period_s = std::f64::consts::TAU * distance_km / speed;
        let gravity = Gravity::default();
        let end = gravity.propagate(&start, period_s).unwrap();
        // On the equator the oblateness adds 1.5 J2 (R/r)² = 1.3e-3 of the attraction.
        assert!((end.position_km - start.position_km).norm() < 2.0 * std::f64::consts::PI * 0.004 * 7_000.0);
        let back = gravity.propagate(&end, -period_s).unwrap();
        assert!((back.position_km - start.position_km).norm() < 0.01, "{back:?}");
        assert!(gravity.propagate(&start, 10.0 * period_s).is_none());
    }
}
