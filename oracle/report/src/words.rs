//! Names of files as people read them.
use score::{Kind, sense};

/// A name with blanks: `cut by roi`.
pub(super) fn spoken(name: &str) -> String {
    name.replace('_', " ")
}

/// The name of a figure for an axis, its unit after it: `RA RMS, °`; of a rate percent.
pub(super) fn figure_label(name: &str) -> String {
    let units = [("_m_s", "m/s"), ("_deg", "°"), ("_percent", "%"), ("_m", "m"), ("_px", "px")];
    let ending = units.iter().find_map(|(ending, unit)| Some((name.strip_suffix(ending)?, *unit)));
    let (stem, unit) = match ending {
        Some((stem, unit)) => (stem, Some(unit)),
        None => (name, (sense(name).kind == Kind::Rate).then_some("%")),
    };
    let word = |word: &str| match word {
        "ra" => "RA".to_owned(),
        "dec" => "Dec".to_owned(),
        "rms" => "RMS".to_owned(),
        "nees" => "NEES".to_owned(),
        "alpha" => "α".to_owned(),
        "beta" => "β".to_owned(),
        "sigma" => "σ".to_owned(),
        "1px" => "1 px".to_owned(),
        "2px" => "2 px".to_owned(),
        word => word.replace("phi", "φ"),
    };
    let words = stem.split('_').map(word).collect::<Vec<_>>().join(" ");
    unit.map_or_else(|| words.clone(), |unit| format!("{words}, {unit}"))
}

/// With a capital letter at its beginning.
pub(super) fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_figures_are_read_with_their_units() {
        for (name, label) in [
            ("ra_rms_deg", "RA RMS, °"),
            ("dec_within_1px", "Dec within 1 px, %"),
            ("correct_rate", "correct rate, %"),
            ("motion_range_rate_rms_m_s", "motion range rate RMS, m/s"),
            ("phi3_within_3_sigma", "φ3 within 3 σ, %"),
            ("stars_mean", "stars mean"),
        ] {
            assert_eq!(figure_label(name), label);
        }
    }
}
