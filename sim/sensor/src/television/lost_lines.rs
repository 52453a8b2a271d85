//! Lines lost in transmission: replaced by snow or by the preceding line.

use contract::docking::Lines;
use draws::{Effect, Seed, uniform};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Loss of lines; half of the lost lines show snow, the other half the preceding line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LostLinesConfig {
    /// Probability that a line is lost, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub probability: f64,
}

impl Default for LostLinesConfig {
    fn default() -> Self {
        Self { probability: 0.002 }
    }
}

impl LostLinesConfig {
    /// Replaces the lost lines of a field and returns their number.
    pub(super) fn apply(
        &self,
        seed: &Seed,
        field: u64,
        lines: Lines,
        signal: &mut [f32],
        columns: usize,
    ) -> u32 {
        let streams = seed.streams(field, Effect::LostLines);
        let mut lost = 0;
        for k in 0..signal.len() / columns {
            let mut stream = streams.stream_at(lines.camera_row(k) as u64);
            if uniform(&mut stream) >= self.probability {
                continue;
            }
            lost += 1;
            let (above, row) = signal.split_at_mut(k * columns);
            let row = &mut row[..columns];
            // The first line of a field has no preceding line.
            if uniform(&mut stream) < 0.5 && k > 0 {
                row.copy_from_slice(&above[(k - 1) * columns..]);
            } else {
                row.fill_with(|| uniform(&mut stream) as f32);
            }
        }
        lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEED: Seed = Seed { seed: 9, case: 0 };

    #[test]
    fn lines_are_lost_at_their_rate_and_half_of_them_to_snow() {
        let config = LostLinesConfig { probability: 0.1 };
        let (columns, rows) = (8, 288);
        let (mut lost, mut snow) = (0_u32, 0_u32);
        let fields = 100;
        for field in 0..fields {
            // Each line has a different level, so a repeated line can be recognised.
            let mut signal: Vec<f32> = (0..rows * columns).map(|i| (i / columns + 2) as f32).collect();
            let said = config.apply(&SEED, field, Lines::Even, &mut signal, columns);
            let changed =
                signal.chunks_exact(columns).enumerate().filter(|(k, row)| row[0] != (k + 2) as f32).count();
            assert_eq!(changed as u32, said);
            lost += said;
            snow += signal.chunks_exact(columns).filter(|row| row[0] < 1.0).count() as u32;
        }
        // Binomial, n = 28 800: σ = 51, and √(2880)/2 = 27; the tolerance is four of them (a repeated line
        // that repeats snow counts as snow: 5 % of the repeated lines, 72 expected).
        assert!((f64::from(lost) - 2880.0).abs() < 204.0, "{lost}");
        assert!((f64::from(snow) - 1440.0 - 72.0).abs() < 4.0 * 27.0 + 34.0, "{snow}");
    }

    #[test]
    fn no_line_is_lost_at_probability_0_and_all_at_1() {
        let mut signal = vec![3.0_f32; 80];
        let none = LostLinesConfig { probability: 0.0 };
        assert_eq!(none.apply(&SEED, 1, Lines::All, &mut signal, 8), 0);
        assert!(signal.iter().all(|s| *s == 3.0));
        assert_eq!(LostLinesConfig { probability: 1.0 }.apply(&SEED, 1, Lines::All, &mut signal, 8), 10);
    }
}
