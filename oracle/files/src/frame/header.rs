//! Header data of a frame file: metadata besides the pixels.

use hifitime::Epoch;
use nalgebra::Vector3;

use crate::TanSip;

/// Metadata that is written to a file in addition to a frame's pixels.
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
    /// Velocity of the observer relative to the barycentre of the solar system, km/s, ICRS axes, which
    /// determines stellar aberration. It differs from the geocentric velocity in `telemetry.csv`.
    pub observer_velocity_km_s: Option<Vector3<f64>>,
    /// World coordinates. Derived from the true mapping, they are ground truth and visible to every reader of
    /// the header.
    pub wcs: Option<TanSip>,
}

/// Statements of a FITS header about the sky in its image.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SkyHeader {
    /// Middle of the exposure.
    pub time: Option<Epoch>,
    /// Width of the field along the columns by world coordinates, degrees.
    pub field_deg: Option<f64>,
    /// Exposure time, s.
    pub exposure_s: Option<f64>,
}
