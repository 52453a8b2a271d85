//! What a figure is: the values that every frame has for it, and how they are summed up.

use super::figure_spec::{Better, FigureSpec, Kind, Sense};
use super::report::Figure;

/// How a figure sums up the values of the frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reduction {
    /// The share of the values that are not 0: values are 0 or 1, any number of them a frame.
    Rate,
    /// The mean of the values, at most one a frame.
    Mean,
    /// The root mean square of the values, at most one a frame.
    Rms,
    /// The median of the values, at most one a frame.
    Median,
}

impl Reduction {
    /// Every one.
    pub const ALL: [Self; 4] = [Self::Rate, Self::Mean, Self::Rms, Self::Median];

    /// The word used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Rate => "rate",
            Self::Mean => "mean",
            Self::Rms => "rms",
            Self::Median => "median",
        }
    }

    /// Reads [`Reduction::code`].
    pub fn parse(code: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|reduction| reduction.code() == code)
    }
}

/// The values of one unit (a frame, a field) for a figure, added to the list.
type Values<'a, U> = Box<dyn Fn(&U, &mut Vec<f64>) + 'a>;

/// The definition of a figure over units of the type `U`: score and gate both count by it, tables and reports show it by its words.
pub struct Definition<'a, U> {
    /// What the figure is.
    pub figure: FigureSpec,
    /// How its values are summed up.
    pub reduction: Reduction,
    /// Of a rate of errors "within" something: the limit, degrees.
    pub limit_deg: Option<f64>,
    values: Values<'a, U>,
}

impl<'a, U> Definition<'a, U> {
    /// A rate of the units for which `holds` says something; more is better unless [`Definition::with_direction`] says otherwise.
    pub fn rate(
        name: impl Into<String>,
        words: impl Into<String>,
        holds: impl Fn(&U) -> Option<bool> + 'a,
    ) -> Self {
        Self::pooled(name, words, move |unit, values| {
            values.extend(holds(unit).map(|held| f64::from(u8::from(held))))
        })
    }

    /// A rate of values, 0 or 1, of which a unit may have several.
    pub fn pooled(
        name: impl Into<String>,
        words: impl Into<String>,
        values: impl Fn(&U, &mut Vec<f64>) + 'a,
    ) -> Self {
        let sense = Sense { kind: Kind::Rate, better: Better::More };
        let figure = FigureSpec { unit: Some("%"), sense, ..FigureSpec::amount(name, words, Better::More) };
        Self { figure, reduction: Reduction::Rate, limit_deg: None, values: Box::new(values) }
    }

    /// A mean, median or root mean square of the units that have a value, in the unit `unit`: an error's, of which a root mean square is
    /// the better the less it is, a mean or median the nearer to 0, unless [`Definition::with_direction`] says otherwise.
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

    /// The same with another direction.
    #[must_use]
    pub fn with_direction(mut self, better: Better) -> Self {
        self.figure.sense.better = better;
        self
    }

    /// The same, one of lines of sight.
    #[must_use]
    pub fn resting_on_attitude(mut self) -> Self {
        self.figure.rests_on_attitude = true;
        self
    }

    /// The same, of errors below a limit, degrees.
    #[must_use]
    pub fn with_limit_deg(self, limit_deg: f64) -> Self {
        Self { limit_deg: Some(limit_deg), ..self }
    }

    /// The figure over some sequences of units, each in order of time.
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

    /// What one unit adds to the figure.
    pub fn term(&self, unit: &U) -> Term {
        let mut values = Vec::new();
        (self.values)(unit, &mut values);
        Term { sum: values.iter().sum(), of: values.len() as u32 }
    }
}

/// What one unit adds to a figure.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Term {
    /// The sum of its values; 0 without any.
    pub sum: f64,
    /// How many they are.
    pub of: u32,
}

/// The terms of all units for one figure.
#[derive(Debug, Clone, PartialEq)]
pub struct FigureTerms {
    /// Name of the figure.
    pub name: String,
    /// How its values are summed up.
    pub reduction: Reduction,
    /// Of a rate of errors "within" something: the limit, degrees.
    pub limit_deg: Option<f64>,
    /// Of a figure of lines of sight: the attitude that they rest on ([`crate::attitude_word`]).
    pub attitude: Option<String>,
    /// One a unit, in their order.
    pub terms: Vec<Term>,
}

impl FigureTerms {
    /// The same figure with the attitude that its lines of sight rest on, if `figure`, which it is of, is one of lines of sight.
    #[must_use]
    pub fn with_attitude(self, figure: &FigureSpec, attitude: Option<&String>) -> Self {
        Self { attitude: attitude.filter(|_| figure.rests_on_attitude).cloned(), ..self }
    }

    /// The terms of units by a definition.
    pub fn new<U>(definition: &Definition<'_, U>, units: &[U]) -> Self {
        Self::from_counted_units(definition, units, |_| true)
    }

    /// The terms of units by a definition; those that are not counted have no value.
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

    /// Terms that were counted, of a figure without a limit that rests on no attitude.
    pub fn from_terms(name: &str, reduction: Reduction, terms: Vec<Term>) -> Self {
        Self { name: name.to_owned(), reduction, limit_deg: None, attitude: None, terms }
    }
}

/// What became of one unit, for a list of those that changed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnitVerdict {
    /// Number of the frame, the field or the case.
    pub number: u64,
    /// Name of the group that it belongs to.
    pub group: String,
    /// The verdict's word.
    pub verdict: String,
    /// Why it was missed, or wrong in what.
    pub cause: Option<String>,
}

/// A scored run, unit by unit: what a comparison of two runs needs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct UnitTable {
    /// The units, by number.
    pub units: Vec<UnitVerdict>,
    /// What they say of each figure.
    pub figures: Vec<FigureTerms>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reduction_comes_back_from_its_word() {
        assert_eq!(Reduction::ALL.map(Reduction::code), ["rate", "mean", "rms", "median"]);
        assert_eq!(
            Reduction::ALL.map(|reduction| Reduction::parse(reduction.code())),
            Reduction::ALL.map(Some)
        );
        assert_eq!(Reduction::parse("mode"), None);
    }

    #[test]
    fn figures_of_lines_of_sight_alone_rest_on_an_attitude() {
        for figure in crate::figures() {
            let terms = FigureTerms::from_terms(&figure.name, Reduction::Mean, Vec::new());
            let rests = terms.with_attitude(&figure, Some(&"true".to_owned())).attitude.is_some();
            let is_of_lines_of_sight = ["ra_", "dec_"].iter().any(|axis| figure.name.starts_with(axis));
            assert_eq!(rests, is_of_lines_of_sight, "{figure}");
        }
    }

    #[test]
    fn a_unit_adds_the_sum_of_its_values_and_their_number() {
        let definition =
            Definition::pooled("held", "held", |unit: &u32, values| values.extend((0..*unit).map(f64::from)));
        assert_eq!(definition.term(&4), Term { sum: 6.0, of: 4 });
        assert_eq!(definition.term(&0), Term { sum: 0.0, of: 0 });
    }
}
