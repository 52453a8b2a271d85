//! `boresight navigate`: end to end on a slice of ARGON, and input that it refuses.

use std::collections::BTreeMap;

use crate::support::{Bench, STUDY, check_same_files};

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
    assert!(bench.read("run.html").contains("Errors of the relative navigation"));
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

/// The navigator of the documentation, as a program: it keeps the rules, and its answers are scored.
#[test]
fn a_program_navigates() {
    let bench = Bench::new();
    let program = format!("exec:python3 '{}/examples/prior_orbit.py'", env!("CARGO_MANIFEST_DIR"));
    bench.boresight("run argon --frames 0..30 --no-report --out run").done();
    let words = ["navigate", "run", "--every", "120", "--json", "--navigator", &program];
    let json = bench.boresight_words(&words).done().json();
    assert_eq!(json["estimator"], *program);
    let score = &json["score"];
    assert_eq!(score["estimates"], score["requested"], "{score}");
    // The prior errs by less than 3 σ of 500 m, and its orbit does not spread it within minutes.
    let along = &score["position_m"]["t"];
    assert_eq!(along["within_3_sigma"].as_f64(), Some(1.0), "{score}");
    let sigma = along["sigma_rms"].as_f64().unwrap();
    assert!((490.0..520.0).contains(&sigma), "{score}");
    assert!(score["measurements"].as_object().unwrap().is_empty(), "it reports no dispositions");
    let checked = bench.boresight_words(&["navigate", "--conformance", "--navigator", &program]).done();
    assert!(checked.stdout.contains("keeps the rules"), "{}", checked.stdout);
    // A navigator that answers nothing useful is negative, with every reason.
    bench.write("blind.py", BLIND_NAVIGATOR);
    let answer =
        bench.boresight_words(&["navigate", "--conformance", "--navigator", "exec:python3 blind.py"]);
    assert_eq!(answer.status, Some(1), "{}", answer.stderr);
    assert!(answer.stdout.contains("hours of measurements: no estimate"), "{}", answer.stdout);
    let answer = bench.boresight("navigate run --navigator exec:true --out other");
    answer.refused(&["exec:true", "during the greeting"]);
    bench.boresight("navigate run --navigator bach").refused(&["bach", "did you mean `batch`"]);
    bench.boresight("navigate run --navigator exec:nowhere").refused(&["`nowhere` not found"]);
    bench.boresight("navigate").refused(&["RUN|SCENARIO"]);
    assert!(!bench.path("other").exists());
}

/// A navigator without estimates.
const BLIND_NAVIGATOR: &str = r#"
import json, sys
input()
print('{"boresight_navigator": 1, "name": "blind", "mode": "batch"}', flush=True)
for line in sys.stdin:
    request = json.loads(line)
    if "estimate" in request:
        print(json.dumps({"estimates": [{"no_estimate": "no_convergence"}] * len(request["estimate"])}), flush=True)
"#;

/// Another tool's measurements: those of the run itself, as a table and as messages, give its orbit.
#[test]
fn measurements_of_another_tool_navigate() {
    let bench = Bench::new();
    bench.scenario("slice.toml", "argon", |scenario| {
        let mode = "mode = 'best'".parse::<toml::Table>().unwrap();
        scenario.insert("far_range".into(), mode.into());
    });
    bench.boresight("run slice.toml --frames 4000..4030 --no-report --out run").done();
    let sigma = |json: &serde_json::Value| json["score"]["position_m"]["t"]["sigma_rms"].as_f64().unwrap();
    let rms =
        |json: &serde_json::Value, axis: &str| json["score"]["position_m"][axis]["rms"].as_f64().unwrap();
    let own = bench.boresight("navigate run --json --out own").done().json();
    assert!(own.get("measurements_file").is_none());
    let table = bench.read("run/measurements.csv");
    bench.write("theirs.csv", &table);
    let same = bench.boresight("navigate run --measurements theirs.csv --json --out same").done().json();
    assert_eq!(same["score"], own["score"]);
    assert_eq!(same["measurements_file"], "theirs.csv");
    for (notation, file) in [("kvn", "los.tdm"), ("xml", "los.xml")] {
        let out = format!("export run --format tdm --notation {notation} --out {file}");
        bench.boresight(&out).done();
        let words = format!("navigate run --measurements {file} --sigma-arcsec 2 --json --out of-{notation}");
        let json = bench.boresight(&words).done().json();
        assert_eq!(json["lines_of_sight"], own["lines_of_sight"], "{file}");
        // Directions are the same, and weights about the same.
        assert!((sigma(&json) / sigma(&own) - 1.0).abs() < 0.1, "{json} {own}");
        assert!((rms(&json, "t") - rms(&own, "t")).abs() < 0.3 * sigma(&own), "{json} {own}");
    }
    let refused = |words: &str, parts: &[&str]| {
        bench.boresight(&format!("navigate run --out no --measurements {words}")).refused(parts);
    };
    refused("los.tdm", &["los.tdm", "--sigma-arcsec"]);
    for sigma in ["0", "-1", "NaN", "inf", "36001"] {
        refused(&format!("los.tdm --sigma-arcsec={sigma}"), &["--sigma-arcsec", sigma, "above 0"]);
    }
    refused("nowhere.csv", &["nowhere.csv"]);
    // Another time scale: the same numbers of TAI are 34 s earlier.
    let message = bench.read("los.tdm");
    bench.write("tai.tdm", message.replace("TIME_SYSTEM = UTC", "TIME_SYSTEM = TAI"));
    refused("tai.tdm --sigma-arcsec 2", &["tai.tdm", "EPOCH", "(TAI)", "telemetry.csv"]);
    // Another run: other times, and a direction behind the camera.
    bench.boresight("run slice.toml --frames 9000..9003 --no-report --out far").done();
    bench.boresight("export far --format tdm --out far.tdm").done();
    refused("far.tdm --sigma-arcsec 2", &["far.tdm", "EPOCH", "telemetry.csv"]);
    let line = message.lines().find(|line| line.starts_with("ANGLE_2")).unwrap();
    let angle: f64 = line.split_whitespace().last().unwrap().parse().unwrap();
    let turned =
        format!("{} {:.9}", line.rsplit_once(' ').unwrap().0, if angle > 0.0 { -80.0 } else { 80.0 });
    bench.write("turned.tdm", message.replacen(line, &turned, 1));
    refused("turned.tdm --sigma-arcsec 2", &["turned.tdm", "ANGLE_1", "from the boresight"]);
    bench.write("nan.tdm", message.replacen(line, &format!("{} NaN", line.rsplit_once(' ').unwrap().0), 1));
    refused("nan.tdm --sigma-arcsec 2", &["nan.tdm", "ANGLE_2", "NaN"]);
    // Times beside a table's rows are compared with those of the run.
    let columns = bench.csv("run/telemetry.csv");
    let stated = |shift: usize| -> String {
        let row = |(place, line): (usize, &str)| match place {
            0 => format!("{line},time_utc"),
            _ => format!("{line},{}", columns[(place - 1 + shift) % columns.len()]["time_utc"]),
        };
        table.lines().enumerate().map(row).collect::<Vec<_>>().join("\n") + "\n"
    };
    bench.write("timed.csv", stated(0));
    bench.boresight("navigate run --measurements timed.csv --out timed").done();
    bench.write("late.csv", stated(1));
    refused("late.csv", &["late.csv", "line 2", "time_utc", "the time of frame 4000"]);
    // One measurement leaves the prior.
    let first: Vec<&str> = table.lines().take(2).collect();
    bench.write("one.csv", first.join("\n") + "\n");
    let one = bench.boresight("navigate run --measurements one.csv --json --out one").done().json();
    assert_eq!((one["lines_of_sight"].as_u64(), one["score"]["estimates"].as_u64()), (Some(1), Some(1)));
    assert!(sigma(&one) > 300.0, "{one}");
    bench.boresight("navigate argon --bound --measurements one.csv").refused(&["--measurements", "run.toml"]);
}

/// A study records the figures of the navigation of each case, and a gate compares two studies, and two runs.
#[test]
fn studies_record_and_gates_compare_navigations() {
    let bench = Bench::new();
    let study = |navigate: &str, figures: &str| {
        format!(
            r#"
title = "navigation on an hour of ARGON"
scenario = "argon"
seed = 5
frames = "4000..4012"
{navigate}
[stop]
cases = 5
[[sweep]]
path = "far_range"
values = [{{ mode = "best" }}]
[[vary]]
path = "orbit.relative.a_dlambda_m"
distribution = {{ kind = "normal", mean = -30000.0, sigma = 300.0 }}
[record]
figures = [{figures}]
"#
        )
    };
    let figures = r#""correct_rate", "navigation_t_rms_m", "navigation_within_3_sigma", "navigation_state_nees_mean", "navigation_t_square_over_bound""#;
    bench.write("with.toml", study("navigate = \"batch\"", figures));
    bench.boresight("study run with.toml --out with").done();
    let summary = bench.json("with/summary.json");
    let all = |name: &str| summary["figures"][name]["all"]["value"].as_f64();
    assert_eq!(summary["figures"]["navigation_t_rms_m"]["cases"], 5, "{summary}");
    assert!((1.0..2000.0).contains(&all("navigation_t_rms_m").unwrap()), "{summary}");
    assert!((0.5..=1.0).contains(&all("navigation_within_3_sigma").unwrap()), "{summary}");
    assert!(all("navigation_state_nees_mean").unwrap() > 0.0, "{summary}");
    assert!(all("navigation_t_square_over_bound").unwrap() > 0.0, "{summary}");
    bench.boresight("gate baseline with --out base --reason first").done();
    let report = bench.boresight("gate base with --json");
    assert_eq!(report.status, Some(0), "{}", report.stderr);
    assert!(report.json()["figures"]["navigation_t_rms_m"].is_object(), "{}", report.stdout);
    // Without the key there are no such figures, and the plan of a study is as before.
    bench.write("without.toml", study("", figures));
    bench
        .boresight("study run without.toml --out without")
        .refused(&["record.figures[1]", "navigation_t_rms_m"]);
    bench.write(
        "docking.toml",
        STUDY.replace("argon", "docking").replace("title", "navigate = 'batch'\ntitle"),
    );
    bench.boresight("study run docking.toml --out docking").refused(&[
        "navigate",
        "no relative navigation",
        "docking",
    ]);
    // Two runs of the same frames, each with its navigation.
    bench.scenario("best.toml", "argon", |scenario| {
        scenario.insert("far_range".into(), "mode = 'best'".parse::<toml::Table>().unwrap().into());
    });
    for (name, navigator) in [("a", "batch"), ("b", "sequential")] {
        bench
            .boresight(&format!(
                "run best.toml --frames 4000..4200 --navigate={navigator} --no-report --out {name}"
            ))
            .done();
    }
    bench.boresight("gate baseline a --out base-a --reason first").done();
    let figures = "--figures navigation_t_rms_m,navigation_position_nees_mean";
    let same = bench.boresight(&format!("gate base-a a {figures} --json")).json();
    assert_eq!(same["figures"]["navigation_t_rms_m"]["difference"].as_f64(), Some(0.0), "{same}");
    let other = bench.boresight(&format!("gate base-a b {figures} --json")).json();
    let found = &other["figures"]["navigation_t_rms_m"];
    let of_run = |name: &str| {
        bench.json(&format!("{name}/navigation.json"))["score"]["position_m"]["t"]["rms"].as_f64().unwrap()
    };
    let (before, after) = (found["baseline"].as_f64().unwrap(), found["result"].as_f64().unwrap());
    assert!((before / of_run("a") - 1.0).abs() < 0.02 && (after / of_run("b") - 1.0).abs() < 0.02, "{other}");
    bench.boresight("run best.toml --frames 4000..4200 --no-report --out c").done();
    bench.boresight("gate base-a c").refused(&["navigation_estimate_rate", "--figures"]);
}

/// The parts of the error add up to it, and a part is zero where its input is exact.
#[test]
fn the_budget_of_a_navigation_adds_up_to_its_error() {
    let bench = Bench::new();
    bench.scenario("best.toml", "argon", |scenario| {
        scenario.insert("far_range".into(), "mode = 'best'".parse::<toml::Table>().unwrap().into());
    });
    let parts = |scenario: &str, out: &str| {
        bench
            .boresight(&format!("run {scenario} --frames 4000..4060 --no-report --navigate --out {out}"))
            .done();
        let json = bench.boresight(&format!("navigate {out} --budget --json")).done().json();
        let parts: BTreeMap<String, [[f64; 3]; 2]> = json["parts"]
            .as_array()
            .unwrap()
            .iter()
            .map(|part| {
                let three = |key: &str| [0, 1, 2].map(|axis| part[key][axis].as_f64().unwrap());
                (part["cause"].as_str().unwrap().to_owned(), [three("rms_m"), three("share")])
            })
            .collect();
        let score = bench.json(&format!("{out}/navigation.json"))["score"]["position_m"].clone();
        for (axis, name) in ["r", "t", "n"].into_iter().enumerate() {
            let sum: f64 = parts.values().map(|[_, share]| share[axis]).sum();
            assert!((sum - 1.0).abs() < 1e-9, "{parts:?}");
            assert!(parts["interaction"][1][axis].abs() < 0.05, "{parts:?}");
            let without = json["share_without_interaction"][axis].as_f64().unwrap();
            assert!((without + parts["interaction"][1][axis] - 1.0).abs() < 1e-12, "{json}");
            // The budget composes each line of sight from its parts; the prior leaves the range uncertain,
            // which enlarges rounding.
            let rms = json["rms_m"][axis].as_f64().unwrap();
            assert!((rms / score[name]["rms"].as_f64().unwrap() - 1.0).abs() < 1e-7, "{json} {score}");
        }
        parts
    };
    let best = parts("best.toml", "best");
    // No manoeuvre in this quarter of an hour; the attitude is that of each image, without a mounting.
    for cause in ["manoeuvre_knowledge", "mounting"] {
        assert_eq!(best[cause][0], [0.0; 3], "{best:?}");
    }
    for cause in ["detector", "attitude", "centre_of_brightness", "prior"] {
        assert!(best[cause][0].iter().all(|rms| *rms > 0.0), "{best:?}");
    }
    // The range is that of the prior within minutes.
    assert!(best["prior"][1][1] > 0.9, "{best:?}");
    // The paper's mode learns its hot pixels first, and takes them for the target until then.
    bench.boresight("run argon --frames 4000..4006 --no-report --out paper").done();
    bench
        .boresight("navigate paper --budget")
        .refused(&["no estimate at 2012-04-24", "none of 5 lines of sight is within 5 σ"]);
    let table = bench.boresight("navigate best --budget").done().stdout;
    assert!(table.contains("centre of brightness") && table.contains("interaction"), "{table}");
    bench.boresight("navigate best --budget --out other").refused(&["--budget", "--out"]);
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

/// The paper's first statement (section 4): errors in R and N are smaller than in T, because the boresight is
/// nearly along the velocity. With integrated orbits, which the navigator's theory approximates.
#[test]
fn on_numerical_orbits_the_error_along_track_is_the_largest() {
    let bench = Bench::new();
    bench.scenario("thin.toml", "argon-numerical", |scenario| {
        scenario.insert("far_range".into(), "mode = 'best'".parse::<toml::Table>().unwrap().into());
        let day = |name: &str, start: &str, count: i64| {
            let day = format!("name = '{name}'\nstart_utc = {start}\ncadence_s = 1800.0\ncount = {count}");
            toml::Value::from(day.parse::<toml::Table>().unwrap())
        };
        let days = vec![
            day("day 1", "'2012-04-23T07:00:00Z'", 13),
            day("day 2", "'2012-04-24T06:00:00Z'", 24),
            day("day 3", "'2012-04-25T06:00:00Z'", 27),
        ];
        scenario.insert("schedule".into(), days.into());
    });
    bench.boresight("run thin.toml --no-report --out run").done();
    let json = bench.boresight("navigate run --json").done().json();
    let score = &json["score"];
    assert_eq!(score["estimates"], score["requested"], "{score}");
    let of = |axis: &str, figure: &str| score["position_m"][axis][figure].as_f64().unwrap();
    for figure in ["rms", "sigma_rms"] {
        assert!(5.0 * of("r", figure) < of("t", figure), "{score}");
        assert!(5.0 * of("n", figure) < of("t", figure), "{score}");
    }
    assert!(["r", "t", "n"].iter().all(|axis| of(axis, "within_3_sigma") > 0.97), "{score}");
    // A filter has no report of a manoeuvre for ten minutes after it.
    let json = bench.boresight("navigate run --navigator sequential --out filter --json").done().json();
    let before = &json["score"]["before_report"];
    assert!((1..=8).contains(&before["estimates"].as_u64().unwrap()), "{json}");
    let all = json["score"]["nees_state_per_dimension"].as_f64().unwrap();
    assert!(before["others_nees_state_per_dimension"].as_f64().unwrap() < 0.5 * all, "{json}");
}

/// The cause of the paper's second statement: errors grow at the end of 26 April, because fewer stars are
/// detected and regions cut the target. Lines of sight of that evening have a bias of the declination that
/// whole images do not have.
#[test]
fn at_the_end_of_the_fourth_day_stars_are_fewer_and_regions_bias_the_declination() {
    let bench = Bench::new();
    let figures = |frames: &str, more: &str, out: &str| {
        bench.boresight(&format!("run argon --frames {frames} --no-report {more} --out {out}")).done();
        let figures = bench.json(&format!("{out}/score.json"))["figures"].clone();
        let value = |name: &str| figures[name]["value"].as_f64().unwrap();
        (3600.0 * value("dec_median_deg"), value("stars_mean"))
    };
    // 24 and 26 April, evening.
    let (early_arcsec, early_stars) = figures("4000..4080", "", "early");
    let (late_arcsec, late_stars) = figures("13000..13080", "", "late");
    let (whole_arcsec, _) = figures("13000..13080", "--inject roi", "whole");
    assert!(early_arcsec.abs() < 40.0, "{early_arcsec}");
    assert!((-300.0..-120.0).contains(&late_arcsec), "{late_arcsec}");
    assert!(whole_arcsec.abs() < 0.3 * late_arcsec.abs(), "{whole_arcsec} {late_arcsec}");
    assert!(late_stars < 0.7 * early_stars, "{late_stars} {early_stars}");
}
