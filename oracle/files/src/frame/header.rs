//! What is written about a frame besides its pixels.

use hifitime::Epoch;
use nalgebra::Vector3;

use crate::TanSip;

/// What is written about a frame besides its pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameHeader {
    /// Middle of the exposure.
    pub time: Epoch,
    /// Exposure time, s.
    pub exposure_s: f64,
    /// Gain of the converter, e⁻/DN, if known.
    pub gain_e_per_dn: Option<f64>,
    /// Seed of the scenario.
    pub seed: u64,
    /// Version of the simulator.
    pub version: String,
    /// Hash of the resolved configuration, hexadecimal.
    pub configuration_hash: String,
    /// Velocity of the observer about the solar system's barycentre, km/s, ICRS axes: the one that aberrates the
    /// stars. Not the geocentric velocity of `telemetry.csv`.
    pub observer_velocity_km_s: Option<Vector3<f64>>,
    /// World coordinates. Made from the true mapping they are truth, and a reader of the header can see them.
    pub wcs: Option<TanSip>,
}
