//! Attitude of the chaser as a given function of time, for example from a file.

use std::fmt::Debug;
use std::sync::Arc;

use contract::{Body, Icrs, Rotation};
use hifitime::Epoch;

/// Attitude as a function of time.
pub trait AttitudeFunction: Debug + Send + Sync {
    /// Returns the attitude at `time`; outside the covered time that of the nearest end.
    fn body_from_icrs(&self, time: Epoch) -> Rotation<Body, Icrs>;
}

/// Shared attitude function. Two profiles are equal if they share it.
#[derive(Debug, Clone)]
pub struct AttitudeProfile(pub Arc<dyn AttitudeFunction>);

impl PartialEq for AttitudeProfile {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}
