//! What a study found: figures with intervals, sensitivities, the worst cases.
use std::path::Path;

use indexmap::IndexMap;
use run::figure_called;
use score::Better;
use serde::{Deserialize, Serialize};

use super::cases::{CaseFigure, CaseRow, CaseTable, Drawn};
use super::definition::Study;
use super::design::DesignKind;
use super::estimate::{Estimate, LEAST_CASES, RESAMPLES, overall, pick, quantiles, sorted_quantile, stream};
use super::sensitivity::{RankCorrelation, SobolIndex, rank_correlation, sobol_index};
use super::stopping::is_narrow_enough;
use super::tried::StudyPipeline;

/// How many of the worst cases are named.
const WORST: usize = 10;

/// What the cases say of a figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FigureSummary {
    /// Cases in which it has a value.
    pub cases: u64,
    /// Of a rate: all frames of all cases together, with the interval of Wilson for as many independent frames as the scatter
    /// between the cases tells. Of another figure: the mean of the cases, its interval by resampling them.
    pub all: Option<Estimate>,
    /// The value that 5 % of the cases are below; interval by resampling them (percentile bootstrap, 1000 samples).
    pub p05: Option<Estimate>,
    /// The median of the cases.
    pub median: Option<Estimate>,
    /// The value that 95 % of the cases are below.
    pub p95: Option<Estimate>,
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
    /// Cases that were run.
    pub cases: u64,
    /// Cases that were asked for, the most there are.
    pub of: u64,
    /// Cases in which the pipeline itself failed: it crashed, gave no answer in time, or none that can be read.
    pub failed_cases: u64,
    /// Whether the figure of the stopping rule is known well enough.
    pub is_narrow_enough: bool,
    /// Figures by name.
    pub figures: IndexMap<String, FigureSummary>,
    /// The same at each point of the sweep; empty without one.
    pub sweep: Vec<SweepPoint>,
    /// How figures go with what was drawn, by figure, the strongest first.
    pub correlations: Vec<RankCorrelation>,
    /// Sobol indices, where the design allows them.
    pub indices: Vec<SobolIndex>,
    /// The figure that the worst cases are the worst by.
    pub worst_by: String,
    /// The worst cases, the worst first.
    pub worst: Vec<WorstCase>,
}

impl Summary {
    /// The summary of some cases of a study by a pipeline; `path` is the study's file, for the commands.
    pub fn new(study: &Study, pipeline: &dyn StudyPipeline, path: &Path, table: &CaseTable) -> Self {
        let seed = study.file.seed;
        let worst_by = study.worst_by();
        Self {
            study: study.name.clone(),
            title: study.file.title.clone(),
            hash: study.hash_with(pipeline),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            attitude: table.attitude(study.granted_attitude()),
            cases: table.rows.len() as u64,
            of: study.cases(),
            failed_cases: table.rows.iter().filter(|row| row.has_failed).count() as u64,
            is_narrow_enough: is_narrow_enough(study, table, table.rows.len() as u64),
            figures: figures(table, seed),
            sweep: sweep(study, table, seed),
            correlations: correlations(table),
            indices: if study.file.design == DesignKind::Saltelli {
                indices(table, seed)
            } else {
                Vec::new()
            },
            worst: worst(table, &worst_by, |case| pipeline.replay(study, path, case)),
            worst_by,
        }
    }
}

fn figures(table: &CaseTable, seed: u64) -> IndexMap<String, FigureSummary> {
    let summary = |(place, name): (usize, &String)| {
        let cases = table.figure(name).unwrap_or_default();
        (name.clone(), figure(name, &cases, seed, place as u64))
    };
    table.figures.iter().enumerate().map(summary).collect()
}

fn figure(name: &str, cases: &[CaseFigure], seed: u64, place: u64) -> FigureSummary {
    let mut values: Vec<f64> = cases.iter().filter_map(|case| case.value).collect();
    values.sort_by(f64::total_cmp);
    let [p05, median, p95] = quantiles(&values, [0.05, 0.5, 0.95], &mut stream(seed, place));
    FigureSummary { cases: values.len() as u64, all: overall(name, cases, seed, place), p05, median, p95 }
}

fn sweep(study: &Study, table: &CaseTable, seed: u64) -> Vec<SweepPoint> {
    let swept = study.file.sweep.len();
    if swept == 0 {
        return Vec::new();
    }
    let mut points: IndexMap<Vec<String>, Vec<CaseRow>> = IndexMap::new();
    for row in &table.rows {
        points.entry(row.drawn[..swept].iter().map(Drawn::shown).collect()).or_default().push(row.clone());
    }
    let point = |(at, rows): (Vec<String>, Vec<CaseRow>)| {
        let cases = rows.len() as u64;
        let table = table.with_rows(rows);
        SweepPoint {
            at: table.drawn.keys().cloned().zip(at).collect(),
            cases,
            figures: figures(&table, seed),
        }
    };
    points.into_iter().map(point).collect()
}

fn correlations(table: &CaseTable) -> Vec<RankCorrelation> {
    let mut all = Vec::new();
    for figure in &table.figures {
        let values = table.figure(figure).unwrap_or_default();
        let mut of_figure: Vec<RankCorrelation> = Vec::new();
        for parameter in table.drawn.keys() {
            let Some(numbers) = table.numbers(parameter) else { continue };
            let pairs: Vec<(f64, f64)> =
                numbers.iter().zip(&values).filter_map(|(x, y)| Some((*x, y.value?))).collect();
            let Some((correlation, low, high)) = rank_correlation(&pairs) else { continue };
            of_figure.push(RankCorrelation {
                parameter: parameter.clone(),
                figure: figure.clone(),
                correlation,
                low,
                high,
                cases: pairs.len() as u64,
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
        if blocks.len() < LEAST_CASES {
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

fn worst(table: &CaseTable, by: &str, replay: impl Fn(u64) -> String) -> Vec<WorstCase> {
    let badness = |value: f64| match figure_called(by).sense.better {
        Better::More => -value,
        Better::Less => value,
        Better::Near(best) => (value - best).abs(),
    };
    let values = table.figure(by).unwrap_or_default();
    let mut cases: Vec<(&CaseRow, f64)> =
        table.rows.iter().zip(values).filter_map(|(row, figure)| Some((row, figure.value?))).collect();
    cases.sort_by(|a, b| badness(b.1).total_cmp(&badness(a.1)).then(a.0.case.cmp(&b.0.case)));
    cases.truncate(WORST);
    let named = |(row, value): (&CaseRow, f64)| WorstCase {
        case: row.case,
        value,
        drawn: table.drawn.keys().cloned().zip(row.drawn.iter().map(Drawn::shown)).collect(),
        replay: replay(row.case),
    };
    cases.into_iter().map(named).collect()
}
