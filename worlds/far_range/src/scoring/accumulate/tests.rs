use contract::{Covariance2, Measurement, NoSolution, PixelPoint, Solution};
use score::Figure;

use super::*;
use crate::scoring::hand_made::{
    CENTRE, COLUMNS, PIXEL, ROWS, detected_at, direction_at, frame, target_with, tilted, unproject,
    verdict_of,
};

/// Limits of the paper, which also are one and two square pixels of the hand-made camera.
const LIMITS: WithinLimits = WithinLimits { ra_deg: [0.024, 0.048], dec_deg: [0.024, 0.048] };

fn scorer() -> Scorer<'static> {
    Scorer::new(ScoreContext {
        scenario: "hand-made".to_owned(),
        seed: 42,
        version: "0.1.0".to_owned(),
        inject: None,
        columns: COLUMNS,
        rows: ROWS,
        limits: LIMITS,
        warm_up_frames: 0,
        unproject: Box::new(unproject),
    })
}

fn right_of_target(px: f64) -> Outcome {
    detected_at(PixelPoint::new(CENTRE.x + px, CENTRE.y))
}

fn score(outcomes: &[Option<Outcome>]) -> Score {
    granted(outcomes, GrantedAttitude::True)
}

fn granted(outcomes: &[Option<Outcome>], granted: GrantedAttitude) -> Score {
    judged(scorer(), outcomes, granted).score
}

fn judged(
    mut scorer: Scorer<'_>,
    outcomes: &[Option<Outcome>],
    granted: GrantedAttitude,
) -> FarRangeJudgement {
    for (number, outcome) in outcomes.iter().enumerate() {
        let mut truth = frame(number as u64);
        truth.group = format!("day {}", 1 + number / 10);
        let objects = [ObjectTruth { frame: truth.frame, ..target_with(1000.0) }];
        scorer.add(&truth, &objects, outcome.as_ref(), granted).unwrap();
    }
    scorer.finish()
}

/// Figures exclude the first frames of a day, which have separate verdicts and figures.
#[test]
fn frames_of_the_warm_up_count_in_their_own_group_alone() {
    let outcomes: Vec<_> = day().into_iter().cycle().take(20).collect();
    let mut scorer = scorer();
    scorer.context.warm_up_frames = 10;
    let judgement = judged(scorer, &outcomes, GrantedAttitude::True);
    let (score, day) = (&judgement.score, score(&outcomes[..10]));
    assert_eq!((score.frames, score.warm_up_frames), (10, 10));
    assert_eq!(score.groups.keys().collect::<Vec<_>>(), [WARM_UP, "day 2"]);
    assert_eq!((&score.figures, &score.misses), (&day.figures, &day.misses));
    assert_eq!((&score.wrong, &score.wrong_taken), (&day.wrong, &day.wrong_taken));
    assert_eq!(score.groups[WARM_UP].figures, day.figures);
    let table = unit_table(&judgement.verdicts, &judgement.limits);
    assert_eq!((table.units[9].group.as_str(), table.units[9].cause.is_some()), (WARM_UP, false));
    for figure in &table.figures {
        let counted: u32 = figure.terms.iter().map(|term| term.count).sum();
        assert_eq!(u64::from(counted), score.figures[&figure.name].of, "{}", figure.name);
    }
    // Missing frames count towards the warm-up by their numbers.
    let mut scorer = self::scorer();
    scorer.context.warm_up_frames = 10;
    for number in [100, 109, 110] {
        let objects = [ObjectTruth { frame: number, ..target_with(1000.0) }];
        scorer.add(&frame(number), &objects, None, GrantedAttitude::None).unwrap();
    }
    assert_eq!(scorer.finish().score.frames, 1);
}

/// Ten frames per day: 6 correct (4 of them within a pixel), 1 wrong, 2 without a target, 1 without a row.
fn day() -> Vec<Option<Outcome>> {
    let none = || Some(Outcome::without_solution(NoSolution::NoTarget));
    let at = |px| Some(right_of_target(px));
    vec![at(0.0), at(0.1), at(-0.5), none(), at(1.2), at(-1.2), at(30.0), none(), None, at(0.3)]
}

fn counts_of(score: &Score, name: &str) -> (u64, u64) {
    (score.figures[name].count, score.figures[name].of)
}

/// Figures could still be computed from impossible values.
#[test]
fn impossible_truth_is_refused() {
    let refused = |truth: FrameTruth, objects: &[ObjectTruth], parts: [&str; 2]| {
        let mut scorer = scorer();
        let refusal = scorer.add(&truth, objects, None, GrantedAttitude::None);
        let message = refusal.unwrap_err().to_string();
        assert!(
            message.starts_with("frame 0") && parts.iter().all(|part| message.contains(part)),
            "{message}"
        );
    };
    let target = target_with(1000.0);
    refused(frame(0), &[target_with(-1.0)], ["`electrons` is -1", "0 or more"]);
    refused(
        frame(0),
        &[ObjectTruth { radius_px: f64::NAN, ..target.clone() }],
        ["`radius_px` is NaN", "0 or"],
    );
    refused(frame(0), &[target.clone(), target.clone()], ["`number of targets` is 2", "at most 1"]);
    refused(FrameTruth { range_km: -10.0, ..frame(0) }, &[target], ["`range_km` is -10", "more than 0"]);
}

/// Defines numerator and denominator of every rate.
#[test]
fn rates_are_of_all_frames_and_accuracies_of_the_detected() {
    let score = score(&day());
    assert_eq!(score.frames, 10);
    for (name, count, of) in [
        (names::HIT_RATE, 7, 10),
        (names::CORRECT_RATE, 6, 10),
        (names::WRONG_RATE, 1, 10),
        (names::MISS_RATE, 3, 10),
        (names::RA_WITHIN_1PX, 4, 7),
        (names::RA_WITHIN_2PX, 6, 7),
        (names::DEC_WITHIN_1PX, 7, 7),
        (names::RA_RMS_DEG, 6, 6),
        // The hand-made outcomes state no number of stars, and no number is assumed.
        (names::STARS_MEAN, 0, 0),
        (names::ATTITUDE_FROM_STARS_RATE, 0, 10),
    ] {
        assert_eq!(counts_of(&score, name), (count, of), "{name}");
    }
    assert_eq!(score.figures[names::CORRECT_RATE].value, Some(0.6));
    let rms_px = ((0.01 + 0.25 + 1.44 + 1.44 + 0.09) / 6.0f64).sqrt();
    // The arc tangent of 1.2 px differs from its argument by less than 1e-6 of it.
    assert!((score.figures[names::RA_RMS_DEG].value.unwrap() - rms_px * 0.024).abs() < 1e-7);
}

/// Previously a pipeline that measures only in the image was scored with the true attitude, and its errors
/// were shown beside those of pipelines that determine their attitude.
#[test]
fn centroids_have_figures_in_pixels_and_of_lines_of_sight_only_where_they_are_granted() {
    let [none, with] =
        [GrantedAttitude::None, GrantedAttitude::True].map(|attitude| granted(&day(), attitude));
    for name in ["ra_within_1px", "dec_within_2px", "ra_rms_deg", "dec_mean_deg", "ra_median_deg"] {
        assert_eq!((none.figures[name].value, none.figures[name].of), (None, 0), "{name}");
        assert!(with.figures[name].of > 0, "{name}");
    }
    assert_eq!((none.attitude.as_deref(), with.attitude.as_deref()), (Some("none"), Some("true")));
    for score in [&none, &with] {
        assert_eq!(counts_of(score, names::HIT_RATE), (7, 10));
        assert_eq!(counts_of(score, names::LINE_OF_SIGHT_RATE), (0, 7));
        let value = |name: &str| score.figures[name].value.unwrap();
        // Errors of the correct measurements: 0, 0.1, −0.5, 1.2, −1.2, 0.3.
        let rms_px = ((0.01 + 0.25 + 1.44 + 1.44 + 0.09) / 6.0f64).sqrt();
        assert!((value(names::CENTROID_X_RMS_PX) - rms_px).abs() < 1e-9);
        assert!((value(names::CENTROID_X_MEAN_PX) + 0.1 / 6.0).abs() < 1e-9);
        assert!((value(names::CENTROID_X_MEDIAN_PX) - 0.05).abs() < 1e-9);
        assert_eq!(value(names::CENTROID_Y_RMS_PX), 0.0);
        assert_eq!(counts_of(score, names::CENTROID_Y_MEDIAN_PX), (6, 6));
    }
}

#[test]
fn a_rate_of_errors_within_a_limit_records_the_limit() {
    let limits = WithinLimits { ra_deg: [0.5, 1.0], dec_deg: [0.25, 0.75] };
    let mut scorer = Scorer::new(ScoreContext { limits, ..scorer().context });
    // 1.2 px correspond to 0.0288°.
    let objects = [target_with(1000.0)];
    scorer.add(&frame(0), &objects, Some(&right_of_target(1.2)), GrantedAttitude::True).unwrap();
    let scored = scorer.finish();
    let figures = &scored.score.figures;
    let limit = |name: &str| figures[name].limit_deg;
    let within = ["ra_within_1px", "ra_within_2px", "dec_within_1px", "dec_within_2px"];
    assert_eq!(within.map(limit), [Some(0.5), Some(1.0), Some(0.25), Some(0.75)]);
    assert!(within.iter().all(|name| figures[*name].value == Some(1.0)));
    assert!(
        figures.iter().all(|(name, figure)| figure.limit_deg.is_some() == within.contains(&name.as_str()))
    );
    let table = unit_table(&scored.verdicts, &limits);
    let terms = table.figures.iter().find(|figure| figure.name == "dec_within_2px").unwrap();
    assert_eq!((terms.limit_deg, terms.attitude.as_deref()), (Some(0.75), Some("true")));
}

#[test]
fn every_frame_is_counted_exactly_once() {
    let outcomes: Vec<_> = day().into_iter().cycle().take(37).collect();
    let score = score(&outcomes);
    assert_eq!(score.frames, 37);
    assert_eq!(score.groups.values().map(|group| group.frames).sum::<u64>(), 37);
    let detected = score.figures[names::HIT_RATE].count;
    assert_eq!(score.misses.values().sum::<u64>() + detected, 37);
    assert_eq!(score.wrong.values().sum::<u64>(), score.figures[names::WRONG_RATE].count);
    assert_eq!(score.wrong_taken.values().sum::<u64>(), score.figures[names::WRONG_RATE].count);
    for (group, own) in &score.groups {
        let detected = own.figures[names::HIT_RATE].count;
        assert_eq!(own.misses.values().sum::<u64>() + detected, own.frames, "{group}");
    }
}

/// A measurement with this error and the covariance of its centroid, px.
fn with_covariance([x, y]: [f64; 2], covariance: Option<[f64; 3]>) -> Option<Outcome> {
    let mut measurement = Measurement::new(PixelPoint::new(CENTRE.x + x, CENTRE.y + y), None);
    measurement.position_covariance =
        covariance.map(|[x, y, rho]| Covariance2::from_sigmas(x, y, rho).unwrap());
    let solution = Solution::Detected(measurement);
    Some(Outcome { solution, ..Outcome::without_solution(NoSolution::NoTarget) })
}

/// In units of σ the errors are (2, 0) with ρ = 1/2 and (1, 2) with ρ = −1/2: eᵀ C⁻¹ e is 4/0.75 and 7/0.75,
/// half of it 8/3 and 14/3.
#[test]
fn consistency_is_counted_over_the_correct_with_a_covariance_by_closed_forms() {
    let outcomes = [
        with_covariance([0.5, 0.0], Some([0.25, 0.5, 0.5])),
        with_covariance([0.25, 0.5], Some([0.25, 0.25, -0.5])),
        with_covariance([30.0, 0.0], Some([0.25, 0.25, 0.0])),
        with_covariance([1.0, 0.0], None),
        None,
    ];
    let score = score(&outcomes);
    let value = |name: &str| score.figures[name].value.unwrap();
    assert!((value(names::CENTROID_NEES_MEAN) - 11.0 / 3.0).abs() < 1e-14);
    assert_eq!(counts_of(&score, names::CENTROID_NEES_MEAN), (2, 2));
    assert_eq!(counts_of(&score, names::CENTROID_WITHIN_1SIGMA_RATE), (2, 4));
    assert_eq!(counts_of(&score, names::CENTROID_WITHIN_3SIGMA_RATE), (4, 4));
    assert_eq!(score.figures[names::LINE_OF_SIGHT_NEES_MEAN].value, None);
    let rows: Vec<_> = score
        .consistency
        .iter()
        .map(|row| (row.by.as_str(), row.value.as_str(), row.frames, row.figures.len()))
        .collect();
    assert_eq!(rows, [("image", "whole", 2, 6), ("attitude", "unstated", 2, 6)]);
    for row in &score.consistency {
        assert_eq!(row.figures[names::CENTROID_NEES_MEAN], score.figures[names::CENTROID_NEES_MEAN]);
    }
    // Without a covariance there are no figures of consistency, and no table of them.
    assert!(self::score(&outcomes[3..]).consistency.is_empty());
}

/// The axes are those of the camera at any attitude: an error of one pixel to the right with σ of half a
/// pixel, and of one pixel down with σ of two.
#[test]
fn the_covariance_of_a_line_of_sight_is_in_the_axes_of_the_true_camera() {
    let truth = tilted(0);
    let camera_line_of_sight = direction_at(PixelPoint::new(CENTRE.x + 1.0, CENTRE.y + 1.0));
    let mut measurement =
        Measurement::new(CENTRE, Some(truth.camera_from_icrs.inverse() * camera_line_of_sight));
    measurement.line_of_sight_covariance = Some(Covariance2::from_degrees([0.012, 0.048, 0.0]).unwrap());
    let outcome = Outcome {
        solution: Solution::Detected(measurement),
        attitude_source: Some(AttitudeSource::NoMatch),
        ..Outcome::without_solution(NoSolution::NoTarget)
    };
    let mut scorer = scorer();
    let objects = [ObjectTruth { cut: 0.4, ..target_with(1000.0) }];
    scorer.add(&truth, &objects, Some(&outcome), GrantedAttitude::None).unwrap();
    let judgement = scorer.finish();
    // (2² + 0.5²)/2; the arc tangent of a pixel equals its argument to 1e-7 of it.
    let nees = judgement.score.figures[names::LINE_OF_SIGHT_NEES_MEAN].value.unwrap();
    assert!((nees - 2.125).abs() < 1e-5, "{nees}");
    assert_eq!(counts_of(&judgement.score, names::LINE_OF_SIGHT_WITHIN_1SIGMA_RATE), (1, 2));
    assert_eq!(judgement.score.figures[names::CENTROID_NEES_MEAN].of, 0);
    let rows = judgement.score.consistency.iter().map(|row| (row.by.as_str(), row.value.as_str()));
    assert!(rows.eq([("image", "cut"), ("attitude", "no_match")]));
    let verdict = &judgement.verdicts[0];
    let row = verdict.row();
    assert_eq!((row.image, row.centroid_nees, row.line_of_sight_nees), (Some("cut"), None, Some(nees)));
    assert!(
        (row.ra_over_sigma.unwrap() - 2.0).abs() < 1e-5 && (row.dec_over_sigma.unwrap() - 0.5).abs() < 1e-5
    );
}

/// The start includes the warm-up: it is counted from the first frame, regardless of the frames that figures
/// exclude.
#[test]
fn a_start_is_counted_from_the_first_frame_with_any_warm_up() {
    let lost = || Some(Outcome::without_solution(NoSolution::NoTarget));
    let day: Vec<_> = (0..4).map(|_| lost()).chain((0..26).map(|_| Some(right_of_target(0.0)))).collect();
    let until = |warm_up_frames| {
        let mut scorer = scorer();
        scorer.context.warm_up_frames = warm_up_frames;
        for (number, outcome) in day.iter().enumerate() {
            let truth = frame(number as u64);
            let objects = [ObjectTruth { frame: truth.frame, ..target_with(1000.0) }];
            scorer.add(&truth, &objects, outcome.as_ref(), GrantedAttitude::None).unwrap();
        }
        let score = scorer.finish().score;
        let of = |figures: &IndexMap<String, Figure>| figures[names::FRAMES_UNTIL_SETTLED].value;
        let groups = score.groups.iter().map(|(name, group)| (name.clone(), of(&group.figures))).collect();
        (of(&score.figures), groups)
    };
    let named = |groups: &[(&str, Option<f64>)]| -> Vec<(String, Option<f64>)> {
        groups.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect()
    };
    assert_eq!(until(0), (Some(4.0), named(&[("day 1", Some(4.0))])));
    assert_eq!(until(10), (Some(4.0), named(&[(WARM_UP, None), ("day 1", Some(4.0))])));
}

#[test]
fn an_error_of_exactly_one_pixel_is_not_within_it() {
    let with_error = |ra: Angle| {
        let error = LineOfSightError { ra, dec: Angle::ZERO, attitude: AttitudeUsed::Own };
        let error = AnswerError {
            centroid_px: None,
            line_of_sight: Some(error),
            centroid_normalised: None,
            line_of_sight_normalised: None,
        };
        let verdict = verdict_of(Verdict::Correct { error });
        group_score(&[&[&verdict]], &[], &LIMITS).figures[names::RA_WITHIN_1PX].count
    };
    assert_eq!(with_error(Angle::from_degrees(0.024)), 0);
    assert_eq!(with_error(Angle::from_degrees(-0.024)), 0);
    assert_eq!(with_error(Angle::from_degrees(0.023_999_999)), 1);
}

#[test]
fn saboteur_a_shift_of_half_a_pixel_shows_in_the_bias_and_in_the_accuracy() {
    let shifted = |shift: f64| {
        let outcomes: Vec<_> =
            (0..200).map(|i| Some(right_of_target(0.7 * f64::from(i % 3 - 1) + shift))).collect();
        score(&outcomes)
    };
    let (good, bad) = (shifted(0.0), shifted(0.5));
    let bias = |score: &Score| score.figures[names::RA_MEAN_DEG];
    assert!((bias(&bad).value.unwrap() - bias(&good).value.unwrap() - 0.012).abs() < 1e-4);
    assert!(bias(&bad).low.unwrap() > 0.0 && bias(&good).low.unwrap() < 0.0);
    let within = |score: &Score| score.figures[names::RA_WITHIN_1PX].value.unwrap();
    assert!(within(&good) == 1.0 && within(&bad) < 0.7);
}

#[test]
fn a_frame_twice_or_out_of_order_is_refused_and_not_counted() {
    let mut scorer = scorer();
    scorer.add(&frame(4), &[], None, GrantedAttitude::None).unwrap();
    assert_eq!(
        scorer.add(&frame(4), &[], None, GrantedAttitude::None).unwrap_err(),
        ScoreError::Order { previous: 4, frame: 4 }
    );
    assert_eq!(
        scorer.add(&frame(5), &[target_with(1.0)], None, GrantedAttitude::None).unwrap_err(),
        ScoreError::ForeignObject { frame: 5, object: 0 }
    );
    assert_eq!(scorer.finish().score.frames, 1);
}

#[test]
fn the_json_has_the_documented_shape_and_round_trips() {
    let score = score(&day());
    let text = serde_json::to_string(&score).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    for key in ["scenario", "seed", "version", "frames", "figures", "groups", "misses", "wrong"] {
        assert!(json.get(key).is_some(), "{key}");
    }
    assert_eq!(json["misses"], serde_json::json!({"not_reported": 1, "unexplained": 2}));
    assert_eq!(json["groups"]["day 1"]["frames"], 10);
    assert_eq!(json["groups"]["day 1"]["figures"]["hit_rate"]["count"], 7);
    assert_eq!(serde_json::from_str::<Score>(&text).unwrap(), score);
}

#[test]
fn groups_keep_the_order_of_their_frames() {
    let outcomes: Vec<_> = day().into_iter().cycle().take(110).collect();
    let score = score(&outcomes);
    assert_eq!(score.groups.keys().next_back().unwrap(), "day 11");
    let text = serde_json::to_string(&score).unwrap();
    assert_eq!(serde_json::from_str::<Score>(&text).unwrap().groups.keys().nth(1).unwrap(), "day 2");
}

#[test]
fn a_run_of_missing_rows_has_no_nan() {
    let text = serde_json::to_string(&score(&[None, None])).unwrap();
    // serde_json writes null for a NaN: read the score back and search for a figure with a denominator but no
    // value.
    let score: Score = serde_json::from_str(&text).unwrap();
    assert_eq!(score.figures[names::HIT_RATE].value, Some(0.0));
    assert_eq!(score.figures[names::RA_WITHIN_1PX].value, None);
    assert!(score.figures.values().all(|figure| figure.value.is_some() == (figure.of > 0)));
}

#[test]
fn every_score_has_the_figures_of_the_list_in_its_order() {
    let figures: Vec<String> = figures().into_iter().map(|figure| figure.name).collect();
    assert!(figures.iter().eq(score(&day()).figures.keys()) && figures.len() == 31);
}

#[test]
fn frames_of_a_group_share_its_name_and_no_frame_has_that_of_another() {
    let mut scorer = scorer();
    for (number, group) in ["day 1", "day 1", "day 2", "day 1"].into_iter().enumerate() {
        let truth = FrameTruth { group: group.to_owned(), ..frame(number as u64) };
        scorer.add(&truth, &[], None, GrantedAttitude::None).unwrap();
    }
    let groups: Vec<_> = scorer.finish().verdicts.into_iter().map(|verdict| verdict.group).collect();
    assert_eq!(groups, ["day 1", "day 1", "day 2", "day 1"].map(Arc::from));
    assert!(Arc::ptr_eq(&groups[0], &groups[1]));
}

#[test]
fn units_are_the_frames_and_add_up_to_the_figures() {
    let mut scorer = scorer();
    for (number, outcome) in day().iter().enumerate() {
        let truth = frame(number as u64);
        let objects = [ObjectTruth { frame: truth.frame, ..target_with(1000.0) }];
        scorer.add(&truth, &objects, outcome.as_ref(), GrantedAttitude::True).unwrap();
    }
    let scored = scorer.finish();
    let table = unit_table(&scored.verdicts, &scored.limits);
    assert_eq!(table.units.iter().map(|unit| unit.number).collect::<Vec<_>>(), (0..10).collect::<Vec<_>>());
    assert_eq!((table.units[6].group.as_str(), table.units[6].verdict.as_str()), ("day 1", "wrong"));
    assert_eq!(table.units[8].cause.as_deref(), Some("not_reported"));
    // The figure of the start is defined only for a complete sequence.
    let from_frames = scored.score.figures.keys().filter(|name| *name != names::FRAMES_UNTIL_SETTLED);
    assert!(table.figures.iter().map(|figure| &figure.name).eq(from_frames));
}

/// The pixel of the hand-made camera has the angle of the paper's pixel.
#[test]
fn the_hand_made_pixel_is_one_pixel() {
    assert!((PIXEL - Angle::from_degrees(LIMITS.ra_deg[0]).radians()).abs() < 1e-15);
}
