//! Axis limits that leave out the largest outliers, and a note on them.

/// Returns the number of values outside the axis.
pub(super) fn outside(range: [f64; 2], values: impl Iterator<Item = f64>) -> usize {
    values.filter(|value| *value < range[0] || *value > range[1]).count()
}

/// Returns the sentence of a caption on the errors outside the axes.
pub(super) fn note_outside(count: usize, of: usize) -> String {
    match count {
        0 => format!("All {of} errors are within the axes."),
        _ => format!("{count} of {of} errors are outside the axes; double-click to zoom out."),
    }
}

/// Returns the limits of an axis that shows all values except the most extreme hundredth.
pub(super) fn limits(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let mut sorted: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return [-1.0, 1.0] };
    let (low, high) = (sorted[last / 200], sorted[last - last / 200]);
    let room = (0.08 * (high - low)).max(1e-9);
    [low - room, high + room]
}
