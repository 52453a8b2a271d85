//! Number of stars detected at one exposure, boresight by boresight.

use rayon::prelude::*;

use crate::camera::CameraModel;
use crate::detection_model::detection::{DetectionCurve, background_e};
use crate::detection_model::pixel::readout_e;
use crate::detection_model::poisson_binomial::at_least;
use crate::requirement::{DetectionRule, MotionGuidance, MotionTable, SkyStatistic};
use crate::sky::{Field, Sky};

/// Smallest detection probability that is included in sums over stars.
const MIN_PROBABILITY: f64 = 1e-9;
/// Step between two levels of the background, in standard deviations of an empty pixel: a detection
/// probability that is a normal distribution function of the background is then interpolated to 0.002.
const LEVEL_STEP: f64 = 0.25;
/// Largest number of levels; for a larger span of backgrounds, as near the Sun, the steps are wider.
const MAX_LEVELS: usize = 24;

/// Detection curves of one exposure at several levels of the background.
#[derive(Debug, Clone, PartialEq)]
pub struct Curves {
    ln_exposure: f64,
    levels_e_per_s: Vec<f64>,
    curves: Vec<DetectionCurve>,
}

/// Detection statistics of the stars at one boresight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StarCount {
    /// Expected number of stars detected.
    pub expected: f64,
    /// P(N ≥ n_min).
    pub chance: f64,
}

impl Curves {
    /// Computes the detection curves of stars for backgrounds from `low_e_per_s` to `high_e_per_s`.
    pub fn new(
        camera: &CameraModel,
        rule: &DetectionRule,
        motion: &MotionTable,
        exposure_s: f64,
        [low_e_per_s, high_e_per_s]: [f64; 2],
    ) -> Self {
        let trail_px = star_trail_px(camera, motion, exposure_s);
        let read_e = readout_e(&camera.config.sensor);
        let variance =
            |background_e_per_s| background_e(camera, exposure_s, background_e_per_s) + read_e * read_e + 1.0;
        let ratio = variance(high_e_per_s) / variance(low_e_per_s);
        let growth = LEVEL_STEP / variance(low_e_per_s).sqrt();
        let steps = ((libm::log(ratio.max(1.0)) / growth).ceil() as usize).min(MAX_LEVELS - 1);
        let levels_e_per_s: Vec<f64> = (0..=steps)
            .map(|i| {
                let grown = variance(low_e_per_s) * libm::pow(ratio, i as f64 / steps.max(1) as f64);
                low_e_per_s + (grown - variance(low_e_per_s)) / exposure_s
            })
            .collect();
        let curve = |level: &f64| DetectionCurve::new(camera, rule, trail_px, exposure_s, *level);
        let curves = levels_e_per_s.par_iter().map(curve).collect();
        Self { ln_exposure: libm::log(exposure_s), levels_e_per_s, curves }
    }

    /// Computes the detection curves for the backgrounds at those boresights of a sky that count.
    pub fn from_sky(
        camera: &CameraModel,
        rule: &DetectionRule,
        motion: &MotionTable,
        exposure_s: f64,
        sky: &Sky,
    ) -> Self {
        let nothing = [f64::INFINITY, 0.0_f64];
        let [low, high] = sky.usable_fields().fold(nothing, |[low, high], field| {
            [low.min(field.background_e_per_s), high.max(field.background_e_per_s)]
        });
        Self::new(camera, rule, motion, exposure_s, [low.min(high), high])
    }

    /// Returns the probability that a star of exp(`ln_e_per_s`) electrons per second is detected over a
    /// background.
    pub fn chance(&self, ln_e_per_s: f64, background_e_per_s: f64) -> f64 {
        let (below, part) = self.bracket(background_e_per_s);
        self.between(below, part, ln_e_per_s + self.ln_exposure)
    }

    /// Returns the detection statistics of the stars of a field.
    pub fn count_stars(&self, field: &Field, n_min: usize, distribution: &mut Vec<f64>) -> StarCount {
        let (below, part) = self.bracket(field.background_e_per_s);
        let mut expected = 0.0;
        let chances =
            field.stars.iter().map(|star| self.between(below, part, star.ln_e_per_s + self.ln_exposure));
        let chances = chances.take_while(|p| *p > MIN_PROBABILITY).inspect(|p| expected += p);
        let chance = at_least(n_min, chances, distribution);
        StarCount { expected, chance }
    }

    /// Returns the detection statistics at each boresight of the sky that counts, in the order of the sky.
    pub fn count_stars_over_sky(&self, sky: &Sky, n_min: usize) -> Vec<StarCount> {
        let counted: Vec<&Field> = sky.usable_fields().collect();
        counted
            .par_iter()
            .map_init(Vec::new, |distribution, field| self.count_stars(field, n_min, distribution))
            .collect()
    }

    fn between(&self, below: usize, part: f64, ln_electrons: f64) -> f64 {
        let low = self.curves[below].probability_at_ln(ln_electrons);
        match self.curves.get(below + 1).filter(|_| part > 0.0) {
            Some(above) => low + part * (above.probability_at_ln(ln_electrons) - low),
            None => low,
        }
    }

    fn bracket(&self, background_e_per_s: f64) -> (usize, f64) {
        let levels = &self.levels_e_per_s;
        let above = levels.partition_point(|level| *level <= background_e_per_s);
        match (above.checked_sub(1), levels.get(above)) {
            (None, _) => (0, 0.0),
            (Some(below), None) => (below, 0.0),
            (Some(below), Some(high)) => {
                (below, (background_e_per_s - levels[below]) / (high - levels[below]))
            }
        }
    }
}

/// Returns the length over which stars are smeared in an exposure, px.
pub fn star_trail_px(camera: &CameraModel, motion: &MotionTable, exposure_s: f64) -> f64 {
    match motion.guidance {
        MotionGuidance::LocalOrbital => camera.trail_px(motion, exposure_s),
        MotionGuidance::Inertial => 0.0,
    }
}

/// Returns the probability over a sky: the mean, or the smallest; 0 if no boresight counts.
pub fn over_sky(seen: &[StarCount], over: SkyStatistic) -> f64 {
    if seen.is_empty() {
        return 0.0;
    }
    match over {
        SkyStatistic::Sky => seen.iter().map(|seen| seen.chance).sum::<f64>() / seen.len() as f64,
        SkyStatistic::EveryPointing => seen.iter().map(|seen| seen.chance).fold(1.0, f64::min),
    }
}
