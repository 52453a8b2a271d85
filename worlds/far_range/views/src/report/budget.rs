//! Error budget: runs on the same frames with the result of one stage replaced by the truth, beside the run
//! without replacement.

use ::report::charts::chart::{BESIDE, Chart, MEASURED, axes, intervals, rounded};
use ::report::charts::plotly::Trace;
use ::report::figures::{cell, percent_cell};
use ::report::page::Section;
use ::report::page::data_table::DataTable;
use far_range::scoring::{Score, names};
use run::figure_by_name;

use super::FarRangeRun;

/// Returns the section on the error contribution of each stage.
pub(super) fn budget(run: &FarRangeRun) -> Section {
    let section = Section::new("budget", "Error budget by stage");
    if run.run_file.inject.is_some() {
        return section;
    }
    if run.budget.is_empty() {
        return section.absent(
            "This run has no budget yet. `boresight report DIR --budget all` runs the same frames once per \
             stage, with the truth instead of that stage's result, and shows here the contribution of each \
             stage of the built-in pipeline to the error (docs/report.md).",
        );
    }
    let plain = ("none (unmodified run)".to_owned(), &run.score);
    let injected = run.budget.iter().map(|injected| (injected.stage.to_string(), &injected.score));
    let rows: Vec<(String, &Score)> = [plain].into_iter().chain(injected).collect();
    let rates = [
        names::HIT_RATE,
        names::CORRECT_RATE,
        names::WRONG_RATE,
        names::RA_WITHIN_1PX,
        names::DEC_WITHIN_1PX,
    ];
    let amounts = [names::RA_RMS_DEG, names::DEC_RMS_DEG, names::RA_MEAN_DEG, names::DEC_MEAN_DEG];
    let mut table = DataTable::new(
        ["replaced stage".to_owned()]
            .into_iter()
            .chain(rates.into_iter().chain(amounts).map(|name| figure_by_name(name).words)),
    )
    .caption("Rates in percent with 95 % intervals, errors of the correct measurements in degrees.");
    for (stage, score) in &rows {
        let mut cells = vec![stage.clone()];
        cells.extend(rates.map(|name| percent_cell(score.figures.get(name))));
        cells.extend(amounts.map(|name| cell(score.figures.get(name).and_then(|figure| figure.value))));
        table.push(cells);
    }
    let of = |label: &str, name: &str, colour| -> Trace {
        let figures: Vec<_> = rows
            .iter()
            .filter_map(|(stage, score)| {
                let figure = score.figures.get(name)?;
                let value = figure.value?;
                Some((stage.clone(), value, figure.low.unwrap_or(value), figure.high.unwrap_or(value)))
            })
            .collect();
        let y = figures.iter().map(|figure| rounded(figure.1, 6)).collect();
        let low: Vec<f64> = figures.iter().map(|figure| figure.2).collect();
        let high: Vec<f64> = figures.iter().map(|figure| figure.3).collect();
        let stages: Vec<String> = figures.into_iter().map(|figure| figure.0).collect();
        intervals(label, stages, y, &low, &high, colour)
    };
    let traces = vec![
        of("across columns", names::RA_RMS_DEG, MEASURED),
        of("across rows", names::DEC_RMS_DEG, BESIDE),
    ];
    section
        .text(
            "The same frames, each time with the truth instead of one stage's result: the improvement is the \
             contribution of that stage to the error (docs/score.md).",
        )
        .chart(Chart::new(
            "RMS error of the correct measurements with 95 % intervals, by the stage that was replaced by \
             the truth.",
            380,
            table,
            traces,
            axes("replaced stage", "RMS error, °"),
        ))
}
