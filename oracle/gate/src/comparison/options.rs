//! What a comparison is asked for.
use indexmap::IndexMap;

/// What a comparison is asked.
#[derive(Debug, Clone, PartialEq)]
pub struct CompareOptions {
    /// Probability of shutting the gate when no figure is worse, above 0 and below 0.5.
    pub alpha: f64,
    /// Names of the figures to compare; empty: all of the baseline.
    pub figures: Vec<String>,
    /// By how much figures may be worse and pass, in their units, in place of the baseline's tolerances.
    pub tolerances: IndexMap<String, f64>,
    /// Why figures with a best value may change; absent: a change shuts the gate.
    pub accept_changed: Option<String>,
}

impl Default for CompareOptions {
    fn default() -> Self {
        Self { alpha: 0.05, figures: Vec::new(), tolerances: IndexMap::new(), accept_changed: None }
    }
}
