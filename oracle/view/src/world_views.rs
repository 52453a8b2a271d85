//! Registry of the views of worlds.

use std::sync::{PoisonError, RwLock};

use files::Failure;
use run::AnyJudgement;

use crate::{AnnotatedFrame, Source};

/// Presence of a close-up of the target in the panel of a whole frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CloseUp {
    /// A close-up in a corner of the frame.
    Inset,
    /// No close-up: the target soon fills the frame.
    None,
}

/// Views of a world.
#[derive(Clone, Copy)]
pub struct WorldViews {
    /// Code of the world.
    pub code: &'static str,
    /// Returns the printed table of a scored run, bold and dim by terminal codes if the flag is set; `None`
    /// for a run of another world.
    pub table: fn(&dyn AnyJudgement, bool) -> Option<String>,
    /// Reads frames of a directory and makes their panels, in the given order.
    pub panels: fn(&Source, &[u64]) -> Result<Vec<AnnotatedFrame>, Failure>,
    /// Close-up in the panel of a whole frame.
    pub close_up: CloseUp,
}

/// Registered views, in order.
static VIEWS: RwLock<Vec<WorldViews>> = RwLock::new(Vec::new());

/// Registers the views of a world for the rest of the process. Views of a world that has some already are
/// left as they are.
pub fn register(views: WorldViews) {
    let mut registered = VIEWS.write().unwrap_or_else(PoisonError::into_inner);
    if registered.iter().all(|known| known.code != views.code) {
        registered.push(views);
    }
}

/// Returns the views of the world with this code; `None` if it has none.
pub fn views_of(code: &str) -> Option<WorldViews> {
    registered().into_iter().find(|views| views.code == code)
}

/// Returns all registered views.
pub(crate) fn registered() -> Vec<WorldViews> {
    VIEWS.read().unwrap_or_else(PoisonError::into_inner).clone()
}
