//! The unknowns of the fit, and their order: globals, common to the field, and the levels of each patch.

use nalgebra::{SMatrix, SVector};

/// Pose, blur x and y, the share of it on pixels, brightness of the side faces towards +y1, −y1, +y2, −y2.
pub(super) const GLOBALS: usize = 13;
/// The first globals are the pose.
pub(super) const POSE: usize = 6;
/// After it the variance along columns, then along rows.
pub(super) const BLUR: usize = 6;
/// The share of the blur that acts on pixels.
pub(super) const GRID: usize = 8;
/// After it the side faces.
pub(super) const SIDES: usize = 9;

/// Derivatives with respect to the globals.
pub(super) type ByGlobals = [f64; GLOBALS];

pub(super) type Globals = SVector<f64, GLOBALS>;
pub(super) type GlobalMatrix = SMatrix<f64, GLOBALS, GLOBALS>;

/// Levels of a patch: plate (constant and slope), what lies beyond the rim, feature over plate.
pub(super) const LOCALS: usize = 5;
