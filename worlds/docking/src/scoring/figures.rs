//! Figures of a docking score, from the verdicts on fields and on the portions that they end.

use score::{Better, Definition, Reduction};

use super::consistency::{WITHIN_3_SIGMA, within_3_sigma};
use super::errors::PoseErrors;
use super::field_verdict::FieldVerdict;
use super::portions::{MotionVerdict, PortionVerdict};
use super::report::names;
use super::verdict::Verdict;

/// A unit: its name in keys, and its symbol.
type Unit = (&'static str, &'static str);
const M: Unit = ("m", "m");
const M_S: Unit = ("m_s", "m/s");
const DEG: Unit = ("deg", "°");

/// A parameter: its name in keys, its words and its unit.
type Parameter = (&'static str, &'static str, Unit);

/// Six parameters of a pose.
const PARAMETERS: [Parameter; 6] = [
    ("d1", "d1", M),
    ("d2", "d2", M),
    ("d3", "d3", M),
    ("phi1", "φ1", DEG),
    ("phi2", "φ2", DEG),
    ("phi3", "φ3", DEG),
];

/// Seven parameters shown to the operator.
const SHOWN: [Parameter; 7] = [
    ("range", "range", M),
    ("range_rate", "range rate", M_S),
    ("alpha", "α", DEG),
    ("beta", "β", DEG),
    ("phi1", "φ1", DEG),
    ("phi2", "φ2", DEG),
    ("phi3", "φ3", DEG),
];

/// NEES of the motion: of (d, φ), of (d, d'), of (φ, φ').
const MOTION_NEES: [(&str, &str); 3] = [
    (names::NEES_MEAN, "NEES mean"),
    ("position_nees_mean", "position NEES mean"),
    ("attitude_nees_mean", "attitude NEES mean"),
];

const HONEST_NEES: Better = Better::Near(1.0);
const HONEST_3_SIGMA: Better = Better::Near(WITHIN_3_SIGMA);

/// Figures with a common prefix of keys and words.
struct Figures<'l> {
    key: &'static str,
    words: &'static str,
    list: &'l mut Vec<Definition<'static, FieldVerdict>>,
}

impl Figures<'_> {
    fn rate(
        &mut self,
        name: &str,
        words: &str,
        better: Better,
        holds: impl Fn(&FieldVerdict) -> Option<bool> + 'static,
    ) {
        let (name, words) = (format!("{}{name}", self.key), format!("{}{words}", self.words));
        self.list.push(Definition::rate(name, words, holds).with_direction(better));
    }

    /// Adds the fraction of errors within three standard deviations; a field may have several errors.
    fn within_3_sigma(&mut self, within: impl Fn(&FieldVerdict) -> Option<Vec<Option<bool>>> + 'static) {
        let name = format!("{}{}", self.key, names::WITHIN_3_SIGMA);
        let values = move |field: &FieldVerdict, values: &mut Vec<f64>| {
            let held = within(field).into_iter().flatten().flatten();
            values.extend(held.map(|held| f64::from(u8::from(held))));
        };
        let definition = Definition::pooled(name, format!("{}within 3 σ", self.words), values);
        self.list.push(definition.with_direction(HONEST_3_SIGMA));
    }

    /// Adds the fraction of errors of one parameter within three standard deviations.
    fn parameter_within_3_sigma(
        &mut self,
        (key, words, _): Parameter,
        within: impl Fn(&FieldVerdict) -> Option<bool> + 'static,
    ) {
        let name = format!("{key}_{}", names::WITHIN_3_SIGMA);
        self.rate(&name, &format!("{words} within 3 σ"), HONEST_3_SIGMA, within);
    }

    fn rms(
        &mut self,
        (key, words, (in_key, unit)): Parameter,
        value: impl Fn(&FieldVerdict) -> Option<f64> + 'static,
    ) {
        let name = format!("{}{key}_rms_{in_key}", self.key);
        let words = format!("{}{words} RMS", self.words);
        self.list.push(Definition::amount(name, words, unit, Reduction::Rms, value));
    }

    fn mean(
        &mut self,
        name: &str,
        words: &str,
        better: Better,
        value: impl Fn(&FieldVerdict) -> Option<f64> + 'static,
    ) {
        let (name, words) = (format!("{}{name}", self.key), format!("{}{words}", self.words));
        self.list.push(Definition::amount(name, words, None, Reduction::Mean, value).with_direction(better));
    }
}

/// Returns all figures over fields, those of single fields first.
pub(super) fn definitions() -> Vec<Definition<'static, FieldVerdict>> {
    let mut list = Vec::new();
    let mut figures = Figures { key: "", words: "", list: &mut list };
    rates(&mut figures);
    errors(success, &mut figures);
    consistency(&mut figures);
    range_only(&mut figures);
    let mut paper = Figures { key: names::PAPER, words: "paper ", list: &mut list };
    paper.rate(names::SUCCESS_RATE, "success rate", Better::More, |field| {
        field.is_asked.then(|| right_by_paper(field).is_some())
    });
    errors(right_by_paper, &mut paper);
    let best = Figures { key: names::MOTION, words: "motion ", list: &mut list };
    motion(|portion| portion.best, best);
    let paper = Figures { key: "paper_motion_", words: "paper motion ", list: &mut list };
    motion(|portion| portion.paper, paper);
    let mut figures = Figures { key: "", words: "", list: &mut list };
    figures.mean(names::PORTION_LATENCY_FIELDS, "portion latency fields", Better::Less, |field| {
        field.portion.as_ref().map(|portion| portion.fields as f64)
    });
    figures.rate(names::RENEWED_WITHIN_1S, "renewed within 1s", Better::More, |field| field.is_renewed);
    list
}

/// Returns the errors of a pose that is not grossly wrong.
fn success(field: &FieldVerdict) -> Option<PoseErrors> {
    match &field.verdict {
        Verdict::Success { errors } => Some(*errors),
        _ => None,
    }
}

/// Returns the errors of the paper's pose, if it is not grossly wrong.
fn right_by_paper(field: &FieldVerdict) -> Option<PoseErrors> {
    field.paper.filter(|_| !field.paper_is_wrong)
}

/// Adds the rates of the verdicts on fields.
fn rates(figures: &mut Figures<'_>) {
    fn is_success(field: &FieldVerdict) -> bool {
        matches!(field.verdict, Verdict::Success { .. })
    }
    figures.rate(names::SUCCESS_RATE, "success rate", Better::More, |field| {
        field.is_asked.then(|| is_success(field))
    });
    figures.rate(names::CLEAR_SUCCESS_RATE, "clear success rate", Better::More, |field| {
        field.is_clear.then(|| is_success(field))
    });
    figures.rate(names::MEASURED_RATE, "measured rate", Better::More, |field| Some(field.is_measured));
    figures.rate(names::RANGE_ONLY_RATE, "range only rate", Better::Less, |field| {
        Some(matches!(field.verdict, Verdict::RangeOnly { .. }))
    });
    figures.rate(names::WRONG_RATE, "wrong rate", Better::Less, |field| {
        Some(matches!(field.verdict, Verdict::Wrong { .. }))
    });
    figures.rate(names::DOUBTFUL_RATE, "doubtful rate", Better::Less, |field| {
        Some(matches!(field.verdict, Verdict::Doubtful { .. }))
    });
    figures.rate(names::DOUBTFUL_WRONG_RATE, "doubtful wrong rate", Better::More, |field| {
        match field.verdict {
            Verdict::Doubtful { gross, .. } => Some(gross.is_some()),
            _ => None,
        }
    });
    figures.rate(names::MISS_RATE, "miss rate", Better::Less, |field| {
        Some(matches!(field.verdict, Verdict::Missed { .. }))
    });
}

/// Adds the sizes of the errors of poses.
fn errors(pick: fn(&FieldVerdict) -> Option<PoseErrors>, figures: &mut Figures<'_>) {
    let of =
        |value: fn(&PoseErrors) -> f64| move |field: &FieldVerdict| pick(field).map(|errors| value(&errors));
    let (key, words) = (figures.key, figures.words);
    figures.rms(("range", "range", M), of(|errors| errors.range_m));
    figures.list.push(Definition::amount(
        format!("{key}range_mean_m"),
        format!("{words}range mean"),
        "m",
        Reduction::Mean,
        of(|errors| errors.range_m),
    ));
    figures.list.push(Definition::amount(
        format!("{key}range_rms_relative"),
        format!("{words}range RMS relative"),
        None,
        Reduction::Rms,
        move |field: &FieldVerdict| pick(field).map(|errors| errors.range_m / field.range_m),
    ));
    figures.rms(("lateral", "lateral", M), of(|errors| errors.lateral_m));
    figures.rms(("attitude", "attitude", DEG), of(|errors| errors.attitude_rad.to_degrees()));
    figures.rms(("alpha", "α", DEG), of(|errors| errors.alpha_rad.to_degrees()));
    figures.rms(("beta", "β", DEG), of(|errors| errors.beta_rad.to_degrees()));
    for (axis, parameter) in PARAMETERS.into_iter().enumerate() {
        figures.rms(parameter, move |field| {
            pick(field).map(|errors| match axis {
                0..3 => errors.position_m[axis],
                _ => errors.phi_rad[axis - 3].to_degrees(),
            })
        });
    }
    let score = of(|errors| errors.speed_score);
    figures.mean(names::SPEED_SCORE_MEAN, "speed score mean", Better::Less, score);
}

/// Adds the consistency of the errors of single fields with their covariances.
fn consistency(figures: &mut Figures<'_>) {
    figures.within_3_sigma(|field| field.within.map(Vec::from));
    for (axis, parameter) in PARAMETERS.into_iter().enumerate() {
        figures.parameter_within_3_sigma(parameter, move |field| field.within?[axis]);
    }
    figures.mean(names::NEES_MEAN, "NEES mean", HONEST_NEES, |field| field.nees);
    figures.rate("covariance_rate", "covariance rate", Better::More, |field| {
        field.within.map(|_| field.nees.is_some())
    });
}

/// Adds the figures of range-only measurements.
fn range_only(figures: &mut Figures<'_>) {
    let range_error = |field: &FieldVerdict| match field.verdict {
        Verdict::RangeOnly { error_m, sigma_m } => Some((error_m, sigma_m)),
        _ => None,
    };
    const RANGE_ONLY: Parameter = ("range_only", "range only", M);
    figures.rms(RANGE_ONLY, move |field| range_error(field).map(|(error_m, _)| error_m));
    figures.rms(("range_only", "range only", ("percent", "%")), move |field| {
        range_error(field).map(|(error_m, _)| 100.0 * error_m / field.range_m)
    });
    figures.parameter_within_3_sigma(RANGE_ONLY, move |field| {
        range_error(field).and_then(|(error_m, sigma_m)| within_3_sigma(error_m, sigma_m))
    });
}

/// Adds the figures of motions reported at the end of portions. Consistency is counted from an estimator's
/// second motion on: the first has no previous portion as a prior.
fn motion(pick: fn(&PortionVerdict) -> Option<MotionVerdict>, mut figures: Figures<'_>) {
    let motion_of = move |field: &FieldVerdict| field.portion.as_ref().and_then(pick);
    let right = move |field: &FieldVerdict| motion_of(field).filter(|motion| !motion.is_wrong);
    let led = move |field: &FieldVerdict| right(field).filter(|motion| motion.is_led);
    figures.rate(names::WRONG_RATE, "wrong rate", Better::Less, move |field| {
        motion_of(field).map(|motion| motion.is_wrong)
    });
    for (index, parameter) in SHOWN.into_iter().enumerate() {
        let in_files = move |error: f64| if parameter.2 == DEG { error.to_degrees() } else { error };
        figures.rms(parameter, move |field| right(field).map(|motion| in_files(motion.errors[index])));
    }
    figures.within_3_sigma(move |field| led(field).map(|motion| motion.within.into()));
    for (index, parameter) in SHOWN.into_iter().enumerate() {
        figures.parameter_within_3_sigma(parameter, move |field| led(field)?.within[index]);
    }
    for (index, (name, words)) in MOTION_NEES.into_iter().enumerate() {
        figures.mean(name, words, HONEST_NEES, move |field| led(field)?.nees[index]);
    }
}
