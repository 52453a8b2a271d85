//! Probability that a pixel rises above a threshold, as a function of its expected electrons.
//!
//! The digital number of a pixel is floor((e (1 − β e/w) + n)/g + b + ½), with e electrons from a Poisson
//! distribution cut at the full well w, n from a normal distribution, the gain g and the bias b. It is above
//! the threshold T when e (1 − β e/w) + n ≥ L = (T + ½ − b) g. Therefore
//!
//! P(DN > T | μ) = Σ_k Pois(k; μ) Q((L − k (1 − β k/w))/σ),
//!
//! with Q the upper tail of the normal distribution (a sum over k as in Janesick, *Photon Transfer*, 2007,
//! chapter 3, without its normal approximation). The simulator *draws* from this distribution; here it is
//! summed, because the simulator computes no probabilities.

use sim::sensor::{SensorConfig, Switch};

/// Number of table nodes per standard deviation of a pixel at the threshold.
const NODES_PER_SIGMA: f64 = 32.0;
/// Extent of the table above the threshold, in standard deviations of a pixel at the threshold.
const SIGMAS_ABOVE: f64 = 12.0;
/// Largest number of nodes; beyond it the table is coarser, or ends earlier.
const MAX_NODES: usize = 1 << 15;
/// Logarithm of a probability that is negligible for any number of draws.
const NEVER: f64 = -700.0;

/// Tabulated detection model of one pixel for one threshold.
#[derive(Debug, Clone, PartialEq)]
pub struct PixelThreshold {
    /// ln P(DN ≤ T) at equal steps of μ from 0.
    ln_below: Vec<f64>,
    step_e: f64,
}

impl PixelThreshold {
    /// Tabulates the detection model of a pixel of `sensor` for the threshold `threshold_dn`, DN.
    pub fn new(sensor: &SensorConfig, threshold_dn: f64) -> Self {
        let limit_e = (threshold_dn.floor() + 0.5 - sensor.bias_dn) * sensor.gain_e_per_dn;
        let model = PixelModel { sensor, limit_e, sigma_e: readout_e(sensor) };
        if !model.can_be_reached(threshold_dn) {
            return Self { ln_below: vec![0.0], step_e: 1.0 };
        }
        let level_e = limit_e.max(0.0);
        let sigma_e = (level_e + model.sigma_e * model.sigma_e + 1.0).sqrt();
        let top_e = level_e + SIGMAS_ABOVE * sigma_e;
        let nodes = ((top_e * NODES_PER_SIGMA / sigma_e).ceil() as usize).clamp(64, MAX_NODES);
        let step_e = top_e / nodes as f64;
        Self { ln_below: (0..=nodes).map(|i| model.ln_below(i as f64 * step_e)).collect(), step_e }
    }

    /// Returns ln P(DN ≤ T) of a pixel that expects `electrons`.
    #[inline]
    pub fn ln_below(&self, electrons: f64) -> f64 {
        let at = electrons.max(0.0) / self.step_e;
        let node = at as usize;
        match self.ln_below.get(node..) {
            Some([low, high, ..]) => low + (at - node as f64) * (high - low),
            // The probability is constant beyond the table: the pixel is always above, or, if its full well
            // is too small, as often as a full pixel.
            _ => self.ln_below.last().copied().unwrap_or(0.0),
        }
    }

    /// Returns P(DN > T) of a pixel that expects `electrons`.
    pub fn above(&self, electrons: f64) -> f64 {
        -libm::expm1(self.ln_below(electrons))
    }
}

/// Returns the standard deviation of the readout noise, electrons; noise shared by a row or column counts as
/// if it were independent in each pixel.
pub fn readout_e(sensor: &SensorConfig) -> f64 {
    let (pixel_e, lines) = (sensor.read_noise_e, sensor.line_noise);
    let variance_e2 = pixel_e * pixel_e + lines.row_e * lines.row_e + lines.column_e * lines.column_e;
    sensor.noise.read.apply(variance_e2).sqrt()
}

struct PixelModel<'a> {
    sensor: &'a SensorConfig,
    limit_e: f64,
    sigma_e: f64,
}

impl PixelModel<'_> {
    /// Returns true if a full pixel can be above the threshold.
    fn can_be_reached(&self, threshold_dn: f64) -> bool {
        let full_e = self.collected_e(self.sensor.full_well_e);
        threshold_dn < f64::from(self.sensor.full_scale_dn()) && full_e + 5.0 * self.sigma_e >= self.limit_e
    }

    /// Returns the signal that the readout receives for a number of electrons: limited by the full well, and
    /// non-linear.
    fn collected_e(&self, electrons: f64) -> f64 {
        let held_e = electrons.min(self.sensor.full_well_e);
        held_e * (1.0 - self.sensor.non_linearity * held_e / self.sensor.full_well_e)
    }

    /// Returns P(above) of a pixel that holds exactly this number of electrons.
    fn probability_above(&self, electrons: f64) -> f64 {
        let distance_e = self.limit_e - self.collected_e(electrons);
        if self.sigma_e == 0.0 {
            return if distance_e <= 0.0 { 1.0 } else { 0.0 };
        }
        0.5 * libm::erfc(distance_e / (self.sigma_e * std::f64::consts::SQRT_2))
    }

    fn ln_below(&self, mean_e: f64) -> f64 {
        let (mut above, mut below) = (0.0, 0.0);
        if self.sensor.noise.shot == Switch::Off || mean_e == 0.0 {
            above = self.probability_above(mean_e);
            below = 1.0 - above;
        } else {
            // Terms of the Poisson distribution; a wide distribution is smooth and is sampled with a stride.
            let width_e = mean_e.sqrt();
            let stride = (width_e / 20.0).floor().max(1.0);
            let reach = ((9.0 * width_e + 20.0) / stride).ceil() as i64;
            let middle = mean_e.floor();
            let ln_mean = libm::log(mean_e);
            let mut all = 0.0;
            for i in -reach..=reach {
                let electrons = middle + i as f64 * stride;
                if electrons < 0.0 {
                    continue;
                }
                let share = libm::exp(electrons * ln_mean - mean_e - libm::lgamma(electrons + 1.0));
                let over = self.probability_above(electrons);
                all += share;
                above += share * over;
                below += share * (1.0 - over);
            }
            (above, below) = (above / all, below / all);
        }
        // The smaller of the two probabilities is the more accurate.
        if above < 0.5 { libm::log1p(-above) } else { libm::log(below.max(1e-300)).max(NEVER) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sensor() -> SensorConfig {
        SensorConfig {
            bit_depth: 12,
            gain_e_per_dn: 10.0,
            bias_dn: 40.0,
            full_well_e: 60_000.0,
            read_noise_e: 15.0,
            ..SensorConfig::default()
        }
    }

    /// scipy 1.17: sum(poisson.pmf(k, mu) * norm.sf((275 - k)/15) for k in range(4000)).
    #[test]
    fn the_model_agrees_with_a_plain_sum() {
        let model = PixelThreshold::new(&sensor(), 67.0);
        for (mean_e, expected) in SCIPY {
            let got = model.above(mean_e);
            // Error of linear interpolation between nodes a thirty-second of a standard deviation apart: a
            // fraction (z/32)²/8 of a tail at z standard deviations.
            let tolerance = if expected < 1e-3 { 2e-2 } else { 2e-3 };
            assert!((got / expected - 1.0).abs() < tolerance, "{mean_e}: {got} {expected}");
        }
    }

    const SCIPY: [(f64, f64); 5] = [
        (150.0, 1.337_734_535_497_808e-10),
        (220.0, 0.004_869_674_011_663_865),
        (270.0, 0.409_582_821_767_703),
        (300.0, 0.862_567_927_968_520_6),
        (400.0, 0.999_999_835_704_183_3),
    ];

    #[test]
    fn without_noise_it_is_a_step() {
        let mut sensor = sensor();
        sensor.noise.shot = Switch::Off;
        sensor.noise.read = Switch::Off;
        let model = PixelThreshold::new(&sensor, 67.0);
        // floor(e/10 + 40.5) > 67 from 275 electrons on; a node is at most a thirty-second of 17 electrons
        // wide.
        assert_eq!((model.above(273.0), model.above(277.0)), (0.0, 1.0));
    }

    #[test]
    fn a_threshold_at_full_scale_or_beyond_the_well_is_never_passed() {
        assert_eq!(PixelThreshold::new(&sensor(), 4095.0).above(1e9), 0.0);
        let shallow = SensorConfig { full_well_e: 150.0, ..sensor() };
        assert_eq!(PixelThreshold::new(&shallow, 67.0).above(1e9), 0.0);
        // A full pixel of 200 electrons needs five standard deviations of its read noise: 2.9e-7.
        let hardly = SensorConfig { full_well_e: 200.0, ..sensor() };
        assert!(PixelThreshold::new(&hardly, 67.0).above(1e9) < 1e-6);
    }

    #[test]
    fn more_electrons_are_never_less_likely_detected() {
        for threshold_dn in [0.0, 41.0, 67.0, 500.0, 4000.0] {
            let model = PixelThreshold::new(&sensor(), threshold_dn);
            let chances: Vec<f64> = (0..2000).map(|i| model.above(f64::from(i) * 25.0)).collect();
            assert!(chances.is_sorted() && chances[1999] == 1.0, "{threshold_dn}");
        }
    }
}
