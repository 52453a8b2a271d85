//! Jitter of the line synchronisation: a small independent shift of each line.

use contract::docking::Lines;
use draws::{Effect, Seed, normal};
use optics::pad;
use optics::simd_kernel::arch;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Margin on each side of a line, px, and largest shift, px: eight times the largest standard deviation.
const MARGIN: usize = 10;
const MAX_SHIFT_PX: f64 = 8.0;

/// Shift of each line along itself by a normal random number.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LineJitterConfig {
    /// Standard deviation of the shift, px, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub sigma_px: f64,
}

impl Default for LineJitterConfig {
    fn default() -> Self {
        Self { sigma_px: 0.1 }
    }
}

impl LineJitterConfig {
    /// Shift of a camera row in a field, px, positive to the right.
    pub(super) fn shift_px(&self, seed: &Seed, field: u64, row: usize) -> f64 {
        let mut stream = seed.stream(field, Effect::LineJitter, row as u64);
        (self.sigma_px * normal(&mut stream)).clamp(-MAX_SHIFT_PX, MAX_SHIFT_PX)
    }

    /// Shifts the lines of a field.
    pub(super) fn apply(
        &self,
        seed: &Seed,
        field: u64,
        lines: Lines,
        signal: &mut [f32],
        columns: usize,
        padded: &mut Vec<f32>,
    ) {
        for (k, row) in signal.chunks_exact_mut(columns).enumerate() {
            let shift = self.shift_px(seed, field, lines.camera_row(k));
            pad(row, MARGIN, MARGIN, padded);
            shifted(padded, shift, row);
        }
    }
}

/// Writes the line at x − shift to `out`, by cubic interpolation through four points (Catmull & Rom 1974).
fn shifted(padded: &[f32], shift_px: f64, out: &mut [f32]) {
    let whole = (-shift_px).floor();
    let t = (-shift_px - whole) as f32;
    let weights = [
        0.5 * t * ((2.0 - t) * t - 1.0),
        0.5 * (t * t * (3.0 * t - 5.0) + 2.0),
        0.5 * t * ((4.0 - 3.0 * t) * t + 1.0),
        0.5 * t * t * (t - 1.0),
    ];
    let first = (MARGIN as f64 + whole) as usize - 1;
    let n = out.len();
    let taps = [&padded[first..], &padded[first + 1..], &padded[first + 2..], &padded[first + 3..]]
        .map(|tap| &tap[..n]);
    arch().dispatch(Cubic { weights, taps, out });
}

/// Task of summing four weighted taps along a line.
struct Cubic<'a> {
    weights: [f32; 4],
    taps: [&'a [f32]; 4],
    out: &'a mut [f32],
}

impl pulp::WithSimd for Cubic<'_> {
    type Output = ();

    // Inlined: only then is it compiled for the registers of the machine. The bits of the result do not
    // depend on the registers.
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { weights, taps, out } = self;
        let taps = taps.map(|tap| &tap[..out.len()]);
        for (x, value) in out.iter_mut().enumerate() {
            *value = weights[0] * taps[0][x]
                + weights[1] * taps[1][x]
                + weights[2] * taps[2][x]
                + weights[3] * taps[3][x];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use optics::simd_kernel::registers::same_on_all_registers;

    #[test]
    fn a_line_is_shifted_to_the_right_by_its_shift() {
        for shift in [-7.9, -1.25, -0.1, 0.0, 0.1, 0.5, 3.75, 8.0] {
            let line: Vec<f32> = (0..100).map(|x| 0.01 * x as f32).collect();
            let (mut padded, mut out) = (Vec::new(), line.clone());
            pad(&line, MARGIN, MARGIN, &mut padded);
            shifted(&padded, shift, &mut out);
            for (x, value) in out.iter().enumerate().take(80).skip(20) {
                // The cubic is exact on a straight line; f32 rounding remains.
                assert!((f64::from(*value) - 0.01 * (x as f64 - shift)).abs() < 1e-6, "{shift} {x}");
            }
        }
    }

    #[test]
    fn a_shifted_line_is_the_same_bits_on_all_registers() {
        let padded: Vec<f32> = (0..177_u32).map(|x| libm::sinf((x * x) as f32)).collect();
        same_on_all_registers(|| {
            let mut out = vec![0.0; 150];
            shifted(&padded, -3.3, &mut out);
            out.iter().map(|value: &f32| value.to_bits()).collect::<Vec<_>>()
        });
    }

    #[test]
    fn shifts_are_normal_and_independent_from_line_to_line() {
        let config = LineJitterConfig { sigma_px: 0.2 };
        let seed = Seed { seed: 5, case: 0 };
        let shifts: Vec<f64> = (0..40)
            .flat_map(|field| (0..500).map(move |row| (field, row)))
            .map(|(field, row)| config.shift_px(&seed, field, row) / 0.2)
            .collect();
        let n = shifts.len() as f64;
        let mean = shifts.iter().sum::<f64>() / n;
        let square = shifts.iter().map(|s| s * s).sum::<f64>() / n;
        let next = shifts.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / n;
        // Standard errors 1/√n, √(2/n), 1/√n with n = 20 000; the tolerance is four of them.
        assert!(mean.abs() < 0.029 && next.abs() < 0.029, "{mean} {next}");
        assert!((square - 1.0).abs() < 0.04, "{square}");
    }
}
