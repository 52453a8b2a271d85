//! Limits of axes that fit most of the values, and a note on the values outside.

/// Part of the values at each end that does not set the limits by itself.
const TAIL: f64 = 0.05;
/// Reach of the axis beyond the values between the tails, in units of their span.
const REACH: f64 = 1.0;
/// Empty part at each end of an axis, in units of its length.
const ROOM: f64 = 0.08;

/// Returns the limits of an axis: those of the values, unless a few outliers are farther from the other
/// values than these are from each other. Outliers are then outside, see [`note_outside`].
pub fn limits(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let mut sorted: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return [-1.0, 1.0] };
    let at = |part: f64| sorted.get((part * last as f64).round() as usize).copied().unwrap_or(0.0);
    let (least, low, high, most) = (at(0.0), at(TAIL), at(1.0 - TAIL), at(1.0));
    let reach = REACH * (high - low);
    // Values that are nearly all equal have no scale: their outliers set it.
    let (low, high) =
        if reach > 0.0 { (least.max(low - reach), most.min(high + reach)) } else { (least, most) };
    let room = (ROOM * (high - low)).max(1e-9);
    [low - room, high + room]
}

/// Returns the number of values outside the axis.
pub fn outside(range: [f64; 2], values: impl Iterator<Item = f64>) -> usize {
    values.filter(|value| *value < range[0] || *value > range[1]).count()
}

/// Returns the sentence of a caption on the values outside the axes; `what` names the values.
pub fn note_outside(count: usize, of: usize, what: &str) -> String {
    match count {
        0 => format!("All {of} {what} are within the axes."),
        _ => format!("{count} of {of} {what} are outside the axes; double-click to zoom out."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outlier_does_not_flatten_the_other_values() {
        let values = || (0..100).map(|i| f64::from(i % 10)).chain([1000.0]);
        let range = limits(values());
        assert!(range[0] < 0.0 && range[1] > 9.0 && range[1] < 25.0, "{range:?}");
        assert_eq!(outside(range, values()), 1);
        assert!(note_outside(1, 101, "errors").starts_with("1 of 101 errors are outside"));
    }

    #[test]
    fn without_outliers_all_values_are_within() {
        let values = || (0..50).map(|i| f64::from(i * i));
        assert_eq!(outside(limits(values()), values()), 0);
        assert_eq!(note_outside(0, 50, "errors"), "All 50 errors are within the axes.");
    }

    #[test]
    fn values_that_are_equal_or_missing_have_an_axis() {
        let range = limits([2.0; 5].into_iter());
        assert!(range[0] < 2.0 && range[1] > 2.0);
        assert_eq!(limits([f64::NAN].into_iter()), [-1.0, 1.0]);
        let range = limits([0.0; 40].into_iter().chain([5.0]));
        assert!(range[1] > 5.0, "{range:?}");
    }
}
