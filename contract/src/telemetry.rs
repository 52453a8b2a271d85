//! What the spacecraft tells about a frame.

use hifitime::Epoch;
use nalgebra::Vector3;

use crate::{Body, Icrs, Rotation};

/// What a pipeline may know about a frame besides its pixels. All of it is measured, none of it is truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Telemetry {
    /// Time tag: the middle of the exposure.
    pub time: Epoch,
    /// Exposure time, s.
    pub exposure_s: f64,
    /// Attitude of the chaser, as its attitude system tells (`q_sc_j2000`).
    pub body_from_icrs: Rotation<Body, Icrs>,
    /// Orbital velocity of the chaser about the Earth, km/s, along the axes of ICRS; `None` when it is not
    /// known. The Earth's own velocity is not in it: a pipeline adds the annual part.
    pub velocity_km_s: Option<Vector3<f64>>,
}
