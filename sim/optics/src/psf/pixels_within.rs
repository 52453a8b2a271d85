//! Range of the pixels that an image reaches.

/// Returns the range of pixels on an axis of `count` pixels whose centres lie within `reach_px` of the
/// interval `span`.
#[inline(always)]
pub(super) fn pixels_within(span: (f64, f64), reach_px: f64, count: usize) -> (usize, usize) {
    let last = count as f64;
    // A float cast saturates, and NaN gives 0: an empty range.
    (
        (span.0 - reach_px).ceil().clamp(0.0, last) as usize,
        (span.1 + reach_px + 1.0).floor().clamp(0.0, last) as usize,
    )
}
