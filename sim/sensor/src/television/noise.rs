//! Noise of the video signal.

use contract::docking::Lines;
use draws::{Effect, Seed};
use rand::Rng;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Ziggurat;

/// White Gaussian noise, independent from pixel to pixel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct VideoNoiseConfig {
    /// Standard deviation, in 1/255 of the white level (8-bit digital numbers at a contrast of 1), 0 to 100;
    /// 0 for none.
    #[schemars(range(min = 0, max = 100))]
    pub sigma_dn8: f64,
}

impl Default for VideoNoiseConfig {
    fn default() -> Self {
        Self { sigma_dn8: 2.0 }
    }
}

impl VideoNoiseConfig {
    /// Adds noise to the lines of a field. Each row of the camera has one stream, at the address of its row
    /// number. Every two pixels take one word from it, the left pixel its lower half. A pixel whose half word
    /// is not sufficient continues at its own address.
    pub(super) fn apply(
        &self,
        ziggurat: &Ziggurat,
        seed: &Seed,
        field: u64,
        lines: Lines,
        signal: &mut [f32],
        columns: usize,
    ) {
        if self.sigma_dn8 == 0.0 {
            return;
        }
        let sigma = (self.sigma_dn8 / 255.0) as f32;
        let streams = seed.streams(field, Effect::VideoNoise);
        for (k, row) in signal.chunks_exact_mut(columns).enumerate() {
            let y = lines.camera_row(k) as u64;
            let mut stream = streams.stream_at(y);
            let add = |x: usize, value: &mut f32, half: u32| {
                let more = || streams.stream_at(contract::Camera::MAX_SIDE_PX as u64 * (y + 1) + x as u64);
                *value += sigma * ziggurat.draw_short(half, more);
            };
            let mut pairs = row.chunks_exact_mut(2);
            for (pair, values) in pairs.by_ref().enumerate() {
                let word = stream.next_u64();
                add(2 * pair, &mut values[0], word as u32);
                add(2 * pair + 1, &mut values[1], (word >> 32) as u32);
            }
            if let [value] = pairs.into_remainder() {
                add(columns - 1, value, stream.next_u64() as u32);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_noise_is_normal_and_white_and_has_its_standard_deviation() {
        let (columns, rows) = (768, 288);
        let mut signal = vec![0.0_f32; columns * rows];
        let seed = Seed { seed: 4, case: 0 };
        let config = VideoNoiseConfig { sigma_dn8: 3.0 };
        config.apply(&Ziggurat::default(), &seed, 17, Lines::Odd, &mut signal, columns);
        let n = signal.len() as f64;
        let moment = |f: &dyn Fn(f64) -> f64| signal.iter().map(|s| f(f64::from(*s) * 85.0)).sum::<f64>() / n;
        let lagged = |lag: usize| {
            signal.windows(lag + 1).map(|w| f64::from(w[0]) * f64::from(w[lag]) * 85.0 * 85.0).sum::<f64>()
                / n
        };
        // Standard errors 1/√n, √(2/n), √(96/n), 1/√n with n = 221 184; the tolerance is four of them.
        assert!(moment(&|s| s).abs() < 0.0086);
        assert!((moment(&|s| s * s) - 1.0).abs() < 0.0121);
        assert!((moment(&|s| s * s * s * s) - 3.0).abs() < 0.084);
        assert!(lagged(1).abs() < 0.0086 && lagged(columns).abs() < 0.0086);
        // Two pixels share a word: large values in one pixel must be independent of large values in the
        // other.
        let square = |s: f32| f64::from(s) * f64::from(s) * 85.0 * 85.0 - 1.0;
        let pairs = signal.chunks_exact(2).map(|pair| square(pair[0]) * square(pair[1])).sum::<f64>();
        // Standard error 2/√(n/2); the tolerance is four of them.
        assert!((pairs / (n / 2.0)).abs() < 0.024, "{pairs}");
    }

    #[test]
    fn its_tails_are_those_of_the_normal_distribution() {
        let (columns, rows) = (768, 576);
        let seed = Seed { seed: 4, case: 0 };
        let mut counts = [0_u32; 4];
        let fields = 8;
        for field in 0..fields {
            let mut signal = vec![0.0_f32; columns * rows];
            let config = VideoNoiseConfig { sigma_dn8: 1.0 };
            config.apply(&Ziggurat::default(), &seed, field, Lines::All, &mut signal, columns);
            for s in signal {
                for (count, beyond) in counts.iter_mut().zip([1.0_f32, 2.0, 3.0, 4.0]) {
                    *count += u32::from(s.abs() * 255.0 > beyond);
                }
            }
        }
        let n = (columns * rows) as f64 * fields as f64;
        // erfc(k/√2); binomial, with a tolerance of four standard deviations.
        for (count, k) in counts.iter().zip([1.0, 2.0, 3.0, 4.0]) {
            let p = libm::erfc(k * std::f64::consts::FRAC_1_SQRT_2);
            let off = (f64::from(*count) - n * p) / (n * p * (1.0 - p)).sqrt();
            assert!(off.abs() < 4.0, "{count} beyond {k} σ: {off} σ");
        }
    }
}
