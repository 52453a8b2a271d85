//! Telemetry of a far-range frame.

use hifitime::Epoch;
use nalgebra::Vector3;

use crate::{Body, Icrs, Rotation};

/// Data that a pipeline receives with a frame besides its pixels. All values are measured, not truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Telemetry {
    /// Time tag: the middle of the exposure.
    pub time: Epoch,
    /// Exposure time, s.
    pub exposure_s: f64,
    /// Attitude of the chaser, as reported by its attitude system (`q_sc_j2000`).
    pub body_from_icrs: Rotation<Body, Icrs>,
    /// Orbital velocity of the chaser about the Earth, km/s, along the ICRS axes; `None` if unknown. It
    /// excludes the Earth's own velocity: a pipeline adds the annual part.
    pub velocity_km_s: Option<Vector3<f64>>,
}
