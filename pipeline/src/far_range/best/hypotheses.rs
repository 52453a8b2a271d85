//! Hypotheses about a track: the target, an unlisted star, a defective pixel, or chance.
//!
//! A hypothesis has the natural logarithm of its weight relative to chance: noise maxima and particle hits
//! that are independent from frame to frame. The weight of a hypothesis is the expected number of its objects
//! per frame and unit of ln F at birth, times the likelihoods of all frames since. The odds of the target are
//! its weight over the sum of the others (Bar-Shalom & Li 1995, Multitarget-Multisensor Tracking, Sec. 7.3).

/// Number of hypotheses about stars, which differ in the scatter of their centroid.
pub(super) const STARS: usize = 3;

/// Natural logarithms of the weights of a track's hypotheses relative to chance, or of the likelihoods of one
/// frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hypotheses {
    pub(super) target: f64,
    /// A star, or another object at rest among the stars, that the list lacks; by the scatter of its
    /// centroid, smallest first.
    pub(super) stars: [f64; STARS],
    /// One or two pixels of high dark current, at rest on the detector.
    pub(super) pixel: f64,
}

/// Largest logarithm of a weight. Evidence beyond it carries no further information, and a track must remain
/// able to lose.
const MAX_LOG_WEIGHT: f64 = 25.0;

/// Largest difference between the logarithms of a track's weights.
const MAX_DIFFERENCE: f64 = 25.0;

impl Hypotheses {
    /// Creates logarithms that are the same for every hypothesis but chance.
    pub(super) fn of_any_object(all: f64) -> Self {
        Self { target: all, stars: [all; STARS], pixel: all }
    }

    /// Returns the logarithm of the odds of the target, ln [w_T/(1 + Σ w_S + w_P)].
    pub(super) fn log_odds(&self) -> f64 {
        let largest = self.largest_star().max(self.pixel).max(0.0);
        let mut sum = libm::exp(-largest) + libm::exp(self.pixel - largest);
        for star in self.stars {
            sum += libm::exp(star - largest);
        }
        self.target - largest - libm::log(sum)
    }

    fn largest_star(&self) -> f64 {
        self.stars.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns true if the track is rather the target, or a pixel, than a star or chance.
    pub(super) fn is_no_star(&self) -> bool {
        self.target > self.largest_star().max(0.0)
    }

    /// Adds the evidence of a frame. Weights above the limit are reduced together, so that their ratios
    /// remain.
    pub(super) fn add(&mut self, evidence: Self) {
        self.target += evidence.target;
        self.pixel += evidence.pixel;
        for (star, of_frame) in self.stars.iter_mut().zip(evidence.stars) {
            *star += of_frame;
        }
        let largest = self.target.max(self.largest_star()).max(self.pixel);
        let excess = (largest - MAX_LOG_WEIGHT).max(0.0);
        let smallest = largest - excess - MAX_DIFFERENCE;
        let limited = |weight: f64| (weight - excess).max(smallest);
        self.target = limited(self.target);
        self.pixel = limited(self.pixel);
        self.stars = self.stars.map(limited);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn odds_are_the_weight_of_the_target_over_the_sum_of_the_others() {
        let hypotheses = Hypotheses { target: 2.0, stars: [1.0, 0.5, -2.0], pixel: -1.0 };
        let others = 1.0 + [1.0_f64, 0.5, -2.0, -1.0].map(libm::exp).iter().sum::<f64>();
        assert!((hypotheses.log_odds() - (2.0 - libm::log(others))).abs() < 1e-12);
    }

    #[test]
    fn a_limited_weight_keeps_its_ratio_to_the_others_and_can_lose() {
        let mut hypotheses = Hypotheses { target: 24.0, stars: [20.0, 0.0, 0.0], pixel: -30.0 };
        hypotheses.add(Hypotheses::of_any_object(8.0));
        assert!((hypotheses.target - 25.0).abs() < 1e-12 && (hypotheses.stars[0] - 21.0).abs() < 1e-12);
        assert!(hypotheses.pixel >= 0.0);
    }
}
