//! Definition of a figure: the values of each frame, and their reduction to one number.

use super::figure::Figure;
use super::figure_spec::{Better, FigureSpec, Kind, Sense};

/// Reduction of the values of all frames to a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reduction {
    /// Fraction of non-zero values; values are 0 or 1, any number per frame.
    Rate,
    /// Mean of the values, at most one per frame.
    Mean,
    /// Root mean square of the values, at most one per frame.
    Rms,
    /// Median of the values, at most one per frame.
    Median,
}

impl Reduction {
    /// All reductions.
    pub const ALL: [Self; 4] = [Self::Rate, Self::Mean, Self::Rms, Self::Median];

    /// Returns the name used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Rate => "rate",
            Self::Mean => "mean",
            Self::Rms => "rms",
            Self::Median => "median",
        }
    }

    /// Parses a [`Reduction::code`].
    pub fn parse(code: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|reduction| reduction.code() == code)
    }
}

/// Function that appends the values of one unit (a frame, a field) for a figure to the list.
type Values<'a, U> = Box<dyn Fn(&U, &mut Vec<f64>) + 'a>;

/// Definition of a figure over units of the type `U`. Score and gate count by it; tables and reports show its
/// words.
pub struct Definition<'a, U> {
    /// Name, words, unit and sense of the figure.
    pub figure: FigureSpec,
    /// Reduction of the values.
    pub reduction: Reduction,
    /// Limit of a rate of errors "within" a limit, degrees; `None` for other figures.
    pub limit_deg: Option<f64>,
    values: Values<'a, U>,
}

impl<'a, U> Definition<'a, U> {
    /// Creates a rate over the units for which `holds` returns a value; more is better unless changed by
    /// [`Definition::with_direction`].
    pub fn rate(
        name: impl Into<String>,
        words: impl Into<String>,
        holds: impl Fn(&U) -> Option<bool> + 'a,
    ) -> Self {
        Self::pooled(name, words, move |unit, values| {
            values.extend(holds(unit).map(|held| f64::from(u8::from(held))))
        })
    }

    /// Creates a rate of values, 0 or 1, of which a unit may have several.
    pub fn pooled(
        name: impl Into<String>,
        words: impl Into<String>,
        values: impl Fn(&U, &mut Vec<f64>) + 'a,
    ) -> Self {
        let sense = Sense { kind: Kind::Rate, better: Better::More };
        let figure = FigureSpec { unit: Some("%"), sense, ..FigureSpec::amount(name, words, Better::More) };
        Self { figure, reduction: Reduction::Rate, limit_deg: None, values: Box::new(values) }
    }

    /// Creates a mean, median or root mean square over the units that have a value, in the unit `unit`. The
    /// values are assumed to be errors: a root mean square is better when smaller, a mean or median when
    /// nearer to 0, unless changed by [`Definition::with_direction`].
    pub fn amount(
        name: impl Into<String>,
        words: impl Into<String>,
        unit: impl Into<Option<&'static str>>,
        reduction: Reduction,
        value: impl Fn(&U) -> Option<f64> + 'a,
    ) -> Self {
        let better = if reduction == Reduction::Rms { Better::Less } else { Better::Near(0.0) };
        let figure = FigureSpec { unit: unit.into(), ..FigureSpec::amount(name, words, better) };
        let values: Values<'a, U> = Box::new(move |unit, values| values.extend(value(unit)));
        Self { figure, reduction, limit_deg: None, values }
    }

    /// Sets the direction that is better.
    #[must_use]
    pub fn with_direction(mut self, better: Better) -> Self {
        self.figure.sense.better = better;
        self
    }

    /// Marks the figure as one of lines of sight, which depends on an attitude.
    #[must_use]
    pub fn resting_on_attitude(mut self) -> Self {
        self.figure.rests_on_attitude = true;
        self
    }

    /// Sets the error below which a measurement counts for this rate, degrees.
    #[must_use]
    pub fn with_limit_deg(self, limit_deg: f64) -> Self {
        Self { limit_deg: Some(limit_deg), ..self }
    }

    /// Computes the figure over several sequences of units, each in order of time.
    pub fn figure(&self, sequences: &[&[&U]]) -> Figure {
        let collected: Vec<Vec<f64>> = sequences
            .iter()
            .map(|sequence| {
                let mut values = Vec::new();
                sequence.iter().for_each(|unit| (self.values)(unit, &mut values));
                values
            })
            .collect();
        let figure = match self.reduction {
            Reduction::Rate => {
                let held = |values: &Vec<f64>| values.iter().map(|value| *value != 0.0).collect();
                Figure::rate(&collected.iter().map(held).collect::<Vec<Vec<bool>>>())
            }
            Reduction::Mean => Figure::mean(&collected),
            Reduction::Rms => Figure::rms(&collected),
            Reduction::Median => Figure::median(&collected),
        };
        Figure { limit_deg: self.limit_deg, ..figure }
    }

    /// Returns the contribution of one unit to the figure.
    pub fn term(&self, unit: &U) -> Term {
        let mut values = Vec::new();
        (self.values)(unit, &mut values);
        Term { sum: values.iter().sum(), count: values.len() as u32 }
    }
}

/// Contribution of one unit to a figure.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Term {
    /// Sum of the unit's values; 0 without values.
    pub sum: f64,
    /// Number of the unit's values.
    pub count: u32,
}

/// Contributions of all units to one figure.
#[derive(Debug, Clone, PartialEq)]
pub struct FigureTerms {
    /// Name of the figure.
    pub name: String,
    /// Reduction of the values.
    pub reduction: Reduction,
    /// Limit of a rate of errors "within" a limit, degrees; `None` for other figures.
    pub limit_deg: Option<f64>,
    /// Attitude that the lines of sight of the figure are based on ([`crate::attitude_word`]); `None` for
    /// figures without lines of sight.
    pub attitude: Option<String>,
    /// One term per unit, in order.
    pub terms: Vec<Term>,
}

impl FigureTerms {
    /// Sets the attitude that the lines of sight are based on, if `figure`, the specification of this figure,
    /// is one of lines of sight.
    #[must_use]
    pub fn with_attitude(self, figure: &FigureSpec, attitude: Option<&String>) -> Self {
        Self { attitude: attitude.filter(|_| figure.rests_on_attitude).cloned(), ..self }
    }

    /// Computes the terms of units by a definition.
    pub fn new<U>(definition: &Definition<'_, U>, units: &[U]) -> Self {
        Self::from_counted_units(definition, units, |_| true)
    }

    /// Computes the terms of units by a definition; units that are not counted have no value.
    pub fn from_counted_units<U>(
        definition: &Definition<'_, U>,
        units: &[U],
        is_counted: impl Fn(&U) -> bool,
    ) -> Self {
        let term = |unit: &U| if is_counted(unit) { definition.term(unit) } else { Term::default() };
        let terms = units.iter().map(term).collect();
        let counted = Self::from_terms(&definition.figure.name, definition.reduction, terms);
        Self { limit_deg: definition.limit_deg, ..counted }
    }

    /// Creates a figure from computed terms, without a limit and without an attitude.
    pub fn from_terms(name: &str, reduction: Reduction, terms: Vec<Term>) -> Self {
        Self { name: name.to_owned(), reduction, limit_deg: None, attitude: None, terms }
    }
}

/// Verdict on one unit, for a list of changed units.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnitVerdict {
    /// Number of the frame, the field or the case.
    pub number: u64,
    /// Name of the unit's group.
    pub group: String,
    /// Name of the verdict.
    pub verdict: String,
    /// Cause of a miss, or kind of error of a wrong measurement.
    pub cause: Option<String>,
}

/// A scored run, unit by unit, as needed to compare two runs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct UnitTable {
    /// Units, by number.
    pub units: Vec<UnitVerdict>,
    /// Terms of the units for each figure.
    pub figures: Vec<FigureTerms>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reduction_round_trips_from_its_word() {
        assert_eq!(Reduction::ALL.map(Reduction::code), ["rate", "mean", "rms", "median"]);
        assert_eq!(
            Reduction::ALL.map(|reduction| Reduction::parse(reduction.code())),
            Reduction::ALL.map(Some)
        );
        assert_eq!(Reduction::parse("mode"), None);
    }

    #[test]
    fn a_unit_adds_the_sum_of_its_values_and_their_number() {
        let definition =
            Definition::pooled("held", "held", |unit: &u32, values| values.extend((0..*unit).map(f64::from)));
        assert_eq!(definition.term(&4), Term { sum: 6.0, count: 4 });
        assert_eq!(definition.term(&0), Term { sum: 0.0, count: 0 });
    }
}
