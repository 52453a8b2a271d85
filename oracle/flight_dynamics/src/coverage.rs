//! Time spans of files.

use std::fmt;

use hifitime::Epoch;
use sim::truth::clock;

use crate::time::TimeSystem;

/// Time span that a file covers, both ends included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coverage {
    /// First instant.
    pub start: Epoch,
    /// Last instant.
    pub stop: Epoch,
}

impl Coverage {
    pub(crate) fn contains(&self, time: Epoch) -> bool {
        self.start <= time && time <= self.stop
    }
}

/// Rule for the start of a span that follows another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BorderRule {
    /// The spans share no more than an instant.
    NoOverlap,
    /// The second span begins at the latest where the first one ends.
    NoGap,
}

impl BorderRule {
    /// Returns the expected start of `later`, with a time of `system`, if it breaks the rule.
    pub(crate) fn broken_by(
        self,
        earlier: &Coverage,
        later: &Coverage,
        system: TimeSystem,
    ) -> Option<String> {
        let (is_broken, start, reason) = match self {
            Self::NoOverlap => {
                (later.start < earlier.stop, "a start not before", "segments must not overlap")
            }
            Self::NoGap => (later.start > earlier.stop, "a start at", "there must be no gap"),
        };
        let end = system.format_time(earlier.stop);
        is_broken.then(|| format!("{start} {end}, the end of the segment before: {reason}"))
    }
}

impl fmt::Display for Coverage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} to {}", clock::format_utc(self.start), clock::format_utc(self.stop))
    }
}

/// A time that a file does not cover.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{} is not covered, expected a time in {spans}", clock::format_utc(*.time))]
pub struct Uncovered {
    /// The time.
    pub time: Epoch,
    /// Spans that are covered, in words.
    pub spans: String,
}

impl Uncovered {
    pub(crate) fn new(time: Epoch, coverage: impl Iterator<Item = Coverage>) -> Self {
        /// Number of spans in a message.
        const SHOWN: usize = 4;
        let spans: Vec<String> = coverage.map(|span| span.to_string()).collect();
        let mut shown = spans.iter().take(SHOWN).cloned().collect::<Vec<_>>().join(", or ");
        if spans.len() > SHOWN {
            shown.push_str(&format!(", or {} more spans", spans.len() - SHOWN));
        }
        Self { time, spans: shown }
    }
}

/// Seconds from `from` to `to`, leap seconds included; exact to 0.1 ns within months.
pub(crate) fn seconds_between(from: Epoch, to: Epoch) -> f64 {
    let nanoseconds = to.to_tai_duration().total_nanoseconds() - from.to_tai_duration().total_nanoseconds();
    nanoseconds as f64 / 1e9
}
