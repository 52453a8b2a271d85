//! What was run, and what came of each unit: of a result or of a baseline.

use super::identity::Identity;
use crate::score::{Reduction, UnitTable};

/// A result or a baseline: what was run, and what came of each unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// What was run.
    pub identity: Identity,
    /// What came of it.
    pub table: UnitTable,
}

impl Sample {
    /// A sample, its terms rounded as baselines keep them: what did not change differs by nothing.
    pub fn new(identity: Identity, mut table: UnitTable) -> Self {
        for figure in &mut table.figures {
            let is_rate = figure.reduction == Reduction::Rate;
            for term in figure.terms.iter_mut().filter(|_| !is_rate) {
                term.sum = f64::from(rounded(term.sum as f32));
            }
        }
        Self { identity, table }
    }
}

/// To twelve binary digits, four decimal ones: forty times finer than the tolerance of an amount, and half as long in a file.
fn rounded(value: f32) -> f32 {
    const DROPPED: u32 = 12;
    let bits = value.to_bits();
    // Half of the last digit kept is added, and what is below it cut off; a carry into the exponent is the next power of two.
    let up = bits.saturating_add(1 << (DROPPED - 1)) >> DROPPED << DROPPED;
    let rounded = f32::from_bits(up);
    if rounded.is_finite() { rounded } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_keeps_twelve_binary_digits_and_whole_numbers_below_that() {
        for value in [0.0_f32, 1.0, -22.0, 4095.0, 0.013_9, -1.7e-5, 3.4e38, 1e-40] {
            let kept = rounded(value);
            assert!((kept - value).abs() <= value.abs() / 4096.0 + f32::MIN_POSITIVE, "{value}: {kept}");
            assert_eq!(rounded(kept), kept, "once is enough");
        }
        assert_eq!([0.0, 1.0, -22.0, 4095.0].map(rounded), [0.0, 1.0, -22.0, 4095.0]);
    }
}
