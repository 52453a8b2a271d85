//! Tolerances: worsening of a figure that still passes.
use run::figure_by_name;
use score::{Better, FigureTerms, Kind};

use crate::dependence::influence::values;

/// Tolerance of a rate: a tenth of a percent.
const OF_RATE: f64 = 0.001;
/// Tolerance of an amount, relative to its size. The effect of a change in the last digits or of another
/// compiler is not a worsening, however significant it is.
const OF_AMOUNT: f64 = 0.01;

/// Returns the default tolerance of a figure in a baseline, in its unit: a tenth of a percent for a rate; for
/// an amount a hundredth of the root mean square of its values (about the best value, if the figure has one),
/// to two digits.
pub(crate) fn default_tolerance(figure: &FigureTerms) -> f64 {
    let sense = figure_by_name(&figure.name).sense;
    match sense.kind {
        Kind::Rate => OF_RATE,
        Kind::Amount => {
            let best = if let Better::Near(best) = sense.better { best } else { 0.0 };
            let all = values(&figure.terms);
            let squares: f64 = all.iter().map(|x| (x - best) * (x - best)).sum();
            let size = if all.is_empty() { 0.0 } else { (squares / all.len() as f64).sqrt() };
            two_digits(OF_AMOUNT * size)
        }
    }
}

/// Rounds to two digits, for readable files.
fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use score::Reduction;

    use super::*;
    use crate::hand_made::figure;

    #[test]
    fn a_figure_may_be_worse_by_a_hundredth_of_its_size_or_a_tenth_of_a_percent() {
        let tolerance = |name: &str, reduction, values: &[f64]| {
            let values: Vec<_> = values.iter().map(|value| Some(*value)).chain([None]).collect();
            default_tolerance(&figure(name, reduction, &values))
        };
        // The root mean square of 3 and −4 is √12.5 = 3.54.
        assert_eq!(tolerance("ra_rms_deg", Reduction::Rms, &[3.0, -4.0]), 0.035);
        // The size of a NEES is its distance from 1.
        assert_eq!(tolerance("nees_mean", Reduction::Mean, &[4.0, -3.0]), 0.035);
        assert_eq!(tolerance("hit_rate", Reduction::Rate, &[1.0, 0.0]), 0.001);
        assert_eq!(tolerance("ra_rms_deg", Reduction::Rms, &[]), 0.0);
    }
}
