//! Label, unit, kind and better direction of a figure, for display and for comparisons. Each
//! [`Definition`](crate::Definition) has one.

pub(crate) mod navigation;

use std::fmt;

/// Kind of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Fraction of a count: from 0 to 1 in files, in percent for display.
    Rate,
    /// Mean, median or root mean square, in the same unit in files and for display.
    Amount,
}

/// Direction in which a figure improves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Better {
    /// Larger values are better.
    More,
    /// Smaller values are better.
    Less,
    /// Values nearer to this one are better: 0 for a bias, 1 for the NEES, which is 1 when σ is correct.
    Near(f64),
}

/// Kind of a figure, and the direction in which it improves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sense {
    /// Kind of the figure.
    pub kind: Kind,
    /// Direction in which the figure improves.
    pub better: Better,
}

/// Description of a figure, without its values.
#[derive(Debug, Clone, PartialEq)]
pub struct FigureSpec {
    /// Key of the figure in files and options.
    pub name: String,
    /// Label for display.
    pub words: String,
    /// Unit for display; `None` for a dimensionless figure.
    pub unit: Option<&'static str>,
    /// Kind of the figure, and the direction in which it improves.
    pub sense: Sense,
    /// True if the figure is about lines of sight, which depend on an attitude ([`crate::attitude_word`]).
    pub rests_on_attitude: bool,
}

impl FigureSpec {
    /// Creates an amount without a unit that does not depend on an attitude.
    pub fn amount(name: impl Into<String>, words: impl Into<String>, better: Better) -> Self {
        let sense = Sense { kind: Kind::Amount, better };
        Self { name: name.into(), words: words.into(), unit: None, sense, rests_on_attitude: false }
    }

    /// Creates a figure that no world defines, such as one from a file of another version: an amount, best at
    /// 0.
    pub fn unknown(name: &str) -> Self {
        Self::amount(name, name.replace('_', " "), Better::Near(0.0))
    }

    /// Returns true if the figure is a rate, which is displayed in percent.
    pub fn is_rate(&self) -> bool {
        self.sense.kind == Kind::Rate
    }

    /// Returns the label for values that are written with a percent sign: without the unit %, with any other
    /// unit.
    pub fn label_without_percent(&self) -> String {
        if self.unit == Some("%") { self.words.clone() } else { self.to_string() }
    }
}

impl fmt::Display for FigureSpec {
    /// Writes the label, then a comma and the unit, if there is one.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words)?;
        self.unit.map_or(Ok(()), |unit| write!(f, ", {unit}"))
    }
}

/// Formats the limit of an error for display, to three significant digits: `0.024°`, `0.0236°`.
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

    /// The declared kind and unit agree with those that the key implies.
    #[test]
    fn every_figure_has_a_label_and_the_unit_of_its_key() {
        const UNITS: [(&str, &str); 5] =
            [("_m_s", "m/s"), ("_deg", "°"), ("_percent", "%"), ("_m", "m"), ("_px", "px")];
        for figure in all() {
            let name = &figure.name;
            assert!(!figure.to_string().contains('_'), "{figure}");
            let is_rate = name.ends_with("_rate") || name.contains("within_");
            assert_eq!(figure.is_rate(), is_rate, "{name}");
            let unit = UNITS.iter().find(|(ending, _)| name.ends_with(ending)).map(|(_, unit)| *unit);
            assert_eq!(figure.unit, unit.or(is_rate.then_some("%")), "{name}");
            // A bias is the only amount that is best at 0.
            let is_bias = name.contains("_mean_") || name.contains("_median_");
            assert_eq!(figure.sense.better == Better::Near(0.0), is_bias, "{name}");
        }
    }

    /// A file names a figure by its key only, without its world.
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
