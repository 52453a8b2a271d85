//! A number that is left out of files when it is 0.

/// Whether a number need not be written: files are as they were before there was such a number.
pub(super) fn is_zero(number: &u64) -> bool {
    *number == 0
}
