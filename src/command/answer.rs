//! Result of a command.

/// Result of a command that ran: exit status 0, 1 or 2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Answer {
    Yes,
    No,
    /// Partial result, because the pipeline did not start.
    Part,
}
