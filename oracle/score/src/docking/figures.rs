//! The figures of a docking score, from the verdicts of fields and of the portions that they end.

use super::errors::PoseErrors;
use super::field_verdict::FieldVerdict;
use super::portions::{MotionVerdict, PortionVerdict};
use super::report::names;
use super::verdict::Verdict;
use crate::{Definition, Reduction};

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

type Figures = Vec<Definition<'static, FieldVerdict>>;

/// All figures over fields, those about single fields first.
pub(super) fn definitions() -> Figures {
    let mut figures = Figures::new();
    rates(&mut figures);
    errors("", success, &mut figures);
    consistency(&mut figures);
    range_only(&mut figures);
    figures.push(Definition::rate(
        format!("{}{}", names::PAPER, names::SUCCESS_RATE),
        |field: &FieldVerdict| field.is_asked.then(|| right_by_paper(field).is_some()),
    ));
    errors(names::PAPER, right_by_paper, &mut figures);
    motion(names::MOTION, |portion| portion.best, &mut figures);
    motion(&format!("{}{}", names::PAPER, names::MOTION), |portion| portion.paper, &mut figures);
    figures.push(Definition::of(names::PORTION_LATENCY_FIELDS, Reduction::Mean, |field: &FieldVerdict| {
        field.portion.as_ref().map(|portion| portion.fields as f64)
    }));
    figures.push(Definition::rate(names::RENEWED_WITHIN_1S, |field: &FieldVerdict| field.is_renewed));
    figures
}

/// The errors of a pose that is not grossly wrong.
fn success(field: &FieldVerdict) -> Option<PoseErrors> {
    match &field.verdict {
        Verdict::Success { errors } => Some(*errors),
        _ => None,
    }
}

/// The same of the paper's pose.
fn right_by_paper(field: &FieldVerdict) -> Option<PoseErrors> {
    field.paper.filter(|_| !field.paper_is_wrong)
}

/// What became of the fields.
fn rates(figures: &mut Figures) {
    let mut rate = |name: &str, holds: fn(&FieldVerdict) -> Option<bool>| {
        figures.push(Definition::rate(name, holds));
    };
    fn is_success(field: &FieldVerdict) -> bool {
        matches!(field.verdict, Verdict::Success { .. })
    }
    rate(names::SUCCESS_RATE, |field| field.is_asked.then(|| is_success(field)));
    rate(names::CLEAR_SUCCESS_RATE, |field| field.is_clear.then(|| is_success(field)));
    rate(names::MEASURED_RATE, |field| Some(field.is_measured));
    rate(names::RANGE_ONLY_RATE, |field| Some(matches!(field.verdict, Verdict::RangeOnly { .. })));
    rate(names::WRONG_RATE, |field| Some(matches!(field.verdict, Verdict::Wrong { .. })));
    rate(names::MISS_RATE, |field| Some(matches!(field.verdict, Verdict::Missed { .. })));
}

/// How large the errors of poses are.
fn errors(prefix: &str, pick: fn(&FieldVerdict) -> Option<PoseErrors>, figures: &mut Figures) {
    let mut add = |name: &str, reduction: Reduction, value: fn(&PoseErrors) -> f64| {
        let value = move |field: &FieldVerdict| pick(field).map(|errors| value(&errors));
        figures.push(Definition::of(format!("{prefix}{name}"), reduction, value));
    };
    add(names::RANGE_RMS_M, Reduction::Rms, |errors| errors.range_m);
    add("range_mean_m", Reduction::Mean, |errors| errors.range_m);
    let relative = move |field: &FieldVerdict| pick(field).map(|errors| errors.range_m / field.range_m);
    figures.push(Definition::of(format!("{prefix}range_rms_relative"), Reduction::Rms, relative));
    let mut rms = |name: &str, value: fn(&PoseErrors) -> f64| {
        let value = move |field: &FieldVerdict| pick(field).map(|errors| value(&errors));
        figures.push(Definition::of(format!("{prefix}{name}"), Reduction::Rms, value));
    };
    rms(names::LATERAL_RMS_M, |errors| errors.lateral_m);
    rms(names::ATTITUDE_RMS_DEG, |errors| errors.attitude_rad.to_degrees());
    rms("alpha_rms_deg", |errors| errors.alpha_rad.to_degrees());
    rms("beta_rms_deg", |errors| errors.beta_rad.to_degrees());
    for (axis, name) in PARAMETERS.iter().enumerate() {
        figures.push(if axis < 3 {
            Definition::of(format!("{prefix}{name}_rms_m"), Reduction::Rms, move |field: &FieldVerdict| {
                pick(field).map(|errors| errors.position_m[axis])
            })
        } else {
            Definition::of(format!("{prefix}{name}_rms_deg"), Reduction::Rms, move |field: &FieldVerdict| {
                pick(field).map(|errors| errors.phi_rad[axis - 3].to_degrees())
            })
        });
    }
    let score = move |field: &FieldVerdict| pick(field).map(|errors| errors.speed_score);
    figures.push(Definition::of(format!("{prefix}{}", names::SPEED_SCORE_MEAN), Reduction::Mean, score));
}

/// Whether the errors of single fields are as large as their covariances say.
fn consistency(figures: &mut Figures) {
    let within = |field: &FieldVerdict| field.within.unwrap_or_default();
    figures.push(Definition::pooled(names::WITHIN_3_SIGMA, move |field: &FieldVerdict, values| {
        values.extend(within(field).into_iter().flatten().map(one_or_zero));
    }));
    for (axis, name) in PARAMETERS.iter().enumerate() {
        let one = move |field: &FieldVerdict| within(field)[axis];
        figures.push(Definition::rate(format!("{name}_{}", names::WITHIN_3_SIGMA), one));
    }
    figures.push(Definition::of(names::NEES_MEAN, Reduction::Mean, |field: &FieldVerdict| field.nees));
    figures.push(Definition::rate("covariance_rate", |field: &FieldVerdict| {
        field.within.map(|_| field.nees.is_some())
    }));
}

/// Ranges that are given alone.
fn range_only(figures: &mut Figures) {
    let told = |field: &FieldVerdict| match field.verdict {
        Verdict::RangeOnly { error_m, sigma_m } => Some((error_m, sigma_m)),
        _ => None,
    };
    figures.push(Definition::of(names::RANGE_ONLY_RMS_M, Reduction::Rms, move |field: &FieldVerdict| {
        told(field).map(|(error_m, _)| error_m)
    }));
    figures.push(Definition::of(
        names::RANGE_ONLY_RMS_PERCENT,
        Reduction::Rms,
        move |field: &FieldVerdict| told(field).map(|(error_m, _)| 100.0 * error_m / field.range_m),
    ));
    figures.push(Definition::rate("range_only_within_3_sigma", move |field: &FieldVerdict| {
        told(field).and_then(|(error_m, sigma_m)| super::consistency::within_3_sigma(error_m, sigma_m))
    }));
}

/// What is said at the end of portions. Consistency is counted from an estimator's second motion on: the first has no
/// portion before it to lean on.
fn motion(prefix: &str, pick: fn(&PortionVerdict) -> Option<MotionVerdict>, figures: &mut Figures) {
    let told = move |field: &FieldVerdict| field.portion.as_ref().and_then(pick);
    let right = move |field: &FieldVerdict| told(field).filter(|motion| !motion.is_wrong);
    let led = move |field: &FieldVerdict| right(field).filter(|motion| motion.is_led);
    figures.push(Definition::rate(format!("{prefix}{}", names::WRONG_RATE), move |field: &FieldVerdict| {
        told(field).map(|motion| motion.is_wrong)
    }));
    for (index, (_, name)) in SHOWN.iter().enumerate() {
        let in_files = move |error: f64| if index < 2 { error } else { error.to_degrees() };
        let error = move |field: &FieldVerdict| right(field).map(|motion| in_files(motion.errors[index]));
        figures.push(Definition::of(format!("{prefix}{name}"), Reduction::Rms, error));
    }
    figures.push(Definition::pooled(
        format!("{prefix}{}", names::WITHIN_3_SIGMA),
        move |field: &FieldVerdict, values| {
            let within = led(field).into_iter().flat_map(|motion| motion.within.into_iter().flatten());
            values.extend(within.map(one_or_zero));
        },
    ));
    for (index, (name, _)) in SHOWN.iter().enumerate() {
        let within = move |field: &FieldVerdict| led(field).and_then(|motion| motion.within[index]);
        figures.push(Definition::rate(format!("{prefix}{name}_{}", names::WITHIN_3_SIGMA), within));
    }
    for (index, name) in MOTION_NEES.iter().enumerate() {
        let nees = move |field: &FieldVerdict| led(field).and_then(|motion| motion.nees[index]);
        figures.push(Definition::of(format!("{prefix}{name}"), Reduction::Mean, nees));
    }
}

fn one_or_zero(held: bool) -> f64 {
    f64::from(u8::from(held))
}
