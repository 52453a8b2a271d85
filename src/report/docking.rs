//! The report of a docking run: the figures of the docking paper, errors against the truth, fields.

use std::path::Path;

use contract::docking::{DockingOutcome, DockingSolution, Motion};
use plotly::Trace;
use sim::docking::FieldTruth;

use super::chart::{
    BESIDE, Chart, MEASURED, Panel, REFERENCE, TRUTH, WRONG, band, bars, crosses, line, points, rounded,
    stacked, stacked_bars,
};
use super::field_sheet::FieldSheet;
use super::figures::{figure_table, percent_cell, shown_percent};
use super::page::{DataTable, Page, Section};
use super::read::{missing, read_json};
use super::thin::{bins, summary, thinned};
use crate::docking_run::judge_docking;
use crate::failure::Failure;
use crate::files::docking::{read_field_measurements, read_motion};
use crate::files::{FieldRow, TableReader, read_field_telemetry};
use crate::run_file::RunFile;
use crate::scenario::DockingScenario;
use crate::score::UnitVerdict;
use crate::score::docking::{DockingScore, Shown};

/// Rows of the table behind a long series.
const TABLE_BINS: usize = 60;
/// Fill of a band of three standard deviations.
const BAND: &str = "rgba(47,127,193,0.2)";
/// The seven parameters of the paper (3.2): name, unit, decimals.
const PARAMETERS: [(&str, &str, i32); 7] = [
    ("ρ", "m", 4),
    ("u", "m/s", 5),
    ("α", "°", 4),
    ("β", "°", 4),
    ("φ1", "°", 4),
    ("φ2", "°", 4),
    ("φ3", "°", 4),
];

/// What a docking run left in its directory.
pub struct DockingRun {
    /// `run.toml`.
    pub run_file: RunFile<DockingScenario>,
    /// `score.json`.
    pub score: DockingScore,
    /// A verdict a field, from truth and measurements.
    pub verdicts: Vec<UnitVerdict>,
    /// `truth/fields.parquet`, in the order of the verdicts.
    pub truths: Vec<FieldTruth>,
    /// `measurements.csv`, of the same fields; `None` where there is no row.
    pub outcomes: Vec<Option<DockingOutcome>>,
    /// `telemetry.csv`, of the same fields.
    pub telemetry: Vec<FieldRow>,
    /// What was said at the end of portions, with the place of the field that ended it.
    pub reports: Vec<Report>,
}

/// What was said at the end of a portion.
pub struct Report {
    /// Place of the field that ended it.
    row: usize,
    /// By the best estimator.
    best: Option<Motion>,
    /// By the paper's formulas.
    paper: Option<Motion>,
}

impl DockingRun {
    /// Reads a run directory.
    ///
    /// # Errors
    /// A [`Failure`] that names the file which is missing, cannot be read, or is not of the same fields as the others.
    pub fn read(directory: &Path) -> Result<Self, Failure> {
        for name in ["score.json", "measurements.csv", "telemetry.csv", "setup.toml", "truth/fields.parquet"]
        {
            if !directory.join(name).is_file() {
                return Err(missing(directory, name));
            }
        }
        let run_file = RunFile::<DockingScenario>::read(&directory.join("run.toml"))?;
        let score: DockingScore = read_json(&directory.join("score.json"), "score")?;
        let measurements = directory.join("measurements.csv");
        let motion = Some(directory.join("motion.csv")).filter(|path| path.is_file());
        let verdicts = judge_docking(directory, &measurements, motion.as_deref())?.units().units;
        let mut truths = Vec::with_capacity(verdicts.len());
        for field in TableReader::<FieldTruth>::open(&directory.join("truth/fields.parquet"))? {
            truths.extend(field?.1);
        }
        if truths.is_empty() || score.frames != truths.len() as u64 || verdicts.len() != truths.len() {
            return Err(Failure::Usage(format!(
                "{}: `frames` is {}, expected the {} of truth/fields.parquet, at least 1",
                directory.join("score.json").display(),
                score.frames,
                truths.len()
            )));
        }
        let mut answers = read_field_measurements(&measurements)?.into_iter().peekable();
        let mut rows = read_field_telemetry(&directory.join("telemetry.csv"))?.into_iter().peekable();
        let mut said =
            motion.as_deref().map(read_motion).transpose()?.unwrap_or_default().into_iter().peekable();
        let (mut outcomes, mut telemetry, mut reports) = (Vec::new(), Vec::new(), Vec::new());
        for (row, truth) in truths.iter().enumerate() {
            outcomes.push(answers.next_if(|(field, _)| *field == truth.field).map(|(_, outcome)| outcome));
            telemetry.push(rows.next_if(|row| row.field == truth.field).ok_or_else(|| {
                Failure::Usage(format!(
                    "{}: there is no row of field {}, expected one for every field of the truth",
                    directory.join("telemetry.csv").display(),
                    truth.field
                ))
            })?);
            if let Some((_, report)) = said.next_if(|(field, _)| *field == truth.field) {
                reports.push(Report { row, best: report.best, paper: report.paper });
            }
        }
        Ok(Self { run_file, score, verdicts, truths, outcomes, telemetry, reports })
    }
}

/// The seven parameters, metres and degrees.
fn shown(pose: &contract::docking::Pose, velocity_m_s: &nalgebra::Vector3<f64>) -> [f64; 7] {
    let shown = Shown::of(pose, velocity_m_s);
    [
        shown.rho_m,
        shown.u_m_s,
        shown.alpha_rad.to_degrees(),
        shown.beta_rad.to_degrees(),
        shown.phi_rad.x.to_degrees(),
        shown.phi_rad.y.to_degrees(),
        shown.phi_rad.z.to_degrees(),
    ]
}

fn true_shown(truth: &FieldTruth) -> [f64; 7] {
    shown(&truth.pose, &truth.velocity_m_s)
}

fn motion_shown(motion: &Motion) -> [f64; 7] {
    shown(&motion.pose, &motion.velocity_m_s)
}

/// Standard deviations of the seven, metres and degrees; NaN where there are none.
fn motion_sigmas(motion: &Motion) -> [f64; 7] {
    let sigmas = Shown::sigmas(motion).unwrap_or([f64::NAN; 7]);
    std::array::from_fn(|i| if i < 2 { sigmas[i] } else { sigmas[i].to_degrees() })
}

/// The page of a docking run; `sheet` draws its fields anew.
///
/// # Errors
/// A [`Failure`] when a field cannot be drawn.
pub fn docking_page(run: &DockingRun, sheet: &FieldSheet) -> Result<Page, Failure> {
    let (first, last) = (&run.truths[0], &run.truths[run.truths.len() - 1]);
    let scenario = &run.run_file.scenario;
    let figure = |name: &str| run.score.figures.get(name).map_or_else(String::new, shown_percent);
    let mut sections = vec![figures_section(run)];
    sections.extend(motion_sections(run));
    sections.push(field_errors(run));
    sections.push(verdicts(run));
    sections.push(fields(run, sheet)?);
    Ok(Page {
        title: scenario.title.clone(),
        kind: "Docking: a run",
        version: run.run_file.version.clone(),
        lead: vec![format!(
            "{} fields: the pose was measured in {} of those in which it can be asked for; {} of all fields were grossly wrong.",
            run.score.frames,
            figure("success_rate"),
            figure("wrong_rate")
        )],
        warnings: Vec::new(),
        facts: vec![
            ("Scenario", run.run_file.name.clone()),
            ("Seed", scenario.seed.to_string()),
            ("Fields", format!("{} to {}", first.field, last.field)),
            ("Time", format!("{:.2} to {:.2} s", first.time_s, last.time_s)),
            ("Range", format!("{:.2} to {:.2} m", first.range_m, last.range_m)),
            ("Reports of motion", run.score.portions.to_string()),
            ("Renderer", run.score.renderer.clone()),
            ("Boresight", run.run_file.version.clone()),
        ],
        sections,
        data: serde_json::json!({ "score": run.score }),
    })
}

/// Figures by range, and all of them.
fn figures_section(run: &DockingRun) -> Section {
    let score = &run.score;
    let mut table = DataTable::new([
        "range",
        "fields",
        "reports",
        "success",
        "of clear ones",
        "range alone",
        "wrong",
        "missed",
    ])
    .caption("Percent, with 95 % intervals, by true range and lens.");
    let rates = ["success_rate", "clear_success_rate", "range_only_rate", "wrong_rate", "miss_rate"];
    let groups = score
        .groups
        .iter()
        .map(|(name, group)| (name.as_str(), group.frames, group.portions, &group.figures));
    for (name, frames, portions, figures) in
        groups.chain([("all", score.frames, score.portions, &score.figures)])
    {
        let mut cells = vec![name.to_owned(), frames.to_string(), portions.to_string()];
        cells.extend(rates.map(|rate| percent_cell(figures.get(rate))));
        table.push(cells);
    }
    Section::new("figures", "Figures").table(table).folded("All figures", figure_table(&score.figures))
}

/// Figs. 5 and 6: the motion and its accuracy.
fn motion_sections(run: &DockingRun) -> [Section; 2] {
    let five = Section::new("fig-5", "Fig. 5: parameters of the motion");
    let six = Section::new("fig-6", "Fig. 6: accuracy of the motion");
    if run.reports.is_empty() {
        let none = "No portion of fields ended in this run with a motion.";
        return [five.text(none), six.text(none)];
    }
    let time = |report: &Report| rounded(run.truths[report.row].time_s, 3);
    let of = |pick: fn(&Report) -> &Option<Motion>| -> Vec<(f64, usize, [f64; 7], [f64; 7])> {
        let reports = run.reports.iter();
        reports
            .filter_map(|report| {
                let motion = pick(report).as_ref()?;
                Some((time(report), report.row, motion_shown(motion), motion_sigmas(motion)))
            })
            .collect()
    };
    let (best, paper) = (of(|report| &report.best), of(|report| &report.paper));
    let every = thinned(run.truths.len(), &[]);
    let truth: Vec<(f64, [f64; 7])> =
        every.iter().map(|&row| (rounded(run.truths[row].time_s, 3), true_shown(&run.truths[row]))).collect();

    let parameters = PARAMETERS.iter().enumerate().map(|(i, (name, unit, decimals))| {
        let kept = thinned(best.len(), &[&|k| best[k].2[i]]);
        let x: Vec<f64> = kept.iter().map(|&k| best[k].0).collect();
        let y: Vec<f64> = kept.iter().map(|&k| rounded(best[k].2[i], *decimals)).collect();
        let three = |k: usize| 3.0 * best[k].3[i];
        let low = kept.iter().map(|&k| rounded(best[k].2[i] - three(k), *decimals)).collect();
        let high = kept.iter().map(|&k| rounded(best[k].2[i] + three(k), *decimals)).collect();
        let mut traces = Vec::from(band("3 σ", x.clone(), low, high, BAND));
        traces.push(points("best estimate", x, y, MEASURED));
        let (tx, ty) = truth.iter().map(|(t, values)| (*t, rounded(values[i], *decimals))).unzip();
        traces.push(line("true", tx, ty, TRUTH));
        let (low, high) = limits(best.iter().map(|row| row.2[i]).chain(truth.iter().map(|row| row.1[i])));
        Panel { range: Some([low, high]), ..Panel::new(format!("{name}, {unit}"), traces) }
    });
    let (traces, layout) = stacked("time, s", parameters.collect());
    let mut head = vec!["time, s".to_owned(), "field".to_owned()];
    head.extend(PARAMETERS.iter().map(|(name, unit, _)| format!("{name}, {unit}")));
    head.extend(PARAMETERS.iter().map(|(name, unit, _)| format!("σ of {name}, {unit}")));
    let mut data = DataTable::new(head).caption("Every so many reports; motion.csv has all of them.");
    for bin in bins(best.len(), TABLE_BINS) {
        let (t, row, values, sigmas) = &best[bin.start];
        let mut cells = vec![format!("{t:.2}"), run.truths[*row].field.to_string()];
        cells.extend(values.iter().chain(sigmas).map(|value| format!("{value:.4}")));
        data.push(cells);
    }
    let five = five.chart(Chart::new(
        "Range, range rate, passive pitch and yaw, and the three active angles at the last moment of every portion, with three \
         standard deviations as the pipeline tells them, and the truth.",
        1080,
        data,
        traces,
        layout,
    ));

    let errors = PARAMETERS.iter().enumerate().map(|(i, (name, unit, decimals))| {
        let error = |row: usize, values: &[f64; 7]| values[i] - true_shown(&run.truths[row])[i];
        let kept = thinned(best.len(), &[&|k| error(best[k].1, &best[k].2), &|k| best[k].3[i]]);
        let x: Vec<f64> = kept.iter().map(|&k| best[k].0).collect();
        let three: Vec<f64> = kept.iter().map(|&k| rounded(3.0 * best[k].3[i], decimals + 1)).collect();
        let below = three.iter().map(|sigma| -sigma).collect();
        let y = kept.iter().map(|&k| rounded(error(best[k].1, &best[k].2), decimals + 1)).collect();
        let mut traces = Vec::from(band("3 σ", x.clone(), below, three, BAND));
        traces.push(points("best estimate", x, y, MEASURED));
        if !paper.is_empty() {
            let kept = thinned(paper.len(), &[&|k| error(paper[k].1, &paper[k].2)]);
            let x = kept.iter().map(|&k| paper[k].0).collect();
            let y = kept.iter().map(|&k| rounded(error(paper[k].1, &paper[k].2), decimals + 1)).collect();
            traces.push(points("paper's formulas", x, y, BESIDE));
        }
        // The paper's formulas scatter far more: the axis is that of the best estimate.
        let all = best.iter().flat_map(|row| [error(row.1, &row.2), 3.0 * row.3[i], -3.0 * row.3[i]]);
        let (low, high) = limits(all);
        Panel { range: Some([low, high]), ..Panel::new(format!("{name}, {unit}"), traces) }
    });
    let (traces, layout) = stacked("time, s", errors.collect());
    let mut head = vec!["from, s".to_owned()];
    for (name, unit, _) in PARAMETERS {
        head.extend(["number", "smallest", "mean", "largest"].map(|what| format!("{name}, {unit}: {what}")));
    }
    let mut data = DataTable::new(head)
        .caption("Errors of the best estimate, measured minus true, by stretches of time.");
    for bin in bins(best.len(), TABLE_BINS) {
        let mut cells = vec![format!("{:.2}", best[bin.start].0)];
        for i in 0..7 {
            let errors = bin.clone().map(|k| best[k].2[i] - true_shown(&run.truths[best[k].1])[i]);
            cells.extend(summary(errors, 5));
        }
        data.push(cells);
    }
    let chart = Chart::new(
        "Errors against the truth, measured minus true, with bands of three standard deviations as the pipeline tells them.",
        1080,
        data,
        traces,
        layout,
    );
    [five, six.chart(sigmas(&best)).chart(chart)]
}

/// Standard deviations over time, as the paper's Fig. 6 has them.
fn sigmas(best: &[(f64, usize, [f64; 7], [f64; 7])]) -> Chart {
    let of = |name: &str, i: usize, colour| {
        let kept = thinned(best.len(), &[&|k| best[k].3[i]]);
        let x = kept.iter().map(|&k| best[k].0).collect();
        let y = kept.iter().map(|&k| rounded(best[k].3[i], 6)).collect();
        line(name, x, y, colour)
    };
    let panels = vec![
        Panel::new("σ of ρ, m", vec![of("ρ, u, α, φ1", 0, MEASURED)]),
        Panel::new("σ of u, m/s", vec![of("u", 1, MEASURED)]),
        Panel::new("σ of α, β, °", vec![of("α", 2, MEASURED), of("β", 3, BESIDE)]),
        Panel::new("σ of φ, °", vec![of("φ1", 4, MEASURED), of("φ2", 5, BESIDE), of("φ3", 6, REFERENCE)]),
    ];
    let (mut traces, layout) = stacked("time, s", panels);
    // The colours of the last two panels, which the first has not.
    for (name, colour) in [("β, φ2", BESIDE), ("φ3", REFERENCE)] {
        traces.push(line(name, vec![f64::NAN], vec![f64::NAN], colour));
    }
    let mut head = vec!["time, s".to_owned()];
    head.extend(PARAMETERS.iter().map(|(name, unit, _)| format!("σ of {name}, {unit}")));
    let mut data = DataTable::new(head).caption("Every so many reports; motion.csv has all of them.");
    for bin in bins(best.len(), TABLE_BINS) {
        let (t, _, _, sigmas) = &best[bin.start];
        data.push([format!("{t:.2}")].into_iter().chain(sigmas.iter().map(|sigma| format!("{sigma:.5}"))));
    }
    Chart::new(
        "Standard deviations that the pipeline tells, at the last moment of every portion.",
        640,
        data,
        traces,
        layout,
    )
}

/// Limits of an axis that shows all but the wildest hundredth of some values.
fn limits(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let mut sorted: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return (-1.0, 1.0) };
    let (low, high) = (sorted[last / 200], sorted[last - last / 200]);
    let room = (0.08 * (high - low)).max(1e-9);
    (low - room, high + room)
}

/// Errors of every measured field.
fn field_errors(run: &DockingRun) -> Section {
    let section = Section::new("field-errors", "Errors of single fields");
    let rows: Vec<usize> = (0..run.truths.len())
        .filter(|&row| run.outcomes[row].as_ref().is_some_and(|outcome| outcome.measurement().is_some()))
        .collect();
    if rows.is_empty() {
        return section.text("No field was measured.");
    }
    let error = |row: usize, i: usize| {
        let measured = run.outcomes[row].as_ref().and_then(DockingOutcome::measurement);
        let (Some(measured), truth) = (measured, &run.truths[row].pose) else { return f64::NAN };
        let pose = &measured.best.pose;
        if i < 3 {
            pose.position_m[i] - truth.position_m[i]
        } else {
            (pose.phi_rad[i - 3] - truth.phi_rad[i - 3]).to_degrees()
        }
    };
    let is_wrong = |row: usize| run.verdicts[row].verdict == "wrong";
    let names = ["d1, m", "d2, m", "d3, m", "φ1, °", "φ2, °", "φ3, °"];
    let panels = names.iter().enumerate().map(|(i, title)| {
        let of = |wrong: bool| {
            let rows: Vec<usize> = rows.iter().copied().filter(|&row| is_wrong(row) == wrong).collect();
            let kept = thinned(rows.len(), &[&|k| error(rows[k], i)]);
            let x: Vec<f64> = kept.iter().map(|&k| rounded(run.truths[rows[k]].time_s, 3)).collect();
            let y: Vec<f64> = kept.iter().map(|&k| rounded(error(rows[k], i), 5)).collect();
            (x, y)
        };
        let ((x, y), (wx, wy)) = (of(false), of(true));
        let (low, high) = limits(rows.iter().filter(|&&row| !is_wrong(row)).map(|&row| error(row, i)));
        let traces = vec![points("right", x, y, MEASURED), crosses("grossly wrong", wx, wy, WRONG)];
        Panel { range: Some([low, high]), ..Panel::new(*title, traces) }
    });
    let (traces, layout) = stacked("time, s", panels.collect());
    let mut head = vec!["from, s".to_owned()];
    for name in names {
        head.extend(["number", "smallest", "mean", "largest"].map(|what| format!("{name}: {what}")));
    }
    let mut data =
        DataTable::new(head).caption("By stretches of measured fields; measurements.csv has every field.");
    for bin in bins(rows.len(), TABLE_BINS) {
        let mut cells = vec![format!("{:.2}", run.truths[rows[bin.start]].time_s)];
        for i in 0..6 {
            cells.extend(summary(bin.clone().map(|k| error(rows[k], i)), 4));
        }
        data.push(cells);
    }
    section.chart(Chart::new(
        "Measured minus true. The axes leave out the wildest hundredth; zoom out (double click) for it. Of many fields so many are \
         drawn as a screen can show, extremes always among them.",
        900,
        data,
        traces,
        layout,
    ))
}

/// What became of the fields, by range.
fn verdicts(run: &DockingRun) -> Section {
    let score = &run.score;
    let groups: Vec<String> = score.groups.keys().cloned().collect();
    let mut data = DataTable::new(
        ["what", "cause"]
            .map(str::to_owned)
            .into_iter()
            .chain(groups.iter().cloned())
            .chain(["all".to_owned()]),
    );
    let mut traces: Vec<Box<dyn Trace>> = Vec::new();
    let mut add = |what: &str, cause: &str, counts: Vec<u64>, all: u64| {
        if all == 0 {
            return;
        }
        let mut cells = vec![what.to_owned(), cause.to_owned()];
        cells.extend(counts.iter().map(u64::to_string));
        cells.push(all.to_string());
        data.push(cells);
        let frames = score.groups.values().map(|group| group.frames.max(1) as f64);
        let percent = counts.iter().zip(frames).map(|(count, of)| rounded(100.0 * *count as f64 / of, 3));
        let name = if cause.is_empty() { what.to_owned() } else { format!("{what}: {cause}") };
        traces.push(bars(&name, groups.clone(), percent.collect()).hover_template("%{x}: %{y} %"));
    };
    let counted = |of: &dyn Fn(&crate::score::docking::DockingGroup) -> u64| {
        score.groups.values().map(of).collect::<Vec<u64>>()
    };
    for name in ["success_rate", "range_only_rate"] {
        let count = |figures: &indexmap::IndexMap<String, crate::score::Figure>| {
            figures.get(name).map_or(0, |figure| figure.count)
        };
        let what = if name == "success_rate" { "success" } else { "range alone" };
        add(what, "", counted(&|group| count(&group.figures)), count(&score.figures));
    }
    for (cause, all) in &score.wrong {
        add("wrong", cause, counted(&|group| group.wrong.get(cause).copied().unwrap_or(0)), *all);
    }
    for (cause, all) in &score.misses {
        add("missed", cause, counted(&|group| group.misses.get(cause).copied().unwrap_or(0)), *all);
    }
    Section::new("verdicts", "What became of the fields").chart(Chart::new(
        "Percent of the fields of a range and lens.",
        420,
        data,
        traces,
        stacked_bars("", "% of fields"),
    ))
}

/// A sheet of fields: a success of every range, every kind of miss and of wrong answer.
fn fields(run: &DockingRun, sheet: &FieldSheet) -> Result<Section, Failure> {
    let mut chosen: Vec<usize> = Vec::new();
    let mut middle = |is: &dyn Fn(&UnitVerdict) -> bool| {
        let rows: Vec<usize> = (0..run.verdicts.len()).filter(|&row| is(&run.verdicts[row])).collect();
        chosen.extend(rows.get(rows.len() / 2));
    };
    for group in run.score.groups.keys() {
        middle(&|unit| unit.verdict == "success" && unit.group == *group);
    }
    middle(&|unit| unit.verdict == "range_only");
    for (verdict, causes) in [("wrong", &run.score.wrong), ("missed", &run.score.misses)] {
        for cause in causes.keys() {
            middle(&|unit| unit.verdict == verdict && unit.cause.as_deref() == Some(cause));
        }
    }
    let mut section = Section::new("fields", "Fields").text(
        "Of every range a success, then of every kind of wrong answer and of miss the field in the middle of all of that kind, drawn \
         anew from run.toml. Orange: what was recognised (cross, circle of the marks, marks that were used); yellow: outlines of \
         station and docking unit; violet: marks that were rejected or missing; green: true centres of cross and disk.",
    );
    if run.score.renderer != "fast" {
        section = section.text(format!(
            "The fields of the run were drawn by {}, these by the fast renderer: the same scene, other shades.",
            run.score.renderer
        ));
    }
    Ok(match sheet.reason() {
        Some(reason) => section.text(format!("There are no pictures: {reason}")),
        None => section.pictures(sheet.pictures(run, &chosen)?),
    })
}

/// What a field's answer was, in words.
pub(super) fn answer_words(outcome: Option<&DockingOutcome>) -> String {
    match outcome.map(|outcome| &outcome.solution) {
        None => "no answer".to_owned(),
        Some(DockingSolution::Measured(measured)) => {
            format!("ρ measured {:.3} m", measured.best.pose.position_m.norm())
        }
        Some(DockingSolution::RangeOnly { range_m, .. }) => format!("range alone {range_m:.2} m"),
        Some(DockingSolution::NoSolution(reason)) => format!("the pipeline says: {reason}"),
    }
}
