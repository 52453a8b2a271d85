//! `boresight run --inject`: the truth instead of one stage's result.

use serde_json::Value;
use sim::truth::ObjectKind;

use crate::support::{Bench, figure};

/// A slice of the fourth day: a truncated target, enough stars, and hot pixels that are unknown at first.
const SLICE: &str = "12000..12060";

fn run(bench: &Bench, stage: &str) -> Value {
    let inject = if stage.is_empty() { String::new() } else { format!("--inject {stage}") };
    bench.boresight(&format!("run argon --frames {SLICE} --out run-{stage} --json {inject}")).done().json()
}

#[test]
fn each_injected_stage_removes_its_error_and_is_reported_in_every_file() {
    let bench = Bench::new();
    let own = run(&bench, "");
    assert!(own.get("inject").is_none());
    assert!(!bench.read("run-/run.toml").contains("inject"));
    let injected = |stage: &str| {
        let score = run(&bench, stage);
        assert_eq!(score["inject"], stage);
        assert_eq!(bench.json(&format!("run-{stage}/score.json")), score);
        assert!(bench.read(&format!("run-{stage}/run.toml")).contains(&format!("inject = \"{stage}\"")));
        // After a further scoring, the score still states the stage.
        let again = bench.boresight(&format!("score run-{stage} run-{stage}/measurements.csv --json")).done();
        assert_eq!(again.json(), score);
        score
    };

    // The region truncates the image: Dec has an error of more than half a pixel (0.012°) until the true
    // centre is used.
    let centroids = injected("centroids");
    assert!(figure(&centroids, "dec_rms_deg") < 0.8 * figure(&own, "dec_rms_deg"));
    let whole = injected("roi");
    assert!(figure(&whole, "dec_rms_deg") < 0.8 * figure(&own, "dec_rms_deg"));
    let is_cut = |run: &str| bench.objects(run).iter().any(|object| object.cut > 0.0);
    assert!(is_cut("run-") && !is_cut("run-roi"));

    // Hot pixels and unlisted stars are no longer mistaken for the target: hardly any wrong result remains.
    let identities = injected("identities");
    assert!(figure(&identities, "wrong_rate") < 0.5 * figure(&own, "wrong_rate"));

    // The remaining error across the columns, where nothing is truncated, is that of the centroid.
    let attitude = injected("attitude");
    assert!(figure(&attitude, "ra_rms_deg") < 0.5 * figure(&own, "ra_rms_deg"));

    // At most 0.3″ are removed: the results change only slightly.
    let aberration = injected("aberration");
    let change = figure(&aberration, "ra_rms_deg") - figure(&own, "ra_rms_deg");
    assert!(change != 0.0 && change.abs() < 5e-4, "{change}");
    injected("brightness");
}

/// The measured centre changes by the true offset of the centre of brightness, frame by frame, and keeps its
/// own error.
#[test]
fn the_offset_of_the_centre_of_brightness_is_taken_away() {
    let bench = Bench::new();
    // The first twenty answers are hot pixels.
    let slice = "15000..15090";
    bench.boresight(&format!("run argon --frames {slice} --out own --no-report")).done();
    bench.boresight(&format!("run argon --frames {slice} --out mass --inject brightness --no-report")).done();
    let (own, mass) = (bench.csv("own/measurements.csv"), bench.csv("mass/measurements.csv"));
    let objects = bench.objects("own");
    let (mut moved, mut largest_px) = (0, 0.0_f64);
    for frame in bench.frames("own") {
        let centre = |rows: &[std::collections::BTreeMap<String, String>]| {
            let row = rows.iter().find(|row| row["frame"] == frame.frame.to_string()).unwrap();
            Some((row["x_px"].parse::<f64>().ok()?, row["y_px"].parse::<f64>().ok()?))
        };
        let target = objects.iter().find(|o| o.frame == frame.frame && o.kind == ObjectKind::Target);
        let (Some(own), Some(mass), Some(target)) = (centre(&own), centre(&mass), target) else { continue };
        let offset = frame
            .target_position
            .map(|of_mass| (of_mass.x - target.position.x, of_mass.y - target.position.y));
        let (x, y) = offset.unwrap();
        if (mass.0 - own.0 - x).abs() < 1e-9 && (mass.1 - own.1 - y).abs() < 1e-9 {
            moved += 1;
        }
        largest_px = largest_px.max((x * x + y * y).sqrt());
    }
    // Wrong answers are other objects, which stay where they are.
    assert!(moved > 50, "{moved}");
    // TANGO is 0.8 m long: at most 0.4 m at 3 km, 0.3 px of 0.42 mrad.
    assert!((0.02..0.4).contains(&largest_px), "{largest_px}");
}

#[test]
fn the_frames_of_an_injected_run_are_those_of_the_plain_run() {
    let bench = Bench::new();
    for inject in ["", "--inject attitude"] {
        let out = inject.replace("--inject ", "");
        bench.boresight(&format!("run argon --frames 3..6 --save-frames png --out run{out} {inject}")).done();
    }
    assert_eq!(bench.tree("run/frames"), bench.tree("runattitude/frames"));
    assert_eq!(bench.frames("run"), bench.frames("runattitude"));
    bench.check_same("run/telemetry.csv", "runattitude/telemetry.csv");
}

#[test]
fn an_injected_run_is_marked_under_its_table() {
    let answer = Bench::new().boresight("run argon --frames 0..3 --inject attitude --out run").done();
    assert!(answer.stdout.contains("the truth replaced attitude"), "{}", answer.stdout);
}

#[test]
fn an_impossible_injection_is_refused_before_anything_is_written() {
    let bench = Bench::new();
    let refused = |words: &str, parts: &[&str]| {
        bench.boresight(&format!("run {words} --out run")).refused(parts);
        assert!(!bench.path("run").exists(), "{words}");
    };
    refused("argon --inject attitud", &["'attitud'", "--inject", "attitude", "centroids"]);
    refused("argon --inject all", &["'all'", "--inject"]);
    refused("starting-point --inject roi", &["--inject roi", "`starting-point` has no [roi]"]);
    refused(
        "argon --inject attitude --pipeline exec:cat",
        &["--inject is attitude", "only to the built-in pipeline `far_range`"],
    );
}
