//! Best mode: attitude from the prior of telemetry and the stars, hypotheses for the target's cluster, and a
//! fit of the target's image with all knowledge of the camera (docs/evidence/best-mode.md).

mod config;
mod diagnosis;
mod faint_points;
mod frame_attitude;
mod hot_pixels;
mod hypotheses;
mod image_fit;
mod lost_in_space;
mod measurement;
mod mounting;
mod normal_equations;
mod photometry;
mod pipeline;
mod plate_solver;
mod point_image;
mod rescaling;
mod stars;
mod start;
mod state;
mod target;
mod track;
mod tracks;
mod unlisted_stars;

pub use config::{AttitudePrior, BestConfig};
pub use diagnosis::{
    InputMistake, Mounting, PixelOrder, QuaternionForm, QuaternionOrder, UnmatchedFrame, find_mistake,
};
pub use plate_solver::{PlateSolution, PlateSolver};
pub(super) use state::BestPipeline;
