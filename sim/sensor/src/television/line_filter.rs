//! Analogue video line: limited bandwidth and ringing, combined in one filter along each line.

use std::f64::consts::PI;

use optics::{correlate, pad};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Limited bandwidth of the video channel: the discrete Gaussian along the line, with weights exp(−σ²)
/// I_n(σ²) of the modified Bessel functions (Lindeberg 1990). Its variance is σ² for every σ; a Gaussian
/// sampled at integer pixels lacks this property below 0.6 px. Its amplitude at f cycles per pixel is exp(−σ²
/// (1 − cos 2πf)).
///
/// 0.45 px corresponds to 3 dB at 5.5 MHz for a 625-line system with square pixels (14.75 MHz).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BandwidthConfig {
    /// Standard deviation along the line, px, 0 to 10.
    #[schemars(range(min = 0, max = 10))]
    pub sigma_px: f64,
}

impl Default for BandwidthConfig {
    fn default() -> Self {
        Self { sigma_px: 0.45 }
    }
}

/// Ringing: an edge of height 1 is followed by amplitude × exp(−x/decay) sin(2π x/period), x pixels after the
/// edge.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RingingConfig {
    /// Amplitude relative to the height of the edge, 0 to 0.5.
    #[schemars(range(min = 0, max = 0.5))]
    pub amplitude: f64,
    /// Period, px, 2 to 50.
    #[schemars(range(min = 2, max = 50))]
    pub period_px: f64,
    /// Distance of decay to 1/e, px, 0.5 to 20.
    #[schemars(range(min = 0.5, max = 20))]
    pub decay_px: f64,
}

impl Default for RingingConfig {
    fn default() -> Self {
        Self { amplitude: 0.06, period_px: 5.0, decay_px: 2.5 }
    }
}

impl RingingConfig {
    /// Impulse response from the edge on: differences of the response to an edge, with unit sum.
    fn impulse(&self) -> Vec<f64> {
        let edge = |i: i32| {
            let x = f64::from(i);
            1.0 + self.amplitude * libm::exp(-x / self.decay_px) * libm::sin(2.0 * PI * x / self.period_px)
        };
        let length = (6.0 * self.decay_px).ceil() as i32;
        let mut impulse = vec![edge(0)];
        impulse.extend((1..length).map(|i| edge(i) - edge(i - 1)));
        let sum: f64 = impulse.iter().sum();
        impulse.iter().map(|h| h / sum).collect()
    }
}

/// Combined filter of bandwidth and ringing.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LineFilter {
    /// Correlation weights in order of increasing column.
    kernel: Vec<f32>,
    before: usize,
    padded: Vec<f32>,
}

impl LineFilter {
    /// Creates the filter; `None` if bandwidth and ringing are both off.
    pub(super) fn new(bandwidth: Option<&BandwidthConfig>, ringing: Option<&RingingConfig>) -> Option<Self> {
        if bandwidth.is_none() && ringing.is_none() {
            return None;
        }
        let gaussian = discrete_gaussian(bandwidth.map_or(0.0, |config| config.sigma_px));
        let reach = gaussian.len() / 2;
        let impulse = ringing.map_or_else(|| vec![1.0], RingingConfig::impulse);
        let mut kernel = vec![0.0_f64; gaussian.len() + impulse.len() - 1];
        for (i, g) in gaussian.iter().enumerate() {
            // Ringing follows an edge: it uses preceding columns, so the impulse is reversed in a
            // correlation.
            for (j, h) in impulse.iter().rev().enumerate() {
                kernel[i + j] += g * h;
            }
        }
        let before = reach + impulse.len() - 1;
        Some(Self { kernel: kernel.iter().map(|k| *k as f32).collect(), before, padded: Vec::new() })
    }

    /// Filters every line.
    pub(super) fn apply(&mut self, signal: &mut [f32], columns: usize) {
        let after = self.kernel.len() - 1 - self.before;
        for row in signal.chunks_exact_mut(columns) {
            pad(row, self.before, after, &mut self.padded);
            correlate(&self.padded, &self.kernel, row);
        }
    }
}

/// Weight of a filter below which it is dropped: less than the rounding error of the sum in single precision.
const MIN_WEIGHT: f64 = 1e-8;

/// exp(−σ²) I_n(σ²) for n from −N to N, with unit sum; less than 1e-7 is truncated.
fn discrete_gaussian(sigma_px: f64) -> Vec<f64> {
    let variance = sigma_px * sigma_px;
    let most = (6.0 * sigma_px).ceil() as i32 + if sigma_px > 0.0 { 3 } else { 0 };
    let half: Vec<f64> =
        (0..=most).map(|n| scaled_bessel(n, variance)).take_while(|weight| *weight > MIN_WEIGHT).collect();
    let reach = half.len() as i32 - 1;
    let weights = (-reach..=reach).map(|n| half[n.unsigned_abs() as usize]);
    let sum: f64 = weights.clone().sum();
    weights.map(|w| w / sum).collect()
}

/// exp(−t) I_n(t) by the power series of the modified Bessel function, whose terms are all positive. t is 0
/// to 100.
fn scaled_bessel(n: i32, t: f64) -> f64 {
    let half = 0.5 * t;
    let mut term = (1..=n).fold(libm::exp(-t), |term, k| term * half / f64::from(k));
    let mut sum = term;
    let mut k = 1.0;
    while term > 1e-18 * sum {
        term *= half * half / (k * (k + f64::from(n)));
        sum += term;
        k += 1.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_is_followed_by_a_damped_oscillation() {
        let config = RingingConfig { amplitude: 0.1, period_px: 8.0, decay_px: 4.0 };
        let mut line = vec![0.0_f32; 100];
        line[40..].fill(1.0);
        LineFilter::new(None, Some(&config)).unwrap().apply(&mut line, 100);
        assert!(line[..40].iter().all(|v| v.abs() < 1e-6), "nothing comes before the edge");
        for x in 0..20 {
            let t = x as f64;
            let theory = 1.0 + 0.1 * libm::exp(-t / 4.0) * libm::sin(2.0 * PI * t / 8.0);
            // The part truncated after 6 decay lengths, 2.5e-3 of the amplitude, is subtracted from the level
            // after the edge.
            assert!((f64::from(line[40 + x]) - theory).abs() < 2.6e-4, "{x}: {} {theory}", line[40 + x]);
        }
        assert!((line[99] - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_bandwidth_leaves_levels_and_has_its_width() {
        for sigma_px in [0.1, 0.45, 1.0, 4.0, 10.0] {
            let config = BandwidthConfig { sigma_px };
            let mut filter = LineFilter::new(Some(&config), None).unwrap();
            let mut flat = vec![0.5_f32; 200];
            filter.apply(&mut flat, 200);
            assert!(flat.iter().all(|v| (v - 0.5).abs() < 1e-6));
            let mut line = vec![0.0_f32; 200];
            line[100] = 1.0;
            filter.apply(&mut line, 200);
            let moment = |x: usize, v: f32| (x as f64 - 100.0) * (x as f64 - 100.0) * f64::from(v);
            let variance: f64 = line.iter().enumerate().map(|(x, &v)| moment(x, v)).sum();
            // Single precision, at distances of up to 60 px.
            assert!((variance / (sigma_px * sigma_px) - 1.0).abs() < 1e-3, "{sigma_px}: {variance}");
        }
    }

    #[test]
    fn the_default_loses_3_db_at_5_5_mhz() {
        let frequency = 5.5 / 14.75;
        let kernel = LineFilter::new(Some(&BandwidthConfig::default()), None).unwrap().kernel;
        let middle = (kernel.len() / 2) as f64;
        let amplitude: f64 = kernel
            .iter()
            .enumerate()
            .map(|(i, &w)| f64::from(w) * libm::cos(2.0 * PI * frequency * (i as f64 - middle)))
            .sum();
        // σ is stated to 0.01 px: 0.03 dB.
        assert!((20.0 * libm::log10(amplitude) + 3.0).abs() < 0.05, "{} dB", 20.0 * libm::log10(amplitude));
    }

    #[test]
    fn without_either_there_is_no_filter() {
        assert_eq!(LineFilter::new(None, None), None);
    }
}
