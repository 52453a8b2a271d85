//! Parts of the five days of the scenario `argon`: the effects reported in the far-range paper follow from
//! the physics.

use pipeline::far_range::aberration_correction;
use serde_json::Value;

use crate::support::{Bench, figure};

/// Number of frames of each day that a test uses, and the time between them, s.
#[derive(Clone, Copy)]
struct Stretch {
    frames: i64,
    cadence_s: f64,
}

/// With the cadence of the flight: fifteen minutes of each day.
const AS_FLOWN: Stretch = Stretch { frames: 60, cadence_s: 15.0 };

/// Runs a stretch from the middle of each day with a change to the scenario, and returns the score.
fn score(bench: &Bench, run: &str, stretch: Stretch, change: impl FnOnce(&mut toml::Table)) -> Value {
    let file = format!("argon-{run}.toml");
    bench.scenario(&file, "argon", |scenario| {
        for day in scenario["schedule"].as_array_mut().unwrap() {
            let day = day.as_table_mut().unwrap();
            let start = hifitime::Epoch::from_gregorian_str(day["start_utc"].as_str().unwrap()).unwrap();
            let middle_s =
                0.5 * day["cadence_s"].as_float().unwrap() * day["count"].as_integer().unwrap() as f64;
            let from = start + hifitime::Duration::from_seconds(middle_s.floor());
            day.insert("start_utc".into(), format!("{}Z", from.to_isoformat()).into());
            day.insert("cadence_s".into(), stretch.cadence_s.into());
            day.insert("count".into(), stretch.frames.into());
        }
        change(scenario);
    });
    bench.boresight(&format!("run {file} --out {run} --json")).done().json()
}

/// Removes hot pixels and cosmic-ray hits: a false target on one of them is equally wrong in both angles, and
/// masks the effect of truncated images.
fn without_false_targets(scenario: &mut toml::Table) {
    let sensor = scenario["sensor"].as_table_mut().unwrap();
    sensor.remove("hot_pixels").unwrap();
    sensor.remove("cosmic_rays").unwrap();
}

/// Returns a figure for days 1 to 5.
fn by_day(score: &Value, name: &str) -> [f64; 5] {
    std::array::from_fn(|day| figure(&score["groups"][format!("day {}", day + 1)], name))
}

/// Section 4 and Fig. 6 of the paper: the regions truncate the image of the target at the bottom.
#[test]
fn the_regions_of_interest_and_nothing_else_spoil_the_declination_of_the_last_days() {
    let bench = Bench::new();
    let flown = score(&bench, "flown", AS_FLOWN, without_false_targets);
    let whole = score(&bench, "whole", AS_FLOWN, |scenario| {
        without_false_targets(scenario);
        scenario.remove("roi").unwrap();
    });
    let lost = |score: &Value| -> [f64; 5] {
        let (ra, dec) = (by_day(score, "ra_within_1px"), by_day(score, "dec_within_1px"));
        assert!(ra.iter().all(|rate| *rate > 0.7), "{ra:?}");
        std::array::from_fn(|day| ra[day] - dec[day])
    };
    // 60 frames per day: the uncertainty of a difference of two rates near 0.85 is 0.065; the effect is 0.7.
    let (flown, whole) = (lost(&flown), lost(&whole));
    assert!(flown[..2].iter().all(|lost| lost.abs() < 0.15), "{flown:?}");
    assert!(flown[3..].iter().all(|lost| *lost > 0.5), "{flown:?}");
    assert!(whole.iter().all(|lost| lost.abs() < 0.15), "{whole:?}");
}

/// Fig. 7 of the paper: the shutter shortens the exposure as the target becomes brighter, and stars are lost.
#[test]
fn stars_are_lost_as_the_target_comes_near() {
    let bench = Bench::new();
    let stars = by_day(&score(&bench, "run", AS_FLOWN, |_| {}), "stars_mean");
    assert!(stars[0] > 10.0 && stars[4] < 0.6 * stars[0], "{stars:?}");
    let mut exposures_s = vec![Vec::new(); 5];
    for frame in bench.frames("run") {
        exposures_s[frame.frame as usize / 60].push(frame.exposure_s);
    }
    let mean_s = |day: usize| exposures_s[day].iter().sum::<f64>() / exposures_s[day].len() as f64;
    assert!(mean_s(4) < 0.5 * mean_s(0), "{} s and {} s", mean_s(0), mean_s(4));
}

/// Fig. 9 of the paper: the correction is a few thousandths of a degree, repeats with the orbital period, and
/// improves the mean error.
#[test]
fn correcting_aberration_takes_an_error_with_the_period_of_the_orbit_out_of_the_mean() {
    /// Two periods of the target's orbit, 5990 s each, in a hundred steps each.
    const TWO_ORBITS: Stretch = Stretch { frames: 200, cadence_s: 59.9 };
    let bench = Bench::new();
    // Few stars and noisy telemetry would mask the effect; neither is related to aberration.
    let quiet = |scenario: &mut toml::Table| {
        scenario["schedule"].as_array_mut().unwrap().truncate(2);
        let knowledge = scenario["knowledge"].as_table_mut().unwrap();
        knowledge.insert("noise_arcsec".into(), vec![0.0; 3].into());
        knowledge.insert("bias_arcsec".into(), vec![0.0; 3].into());
        knowledge.remove("drift");
    };
    let corrected = score(&bench, "corrected", TWO_ORBITS, quiet);
    let ignored = score(&bench, "ignored", TWO_ORBITS, |scenario| {
        quiet(scenario);
        let far_range = scenario["far_range"].as_table_mut().unwrap();
        far_range.insert("aberration".into(), "ignore".into());
    });
    let corrections_deg: Vec<nalgebra::Vector3<f64>> = bench
        .frames("corrected")
        .iter()
        .map(|truth| {
            let correction =
                aberration_correction(truth.time, Some(truth.velocity_km_s), &truth.camera_from_icrs)
                    .unwrap();
            correction.quaternion().scaled_axis() * 57.295_779_513
        })
        .collect();
    let largest = corrections_deg.iter().map(|correction| correction.norm()).fold(0.0, f64::max);
    assert!((0.004..0.006).contains(&largest), "{largest}°");
    let day_2 = &corrections_deg[200..];
    let mean_change = |lag: usize| {
        day_2.iter().zip(&day_2[lag..]).map(|(a, b)| (b - a).norm()).sum::<f64>() / (200 - lag) as f64
    };
    assert!(mean_change(100) < 0.05 * mean_change(50), "{}° and {}°", mean_change(100), mean_change(50));
    let mean_error = |score: &Value| libm::hypot(figure(score, "ra_rms_deg"), figure(score, "dec_rms_deg"));
    assert!(
        mean_error(&corrected) < 0.9 * mean_error(&ignored),
        "{}° and {}°",
        mean_error(&corrected),
        mean_error(&ignored)
    );
}
