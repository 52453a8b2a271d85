//! What a figure is for people and comparisons: words, unit, kind, and which way is better. Each [`Definition`](crate::Definition) has one.

use std::fmt;

/// What is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// So many of so many; from 0 to 1 in files, in percent where people read it.
    Rate,
    /// A mean, a median, a root mean square, in its unit everywhere.
    Amount,
}

/// Which way is better.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Better {
    /// More of it.
    More,
    /// Less of it.
    Less,
    /// Nearer to a value: no bias is 0, honest sigmas have a NEES of 1.
    Near(f64),
}

/// Kind and direction of a figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sense {
    /// What is counted.
    pub kind: Kind,
    /// Which way is better.
    pub better: Better,
}

/// A figure without its values.
#[derive(Debug, Clone, PartialEq)]
pub struct FigureSpec {
    /// Its key in files and options.
    pub name: String,
    /// What it is called where people read it.
    pub words: String,
    /// The unit in which people read it; none for a number without one.
    pub unit: Option<&'static str>,
    /// Kind and direction.
    pub sense: Sense,
    /// Whether it is one of lines of sight, which rest on an attitude ([`crate::attitude_word`]).
    pub rests_on_attitude: bool,
}

impl FigureSpec {
    /// An amount without a unit, which rests on no attitude.
    pub fn amount(name: impl Into<String>, words: impl Into<String>, better: Better) -> Self {
        let sense = Sense { kind: Kind::Amount, better };
        Self { name: name.into(), words: words.into(), unit: None, sense, rests_on_attitude: false }
    }

    /// A figure that no world defines, as a file of another version may name one: an amount, best at 0.
    pub fn unknown(name: &str) -> Self {
        Self::amount(name, name.replace('_', " "), Better::Near(0.0))
    }

    /// Whether it is written in percent.
    pub fn is_rate(&self) -> bool {
        self.sense.kind == Kind::Rate
    }

    /// The label beside values that are written with their percent sign, and without any other unit.
    pub fn label_without_percent(&self) -> String {
        if self.unit == Some("%") { self.words.clone() } else { self.to_string() }
    }
}

impl fmt::Display for FigureSpec {
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
    use crate::{docking, figures};

    fn all() -> Vec<FigureSpec> {
        figures().into_iter().chain(docking::figures()).collect()
    }

    #[test]
    fn figures_are_read_with_their_units_and_have_a_direction() {
        let is = |name: &str, label: &str, better| {
            let figure = all().into_iter().find(|figure| figure.name == name).unwrap();
            assert_eq!((figure.to_string().as_str(), figure.sense.better), (label, better), "{name}");
        };
        is("ra_rms_deg", "RA RMS, °", Better::Less);
        is("ra_mean_deg", "RA mean, °", Better::Near(0.0));
        is("dec_within_1px", "Dec within 1 px, %", Better::More);
        is("correct_rate", "correct rate, %", Better::More);
        is("wrong_rate", "wrong rate, %", Better::Less);
        is("motion_range_rate_rms_m_s", "motion range rate RMS, m/s", Better::Less);
        is("phi3_within_3_sigma", "φ3 within 3 σ, %", Better::Near(0.9973));
        is("motion_position_nees_mean", "motion position NEES mean", Better::Near(1.0));
        is("paper_success_rate", "paper success rate, %", Better::More);
        is("latency_fields", "latency fields", Better::Less);
        is("stars_mean", "stars mean", Better::More);
    }

    /// Keys tell kind and unit to whoever reads a file; declarations say the same.
    #[test]
    fn no_figure_is_shown_by_its_key_or_says_another_unit_than_its_key() {
        const UNITS: [(&str, &str); 5] =
            [("_m_s", "m/s"), ("_deg", "°"), ("_percent", "%"), ("_m", "m"), ("_px", "px")];
        for figure in all() {
            let name = &figure.name;
            assert!(!figure.to_string().contains('_'), "{figure}");
            let is_rate = name.ends_with("_rate") || name.contains("within_");
            assert_eq!(figure.is_rate(), is_rate, "{name}");
            let unit = UNITS.iter().find(|(ending, _)| name.ends_with(ending)).map(|(_, unit)| *unit);
            assert_eq!(figure.unit, unit.or(is_rate.then_some("%")), "{name}");
            // A bias is the only amount that is best at nought.
            let is_bias = name.contains("_mean_") || name.contains("_median_");
            assert_eq!(figure.sense.better == Better::Near(0.0), is_bias, "{name}");
        }
    }

    /// A file names a figure by its key alone, whatever its world.
    #[test]
    fn a_key_is_the_same_figure_in_both_worlds() {
        for figure in figures() {
            for other in docking::figures().iter().filter(|other| other.name == figure.name) {
                assert_eq!(*other, figure);
            }
        }
    }

    #[test]
    fn a_limit_has_three_digits() {
        assert_eq!([0.024, 0.023_557_1, 0.048_819, 2.0].map(angle), ["0.024°", "0.0236°", "0.0488°", "2°"]);
    }
}
