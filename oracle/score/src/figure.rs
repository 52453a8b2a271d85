//! A figure with its interval, and notes on figures.
use serde::{Deserialize, Serialize};
use statistics::{
    Interval, below_median, effective_size, mean_interval, median, median_interval, rms_interval, wilson,
};

/// One figure, with the number of values it was computed from and its 95 % interval. No number is ever NaN:
/// an undefined one is `None` (null).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// Value; `None` if there is nothing to count.
    pub value: Option<f64>,
    /// Numerator of a rate, whose value is `count`/`of`; equal to `of` in other figures.
    pub count: u64,
    /// Number of values that the figure is computed from.
    pub of: u64,
    /// Effective number of independent values (see [`effective_size`]); 0 when `of` is 0.
    pub effective: f64,
    /// Lower limit of the 95 % interval.
    pub low: Option<f64>,
    /// Upper limit of the 95 % interval.
    pub high: Option<f64>,
    /// Limit, degrees, of a rate of errors "within" a limit; absent in other figures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit_deg: Option<f64>,
}

impl Figure {
    /// Computes a rate. Each inner list is one sequence in order of time.
    pub fn rate(sequences: &[Vec<bool>]) -> Self {
        let numbers: Vec<Vec<f64>> = sequences
            .iter()
            .map(|sequence| sequence.iter().map(|&b| f64::from(u8::from(b))).collect())
            .collect();
        let of = sequences.iter().map(Vec::len).sum::<usize>() as u64;
        let count = sequences.iter().flatten().filter(|&&b| b).count() as u64;
        let value = (of > 0).then(|| count as f64 / of as f64);
        let effective = effective_size(&numbers);
        Self::new(value, count, of, effective, value.and_then(|rate| wilson(rate, effective)))
    }

    /// Computes a mean. Each inner list is one sequence of finite values in order of time.
    pub fn mean(sequences: &[Vec<f64>]) -> Self {
        Self::location(sequences, effective_size(sequences), mean, mean_interval)
    }

    /// Computes a root mean square of sequences as in [`Figure::mean`].
    pub fn rms(sequences: &[Vec<f64>]) -> Self {
        let squares: Vec<Vec<f64>> =
            sequences.iter().map(|sequence| sequence.iter().map(|x| x * x).collect()).collect();
        let rms = |_: &[Vec<f64>]| mean(&squares).map(f64::sqrt);
        Self::location(sequences, effective_size(&squares), rms, rms_interval)
    }

    /// Computes a median of sequences as in [`Figure::mean`].
    pub fn median(sequences: &[Vec<f64>]) -> Self {
        Self::location(sequences, effective_size(&below_median(sequences)), median, median_interval)
    }

    fn location(
        sequences: &[Vec<f64>],
        effective: f64,
        value: impl Fn(&[Vec<f64>]) -> Option<f64>,
        interval: impl Fn(&[Vec<f64>]) -> Option<Interval>,
    ) -> Self {
        let of = sequences.iter().map(Vec::len).sum::<usize>() as u64;
        Self::new(value(sequences), of, of, effective, interval(sequences))
    }

    fn new(value: Option<f64>, count: u64, of: u64, effective: f64, interval: Option<Interval>) -> Self {
        Self {
            value,
            count,
            of,
            effective,
            low: interval.map(|interval| interval.low),
            high: interval.map(|interval| interval.high),
            limit_deg: None,
        }
    }
}

fn mean(sequences: &[Vec<f64>]) -> Option<f64> {
    let n = sequences.iter().map(Vec::len).sum::<usize>();
    (n > 0).then(|| sequences.iter().flatten().sum::<f64>() / n as f64)
}

/// Returns a note for the reader about the frames that the figures leave out; `None` if there are none.
/// `images` is "frames" or "fields".
pub fn warm_up_note(frames: u64, images: &str) -> Option<String> {
    (frames > 0).then(|| {
        format!(
            "The first {frames} {images} are the warm-up: group `warm-up`, excluded from all other figures."
        )
    })
}

/// Returns true for 0, which is left out of files; files in which the number is 0 are thus the same as before
/// the number was introduced.
pub fn is_zero(number: &u64) -> bool {
    *number == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_sane(figure: &Figure) {
        let finite = |v: Option<f64>| v.is_none_or(f64::is_finite);
        assert!(
            finite(figure.value) && finite(figure.low) && finite(figure.high) && figure.effective.is_finite()
        );
        if let (Some(value), Some(low), Some(high)) = (figure.value, figure.low, figure.high) {
            assert!(low <= value && value <= high, "{figure:?}");
        }
        assert!(figure.effective <= figure.of as f64);
    }

    #[test]
    fn a_figure_over_nothing_is_null_and_not_nan() {
        for figure in [
            Figure::rate(&[]),
            Figure::rate(&[vec![], vec![]]),
            Figure::mean(&[]),
            Figure::rms(&[vec![]]),
            Figure::median(&[]),
        ] {
            is_sane(&figure);
            assert_eq!((figure.value, figure.count, figure.of, figure.low), (None, 0, 0, None));
        }
        assert_eq!(
            serde_json::to_string(&Figure::rate(&[])).unwrap(),
            r#"{"value":null,"count":0,"of":0,"effective":0.0,"low":null,"high":null}"#
        );
    }

    #[test]
    fn all_hits_and_all_misses_have_one_sided_doubt() {
        let hits = Figure::rate(&[vec![true; 10]]);
        assert_eq!((hits.value, hits.high), (Some(1.0), Some(1.0)));
        assert!((hits.low.unwrap() - 0.7225).abs() < 1e-4);
        let misses = Figure::rate(&[vec![false; 10]]);
        assert_eq!((misses.value, misses.low), (Some(0.0), Some(0.0)));
        assert!((misses.high.unwrap() - 0.2775).abs() < 1e-4);
    }

    #[test]
    fn figures_of_short_series_are_sane() {
        for n in 1..6 {
            for bits in 0..1u32 << n {
                let series: Vec<bool> = (0..n).map(|i| bits >> i & 1 == 1).collect();
                let numbers: Vec<f64> = series.iter().map(|&b| if b { -0.02 } else { 0.5 }).collect();
                is_sane(&Figure::rate(&[series]));
                for figure in
                    [Figure::mean, Figure::rms, Figure::median].map(|f| f(std::slice::from_ref(&numbers)))
                {
                    is_sane(&figure);
                }
            }
        }
    }

    /// The effective size of a median follows from whether each value is below the median, not from its
    /// distance to the median.
    #[test]
    fn a_median_has_an_effective_number_of_its_own() {
        let series = [vec![0.0, 1.0, 2.0, 3.0, 4.0, 3.0, 5.0, 5.0, 5.0, 3.0, 9.0, 5.0, 5.0, 6.0, 8.0, 5.0]];
        let figure = Figure::median(&series);
        // Computed independently of this code: see `values_at_the_median_are_not_below_it`.
        assert!((figure.effective - 4.287).abs() < 5e-4, "{figure:?}");
        assert!((figure.effective - Figure::mean(&series).effective).abs() > 0.1);
    }

    #[test]
    fn root_mean_square_of_three_four_is_its_own_definition() {
        let figure = Figure::rms(&[vec![3.0], vec![-4.0]]);
        assert!((figure.value.unwrap() - 12.5f64.sqrt()).abs() < 1e-15);
        assert_eq!(figure.of, 2);
    }
}
