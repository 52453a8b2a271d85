use contract::docking::{DockingSolution, Motion, MotionReport, NoPose, Pose};
use indexmap::IndexMap;
use nalgebra::{Matrix3, Matrix6, Vector3};

use super::*;
use crate::scoring::hand_made::{ahead, field, measured_outcome, range_only, setup};

fn score(fields: &[(TrueField, Option<DockingOutcome>)]) -> DockingScore {
    scored(fields).score()
}

fn scored(fields: &[(TrueField, Option<DockingOutcome>)]) -> DockingScorer {
    scored_after(0, fields)
}

fn scored_after(warm_up_frames: u64, fields: &[(TrueField, Option<DockingOutcome>)]) -> DockingScorer {
    let context = DockingContext {
        scenario: "hand-made".to_owned(),
        seed: 42,
        version: "0.1.0".to_owned(),
        renderer: "fast".to_owned(),
        warm_up_frames,
        setup: setup(),
    };
    let mut scorer = DockingScorer::new(context);
    for (truth, outcome) in fields {
        scorer.add(truth, outcome.as_ref()).unwrap();
    }
    scorer
}

fn measured_at(d: [f64; 3], phi: [f64; 3]) -> Option<DockingOutcome> {
    Some(measured_outcome(Pose { position_m: d.into(), phi_rad: phi.into() }))
}

fn value(score: &DockingScore, name: &str) -> f64 {
    score.figures[name].value.unwrap_or_else(|| panic!("{name}"))
}

/// Ten fields from 10.0 m with different kinds of outcome.
fn mixed() -> Vec<(TrueField, Option<DockingOutcome>)> {
    let none = |reason| Some(DockingOutcome::without_pose(reason));
    let answers = [
        none(NoPose::NoTarget),
        measured_at([0.0, 0.0, 10.0], [0.0; 3]),
        measured_at([0.03, 0.04, 10.0], [0.0; 3]),
        measured_at([0.0, 0.0, 10.03], [0.0, 0.0, 0.02]),
        measured_at([0.0, 0.0, 11.0], [0.0; 3]),
        measured_at([0.0, 0.0, 10.0], [0.0, 0.0, 3.0]),
        Some(range_only(10.4, 0.2)),
        Some(range_only(20.0, 0.2)),
        none(NoPose::Failed("out of film".to_owned())),
        None,
    ];
    answers.into_iter().enumerate().map(|(i, answer)| (field(i as u64, 10.0), answer)).collect()
}

#[test]
fn fields_of_the_warm_up_count_in_their_own_group_and_in_the_latency_alone() {
    let fields: Vec<_> = (0..20).map(|i| (field(i, 10.0), mixed()[i as usize % 10].1.clone())).collect();
    let scorer = scored_after(10, &fields);
    let (warm, ten, all) = (scorer.score(), score(&fields[..10]), score(&fields));
    assert_eq!((warm.frames, warm.warm_up_frames), (10, 10));
    let groups: Vec<&String> = warm.groups.keys().collect();
    assert!(groups.len() == 2 && groups[0] == WARM_UP && ten.groups.contains_key(groups[1]), "{groups:?}");
    assert_eq!(warm.figures[names::LATENCY_FIELDS], all.figures[names::LATENCY_FIELDS]);
    let without = |score: &DockingScore| {
        let figures = score.figures.iter().filter(|(name, _)| *name != names::LATENCY_FIELDS);
        figures.map(|(name, figure)| (name.clone(), *figure)).collect::<Vec<_>>()
    };
    assert_eq!((without(&warm), &warm.misses, &warm.wrong), (without(&ten), &ten.misses, &ten.wrong));
    for figure in &scorer.units().figures {
        let counted: u32 = figure.terms.iter().map(|term| term.count).sum();
        assert_eq!(u64::from(counted), warm.figures[&figure.name].of, "{}", figure.name);
    }
}

#[test]
fn every_field_is_counted_exactly_once() {
    let fields: Vec<_> = (0..37).map(|i| (field(i, 10.0), mixed()[i as usize % 10].1.clone())).collect();
    let score = score(&fields);
    assert_eq!(score.frames, 37);
    assert_eq!(score.groups.values().map(|group| group.frames).sum::<u64>(), 37);
    let count = |name: &str| score.figures[name].count;
    let parts = [names::SUCCESS_RATE, names::RANGE_ONLY_RATE, names::WRONG_RATE, names::MISS_RATE].map(count);
    assert_eq!(parts.iter().sum::<u64>(), 37);
    assert_eq!(score.misses.values().sum::<u64>(), count(names::MISS_RATE));
    assert_eq!(score.wrong.values().sum::<u64>(), count(names::WRONG_RATE));
}

#[test]
fn rates_and_causes_are_those_of_a_count_by_hand() {
    let score = score(&mixed());
    for (name, expected) in [
        (names::SUCCESS_RATE, 0.3),
        (names::CLEAR_SUCCESS_RATE, 0.3),
        (names::MEASURED_RATE, 0.5),
        (names::RANGE_ONLY_RATE, 0.1),
        (names::WRONG_RATE, 0.3),
        (names::MISS_RATE, 0.3),
        ("paper_success_rate", 0.3),
    ] {
        assert_eq!(value(&score, name), expected, "{name}");
    }
    let counts =
        |counts: &IndexMap<String, u64>| counts.iter().map(|(k, v)| format!("{k} {v}")).collect::<Vec<_>>();
    assert_eq!(counts(&score.misses), ["not_reported 1", "pipeline_failed 1", "no_target 1"]);
    assert_eq!(counts(&score.wrong), ["range 1", "roll 1", "outline 1"]);
    // The first field is clear, and the second is the first success.
    assert_eq!(value(&score, names::LATENCY_FIELDS), 1.0);
}

#[test]
fn errors_of_the_right_fields_have_their_closed_forms() {
    let score = score(&mixed());
    let rms = |squares: f64| (squares / 3.0).sqrt();
    let range = (0.03_f64 * 0.03 + 0.04_f64 * 0.04 + 100.0).sqrt() - 10.0;
    for (name, expected) in [
        (names::RANGE_RMS_M, rms(0.03 * 0.03 + range * range)),
        (names::LATERAL_RMS_M, rms(0.05 * 0.05)),
        (names::ATTITUDE_RMS_DEG, rms(0.02 * 0.02).to_degrees()),
        ("range_rms_relative", rms(0.003 * 0.003 + range * range / 100.0)),
        ("d1_rms_m", rms(0.03 * 0.03)),
        ("phi3_rms_deg", rms(0.02 * 0.02).to_degrees()),
        // Errors over the standard deviation of 0.01 in each: 0; 3 and 4; 3 and 2.
        (names::NEES_MEAN, (0.0 + 25.0 / 6.0 + 13.0 / 6.0) / 3.0),
        (names::RANGE_ONLY_RMS_M, 0.4),
        (names::RANGE_ONLY_RMS_PERCENT, 4.0),
        ("range_only_within_3_sigma", 1.0),
    ] {
        assert!((value(&score, name) - expected).abs() < 1e-9, "{name}: {}", value(&score, name));
        assert!(score.figures[name].count > 0);
    }
    // The paper's pose is the same here, and therefore its figures.
    assert_eq!(value(&score, "paper_range_rms_m"), value(&score, names::RANGE_RMS_M));
}

/// Out of 18 parameters only the error of 0.04 m exceeds 0.03 m.
#[test]
fn shares_within_three_sigma_are_counted_by_parameter() {
    let mut fields = mixed();
    fields[3].1 = measured_at([0.0, 0.0, 10.029], [0.0; 3]);
    fields[2].1 = measured_at([0.029, 0.04, 10.0], [0.0; 3]);
    let score = score(&fields);
    assert_eq!(
        (score.figures[names::WITHIN_3_SIGMA].count, score.figures[names::WITHIN_3_SIGMA].of),
        (17, 18)
    );
    assert_eq!(value(&score, "d2_within_3_sigma"), 2.0 / 3.0);
    assert_eq!(value(&score, "d1_within_3_sigma"), 1.0);
}

#[test]
fn groups_go_from_far_to_near_by_lens() {
    let mut fields: Vec<_> = [4.0, 300.0, 15.0, 12.0, 1.0].into_iter().map(|range| field(0, range)).collect();
    for (number, truth) in fields.iter_mut().enumerate() {
        truth.field = number as u64;
    }
    fields[3].camera = 1;
    fields[4].camera = 1;
    let score = score(&fields.into_iter().map(|truth| (truth, None)).collect::<Vec<_>>());
    let groups: Vec<_> = score.groups.keys().map(String::as_str).collect();
    assert_eq!(
        groups,
        ["> 200 m, 15.0°", "20–10 m, 15.0°", "20–10 m, 40.0°", "5–3 m, 15.0°", "< 1.5 m, 40.0°"]
    );
}

fn report(time_s: f64, range_m: f64) -> MotionReport {
    let best = Motion {
        time_s,
        pose: ahead(range_m),
        velocity_m_s: Vector3::new(0.0, 0.0, -0.2),
        phi_rate_rad_s: Vector3::zeros(),
        position_covariance: Matrix6::from_diagonal_element(1e-4),
        attitude_covariance: Matrix6::from_diagonal_element(1e-4),
        cross_covariance: Matrix3::zeros(),
        fields: 10,
    };
    MotionReport { best: Some(best.clone()), paper: Some(best) }
}

/// Fields 0.1 s apart, all measured, with one report at 0.9 s: a report is required from 1.1 s on, and until
/// 1.9 s the report is at most a second old.
#[test]
fn silence_after_a_report_is_reported() {
    let mut fields: Vec<_> = (0..40)
        .map(|i| {
            (TrueField { time_s: 0.1 * i as f64, ..field(i, 10.0) }, measured_at([0.0, 0.0, 10.0], [0.0; 3]))
        })
        .collect();
    let time_s = fields[9].0.time_s;
    fields[9].1.as_mut().unwrap().motion = Some(report(time_s, 10.0));
    let figure = score(&fields).figures[names::RENEWED_WITHIN_1S];
    assert_eq!((figure.count, figure.of), (9, 29));
}

/// Range errors are in metres, range rate errors in metres per second, angles in degrees.
#[test]
fn a_motion_to_the_side_is_reported_in_degrees() {
    let mut outcome = measured_at([0.0, 0.0, 10.0], [0.0; 3]);
    let truth = field(0, 10.0);
    let mut reported = report(truth.time_s, 10.0);
    reported.best.as_mut().unwrap().pose.position_m = Vector3::new(0.0, 0.1, 10.0);
    outcome.as_mut().unwrap().motion = Some(reported);
    let score = score(&[(truth, outcome)]);
    assert!((value(&score, "motion_alpha_rms_deg") - 0.572_938_7).abs() < 1e-6);
    assert!(
        (value(&score, "motion_range_rate_rms_m_s") - 0.2 * (1.0 - 1.0 / 1.0001_f64.sqrt())).abs() < 1e-9
    );
}

/// A missed field between measured ones is part of their portion.
#[test]
fn a_portion_counts_the_fields_that_were_missed_in_it() {
    let mut fields: Vec<_> =
        (0..8).map(|i| (field(i, 10.0), measured_at([0.0, 0.0, 10.0], [0.0; 3]))).collect();
    for missed in [0, 3, 4] {
        fields[missed].1 = None;
    }
    fields[7].1.as_mut().unwrap().motion = Some(report(fields[7].0.time_s, 10.0));
    assert_eq!(value(&score(&fields), names::PORTION_LATENCY_FIELDS), 7.0);
}

#[test]
fn the_latency_is_from_the_first_clear_field_to_the_first_success() {
    let missed = |number| (field(number, 10.0), None);
    let right = |number| (field(number, 10.0), measured_at([0.0, 0.0, 10.0], [0.0; 3]));
    let of = |fields: &[_]| score(fields).figures[names::LATENCY_FIELDS].value;
    let hidden = (TrueField { visibility: TargetVisibility::Partial, ..field(0, 10.0) }, None);
    assert_eq!(of(&[hidden, missed(1), missed(2), missed(3), right(4)]), Some(3.0));
    assert_eq!(of(&[right(0), missed(1)]), Some(0.0));
    assert_eq!(of(&[missed(0), missed(1)]), None);
}

/// A bar of 3 cm is resolved at 10 m, but not at 300 m.
#[test]
fn a_field_is_clear_when_the_target_is_whole_and_resolved() {
    let fields = [
        (TargetVisibility::Full, 10.0),
        (TargetVisibility::Partial, 10.0),
        (TargetVisibility::Full, 300.0),
        (TargetVisibility::Outside, 300.0),
    ];
    let fields: Vec<_> = (0..)
        .zip(fields)
        .map(|(number, (visibility, range_m))| (TrueField { visibility, ..field(number, range_m) }, None))
        .collect();
    assert_eq!(score(&fields).figures[names::CLEAR_SUCCESS_RATE].of, 1);
}

#[test]
fn units_are_the_fields_with_their_verdicts_and_causes() {
    let table = scored(&mixed()).units();
    let reported: Vec<_> =
        table.units.iter().map(|unit| (unit.verdict.as_str(), unit.cause.as_deref())).collect();
    assert_eq!(reported[..2], [("missed", Some("no_target")), ("success", None)]);
    assert_eq!(reported[4..7], [("wrong", Some("range")), ("wrong", Some("roll")), ("range_only", None)]);
    assert!(table.units.iter().map(|unit| unit.number).eq(0..10));
    assert!(table.units.iter().all(|unit| unit.group == "10–5 m, 15.0°"), "{:?}", table.units[0].group);
    let names: Vec<_> = table.figures.iter().map(|figure| figure.name.clone()).collect();
    let figures: Vec<String> = figures().into_iter().map(|figure| figure.name).collect();
    assert_eq!(figures[..names.len()], names);
    assert!(figures.iter().eq(score(&mixed()).figures.keys()));
}

/// Two misses, then portions of ten fields at 50 fields per second; the tenth field of each portion has a
/// report.
#[test]
fn portions_are_timed_from_their_first_measured_field() {
    let mut fields: Vec<_> =
        (0..32).map(|i| (field(i, 10.0), measured_at([0.0, 0.0, 10.0], [0.0; 3]))).collect();
    fields[0].1 = None;
    fields[1].1 = None;
    for (end, range_m) in [(11, 10.05), (21, 10.01), (31, 9.97)] {
        let time_s = fields[end].0.time_s;
        fields[end].1.as_mut().unwrap().motion = Some(report(time_s, range_m));
    }
    let score = score(&fields);
    assert_eq!(score.portions, 3);
    assert_eq!(value(&score, names::PORTION_LATENCY_FIELDS), 10.0);
    assert_eq!(score.figures[names::RENEWED_WITHIN_1S].of, 0, "it is all over within a second");
    let rms = ((0.05_f64 * 0.05 + 0.01_f64 * 0.01 + 0.03_f64 * 0.03) / 3.0).sqrt();
    assert!((value(&score, "motion_range_rms_m") - rms).abs() < 1e-12);
    assert_eq!(value(&score, "paper_motion_range_rms_m"), value(&score, "motion_range_rms_m"));
    // Counted from the second portion on: errors of 1 and 3 standard deviations in one parameter of six.
    assert!((value(&score, "motion_nees_mean") - (1.0 + 9.0) / 2.0 / 6.0).abs() < 1e-9);
    assert_eq!(score.figures["motion_within_3_sigma"].of, 14);
}

#[test]
fn a_score_of_nothing_and_of_nothing_right_has_no_nan() {
    let misses: Vec<_> = (0..5).map(|i| (field(i, 100.0), None)).collect();
    let silent = measured_at([0.0, 0.0, 10.0], [0.0; 3]).map(|mut outcome| {
        if let DockingSolution::Measured(measurement) = &mut outcome.solution {
            measurement.best.covariance = Matrix6::zeros();
            measurement.paper = None;
        }
        outcome
    });
    for score in [score(&[]), score(&misses), score(&[(field(0, 10.0), silent)])] {
        for (name, figure) in &score.figures {
            assert_eq!(figure.value.is_some(), figure.of > 0, "{name}");
            assert!(figure.value.is_none_or(f64::is_finite), "{name}");
        }
        assert!(!serde_json::to_string(&score).unwrap().contains("NaN"));
    }
}

#[test]
fn a_field_met_twice_is_refused() {
    let context = DockingContext {
        warm_up_frames: 0,
        scenario: String::new(),
        seed: 0,
        version: String::new(),
        renderer: String::new(),
        setup: setup(),
    };
    let mut scorer = DockingScorer::new(context);
    scorer.add(&field(3, 10.0), None).unwrap();
    assert_eq!(scorer.add(&field(3, 10.0), None), Err(ScoreError::Order { previous: 3, frame: 3 }));
}

/// The first of three reports has only the paper's motion, which is counted; the best estimator's first
/// motion is in the second report.
#[test]
fn a_report_of_the_papers_motion_alone_counts_as_the_papers() {
    let fields: Vec<_> = (0..30)
        .map(|i| {
            let truth = TrueField { time_s: 0.1 * i as f64, ..field(i, 10.0) };
            let mut outcome = measured_at([0.0, 0.0, 10.0], [0.0; 3]);
            if let Some(outcome) = outcome.as_mut().filter(|_| i % 10 == 9) {
                let both = report(truth.time_s, 10.0);
                let best = both.best.filter(|_| i > 10);
                outcome.motion = Some(MotionReport { best, ..both });
            }
            (truth, outcome)
        })
        .collect();
    let score = score(&fields);
    let of = |name: &str| score.figures[name].of;
    assert_eq!(score.portions, 3);
    assert_eq!((of("motion_wrong_rate"), of("paper_motion_wrong_rate")), (2, 3));
    // Counted from the second motion of each estimator on.
    assert_eq!((of("motion_range_within_3_sigma"), of("paper_motion_range_within_3_sigma")), (1, 2));
}

/// A saboteur pipeline: the same errors, with stated standard deviations that are ten times too small.
#[test]
fn a_pipeline_that_claims_too_much_is_refused_by_its_consistency() {
    let fields: Vec<_> = (0..50)
        .map(|i| {
            let error = if i % 2 == 0 { 0.008 } else { -0.008 };
            let mut outcome = measured_at([error, error, 10.0 + error], [error, error, error]);
            if let Some(DockingSolution::Measured(m)) = outcome.as_mut().map(|outcome| &mut outcome.solution)
            {
                m.best.covariance *= 0.01;
            }
            (field(i, 10.0), outcome)
        })
        .collect();
    let score = score(&fields);
    assert_eq!(value(&score, names::SUCCESS_RATE), 1.0);
    assert_eq!(value(&score, names::WITHIN_3_SIGMA), 0.0);
    assert!(value(&score, names::NEES_MEAN) > 60.0);
}

/// At 300 m a bar of 3 cm is 0.3 px wide with the narrow lens.
#[test]
fn a_range_only_result_is_no_failure_if_no_pose_is_possible() {
    let far = |number| (field(number, 300.0), Some(range_only(306.0, 3.0)));
    let near = (field(2, 10.0), measured_at([0.0, 0.0, 10.0], [0.0; 3]));
    let score = score(&[far(0), far(1), near]);
    assert_eq!(value(&score, names::SUCCESS_RATE), 1.0);
    assert_eq!(score.figures[names::SUCCESS_RATE].of, 1);
    assert_eq!(value(&score, names::MISS_RATE), 0.0);
    assert!((value(&score, names::RANGE_ONLY_RMS_PERCENT) - 2.0).abs() < 1e-12);
}
