//! Contribution of each unit of a run to a figure.

use score::{FigureTerms, Reduction, Term};
use statistics::median;

/// Sums of one run for a figure.
pub(crate) struct Sums {
    /// Linearised sum and count of each unit.
    pub(crate) units: Vec<(f64, f64)>,
    pub(crate) sum: f64,
    pub(crate) count: f64,
}

impl Sums {
    pub(crate) fn from_terms(terms: &[Term], reduction: Reduction, centre: f64) -> Self {
        let linear = |term: &Term| match reduction {
            Reduction::Rate | Reduction::Mean => term.sum,
            Reduction::Rms => term.sum * term.sum,
            Reduction::Median if term.count == 0 => 0.0,
            Reduction::Median => f64::from(i8::from(term.sum > centre) - i8::from(term.sum < centre)),
        };
        let units: Vec<(f64, f64)> = terms.iter().map(|term| (linear(term), f64::from(term.count))).collect();
        let (sum, of) = units.iter().fold((0.0, 0.0), |(sum, of), unit| (sum + unit.0, of + unit.1));
        Self { units, sum, count: of }
    }

    pub(crate) fn ratio(&self) -> Option<f64> {
        (self.count > 0.0).then(|| self.sum / self.count)
    }
}

/// Returns the values of a figure that has at most one value per unit.
pub(crate) fn values(terms: &[Term]) -> Vec<f64> {
    terms.iter().filter(|term| term.count > 0).map(|term| term.sum).collect()
}

/// Returns the contribution of each unit of one run to a figure, relative to the figure's value.
pub(crate) fn influence(figure: &FigureTerms) -> Vec<f64> {
    let own = values(&figure.terms);
    let centre = if figure.reduction == Reduction::Median { median(&[own]).unwrap_or(0.0) } else { 0.0 };
    let sums = Sums::from_terms(&figure.terms, figure.reduction, centre);
    let ratio = sums.ratio().unwrap_or(0.0);
    sums.units.iter().map(|(sum, of)| sum - ratio * of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand_made::figure as terms;

    #[test]
    fn the_influence_of_a_unit_is_its_contribution_about_the_value() {
        let of = |reduction, values: &[Option<f64>]| influence(&terms("any", reduction, values));
        // Relative to the mean of 4, and to the mean square of 9.
        let values = [Some(1.0), None, Some(4.0), Some(7.0)];
        assert_eq!(of(Reduction::Mean, &values), [-3.0, 0.0, 0.0, 3.0]);
        assert_eq!(of(Reduction::Rms, &[Some(1.0), Some(-1.0), Some(5.0)]), [-8.0, -8.0, 16.0]);
        // Below, above and at the median of 2.
        assert_eq!(of(Reduction::Median, &[Some(1.0), Some(5.0), Some(2.0), None]), [-1.0, 1.0, 0.0, 0.0]);
        assert_eq!(of(Reduction::Mean, &[None; 2]), [0.0, 0.0]);
        // Three of four are held: 2 − 3 · 3/4, 1 − 1 · 3/4.
        let pooled = vec![Term { sum: 2.0, count: 3 }, Term { sum: 1.0, count: 1 }];
        let pooled = FigureTerms::from_terms("held", Reduction::Rate, pooled);
        assert_eq!(influence(&pooled), [-0.25, 0.25]);
    }
}
