//! What a command answers.

/// The answer of a command that ran: exit status 0 or 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Answer {
    Yes,
    No,
}
