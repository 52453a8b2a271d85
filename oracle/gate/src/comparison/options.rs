//! Options of a comparison.
use indexmap::IndexMap;

/// Options of a comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct CompareOptions {
    /// Probability of shutting the gate when no figure is worse, above 0 and below 0.5.
    pub alpha: f64,
    /// Names of the figures to compare; if empty, all figures of the baseline.
    pub figures: Vec<String>,
    /// Tolerances of figures, in their units, which replace those of the baseline.
    pub tolerances: IndexMap<String, f64>,
    /// Reason why figures with a best value may change; if absent, a change shuts the gate.
    pub accept_changed: Option<String>,
}

impl Default for CompareOptions {
    fn default() -> Self {
        Self { alpha: 0.05, figures: Vec::new(), tolerances: IndexMap::new(), accept_changed: None }
    }
}
