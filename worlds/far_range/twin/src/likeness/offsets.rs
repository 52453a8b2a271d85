//! Variance of offsets that rows, columns or cells of all frames have.

use super::estimate::Estimate;

/// Returns the variance of offsets, mean over the frames; `offsets` has one list per frame, all equally long.
/// `None` for no frame or fewer than three offsets.
///
/// The variances of the frames are not independent where a pattern is fixed: the covariance of the variances
/// of frames a and b is 2 C²/(n − 1), with the covariance C of their n offsets. Its sum over all pairs gives
/// the error (offsets are assumed to be normal).
pub(crate) fn variance_of_offsets(offsets: &[Vec<f64>]) -> Option<Estimate> {
    let count = offsets.iter().map(Vec::len).min()?;
    if count < 3 {
        return None;
    }
    let centred: Vec<Vec<f64>> = offsets.iter().map(|of_frame| centred(of_frame)).collect();
    let frames = centred.len() as f64;
    let (mut sum, mut squares) = (0.0, 0.0);
    for (index, first) in centred.iter().enumerate() {
        for (other, second) in centred.iter().enumerate() {
            let covariance = covariance(first, second);
            squares += 2.0 * covariance * covariance / (count as f64 - 1.0);
            if index == other {
                sum += covariance;
            }
        }
    }
    Some(Estimate::known(sum / frames, squares.sqrt() / frames))
}

/// Returns the values less their mean.
pub(crate) fn centred(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|value| value - mean).collect()
}

/// Returns the covariance of two lists whose means are 0.
pub(crate) fn covariance(first: &[f64], second: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (a, b) in first.iter().zip(second) {
        sum += a * b;
    }
    sum / (first.len().min(second.len()) as f64 - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fixed_pattern_counts_once() {
        let pattern = vec![1.0, -1.0, 2.0, -2.0, 0.0];
        // Σ x²/(n − 1) = 10/4; error 2.5 √(2/4).
        let one = variance_of_offsets(std::slice::from_ref(&pattern)).unwrap();
        assert!((one.value - 2.5).abs() < 1e-12 && (one.sigma - 2.5 * 0.5_f64.sqrt()).abs() < 1e-12);
        let four =
            variance_of_offsets(&[pattern.clone(), pattern.clone(), pattern.clone(), pattern]).unwrap();
        assert!((four.sigma - one.sigma).abs() < 1e-12);
        // Patterns without covariance: half the error of one for four frames, 1/√2 for two.
        let other = vec![2.0, 2.0, -1.0, -1.0, -2.0];
        let two = variance_of_offsets(&[vec![1.0, -1.0, 2.0, -2.0, 0.0], other]).unwrap();
        assert!(two.sigma < 0.75 * 3.5 * 0.5_f64.sqrt(), "{two:?}");
        assert_eq!(variance_of_offsets(&[]), None);
    }
}
