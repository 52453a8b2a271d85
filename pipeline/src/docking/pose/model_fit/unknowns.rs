//! Unknowns of the fit, and their order: globals, common to the field, and the levels of each patch.

use nalgebra::{SMatrix, SVector};

/// Number of globals: pose, blur x and y, the share of blur on pixels, brightness of the side faces towards
/// +y1, −y1, +y2, −y2.
pub(super) const GLOBALS: usize = 13;
/// Number of globals of the pose, which come first.
pub(super) const POSE: usize = 6;
/// Index of the blur's variance along columns; the variance along rows follows.
pub(super) const BLUR: usize = 6;
/// Index of the share of the blur that acts on pixels.
pub(super) const GRID: usize = 8;
/// Index of the first of the side faces.
pub(super) const SIDES: usize = 9;

/// Derivatives with respect to the globals.
pub(super) type ByGlobals = [f64; GLOBALS];

pub(super) type Globals = SVector<f64, GLOBALS>;
pub(super) type GlobalMatrix = SMatrix<f64, GLOBALS, GLOBALS>;

/// Number of levels of a patch: plate (constant and slope), area beyond the rim, feature over plate.
pub(super) const LOCALS: usize = 5;
