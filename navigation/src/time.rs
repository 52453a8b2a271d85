//! Times as seconds since an epoch.

use hifitime::Epoch;

/// Returns the seconds (SI) from `from` to `to`, exact to 0.1 ns within months: computed in TAI, because a
/// difference of UTC would miss leap seconds, and in integer nanoseconds.
pub(crate) fn seconds_between(from: Epoch, to: Epoch) -> f64 {
    let nanoseconds = to.to_tai_duration().total_nanoseconds() - from.to_tai_duration().total_nanoseconds();
    nanoseconds as f64 / 1e9
}
