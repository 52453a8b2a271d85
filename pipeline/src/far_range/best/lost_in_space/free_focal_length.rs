//! Search with a focal length that is known within a tolerance, and with an unknown radial distortion.
//!
//! Triangles of sources are looked up by their shape, which is computed at focal lengths in steps of
//! [`STEP`]: between the steps, it does not change. The three separations of a triangle that is found give
//! its focal length; attitude and focal length together are four unknowns of six coordinates. As with a known
//! focal length, the odds of all other sources decide.
//!
//! An unknown distortion is looked for in steps of the corner shift ([`SHIFT_STEP`]), the stated distortion
//! first. At each, the sources are undistorted, and the shift is a fifth unknown with a prior of half a step:
//! the predictions of stars far from the triangle are wide, and each star that matches narrows them.

use contract::ListedStar;

use super::hypothesis::{Hypothesis, Lens, Match, ShiftPrior};
use super::source::ImageSource;
use super::triangles::{Shape, TriangleSearch, pyramid_order};
use super::{FocalLength, FoundAttitude, LostInSpace, MAX_TRIANGLE_SOURCES};

/// Step of the focal lengths at which the shapes of triangles are computed, as a share.
const STEP: f64 = 0.01;

/// Number of star pairs visited in a frame after which the search ends, and number of attitudes tested.
const MAX_VISITED_PAIRS: usize = 60_000_000;
const MAX_TESTED: usize = 30_000;

/// Natural logarithm of the smallest odds: 3 · 10¹⁰, so that a false attitude has a probability of at most
/// 10⁻⁶ in a frame without stars for [`MAX_TESTED`] tests, none of them on the triangle that produced the
/// attitude.
const MIN_LOG_ODDS: f64 = 24.2;

/// Step of the corner shifts.
const SHIFT_STEP: f64 = 0.02;

/// Share of the limits of visited pairs and tested attitudes at a shift other than 0.
const OTHER_SHIFTS_SHARE: usize = 4;

/// Natural logarithm of the smallest odds with an unknown distortion: 1.2 · 10¹¹, for up to 120,000 tests at
/// all shifts.
const MIN_LOG_ODDS_OF_SHIFTS: f64 = 25.5;

/// Number of rounds for the focal length of a triangle. Chords are inversely proportional to it but for the
/// square of the field, so each round leaves a hundredth of the error.
const TRIANGLE_ROUNDS: usize = 3;

/// Limits of a search, and what it accepts.
struct Limits {
    visited_pairs: usize,
    tested: usize,
    log_odds: f64,
    /// Prior of the corner shift; `None` for the stated distortion.
    shift: Option<ShiftPrior>,
}

impl LostInSpace {
    /// Returns attitude, focal length and, if it is unknown, radial distortion that the sources of a frame
    /// determine. Returns `None` when none reaches the odds, or the focal length is outside the tolerance.
    pub(super) fn solve_with_free_focal_length(&self, sources: &[ImageSource]) -> Option<FoundAttitude> {
        let (visited_pairs, tested) = (MAX_VISITED_PAIRS, MAX_TESTED);
        if self.corner_shift_bound == 0.0 {
            let limits = Limits { visited_pairs, tested, log_odds: MIN_LOG_ODDS, shift: None };
            return self.search(sources, &limits);
        }
        let sigma = 0.5 * SHIFT_STEP;
        for mean in corner_shifts(self.corner_shift_bound) {
            let share = if mean == 0.0 { 1 } else { OTHER_SHIFTS_SHARE };
            let limits = Limits {
                visited_pairs: visited_pairs / share,
                tested: tested / share,
                log_odds: MIN_LOG_ODDS_OF_SHIFTS,
                shift: Some(ShiftPrior { mean, sigma }),
            };
            let lens = Lens { focal_ratio: 1.0, corner_shift: mean };
            let model = self.model.with_added_radial(lens.radial(&self.model));
            let undistorted: Vec<ImageSource> = sources
                .iter()
                .filter_map(|source| {
                    Some(ImageSource { direction: model.back_project(source.position)?, ..*source })
                })
                .collect();
            if let Some(found) = self.search(&undistorted, &limits) {
                return Some(found);
            }
        }
        None
    }

    /// Searches for the triangles of sources, whose directions are those by the lens of the limits.
    fn search(&self, sources: &[ImageSource], limits: &Limits) -> Option<FoundAttitude> {
        let mut search = TriangleSearch::new(&self.stars, &self.pairs, &self.model);
        let ratios = focal_ratios(self.focal_length_tolerance);
        let mut tested = 0;
        for corners in pyramid_order(sources.len().min(MAX_TRIANGLE_SOURCES)) {
            let corners = corners.map(|corner| sources[corner]);
            let directions = |ratio: &f64| match corners.map(|corner| corner.direction_at(*ratio)) {
                [Some(a), Some(b), Some(c)] => Some(Shape::new([a, b, c])),
                _ => None,
            };
            let Some(shapes) = ratios.iter().map(directions).collect::<Option<Vec<Shape>>>() else {
                continue;
            };
            for (step, triple) in search.similar_triples(&shapes, &self.neighbours) {
                let triangle = Triangle { corners, stars: triple.map(|star| self.stars[star as usize]) };
                let Some(ratio) = triangle.focal_ratio(ratios[step], search.tolerance()) else { continue };
                if !self.is_within_tolerance(ratio) {
                    continue;
                }
                tested += 1;
                if let Some(found) = self.test_triangle(sources, &triangle, ratio, limits) {
                    return Some(found);
                }
            }
            if tested >= limits.tested || search.visited() >= limits.visited_pairs {
                break;
            }
        }
        None
    }

    /// Returns attitude and lens of a triangle, refined with all its stars, if the other sources support it
    /// with the smallest odds or more.
    fn test_triangle(
        &self,
        sources: &[ImageSource],
        triangle: &Triangle,
        ratio: f64,
        limits: &Limits,
    ) -> Option<FoundAttitude> {
        let corners = triangle.matches();
        let hypothesis = match limits.shift {
            None => Hypothesis::with_free_focal_length(&corners, &self.model, ratio)?,
            Some(prior) => {
                let first = Lens { focal_ratio: ratio, corner_shift: prior.mean };
                Hypothesis::with_free_lens(&corners, &self.model, first, prior)?
            }
        };
        let support = hypothesis.support(sources, &corners, &self.list);
        if support.log_odds < limits.log_odds {
            return None;
        }
        let focal_length = match limits.shift {
            None => FocalLength::Free { ratio: hypothesis.lens.focal_ratio },
            // The stars determine the shift: the prior only keeps it near the bound.
            Some(_) => FocalLength::FreeLens {
                lens: hypothesis.lens,
                prior: ShiftPrior { mean: 0.0, sigma: self.corner_shift_bound },
            },
        };
        self.refined(sources, support.matched, focal_length)
    }
}

/// Returns the corner shifts at which sources are undistorted: 0 first.
fn corner_shifts(bound: f64) -> Vec<f64> {
    let mut shifts = vec![0.0];
    for step in 1..=(bound / SHIFT_STEP).round() as i32 {
        let shift = f64::from(step) * SHIFT_STEP;
        shifts.extend([-shift, shift]);
    }
    shifts
}

/// Returns the focal lengths, over the stated one, at which the shapes of triangles are computed, in
/// increasing order.
fn focal_ratios(tolerance: f64) -> Vec<f64> {
    let steps = (tolerance / STEP).ceil() as i32;
    (-steps..=steps).map(|step| 1.0 + (f64::from(step) * STEP).clamp(-tolerance, tolerance)).collect()
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
