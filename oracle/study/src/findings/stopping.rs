//! Stopping rule of a study, which ends when a figure is known accurately enough.

use serde::{Deserialize, Serialize};

use super::estimate::overall;
use crate::cases::{CaseFigure, CaseTable};
use crate::definition::Study;
use crate::definition::file::Until;

/// Number of draws before the first test, and smallest number from one test to the next.
const STEP: u64 = 16;
/// Inverse of the smallest relative growth in the number of draws from one test to the next.
const PARTS: u64 = 16;
/// Smallest number of draws with a value other than the most frequent one; with fewer, the scatter is
/// unknown.
const MIN_OTHER_VALUES: usize = 8;

/// State of the figure of a stopping rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StoppingStatus {
    /// The figure's interval is as narrow as required.
    NarrowEnough,
    /// The figure's interval is too wide, or the figure has none.
    TooWide,
    /// The figure has the same value in nearly every draw: its scatter is unknown, however narrow its
    /// interval.
    NearlyConstant,
}

/// Test whether the figure of a stopping rule is known accurately enough: after 16 draws, 32, 48, from 256 on
/// after each further sixteenth, and after all draws. A draw is one case at every point of the sweep. Neither
/// the tests nor the end of the study depend on the division into shards.
pub(crate) struct StoppingRule<'a> {
    until: Option<&'a Until>,
    points: u64,
    most: u64,
    /// Number of draws at the next test.
    next: u64,
    /// Values of the figure in all cases added so far; `draws` has the number of each case's draw.
    figures: Vec<CaseFigure>,
    draws: Vec<usize>,
}

impl<'a> StoppingRule<'a> {
    /// Creates the test, before the first case.
    pub(crate) fn new(study: &'a Study) -> Self {
        Self::from_rule(study.file.stop.until.as_ref(), study.sweep_points(), study.cases())
    }

    fn from_rule(until: Option<&'a Until>, points: u64, cases: u64) -> Self {
        let most = cases / points;
        Self { until, points, most, next: STEP.min(most), figures: Vec::new(), draws: Vec::new() }
    }

    /// Adds the next cases; returns the number of cases that are enough, once it is known.
    pub(crate) fn add(&mut self, cases: &CaseTable) -> Option<u64> {
        let until = self.until?;
        self.figures.extend(cases.figure(&until.figure)?);
        let known = self.draws.len() as u64..self.figures.len() as u64;
        self.draws.extend(known.map(|case| (case / self.points) as usize));
        while self.next * self.points <= self.figures.len() as u64 {
            let draws = self.next;
            let cases = draws * self.points;
            let (figures, of_cases) =
                (self.figures.get(..cases as usize)?, self.draws.get(..cases as usize)?);
            if stopping_status(until, figures, of_cases) == StoppingStatus::NarrowEnough {
                return Some(cases);
            }
            if draws >= self.most {
                return None;
            }
            self.next = (draws + (draws / PARTS).max(STEP)).min(self.most);
        }
        None
    }
}

/// Returns the state of the figure of a stopping rule over cases, whose draws have the numbers `draws`.
pub(crate) fn stopping_status(until: &Until, figures: &[CaseFigure], draws: &[usize]) -> StoppingStatus {
    let estimate = overall(&until.figure, figures, draws);
    let width = estimate.and_then(|estimate| Some(estimate.high? - estimate.low?));
    if !width.is_some_and(|width| width <= 2.0 * until.half_width) {
        return StoppingStatus::TooWide;
    }
    let others = figures.len() - most_frequent(figures.iter().filter_map(|figure| figure.value));
    // Equal cases of a draw count as one.
    let points = figures.len() / draws.iter().max().map_or(1, |last| last + 1);
    if others / points.max(1) < MIN_OTHER_VALUES {
        StoppingStatus::NearlyConstant
    } else {
        StoppingStatus::NarrowEnough
    }
}

/// Returns how often the most frequent value occurs.
fn most_frequent(values: impl Iterator<Item = f64>) -> usize {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.chunk_by(|a, b| a == b).map(<[f64]>::len).max().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::CaseRow;
    use draws::{Effect, Seed, Stream, normal, uniform};

    fn stopped(
        study: u64,
        (figure, half_width): (&str, f64),
        points: u64,
        case: impl Fn(&mut Stream, &mut dyn FnMut(CaseFigure)),
    ) -> (u64, f64) {
        crate::figures_of_tests::register();
        let until = Until { figure: figure.to_owned(), half_width };
        let mut stopping = StoppingRule::from_rule(Some(&until), points, 4000 * points);
        let mut table = CaseTable::from_rows(&[figure], Vec::new());
        for draw in 0..4000 {
            let random = &mut Seed { seed: 5, case: study }.stream(draw, Effect::StudyParameter, 0);
            let mut of_draw = table.with_rows(Vec::new());
            case(random, &mut |figure| {
                let case = (table.rows.len() + of_draw.rows.len()) as u64;
                of_draw.rows.push(CaseRow::from_figures(case, draw, vec![figure]));
            });
            table.rows.extend(of_draw.rows.iter().cloned());
            if let Some(cases) = stopping.add(&of_draw) {
                assert_eq!(cases, table.rows.len() as u64);
                break;
            }
        }
        let cases = table.figure(figure).unwrap();
        (table.rows.len() as u64, overall(figure, &cases, &table.draws()).unwrap().value)
    }

    /// Returns the standard deviation, over 400 studies, of the figure at the stop, relative to the one that
    /// the interval implies.
    fn scatter_over_requested(
        rule: (&str, f64),
        points: u64,
        case: impl Fn(&mut Stream, &mut dyn FnMut(CaseFigure)),
    ) -> (f64, f64) {
        let studies = 400;
        let ended: Vec<(u64, f64)> = (0..studies).map(|study| stopped(study, rule, points, &case)).collect();
        let mean = ended.iter().map(|(_, value)| value).sum::<f64>() / studies as f64;
        let square: f64 = ended.iter().map(|(_, value)| (value - mean) * (value - mean)).sum();
        let cases = ended.iter().map(|(cases, _)| *cases as f64).sum::<f64>() / studies as f64;
        ((square / (studies - 1) as f64).sqrt() / (rule.1 / statistics::Z_95), cases)
    }

    /// A standard deviation from 400 values has a relative standard deviation of 3.5 %.
    #[test]
    fn the_scatter_of_stopped_studies_has_the_requested_width() {
        for half_width in [0.03, 0.015] {
            let (rate, draws) = scatter_over_requested(("correct_rate", half_width), 4, |random, add| {
                let of_draw = 0.6 + 0.4 * uniform(random);
                for less in [0.0, 0.1, 0.2, 0.3] {
                    let count = (0..25).filter(|_| uniform(random) < of_draw - less).count() as u64;
                    add(CaseFigure { value: Some(count as f64 / 25.0), count, of: 25 });
                }
            });
            println!(
                "rate, half width {half_width}: {rate:.2} of the requested scatter after {draws:.0} cases"
            );
            assert!(
                (0.85..1.15).contains(&rate),
                "{half_width}: {rate} of the requested scatter after {draws} cases"
            );
            let (mean, draws) =
                scatter_over_requested(("ra_rms_deg", half_width * 10.0), 1, |random, add| {
                    add(CaseFigure { value: Some(5.0 + normal(random)), count: 1, of: 1 });
                });
            println!(
                "mean, half width {half_width}: {mean:.2} of the requested scatter after {draws:.0} cases"
            );
            assert!(
                (0.85..1.15).contains(&mean),
                "{half_width}: {mean} of the requested scatter after {draws} cases"
            );
        }
    }

    /// All of 25 frames are hits in 97 of 100 draws: the interval is narrow from the first test on, although
    /// the scatter is unknown.
    #[test]
    fn a_figure_that_is_nearly_constant_is_not_waited_for() {
        let until = Until { figure: "hit_rate".to_owned(), half_width: 0.03 };
        let row = |case: u64, others: u64| {
            let count = if case < others { 24 } else { 25 };
            let figures = vec![CaseFigure { value: Some(count as f64 / 25.0), count, of: 25 }];
            CaseRow::from_figures(case, case, figures)
        };
        let table =
            |others| CaseTable::from_rows(&["hit_rate"], (0..100).map(|case| row(case, others)).collect());
        let draws: Vec<usize> = (0..100).collect();
        let after = |others, half_width| {
            let figures = table(others).figure("hit_rate").unwrap();
            stopping_status(&Until { half_width, ..until.clone() }, &figures, &draws)
        };
        assert_eq!(after(3, 0.03), StoppingStatus::NearlyConstant);
        assert_eq!(after(7, 0.03), StoppingStatus::NearlyConstant);
        assert_eq!(after(8, 0.03), StoppingStatus::NarrowEnough);
        assert_eq!(after(8, 0.0001), StoppingStatus::TooWide);
        assert_eq!(StoppingRule::from_rule(Some(&until), 1, 100).add(&table(3)), None);
        // The first test with eight draws of either value.
        assert_eq!(StoppingRule::from_rule(Some(&until), 1, 100).add(&table(60)), Some(80));
    }
}
