//! Figures of a world that tests know: rates and one amount.

use run::register_figures;
use score::{Better, FigureSpec, Kind, Sense};

/// Registers the figures for the rest of the process.
pub(crate) fn register() {
    let rate = |name: &str| FigureSpec {
        unit: Some("%"),
        sense: Sense { kind: Kind::Rate, better: Better::More },
        ..FigureSpec::amount(name, name.replace('_', " "), Better::More)
    };
    let amount = FigureSpec {
        unit: Some("°"),
        ..FigureSpec::amount("ra_rms_deg", "RMS across columns", Better::Less)
    };
    register_figures(vec![rate("correct_rate"), rate("hit_rate"), amount]);
}
