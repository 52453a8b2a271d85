//! Comparison of two sets of frames.

use camera_fit::CameraFit;

use super::background::{BINS_PER_SIGMA, FrameBackground, HISTOGRAM_SIGMAS};
use super::difference::{Likeness, NotCompared};
use super::estimate::Estimate;
use super::spectrum::Spectrum;
use super::stars::{SharedStar, shared_stars};
use super::{background, geometry, hot_pixels, stars};
use crate::FrameSet;

/// Numbers of pixels by their height above the background, camera and twin.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    /// Middle of each bin, DN.
    pub height_dn: Vec<f64>,
    /// Share of the pixels in each bin.
    pub share: [Vec<f64>; 2],
}

/// Result of a comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Figures that both sets give.
    pub figures: Vec<Likeness>,
    /// Figures that they do not give.
    pub missing: Vec<NotCompared>,
    /// Stars of both sets.
    pub stars: Vec<SharedStar>,
    /// Distribution of the pixels.
    pub histogram: Histogram,
    /// Power spectra of camera and twin: along the rows, and along the columns.
    pub spectra: [[Spectrum; 2]; 2],
}

/// Probability of a difference by chance in any of the figures, below which the sets differ as a whole.
const CHANCE: f64 = 0.05;

impl Comparison {
    /// Returns true if no figure differs by more than chance gives in one of so many: the smallest
    /// probability is at least 5 % divided by their number (Bonferroni; the first step of Holm 1979).
    pub fn is_alike(&self) -> bool {
        let limit = CHANCE / self.figures.len().max(1) as f64;
        self.figures.iter().all(|figure| figure.probability >= limit)
    }
}

/// Compares the frames of a camera with those of its twin.
pub fn compare(camera: &FrameSet, twin: &FrameSet) -> Comparison {
    // Bins of one DN or more: those of whole numbers below would be full and empty in turn.
    let bin_dn = camera.fit.noise_dn.max(BINS_PER_SIGMA);
    let backgrounds = [camera.backgrounds(bin_dn), twin.backgrounds(bin_dn)];
    let mut figures = background::likenesses(&backgrounds[0], &backgrounds[1]);
    let mut missing = Vec::new();
    match hot_pixels::likeness(camera, twin) {
        Ok(figure) => figures.push(figure),
        Err(lack) => missing.push(lack),
    }
    figures.push(star_count(&camera.fit, &twin.fit));
    let shared = shared_stars(&camera.fit, &twin.fit);
    let (of_stars, without_stars) = stars::likenesses(&shared);
    let (of_geometry, undetermined) = geometry::likenesses(&camera.fit, &twin.fit);
    figures.extend(of_stars);
    figures.extend(of_geometry);
    missing.extend(without_stars);
    missing.extend(undetermined);
    let spectra = [&backgrounds[0], &backgrounds[1]]
        .map(|set| [0, 1].map(|axis| Spectrum::mean(set.iter().map(|frame| &frame.spectra[axis]))));
    Comparison { figures, missing, stars: shared, histogram: histogram(&backgrounds, bin_dn), spectra }
}

/// Compares the number of stars per frame. Numbers scatter as those of Poisson: by more than those of the
/// same sky.
fn star_count(camera: &CameraFit, twin: &CameraFit) -> Likeness {
    let per_frame = |fit: &CameraFit| fit.stars as f64 / fit.frames.len().max(1) as f64;
    let (first, second) = (camera.stars.max(1) as f64, twin.stars.max(1) as f64);
    let ln_ratio =
        Estimate::known(libm::log(per_frame(twin) / per_frame(camera)), (1.0 / first + 1.0 / second).sqrt());
    Likeness::of_ratio("star_count", "number of stars", ln_ratio)
}

fn histogram(backgrounds: &[Vec<FrameBackground>; 2], bin_dn: f64) -> Histogram {
    let [low, high] = HISTOGRAM_SIGMAS;
    let bins = ((high - low) * BINS_PER_SIGMA) as usize;
    let height_dn = (0..bins).map(|bin| (low + (bin as f64 + 0.5) / BINS_PER_SIGMA) * bin_dn).collect();
    let share = [0, 1].map(|set: usize| {
        let mut counts = vec![0.0; bins];
        for frame in &backgrounds[set] {
            for (sum, count) in counts.iter_mut().zip(&frame.histogram) {
                *sum += *count as f64;
            }
        }
        let all = counts.iter().sum::<f64>().max(1.0);
        counts.iter_mut().for_each(|count| *count /= all);
        counts
    });
    Histogram { height_dn, share }
}
