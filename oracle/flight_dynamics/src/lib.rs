//! Files of flight dynamics: CCSDS navigation messages, two-line elements and SPICE kernels.
//!
//! | file | read | written |
//! | --- | --- | --- |
//! | OEM 1.0 to 3.0 (CCSDS 502.0-B), KVN and XML | [`Oem::read`] | [`Oem::to_kvn`], [`Oem::to_xml`] |
//! | OPM 1.0 to 3.0 (CCSDS 502.0-B), KVN and XML | [`Opm::read`] | [`Opm::to_kvn`], [`Opm::to_xml`] |
//! | AEM 1.0 to 2.0 (CCSDS 504.0-B), KVN and XML | [`Aem::read`] | [`Aem::to_kvn`], [`Aem::to_xml`] |
//! | TDM 1.0 to 2.0 (CCSDS 503.0-B), KVN and XML | [`Tdm::read`] | [`Tdm::to_kvn`], [`Tdm::to_xml`] |
//! | two-line elements | [`Tle::read`] | |
//! | SPICE SPK, types 1, 2, 3, 8, 9, 12, 13, 21 | [`Spk::read`] | |
//!
//! The central body is the Earth. [`ReferenceFrame`] lists the frames, [`TimeSystem`] the time systems. A
//! [`FileError`](files::FileError) names file, line, field, value and the expected value. No input causes a
//! panic.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

mod ccsds;
mod coverage;
mod document;
mod ephemeris;
mod frame;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod interpolation;
mod physics;
mod spk;
mod time;
mod tle;

pub use ccsds::{
    Aem, AemSegment, AttitudeDirection, AttitudeNode, BODY_FRAME, CAMERA_FRAME, Covariance, CovarianceFrame,
    Header, InitialState, Manoeuvre, Observation, Oem, OemSegment, Opm, SpacecraftParameters, StateNode, Tdm,
    TdmSegment,
};
pub use coverage::{Coverage, Uncovered};
pub use document::Notation;
pub use ephemeris::{AttitudeEphemeris, OrbitEphemeris};
pub use frame::ReferenceFrame;
/// Instant of a state.
pub use hifitime::Epoch;
pub use interpolation::{Interpolation, Method};
pub use physics::check_samples;
pub use spk::Spk;
pub use time::TimeSystem;
pub use tle::Tle;
