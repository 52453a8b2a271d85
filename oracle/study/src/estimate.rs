//! Values of many cases together, with their intervals.

use rand::Rng;
use run::figure_called;
use serde::{Deserialize, Serialize};
use sim::randomness::{Effect, Seed, Stream};
use statistics::wilson;

use super::cases::CaseFigure;

/// Samples of cases drawn with replacement, for the intervals of quantiles and indices.
pub(super) const RESAMPLES: usize = 1000;
/// Fewer cases than this have no quantile interval.
pub(super) const LEAST_CASES: usize = 5;
/// A value with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Lower limit; absent where too few cases are known.
    pub low: Option<f64>,
    /// Upper limit.
    pub high: Option<f64>,
}

/// A figure over all cases together; `place` is that of its draws.
pub fn overall(name: &str, cases: &[CaseFigure], seed: u64, place: u64) -> Option<Estimate> {
    if figure_called(name).is_rate() {
        return rate(cases);
    }
    let values: Vec<f64> = cases.iter().filter_map(|case| case.value).collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    if values.is_empty() {
        return None;
    }
    let interval = (values.len() >= LEAST_CASES).then(|| {
        let mut stream = stream(seed, place);
        let mut means: Vec<f64> = (0..RESAMPLES)
            .map(|_| (0..values.len()).map(|_| values[pick(&mut stream, values.len())]).sum::<f64>())
            .map(|sum| sum / values.len() as f64)
            .collect();
        means.sort_by(f64::total_cmp);
        [sorted_quantile(&means, 0.025), sorted_quantile(&means, 0.975)]
    });
    let value = mean(&values);
    // The mean of few skewed values may lie outside the percentiles of its own resamples.
    Some(Estimate {
        value,
        low: interval.map(|[low, _]| low.min(value)),
        high: interval.map(|[_, high]| high.max(value)),
    })
}

/// A rate over frames that come in cases: Wilson's interval with the number of independent frames that would scatter as the cases
/// do. Cases that are all alike tell nothing of their scatter: they count as one frame each when all or none of their frames
/// count, and in full otherwise.
fn rate(cases: &[CaseFigure]) -> Option<Estimate> {
    let (count, of) = cases.iter().fold((0, 0), |(count, of), case| (count + case.count, of + case.of));
    if of == 0 {
        return None;
    }
    let value = count as f64 / of as f64;
    let counted: Vec<&CaseFigure> = cases.iter().filter(|case| case.of > 0).collect();
    let n = counted.len() as f64;
    let is_single = counted.iter().all(|case| case.of == 1);
    let scatter: f64 = counted
        .iter()
        .map(|case| {
            let off = case.count as f64 - value * case.of as f64;
            off * off
        })
        .sum::<f64>()
        / (of as f64 * of as f64);
    let effective = if is_single || scatter == 0.0 {
        if value == 0.0 || value == 1.0 { n } else { of as f64 }
    } else if n < 2.0 {
        1.0
    } else {
        (value * (1.0 - value) / (scatter * n / (n - 1.0))).clamp(1.0, of as f64)
    };
    let interval = wilson(value, effective);
    Some(Estimate { value, low: interval.map(|i| i.low), high: interval.map(|i| i.high) })
}

pub(super) fn quantiles<const N: usize>(
    sorted: &[f64],
    at: [f64; N],
    stream: &mut Stream,
) -> [Option<Estimate>; N] {
    if sorted.is_empty() {
        return [None; N];
    }
    let mut resampled: [Vec<f64>; N] = std::array::from_fn(|_| Vec::new());
    if sorted.len() >= LEAST_CASES {
        let mut sample = vec![0.0; sorted.len()];
        for _ in 0..RESAMPLES {
            sample.iter_mut().for_each(|value| *value = sorted[pick(stream, sorted.len())]);
            sample.sort_by(f64::total_cmp);
            for (values, p) in resampled.iter_mut().zip(at) {
                values.push(sorted_quantile(&sample, p));
            }
        }
    }
    std::array::from_fn(|i| {
        let values = &mut resampled[i];
        values.sort_by(f64::total_cmp);
        let value = sorted_quantile(sorted, at[i]);
        let limit = |p: f64| (!values.is_empty()).then(|| sorted_quantile(values, p));
        Some(Estimate {
            value,
            low: limit(0.025).map(|low| low.min(value)),
            high: limit(0.975).map(|high| high.max(value)),
        })
    })
}

/// The quantile of sorted values, between two neighbours in proportion (type 7 of Hyndman & Fan 1996).
pub(super) fn sorted_quantile(sorted: &[f64], p: f64) -> f64 {
    let at = p * (sorted.len() - 1) as f64;
    let (below, part) = (at.floor(), at.fract());
    let low = sorted[below as usize];
    let high = sorted[(below as usize + 1).min(sorted.len() - 1)];
    if part == 0.0 { low } else { low + part * (high - low) }
}

pub(super) fn stream(seed: u64, place: u64) -> Stream {
    Seed { seed, case: 0 }.stream(0, Effect::Bootstrap, place)
}

pub(super) fn pick(stream: &mut Stream, count: usize) -> usize {
    // 64 bits over a few million cases: the bias is below 1e-12.
    ((u128::from(stream.next_u64()) * count as u128) >> 64) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use sim::randomness::uniform;

    fn case(count: u64, of: u64) -> CaseFigure {
        CaseFigure { value: (of > 0).then(|| count as f64 / of as f64), count, of }
    }

    #[test]
    fn a_rate_over_single_frames_has_wilsons_interval() {
        let cases: Vec<CaseFigure> = (0..29).map(|k| case(u64::from(k == 3), 1)).collect();
        let got = rate(&cases).unwrap();
        // Newcombe (1998), Table I: 1 of 29.
        assert!(
            (got.low.unwrap() - 0.0061).abs() < 5e-5 && (got.high.unwrap() - 0.1718).abs() < 5e-5,
            "{got:?}"
        );
    }

    /// Frames of a case that go together count as one: the interval holds the truth in 95 % of the studies, where one that takes
    /// frames for independent holds it in few.
    #[test]
    fn the_interval_of_a_rate_knows_that_frames_come_in_cases() {
        let (mut held, studies) = (0, 400);
        for study in 0..studies {
            let mut stream = Seed { seed: 11, case: study }.stream(0, Effect::StudyParameter, 0);
            // Each case has a rate of its own, uniform from 0.6 to 1: the truth is 0.8.
            let cases: Vec<CaseFigure> = (0..60)
                .map(|_| {
                    let p = 0.6 + 0.4 * uniform(&mut stream);
                    case((0..50).filter(|_| uniform(&mut stream) < p).count() as u64, 50)
                })
                .collect();
            let got = rate(&cases).unwrap();
            held += u64::from(got.low.unwrap() <= 0.8 && 0.8 <= got.high.unwrap());
        }
        // Binomial of 400 at 0.95: standard deviation 4.4; four of them below.
        assert!((362..=397).contains(&held), "{held} of {studies}");
    }

    #[test]
    fn a_rate_over_nothing_is_none() {
        assert_eq!(rate(&[]), None);
        assert_eq!(rate(&[case(0, 0)]), None);
    }

    /// The percentile bootstrap of the median of 101 normal numbers holds the truth in about 95 % of the samples.
    #[test]
    fn the_interval_of_a_quantile_holds_its_truth() {
        let (mut held, samples) = (0, 200);
        for sample in 0..samples {
            let mut draws = Seed { seed: 3, case: sample }.stream(0, Effect::StudyParameter, 0);
            let mut values: Vec<f64> = (0..101).map(|_| sim::randomness::normal(&mut draws)).collect();
            values.sort_by(f64::total_cmp);
            let [median] = quantiles(&values, [0.5], &mut stream(9, sample));
            let median = median.unwrap();
            held += u64::from(median.low.unwrap() <= 0.0 && 0.0 <= median.high.unwrap());
        }
        // Binomial of 200 at 0.95: standard deviation 3.1; four of them below.
        assert!((178..=200).contains(&held), "{held} of {samples}");
    }
}
