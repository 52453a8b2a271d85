//! Intervals of means, root mean squares and medians.
//!
//! They use the normal distribution with the effective size, which is accurate from about twenty effective
//! values on and too narrow below.

use super::{Interval, Z_95, effective_size, wilson};

/// Computes the interval of a mean: mean ± z s/√n_eff, with s² the sample variance. Sequences as in
/// [`effective_size`]. `None` for fewer than two values.
pub fn mean_interval(sequences: &[Vec<f64>]) -> Option<Interval> {
    let n = sequences.iter().map(Vec::len).sum::<usize>();
    if n < 2 {
        return None;
    }
    let mean = sequences.iter().flatten().sum::<f64>() / n as f64;
    let variance =
        sequences.iter().flatten().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n as f64 - 1.0);
    let half = Z_95 * (variance / effective_size(sequences)).sqrt();
    Some(Interval { low: mean - half, high: mean + half })
}

/// Computes the interval of a root mean square: the root of the interval of the mean square, its lower limit
/// at least 0. `None` for fewer than two values.
pub fn rms_interval(sequences: &[Vec<f64>]) -> Option<Interval> {
    let squares: Vec<Vec<f64>> =
        sequences.iter().map(|sequence| sequence.iter().map(|x| x * x).collect()).collect();
    let interval = mean_interval(&squares)?;
    Some(Interval { low: interval.low.max(0.0).sqrt(), high: interval.high.max(0.0).sqrt() })
}

/// Returns the median; for an even number of values the mean of the middle two. `None` without any value.
pub fn median(sequences: &[Vec<f64>]) -> Option<f64> {
    let sorted = sorted(sequences);
    let upper = *sorted.get(sorted.len() / 2)?;
    Some(if sorted.len() % 2 == 1 { upper } else { f64::midpoint(sorted[sorted.len() / 2 - 1], upper) })
}

/// Computes the interval of a median: the values at the ranks given by the interval of the rate ½, with the
/// effective size of the flags "below the median". Makes no assumption about the distribution of the values.
/// `None` for fewer than three values: the median lies between two values only half of the time, regardless
/// of their scatter.
pub fn median_interval(sequences: &[Vec<f64>]) -> Option<Interval> {
    if sequences.iter().map(Vec::len).sum::<usize>() < 3 {
        return None;
    }
    let ranks = wilson(0.5, effective_size(&below_median(sequences)))?;
    let sorted = sorted(sequences);
    // Both bounds of the rate ½ lie strictly between 0 and 1, where a value exists.
    let at = |share: f64| sorted.get((share * sorted.len() as f64) as usize).copied();
    Some(Interval { low: at(ranks.low)?, high: at(ranks.high)? })
}

/// Returns 1 for each value below the median and 0 for each other one: the series whose effective size the
/// median uses.
pub fn below_median(sequences: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let below = |median: f64| {
        let of = |sequence: &Vec<f64>| sequence.iter().map(|x| f64::from(u8::from(*x < median))).collect();
        sequences.iter().map(of).collect()
    };
    median(sequences).map_or_else(Vec::new, below)
}

fn sorted(sequences: &[Vec<f64>]) -> Vec<f64> {
    let mut all = sequences.concat();
    all.sort_by(f64::total_cmp);
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use draws::{Effect, Seed, normal};

    /// Two short series whose effective size is 17.201 of 20; the intervals were computed independently of
    /// this code.
    #[test]
    fn intervals_of_short_series_are_those_of_their_definitions() {
        let series = [
            vec![5.0, 6.0, 8.0, 7.0, 9.0, 4.0, 3.0, 5.0, 4.0, 2.0, 3.0, 6.0],
            vec![1.0, 2.0, 2.0, 4.0, 3.0, 3.0, 1.0, 0.0],
        ];
        for (interval, low, high) in [
            (mean_interval(&series), 2.763_956_261_526_683, 5.036_043_738_473_317),
            (rms_interval(&series), 3.061_350_299_818_731, 5.659_340_451_130_305),
            // Values number 5 and 14, counted from 0, of 0 1 1 2 2 2 3 3 3 3 4 4 4 5 5 6 6 7 8 9.
            (median_interval(&series), 2.0, 5.0),
        ] {
            let met = interval.unwrap();
            assert!((met.low - low).abs() < 1e-9 && (met.high - high).abs() < 1e-9, "{met:?}");
        }
        assert!(mean_interval(&[vec![1.0]]).is_none() && mean_interval(&[vec![1.0], vec![3.0]]).is_some());
    }

    /// Seven of sixteen values equal the median, 5. The flags "below the median" have an effective size of
    /// 4.287 and the interval is 2 to 6; the flags "above", "at" or "not above the median" have one of 9 or
    /// more and would give 3 to 5. Computed independently of this code.
    #[test]
    fn values_at_the_median_are_not_below_it() {
        let series = [vec![0.0, 1.0, 2.0, 3.0, 4.0, 3.0, 5.0, 5.0, 5.0, 3.0, 9.0, 5.0, 5.0, 6.0, 8.0, 5.0]];
        assert_eq!(median_interval(&series), Some(Interval { low: 2.0, high: 6.0 }));
    }

    /// Returns the fraction of 500 series (autoregressions with ρ = 0.7, mean 1, standard deviation 2) whose
    /// interval contains `truth`.
    fn coverage(truth: f64, interval: impl Fn(&[Vec<f64>]) -> Option<Interval>) -> f64 {
        let trials = 500;
        let covered = (0..trials)
            .filter(|&trial| {
                let random = &mut Seed { seed: 7, case: 0 }.stream(trial, Effect::PixelNoise, 0);
                let rho: f64 = 0.7;
                let mut x = normal(random);
                let series = (0..2000)
                    .map(|_| {
                        x = rho * x + (1.0 - rho * rho).sqrt() * normal(random);
                        1.0 + 2.0 * x
                    })
                    .collect();
                let interval = interval(&[series]).unwrap();
                (interval.low..=interval.high).contains(&truth)
            })
            .count();
        covered as f64 / trials as f64
    }

    #[test]
    fn the_nominal_intervals_of_correlated_errors_cover_the_truth() {
        // 95 % nominal; the standard deviation of the fraction is 1 %.
        for (name, coverage) in [
            ("mean", coverage(1.0, mean_interval)),
            ("rms", coverage(5f64.sqrt(), rms_interval)),
            ("median", coverage(1.0, median_interval)),
        ] {
            assert!((0.90..=0.99).contains(&coverage), "{name}: {coverage}");
        }
    }

    #[test]
    fn one_value_has_a_median_and_no_interval_of_its_mean() {
        let one = [vec![3.0]];
        assert_eq!(mean_interval(&one), None);
        assert_eq!(rms_interval(&one), None);
        assert_eq!(median(&one), Some(3.0));
        assert_eq!(median_interval(&one), None);
        assert_eq!(median_interval(&[vec![3.0], vec![4.0]]), None);
        assert!(median_interval(&[vec![3.0, 5.0], vec![4.0]]).is_some());
        assert_eq!(median(&[]), None);
        assert_eq!(median_interval(&[]), None);
    }

    #[test]
    fn the_median_of_an_even_number_lies_in_the_middle() {
        assert_eq!(median(&[vec![4.0, 1.0], vec![2.0, 100.0]]), Some(3.0));
    }

    #[test]
    fn equal_values_leave_no_doubt() {
        let equal = [vec![0.5; 30]];
        assert_eq!(mean_interval(&equal), Some(Interval { low: 0.5, high: 0.5 }));
        assert_eq!(median_interval(&equal), Some(Interval { low: 0.5, high: 0.5 }));
    }
}
