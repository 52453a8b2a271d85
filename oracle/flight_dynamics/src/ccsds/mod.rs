//! Messages of CCSDS.

mod aem;
mod common;
mod covariance;
mod initial_state;
mod oem;
mod opm;
mod tdm;

pub use aem::{Aem, AemSegment, AttitudeDirection, AttitudeNode, BODY_FRAME, CAMERA_FRAME};
pub use common::Header;
pub use covariance::{Covariance, CovarianceFrame};
pub use initial_state::InitialState;
pub use oem::{Oem, OemSegment, StateNode};
pub use opm::{Manoeuvre, Opm, SpacecraftParameters};
pub use tdm::{Observation, Tdm, TdmSegment};
