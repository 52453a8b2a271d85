//! Epoch of the frames by the proper motions of their stars.

use hifitime::{Epoch, Unit};
use nalgebra::Vector3;
use sim::SimError;

use crate::adjustment::{AdjustedCamera, Adjustment, Observation, Term, displacement_share};
use crate::star_list::directions_of;

/// Days of a Julian year.
const YEAR_DAYS: f64 = 365.25;

/// Offset, in standard deviations, from which on the stated time is contradicted.
const CONTRADICTION_SIGMAS: f64 = 5.0;

/// Time of the frames by the proper motions of their stars, minus the stated one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EpochOffset {
    /// Difference, years.
    pub years: f64,
    /// Its standard deviation, years.
    pub sigma_years: f64,
}

impl EpochOffset {
    /// Returns true if the stars contradict the stated time.
    pub fn is_contradiction(&self) -> bool {
        self.years.abs() > CONTRADICTION_SIGMAS * self.sigma_years
    }
}

/// Returns the epoch by the proper motions: the share of a year's motion in the residuals, with camera and
/// attitudes adjusted at the same time.
///
/// A year later the Earth has the same velocity, so that aberration, which camera and attitudes absorb in
/// part, does not take part.
///
/// # Errors
/// [`SimError`] for a time outside the ephemerides.
pub(crate) fn epoch_offset(
    camera: &AdjustedCamera,
    adjustment: &Adjustment,
    observations: &[Observation],
    time: Epoch,
) -> Result<Option<EpochOffset>, SimError> {
    let stars: Vec<u32> = observations.iter().map(|observation| observation.star).collect();
    let (now, later) = (directions_of(&stars, time)?, directions_of(&stars, time + Unit::Day * YEAR_DAYS)?);
    let moved: Vec<Vector3<f64>> = observations
        .iter()
        .zip(now.iter().zip(&later))
        .map(|(observation, (now, later))| observation.direction + (later - now))
        .collect();
    let share = displacement_share(camera, &Term::ALL, adjustment, observations, &moved);
    Ok(share.map(|[years, sigma_years]| EpochOffset { years, sigma_years }))
}
