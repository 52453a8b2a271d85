//! Score of a plain world: verdicts and figures, counted frame by frame.

use files::{Failure, Row};
use indexmap::IndexMap;
use score::{Definition, Figure, FigureTerms, UnitTable, UnitVerdict};

use super::{Answer, Plain, PlainWorld};
use crate::world::{Judgement, Scorer};

/// Figure by which runs are judged: the fraction of verdicts that are [`CORRECT`].
pub(super) const CORRECT_RATE: &str = "correct_rate";

/// Verdict that the headline figure counts.
const CORRECT: &str = "correct";

/// A frame with its truth and the answer of the pipeline; none if there is no row, or the pipeline failed.
#[derive(Debug, Clone)]
pub struct Scored<P: PlainWorld> {
    /// Truth.
    pub truth: P::Truth,
    /// Answer.
    pub answer: Option<P::Answer>,
}

/// Returns all figures, the headline first.
pub(super) fn definitions<P: PlainWorld>() -> Vec<Definition<'static, Scored<P>>> {
    let correct = Definition::rate(CORRECT_RATE, "correct rate", |scored: &Scored<P>| {
        Some(P::judge(scored).0 == CORRECT)
    });
    [correct].into_iter().chain(P::figures()).collect()
}

/// Scores answers frame by frame.
pub struct UnitScorer<P: PlainWorld>(pub(super) Vec<Scored<P>>);

impl<P: PlainWorld> Default for UnitScorer<P> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<P: PlainWorld> Scorer<Plain<P>> for UnitScorer<P> {
    fn add(&mut self, truth: &P::Truth, (): &(), outcome: &Answer<P::Answer>) -> Result<(), Failure> {
        self.0.push(Scored { truth: truth.clone(), answer: outcome.as_ref().ok().cloned() });
        Ok(())
    }

    fn finish(self) -> UnitJudgement {
        let frames: Vec<&Scored<P>> = self.0.iter().collect();
        let definitions = definitions::<P>();
        let mut figures = IndexMap::new();
        let mut terms = Vec::new();
        for definition in &definitions {
            figures.insert(definition.figure.name.clone(), definition.figure(&[&frames]));
            terms.push(FigureTerms::new(definition, &self.0));
        }
        let units = self.0.iter().map(unit).collect();
        UnitJudgement { figures, units: UnitTable { units, figures: terms } }
    }
}

fn unit<P: PlainWorld>(scored: &Scored<P>) -> UnitVerdict {
    let (verdict, cause) = P::judge(scored);
    UnitVerdict { number: scored.truth.frame(), group: "all".to_owned(), verdict: verdict.to_owned(), cause }
}

/// A run that was scored frame by frame; `score.json` contains its figures.
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
