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

    /// Returns the label for a table: without the unit for a rate, whose values have a percent sign, with the
    /// unit for an amount.
    pub fn label_without_percent(&self) -> String {
        if self.is_rate() { self.words.clone() } else { self.to_string() }
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

    #[test]
    fn a_label_in_a_table_has_the_unit_of_an_amount() {
        let relative =
            FigureSpec { unit: Some("%"), ..FigureSpec::amount("range", "range RMS", Better::Less) };
        assert_eq!(relative.label_without_percent(), "range RMS, %");
        let rate = Sense { kind: Kind::Rate, better: Better::More };
        assert_eq!(FigureSpec { sense: rate, ..relative }.label_without_percent(), "range RMS");
    }

    #[test]
    fn a_limit_has_three_digits() {
        assert_eq!([0.024, 0.023_557_1, 0.048_819, 2.0].map(angle), ["0.024°", "0.0236°", "0.0488°", "2°"]);
    }
}
