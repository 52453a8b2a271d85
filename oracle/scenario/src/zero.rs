//! Numbers that are omitted from files when they are 0.

/// Returns true if a number is omitted from files, which are then the same as before the number existed.
pub(super) fn is_zero(number: &u64) -> bool {
    *number == 0
}
