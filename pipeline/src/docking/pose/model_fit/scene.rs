//! What is fitted, and with what.

use contract::docking::TargetModel;

use super::sampled::Tables;
use crate::CameraModel;

/// A target seen by a camera.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    pub(super) camera: &'a CameraModel,
    pub(super) target: &'a TargetModel,
    pub(super) tables: &'a Tables,
}
