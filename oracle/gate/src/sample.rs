//! Identity and unit table of a result or a baseline.
use score::{Reduction, UnitTable};

use crate::identity::Identity;

/// A result or a baseline: its identity and the results of its units.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Identity of the run or study.
    pub identity: Identity,
    /// Verdicts and figures, unit by unit.
    pub table: UnitTable,
}

impl Sample {
    /// Creates a sample with its terms rounded as in a baseline file, so that unchanged values differ by
    /// exactly zero.
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

/// Rounds to twelve binary digits (four decimal digits). This is forty times finer than the tolerance of an
/// amount, and takes half the space in a file.
fn rounded(value: f32) -> f32 {
    const DROPPED_BITS: u32 = 12;
    let bits = value.to_bits();
    // Adds half of the last kept digit and truncates the digits below. A carry into the exponent gives the
    // next power of two.
    let up = bits.saturating_add(1 << (DROPPED_BITS - 1)) >> DROPPED_BITS << DROPPED_BITS;
    let rounded = f32::from_bits(up);
    if rounded.is_finite() { rounded } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand_made::{figure, identity};

    /// For numbers from 1 to 2 the last kept digit is 2⁻¹¹.
    #[test]
    fn rounding_is_to_the_nearest_stored_number() {
        let digit = 1.0 / 2048.0_f32;
        for (digits, kept) in
            [(0.0, 0.0), (0.25, 0.0), (0.75, 1.0), (1.25, 1.0), (1.75, 2.0), (2047.75, 2048.0)]
        {
            assert_eq!(rounded(1.0 + digits * digit), 1.0 + kept * digit, "{digits} digits");
            assert_eq!(rounded(-1.0 - digits * digit), -1.0 - kept * digit, "{digits} digits");
        }
        // Rounded up, the value would be the next power of two, which is infinite.
        assert_eq!(rounded(f32::MAX), f32::MAX);
    }

    #[test]
    fn amounts_are_rounded_and_counts_are_not() {
        let values = [Some(1.0 + 1.0 / 8192.0), Some(4097.0), None];
        let rate = figure("dec_within_1px", Reduction::Rate, &values);
        let amount = figure("ra_rms_deg", Reduction::Rms, &values);
        let table = UnitTable { units: Vec::new(), figures: vec![rate.clone(), amount] };
        let sample = Sample::new(identity(), table);
        assert_eq!(sample.table.figures[0], rate);
        // 4097 is halfway between two representable numbers and is rounded away from zero.
        let kept = figure("ra_rms_deg", Reduction::Rms, &[Some(1.0), Some(4098.0), None]);
        assert_eq!(sample.table.figures[1], kept);
    }

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
