//! Figures of the relative navigation on a run, which studies record and gates compare.

use super::{Better, FigureSpec, Kind, Sense};

/// Fraction of errors within three standard deviations, for a normal distribution.
const WITHIN_3_SIGMA: f64 = 0.9973;

/// Returns true if a figure of this name is one of the relative navigation.
pub fn is_of_navigation(name: &str) -> bool {
    name.starts_with("navigation_")
}

/// Returns the figures of the relative navigation. They are part of no score of a run.
pub fn figures() -> Vec<FigureSpec> {
    let amount = |name: &str, words: &str, unit: Option<&'static str>, better: Better| FigureSpec {
        unit,
        ..FigureSpec::amount(name, words, better)
    };
    let rate = |name: &str, words: &str, better: Better| FigureSpec {
        unit: Some("%"),
        sense: Sense { kind: Kind::Rate, better },
        ..FigureSpec::amount(name, words, better)
    };
    vec![
        rate("navigation_estimate_rate", "navigation estimate rate", Better::More),
        amount("navigation_r_rms_m", "navigation R RMS", Some("m"), Better::Less),
        amount("navigation_t_rms_m", "navigation T RMS", Some("m"), Better::Less),
        amount("navigation_n_rms_m", "navigation N RMS", Some("m"), Better::Less),
        rate("navigation_within_3_sigma", "navigation within 3 σ", Better::Near(WITHIN_3_SIGMA)),
        amount("navigation_position_nees_mean", "navigation position NEES mean", None, Better::Near(1.0)),
        amount("navigation_state_nees_mean", "navigation state NEES mean", None, Better::Near(1.0)),
        amount("navigation_range_rms_percent", "navigation range RMS", Some("%"), Better::Less),
        amount("navigation_convergence_s", "navigation convergence", Some("s"), Better::Less),
        amount("navigation_r_square_over_bound", "navigation R² over bound²", None, Better::Less),
        amount("navigation_t_square_over_bound", "navigation T² over bound²", None, Better::Less),
        amount("navigation_n_square_over_bound", "navigation N² over bound²", None, Better::Less),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_the_prefix_unit_and_kind_of_their_key() {
        for figure in figures() {
            let name = &figure.name;
            assert!(is_of_navigation(name) && !figure.words.contains('_'), "{figure}");
            assert_eq!(figure.is_rate(), name.ends_with("_rate") || name.contains("within_"), "{name}");
            let units = [("_m", "m"), ("_s", "s"), ("_percent", "%")];
            let unit = units.iter().find(|(ending, _)| name.ends_with(ending)).map(|(_, unit)| *unit);
            assert_eq!(figure.unit, unit.or(figure.is_rate().then_some("%")), "{name}");
        }
    }
}
