//! Levels that the full wells or the converter cut.

use crate::moments::StackMoments;

/// Share of the samples at an end of the converter from which the cut changes the variance by 1e-3.
pub(crate) const MAX_SHARE_OF_GOOD: f64 = 1e-4;

/// The same before defects are left out, which may lie at the ends.
pub(crate) const MAX_SHARE_OF_ALL: f64 = 0.05;

/// Share of the largest variance below which a brighter level is beyond saturation.
const BEYOND_SHARE: f64 = 0.9;

/// Share of the saturation up to which the photon transfer is used (EMVA 1288: 70 %).
const USED_SHARE: f64 = 0.7;

/// Temporal variance, as a share of that of the photon transfer, below which nearly all pixels are full.
pub(crate) const FULL_SHARE: f64 = 0.2;

/// Use of a stack in the photon transfer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StackState {
    /// Used.
    Used,
    /// Cut at the largest digital number.
    Converter,
    /// Brighter than the level of the largest variance.
    BeyondSaturation,
    /// Above 70 % of the saturation, or with a variance that a partial cut lowers.
    NearSaturation,
    /// Cut at 0.
    AtZero,
}

impl StackState {
    /// Words for a table.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Used => "used",
            Self::Converter => "cut by the converter",
            Self::BeyondSaturation => "beyond saturation",
            Self::NearSaturation => "near saturation",
            Self::AtZero => "cut at 0",
        }
    }
}

/// Number of bits whose largest number a digital number is, if any from 8 to 16.
pub(crate) fn bits_of_full_scale(dn: u16) -> Option<u8> {
    (8..=16).find(|bits| u32::from(dn) == (1_u32 << bits) - 1)
}

/// Returns the use of each level of light; `bias` is the mean without light, `top` the largest number of all
/// stacks, and `max_share` the largest share of samples at an end of the converter.
pub(crate) fn states_of_levels(
    levels: &[(f64, &StackMoments)],
    bias: f64,
    top: u16,
    max_share: f64,
) -> Vec<StackState> {
    let is_cut =
        |moments: &StackMoments| moments.share_at_top > max_share && bits_of_full_scale(top).is_some();
    let mut states: Vec<StackState> = levels
        .iter()
        .map(|(_, moments)| match moments {
            moments if is_cut(moments) => StackState::Converter,
            moments if moments.share_at_zero > max_share => StackState::AtZero,
            _ => StackState::Used,
        })
        .collect();
    let uncut = levels.iter().zip(&states).filter(|(_, state)| **state == StackState::Used);
    let Some(((exposure, largest), _)) = uncut.max_by(|a, b| a.0.1.pixel[0].total_cmp(&b.0.1.pixel[0]))
    else {
        return states;
    };
    let limit = bias + USED_SHARE * (largest.mean - bias);
    let mut is_well_seen = false;
    for ((x, moments), state) in levels.iter().zip(&mut states) {
        let is_beyond = x > exposure && moments.pixel[0] < BEYOND_SHARE * largest.pixel[0];
        if *state == StackState::Used && is_beyond {
            *state = StackState::BeyondSaturation;
            is_well_seen = true;
        }
    }
    if is_well_seen {
        let below = |moments: &StackMoments| moments.mean <= limit;
        let rest = levels.iter().zip(&states).filter(|((_, m), s)| **s == StackState::Used && below(m));
        // With a single level below 70 %, the others below the largest variance are kept.
        let keep_low = rest.count() >= 2;
        for ((x, moments), state) in levels.iter().zip(&mut states) {
            let is_near = if keep_low { !below(moments) } else { x >= exposure };
            if *state == StackState::Used && is_near {
                *state = StackState::NearSaturation;
            }
        }
    }
    states
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(mean: f64, variance: f64, share_at_top: f64) -> StackMoments {
        StackMoments {
            frames: 2,
            mean,
            mean_sigma: 0.01,
            pixel: [variance, 0.01 * variance],
            row: [0.0, 1.0],
            column: [0.0, 1.0],
            total: [variance, 0.01 * variance],
            frame_mean: [0.0, 0.0],
            share_at_top,
            share_at_zero: 0.0,
        }
    }

    fn states(levels: &[StackMoments], top: u16) -> Vec<StackState> {
        let levels: Vec<(f64, &StackMoments)> =
            levels.iter().enumerate().map(|(index, level)| (1.0 + index as f64, level)).collect();
        states_of_levels(&levels, 100.0, top, MAX_SHARE_OF_GOOD)
    }

    #[test]
    fn levels_at_the_end_of_the_converter_are_left_out() {
        let levels = [moments(1000.0, 300.0, 0.0), moments(3000.0, 900.0, 0.0), moments(4090.0, 20.0, 0.4)];
        assert_eq!(states(&levels, 4095), [StackState::Used, StackState::Used, StackState::Converter]);
    }

    #[test]
    fn full_wells_show_by_the_variance() {
        let levels = [
            moments(500.0, 130.0, 0.0),
            moments(1000.0, 300.0, 0.0),
            moments(1800.0, 560.0, 0.0),
            moments(2000.0, 20.0, 0.001),
        ];
        use StackState::{BeyondSaturation, NearSaturation, Used};
        assert_eq!(states(&levels, 2030), [Used, Used, NearSaturation, BeyondSaturation]);
    }

    #[test]
    fn full_scales_are_those_of_whole_bits() {
        assert_eq!(bits_of_full_scale(255), Some(8));
        assert_eq!(bits_of_full_scale(65_535), Some(16));
        assert_eq!(bits_of_full_scale(4000), None);
    }
}
