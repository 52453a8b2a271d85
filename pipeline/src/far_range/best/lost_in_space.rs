//! Attitude of a frame without a prior: lost in space.
//!
//! Triangles of bright sources are looked up in a list of star pairs by their separations, in the order of
//! the Pyramid algorithm, and mirrored triangles are refused (Mortari, Samaan, Bruccoleri & Junkins 2004, The
//! Pyramid Star Identification Technique, Navigation 51, 171). Each triangle found gives an attitude with a
//! covariance. Instead of Pyramid's fourth star, all other sources decide: by the odds that they are the
//! stars predicted by that attitude, against sources anywhere in the image (Lang, Hogg, Mierle, Blanton &
//! Roweis 2010, AJ 139, 1782, section 2.3).
//!
//! Brightness is used only to order sources and stars: neither zero point nor exposure is needed.

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
use hypothesis::{Hypothesis, Match};
use selection::{brightest_of_each_field, largest_chord};
use separations::StarPairs;
use source::ImageSource;
use triangles::{TriangleSearch, pyramid_order};

/// Solver for the frames of one camera with one star list. Has no state from frames.
#[derive(Debug)]
pub(super) struct LostInSpace {
    model: CameraModel,
    /// Brightest stars of each field.
    stars: Vec<ListedStar>,
    list: StarList,
    pairs: StarPairs,
}

/// Attitude found without a prior.
#[derive(Debug, Clone)]
pub(super) struct FoundAttitude {
    pub(super) camera_from_icrs: Rotation<CameraFrame, Icrs>,
    /// Covariance of the attitude's error, a small rotation about the camera's axes, rad², for sources with
    /// an error of 0.4 px along an axis. The rotation about the boresight is the least accurate.
    pub(super) covariance: Matrix3<f64>,
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

impl LostInSpace {
    /// Creates a solver with the stars of `stars` up to the V magnitude `max_magnitude`, limited to the
    /// brightest of each field of the camera.
    pub(super) fn new(stars: &[ListedStar], model: &CameraModel, max_magnitude: f64) -> Self {
        let stars = brightest_of_each_field(stars, model, max_magnitude);
        Self {
            list: StarList::new(&stars, f64::INFINITY, model),
            pairs: StarPairs::new(&stars, largest_chord(model)),
            model: model.clone(),
            stars,
        }
    }

    /// Returns the attitude determined by the sources of a frame, each a position in px and a flux in any
    /// unit. Returns `None` when no attitude reaches odds of 10⁹. Sources that are not finite or that the
    /// camera cannot see are ignored.
    pub(super) fn solve(&self, sources: &[(PixelPoint, f64)]) -> Option<FoundAttitude> {
        let sources = self.brightest(sources);
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
                if let Some(found) = self.test(&sources, &triangle) {
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
        let mut hypothesis = Hypothesis::new(triangle, &self.model)?;
        let support = hypothesis.support(sources, triangle, &self.list, &self.model);
        if support.log_odds < MIN_LOG_ODDS {
            return None;
        }
        let mut matched = support.matched;
        let mut is_settled = false;
        for _ in 0..MAX_REFINEMENTS {
            hypothesis = Hypothesis::new(&matched, &self.model)?;
            let next = hypothesis.support(sources, &[], &self.list, &self.model).matched;
            is_settled = next.len() == matched.len()
                && next.iter().all(|pair| matched.iter().any(|before| before.is_same_as(pair)));
            matched = next;
            if is_settled {
                break;
            }
        }
        (is_settled && matched.len() >= MIN_MATCHED).then(|| FoundAttitude {
            camera_from_icrs: hypothesis.camera_from_icrs,
            covariance: hypothesis.covariance,
            matched: matched.into_iter().map(|pair| (pair.source.index, pair.star)).collect(),
        })
    }
}
