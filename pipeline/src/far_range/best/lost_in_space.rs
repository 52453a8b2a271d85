//! Attitude of a frame without a prior: lost in space.
//!
//! Triangles of bright sources are looked up in a list of star pairs by their separations, in the order of
//! the Pyramid algorithm, and mirrored triangles are refused (Mortari, Samaan, Bruccoleri & Junkins 2004, The
//! Pyramid Star Identification Technique, Navigation 51, 171). Each triangle found gives an attitude with a
//! covariance. Instead of Pyramid's fourth star, all other sources decide: by the odds that they are the
//! stars predicted by that attitude, against sources anywhere in the image (Lang, Hogg, Mierle, Blanton &
//! Roweis 2010, AJ 139, 1782, section 2.3).
//!
//! Brightness is used only to order sources and stars: neither zero point nor exposure is needed. The focal
//! length may be wrong by a stated tolerance: it is then found with the attitude.

mod free_focal_length;
mod hypothesis;
mod selection;
mod separations;
mod source;
#[cfg(test)]
pub(super) mod tests;
mod triangles;

use contract::{CameraFrame, Icrs, ListedStar, PixelPoint, Rotation};
use nalgebra::Matrix3;

use crate::CameraModel;
use crate::far_range::identify::StarList;
use hypothesis::{Hypothesis, Lens, Match, ShiftPrior};
use selection::{brightest_of_each_field, largest_chord};
use separations::{Neighbours, StarPairs};
use source::ImageSource;
use triangles::{TriangleSearch, pyramid_order};

/// Solver for the frames of one camera with one star list. Has no state from frames.
#[derive(Debug)]
pub(super) struct LostInSpace {
    model: CameraModel,
    /// Largest relative error of the model's focal length.
    focal_length_tolerance: f64,
    /// Largest share by which an unknown radial distortion moves a point at half the diagonal; 0 if the
    /// distortion is known.
    corner_shift_bound: f64,
    /// Brightest stars of each field.
    stars: Vec<ListedStar>,
    list: StarList,
    pairs: StarPairs,
    /// Neighbours of each star; none with a known focal length.
    neighbours: Neighbours,
}

/// Attitude found without a prior.
#[derive(Debug, Clone)]
pub(super) struct FoundAttitude {
    pub(super) camera_from_icrs: Rotation<CameraFrame, Icrs>,
    /// Covariance of the attitude's error, a small rotation about the camera's axes, rad², for sources with
    /// an error of 0.4 px along an axis. The rotation about the boresight is the least accurate.
    pub(super) covariance: Matrix3<f64>,
    /// Focal length over the stated one: 1, unless the stars contradict it.
    pub(super) focal_ratio: f64,
    /// Standard deviation of the natural logarithm of `focal_ratio`; 0 for the stated focal length.
    pub(super) focal_sigma: f64,
    /// Radial distortion k1 in addition to the stated one, px⁻²; 0 if that is known.
    pub(super) added_radial: f64,
    /// Sources, by their index in the argument, with their stars: at least four, each source and each star
    /// once.
    pub(super) matched: Vec<(usize, ListedStar)>,
}

/// Largest number of sources compared with predicted stars, brightest first.
const MAX_SOURCES: usize = 40;

/// Largest number of sources used for triangles, brightest first.
const MAX_TRIANGLE_SOURCES: usize = 25;

/// Number of star pairs visited in a frame after which the search ends without an attitude. Bounds the search
/// time.
const MAX_VISITED_PAIRS: usize = 3_000_000;

/// Number of attitudes tested in a frame after which the search ends without an attitude.
const MAX_TESTED: usize = 1000;

/// Natural logarithm of the smallest odds of an attitude, without a prior: 10⁹, as in Lang et al.
///
/// Odds are a ratio of likelihoods, so randomly scattered sources reach 10⁹ with a probability of at most
/// 10⁻⁹ in a test of one attitude. [`MAX_TESTED`] attitudes are tested per frame, and none on the triangle
/// that produced it: a false attitude has a probability of at most 10⁻⁶ in a frame without stars.
const MIN_LOG_ODDS: f64 = 20.7;

/// Largest number of rounds of solving and matching until the matches of an accepted attitude are stable;
/// four are usual.
const MAX_REFINEMENTS: usize = 20;

/// Smallest number of stars of a final attitude, including the three of the triangle.
pub(super) const MIN_MATCHED: usize = 4;

/// Smallest number of stars of a final attitude with a free focal length: ten coordinates for four unknowns.
const MIN_MATCHED_WITH_FREE_FOCAL_LENGTH: usize = 5;

/// The same with a free distortion: twelve coordinates for five unknowns.
const MIN_MATCHED_WITH_FREE_LENS: usize = 6;

/// Largest error, in standard deviations, of a focal length that counts as the stated one.
const STATED_SIGMAS: f64 = 4.0;

impl LostInSpace {
    /// Creates a solver with the stars of `stars` up to the V magnitude `max_magnitude`, limited to the
    /// brightest of each field of the camera. The focal length of `model` may be wrong by the share
    /// `focal_length_tolerance`, 0 to 0.2.
    pub(super) fn new(
        stars: &[ListedStar],
        model: &CameraModel,
        max_magnitude: f64,
        focal_length_tolerance: f64,
    ) -> Self {
        let stars = brightest_of_each_field(stars, model, max_magnitude);
        let widest = model.with_focal_ratio(1.0 - focal_length_tolerance);
        let pairs = StarPairs::new(&stars, largest_chord(&widest));
        let neighbours = match focal_length_tolerance {
            0.0 => Neighbours::default(),
            _ => Neighbours::new(&pairs, stars.len()),
        };
        Self {
            list: StarList::new(&stars, f64::INFINITY, &widest),
            pairs,
            neighbours,
            model: model.clone(),
            focal_length_tolerance,
            corner_shift_bound: 0.0,
            stars,
        }
    }

    /// Returns the solver for a radial distortion that differs from the stated one by up to `bound` of the
    /// distance from the centre at half the diagonal, 0 to 0.1. The focal length must have a tolerance.
    pub(super) fn with_unknown_distortion(self, bound: f64) -> Self {
        Self { corner_shift_bound: bound, ..self }
    }

    /// Returns the attitude determined by the sources of a frame, each a position in px and a flux in any
    /// unit, and the focal length where it is not the stated one. Returns `None` when no attitude reaches
    /// odds of 10⁹. Sources that are not finite or that the camera cannot see are ignored.
    pub(super) fn solve(&self, sources: &[(PixelPoint, f64)]) -> Option<FoundAttitude> {
        let sources = self.brightest(sources);
        if self.focal_length_tolerance == 0.0 {
            return self.solve_with_known_focal_length(&sources);
        }
        let found = self.solve_with_free_focal_length(&sources)?;
        let is_other = libm::log(found.focal_ratio).abs() > STATED_SIGMAS * found.focal_sigma;
        if is_other || self.corner_shift_bound > 0.0 {
            return Some(found);
        }
        // The stars confirm the stated focal length, which is then better known than by them.
        self.refined(&sources, found.matches(&sources), FocalLength::Stated).or(Some(found))
    }

    /// Returns the attitude determined by sources at the stated focal length.
    fn solve_with_known_focal_length(&self, sources: &[ImageSource]) -> Option<FoundAttitude> {
        let mut search = TriangleSearch::new(&self.stars, &self.pairs, &self.model);
        let mut tested = 0;
        for corners in pyramid_order(sources.len().min(MAX_TRIANGLE_SOURCES)) {
            let corners = corners.map(|corner| sources[corner]);
            for stars in search.matching_triples(corners.map(|corner| corner.direction)) {
                let triangle: Vec<Match> = corners
                    .into_iter()
                    .zip(stars)
                    .map(|(source, star)| Match { source, star: self.stars[star as usize] })
                    .collect();
                tested += 1;
                if let Some(found) = self.test(sources, &triangle) {
                    return Some(found);
                }
            }
            if tested >= MAX_TESTED || search.visited() >= MAX_VISITED_PAIRS {
                break;
            }
        }
        None
    }

    /// Returns the brightest sources that have a direction, in order of flux.
    fn brightest(&self, sources: &[(PixelPoint, f64)]) -> Vec<ImageSource> {
        let mut order: Vec<usize> = (0..sources.len())
            .filter(|&i| {
                let (position, flux) = sources[i];
                position.x.is_finite() && position.y.is_finite() && flux.is_finite()
            })
            .collect();
        order.sort_by(|&a, &b| sources[b].1.total_cmp(&sources[a].1).then(a.cmp(&b)));
        order
            .into_iter()
            .filter_map(|index| {
                let position = sources[index].0;
                let direction = self.model.back_project(position)?;
                Some(ImageSource { index, position, direction })
            })
            .take(MAX_SOURCES)
            .collect()
    }

    /// Returns the attitude of a triangle, refined with all its stars, if the other sources support it with
    /// the smallest odds or more.
    fn test(&self, sources: &[ImageSource], triangle: &[Match]) -> Option<FoundAttitude> {
        let hypothesis = Hypothesis::with_known_focal_length(triangle, &self.model)?;
        let support = hypothesis.support(sources, triangle, &self.list);
        if support.log_odds < MIN_LOG_ODDS {
            return None;
        }
        self.refined(sources, support.matched, FocalLength::Stated)
    }

    /// Solves the matched sources and matches all sources anew, until the matches are stable. `None` if they
    /// do not become so, are too few, or the focal length is outside the tolerance.
    fn refined(
        &self,
        sources: &[ImageSource],
        mut matched: Vec<Match>,
        mut focal_length: FocalLength,
    ) -> Option<FoundAttitude> {
        let fewest = match focal_length {
            FocalLength::Stated => MIN_MATCHED,
            FocalLength::Free { .. } => MIN_MATCHED_WITH_FREE_FOCAL_LENGTH,
            FocalLength::FreeLens { .. } => MIN_MATCHED_WITH_FREE_LENS,
        };
        for _ in 0..MAX_REFINEMENTS {
            let hypothesis = match focal_length {
                FocalLength::Stated => Hypothesis::with_known_focal_length(&matched, &self.model)?,
                FocalLength::Free { ratio } => {
                    Hypothesis::with_free_focal_length(&matched, &self.model, ratio)?
                }
                FocalLength::FreeLens { lens, prior } => {
                    Hypothesis::with_free_lens(&matched, &self.model, lens, prior)?
                }
            };
            match &mut focal_length {
                FocalLength::Stated => {}
                FocalLength::Free { ratio } => *ratio = hypothesis.lens.focal_ratio,
                FocalLength::FreeLens { lens, .. } => *lens = hypothesis.lens,
            }
            let next = hypothesis.support(sources, &[], &self.list).matched;
            let is_settled = are_same(&next, &matched);
            matched = next;
            if is_settled {
                let is_found =
                    matched.len() >= fewest && self.is_within_tolerance(hypothesis.lens.focal_ratio);
                let found = || FoundAttitude::from_hypothesis(&hypothesis, &matched, &self.model);
                return is_found.then(found);
            }
        }
        None
    }

    fn is_within_tolerance(&self, ratio: f64) -> bool {
        (ratio - 1.0).abs() <= self.focal_length_tolerance
    }
}

/// Returns true if two lists have the same sources with the same stars.
fn are_same(a: &[Match], b: &[Match]) -> bool {
    a.len() == b.len() && a.iter().all(|pair| b.iter().any(|other| other.is_same_as(pair)))
}

/// Focal length with which matched sources are solved.
#[derive(Debug, Clone, Copy)]
enum FocalLength {
    /// The stated one.
    Stated,
    /// That of the stars, with a first value over the stated one.
    Free { ratio: f64 },
    /// That of the stars, with a radial distortion: first values, and the prior of the distortion.
    FreeLens { lens: Lens, prior: ShiftPrior },
}

impl FoundAttitude {
    fn from_hypothesis(hypothesis: &Hypothesis, matched: &[Match], stated: &CameraModel) -> Self {
        Self {
            camera_from_icrs: hypothesis.camera_from_icrs,
            covariance: hypothesis.covariance.fixed_view::<3, 3>(0, 0).into_owned(),
            focal_ratio: hypothesis.lens.focal_ratio,
            added_radial: hypothesis.lens.radial(stated),
            focal_sigma: hypothesis.covariance[(3, 3)].sqrt(),
            matched: matched.iter().map(|pair| (pair.source.index, pair.star)).collect(),
        }
    }

    /// Returns the matched sources of those from which the attitude was found.
    fn matches(&self, sources: &[ImageSource]) -> Vec<Match> {
        let of_index = |index: usize| sources.iter().find(|source| source.index == index).copied();
        let matched = self.matched.iter();
        matched.filter_map(|&(index, star)| Some(Match { source: of_index(index)?, star })).collect()
    }
}
