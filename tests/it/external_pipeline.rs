//! External pipeline programs with `--pipeline exec:COMMAND`: the example of the documentation, and programs
//! with every kind of fault.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use boresight::far_range::FarRangeMission;
use boresight::files::format_utc;
use boresight::run::WorldPipelines as _;
use contract::{
    Calibration, Camera, Direction, FarRange, Frame, ListedStar, PipelineFactory, PixelPoint, Rotation,
    Setup, Telemetry, conformance,
};
use hifitime::Epoch;
use nalgebra::Vector3;
use pipeline::external::ExternalFactory;
use serde_json::{Value, json};

use crate::support::{Bench, figure};

/// Command of the example in examples.
fn brightest() -> String {
    format!("exec:python3 '{}/examples/brightest.py'", env!("CARGO_MANIFEST_DIR"))
}

/// Frames of the starting point with whole images in which the target outshines the hot pixels.
const FRAMES: &str = "100..105";

/// Checks that the measured positions agree with the true positions of the target, except for the first
/// frame, which has no previous frame.
fn check_positions(bench: &Bench, measurements: &str, run: &str, tolerance_px: [f64; 2]) {
    let rows = bench.csv(measurements);
    assert_eq!(rows.len(), bench.frames(run).len());
    for (row, truth) in rows.iter().zip(bench.frames(run)) {
        assert_eq!(row["frame"], truth.frame.to_string());
        if truth.frame == bench.frames(run)[0].frame {
            assert_eq!(row["status"], "no_previous_frame");
            continue;
        }
        assert_eq!(row["status"], "detected", "frame {}", truth.frame);
        let true_place = truth.target_position.unwrap();
        for (column, expected, tolerance) in
            [("x_px", true_place.x, tolerance_px[0]), ("y_px", true_place.y, tolerance_px[1])]
        {
            let met: f64 = row[column].parse().unwrap();
            assert!(
                (met - expected).abs() < tolerance,
                "frame {}: {column} {met}, truth {expected}",
                truth.frame
            );
        }
    }
}

#[test]
fn the_example_finds_the_target_in_whole_images() {
    let bench = Bench::new();
    let words = ["run", "starting-point", "--frames", FRAMES, "--out", "run", "--pipeline", &brightest()];
    bench.boresight_words(&words).done();
    // A bright, complete image: its centroid has an error of some thousandths of a pixel, and the sunlit side
    // of the sphere is up to 0.06 px from its middle. A pixel convention that differs by half a pixel, or
    // exchanged axes, cannot pass.
    check_positions(&bench, "run/measurements.csv", "run", [0.1, 0.1]);
    assert_eq!(figure(&bench.json("run/score.json"), "correct_rate"), 4.0 / 5.0);
}

#[test]
fn the_example_finds_the_target_in_regions_of_interest() {
    let bench = Bench::new();
    let words = ["run", "argon", "--frames", "15000..15005", "--out", "run", "--pipeline", &brightest()];
    bench.boresight_words(&words).done();
    // At 3 km from the target its image is saturated and truncated at the bottom: the centroid moves up by
    // some pixels, as in Fig. 6 of the paper.
    check_positions(&bench, "run/measurements.csv", "run", [0.8, 5.0]);
}

#[test]
fn the_example_answers_a_dataset_as_it_answers_a_run() {
    let bench = Bench::new();
    let pipeline = brightest();
    let words = ["run", "starting-point", "--frames", FRAMES, "--out", "run", "--pipeline", &pipeline];
    bench.boresight_words(&words).done();
    bench.boresight(&format!("render starting-point --frames {FRAMES} --format png --out set")).done();
    bench.boresight_words(&["process", "set", "--pipeline", &pipeline]).done();
    bench.check_same("run/measurements.csv", "set/measurements.csv");
}

/// A small camera at rest, and a listed star with its image at the pixel (10.5, 40.5).
fn setup() -> Setup {
    let star = Vector3::new((10.5 - 31.5) * 8e-3, (40.5 - 23.5) * 8e-3, 20.0);
    Setup {
        camera: Camera {
            columns: 64,
            rows: 48,
            focal_length_mm: 20.0,
            pixel_width_um: 8.0,
            pixel_height_um: 8.0,
            principal_x_px: 31.5,
            principal_y_px: 23.5,
            radial: [0.0; 3],
            tangential: [0.0; 2],
        },
        camera_from_body: Rotation::identity(),
        bit_depth: 12,
        readout: None,
        calibration: Calibration::default(),
        zero_suppression_dn: None,
        stars: vec![ListedStar { id: 7, direction: Direction::from_vector(star).unwrap(), magnitude: 2.0 }],
    }
}

/// A frame of level 100 with a square of 2 × 2 pixels at the listed star, and a fainter square around (30.5,
/// 20.5).
fn star_and_target() -> (Frame, Telemetry) {
    let mut dn = vec![100; 64 * 48];
    for (x, y, level) in [(10, 40, 3000), (30, 20, 1000)] {
        [0, 1, 64, 65].into_iter().for_each(|beside| dn[y * 64 + x + beside] = level);
    }
    let telemetry = Telemetry {
        time: Epoch::from_gregorian_utc_at_midnight(2012, 4, 25),
        exposure_s: 0.25,
        body_from_icrs: Rotation::identity(),
        velocity_km_s: None,
    };
    (Frame::new(1, 64, 48, 12, dn, None).unwrap(), telemetry)
}

/// Run with the interpreter that has the packages.
#[test]
#[ignore = "needs numpy, astropy, sep and photutils; BORESIGHT_PYTHON names the interpreter"]
fn examples_with_packages_keep_the_contract_and_leave_listed_stars_alone() {
    let python = std::env::var("BORESIGHT_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let setup = setup();
    for (name, expected) in [
        ("argmax", PixelPoint::new(10.0, 40.0)),
        ("sep_brightest", PixelPoint::new(30.5, 20.5)),
        ("photutils_brightest", PixelPoint::new(30.5, 20.5)),
    ] {
        let scratch = tempfile::tempdir().unwrap();
        let program = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("examples/{name}.py"));
        let factory = ExternalFactory::<FarRange>::new(
            format!("'{python}' '{}'", program.display()),
            scratch.path().to_owned(),
            Arc::new(FarRangeMission::write_image),
            format_utc,
        );
        assert_eq!(conformance::check(&factory, &setup), Ok(()), "{name}");
        let (image, telemetry) = star_and_target();
        let outcome = factory.build(&setup).unwrap().process(&image, &telemetry);
        let position = outcome.measurement().unwrap_or_else(|| panic!("{name}: {outcome:?}")).position;
        assert!(position.distance(expected) < 0.01, "{name}: {position:?}");
    }
}

/// A program that sends a greeting, answers frames 100 and 101, and then executes `then` in Python with a
/// request in `line`.
fn answers_two_then(then: &str) -> String {
    format!(
        r#"import json, sys, time
sys.stdin.readline()
print(json.dumps({{"boresight_pipeline": 1, "name": "faulty"}}), flush=True)
for line in sys.stdin:
    frame = json.loads(line)["frame"]
    if frame < 102:
        print(json.dumps({{"frame": frame, "status": "no_target"}}), flush=True)
        continue
    {then}
"#
    )
}

/// Runs [`FRAMES`] with a program; returns the statuses and the score.
fn run_with(bench: &Bench, program: &str, more: &[&str]) -> (Vec<String>, Value) {
    bench.write("program.py", program);
    let words = [
        "run",
        "starting-point",
        "--frames",
        FRAMES,
        "--out",
        "run",
        "--pipeline",
        "exec:python3 program.py",
    ];
    bench.boresight_words(&[words.as_slice(), more].concat()).done();
    (statuses(bench), bench.json("run/score.json"))
}

fn statuses(bench: &Bench) -> Vec<String> {
    bench.csv("run/measurements.csv").iter().map(|row| row["status"].clone()).collect()
}

/// Checks that the first two frames are misses by the program, and the other three are failures whose reason
/// contains `parts`.
fn check_fails_after_two(program: &str, more: &[&str], parts: &[&str]) {
    let bench = Bench::new();
    let (statuses, score) = run_with(&bench, program, more);
    assert_eq!((score["frames"].as_u64(), figure(&score, "miss_rate")), (Some(5), 1.0));
    assert_eq!(score["misses"]["pipeline_failed"], 3, "{score}");
    assert_eq!(statuses[..2], ["no_target", "no_target"]);
    for status in &statuses[2..] {
        assert!(status.starts_with("failed: "), "{status}");
        assert!(parts.iter().all(|part| status.contains(part)), "{status}");
    }
}

#[test]
fn a_crashing_program_fails_its_frames_and_its_last_output_is_kept() {
    let then = "sys.exit('the film is full')";
    check_fails_after_two(&answers_two_then(then), &[], &["at frame 102", "the film is full"]);
}

#[test]
fn a_program_that_hangs_is_ended_after_its_timeout() {
    let start = std::time::Instant::now();
    let then = "time.sleep(100)";
    check_fails_after_two(&answers_two_then(then), &["--timeout-s", "0.5"], &["at frame 102", "0.5"]);
    assert!(start.elapsed().as_secs() < 60, "the program was waited for");
}

#[test]
fn an_invalid_answer_fails_its_frame_and_is_shown() {
    check_fails_after_two(&answers_two_then("print('Paris', flush=True)"), &[], &["Paris"]);
}

#[test]
fn a_position_that_is_not_a_number_or_off_the_detector_is_a_failure() {
    for (x, part) in [("float('nan')", "NaN"), ("-3", "(-3, 1)"), ("752", "(752, 1)")] {
        let answer = format!(r#"{{"frame": frame, "status": "detected", "x_px": {x}, "y_px": 1}}"#);
        let then = format!("print(json.dumps({answer}), flush=True)");
        check_fails_after_two(&answers_two_then(&then), &[], &[part]);
    }
}

#[test]
fn an_answer_for_another_frame_is_a_failure() {
    let then = r#"print(json.dumps({"frame": 7, "status": "no_target"}), flush=True)"#;
    check_fails_after_two(&answers_two_then(then), &[], &["frame 7"]);
}

#[test]
fn a_program_that_does_not_exist_is_refused_before_anything_is_written() {
    let bench = Bench::new();
    let words = [
        "run",
        "starting-point",
        "--frames",
        FRAMES,
        "--out",
        "run",
        "--pipeline",
        "exec:no-such-program -x",
    ];
    bench.boresight_words(&words).refused(&["program `no-such-program` not found", "search path"]);
    assert!(!bench.path("run").exists());
}

#[test]
fn a_program_is_given_no_truth() {
    let bench = Bench::new();
    let program = answers_two_then("pass").replace(
        "    frame = ",
        "    request = json.loads(line)\n    open('heard.jsonl', 'a').write(json.dumps({\n        \
         'keys': sorted(request), 'telemetry': sorted(request['telemetry']),\n        \
         'header': open(request['image'], 'rb').read(2880 * 3).decode('latin1')}) + '\\n')\n    frame = ",
    );
    let program = program.replace("frame < 102", "frame < 1000");
    run_with(&bench, &program, &[]);
    // World coordinates and the observer's velocity belong to the truth; a rendered dataset contains them.
    let of_truth = ["CRVAL1", "CTYPE1", "A_ORDER", "OBSVELX"];
    bench.boresight("render starting-point --frames 100..101 --out set").done();
    let rendered = std::fs::read(bench.path("set/frames/000100.fits")).unwrap();
    let rendered = String::from_utf8_lossy(&rendered[..2880 * 3]).into_owned();
    assert!(of_truth.iter().all(|keyword| rendered.contains(keyword)), "{rendered}");

    let heard = bench.read("heard.jsonl");
    assert_eq!(heard.lines().count(), 5);
    for line in heard.lines() {
        let heard: BTreeMap<String, Value> = serde_json::from_str(line).unwrap();
        assert_eq!(heard["keys"], json!(["frame", "image", "telemetry", "windows"]));
        let telemetry = json!(["exposure_s", "q_sc_j2000", "time_utc", "v_orbital_j2000_km_s"]);
        assert_eq!(heard["telemetry"], telemetry);
        let header = heard["header"].as_str().unwrap();
        assert!(header.starts_with("SIMPLE"), "{header}");
        assert!(!of_truth.iter().any(|keyword| header.contains(keyword)), "{header}");
    }
}

/// A pipeline that never finds a target.
const BLIND: &str = r#"
import json, sys

sys.stdin.readline()
print(json.dumps({"boresight_pipeline": 1, "name": "blind"}), flush=True)
for line in sys.stdin:
    print(json.dumps({"frame": json.loads(line)["frame"], "status": "no_target"}), flush=True)
"#;

/// Outcomes of several pipelines on one dataset stand side by side, each with its own files, and each is
/// scored and reported by itself.
#[test]
fn one_dataset_holds_outcomes_of_several_pipelines() {
    let bench = Bench::new();
    bench.write("blind.py", BLIND);
    bench.boresight("render starting-point --frames 100..105 --out data").done();
    bench.boresight("process data").done();
    let process = |out: &str, world: &str| {
        bench.boresight_words(&["process", "data", "--out", out, "--pipeline", world]).done().stdout
    };
    process("data/mine.csv", "exec:python3 blind.py");
    process("new/folder/mine.csv", "far_range");
    for name in ["data/clusters.parquet", "data/mine.clusters.parquet", "new/folder/mine.clusters.parquet"] {
        assert!(bench.path(name).is_file(), "{name}");
    }
    let rate = |file: &str| bench.boresight(&format!("score data {file} --json")).done().json();
    let [own, other] = ["data/measurements.csv", "data/mine.csv"].map(rate);
    assert_eq!(figure(&own, "hit_rate"), 1.0);
    assert_eq!(other["misses"]["unexplained"], 5, "{other}");
    bench.boresight("report data").done();
    bench.boresight("report data --measurements data/mine.csv --out data/mine.html").done();
    assert!(!bench.read("data/report.html").contains("unexplained"));
    assert!(bench.read("data/mine.html").contains("unexplained"));
    bench.boresight("render docking --frames 0..4 --out approach").done();
    bench
        .boresight("report approach")
        .refused(&["approach/measurements.csv: is missing", "boresight process"]);
    bench.boresight("process approach --out approach/first.csv").done();
    bench.boresight("process approach").done();
    bench.boresight("report approach --measurements approach/first.csv --out first.html").done();
    assert!(bench.path("approach/first.motion.csv").is_file() && bench.path("first.html").is_file());
}
