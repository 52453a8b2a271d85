//! Change of a comparison against an earlier one.

use serde::Deserialize;

use super::difference::Likeness;

/// A comparison that was kept: the document of `boresight compare --json`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct KeptComparison {
    /// Figures.
    pub figures: Vec<KeptFigure>,
}

/// A figure of a comparison that was kept.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct KeptFigure {
    /// Code of the figure.
    pub code: String,
    /// Twin minus camera.
    pub difference: f64,
    /// Half of the interval of 95 % of the difference.
    pub limit: f64,
}

/// A figure that is not as it was.
#[derive(Debug, Clone, PartialEq)]
pub enum Change {
    /// The difference changed by more than its error.
    Moved {
        /// Code of the figure.
        code: String,
        /// Difference in the kept comparison, and now.
        differences: [f64; 2],
        /// Limit of the change: √(l² + l'²) of the half intervals l and l'.
        limit: f64,
    },
    /// The frames no longer give the figure.
    Lost {
        /// Code of the figure.
        code: String,
    },
}

/// Returns the figures of a kept comparison that changed or are lost.
pub fn changes(kept: &KeptComparison, now: &[Likeness]) -> Vec<Change> {
    let mut changes = Vec::new();
    for before in &kept.figures {
        let Some(figure) = now.iter().find(|figure| figure.code == before.code) else {
            changes.push(Change::Lost { code: before.code.clone() });
            continue;
        };
        let limit = libm::hypot(before.limit, figure.limit);
        if (figure.difference - before.difference).abs() > limit {
            let differences = [before.difference, figure.difference];
            changes.push(Change::Moved { code: before.code.clone(), differences, limit });
        }
    }
    changes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likeness::{Estimate, Unit};

    #[test]
    fn a_figure_that_moves_or_is_lost_is_a_change() {
        let figure = |code: &'static str, value: f64| {
            Likeness::of_difference(code, code, Unit::Dn, Estimate::known(value, 1.0))
        };
        let kept = |code: &str, difference: f64| KeptFigure { code: code.to_owned(), difference, limit: 2.0 };
        let before =
            KeptComparison { figures: vec![kept("noise", 0.0), kept("rows", 0.0), kept("hot", 1.0)] };
        // √(2² + 1.96²) = 2.8.
        let found = changes(&before, &[figure("noise", 2.7), figure("rows", -2.9), figure("other", 9.0)]);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(
            matches!(&found[0], Change::Moved { code, limit, .. } if code == "rows" && (limit - 2.8).abs() < 0.01)
        );
        assert_eq!(found[1], Change::Lost { code: "hot".to_owned() });
    }
}
