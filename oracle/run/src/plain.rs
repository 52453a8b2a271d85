//! Components for a world whose files are text tables and whose figures are counted unit by unit.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use contract::Interface;
use files::{CsvLine, CsvWriter, Failure, FileError};
use indexmap::IndexMap;
use score::{Definition, Figure, FigureTerms, UnitTable, UnitVerdict};

use crate::world::{Answers, Judgement, OutcomeOf, Scorer, TelemetryOf, World, paths};

/// Image format of a world with a single format, named `csv`.
#[derive(Debug, Clone, Copy)]
pub struct CsvImages;

impl CsvImages {
    /// Name of the format.
    pub const WORD: &'static str = "csv";
}

impl FromStr for CsvImages {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let refused = || format!("`{text}` is not a format of these images; expected {}", Self::WORD);
        if text == Self::WORD { Ok(Self) } else { Err(refused()) }
    }
}

/// Writes outcomes as one CSV file, a row per outcome.
pub struct CsvAnswers<L>(CsvWriter<L>);

impl<I: Interface, L: CsvLine + for<'a> From<(u64, &'a I::Outcome)>> Answers<I> for CsvAnswers<L> {
    fn files(measurements: &Path) -> Vec<PathBuf> {
        vec![measurements.to_owned()]
    }

    fn create(files: &[PathBuf]) -> Result<Self, FileError> {
        let [measurements] = paths(files)?;
        CsvWriter::create(measurements).map(Self)
    }

    fn add(&mut self, number: u64, _: &I::Telemetry, outcome: &I::Outcome) -> Result<(), FileError> {
        self.0.line(&L::from((number, outcome)))
    }

    fn finish(self) -> Result<(), FileError> {
        self.0.finish()
    }
}

/// A frame of a world with its outcome, in the form from which figures are counted.
pub trait ScoredUnit<W: World>: Sized {
    /// Creates the unit of an outcome.
    fn new(truth: &W::Truth, telemetry: &TelemetryOf<W>, outcome: &OutcomeOf<W>) -> Self;

    /// Returns the figures of the score, in the order of its file.
    fn definitions() -> Vec<Definition<'static, Self>>;

    /// Returns number, group, verdict and cause.
    fn verdict(&self) -> UnitVerdict;
}

/// Scores outcomes whose figures are counted unit by unit.
pub struct UnitScorer<U>(Vec<U>);

impl<U> Default for UnitScorer<U> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<W: World<Judgement = UnitJudgement>, U: ScoredUnit<W>> Scorer<W> for UnitScorer<U> {
    fn add(
        &mut self,
        truth: &W::Truth,
        telemetry: &TelemetryOf<W>,
        outcome: &OutcomeOf<W>,
    ) -> Result<(), Failure> {
        self.0.push(U::new(truth, telemetry, outcome));
        Ok(())
    }

    fn finish(self) -> UnitJudgement {
        let sequence: Vec<&U> = self.0.iter().collect();
        let definitions = U::definitions();
        let figure = |d: &Definition<'static, U>| (d.figure.name.clone(), d.figure(&[&sequence]));
        UnitJudgement {
            figures: definitions.iter().map(figure).collect(),
            units: UnitTable {
                units: self.0.iter().map(U::verdict).collect(),
                figures: definitions.iter().map(|figure| FigureTerms::new(figure, &self.0)).collect(),
            },
        }
    }
}

/// A run that was scored unit by unit; `score.json` contains its figures.
pub struct UnitJudgement {
    figures: IndexMap<String, Figure>,
    units: UnitTable,
}

impl Judgement for UnitJudgement {
    type Score = IndexMap<String, Figure>;

    fn score(&self) -> &Self::Score {
        &self.figures
    }

    fn figures(&self) -> &IndexMap<String, Figure> {
        &self.figures
    }

    fn units(&self) -> UnitTable {
        self.units.clone()
    }
}
