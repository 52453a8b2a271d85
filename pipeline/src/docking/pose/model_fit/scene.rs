//! Inputs of the fit.

use contract::docking::TargetModel;

use super::sampled::Tables;
use crate::CameraModel;

/// Target seen by a camera.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    pub(super) camera: &'a CameraModel,
    pub(super) target: &'a TargetModel,
    pub(super) tables: &'a Tables,
}
