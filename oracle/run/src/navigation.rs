//! Relative navigation, a step after the runs of a world: its figures belong to those of a run in studies and
//! gates.

use std::path::Path;
use std::sync::{PoisonError, RwLock};

use files::Failure;
use score::FigureTerms;

/// Figure of the navigation of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct NavigationFigure {
    /// Key of the figure.
    pub name: &'static str,
    /// Value; `None` if it is undefined.
    pub value: Option<f64>,
    /// Numerator of a rate; equal to `of` in other figures.
    pub count: u64,
    /// Number of values that the figure is computed from.
    pub of: u64,
}

/// Navigation of the runs of a world.
#[derive(Clone, Copy)]
pub struct WorldNavigation {
    /// Code of the world.
    pub world: &'static str,
    /// Navigates on a run directory with the built-in estimator of this name, at the default interval, and
    /// returns the figures.
    pub figures: fn(&Path, &str) -> Result<Vec<NavigationFigure>, Failure>,
    /// Returns the figures of the navigation that is stored in a run directory, per frame; none if there is
    /// none.
    pub terms: fn(&Path) -> Result<Vec<FigureTerms>, Failure>,
}

/// Registered navigation, in order.
static NAVIGATION: RwLock<Vec<WorldNavigation>> = RwLock::new(Vec::new());

/// Registers the navigation of a world for the rest of the process.
pub fn register_navigation(navigation: WorldNavigation) {
    let mut registered = NAVIGATION.write().unwrap_or_else(PoisonError::into_inner);
    if registered.iter().all(|known| known.world != navigation.world) {
        registered.push(navigation);
    }
}

/// Returns the navigation of the world with this code; `None` if it has none.
pub fn navigation_of(world: &str) -> Option<WorldNavigation> {
    let registered = NAVIGATION.read().unwrap_or_else(PoisonError::into_inner);
    registered.iter().find(|navigation| navigation.world == world).copied()
}
