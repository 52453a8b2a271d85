//! What a figure is called where people read it; files and options have its key.

use std::fmt;

use crate::sense::{Kind, sense};

/// The words and the unit of a figure, by its key: `ra_rms_deg` is `RA RMS` in `°`, a rate is in `%`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FigureLabel {
    /// The words.
    pub words: String,
    /// The unit; none for a number without one.
    pub unit: Option<&'static str>,
}

/// Endings of keys that tell the unit.
const UNITS: [(&str, &str); 5] =
    [("_m_s", "m/s"), ("_deg", "°"), ("_percent", "%"), ("_m", "m"), ("_px", "px")];

impl FigureLabel {
    /// That of a key.
    pub fn of(key: &str) -> Self {
        let ending = UNITS.iter().find_map(|(ending, unit)| Some((key.strip_suffix(ending)?, *unit)));
        let (stem, unit) = match ending {
            Some((stem, unit)) => (stem, Some(unit)),
            None => (key, (sense(key).kind == Kind::Rate).then_some("%")),
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
        Self { words: stem.split('_').map(word).collect::<Vec<_>>().join(" "), unit }
    }

    /// The label beside values that are written with their percent sign, and without any other unit.
    pub fn beside_percent(&self) -> String {
        if self.unit == Some("%") { self.words.clone() } else { self.to_string() }
    }
}

impl fmt::Display for FigureLabel {
    /// The words, and after a comma the unit.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words)?;
        self.unit.map_or(Ok(()), |unit| write!(f, ", {unit}"))
    }
}

/// A limit of an error as people read it, to three significant digits: `0.024°`, `0.0236°`.
pub fn angle(degrees: f64) -> String {
    let rounded: f64 = format!("{degrees:.2e}").parse().unwrap_or(degrees);
    format!("{rounded}°")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{docking, figure_names};

    #[test]
    fn names_of_figures_are_read_with_their_units() {
        for (key, label) in [
            ("ra_rms_deg", "RA RMS, °"),
            ("dec_within_1px", "Dec within 1 px, %"),
            ("correct_rate", "correct rate, %"),
            ("motion_range_rate_rms_m_s", "motion range rate RMS, m/s"),
            ("phi3_within_3_sigma", "φ3 within 3 σ, %"),
            ("stars_mean", "stars mean"),
        ] {
            assert_eq!(FigureLabel::of(key).to_string(), label);
        }
    }

    #[test]
    fn a_limit_has_three_digits() {
        assert_eq!([0.024, 0.023_557_1, 0.048_819, 2.0].map(angle), ["0.024°", "0.0236°", "0.0488°", "2°"]);
    }

    #[test]
    fn no_figure_is_shown_by_its_key() {
        for key in figure_names().into_iter().chain(docking::figure_names()) {
            let label = FigureLabel::of(&key).to_string();
            assert!(!label.contains('_'), "{label}");
        }
    }
}
