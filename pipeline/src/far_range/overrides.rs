//! The seam of an error budget: results of single steps, put in the place of the pipeline's own.

use contract::{CameraFrame, Direction, Icrs, ListedStar, PixelPoint, Rotation};

/// What one frame is processed with instead of the pipeline's own results; nothing by default. The pipeline has no truth
/// and asks for none: whoever calls [`super::FarRangePipeline::process_with`] answers for where these come from, and an answer made
/// with any of them is not the pipeline's own.
#[derive(Clone, Copy, Default)]
pub struct Overrides<'a> {
    /// The centre of the cluster whose brightness centre (Eq. 1) is told, for all later steps; `None` leaves it.
    pub centroid: Option<&'a dyn Fn(PixelPoint) -> Option<PixelPoint>>,
    /// What the cluster with this centre is, in the place of identification with the star list and of the search for
    /// hotspots.
    pub identity: Option<&'a dyn Fn(PixelPoint) -> Identity>,
    /// The camera's attitude, in the prediction of stars (Eq. 4), in tracking (Eq. 5) and in the line of sight (Eq. 17).
    pub camera_from_icrs: Option<Rotation<CameraFrame, Icrs>>,
    /// Where a listed star is seen, aberration included, in Eq. 14; the attitude is then not corrected for aberration.
    pub apparent: Option<ApparentPlace<'a>>,
}

/// Where a listed star is seen.
pub type ApparentPlace<'a> = &'a dyn Fn(&ListedStar) -> Direction<Icrs>;

/// What a cluster is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Identity {
    /// The star of this number.
    Star(u32),
    /// A hotspot of the detector.
    Hotspot,
    /// Neither: a candidate for the target.
    Neither,
}
