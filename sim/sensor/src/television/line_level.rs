//! Faint horizontal bands and lines: mains hum, and a random level of each line.

use std::f64::consts::PI;

use contract::docking::Lines;
use draws::{Effect, Seed, normal};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Levels added to every pixel of a line: a band that drifts over the picture, and a normal random number per
/// line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LineLevelConfig {
    /// Amplitude of the hum, in units of the white level, 0 to 0.5.
    #[schemars(range(min = 0, max = 0.5))]
    pub hum_amplitude: f64,
    /// Period of the hum's bands, in rows of the camera, 2 to 10000.
    #[schemars(range(min = 2, max = 10000))]
    pub hum_period_rows: f64,
    /// Number of bands of the hum that pass a row per second, −25 to 25, Hz.
    #[schemars(range(min = -25, max = 25))]
    pub hum_beat_hz: f64,
    /// Standard deviation of the random level of a line, in units of the white level, 0 to 0.5.
    #[schemars(range(min = 0, max = 0.5))]
    pub line_sigma: f64,
}

impl Default for LineLevelConfig {
    fn default() -> Self {
        Self { hum_amplitude: 0.004, hum_period_rows: 288.0, hum_beat_hz: 0.7, line_sigma: 0.004 }
    }
}

impl LineLevelConfig {
    /// Level of a camera row in a field exposed at `time_s`.
    pub(super) fn level(&self, seed: &Seed, field: u64, row: usize, time_s: f64) -> f64 {
        let turns = row as f64 / self.hum_period_rows - self.hum_beat_hz * time_s;
        let line_noise = normal(&mut seed.stream(field, Effect::LineLevel, row as u64));
        self.hum_amplitude * libm::sin(2.0 * PI * turns) + self.line_sigma * line_noise
    }

    /// Adds the levels to the lines of a field.
    pub(super) fn apply(
        &self,
        seed: &Seed,
        field: u64,
        time_s: f64,
        lines: Lines,
        signal: &mut [f32],
        columns: usize,
    ) {
        for (k, row) in signal.chunks_exact_mut(columns).enumerate() {
            let level = self.level(seed, field, lines.camera_row(k), time_s) as f32;
            row.iter_mut().for_each(|s| *s += level);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_a_band_and_a_normal_number() {
        let config = LineLevelConfig {
            hum_amplitude: 0.1,
            hum_period_rows: 100.0,
            hum_beat_hz: 2.0,
            line_sigma: 0.01,
        };
        let seed = Seed { seed: 3, case: 0 };
        let n = 20_000_u64;
        let (mut band, mut square) = (0.0, 0.0);
        for field in 0..n {
            // A row at the crest of the hum: a quarter of a period, and full cycles of the beat.
            let line_noise = config.level(&seed, field, 25, 0.5 * field as f64) - 0.1;
            band += line_noise / n as f64;
            square += line_noise * line_noise / n as f64;
        }
        // Standard errors 0.01/√n and 0.01²√(2/n); the tolerance is four of them.
        assert!(band.abs() < 2.9e-4, "{band}");
        assert!((square / 1e-4 - 1.0).abs() < 0.04, "{square}");
    }
}
