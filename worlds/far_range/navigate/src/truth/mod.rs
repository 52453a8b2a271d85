//! True relative orbit.

pub(crate) mod target_orbit;

use contract::navigation::RelativeElements;
use far_range::{FarRangeScenario, TrajectoryConfig};
use files::Failure;
use hifitime::Epoch;
use nalgebra::{Vector3, Vector6};
use navigation::Osculation;
use navigation::orbit::State;
use navigation::relative::between;
use sim::truth::{Trajectory, clock};

/// True relative orbit of a run.
#[derive(Debug, Clone)]
pub(crate) struct Truth {
    trajectory: Trajectory,
    osculation: Osculation,
}

impl Truth {
    pub(crate) fn new(scenario: &FarRangeScenario) -> Result<Self, Failure> {
        let osculation = match scenario.trajectory {
            TrajectoryConfig::MeanElements {} => Osculation::None,
            _ => Osculation::FirstOrder,
        };
        Ok(Self { trajectory: scenario.trajectory()?, osculation })
    }

    pub(crate) fn trajectory(&self) -> &Trajectory {
        &self.trajectory
    }

    /// Relation of mean elements and states in the simulator's trajectory.
    pub(crate) fn osculation(&self) -> Osculation {
        self.osculation
    }

    /// Returns true if the orbits are mean elements: the navigator's dynamics are then exact.
    pub(crate) fn has_mean_elements(&self) -> bool {
        self.osculation == Osculation::None
    }

    /// Returns position, m, and velocity in the rotating frame, m/s, of the chaser in the target's R, T, N.
    pub(crate) fn state(&self, time: Epoch) -> Vector6<f64> {
        let states = self.trajectory.states_at(time);
        relative_state(&states.chaser, &states.target)
    }

    /// Returns the mean relative elements: those of the trajectory if it has mean elements, otherwise those
    /// of the true states without their short-period variations of first order in J2.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a state without supported elements.
    pub(crate) fn elements(&self, time: Epoch) -> Result<RelativeElements, Failure> {
        let unsupported =
            || Failure::Usage(format!("the true orbits have no elements at {}", clock::format_utc(time)));
        if self.has_mean_elements() {
            let sim::truth::RelativeElements { a_da_m, a_dlambda_m, a_dex_m, a_dey_m, a_dix_m, a_diy_m } =
                self.trajectory.relative_elements(time).ok_or_else(unsupported)?;
            return Ok(RelativeElements { a_da_m, a_dlambda_m, a_dex_m, a_dey_m, a_dix_m, a_diy_m });
        }
        let states = self.trajectory.states_at(time);
        let mean = |state: sim::truth::State| {
            let sim::truth::State { position_km, velocity_km_s } = state;
            self.osculation.mean(&State { position_km, velocity_km_s }).ok_or_else(unsupported)
        };
        Ok(between(&mean(states.chaser)?, &mean(states.target)?))
    }
}

/// Returns position, m, and velocity in the rotating frame, m/s, of the chaser in the target's R, T, N.
pub(crate) fn relative_state(chaser: &sim::truth::State, target: &sim::truth::State) -> Vector6<f64> {
    let rtn_from_icrs = target.rtn_from_icrs();
    let position: Vector3<f64> = rtn_from_icrs.rotate(&(chaser.position_km - target.position_km)) * 1000.0;
    let inertial = rtn_from_icrs.rotate(&(chaser.velocity_km_s - target.velocity_km_s)) * 1000.0;
    let velocity = inertial - rotation_rate(target).cross(&position);
    Vector6::new(position.x, position.y, position.z, velocity.x, velocity.y, velocity.z)
}

/// Returns the angular velocity of the R, T, N axes of a state about themselves, rad/s.
pub(crate) fn rotation_rate(state: &sim::truth::State) -> Vector3<f64> {
    let (r, v) = (&state.position_km, &state.velocity_km_s);
    Vector3::new(0.0, 0.0, r.cross(v).norm() / r.norm_squared())
}
