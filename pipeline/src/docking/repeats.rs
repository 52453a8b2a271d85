//! Detection of fields that are repeated bit for bit: a digitiser or a network may substitute an old field
//! for a lost one.

use std::collections::VecDeque;

use contract::docking::{Field, Lines};

/// Number of fields in memory: a second of television is longer than any buffer that is known to repeat.
const MEMORY: usize = 50;

/// Digests of the last fields.
#[derive(Debug, Clone, Default)]
pub(crate) struct RepeatDetector {
    last: VecDeque<(Lines, u64)>,
}

impl RepeatDetector {
    /// Adds a field. Returns true if an identical field was among the last ones. Because of noise, no two
    /// fields are identical by chance; fields are compared by a 64-bit digest of their pixels.
    pub(crate) fn is_repeated(&mut self, field: &Field) -> bool {
        let seen = (field.lines(), digest(field.image().dn()));
        let is_repeated = self.last.contains(&seen);
        if self.last.len() == MEMORY {
            self.last.pop_front();
        }
        self.last.push_back(seen);
        is_repeated
    }
}

/// Returns the FNV-1a digest (Fowler, Noll & Vo 1991) of the pixels, in four lanes.
fn digest(dn: &[u16]) -> u64 {
    const PRIME: u64 = 0x0000_0100_0000_01B3;
    let mut lanes = [0xCBF2_9CE4_8422_2325_u64, 1, 2, 3];
    let (chunks, rest) = dn.as_chunks::<4>();
    for chunk in chunks {
        for (lane, value) in lanes.iter_mut().zip(chunk) {
            *lane = (*lane ^ u64::from(*value)).wrapping_mul(PRIME);
        }
    }
    lanes
        .iter()
        .copied()
        .chain(rest.iter().map(|value| u64::from(*value)))
        .fold(0, |sum, value| (sum ^ value).rotate_left(23).wrapping_mul(PRIME))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::docking::synthetic;

    #[test]
    fn a_field_that_comes_again_is_recognised_until_it_is_forgotten() {
        let field = |value: u16| synthetic::drawn(Lines::Even, |x, _| if x == 7 { value } else { 20 });
        let mut repeats = RepeatDetector::default();
        assert!(!repeats.is_repeated(&field(0)) && !repeats.is_repeated(&field(1)));
        assert!(repeats.is_repeated(&field(0)));
        assert!((2..52).all(|value| !repeats.is_repeated(&field(value))));
        assert!(!repeats.is_repeated(&field(1)), "forgotten");
    }

    #[test]
    fn one_pixel_or_the_other_parity_makes_another_field() {
        let mut repeats = RepeatDetector::default();
        assert!(!repeats.is_repeated(&synthetic::drawn(Lines::Even, |_, _| 90)));
        assert!(!repeats.is_repeated(&synthetic::drawn(Lines::Odd, |_, _| 90)));
        let one = synthetic::drawn(Lines::Even, |x, y| if (x, y) == (0, 0) { 91 } else { 90 });
        assert!(!repeats.is_repeated(&one));
    }
}
