//! Attitude of a single image of stars, without a pipeline around it.

use contract::{Camera, CameraFrame, ContractError, Icrs, ListedStar, PixelPoint, Rotation};

use super::lost_in_space::LostInSpace;
use crate::CameraModel;

/// Solver for images of one camera: attitude without a prior, and the focal length within a tolerance.
#[derive(Debug)]
pub struct PlateSolver(LostInSpace);

/// Attitude of an image by its stars.
#[derive(Debug, Clone)]
pub struct PlateSolution {
    /// Attitude.
    pub camera_from_icrs: Rotation<CameraFrame, Icrs>,
    /// Focal length over that of the camera; 1 if the stars do not contradict it.
    pub focal_ratio: f64,
    /// Radial distortion k1 in addition to that of the camera, px⁻²; 0 unless the solver was created for an
    /// unknown one.
    pub added_radial: f64,
    /// Sources, by their index in the argument, with their stars: at least four, each source and each star
    /// once.
    pub matched: Vec<(usize, ListedStar)>,
}

impl PlateSolver {
    /// Creates a solver with a star list. The focal length of `camera` may be wrong by the share
    /// `focal_length_tolerance`, 0 to 0.2.
    ///
    /// # Errors
    /// The errors of [`Camera::check`].
    pub fn new(
        stars: &[ListedStar],
        camera: &Camera,
        focal_length_tolerance: f64,
    ) -> Result<Self, ContractError> {
        let model = CameraModel::new(camera)?;
        Ok(Self(LostInSpace::new(stars, &model, f64::INFINITY, focal_length_tolerance.clamp(0.0, 0.2))))
    }

    /// Returns the solver for images with an unknown radial distortion, which moves a point at half the
    /// diagonal by up to the share `bound` of its distance from the centre, 0 to 0.1. The focal length must
    /// have a tolerance. Images without an attitude take three times as long.
    #[must_use]
    pub fn with_unknown_distortion(self, bound: f64) -> Self {
        Self(self.0.with_unknown_distortion(bound.clamp(0.0, 0.1)))
    }

    /// Returns the attitude determined by the sources of an image, each a position in px and a flux in any
    /// unit; `None` when none reaches the odds at which a false one has a probability of 10⁻⁶ in an image
    /// without stars.
    pub fn solve(&self, sources: &[(PixelPoint, f64)]) -> Option<PlateSolution> {
        let found = self.0.solve(sources)?;
        Some(PlateSolution {
            camera_from_icrs: found.camera_from_icrs,
            focal_ratio: found.focal_ratio,
            added_radial: found.added_radial,
            matched: found.matched,
        })
    }
}
