//! The figures of a docking score, from the verdicts of fields and portions.
//!
//! Each inner list of what is collected is one sequence in order of time: a bin of range and lens, in which the law of the
//! errors hardly changes.

use indexmap::IndexMap;

use super::accumulate::FieldVerdict;
use super::errors::PoseErrors;
use super::portions::{MotionVerdict, PortionVerdict};
use super::report::names;
use super::verdict::Verdict;
use crate::score::Figure;

/// The six parameters of a pose.
const PARAMETERS: [&str; 6] = ["d1", "d2", "d3", "phi1", "phi2", "phi3"];

/// The seven that are shown: name, and name of the root mean square with its unit.
const SHOWN: [(&str, &str); 7] = [
    ("range", "range_rms_m"),
    ("range_rate", "range_rate_rms_m_s"),
    ("alpha", "alpha_rms_deg"),
    ("beta", "beta_rms_deg"),
    ("phi1", "phi1_rms_deg"),
    ("phi2", "phi2_rms_deg"),
    ("phi3", "phi3_rms_deg"),
];

/// NEES of what is shown: of (d, φ), of (d, d'), of (φ, φ').
const MOTION_NEES: [&str; 3] = ["nees_mean", "position_nees_mean", "attitude_nees_mean"];

type Fields<'a> = [&'a [&'a FieldVerdict]];
type Portions<'a> = [Vec<&'a PortionVerdict>];
type Figures = IndexMap<String, Figure>;

/// All figures of some sequences of fields, those about single fields first.
pub(super) fn figures(fields: &Fields<'_>) -> Figures {
    let mut figures = Figures::new();
    rates(fields, &mut figures);
    let success = |field: &FieldVerdict| match &field.verdict {
        Verdict::Success { errors } => Some(*errors),
        _ => None,
    };
    errors(fields, "", &success, &mut figures);
    consistency(fields, &mut figures);
    range_only(fields, &mut figures);
    let right = |field: &FieldVerdict| field.paper.filter(|_| !field.paper_is_wrong);
    figures.insert(
        format!("{}{}", names::PAPER, names::SUCCESS_RATE),
        Figure::rate(&collect(fields, |field| field.is_asked.then(|| right(field).is_some()))),
    );
    errors(fields, names::PAPER, &right, &mut figures);

    let portions: Vec<Vec<&PortionVerdict>> = fields
        .iter()
        .map(|fields| fields.iter().filter_map(|field| field.portion.as_ref()).collect())
        .collect();
    motion(&portions, names::MOTION, &|portion| portion.best, &mut figures);
    motion(&portions, &format!("{}{}", names::PAPER, names::MOTION), &|portion| portion.paper, &mut figures);
    let of_portions = |value: &dyn Fn(&PortionVerdict) -> Option<f64>| select(&portions, |p| value(p));
    let latency = Figure::mean(&of_portions(&|portion| Some(portion.fields as f64)));
    figures.insert(names::PORTION_LATENCY_FIELDS.to_owned(), latency);
    let renewed = collect(fields, |field| field.is_renewed);
    figures.insert(names::RENEWED_WITHIN_1S.to_owned(), Figure::rate(&renewed));
    figures
}

/// What became of the fields.
fn rates(fields: &Fields<'_>, figures: &mut Figures) {
    let mut rate = |name: &str, holds: &dyn Fn(&FieldVerdict) -> Option<bool>| {
        figures.insert(name.to_owned(), Figure::rate(&collect(fields, holds)));
    };
    let is_success = |field: &FieldVerdict| matches!(field.verdict, Verdict::Success { .. });
    rate(names::SUCCESS_RATE, &|field| field.is_asked.then(|| is_success(field)));
    rate(names::CLEAR_SUCCESS_RATE, &|field| field.is_clear.then(|| is_success(field)));
    rate(names::MEASURED_RATE, &|field| Some(field.is_measured));
    rate(names::RANGE_ONLY_RATE, &|field| Some(matches!(field.verdict, Verdict::RangeOnly { .. })));
    rate(names::WRONG_RATE, &|field| Some(matches!(field.verdict, Verdict::Wrong { .. })));
    rate(names::MISS_RATE, &|field| Some(matches!(field.verdict, Verdict::Missed { .. })));
}

/// How large the errors of poses are.
fn errors(
    fields: &Fields<'_>,
    prefix: &str,
    pick: &dyn Fn(&FieldVerdict) -> Option<PoseErrors>,
    figures: &mut Figures,
) {
    let values = |value: &dyn Fn(&PoseErrors) -> f64| {
        collect(fields, |field| pick(field).map(|errors| value(&errors)))
    };
    let mut add = |name: &str, figure: Figure| figures.insert(format!("{prefix}{name}"), figure);
    let degrees = |value: fn(&PoseErrors) -> f64| move |errors: &PoseErrors| value(errors).to_degrees();
    let range = values(&|errors| errors.range_m);
    add(names::RANGE_RMS_M, Figure::rms(&range));
    add("range_mean_m", Figure::mean(&range));
    let relative = collect(fields, |field| pick(field).map(|errors| errors.range_m / field.range_m));
    add("range_rms_relative", Figure::rms(&relative));
    add(names::LATERAL_RMS_M, Figure::rms(&values(&|errors| errors.lateral_m)));
    add(names::ATTITUDE_RMS_DEG, Figure::rms(&values(&degrees(|errors| errors.attitude_rad))));
    add("alpha_rms_deg", Figure::rms(&values(&degrees(|errors| errors.alpha_rad))));
    add("beta_rms_deg", Figure::rms(&values(&degrees(|errors| errors.beta_rad))));
    for (axis, name) in PARAMETERS.iter().enumerate() {
        if axis < 3 {
            add(&format!("{name}_rms_m"), Figure::rms(&values(&|errors| errors.position_m[axis])));
        } else {
            let phi_deg = values(&|errors| errors.phi_rad[axis - 3].to_degrees());
            add(&format!("{name}_rms_deg"), Figure::rms(&phi_deg));
        }
    }
    add(names::SPEED_SCORE_MEAN, Figure::mean(&values(&|errors| errors.speed_score)));
}

/// Whether the errors of single fields are as large as their covariances say.
fn consistency(fields: &Fields<'_>, figures: &mut Figures) {
    let within = |field: &FieldVerdict| field.within.unwrap_or_default();
    let pooled: Vec<Vec<bool>> = fields
        .iter()
        .map(|fields| fields.iter().flat_map(|field| within(field).into_iter().flatten()).collect())
        .collect();
    figures.insert(names::WITHIN_3_SIGMA.to_owned(), Figure::rate(&pooled));
    for (axis, name) in PARAMETERS.iter().enumerate() {
        let one = collect(fields, |field| within(field)[axis]);
        figures.insert(format!("{name}_{}", names::WITHIN_3_SIGMA), Figure::rate(&one));
    }
    figures.insert(names::NEES_MEAN.to_owned(), Figure::mean(&collect(fields, |field| field.nees)));
    let told = collect(fields, |field| field.within.map(|_| field.nees.is_some()));
    figures.insert("covariance_rate".to_owned(), Figure::rate(&told));
}

/// Ranges that are given alone.
fn range_only(fields: &Fields<'_>, figures: &mut Figures) {
    let told = |field: &FieldVerdict| match field.verdict {
        Verdict::RangeOnly { error_m, sigma_m } => Some((error_m, sigma_m)),
        _ => None,
    };
    let range = collect(fields, |field| told(field).map(|(error_m, _)| error_m));
    figures.insert(names::RANGE_ONLY_RMS_M.to_owned(), Figure::rms(&range));
    let percent = collect(fields, |field| told(field).map(|(error_m, _)| 100.0 * error_m / field.range_m));
    figures.insert(names::RANGE_ONLY_RMS_PERCENT.to_owned(), Figure::rms(&percent));
    let within = collect(fields, |field| {
        told(field).and_then(|(error_m, sigma_m)| super::consistency::within_3_sigma(error_m, sigma_m))
    });
    figures.insert("range_only_within_3_sigma".to_owned(), Figure::rate(&within));
}

/// What is said at the end of portions. Consistency is counted from an estimator's second motion on: the first has no
/// portion before it to lean on.
fn motion(
    portions: &Portions<'_>,
    prefix: &str,
    pick: &dyn Fn(&PortionVerdict) -> Option<MotionVerdict>,
    figures: &mut Figures,
) {
    let mut add = |name: &str, figure: Figure| figures.insert(format!("{prefix}{name}"), figure);
    let wrong = select(portions, |portion| pick(portion).map(|motion| motion.is_wrong));
    add(names::WRONG_RATE, Figure::rate(&wrong));
    let right = |portion: &PortionVerdict| pick(portion).filter(|motion| !motion.is_wrong);
    for (index, (_, name)) in SHOWN.iter().enumerate() {
        let in_files = |error: f64| if index < 2 { error } else { error.to_degrees() };
        let errors = select(portions, |portion| right(portion).map(|motion| in_files(motion.errors[index])));
        add(name, Figure::rms(&errors));
    }
    let led = |portion: &PortionVerdict| right(portion).filter(|motion| motion.is_led);
    let pooled: Vec<Vec<bool>> = portions
        .iter()
        .map(|portions| {
            let motions = portions.iter().filter_map(|portion| led(portion));
            motions.flat_map(|motion| motion.within.into_iter().flatten()).collect()
        })
        .collect();
    add(names::WITHIN_3_SIGMA, Figure::rate(&pooled));
    for (index, (name, _)) in SHOWN.iter().enumerate() {
        let within = select(portions, |portion| led(portion).and_then(|motion| motion.within[index]));
        add(&format!("{name}_{}", names::WITHIN_3_SIGMA), Figure::rate(&within));
    }
    for (index, name) in MOTION_NEES.iter().enumerate() {
        let nees = select(portions, |portion| led(portion).and_then(|motion| motion.nees[index]));
        add(name, Figure::mean(&nees));
    }
}

/// The values of the fields that have one, sequence by sequence.
fn collect<T>(fields: &Fields<'_>, value: impl Fn(&FieldVerdict) -> Option<T>) -> Vec<Vec<T>> {
    fields.iter().map(|fields| fields.iter().filter_map(|field| value(field)).collect()).collect()
}

/// The values of the portions that have one, sequence by sequence.
fn select<T>(portions: &Portions<'_>, value: impl Fn(&PortionVerdict) -> Option<T>) -> Vec<Vec<T>> {
    portions.iter().map(|portions| portions.iter().filter_map(|portion| value(portion)).collect()).collect()
}
