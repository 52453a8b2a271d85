//! Pose of a field (docking paper, 3.1): by the paper's formulas, and by the pipeline's best estimator.

pub mod geometry;
pub mod model_fit;
pub mod paper_pose;
pub(super) mod paper_sigma;
