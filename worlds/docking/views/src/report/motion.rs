//! Reported motion at the end of portions: its parameters and their accuracy.

use ::report::charts::axis_limits::{limits, note_outside, outside};
use ::report::charts::chart::{
    BESIDE, Chart, MEASURED, Panel, REFERENCE, TRUTH, band, cloud, line, points, rounded, stacked,
};
use ::report::charts::plotly::{Axis, Trace};
use ::report::charts::thinning::{bins, summary, thinned, thinning_caption};
use ::report::page::Section;
use ::report::page::data_table::DataTable;
use contract::docking::{Motion, Pose};
use docking::scoring::ApproachParameters;
use nalgebra::Vector3;

use super::run::{DockingRun, PortionReport};

/// Number of rows of the tables behind the charts.
const TABLE_BINS: usize = 60;
/// Caption of a table that contains a sample of the reports.
const SAMPLED: &str = "A regular selection of the reports; motion.csv has all of them.";
/// Fill of a band of three standard deviations.
const BAND: &str = "rgba(47,127,193,0.2)";
/// The seven parameters: name, unit, number of decimals.
const PARAMETERS: [(&str, &str, i32); 7] = [
    ("ρ", "m", 6),
    ("u", "m/s", 6),
    ("α", "°", 5),
    ("β", "°", 5),
    ("φ1", "°", 5),
    ("φ2", "°", 5),
    ("φ3", "°", 5),
];

/// Motion reported by an estimator at the end of a portion, metres and degrees.
struct MotionEstimate {
    time_s: f64,
    field: u64,
    values: [f64; 7],
    /// Standard deviations; NaN if the estimator states none.
    sigmas: [f64; 7],
    /// Measured minus true values.
    errors: [f64; 7],
}

impl MotionEstimate {
    /// Collects all motions that `pick` selects from the reports of a run.
    fn from_reports(run: &DockingRun, pick: fn(&PortionReport) -> &Option<Motion>) -> Vec<Self> {
        let estimate = |report: &PortionReport| {
            let (motion, truth) = (pick(report).as_ref()?, &run.truths[report.row]);
            let values = approach_parameters(&motion.pose, &motion.velocity_m_s);
            let true_values = approach_parameters(&truth.pose, &truth.velocity_m_s);
            let sigmas = ApproachParameters::sigmas(motion).unwrap_or([f64::NAN; 7]);
            Some(Self {
                time_s: rounded(truth.time_s, 3),
                field: truth.field,
                values,
                sigmas: std::array::from_fn(|i| if i < 2 { sigmas[i] } else { sigmas[i].to_degrees() }),
                errors: std::array::from_fn(|i| values[i] - true_values[i]),
            })
        };
        run.reports.iter().filter_map(estimate).collect()
    }
}

/// Returns the seven parameters, metres and degrees.
fn approach_parameters(pose: &Pose, velocity_m_s: &Vector3<f64>) -> [f64; 7] {
    let shown = ApproachParameters::from_motion(pose, velocity_m_s);
    let phi = shown.phi_rad;
    let degrees = [shown.alpha_rad, shown.beta_rad, phi.x, phi.y, phi.z].map(f64::to_degrees);
    [shown.rho_m, shown.u_m_s, degrees[0], degrees[1], degrees[2], degrees[3], degrees[4]]
}

/// Returns the sections on the motion and on its accuracy.
pub(super) fn sections(run: &DockingRun) -> [Section; 2] {
    let five = Section::new("motion", "Parameters of the motion").in_paper("Fig. 5");
    let six = Section::new("motion-errors", "Accuracy of the motion").in_paper("Fig. 6");
    let best = MotionEstimate::from_reports(run, |report| &report.best);
    if best.is_empty() {
        let none = "No portion of fields in this run ended with a motion estimate.";
        return [five.absent(none), six.absent(none)];
    }
    let paper = MotionEstimate::from_reports(run, |report| &report.paper);
    let about = "Errors of the best estimate";
    let six = six.chart(sigmas(&best)).chart(errors(&best, about, "best estimate", MEASURED));
    // The errors of the paper's formulas have separate axes: their scatter is ten times larger and not
    // centred on zero.
    let about = "Errors of the paper's formulas";
    let has_paper = !paper.is_empty();
    let six = if has_paper { six.chart(errors(&paper, about, "paper's formulas", BESIDE)) } else { six };
    [five.chart(parameters(run, &best)), six]
}

/// Returns a quantity of all reported motions, as points over time.
fn estimate_points(
    name: &str,
    estimate: &[MotionEstimate],
    decimals: i32,
    number: &dyn Fn(&MotionEstimate) -> f64,
    colour: &'static str,
) -> Vec<Trace> {
    let all: Vec<usize> = (0..estimate.len()).collect();
    cloud(name, &all, Some(&|k| number(&estimate[k])), colour, |kept| {
        let (x, y) = series(estimate, kept, decimals, number);
        points("", x, y, colour)
    })
}

/// Returns the times of the kept motions, and a quantity of each, rounded to `decimals` decimals.
fn series(
    estimate: &[MotionEstimate],
    kept: &[usize],
    decimals: i32,
    number: impl Fn(&MotionEstimate) -> f64,
) -> (Vec<f64>, Vec<f64>) {
    kept.iter().map(|&k| (estimate[k].time_s, rounded(number(&estimate[k]), decimals))).unzip()
}

/// Returns the chart of the seven parameters with three standard deviations, and of their true values.
fn parameters(run: &DockingRun, best: &[MotionEstimate]) -> Chart {
    let truth: Vec<(f64, [f64; 7])> = thinned(run.truths.len(), &[])
        .into_iter()
        .map(|row| &run.truths[row])
        .map(|truth| (rounded(truth.time_s, 3), approach_parameters(&truth.pose, &truth.velocity_m_s)))
        .collect();
    let mut beyond = 0;
    let panels = PARAMETERS.iter().enumerate().map(|(i, (name, unit, decimals))| {
        let kept = thinned(best.len(), &[&|k| best[k].values[i]]);
        let of = |sigmas: f64| {
            series(best, &kept, *decimals, |estimate| estimate.values[i] + sigmas * estimate.sigmas[i])
        };
        let (x, low) = of(-3.0);
        let mut traces = Vec::from(band("3 σ", x, low, of(3.0).1, BAND));
        traces.extend(estimate_points(
            "best estimate",
            best,
            *decimals,
            &|estimate| estimate.values[i],
            MEASURED,
        ));
        let (x, y): (Vec<f64>, Vec<f64>) =
            truth.iter().map(|(time_s, values)| (*time_s, rounded(values[i], *decimals))).unzip();
        traces.push(line("true", x, y, TRUTH));
        let of_band = |estimate: &MotionEstimate| {
            [-3.0, 3.0].map(|sigmas| estimate.values[i] + sigmas * estimate.sigmas[i])
        };
        let range = limits(best.iter().flat_map(of_band).chain(truth.iter().map(|row| row.1[i])));
        beyond += outside(range, best.iter().map(|estimate| estimate.values[i]));
        Panel { range: Some(range), ..Panel::new(format!("{name}, {unit}"), traces) }
    });
    let (traces, layout) = stacked(Axis::titled("time, s"), panels.collect());
    let mut head = vec!["time, s".to_owned(), "field".to_owned()];
    head.extend(PARAMETERS.map(|(name, unit, _)| format!("{name}, {unit}")));
    head.extend(PARAMETERS.map(|(name, unit, _)| format!("σ of {name}, {unit}")));
    let mut data = DataTable::new(head).caption(SAMPLED);
    for bin in bins(best.len(), TABLE_BINS) {
        let estimate = &best[bin.start];
        let mut cells = vec![format!("{:.2}", estimate.time_s), estimate.field.to_string()];
        cells.extend(estimate.values.iter().map(|value| format!("{value:.5}")));
        cells.extend(estimate.sigmas.iter().map(|sigma| format!("{sigma:.7}")));
        data.push(cells);
    }
    let caption = format!(
        "Range, range rate, passive pitch and yaw, and the three active angles at the end of each portion, \
         with ±3 σ as reported by the pipeline, and the truth. {} {}",
        note_outside(beyond, 7 * best.len(), "estimates"),
        thinning_caption(&[(best.len(), "reports")], true)
    );
    Chart::new(caption, 1080, data, traces, layout)
}

/// Returns the chart of the standard deviations over time, by group of parameters.
fn sigmas(best: &[MotionEstimate]) -> Chart {
    let of = |name: &str, i: usize, colour| {
        let kept = thinned(best.len(), &[&|k| best[k].sigmas[i]]);
        let (x, y) = series(best, &kept, 7, |estimate| estimate.sigmas[i]);
        line(name, x, y, colour)
    };
    // The standard deviations range from decimetres at long range to micrometres at the end.
    let log = |title: &str, shown: std::ops::Range<usize>, traces| {
        let numbers =
            || best.iter().flat_map(|estimate| &estimate.sigmas[shown.clone()]).copied().filter(|s| *s > 0.0);
        let limits = [numbers().fold(f64::INFINITY, f64::min), numbers().fold(0.0, f64::max)];
        let log = Some(limits).filter(|[low, high]| low.is_finite() && high.is_finite());
        Panel { log, ..Panel::new(title, traces) }
    };
    let panels = vec![
        log("σ of ρ, m", 0..1, vec![of("ρ, u, α, φ1", 0, MEASURED)]),
        log("σ of u, m/s", 1..2, vec![of("u", 1, MEASURED)]),
        log("σ of α, β, °", 2..4, vec![of("α", 2, MEASURED), of("β", 3, BESIDE)]),
        log("σ of φ, °", 4..7, vec![of("φ1", 4, MEASURED), of("φ2", 5, BESIDE), of("φ3", 6, REFERENCE)]),
    ];
    let (mut traces, layout) = stacked(Axis::titled("time, s"), panels);
    // Legend entries of the last two panels, whose colours the first panel lacks; the legend is that of the
    // first panel.
    for (name, colour) in [("β, φ2", BESIDE), ("φ3", REFERENCE)] {
        traces.push(line(name, vec![f64::NAN], vec![f64::NAN], colour));
    }
    let mut head = vec!["time, s".to_owned()];
    head.extend(PARAMETERS.map(|(name, unit, _)| format!("σ of {name}, {unit}")));
    let mut data = DataTable::new(head).caption(SAMPLED);
    for bin in bins(best.len(), TABLE_BINS) {
        let estimate = &best[bin.start];
        let sigmas = estimate.sigmas.iter().map(|sigma| format!("{sigma:.7}"));
        data.push([format!("{:.2}", estimate.time_s)].into_iter().chain(sigmas));
    }
    let caption = "Standard deviations reported by the pipeline at the end of each portion.";
    Chart::new(caption, 640, data, traces, layout)
}

/// Returns the chart of the errors of an estimator against the truth, with bands of three standard
/// deviations.
fn errors(all: &[MotionEstimate], about: &str, name: &str, colour: &'static str) -> Chart {
    let mut beyond = 0;
    let mut panels = Vec::new();
    for (i, (title, unit, decimals)) in PARAMETERS.iter().enumerate() {
        let kept = thinned(all.len(), &[&|k| all[k].sigmas[i]]);
        let of = |sigmas: f64| series(all, &kept, *decimals, |estimate| sigmas * estimate.sigmas[i]);
        let (x, low) = of(-3.0);
        let mut traces = Vec::from(band("3 σ", x, low, of(3.0).1, BAND));
        traces.extend(estimate_points(name, all, *decimals, &|estimate| estimate.errors[i], colour));
        let shown = |estimate: &MotionEstimate| {
            [estimate.errors[i], 3.0 * estimate.sigmas[i], -3.0 * estimate.sigmas[i]]
        };
        let range = limits(all.iter().flat_map(shown));
        beyond += outside(range, all.iter().map(|estimate| estimate.errors[i]));
        panels.push(Panel { range: Some(range), ..Panel::new(format!("{title}, {unit}"), traces) });
    }
    let (traces, layout) = stacked(Axis::titled("time, s"), panels);
    let mut head = vec!["from, s".to_owned()];
    for (name, unit, _) in PARAMETERS {
        head.extend(["number", "smallest", "mean", "largest"].map(|what| format!("{name}, {unit}: {what}")));
    }
    let text = format!("{about}, measured minus true, by time interval; motion.csv has all reports.");
    let mut data = DataTable::new(head).caption(text);
    for bin in bins(all.len(), TABLE_BINS) {
        let estimate = &all[bin];
        let mut cells = vec![format!("{:.2}", estimate[0].time_s)];
        (0..7).for_each(|i| cells.extend(summary(estimate.iter().map(|estimate| estimate.errors[i]), 6)));
        data.push(cells);
    }
    let caption = format!(
        "{about}, measured minus true, with bands of ±3 σ as reported by the pipeline. {} {}",
        note_outside(beyond, 7 * all.len(), "errors"),
        thinning_caption(&[(all.len(), "reports")], true)
    );
    Chart::new(caption, 1080, data, traces, layout)
}
