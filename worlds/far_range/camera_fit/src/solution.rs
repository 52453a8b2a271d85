//! Attitude of each frame and the focal length, by the patterns of the stars.

use contract::{Camera, CameraFrame, ContractError, Icrs, ListedStar, PixelPoint, Rotation};
use pipeline::far_range::PlateSolver;

use crate::fit::first_with;
use crate::sources::ImageSources;

/// Tolerance of the focal length in the other frames, after a first frame is solved. The error of one frame's
/// focal length is some parts in a thousand; unknown distortion adds as much.
const KNOWN_TOLERANCE: f64 = 0.01;

/// Largest share by which an unknown radial distortion moves a point at half the diagonal of the detector.
pub const DISTORTION_BOUND: f64 = 0.08;

/// Largest number of frames, those with the most sources, in which a distortion is looked for.
const DISTORTED_FRAMES: usize = 3;

/// Attitude of a frame by its stars.
#[derive(Debug, Clone)]
pub struct FrameSolution {
    /// Attitude.
    pub camera_from_icrs: Rotation<CameraFrame, Icrs>,
    /// Focal length over the stated one.
    pub focal_ratio: f64,
    /// Radial distortion k1 in addition to that of the stated camera, px⁻².
    pub added_radial: f64,
}

/// Solves frames of one camera whose focal length is wrong by up to `tolerance`. The first frame that is
/// solved, in order of the number of sources, gives the focal length for all others; those that are not
/// solved with it are tried as the first, because they may be of another camera. Returns `None` for each
/// frame without an attitude, and for frames with trails.
///
/// # Errors
/// Those of [`PlateSolver::new`].
pub fn solve_frames(
    frames: &[ImageSources],
    stars: &[ListedStar],
    camera: &Camera,
    tolerance: f64,
) -> Result<Vec<Option<FrameSolution>>, ContractError> {
    let mut order: Vec<usize> =
        (0..frames.len()).filter(|&frame| frames[frame].trail_deg().is_none()).collect();
    order.sort_by_key(|&frame| std::cmp::Reverse(frames[frame].sources.len()));
    let wide = PlateSolver::new(stars, camera, tolerance)?;
    let mut solutions: Vec<Option<FrameSolution>> = vec![None; frames.len()];
    let mut known: Option<KnownCamera> = None;
    for &frame in &order {
        let of_known = known.as_ref().and_then(|known| known.solve(&frames[frame]));
        solutions[frame] = of_known.or_else(|| solve(&wide, &frames[frame]));
        if known.is_none()
            && let Some(solution) = &solutions[frame]
        {
            known = Some(KnownCamera::new(stars, camera, solution)?);
        }
    }
    if known.is_some() || tolerance == 0.0 {
        return Ok(solutions);
    }
    // A distortion that the solver does not expect takes longer: it is looked for in the frames with the most
    // sources, and then known for all.
    let distorted = wide.with_unknown_distortion(DISTORTION_BOUND);
    let found = order.iter().take(DISTORTED_FRAMES).find_map(|&frame| solve(&distorted, &frames[frame]));
    if let Some(solution) = found {
        let known = KnownCamera::new(stars, camera, &solution)?;
        for &frame in &order {
            solutions[frame] = known.solve(&frames[frame]);
        }
    }
    Ok(solutions)
}

/// Solver for the camera of a frame that was solved.
struct KnownCamera {
    solver: PlateSolver,
    focal_ratio: f64,
    added_radial: f64,
}

impl KnownCamera {
    fn new(stars: &[ListedStar], camera: &Camera, solution: &FrameSolution) -> Result<Self, ContractError> {
        let &FrameSolution { focal_ratio, added_radial, .. } = solution;
        let solver =
            PlateSolver::new(stars, &first_with(camera, focal_ratio, added_radial), KNOWN_TOLERANCE)?;
        Ok(Self { solver, focal_ratio, added_radial })
    }

    fn solve(&self, frame: &ImageSources) -> Option<FrameSolution> {
        let found = solve(&self.solver, frame)?;
        Some(FrameSolution {
            focal_ratio: found.focal_ratio * self.focal_ratio,
            added_radial: found.added_radial + self.added_radial,
            ..found
        })
    }
}

fn solve(solver: &PlateSolver, frame: &ImageSources) -> Option<FrameSolution> {
    let found = solver.solve(&star_like_sources(frame))?;
    Some(FrameSolution {
        camera_from_icrs: found.camera_from_icrs,
        focal_ratio: found.focal_ratio,
        added_radial: found.added_radial,
    })
}

/// Returns positions and significances of the sources that are no spikes.
pub(crate) fn star_like_sources(frame: &ImageSources) -> Vec<(PixelPoint, f64)> {
    let star_like = frame.sources.iter().filter(|source| !source.is_spike);
    star_like.map(|source| (source.position, source.significance)).collect()
}
