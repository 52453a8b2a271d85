//! Frames of more than one camera in a folder.
//!
//! Each frame is adjusted alone, which gives a camera with its covariance. Two frames contradict each other
//! if their cameras differ by more than the errors (χ² of the terms) and by more than a pixel in the image.
//! The largest group of frames that agree with one of them is that of the camera.

use contract::Camera;
use nalgebra::{SMatrix, SVector};

use crate::adjustment::{AdjustedCamera, TERMS, Term};
use crate::fit::first_with;
use crate::rounds::{SolvedFrames, adjust_in_rounds};
use crate::solution::FrameSolution;
use crate::sources::ImageSources;
use crate::star_list::SkyList;

/// χ² of the eight terms of two cameras above which they differ. Normal errors exceed 42 once in a million;
/// the errors of a frame with few stars are known to a factor of some 1.4.
const MAX_CHI2: f64 = 80.0;

/// Radial difference in the image above which two cameras differ, px.
const MAX_DIFFERENCE_PX: f64 = 1.0;

/// Frame that contradicts the camera of the others.
pub(crate) struct Contradiction {
    pub(crate) frame: usize,
    /// Focal length by the frame alone with its standard deviation, mm.
    focal_mm: [f64; 2],
    /// Largest radial difference from the camera of the others, px.
    difference_px: f64,
}

impl Contradiction {
    /// Returns the reason for which the frame is left out.
    pub(crate) fn reason(&self, camera: &Camera) -> String {
        let [focal_mm, sigma_mm] = self.focal_mm;
        format!(
            "its stars do not fit the camera of the other frames: its own focal length is {focal_mm:.4} ± \
             {sigma_mm:.4} mm, that of the camera {:.4} mm, and positions differ by up to {:.1} px",
            camera.focal_length_mm, self.difference_px
        )
    }
}

/// Camera of a frame alone.
struct OwnCamera {
    frame: usize,
    stars: usize,
    camera: Camera,
    /// Half of the diagonal of the detector, px.
    half_diagonal_px: f64,
    covariance: SMatrix<f64, TERMS, TERMS>,
}

/// Returns the frames of one camera, by their index, and those that contradict it. A frame with too few stars
/// for a camera of its own contradicts none.
pub(crate) fn group_of_one_camera(
    solutions: &[Option<FrameSolution>],
    first: &Camera,
    sources: &[ImageSources],
    list: &SkyList,
) -> (Vec<usize>, Vec<Contradiction>) {
    let solved: Vec<usize> = (0..solutions.len()).filter(|&frame| solutions[frame].is_some()).collect();
    if solved.len() < 2 {
        return (solved, Vec::new());
    }
    let mut own = Vec::new();
    for (frame, solution) in solutions.iter().enumerate() {
        let Some(solution) = solution else { continue };
        own.extend(OwnCamera::new(frame, solution, first, sources, list));
    }
    // The camera with which most frames agree; among equals, that of most stars.
    let agreeing = |camera: &OwnCamera| own.iter().filter(|other| camera.agrees_with(other)).count();
    let Some(reference) = own.iter().max_by_key(|camera| (agreeing(camera), camera.stars)) else {
        return (solved, Vec::new());
    };
    let mut contradictions = Vec::new();
    for camera in own.iter().filter(|camera| !camera.agrees_with(reference)) {
        contradictions.push(Contradiction {
            frame: camera.frame,
            focal_mm: [
                camera.camera.focal_length_mm,
                camera.covariance[(0, 0)].sqrt() * camera.camera.focal_length_mm,
            ],
            difference_px: camera.difference_px(reference),
        });
    }
    let is_member = |frame: &usize| contradictions.iter().all(|other| other.frame != *frame);
    (solved.into_iter().filter(is_member).collect(), contradictions)
}

impl OwnCamera {
    /// Adjusts a camera to a single frame; `None` if its stars are too few.
    fn new(
        frame: usize,
        solution: &FrameSolution,
        first: &Camera,
        sources: &[ImageSources],
        list: &SkyList,
    ) -> Option<Self> {
        let about = AdjustedCamera::new(&first_with(first, solution.focal_ratio, solution.added_radial));
        let mut solved = SolvedFrames::new(&[(frame, solution)]);
        let rounds = adjust_in_rounds(&about, &mut solved, sources, list, false).ok()?;
        Some(Self {
            frame,
            stars: rounds.adjustment.residuals.len(),
            half_diagonal_px: 0.5 * libm::hypot(first.columns as f64, first.rows as f64),
            covariance: SMatrix::from_fn(|i, j| rounds.adjustment.covariance[i][j]),
            camera: rounds.fitted,
        })
    }

    /// Returns the terms of the camera, in units of the adjustment.
    fn terms(&self) -> SVector<f64, TERMS> {
        let h = self.half_diagonal_px;
        let camera = &self.camera;
        let [k1, k2, k3] = camera.radial;
        let [p1, p2] = camera.tangential;
        SVector::from([
            libm::log(camera.focal_length_mm),
            camera.principal_x_px / h,
            camera.principal_y_px / h,
            k1 * h * h,
            k2 * libm::pow(h, 4.0),
            k3 * libm::pow(h, 6.0),
            p1 * h,
            p2 * h,
        ])
    }

    fn agrees_with(&self, other: &Self) -> bool {
        if self.frame == other.frame || self.difference_px(other) <= MAX_DIFFERENCE_PX {
            return true;
        }
        let difference = self.terms() - other.terms();
        let inverse = (self.covariance + other.covariance).try_inverse();
        inverse.is_none_or(|inverse| difference.dot(&(inverse * difference)) <= MAX_CHI2)
    }

    /// Returns the largest radial difference of two cameras up to half of the diagonal, px.
    fn difference_px(&self, other: &Self) -> f64 {
        let difference = self.terms() - other.terms();
        let term = |term: Term| difference[term as usize];
        let mut largest: f64 = 0.0;
        for quarter in 1..=4 {
            let r = 0.25 * f64::from(quarter);
            let r2 = r * r;
            let radial = term(Term::Radial1) + r2 * (term(Term::Radial2) + r2 * term(Term::Radial3));
            largest = largest.max((r * (term(Term::FocalLength) + r2 * radial)).abs());
        }
        largest * self.half_diagonal_px
    }
}
