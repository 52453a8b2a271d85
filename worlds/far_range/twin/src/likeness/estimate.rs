//! Estimates of a figure, with their errors.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Probability below which frames scatter by more than their own errors (Cochran's test).
const SCATTER_PROBABILITY: f64 = 0.01;

/// Distance from the median, in standard deviations, beyond which a value is left out of a clipped mean.
const CLIP_SIGMAS: f64 = 4.0;

/// Standard deviation of a normal distribution over its median absolute deviation.
const SIGMA_PER_MAD: f64 = 1.482_602_218_505_602;

/// An estimate with its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Value.
    pub value: f64,
    /// Standard deviation of the value.
    pub sigma: f64,
    /// Degrees of freedom of the standard deviation; infinite if it is known.
    pub freedom: f64,
}

impl Estimate {
    /// Returns an estimate with a known standard deviation.
    pub fn known(value: f64, sigma: f64) -> Self {
        Self { value, sigma, freedom: f64::INFINITY }
    }

    /// Returns the mean of values, without those far from the median; `None` for fewer than three.
    pub(crate) fn of_values(values: &[f64]) -> Option<Self> {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        if sorted.len() < 3 {
            return None;
        }
        sorted.sort_by(f64::total_cmp);
        let median = sorted[sorted.len() / 2];
        let mut deviations: Vec<f64> = sorted.iter().map(|value| (value - median).abs()).collect();
        deviations.sort_by(f64::total_cmp);
        let limit = CLIP_SIGMAS * SIGMA_PER_MAD * deviations[deviations.len() / 2];
        let kept: Vec<f64> = sorted.into_iter().filter(|value| (value - median).abs() <= limit).collect();
        let count = kept.len() as f64;
        if kept.len() < 3 {
            return None;
        }
        let mean = kept.iter().sum::<f64>() / count;
        let squares: f64 = kept.iter().map(|value| (value - mean) * (value - mean)).sum();
        Some(Self { value: mean, sigma: (squares / (count * (count - 1.0))).sqrt(), freedom: count - 1.0 })
    }

    /// Returns the mean of the values of several frames. Where the frames scatter by more than their own
    /// errors (Cochran 1954: Q = Σ (x − x̄)²/σ² beyond the 99 % quantile of χ²), the scatter gives the error:
    /// the frames are then the sample.
    pub(crate) fn of_frames(frames: &[Self]) -> Option<Self> {
        let count = frames.len() as f64;
        if frames.is_empty() {
            return None;
        }
        let mean = frames.iter().map(|frame| frame.value).sum::<f64>() / count;
        let variance = frames.iter().map(|frame| frame.sigma * frame.sigma).sum::<f64>() / (count * count);
        let freedom = frames.iter().map(|frame| frame.freedom).sum();
        let within = Self { value: mean, sigma: variance.sqrt(), freedom };
        if frames.len() < 2 || variance <= 0.0 {
            return Some(within);
        }
        let squares: f64 = frames.iter().map(|frame| (frame.value - mean) * (frame.value - mean)).sum();
        let q = squares / (count * variance);
        let limit = ChiSquared::new(count - 1.0).ok()?.inverse_cdf(1.0 - SCATTER_PROBABILITY);
        if q <= limit {
            return Some(within);
        }
        let between = squares / (count * (count - 1.0));
        Some(Self { value: mean, sigma: between.sqrt(), freedom: count - 1.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_that_scatter_are_the_sample() {
        let frames = |values: [f64; 4]| values.map(|value| Estimate::known(value, 1.0));
        let steady = Estimate::of_frames(&frames([1.0, 2.0, 3.0, 2.0])).unwrap();
        assert_eq!((steady.value, steady.sigma, steady.freedom), (2.0, 0.5, f64::INFINITY));
        let moving = Estimate::of_frames(&frames([0.0, 10.0, 20.0, 10.0])).unwrap();
        // Σ (x − x̄)² = 200: 200/(4 · 3).
        assert!((moving.sigma - (200.0_f64 / 12.0).sqrt()).abs() < 1e-12);
        assert_eq!((moving.value, moving.freedom), (10.0, 3.0));
        assert_eq!(Estimate::of_frames(&[]), None);
    }

    #[test]
    fn a_far_value_is_left_out_of_the_mean() {
        let mean = Estimate::of_values(&[1.0, 2.0, 3.0, 2.0, 1.0, 3.0, 500.0, f64::NAN]).unwrap();
        assert_eq!((mean.value, mean.freedom), (2.0, 5.0));
        assert!((mean.sigma - (4.0_f64 / 30.0).sqrt()).abs() < 1e-12);
        assert_eq!(Estimate::of_values(&[1.0, 2.0]), None);
    }
}
