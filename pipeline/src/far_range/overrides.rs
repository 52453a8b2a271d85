//! Interface for an error budget: given results of single steps that replace the pipeline's results.

use contract::{CameraFrame, Direction, Icrs, ListedStar, PixelPoint, Rotation};

/// Given results for the processing of one frame, which replace the pipeline's results; empty by default. The
/// pipeline has no access to the truth. The caller of [`super::FarRangePipeline::process_with`] is
/// responsible for the origin of these results, and an outcome obtained with any of them does not represent
/// the pipeline.
#[derive(Clone, Copy, Default)]
pub struct Overrides<'a> {
    /// Function that returns the centre to use in all later steps for a cluster, from its centre of
    /// brightness (Eq. 1); `None` leaves the centre unchanged.
    pub centroid: Option<&'a dyn Fn(PixelPoint) -> Option<PixelPoint>>,
    /// Function that returns the identity of the cluster with this centre. Replaces identification with the
    /// star list and the search for hotspots.
    pub identity: Option<&'a dyn Fn(PixelPoint) -> Identity>,
    /// Camera attitude for the prediction of stars (Eq. 4), tracking (Eq. 5) and the line of sight (Eq. 17).
    pub camera_from_icrs: Option<Rotation<CameraFrame, Icrs>>,
    /// Apparent direction of a listed star, including aberration, for Eq. 14. The attitude is then not
    /// corrected for aberration.
    pub apparent: Option<ApparentPlace<'a>>,
}

/// Function that returns the apparent direction of a listed star.
pub type ApparentPlace<'a> = &'a dyn Fn(&ListedStar) -> Direction<Icrs>;

/// Identity of a cluster.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Identity {
    /// Star with this number.
    Star(u32),
    /// Hotspot of the detector.
    Hotspot,
    /// Neither star nor hotspot: a candidate for the target.
    Neither,
}
