//! Attitude of each frame and the focal length, by the patterns of the stars.

use contract::{Camera, CameraFrame, ContractError, Icrs, ListedStar, PixelPoint, Rotation};
use pipeline::far_range::PlateSolver;

use crate::sources::ImageSources;

/// Tolerance of the focal length in the other frames, after a first frame is solved. The error of one frame's
/// focal length is some parts in a thousand; unknown distortion adds as much.
const KNOWN_TOLERANCE: f64 = 0.01;

/// Attitude of a frame by its stars.
#[derive(Debug, Clone)]
pub struct FrameSolution {
    /// Attitude.
    pub camera_from_icrs: Rotation<CameraFrame, Icrs>,
    /// Focal length over the stated one.
    pub focal_ratio: f64,
    /// Sources, by their index, with their stars.
    pub matched: Vec<(usize, ListedStar)>,
}

/// Solves frames of one camera whose focal length is wrong by up to `tolerance`. The first frame that is
/// solved, in order of the number of sources, gives the focal length for all others. Returns `None` for each
/// frame without an attitude.
///
/// # Errors
/// Those of [`PlateSolver::new`].
pub fn solve_frames(
    frames: &[ImageSources],
    stars: &[ListedStar],
    camera: &Camera,
    tolerance: f64,
) -> Result<Vec<Option<FrameSolution>>, ContractError> {
    let mut order: Vec<usize> = (0..frames.len()).collect();
    order.sort_by_key(|&frame| std::cmp::Reverse(frames[frame].sources.len()));
    let mut solutions: Vec<Option<FrameSolution>> = vec![None; frames.len()];
    let mut solver = PlateSolver::new(stars, camera, tolerance)?;
    let mut known_ratio = 1.0;
    for frame in order {
        let Some(mut solution) = solve(&solver, &frames[frame]) else { continue };
        solution.focal_ratio *= known_ratio;
        if known_ratio == 1.0 && solution.focal_ratio != 1.0 {
            known_ratio = solution.focal_ratio;
            let scaled = Camera { focal_length_mm: camera.focal_length_mm * known_ratio, ..camera.clone() };
            solver = PlateSolver::new(stars, &scaled, KNOWN_TOLERANCE)?;
        }
        solutions[frame] = Some(solution);
    }
    Ok(solutions)
}

fn solve(solver: &PlateSolver, frame: &ImageSources) -> Option<FrameSolution> {
    let (mut indices, mut sources): (Vec<usize>, Vec<(PixelPoint, f64)>) = (Vec::new(), Vec::new());
    for (index, source) in frame.sources.iter().enumerate() {
        if !source.is_spike {
            indices.push(index);
            sources.push((source.position, source.significance));
        }
    }
    let found = solver.solve(&sources)?;
    Some(FrameSolution {
        camera_from_icrs: found.camera_from_icrs,
        focal_ratio: found.focal_ratio,
        matched: found.matched.into_iter().map(|(source, star)| (indices[source], star)).collect(),
    })
}
