//! Slips of the programs that write orbits: changes of the states after which they move under gravity.

use nalgebra::Vector3;
use sim::truth::State;

/// Rate of the Earth's rotation, rad/s (IERS Conventions 2010).
const EARTH_RATE_RAD_S: f64 = 7.292_115e-5;

/// Speed below which a velocity counts as missing, km/s.
const MISSING_KM_S: f64 = 1e-9;

/// A slip that explains implausible states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Slip {
    /// The velocities have the wrong sign.
    Reversed,
    /// The velocities are in m/s.
    MetresPerSecond,
    /// The velocities are in thousands of km/s: m/s were divided by 1000 once too often.
    TooSmall,
    /// Position and velocity are relative to axes that rotate with the Earth.
    RotatingAxes,
    /// The velocities are relative to the rotating Earth, in inertial axes.
    RelativeToEarth,
    /// The components of the velocity are in another order: each index is that of the true component.
    Exchanged([usize; 3]),
}

impl Slip {
    const ALL: [Self; 10] = [
        Self::Reversed,
        Self::MetresPerSecond,
        Self::TooSmall,
        Self::RotatingAxes,
        Self::RelativeToEarth,
        Self::Exchanged([1, 0, 2]),
        Self::Exchanged([2, 1, 0]),
        Self::Exchanged([0, 2, 1]),
        Self::Exchanged([1, 2, 0]),
        Self::Exchanged([2, 0, 1]),
    ];

    /// Returns the slip whose repair makes states plausible by `is_plausible`, if there is one.
    pub(crate) fn find(
        states: &[(f64, State)],
        is_plausible: impl Fn(&[(f64, State)]) -> bool,
    ) -> Option<Self> {
        Self::ALL.into_iter().find(|slip| {
            let repaired = states.iter().map(|(time_s, state)| (*time_s, slip.repair(*time_s, state)));
            is_plausible(&repaired.collect::<Vec<_>>())
        })
    }

    /// Returns the state without the slip, in inertial axes; `time_s` is the time since those axes coincided
    /// with the rotating ones.
    fn repair(self, time_s: f64, state: &State) -> State {
        let State { position_km, velocity_km_s } = *state;
        let pole = Vector3::new(0.0, 0.0, EARTH_RATE_RAD_S);
        let with = |velocity_km_s| State { position_km, velocity_km_s };
        match self {
            Self::Reversed => with(-velocity_km_s),
            Self::MetresPerSecond => with(velocity_km_s * 1e-3),
            Self::TooSmall => with(velocity_km_s * 1e3),
            Self::RelativeToEarth => with(velocity_km_s + pole.cross(&position_km)),
            Self::RotatingAxes => {
                let turn =
                    nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), EARTH_RATE_RAD_S * time_s);
                State {
                    position_km: turn * position_km,
                    velocity_km_s: turn * (velocity_km_s + pole.cross(&position_km)),
                }
            }
            Self::Exchanged(indices) => {
                let component = |index: usize| velocity_km_s.get(index).copied().unwrap_or_default();
                with(indices.map(component).into())
            }
        }
    }

    /// Returns the words of a message.
    pub(crate) fn in_words(self) -> &'static str {
        match self {
            Self::Reversed => "the velocities have the wrong sign",
            Self::MetresPerSecond => "the velocities are in m/s; the unit is km/s",
            Self::TooSmall => "the velocities are 1000 times too small; the unit is km/s",
            Self::RotatingAxes => "the axes rotate with the Earth (ITRF), and the file states inertial axes",
            Self::RelativeToEarth => "the velocities are relative to the rotating Earth",
            Self::Exchanged(_) => "the components of the velocities are in another order",
        }
    }
}

/// Returns true for a velocity of zero.
pub(crate) fn is_missing(velocity_km_s: &Vector3<f64>) -> bool {
    velocity_km_s.norm() < MISSING_KM_S
}
