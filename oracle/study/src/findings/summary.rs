//! What a study found: figures with intervals, sensitivities, the worst cases.
use std::path::Path;

use indexmap::IndexMap;
use run::figure_called;
use score::Better;
use serde::{Deserialize, Serialize};
use sim::randomness::{Effect, Seed};
use statistics::{
    ClusterSum, LEAST_CLUSTERS, cluster_rank_correlation, mean_difference_interval, rate_difference_interval,
};

use super::estimate::{Estimate, RESAMPLES, overall, pick, quantiles, share, sorted_quantile, stream, sums};
use super::requirement::{RequirementResult, RequirementVerdict, decide};
use super::sensitivity::{RankCorrelation, SobolIndex, sobol_index};
use super::stopping::{Waited, waited};
use crate::cases::{CaseFigure, CaseRow, CaseTable, Drawn};
use crate::definition::Study;
use crate::definition::design::DesignKind;
use crate::evaluate::tried::StudyPipeline;

/// How many of the worst cases are named.
const WORST: usize = 10;

/// What the cases say of a figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FigureSummary {
    /// Cases in which it has a value.
    pub cases: u64,
    /// Of a rate: all frames of all cases together, with the interval of Wilson for as many independent frames as the scatter
    /// between the draws tells. Of another figure: the mean of the cases, its interval by Student's t over the draws.
    pub all: Option<Estimate>,
    /// The value that 5 % of the cases are below; its interval by fractional order statistics, absent where too few cases are known.
    pub p05: Option<Estimate>,
    /// The median of the cases.
    pub median: Option<Estimate>,
    /// The value that 95 % of the cases are below.
    pub p95: Option<Estimate>,
}

/// How often a cause kept frames from being right.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CauseSummary {
    /// Frames of all cases together.
    pub frames: u64,
    /// Cases with such a frame.
    pub cases: u64,
    /// Share of all frames that count, with the interval of a rate.
    pub share: Option<Estimate>,
}

/// A case that cannot be run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct CaseError {
    /// Its number.
    pub case: u64,
    /// Why its values make no scenario.
    pub error: String,
}

/// Figures of the cases at one point of the sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepPoint {
    /// The swept values there, by path.
    pub at: IndexMap<String, String>,
    /// Number of cases.
    pub cases: u64,
    /// Figures by name.
    pub figures: IndexMap<String, FigureSummary>,
    /// Misses and wrong answers by cause, as in `missed.cut_by_roi`; causes that did not occur are left out.
    #[serde(default)]
    pub causes: IndexMap<String, CauseSummary>,
}

/// What one step of the sweep makes of a figure: the difference of two points that have the same draws.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepDifference {
    /// Name of the figure.
    pub figure: String,
    /// The swept values at the first point, by path.
    pub from: IndexMap<String, String>,
    /// The swept values at the second point, of which one differs.
    pub to: IndexMap<String, String>,
    /// The figure at the second point less that at the first; of a rate over the frames of all draws, of another figure the mean over
    /// the draws that have it at both points.
    #[serde(flatten)]
    pub difference: Estimate,
    /// Draws that are compared.
    pub draws: u64,
}

/// A case that came out badly.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WorstCase {
    /// Its number.
    pub case: u64,
    /// The figure by which it is bad.
    pub value: f64,
    /// What was drawn, by path.
    pub drawn: IndexMap<String, String>,
    /// What runs it again: the command, which keeps its frames, or of a pipeline that no command can name the call.
    pub replay: String,
}

/// The summary of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Name of the study.
    pub study: String,
    /// What it is, in one line; empty in a summary of an earlier version.
    #[serde(default)]
    pub title: String,
    /// Hash of the study, its scenario and its pipeline.
    pub hash: String,
    /// Version of Boresight.
    pub version: String,
    /// The attitude that the lines of sight of the far range rest on ([`CaseTable::attitude`]).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attitude: Option<String>,
    /// The first frames of every case, which count in no figure.
    #[serde(default, skip_serializing_if = "score::is_zero")]
    pub warm_up_frames: u64,
    /// Cases that were run.
    pub cases: u64,
    /// Cases that were asked for, the most there are.
    pub of: u64,
    /// Cases in which the pipeline itself failed: it crashed, gave no answer in time, or none that can be read.
    pub failed_cases: u64,
    /// Cases that cannot be run, as their values make no scenario.
    #[serde(default)]
    pub error_cases: u64,
    /// The first of them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub errors: Vec<CaseError>,
    /// Independent draws among them: with a sweep, every draw is a case at each of its points.
    #[serde(default)]
    pub draws: u64,
    /// Whether the figure of the stopping rule is known well enough.
    pub is_narrow_enough: bool,
    /// What is known of the figure of the stopping rule; absent without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub waited: Option<Waited>,
    /// What is required, with its verdicts: at each point of the sweep, point by point.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub requirements: Vec<RequirementResult>,
    /// Figures by name.
    pub figures: IndexMap<String, FigureSummary>,
    /// Misses and wrong answers by cause, as in `missed.cut_by_roi`; causes that did not occur are left out.
    #[serde(default)]
    pub causes: IndexMap<String, CauseSummary>,
    /// The same at each point of the sweep; empty without one.
    pub sweep: Vec<SweepPoint>,
    /// Differences between points of the sweep that differ in one value, each draw compared with itself.
    #[serde(default)]
    pub differences: Vec<SweepDifference>,
    /// How figures go with what was drawn, by figure, the strongest first.
    pub correlations: Vec<RankCorrelation>,
    /// Sobol indices, where the design allows them.
    pub indices: Vec<SobolIndex>,
    /// The figure that the worst cases are the worst by.
    pub worst_by: String,
    /// The worst cases, the worst first; of equally bad ones some that are spread over the study.
    pub worst: Vec<WorstCase>,
    /// Cases that are as bad as the last of these, or worse.
    #[serde(default)]
    pub worst_of: u64,
}

impl Summary {
    /// The verdict on all requirements together: not met when one is not met at a point of the sweep, met when all are met everywhere.
    /// `None` without requirements.
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

    /// The summary of some cases of a study by a pipeline; `path` is the study's file, for the commands.
    pub fn new(study: &Study, pipeline: &dyn StudyPipeline, path: &Path, table: &CaseTable) -> Self {
        let seed = study.file.seed;
        let worst_by = study.worst_by();
        let until = study.file.stop.until.as_ref();
        let waited = until.map(|until| waited(until, table, table.rows.len() as u64));
        let points = sweep(study, table);
        let (worst, worst_of) = worst(table, &worst_by, seed, |case| pipeline.replay(study, path, case));
        Self {
            study: study.name.clone(),
            title: study.file.title.clone(),
            hash: study.hash_with(pipeline),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            attitude: table.attitude(study.granted_attitude()),
            warm_up_frames: study.warm_up_frames(),
            cases: table.rows.len() as u64,
            of: study.cases(),
            failed_cases: table.rows.iter().filter(|row| row.has_failed).count() as u64,
            draws: table.draws().into_iter().max().map_or(0, |last| last as u64 + 1),
            is_narrow_enough: waited == Some(Waited::NarrowEnough),
            waited,
            error_cases: table.rows.iter().filter(|row| row.error.is_some()).count() as u64,
            errors: errors(table),
            requirements: requirements(study, table, &points),
            figures: figures(table),
            causes: causes(table),
            differences: differences(&points),
            sweep: points.into_iter().map(|point| point.summary).collect(),
            correlations: correlations(table),
            indices: if study.file.design == DesignKind::Saltelli {
                indices(table, seed)
            } else {
                Vec::new()
            },
            worst,
            worst_of,
            worst_by,
        }
    }
}

fn figures(table: &CaseTable) -> IndexMap<String, FigureSummary> {
    let draws = table.draws();
    let summary = |name: &String| {
        let cases = table.figure(name).unwrap_or_default();
        (name.clone(), figure(name, &cases, &draws))
    };
    table.figures.iter().map(summary).collect()
}

fn figure(name: &str, cases: &[CaseFigure], draws: &[usize]) -> FigureSummary {
    let [p05, median, p95] = quantiles(cases, draws, [0.05, 0.5, 0.95]);
    let count = cases.iter().filter(|case| case.value.is_some()).count() as u64;
    FigureSummary { cases: count, all: overall(name, cases, draws), p05, median, p95 }
}

fn causes(table: &CaseTable) -> IndexMap<String, CauseSummary> {
    let draws = table.draws();
    let summary = |(place, name): (usize, &String)| {
        let count =
            |row: &CaseRow| CaseFigure { value: None, count: u64::from(row.causes[place]), of: row.frames };
        let cases: Vec<CaseFigure> = table.rows.iter().map(count).collect();
        let frames = cases.iter().map(|case| case.count).sum();
        let share = share(&cases, &draws);
        let cases = cases.iter().filter(|case| case.count > 0).count() as u64;
        (frames > 0).then(|| (name.clone(), CauseSummary { frames, cases, share }))
    };
    let mut causes: IndexMap<_, _> = table.causes.iter().enumerate().filter_map(summary).collect();
    causes.sort_by(|_, a, _, b| b.frames.cmp(&a.frames));
    causes
}

fn requirements(study: &Study, table: &CaseTable, points: &[Point]) -> Vec<RequirementResult> {
    let required = &study.file.require;
    if points.is_empty() {
        return decide(required, table, &IndexMap::new());
    }
    points.iter().flat_map(|point| decide(required, &point.table, &point.summary.at)).collect()
}

/// The first cases that cannot be run.
fn errors(table: &CaseTable) -> Vec<CaseError> {
    let error = |row: &CaseRow| Some(CaseError { case: row.case, error: row.error.clone()? });
    table.rows.iter().filter_map(error).take(WORST).collect()
}

/// A point of the sweep with its cases.
struct Point {
    summary: SweepPoint,
    table: CaseTable,
}

fn sweep(study: &Study, table: &CaseTable) -> Vec<Point> {
    let swept = study.file.sweep.len();
    if swept == 0 {
        return Vec::new();
    }
    let mut points: IndexMap<Vec<String>, Vec<CaseRow>> = IndexMap::new();
    for row in &table.rows {
        points.entry(row.drawn[..swept].iter().map(Drawn::shown).collect()).or_default().push(row.clone());
    }
    let point = |(at, rows): (Vec<String>, Vec<CaseRow>)| {
        let table = table.with_rows(rows);
        let summary = SweepPoint {
            at: table.drawn.keys().cloned().zip(at).collect(),
            cases: table.rows.len() as u64,
            figures: figures(&table),
            causes: causes(&table),
        };
        Point { summary, table }
    };
    points.into_iter().map(point).collect()
}

/// The differences of every figure between points of which one value differs.
fn differences(points: &[Point]) -> Vec<SweepDifference> {
    let differ = |a: &Point, b: &Point| {
        let values = a.summary.at.values().zip(b.summary.at.values());
        values.filter(|(a, b)| a != b).count() == 1
    };
    let mut all = Vec::new();
    for (place, first) in points.iter().enumerate() {
        for second in points.iter().skip(place + 1).filter(|second| differ(first, second)) {
            for figure in &first.table.figures {
                let Some((difference, draws)) = difference(figure, &first.table, &second.table) else {
                    continue;
                };
                all.push(SweepDifference {
                    figure: figure.clone(),
                    from: first.summary.at.clone(),
                    to: second.summary.at.clone(),
                    difference,
                    draws,
                });
            }
        }
    }
    all
}

/// A figure of the second table less that of the first, over the draws that have it in both, and how many these are.
fn difference(figure: &str, first: &CaseTable, second: &CaseTable) -> Option<(Estimate, u64)> {
    let is_rate = figure_called(figure).is_rate();
    // A point of the sweep has one case of each draw.
    let sums = |table: &CaseTable| -> IndexMap<u64, ClusterSum> {
        let cases = table.figure(figure).unwrap_or_default();
        let draws: Vec<usize> = (0..cases.len()).collect();
        table.rows.iter().map(|row| row.seed).zip(sums(is_rate, &cases, &draws)).collect()
    };
    let of_second = sums(second);
    let pairs: Vec<(ClusterSum, ClusterSum)> = sums(first)
        .into_iter()
        .filter_map(|(seed, first)| Some((first, *of_second.get(&seed)?)))
        .filter(|(first, second)| first.of > 0.0 && second.of > 0.0)
        .collect();
    let ratio = |pick: fn(&(ClusterSum, ClusterSum)) -> ClusterSum| {
        let (sum, of) =
            pairs.iter().map(pick).fold((0.0, 0.0), |(sum, of), draw| (sum + draw.sum, of + draw.of));
        (of > 0.0).then(|| sum / of)
    };
    let value = ratio(|pair| pair.1)? - ratio(|pair| pair.0)?;
    let interval = if is_rate { rate_difference_interval(&pairs) } else { mean_difference_interval(&pairs) };
    Some((Estimate::new(value, interval), pairs.len() as u64))
}

fn correlations(table: &CaseTable) -> Vec<RankCorrelation> {
    let draws = table.draws();
    let mut all = Vec::new();
    for figure in &table.figures {
        let values = table.figure(figure).unwrap_or_default();
        let mut of_figure: Vec<RankCorrelation> = Vec::new();
        for parameter in table.drawn.keys() {
            let Some(numbers) = table.numbers(parameter) else { continue };
            let cases = draws.iter().zip(numbers.iter().zip(&values));
            let triples: Vec<(usize, f64, f64)> =
                cases.filter_map(|(draw, (x, y))| Some((*draw, *x, y.value?))).collect();
            let Some((correlation, interval)) = cluster_rank_correlation(&triples) else { continue };
            of_figure.push(RankCorrelation {
                parameter: parameter.clone(),
                figure: figure.clone(),
                correlation,
                low: interval.map(|interval| interval.low),
                high: interval.map(|interval| interval.high),
                cases: triples.len() as u64,
            });
        }
        of_figure.sort_by(|a, b| b.correlation.abs().total_cmp(&a.correlation.abs()));
        all.extend(of_figure);
    }
    all
}

/// Sobol indices of a design of Saltelli's, whole blocks of d + 2 cases that all have the figure.
fn indices(table: &CaseTable, seed: u64) -> Vec<SobolIndex> {
    let parameters: Vec<&String> = table.drawn.keys().collect();
    let block = parameters.len() + 2;
    let mut all = Vec::new();
    for (place, figure) in table.figures.iter().enumerate() {
        let values = table.figure(figure).unwrap_or_default();
        let blocks: Vec<Vec<f64>> = values
            .chunks_exact(block)
            .filter_map(|cases| cases.iter().map(|case| case.value).collect())
            .collect();
        if blocks.len() < LEAST_CLUSTERS {
            continue;
        }
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
                figure: figure.clone(),
                first,
                first_interval: interval(of_first, first),
                total,
                total_interval: interval(of_total, total),
            });
        }
    }
    all
}

/// The worst cases, and how many are as bad as the last of them. Which of equally bad ones is drawn, so that they are not all of the
/// first draws.
fn worst(table: &CaseTable, by: &str, seed: u64, replay: impl Fn(u64) -> String) -> (Vec<WorstCase>, u64) {
    let badness = |value: f64| match figure_called(by).sense.better {
        Better::More => -value,
        Better::Less => value,
        Better::Near(best) => (value - best).abs(),
    };
    let values = table.figure(by).unwrap_or_default();
    let mut cases: Vec<(&CaseRow, f64)> =
        table.rows.iter().zip(values).filter_map(|(row, figure)| Some((row, figure.value?))).collect();
    let lot = |row: &CaseRow| Seed { seed, case: row.case }.streams(0, Effect::WorstCases).word(0);
    cases.sort_by_cached_key(|(row, _)| (lot(row), row.case));
    cases.sort_by(|a, b| badness(b.1).total_cmp(&badness(a.1)));
    let last = cases.get(WORST.min(cases.len()).wrapping_sub(1)).map(|(_, value)| badness(*value));
    let count = last.map_or(0, |last| cases.iter().filter(|(_, value)| badness(*value) >= last).count());
    cases.truncate(WORST);
    let named = |(row, value): (&CaseRow, f64)| WorstCase {
        case: row.case,
        value,
        drawn: table.drawn.keys().cloned().zip(row.drawn.iter().map(Drawn::shown)).collect(),
        replay: replay(row.case),
    };
    (cases.into_iter().map(named).collect(), count as u64)
}
