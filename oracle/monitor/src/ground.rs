//! Sub-satellite and subsolar points on the Earth.

use hifitime::{Epoch, Unit};
use nalgebra::Vector3;
use sim::truth::{Trajectory, clock, ephemeris, geographic};

use crate::report::Ground;

/// Time span of the drawn track before and after a frame, s, and its step, s.
const REACH_S: f64 = 3000.0;
const STEP_S: f64 = 60.0;

/// Source of a spacecraft's ground track.
#[derive(Debug, Clone)]
pub enum GroundTrack {
    /// Trajectory of the scenario's chaser.
    Chaser(Box<Trajectory>),
    /// A circular orbit.
    Circular(CircularOrbit),
}

/// A circular orbit: at `epoch` the spacecraft is in the direction `radial` and moves along `ahead`.
#[derive(Debug, Clone)]
pub struct CircularOrbit {
    /// Time at which the spacecraft is in the direction `radial`.
    pub epoch: Epoch,
    /// Unit vector from the centre of the Earth to the spacecraft at `epoch`, ICRS axes.
    pub radial: Vector3<f64>,
    /// Unit vector of its motion at `epoch`, ICRS axes.
    pub ahead: Vector3<f64>,
    /// Radius, km.
    pub radius_km: f64,
    /// Mean motion, rad/s.
    pub rate_rad_s: f64,
}

impl GroundTrack {
    /// Returns the sub-satellite point and the subsolar point; `None` outside the time span of the Earth's
    /// ephemeris.
    pub fn ground_at(&self, time: Epoch) -> Option<Ground> {
        Some(Ground {
            spacecraft: point(time, &self.position_km(time)),
            sun: point(time, &sun_direction(time)?),
        })
    }

    /// Returns the ground track from 50 minutes before to 50 minutes after a time: longitude and latitude,
    /// degrees.
    pub fn path(&self, time: Epoch) -> Vec<[f64; 2]> {
        let steps = (REACH_S / STEP_S) as i32;
        (-steps..=steps)
            .map(|step| {
                let time = time + f64::from(step) * STEP_S * Unit::Second;
                point(time, &self.position_km(time))
            })
            .collect()
    }

    /// Returns the position relative to the centre of the Earth, km, ICRS axes; for a circular orbit only its
    /// direction is meaningful.
    pub fn position_km(&self, time: Epoch) -> Vector3<f64> {
        match self {
            Self::Chaser(trajectory) => trajectory.states_at(time).chaser.position_km,
            Self::Circular(orbit) => {
                let (sin, cos) = libm::sincos(orbit.rate_rad_s * (time - orbit.epoch).to_seconds());
                (orbit.radial * cos + orbit.ahead * sin) * orbit.radius_km
            }
        }
    }
}

/// Returns the unit vector from the centre of the Earth towards the Sun, ICRS axes; `None` outside the time
/// span of the Earth's ephemeris.
pub fn sun_direction(time: Epoch) -> Option<Vector3<f64>> {
    ephemeris::earth(clock::tdb_j2000_s(time)).map(|earth| earth.sun_geocentric_km().normalize())
}

fn point(time: Epoch, position_km: &Vector3<f64>) -> [f64; 2] {
    let (latitude, longitude) = geographic(time, position_km);
    [longitude.degrees(), latitude.degrees()]
}
