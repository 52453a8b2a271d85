//! What a command answers.

/// The answer of a command that ran: exit status 0, 1 or 2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Answer {
    Yes,
    No,
    /// A part of what was asked for, as the pipeline did not start.
    Part,
}
