//! Camera from frames of the night sky.
//!
//! The steps, each a module:
//!
//! 1. [`sources`]: stars and hot pixels of each image, with positions and their errors.
//! 2. [`solution`]: attitude of each frame and the focal length, by the patterns of the stars.
//! 3. `mixture`: frames of another camera are left out. Images that are mirrored or negative, or have swapped
//!    bytes, are recognised where no frame has an attitude (`reading`).
//! 4. [`adjustment`]: all frames together, by least squares: focal length, principal point, distortion, and
//!    the attitude of each frame, with the covariance of every figure.
//! 5. `stars`: width and brightness of the stars.
//!
//! [`fit_camera`] is these steps in order. The star list has apparent places for the time of the frames, seen
//! from the centre of the Earth: proper motion, parallax, light deflection and aberration by the Earth's
//! motion around the Sun. The motion of a spacecraft around the Earth (5″) is a common shift, which the
//! attitudes absorb, and a change of scale of 2.5 · 10⁻⁵.

pub mod adjustment;
mod background;
mod epoch;
mod fit;
mod left_out;
mod mixture;
mod reading;
mod rounds;
pub mod solution;
pub mod sources;
mod star_list;
mod stars;

pub use background::{Background, clipped};
pub use epoch::EpochOffset;
pub use fit::{
    CameraFit, FirstGuess, FitError, FittedFrame, MatchedStar, SkyFrame, UnsolvedFrame, fit_camera,
    saturation_dn,
};
pub use reading::Reading;
pub use sources::FLUX_REACH_PX;
pub use stars::photometry::Photometry;
pub use stars::profile::{ProfileKind, StarProfile};
