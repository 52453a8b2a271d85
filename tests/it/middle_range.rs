//! The middle range: run, score, closed loop, study, gate, report and monitor.

use boresight::middle_range::STARTING_POINT;
use boresight::monitor::{Feed, Measurements};
use boresight::pipeline_choice::PipelineChoice;
use boresight::run::{Options, ScenarioSource};

use crate::support::Bench;

fn figure(score: &serde_json::Value, name: &str) -> f64 {
    score[name]["value"].as_f64().unwrap_or_else(|| panic!("{name}: {score}"))
}

#[test]
fn a_sphere_is_measured_from_two_kilometres_to_a_hundred_metres() {
    let bench = Bench::new();
    bench.boresight("run middle-range --jobs 1 --save-frames png --out run").done();
    let score: serde_json::Value = serde_json::from_str(&bench.read("run/score.json")).unwrap();
    assert!(figure(&score, "correct_rate") > 0.98, "{score}");
    assert!(figure(&score, "range_rms_percent") < 5.0 && figure(&score, "centre_rms_px") < 0.5, "{score}");
    assert!(figure(&score, "range_within_3_sigma") > 0.95, "{score}");
    // The first frame is under-exposed; the answers control the exposure from then on.
    let states = bench.read("run/truth/states.jsonl");
    assert!(states.lines().count() > 20, "{states}");
    assert!(bench.read("run/report.html").contains("Range error"));

    // Any frame is made again alone, and stored images give the same answers.
    bench.boresight("render run/run.toml --frames 117..118 --out again").done();
    bench.check_same("run/frames/000117.png", "again/frames/000117.png");
    bench.boresight("process run --out answers.csv").done();
    bench.check_same("answers.csv", "run/measurements.csv");
    assert_eq!(bench.boresight("score run answers.csv --json").done().json(), score);

    // A run is no worse than itself as a baseline.
    bench.boresight("gate baseline run --out before --reason first").done();
    bench.boresight("gate before run").done();
}

#[test]
fn a_study_varies_the_phase_and_a_wrong_value_is_refused_by_name() {
    let bench = Bench::new();
    bench.write(
        "study.toml",
        "title = \"Phase\"\nscenario = \"middle-range\"\nseed = 1\nframes = \"200..204\"\n[stop]\ncases = 6\n\
         [[vary]]\npath = \"body.phase_deg\"\ndistribution = { kind = \"uniform\", min = 20.0, max = 80.0 }\n",
    );
    bench.boresight("study run study.toml --out study").done();
    assert!(bench.read("study/summary.json").contains("range_rms_percent"));
    let text = STARTING_POINT;
    bench.write("near.toml", text.replace("radius_m = 4.0", "radius_m = 200.0"));
    bench.boresight("run near.toml --out near").refused(&["near.toml", "body.radius_m", "100 m"]);
    bench.write("few.toml", text.replace("frames = 240", "frames = 0"));
    bench.boresight("scenario check few.toml").found(&["few.toml", "approach.frames", "1"]);
    bench.boresight("run middle-range --attitude true --out a").refused(&["--attitude"]);
    bench.boresight("run middle-range --inject roi --out a").refused(&["--inject roi", "middle_range"]);
}

#[test]
fn the_monitor_shows_it() {
    boresight::register_worlds();
    let source = ScenarioSource::read("middle-range").unwrap();
    let mission = source.prepare(Options::default()).unwrap();
    let choice = PipelineChoice { word: None, timeout_s: 10.0, memory_mb: 4000, sandbox: None };
    let factory = mission.factory(&choice, std::path::Path::new("")).unwrap();
    Feed::new(mission, Measurements::Live { factory, frames: 0..3, jobs: 1 }).unwrap();
}
