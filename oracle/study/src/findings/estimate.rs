//! Estimates over many cases, with their intervals.

use draws::{Effect, Seed, Stream};
use rand::Rng;
use run::figure_by_name;
use serde::{Deserialize, Serialize};
use statistics::{
    ClusterSum, ClusterValue, Interval, cluster_mean_interval, cluster_quantile_interval,
    cluster_rate_interval, clusters_needed,
};

use crate::cases::CaseFigure;

/// Number of samples of blocks, drawn with replacement, for the intervals of Sobol indices.
pub(crate) const RESAMPLES: usize = 1000;
/// Estimated value with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Estimated value.
    pub value: f64,
    /// Lower limit; absent if there are too few cases.
    pub low: Option<f64>,
    /// Upper limit; absent if there are too few cases.
    pub high: Option<f64>,
}

impl Estimate {
    /// Creates an estimate, whose interval is extended to contain the value: the interval of a quantile
    /// between two cases may exclude it.
    pub(crate) fn new(value: f64, interval: Option<Interval>) -> Self {
        let (low, high) = (interval.map(|i| i.low.min(value)), interval.map(|i| i.high.max(value)));
        Self { value, low, high }
    }
}

/// Estimates a figure over all cases together; `draws` are the numbers of their draws ([`CaseTable::draws`]):
/// only cases of different draws are independent.
///
/// [`CaseTable::draws`]: crate::CaseTable::draws
pub fn overall(name: &str, cases: &[CaseFigure], draws: &[usize]) -> Option<Estimate> {
    if figure_by_name(name).is_rate() {
        return share(cases, draws);
    }
    let sums = sums(false, cases, draws);
    Some(Estimate::new(ratio(&sums)?, cluster_mean_interval(&sums)))
}

/// Estimates a rate over the frames of all cases together.
pub(crate) fn share(cases: &[CaseFigure], draws: &[usize]) -> Option<Estimate> {
    let sums = sums(true, cases, draws);
    Some(Estimate::new(ratio(&sums)?, cluster_rate_interval(&sums)))
}

/// Returns the number of draws from which the scatter of a rate is known, if there are fewer; `None` for
/// another figure.
pub(crate) fn draws_needed(name: &str, cases: &[CaseFigure], draws: &[usize]) -> Option<u64> {
    if figure_by_name(name).is_rate() { clusters_needed(&sums(true, cases, draws)) } else { None }
}

pub(crate) fn ratio(sums: &[ClusterSum]) -> Option<f64> {
    let (sum, of) = sums.iter().fold((0.0, 0.0), |(sum, of), draw| (sum + draw.sum, of + draw.count));
    (of > 0.0).then(|| sum / of)
}

/// Returns the contribution of each draw to a figure: the counted frames for a rate, the values of the draw's
/// cases for another figure.
pub(crate) fn sums(is_rate: bool, cases: &[CaseFigure], draws: &[usize]) -> Vec<ClusterSum> {
    let mut sums = vec![ClusterSum::default(); draws.iter().map(|draw| draw + 1).max().unwrap_or_default()];
    for (case, draw) in cases.iter().zip(draws) {
        let sum = &mut sums[*draw];
        if is_rate {
            sum.sum += case.count as f64;
            sum.count += case.of as f64;
        } else if let Some(value) = case.value {
            sum.sum += value;
            sum.count += 1.0;
        }
    }
    sums
}

/// Estimates quantiles of the cases; without an interval if there are too few cases.
pub(crate) fn quantiles<const N: usize>(
    cases: &[CaseFigure],
    draws: &[usize],
    at: [f64; N],
) -> [Option<Estimate>; N] {
    let mut sorted: Vec<ClusterValue> =
        cases.iter().zip(draws).filter_map(|(case, draw)| Some((*draw, case.value?))).collect();
    sorted.sort_by(|a, b| a.1.total_cmp(&b.1));
    let values: Vec<f64> = sorted.iter().map(|(_, value)| *value).collect();
    at.map(|p| {
        let value = (!values.is_empty()).then(|| sorted_quantile(&values, p))?;
        Some(Estimate::new(value, cluster_quantile_interval(&sorted, p)))
    })
}

/// Returns the quantile of sorted values, interpolated linearly between neighbours (type 7 of Hyndman & Fan
/// 1996).
pub(crate) fn sorted_quantile(sorted: &[f64], p: f64) -> f64 {
    let at = p * (sorted.len() - 1) as f64;
    let (below, part) = (at.floor(), at.fract());
    let low = sorted[below as usize];
    let high = sorted[(below as usize + 1).min(sorted.len() - 1)];
    if part == 0.0 { low } else { low + part * (high - low) }
}

pub(crate) fn stream(seed: u64, place: u64) -> Stream {
    Seed { seed, case: 0 }.stream(0, Effect::Bootstrap, place)
}

pub(crate) fn pick(stream: &mut Stream, count: usize) -> usize {
    // With 64 bits and a few million cases, the bias is below 1e-12.
    ((u128::from(stream.next_u64()) * count as u128) >> 64) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(count: u64, of: u64) -> CaseFigure {
        CaseFigure { value: (of > 0).then(|| count as f64 / of as f64), count, of }
    }

    #[test]
    fn a_rate_over_single_frames_has_wilsons_interval() {
        let cases: Vec<CaseFigure> = (0..29).map(|k| case(u64::from(k == 3), 1)).collect();
        let draws: Vec<usize> = (0..29).collect();
        crate::figures_of_tests::register();
        let got = overall("hit_rate", &cases, &draws).unwrap();
        // Newcombe (1998), Table I: 1 of 29.
        assert!(
            (got.low.unwrap() - 0.0061).abs() < 5e-5 && (got.high.unwrap() - 0.1718).abs() < 5e-5,
            "{got:?}"
        );
    }

    #[test]
    fn a_figure_over_nothing_is_none() {
        for name in ["hit_rate", "ra_rms_deg"] {
            assert_eq!(overall(name, &[], &[]), None);
            assert_eq!(overall(name, &[case(0, 0)], &[0]), None);
        }
        assert_eq!(quantiles(&[case(0, 0)], &[0], [0.5]), [None]);
    }

    /// Four points of a sweep are not four times as many independent cases.
    #[test]
    fn cases_of_one_draw_count_as_one() {
        let value = |k: usize| CaseFigure { value: Some((k * 7 % 41) as f64), count: 0, of: 1 };
        let single: Vec<CaseFigure> = (0..41).map(value).collect();
        let swept: Vec<CaseFigure> = single.iter().flat_map(|case| [*case; 4]).collect();
        let (draws, of_swept): (Vec<usize>, Vec<usize>) =
            ((0..41).collect(), (0..41).flat_map(|draw| [draw; 4]).collect());
        let once = overall("ra_rms_deg", &single, &draws).unwrap();
        let four = overall("ra_rms_deg", &swept, &of_swept).unwrap();
        assert_eq!(once, four);
        // Quantile intervals of the 41 single cases and of the swept cases have about the same width.
        let width = |estimate: &Option<Estimate>| estimate.and_then(|e| Some(e.high? - e.low?)).unwrap();
        let [once] = quantiles(&single, &draws, [0.5]);
        let [four] = quantiles(&swept, &of_swept, [0.5]);
        assert!((width(&four) / width(&once) - 1.0).abs() < 0.15, "{once:?} {four:?}");
    }

    #[test]
    fn few_cases_have_quantiles_without_an_interval() {
        let cases: Vec<CaseFigure> =
            (0..40).map(|k| CaseFigure { value: Some(f64::from(k)), count: 0, of: 1 }).collect();
        let draws: Vec<usize> = (0..40).collect();
        let [p05, median] = quantiles(&cases, &draws, [0.05, 0.5]).map(Option::unwrap);
        assert!((p05.value - 1.95).abs() < 1e-12 && p05.low.is_none() && p05.high.is_none(), "{p05:?}");
        // The 14th and the 27th of 40 values are the limits of the exact test at 95 %; interpolation widens
        // them by a fraction.
        let (low, high) = (median.low.unwrap(), median.high.unwrap());
        assert!((12.5..14.0).contains(&low) && (25.0..26.5).contains(&high), "{median:?}");
    }
}
