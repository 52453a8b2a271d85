//! `boresight navigate`: end to end on a slice of ARGON, and input that it refuses.

use crate::support::{Bench, check_same_files};

#[test]
fn a_slice_of_argon_gives_estimates_figures_and_a_chart() {
    let bench = Bench::new();
    bench.scenario("slice.toml", "argon", |scenario| {
        let mode = "mode = 'best'".parse::<toml::Table>().unwrap();
        scenario.insert("far_range".into(), mode.into());
    });
    bench.boresight("run slice.toml --frames 4000..4060 --no-report --out run").done();
    let json = bench.boresight("navigate run --every 120 --json").done().json();
    assert_eq!(json["estimator"], "batch");
    assert_eq!(json["manoeuvres"], 0);
    let score = &json["score"];
    let estimates = score["estimates"].as_u64().unwrap();
    assert!(estimates >= 8 && score["requested"].as_u64() == Some(estimates), "{score}");
    let rms = |axis: &str| score["position_m"][axis]["rms"].as_f64().unwrap();
    assert!(rms("r") < rms("t") && rms("n") < rms("t"), "{score}");
    let sigma = |axis: &str| score["position_m"][axis]["sigma_rms"].as_f64().unwrap();
    assert!(sigma("r") < sigma("t") && sigma("n") < sigma("t"), "{score}");
    let rows = bench.csv("run/navigation.csv");
    assert_eq!(rows.len() as u64, estimates);
    assert!(rows.iter().all(|row| row["status"] == "estimated" && !row["error_r_m"].is_empty()));
    assert_eq!(bench.json("run/navigation.json"), json);
    // The report has the paper's figure.
    bench.boresight("report run --out run.html").done();
    assert!(bench.read("run.html").contains("Fig. 10"));
    // Files of an earlier navigation are not replaced.
    bench.boresight("navigate run").refused(&["navigation"]);
    let table = bench.boresight("navigate run --estimator sequential --out other").done().stdout;
    assert!(
        table.contains("aδλ") && table.contains("NEES") && table.contains("other/navigation.csv"),
        "{table}"
    );
}

#[test]
fn run_with_navigate_writes_the_files_of_both_commands_and_its_report_has_the_chart() {
    let bench = Bench::new();
    bench.scenario("slice.toml", "argon", |scenario| {
        let mode = "mode = 'best'".parse::<toml::Table>().unwrap();
        scenario.insert("far_range".into(), mode.into());
    });
    let json =
        bench.boresight("run slice.toml --frames 4000..4020 --navigate --out both --json").done().json();
    bench.boresight("run slice.toml --frames 4000..4020 --out run").done();
    // The report of a run has no Fig. 10 before its navigation, and has it afterwards.
    assert!(!bench.read("run/report.html").contains("eR, m"));
    let navigation = bench.boresight("navigate run --json").done().json();
    assert_eq!(json["navigation"], navigation);
    assert_eq!(json["figures"], bench.json("run/score.json")["figures"]);
    check_same_files(&bench.tree("both"), &bench.tree("run"));
    assert!(bench.read("both/report.html").contains("eR, m"));
    // Without a report none is written; a report elsewhere is the caller's.
    bench.boresight("run slice.toml --frames 4000..4004 --no-report --navigate=sequential --out bare").done();
    assert_eq!(bench.json("bare/navigation.json")["estimator"], "sequential");
    bench.boresight("navigate bare --out other").done();
    assert!(!bench.path("bare/report.html").exists() && !bench.path("other/report.html").exists());
}

#[test]
fn a_failed_navigation_leaves_a_complete_run_and_a_reason() {
    let bench = Bench::new();
    bench.boresight("run docking --navigate --frames 0..2 --out a").refused(&["--navigate", "docking"]);
    assert!(!bench.path("a").exists());
    bench.write("blind.py", BLIND);
    let words = ["run", "argon", "--frames", "4000..4003", "--navigate", "--out", "b", "--pipeline"];
    let words = [&words[..], &["exec:python3 blind.py"]].concat();
    bench.boresight_words(&words).refused(&["no relative navigation", "measurements.csv", "los_j2000_x"]);
    assert!(bench.path("b/score.json").exists() && bench.path("b/report.html").exists());
}

/// A pipeline that detects nothing.
const BLIND: &str = r#"
import json, sys
for line in sys.stdin:
    request = json.loads(line)
    if "frame" in request:
        print(json.dumps({"frame": request["frame"], "status": "no_target"}), flush=True)
    else:
        print('{"boresight_pipeline": 1, "name": "blind"}', flush=True)
"#;

#[test]
fn the_bound_of_a_scenario_needs_no_run() {
    let bench = Bench::new();
    let json = bench.boresight("navigate argon --bound --json").done().json();
    assert_eq!(json["manoeuvres"], 10);
    assert!(json["range_sigma_percent"].as_f64().unwrap() < 5.0, "{json}");
    let bounds = json["bounds"].as_array().unwrap();
    let along = |place: usize| bounds[place]["filter_m"][1].as_f64().unwrap();
    assert!(along(bounds.len() - 1) < 0.1 * along(0), "{json}");
    let table = bench.boresight("navigate argon --bound").done().stdout;
    assert!(table.contains("condition number") && table.contains("Cramér–Rao"), "{table}");
}

#[test]
fn wrong_input_of_navigate_is_refused() {
    let bench = Bench::new();
    bench.boresight("run docking --frames 15000..15004 --no-report --out approach").done();
    bench.boresight("navigate approach").refused(&["approach", "docking", "far_range"]);
    bench.boresight("navigate nowhere").refused(&["nowhere"]);
    bench.boresight("navigate argon --bound --every 60").refused(&["--every"]);
    bench.boresight("run argon --frames 4000..4004 --no-report --out run").done();
    bench.boresight("navigate run --every 0").refused(&["--every", "positive"]);
    bench.boresight("run argon --frames 9000..9004 --seed 3 --no-report --out another").done();
    bench.write("run/measurements.csv", bench.read("another/measurements.csv"));
    bench.boresight("navigate run").refused(&["measurements.csv"]);
}
