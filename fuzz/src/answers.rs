//! Fuzz target for output lines of an external pipeline.

use pipeline::external::{docking_protocol, protocol};

use crate::Sandbox;

/// Number of the requested frame, and the size of the detector.
const FRAME: u64 = 7;
const SIZE_PX: (usize, usize) = (752, 580);

pub(crate) fn answer(_: &Sandbox, bytes: &[u8]) {
    let _ = protocol::check_greeting(bytes);
    let _ = protocol::outcome(bytes, FRAME, SIZE_PX);
    let _ = docking_protocol::outcome(bytes, FRAME);
}
