//! When a study is done: the figure of its stopping rule is known well enough.

use super::cases::CaseTable;
use super::definition::Study;
use super::estimate::overall;

/// Cases after which a study looks for the first time, and the fewest from one look to the next.
const STEP: u64 = 8;
/// From one look to the next, the cases grow at least by one part of so many.
const PARTS: u64 = 16;

/// Looks whether the figure of a stopping rule is known well enough: after 8 cases, 16, 24, from 128 on after a sixteenth more each time, and
/// after all. The numbers do not depend on how the study is cut into shards, so neither does where it stops.
pub(super) struct Stopping<'a> {
    study: &'a Study,
    next: u64,
}

impl<'a> Stopping<'a> {
    /// Before the first case.
    pub(super) fn new(study: &'a Study) -> Self {
        Self { study, next: STEP.min(study.cases()) }
    }

    /// The number of cases that are enough, if they are known already; `known` are all cases from the first on, as far as they are known,
    /// and more of them from call to call.
    pub(super) fn enough(&mut self, known: &CaseTable) -> Option<u64> {
        while self.next <= known.rows.len() as u64 {
            let cases = self.next;
            if is_narrow_enough(self.study, known, cases) {
                return Some(cases);
            }
            if cases >= self.study.cases() {
                return None;
            }
            self.next = (cases + (cases / PARTS).max(STEP)).min(self.study.cases());
        }
        None
    }
}

/// Whether the figure of the stopping rule is known well enough from the first `cases`.
pub(super) fn is_narrow_enough(study: &Study, known: &CaseTable, cases: u64) -> bool {
    let Some(until) = &study.file.stop.until else { return false };
    let Some(mut figures) = known.figure(&until.figure) else { return false };
    figures.truncate(cases as usize);
    let estimate = overall(&until.figure, &figures, study.file.seed, 0);
    let width = estimate.and_then(|estimate| Some(estimate.high? - estimate.low?));
    width.is_some_and(|width| width <= 2.0 * until.half_width)
}
