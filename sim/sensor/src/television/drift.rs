//! Slow drift of the camera's contrast and brightness.

use std::f64::consts::PI;

use contract::OutOfRange;
use contract::bounds::require;
use draws::{Effect, Seed, uniform};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Drift of contrast and brightness as sums of sinusoids of equal amplitude with phases drawn from the seed:
/// a function of time without memory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DriftConfig {
    /// Root mean square of the relative change of contrast, 0 to 0.3.
    #[schemars(range(min = 0, max = 0.3))]
    pub contrast_rms: f64,
    /// Root mean square of the change of brightness, in units of the white level, 0 to 0.3.
    #[schemars(range(min = 0, max = 0.3))]
    pub brightness_rms: f64,
    /// Periods of the sinusoids, s, 0.1 to 1e5; 1 to 16 periods.
    #[schemars(length(min = 1, max = 16), inner(range(min = 0.1, max = 1e5)))]
    pub periods_s: Vec<f64>,
}

impl Default for DriftConfig {
    fn default() -> Self {
        Self { contrast_rms: 0.04, brightness_rms: 0.01, periods_s: vec![97.0, 41.0, 13.0] }
    }
}

impl DriftConfig {
    /// Checks the largest deviation: where the maxima of all sinusoids coincide, contrast changes by √(2 n)
    /// times the root mean square.
    pub(super) fn check(&self) -> Result<(), OutOfRange> {
        require(
            "television.drift.contrast_rms",
            self.contrast_rms,
            "less than 1/√(2 × number of periods), so that contrast stays positive",
            |rms| rms * libm::sqrt(2.0 * self.periods_s.len() as f64) < 1.0,
        )
    }

    /// Contrast (about 1) and brightness (about 0) at a time.
    pub(super) fn contrast_and_brightness_at(&self, seed: &Seed, time_s: f64) -> (f64, f64) {
        // A sinusoid of amplitude a has the mean square a²/2.
        let amplitude = (2.0 / self.periods_s.len().max(1) as f64).sqrt();
        let mut sums = [0.0; 2];
        for (i, period_s) in (0..).zip(&self.periods_s) {
            let mut stream = seed.stream(0, Effect::VideoDrift, i);
            for sum in &mut sums {
                let phase = 2.0 * PI * uniform(&mut stream);
                *sum += amplitude * libm::sin(2.0 * PI * time_s / period_s + phase);
            }
        }
        (1.0 + self.contrast_rms * sums[0], self.brightness_rms * sums[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_drift_has_its_root_mean_square() {
        let config = DriftConfig { contrast_rms: 0.05, brightness_rms: 0.02, periods_s: vec![10.0, 4.0] };
        // 20 s contain an integer number of periods of 10 s and of 4 s.
        let n = 2000;
        let mut squares = [0.0; 2];
        for i in 0..n {
            let (contrast, brightness) = config
                .contrast_and_brightness_at(&Seed { seed: 1, case: 0 }, 20.0 * f64::from(i) / f64::from(n));
            squares[0] += (contrast - 1.0) * (contrast - 1.0) / f64::from(n);
            squares[1] += brightness * brightness / f64::from(n);
        }
        // Exact over full periods, to rounding.
        assert!((squares[0].sqrt() - 0.05).abs() < 1e-12 && (squares[1].sqrt() - 0.02).abs() < 1e-12);
    }
}
