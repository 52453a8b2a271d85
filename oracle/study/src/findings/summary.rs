//! Summary of a study: figures with intervals, sensitivities, the worst cases.
use draws::{Effect, Seed};
use std::path::Path;

use files::{Failure, FileError};
use indexmap::IndexMap;
use pipeline::external::protocol::harmless;
use run::figure_by_name;
use score::Better;
use serde::{Deserialize, Serialize};
use statistics::{
    ClusterSum, MIN_CLUSTERS, cluster_rank_correlation, mean_difference_interval, rate_difference_interval,
};

use super::estimate::{
    Estimate, RESAMPLES, draws_needed, overall, pick, quantiles, share, sorted_quantile, stream, sums,
};
use super::requirement::{RequirementResult, RequirementVerdict, decide, swept_words};
use super::sensitivity::{RankCorrelation, SobolIndex, sobol_index};
use super::stopping::{StoppingStatus, stopping_status};
use crate::case_file::CaseFile;
use crate::cases::CaseFigure;
use crate::definition::Study;
use crate::definition::design::DesignKind;
use crate::evaluate::study_pipeline::StudyPipeline;

/// Number of worst cases that are listed.
const WORST: usize = 10;
/// Largest number of points of the sweep that a note lists.
const SHOWN_POINTS: usize = 8;

/// Summary of a figure over the cases.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FigureSummary {
    /// Number of cases in which the figure has a value.
    pub cases: u64,
    /// Estimate over all cases. For a rate: over the frames of all cases together, with the interval of
    /// Wilson for the number of independent frames that follows from the scatter between the draws. For
    /// another figure: the mean over the cases, with the interval by Student's t over the draws.
    pub all: Option<Estimate>,
    /// For a rate: number of draws from which its scatter follows from the draws, if there are fewer. A few
    /// bad draws among good ones determine the scatter; until then the interval is wider than necessary.
    pub draws_needed: Option<u64>,
    /// The value below which 5 % of the cases lie; its interval by fractional order statistics, absent if
    /// there are too few cases.
    pub p05: Option<Estimate>,
    /// The median of the cases.
    pub median: Option<Estimate>,
    /// The value below which 95 % of the cases lie.
    pub p95: Option<Estimate>,
}

/// Frequency of a cause of misses or wrong measurements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CauseSummary {
    /// Number of frames with this cause, over all cases.
    pub frames: u64,
    /// Number of cases with at least one such frame.
    pub cases: u64,
    /// Fraction of all frames that count, with the interval of a rate.
    pub share: Option<Estimate>,
}

/// A case that cannot be run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct CaseError {
    /// Number of the case.
    pub case: u64,
    /// Reason why the case's values do not form a valid scenario.
    pub error: String,
}

/// Figures of the cases at one point of the sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepPoint {
    /// Swept values at the point, by path.
    pub at: IndexMap<String, String>,
    /// Number of cases.
    pub cases: u64,
    /// Number of these cases that cannot be run, because their values do not form a valid scenario.
    #[serde(default, skip_serializing_if = "score::is_zero")]
    pub error_cases: u64,
    /// Number of these cases in which the pipeline failed.
    #[serde(default, skip_serializing_if = "score::is_zero")]
    pub failed_cases: u64,
    /// Figures by name.
    pub figures: IndexMap<String, FigureSummary>,
    /// Misses and wrong measurements by cause, as in `missed.cut_by_roi`; causes that did not occur are left
    /// out.
    #[serde(default)]
    pub causes: IndexMap<String, CauseSummary>,
}

/// Effect of one step of the sweep on a figure: the difference of two points that have the same draws.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepDifference {
    /// Name of the figure.
    pub figure: String,
    /// The swept values at the first point, by path.
    pub from: IndexMap<String, String>,
    /// The swept values at the second point, by path; exactly one of them differs from the first point.
    pub to: IndexMap<String, String>,
    /// Figure at the second point minus the figure at the first; a rate is taken over the frames of all
    /// draws, another figure as the mean over the draws that have it at both points.
    #[serde(flatten)]
    pub difference: Estimate,
    /// Number of draws that are compared.
    pub draws: u64,
}

/// One of the worst cases.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WorstCase {
    /// Number of the case.
    pub case: u64,
    /// Value of the figure that ranks the cases.
    pub value: f64,
    /// Drawn values, by path.
    pub drawn: IndexMap<String, String>,
    /// Command that runs the case again and keeps its frames, or, for a pipeline that no command can name,
    /// the call that does so.
    pub replay: String,
}

/// Summary of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Name of the study.
    pub study: String,
    /// Title of the study, in one line; empty in a summary of an earlier version.
    #[serde(default)]
    pub title: String,
    /// Hash of the study, its scenario and its pipeline.
    pub hash: String,
    /// Version of Boresight.
    pub version: String,
    /// Attitude that the lines of sight of the far range depend on ([`crate::CaseTable::attitude`]).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attitude: Option<String>,
    /// Number of first frames of every case, which count in no figure.
    #[serde(default, skip_serializing_if = "score::is_zero")]
    pub warm_up_frames: u64,
    /// Number of cases that were run.
    pub cases: u64,
    /// Number of cases requested: the largest number of cases.
    pub of: u64,
    /// Number of cases in which the pipeline failed: it crashed, exceeded its time limit, or returned an
    /// unreadable outcome.
    pub failed_cases: u64,
    /// Number of cases that cannot be run because their values do not form a valid scenario.
    #[serde(default)]
    pub error_cases: u64,
    /// The first of the cases that cannot be run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub errors: Vec<CaseError>,
    /// Number of independent draws among the cases: with a sweep, every draw is a case at each of its points;
    /// in a replicated design, every replication counts as one draw.
    #[serde(default)]
    pub draws: u64,
    /// True if the figure of the stopping rule is known accurately enough.
    pub is_narrow_enough: bool,
    /// State of the figure of the stopping rule; absent without a stopping rule.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub waited: Option<StoppingStatus>,
    /// Requirements with their verdicts: for each point of the sweep in turn.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub requirements: Vec<RequirementResult>,
    /// Figures by name.
    pub figures: IndexMap<String, FigureSummary>,
    /// Misses and wrong measurements by cause, as in `missed.cut_by_roi`; causes that did not occur are left
    /// out.
    #[serde(default)]
    pub causes: IndexMap<String, CauseSummary>,
    /// Figures and causes at each point of the sweep; empty without a sweep.
    pub sweep: Vec<SweepPoint>,
    /// Differences between points of the sweep that differ in one value, each draw compared with itself.
    #[serde(default)]
    pub differences: Vec<SweepDifference>,
    /// Rank correlations of figures with drawn values, by figure, the strongest first.
    pub correlations: Vec<RankCorrelation>,
    /// Sobol indices, if the design allows them.
    pub indices: Vec<SobolIndex>,
    /// Figure by which the worst cases are ranked.
    pub worst_by: String,
    /// Worst cases, the worst first; among equally bad cases, some that are spread over the study.
    pub worst: Vec<WorstCase>,
    /// Number of cases that are at least as bad as the last of the worst cases.
    #[serde(default)]
    pub worst_of: u64,
}

impl SweepPoint {
    /// Returns the swept values in words, as in `sensor.read_noise_e = 5`.
    pub fn at_words(&self) -> String {
        swept_words(&self.at)
    }
}

impl Summary {
    /// Returns the statements about cases that limit the figures, one sentence or more each: a figure of
    /// `until` that cannot stop the study, failures of the pipeline, cases that cannot be run, and points of
    /// the sweep at which no case can be run, or in every case of which the pipeline failed.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.waited == Some(StoppingStatus::NearlyConstant) {
            notes.push(
                "The figure of `until` is equal in nearly every draw: its scatter is unknown, and the study \
                 did not stop by it. Choose a figure that varies."
                    .to_owned(),
            );
        }
        if self.failed_cases > 0 {
            let cases = self.failed_cases;
            notes.push(format!(
                "The pipeline failed in {cases} cases: it crashed, timed out, or returned an unreadable \
                 outcome."
            ));
        }
        if let Some(first) = self.errors.first() {
            notes.push(format!(
                "{} cases cannot be run: their values give no valid scenario (`error` in cases.parquet). \
                 The first is case {}: {}",
                self.error_cases,
                first.case,
                harmless(&first.error)
            ));
        }
        let needed = |(name, figure): (&String, &FigureSummary)| {
            figure
                .draws_needed
                .map(|draws| format!("{} from {draws} draws", figure_by_name(name).label_without_percent()))
        };
        let wanted: Vec<String> = self.figures.iter().filter_map(needed).collect();
        if !wanted.is_empty() {
            notes.push(format!(
                "A few of the {} draws determine the scatter of some rates, whose intervals are wider than \
                 necessary until there are more draws: {}.",
                self.draws,
                wanted.join(", ")
            ));
        }
        notes.extend(self.points_note(
            |point| point.error_cases == point.cases,
            "without a result, because none of their cases can be run: differences and curves leave them out",
        ));
        notes.extend(self.points_note(
            |point| point.failed_cases > 0 && point.failed_cases + point.error_cases == point.cases,
            "at which the pipeline failed in every case that can be run: their figures describe the failure",
        ));
        notes
    }

    /// Returns the statement about those points of the sweep for which `applies` is true; `None` if there
    /// are none.
    fn points_note(&self, applies: impl Fn(&SweepPoint) -> bool, what: &str) -> Option<String> {
        let points: Vec<&SweepPoint> = self.sweep.iter().filter(|point| applies(point)).collect();
        let shown: Vec<String> = points.iter().take(SHOWN_POINTS).map(|point| point.at_words()).collect();
        let more = points.len().saturating_sub(SHOWN_POINTS);
        let more = if more > 0 { format!("; and {more} more") } else { String::new() };
        (!points.is_empty()).then(|| {
            let shown = harmless(&shown.join("; "));
            format!("{} of {} sweep points {what}. {shown}{more}.", points.len(), self.sweep.len())
        })
    }

    /// Returns the verdict on all requirements together: not met if one is not met at a point of the sweep,
    /// met if all are met at every point. `None` without requirements.
    pub fn verdict(&self) -> Option<RequirementVerdict> {
        let has = |verdict| self.requirements.iter().any(|result| result.verdict == verdict);
        if has(RequirementVerdict::NotMet) {
            Some(RequirementVerdict::NotMet)
        } else if has(RequirementVerdict::NotDecided) {
            Some(RequirementVerdict::NotDecided)
        } else {
            (!self.requirements.is_empty()).then_some(RequirementVerdict::Met)
        }
    }

    /// Summarises the cases of a study with a pipeline; `path` is the study's file, used in the commands.
    /// Figures are read one after another.
    ///
    /// # Errors
    /// A [`Failure`] for a file of cases that cannot be read.
    pub(crate) fn new(
        study: &Study,
        pipeline: &dyn StudyPipeline,
        path: &Path,
        cases: &CaseFile,
    ) -> Result<Self, Failure> {
        let mut found = Findings::new(study, cases)?;
        for (place, name) in cases.figures().iter().enumerate() {
            let values = cases.figure(name)?.unwrap_or_default();
            found.add_figure(place, name, &values);
        }
        for name in cases.causes() {
            found.add_cause(name, &cases.cause(name)?);
        }
        found.sort_causes();
        let Findings { sweep, differences, decided, figures, causes, waited_for, .. } = found;
        let worst_by = study.worst_by();
        let replay = |case| pipeline.replay(study, path, case);
        let (worst, worst_of) = worst(cases, &worst_by, study.file.seed, replay)?;
        let case_error = |(case, error): &(u64, String)| CaseError { case: *case, error: error.clone() };
        Ok(Self {
            study: study.name.clone(),
            title: study.file.title.clone(),
            hash: study.hash_with(pipeline),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            attitude: cases.attitude(study.granted_attitude())?,
            warm_up_frames: study.warm_up_frames(),
            cases: cases.count(),
            of: study.cases(),
            failed_cases: count_true(&cases.has_failed),
            draws: cases.draws.last().map_or(0, |last| *last as u64 + 1),
            is_narrow_enough: waited_for == Some(StoppingStatus::NarrowEnough),
            waited: waited_for,
            error_cases: count_true(&cases.has_error),
            errors: cases.errors.iter().map(case_error).collect(),
            requirements: decided.into_iter().flatten().flatten().collect(),
            figures,
            causes,
            differences: differences.into_iter().flatten().collect(),
            sweep,
            correlations: found.correlations,
            indices: found.indices,
            worst,
            worst_of,
            worst_by,
        })
    }
}

/// Findings of a study, figure by figure.
struct Findings<'a> {
    study: &'a Study,
    cases: &'a CaseFile,
    points: Points,
    /// Drawn numbers of each parameter that has numbers.
    parameters: Vec<(&'a String, Vec<f64>)>,
    sweep: Vec<SweepPoint>,
    /// Pairs of points that differ in one value.
    pairs: Vec<[usize; 2]>,
    /// Differences of the figures by pair.
    differences: Vec<Vec<SweepDifference>>,
    /// By point (a single entry for all cases without a sweep), then by requirement.
    decided: Vec<Vec<Option<RequirementResult>>>,
    figures: IndexMap<String, FigureSummary>,
    causes: IndexMap<String, CauseSummary>,
    waited_for: Option<StoppingStatus>,
    correlations: Vec<RankCorrelation>,
    indices: Vec<SobolIndex>,
}

impl<'a> Findings<'a> {
    fn new(study: &'a Study, cases: &'a CaseFile) -> Result<Self, Failure> {
        let points = Points::new(study, cases)?;
        let mut sweep = Vec::with_capacity(points.at.len());
        for (point, at) in points.at.iter().enumerate() {
            sweep.push(points.summary(point, at, cases));
        }
        let mut parameters = Vec::new();
        for name in cases.drawn_columns() {
            parameters.extend(cases.numbers(name)?.map(|numbers| (name, numbers)));
        }
        let pairs = points.pairs();
        Ok(Self {
            study,
            cases,
            parameters,
            differences: vec![Vec::new(); pairs.len()],
            pairs,
            decided: vec![vec![None; study.file.require.len()]; sweep.len().max(1)],
            sweep,
            points,
            figures: IndexMap::new(),
            causes: IndexMap::new(),
            waited_for: None,
            correlations: Vec::new(),
            indices: Vec::new(),
        })
    }

    /// Adds a figure, the one at `place` among all, with its value in each case.
    fn add_figure(&mut self, place: usize, name: &str, values: &[CaseFigure]) {
        let draws = &self.cases.draws;
        self.figures.insert(name.to_owned(), figure(name, values, draws));
        for (point, summary) in self.sweep.iter_mut().enumerate() {
            let at_point = figure(name, &self.points.pick(point, values), &self.points.pick(point, draws));
            summary.figures.insert(name.to_owned(), at_point);
        }
        self.add_differences(name, values);
        self.decide_requirements(name, values);
        let until = self.study.file.stop.until.as_ref().filter(|until| until.figure == *name);
        if let Some(until) = until {
            self.waited_for = Some(stopping_status(until, values, draws));
        }
        self.correlations.extend(correlations_of(name, values, &self.parameters, draws));
        if self.study.file.design == DesignKind::Saltelli {
            self.indices.extend(indices_of(name, place, values, self.cases, self.study.file.seed));
        }
    }

    /// Adds the difference of a figure between the points of each pair.
    fn add_differences(&mut self, name: &str, values: &[CaseFigure]) {
        for (index, pair) in self.pairs.iter().enumerate() {
            let of_pair = pair
                .map(|point| (self.points.pick(point, values), self.points.pick(point, &self.cases.draws)));
            let [from, to] = pair.map(|point| self.points.at.get(point).cloned().unwrap_or_default());
            let [first, second] = &of_pair;
            if let Some((difference, draws)) = difference(name, [first, second]) {
                let figure = name.to_owned();
                self.differences[index].push(SweepDifference { figure, from, to, difference, draws });
            }
        }
    }

    /// Decides the requirements on a figure, at each point. Cases that cannot be run do not count.
    fn decide_requirements(&mut self, name: &str, values: &[CaseFigure]) {
        for (number, requirement) in self.study.file.require.iter().enumerate() {
            if requirement.figure != *name {
                continue;
            }
            for (point, decided) in self.decided.iter_mut().enumerate() {
                let (at, rows) = match self.points.at.get(point) {
                    Some(at) => (at.clone(), self.points.pick(point, &self.points.rows)),
                    None => (IndexMap::new(), (0..values.len()).collect()),
                };
                let (mut counted, mut draws) = (Vec::new(), Vec::new());
                for row in rows {
                    if !self.cases.has_error[row] {
                        counted.push(values[row]);
                        draws.push(self.cases.draws[row]);
                    }
                }
                decided[number] = decide(requirement, &counted, &draws, &at);
            }
        }
    }

    /// Adds a cause with its count in each case.
    fn add_cause(&mut self, name: &str, counts: &[CaseFigure]) {
        let draws = &self.cases.draws;
        if let Some(all) = cause(counts, draws) {
            self.causes.insert(name.to_owned(), all);
        }
        for (point, summary) in self.sweep.iter_mut().enumerate() {
            let at_point = cause(&self.points.pick(point, counts), &self.points.pick(point, draws));
            if let Some(at_point) = at_point {
                summary.causes.insert(name.to_owned(), at_point);
            }
        }
    }

    /// Sorts causes by their number of frames, the most frequent first.
    fn sort_causes(&mut self) {
        let of_points = self.sweep.iter_mut().map(|point| &mut point.causes);
        for causes in of_points.chain([&mut self.causes]) {
            causes.sort_by(|_, a, _, b| b.frames.cmp(&a.frames));
        }
    }
}

fn count_true(cases: &[bool]) -> u64 {
    cases.iter().filter(|case| **case).count() as u64
}

fn figure(name: &str, cases: &[CaseFigure], draws: &[usize]) -> FigureSummary {
    let [p05, median, p95] = quantiles(cases, draws, [0.05, 0.5, 0.95]);
    let count = cases.iter().filter(|case| case.value.is_some()).count() as u64;
    FigureSummary {
        cases: count,
        all: overall(name, cases, draws),
        draws_needed: draws_needed(name, cases, draws),
        p05,
        median,
        p95,
    }
}

/// Summarises a cause over the cases; `None` if it did not occur.
fn cause(cases: &[CaseFigure], draws: &[usize]) -> Option<CauseSummary> {
    let frames = cases.iter().map(|case| case.count).sum();
    let share = share(cases, draws);
    let cases = cases.iter().filter(|case| case.count > 0).count() as u64;
    (frames > 0).then_some(CauseSummary { frames, cases, share })
}

/// Points of a sweep; empty without a sweep.
struct Points {
    /// Swept values at each point, by path.
    at: Vec<IndexMap<String, String>>,
    /// For each point, the indices of its cases within a draw. Equal values of a sweep are one point.
    of_draw: Vec<Vec<usize>>,
    /// Number of cases per draw.
    together: usize,
    /// Number of each case.
    rows: Vec<usize>,
}

impl Points {
    fn new(study: &Study, cases: &CaseFile) -> Result<Self, FileError> {
        let rows: Vec<usize> = (0..cases.count() as usize).collect();
        let (swept, together) = (study.file.sweep.len(), study.sweep_points() as usize);
        let mut points: IndexMap<Vec<String>, Vec<usize>> = IndexMap::new();
        if swept > 0 {
            let first: Vec<usize> = rows.iter().copied().take(together).collect();
            for (place, drawn) in cases.drawn_value_texts(&first)?.into_iter().enumerate() {
                points.entry(drawn.into_iter().take(swept).collect()).or_default().push(place);
            }
        }
        // A parameter with one value is a setting of the study, and points that do not differ are none.
        let (mut at, mut of_draw): (Vec<Vec<String>>, Vec<Vec<usize>>) = points.into_iter().unzip();
        let first = at.first().cloned().unwrap_or_default();
        let differs = |column: usize| at.iter().any(|point| point.get(column) != first.get(column));
        let differing: Vec<bool> = (0..swept).map(differs).collect();
        if at.len() == 1 {
            (at, of_draw) = (Vec::new(), Vec::new());
        }
        let named = |point: Vec<String>| {
            let values = cases.drawn_columns().cloned().zip(point).zip(&differing);
            values.filter(|(_, differs)| **differs).map(|(value, _)| value).collect()
        };
        let at = at.into_iter().map(named).collect();
        Ok(Self { at, of_draw, together, rows })
    }

    /// Returns the values of a column at a point, in the order of the draws.
    fn pick<T: Copy>(&self, point: usize, column: &[T]) -> Vec<T> {
        let places = &self.of_draw[point];
        column
            .chunks(self.together)
            .flat_map(|draw| places.iter().filter_map(|place| draw.get(*place).copied()))
            .collect()
    }

    /// Returns the pairs of points that differ in one value.
    fn pairs(&self) -> Vec<[usize; 2]> {
        let differ = |[a, b]: &[usize; 2]| {
            let values = self.at[*a].values().zip(self.at[*b].values());
            values.filter(|(a, b)| a != b).count() == 1
        };
        let all = (0..self.at.len()).flat_map(|a| (a + 1..self.at.len()).map(move |b| [a, b]));
        all.filter(differ).collect()
    }

    fn summary(&self, point: usize, at: &IndexMap<String, String>, cases: &CaseFile) -> SweepPoint {
        SweepPoint {
            at: at.clone(),
            cases: self.pick(point, &cases.draws).len() as u64,
            error_cases: count_true(&self.pick(point, &cases.has_error)),
            failed_cases: count_true(&self.pick(point, &cases.has_failed)),
            figures: IndexMap::new(),
            causes: IndexMap::new(),
        }
    }
}

/// Returns the figure at the second of two points minus the figure at the first, over the draws that have it
/// at both points, and the number of these draws.
fn difference(name: &str, points: [&(Vec<CaseFigure>, Vec<usize>); 2]) -> Option<(Estimate, u64)> {
    let is_rate = figure_by_name(name).is_rate();
    let [first, second] = points.map(|(cases, draws)| sums(is_rate, cases, draws));
    let pairs: Vec<(ClusterSum, ClusterSum)> = first
        .into_iter()
        .zip(second)
        .filter(|(first, second)| first.count > 0.0 && second.count > 0.0)
        .collect();
    let ratio = |pick: fn(&(ClusterSum, ClusterSum)) -> ClusterSum| {
        let (sum, of) =
            pairs.iter().map(pick).fold((0.0, 0.0), |(sum, of), draw| (sum + draw.sum, of + draw.count));
        (of > 0.0).then(|| sum / of)
    };
    let value = ratio(|pair| pair.1)? - ratio(|pair| pair.0)?;
    let interval = if is_rate { rate_difference_interval(&pairs) } else { mean_difference_interval(&pairs) };
    Some((Estimate::new(value, interval), pairs.len() as u64))
}

/// Returns the rank correlation of a figure with each drawn number, the strongest first.
fn correlations_of(
    figure: &str,
    values: &[CaseFigure],
    parameters: &[(&String, Vec<f64>)],
    draws: &[usize],
) -> Vec<RankCorrelation> {
    let mut all = Vec::new();
    for (parameter, numbers) in parameters {
        let cases = draws.iter().zip(numbers.iter().zip(values));
        let triples: Vec<(usize, f64, f64)> =
            cases.filter_map(|(draw, (x, y))| Some((*draw, *x, y.value?))).collect();
        let Some((correlation, interval)) = cluster_rank_correlation(&triples) else { continue };
        all.push(RankCorrelation {
            parameter: (*parameter).clone(),
            figure: figure.to_owned(),
            correlation,
            low: interval.map(|interval| interval.low),
            high: interval.map(|interval| interval.high),
            cases: triples.len() as u64,
        });
    }
    all.sort_by(|a, b| b.correlation.abs().total_cmp(&a.correlation.abs()));
    all
}

/// Computes the Sobol indices of a figure over Saltelli's design, from those blocks of d + 2 cases in which
/// every case has the figure.
fn indices_of(
    figure: &str,
    place: usize,
    values: &[CaseFigure],
    cases: &CaseFile,
    seed: u64,
) -> Vec<SobolIndex> {
    let parameters: Vec<&String> = cases.drawn_columns().collect();
    let blocks: Vec<Vec<f64>> = values
        .chunks_exact(parameters.len() + 2)
        .filter_map(|cases| cases.iter().map(|case| case.value).collect())
        .collect();
    let mut all = Vec::new();
    if blocks.len() >= MIN_CLUSTERS {
        for (i, parameter) in parameters.iter().enumerate() {
            let index = |picked: &dyn Fn(usize) -> usize| {
                let column = |member: usize| -> Vec<f64> {
                    (0..blocks.len()).map(|k| blocks[picked(k)][member]).collect()
                };
                sobol_index(&column(0), &column(1), &column(2 + i))
            };
            let Some((first, total)) = index(&|k| k) else { continue };
            let mut stream = stream(seed, place as u64);
            let mut again: [Vec<f64>; 2] = Default::default();
            for _ in 0..RESAMPLES {
                let order: Vec<usize> = (0..blocks.len()).map(|_| pick(&mut stream, blocks.len())).collect();
                if let Some((first, total)) = index(&|k| order[k]) {
                    again[0].push(first);
                    again[1].push(total);
                }
            }
            let interval = |values: &mut Vec<f64>, value: f64| {
                values.sort_by(f64::total_cmp);
                if values.is_empty() {
                    return [value; 2];
                }
                [sorted_quantile(values, 0.025).min(value), sorted_quantile(values, 0.975).max(value)]
            };
            let [of_first, of_total] = &mut again;
            all.push(SobolIndex {
                parameter: (*parameter).clone(),
                figure: figure.to_owned(),
                first,
                first_interval: interval(of_first, first),
                total,
                total_interval: interval(of_total, total),
            });
        }
    }
    all
}

/// Returns the worst cases, and the number of cases that are at least as bad as the last of them. The choice
/// among equally bad cases is random, which spreads them over all draws.
fn worst(
    cases: &CaseFile,
    by: &str,
    seed: u64,
    replay: impl Fn(u64) -> String,
) -> Result<(Vec<WorstCase>, u64), FileError> {
    let badness = |value: f64| match figure_by_name(by).sense.better {
        Better::More => -value,
        Better::Less => value,
        Better::Near(best) => (value - best).abs(),
    };
    let values = cases.figure(by)?.unwrap_or_default();
    let values = values.iter().enumerate().filter_map(|(case, figure)| Some((case, figure.value?)));
    let mut bad: Vec<(usize, f64)> = values.collect();
    let lot = |case: usize| Seed { seed, case: case as u64 }.streams(0, Effect::WorstCases).word(0);
    bad.sort_by_cached_key(|(case, _)| (lot(*case), *case));
    bad.sort_by(|a, b| badness(b.1).total_cmp(&badness(a.1)));
    let last = bad.get(WORST.min(bad.len()).wrapping_sub(1)).map(|(_, value)| badness(*value));
    let count = last.map_or(0, |last| bad.iter().filter(|(_, value)| badness(*value) >= last).count());
    bad.truncate(WORST);
    let numbers: Vec<usize> = bad.iter().map(|(case, _)| *case).collect();
    let named = |((case, value), shown): ((usize, f64), Vec<String>)| WorstCase {
        case: case as u64,
        value,
        drawn: cases.drawn_columns().cloned().zip(shown).collect(),
        replay: replay(case as u64),
    };
    Ok((bad.into_iter().zip(cases.drawn_value_texts(&numbers)?).map(named).collect(), count as u64))
}
