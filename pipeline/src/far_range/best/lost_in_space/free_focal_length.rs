//! Search with a focal length that is known within a tolerance.
//!
//! Triangles of sources are looked up at focal lengths in steps of [`STEP`], with separations that may differ
//! by half a step. The three separations of a triangle that is found give its focal length; attitude and
//! focal length together are four unknowns of six coordinates. As with a known focal length, the odds of all
//! other sources decide.

use contract::ListedStar;

use super::hypothesis::{Hypothesis, Match};
use super::source::ImageSource;
use super::triangles::{TriangleSearch, pyramid_order};
use super::{FocalLength, FoundAttitude, LostInSpace, MAX_TRIANGLE_SOURCES};

/// Step of the focal lengths at which triangles are looked up, as a share.
const STEP: f64 = 0.01;

/// Number of star pairs visited in a frame after which the search ends, and number of attitudes tested.
const MAX_VISITED_PAIRS: usize = 60_000_000;
const MAX_TESTED: usize = 30_000;

/// Natural logarithm of the smallest odds: 3 · 10¹⁰, so that a false attitude has a probability of at most
/// 10⁻⁶ in a frame without stars for [`MAX_TESTED`] tests, none of them on the triangle that produced the
/// attitude.
const MIN_LOG_ODDS: f64 = 24.2;

/// Number of rounds for the focal length of a triangle. Chords are inversely proportional to it but for the
/// square of the field, so each round leaves a hundredth of the error.
const TRIANGLE_ROUNDS: usize = 3;

impl LostInSpace {
    /// Returns attitude and focal length that the sources of a frame determine. Returns `None` when none
    /// reaches the odds, or the focal length is outside the tolerance.
    pub(super) fn solve_with_free_focal_length(&self, sources: &[ImageSource]) -> Option<FoundAttitude> {
        let mut search = TriangleSearch::new(&self.stars, &self.pairs, &self.model);
        let ratios = focal_ratios(self.focal_length_tolerance);
        let mut tested = 0;
        for corners in pyramid_order(sources.len().min(MAX_TRIANGLE_SOURCES)) {
            let corners = corners.map(|corner| sources[corner]);
            for &ratio in &ratios {
                let [Some(a), Some(b), Some(c)] = corners.map(|corner| corner.direction_at(ratio)) else {
                    continue;
                };
                for triple in search.matching_triples([a, b, c], 0.5 * STEP) {
                    let triangle = Triangle { corners, stars: triple.map(|star| self.stars[star as usize]) };
                    let Some(ratio) = triangle.focal_ratio(ratio, search.tolerance()) else { continue };
                    if !self.is_within_tolerance(ratio) {
                        continue;
                    }
                    tested += 1;
                    if let Some(found) = self.test_triangle(sources, &triangle, ratio) {
                        return Some(found);
                    }
                }
            }
            if tested >= MAX_TESTED || search.visited() >= MAX_VISITED_PAIRS {
                break;
            }
        }
        None
    }

    /// Returns attitude and focal length of a triangle, refined with all its stars, if the other sources
    /// support it with the smallest odds or more.
    fn test_triangle(
        &self,
        sources: &[ImageSource],
        triangle: &Triangle,
        ratio: f64,
    ) -> Option<FoundAttitude> {
        let corners = triangle.matches();
        let hypothesis = Hypothesis::with_free_focal_length(&corners, &self.model, ratio)?;
        let support = hypothesis.support(sources, &corners, &self.list);
        if support.log_odds < MIN_LOG_ODDS {
            return None;
        }
        let focal_length = FocalLength::Free { ratio: hypothesis.focal_ratio };
        self.refined(sources, support.matched, focal_length)
    }
}

/// Returns the focal lengths, over the stated one, at which triangles are looked up: the stated one first.
fn focal_ratios(tolerance: f64) -> Vec<f64> {
    let steps = (tolerance / STEP).ceil() as i32;
    let mut ratios = vec![1.0];
    for step in 1..=steps {
        let share = (f64::from(step) * STEP).min(tolerance);
        ratios.extend([1.0 + share, 1.0 - share]);
    }
    ratios
}

/// Three sources and the stars that they may be.
struct Triangle {
    corners: [ImageSource; 3],
    stars: [ListedStar; 3],
}

impl Triangle {
    fn matches(&self) -> Vec<Match> {
        let pairs = self.corners.into_iter().zip(self.stars);
        pairs.map(|(source, star)| Match { source, star }).collect()
    }

    /// Returns the focal length over the stated one at which the separations of the sources are those of the
    /// stars, from a first value; `None` if they differ by more than `tolerance`, a chord.
    fn focal_ratio(&self, mut ratio: f64, tolerance: f64) -> Option<f64> {
        let expected = chords(self.stars.map(|star| *star.direction.vector()));
        for _ in 0..TRIANGLE_ROUNDS {
            let measured = self.chords_at(ratio)?;
            // Chords are inversely proportional to the focal length: the factor is Σ c²/Σ c d, by least
            // squares.
            let (mut squares, mut products) = (0.0, 0.0);
            for side in 0..3 {
                squares += measured[side] * measured[side];
                products += measured[side] * expected[side];
            }
            ratio *= squares / products;
        }
        let measured = self.chords_at(ratio)?;
        (0..3).all(|side| (measured[side] - expected[side]).abs() <= tolerance).then_some(ratio)
    }

    fn chords_at(&self, ratio: f64) -> Option<[f64; 3]> {
        let [a, b, c] = self.corners.map(|corner| corner.direction_at(ratio));
        Some(chords([*a?.vector(), *b?.vector(), *c?.vector()]))
    }
}

/// Returns the distances between three unit vectors, each opposite to one of them.
fn chords([a, b, c]: [nalgebra::Vector3<f64>; 3]) -> [f64; 3] {
    [(b - c).norm(), (c - a).norm(), (a - b).norm()]
}
