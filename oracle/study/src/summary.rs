//! What a study found: figures with intervals, sensitivities, the worst cases.
use std::path::Path;

use indexmap::IndexMap;
use rand::Rng;
use score::{Better, Kind, sense};
use serde::{Deserialize, Serialize};
use sim::randomness::{Effect, Seed, Stream};
use statistics::wilson;

use super::cases::{CaseFigure, CaseRow, CaseTable, Drawn};
use super::definition::Study;
use super::design::DesignKind;
use super::sensitivity::{RankCorrelation, SobolIndex, rank_correlation, sobol_index};
use super::stopping::is_narrow_enough;
use super::tried::StudyPipeline;

/// Samples of cases drawn with replacement, for the intervals of quantiles and indices.
const RESAMPLES: usize = 1000;
/// Fewer cases than this have no quantile interval.
const LEAST_CASES: usize = 5;
/// How many of the worst cases are named.
const WORST: usize = 10;

/// A value with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Lower limit; absent where too few cases are known.
    pub low: Option<f64>,
    /// Upper limit.
    pub high: Option<f64>,
}

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

/// A figure over all cases together; `place` is that of its draws.
pub fn overall(name: &str, cases: &[CaseFigure], seed: u64, place: u64) -> Option<Estimate> {
    if sense(name).kind == Kind::Rate {
        return rate(cases);
    }
    let values: Vec<f64> = cases.iter().filter_map(|case| case.value).collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    if values.is_empty() {
        return None;
    }
    let interval = (values.len() >= LEAST_CASES).then(|| {
        let mut stream = stream(seed, place);
        let mut means: Vec<f64> = (0..RESAMPLES)
            .map(|_| (0..values.len()).map(|_| values[pick(&mut stream, values.len())]).sum::<f64>())
            .map(|sum| sum / values.len() as f64)
            .collect();
        means.sort_by(f64::total_cmp);
        [sorted_quantile(&means, 0.025), sorted_quantile(&means, 0.975)]
    });
    let value = mean(&values);
    // The mean of few skewed values may lie outside the percentiles of its own resamples.
    Some(Estimate {
        value,
        low: interval.map(|[low, _]| low.min(value)),
        high: interval.map(|[_, high]| high.max(value)),
    })
}

/// A rate over frames that come in cases: Wilson's interval with the number of independent frames that would scatter as the cases
/// do. Cases that are all alike tell nothing of their scatter: they count as one frame each when all or none of their frames
/// count, and in full otherwise.
fn rate(cases: &[CaseFigure]) -> Option<Estimate> {
    let (count, of) = cases.iter().fold((0, 0), |(count, of), case| (count + case.count, of + case.of));
    if of == 0 {
        return None;
    }
    let value = count as f64 / of as f64;
    let counted: Vec<&CaseFigure> = cases.iter().filter(|case| case.of > 0).collect();
    let n = counted.len() as f64;
    let is_single = counted.iter().all(|case| case.of == 1);
    let scatter: f64 = counted
        .iter()
        .map(|case| {
            let off = case.count as f64 - value * case.of as f64;
            off * off
        })
        .sum::<f64>()
        / (of as f64 * of as f64);
    let effective = if is_single || scatter == 0.0 {
        if value == 0.0 || value == 1.0 { n } else { of as f64 }
    } else if n < 2.0 {
        1.0
    } else {
        (value * (1.0 - value) / (scatter * n / (n - 1.0))).clamp(1.0, of as f64)
    };
    let interval = wilson(value, effective);
    Some(Estimate { value, low: interval.map(|i| i.low), high: interval.map(|i| i.high) })
}

fn quantiles<const N: usize>(sorted: &[f64], at: [f64; N], stream: &mut Stream) -> [Option<Estimate>; N] {
    if sorted.is_empty() {
        return [None; N];
    }
    let mut resampled: [Vec<f64>; N] = std::array::from_fn(|_| Vec::new());
    if sorted.len() >= LEAST_CASES {
        let mut sample = vec![0.0; sorted.len()];
        for _ in 0..RESAMPLES {
            sample.iter_mut().for_each(|value| *value = sorted[pick(stream, sorted.len())]);
            sample.sort_by(f64::total_cmp);
            for (values, p) in resampled.iter_mut().zip(at) {
                values.push(sorted_quantile(&sample, p));
            }
        }
    }
    std::array::from_fn(|i| {
        let values = &mut resampled[i];
        values.sort_by(f64::total_cmp);
        let value = sorted_quantile(sorted, at[i]);
        let limit = |p: f64| (!values.is_empty()).then(|| sorted_quantile(values, p));
        Some(Estimate {
            value,
            low: limit(0.025).map(|low| low.min(value)),
            high: limit(0.975).map(|high| high.max(value)),
        })
    })
}

/// The quantile of sorted values, between two neighbours in proportion (type 7 of Hyndman & Fan 1996).
fn sorted_quantile(sorted: &[f64], p: f64) -> f64 {
    let at = p * (sorted.len() - 1) as f64;
    let (below, part) = (at.floor(), at.fract());
    let low = sorted[below as usize];
    let high = sorted[(below as usize + 1).min(sorted.len() - 1)];
    if part == 0.0 { low } else { low + part * (high - low) }
}

fn stream(seed: u64, place: u64) -> Stream {
    Seed { seed, case: 0 }.stream(0, Effect::Bootstrap, place)
}

fn pick(stream: &mut Stream, count: usize) -> usize {
    // 64 bits over a few million cases: the bias is below 1e-12.
    ((u128::from(stream.next_u64()) * count as u128) >> 64) as usize
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
    let badness = |value: f64| match sense(by).better {
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

/// Words as a shell takes them.
pub fn command_line(words: &[String]) -> String {
    // A word of a command line has no zero byte.
    shlex::try_join(words.iter().map(String::as_str)).unwrap_or_else(|_| words.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sim::randomness::uniform;

    fn case(count: u64, of: u64) -> CaseFigure {
        CaseFigure { value: (of > 0).then(|| count as f64 / of as f64), count, of }
    }

    #[test]
    fn a_rate_over_single_frames_has_wilsons_interval() {
        let cases: Vec<CaseFigure> = (0..29).map(|k| case(u64::from(k == 3), 1)).collect();
        let got = rate(&cases).unwrap();
        // Newcombe (1998), Table I: 1 of 29.
        assert!(
            (got.low.unwrap() - 0.0061).abs() < 5e-5 && (got.high.unwrap() - 0.1718).abs() < 5e-5,
            "{got:?}"
        );
    }

    /// Frames of a case that go together count as one: the interval holds the truth in 95 % of the studies, where one that takes
    /// frames for independent holds it in few.
    #[test]
    fn the_interval_of_a_rate_knows_that_frames_come_in_cases() {
        let (mut held, studies) = (0, 400);
        for study in 0..studies {
            let mut stream = Seed { seed: 11, case: study }.stream(0, Effect::StudyParameter, 0);
            // Each case has a rate of its own, uniform from 0.6 to 1: the truth is 0.8.
            let cases: Vec<CaseFigure> = (0..60)
                .map(|_| {
                    let p = 0.6 + 0.4 * uniform(&mut stream);
                    case((0..50).filter(|_| uniform(&mut stream) < p).count() as u64, 50)
                })
                .collect();
            let got = rate(&cases).unwrap();
            held += u64::from(got.low.unwrap() <= 0.8 && 0.8 <= got.high.unwrap());
        }
        // Binomial of 400 at 0.95: standard deviation 4.4; four of them below.
        assert!((362..=397).contains(&held), "{held} of {studies}");
    }

    #[test]
    fn a_rate_over_nothing_is_none() {
        assert_eq!(rate(&[]), None);
        assert_eq!(rate(&[case(0, 0)]), None);
    }

    /// The percentile bootstrap of the median of 101 normal numbers holds the truth in about 95 % of the samples.
    #[test]
    fn the_interval_of_a_quantile_holds_its_truth() {
        let (mut held, samples) = (0, 200);
        for sample in 0..samples {
            let mut draws = Seed { seed: 3, case: sample }.stream(0, Effect::StudyParameter, 0);
            let mut values: Vec<f64> = (0..101).map(|_| sim::randomness::normal(&mut draws)).collect();
            values.sort_by(f64::total_cmp);
            let [median] = quantiles(&values, [0.5], &mut stream(9, sample));
            let median = median.unwrap();
            held += u64::from(median.low.unwrap() <= 0.0 && 0.0 <= median.high.unwrap());
        }
        // Binomial of 200 at 0.95: standard deviation 3.1; four of them below.
        assert!((178..=200).contains(&held), "{held} of {samples}");
    }
}
