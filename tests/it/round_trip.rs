//! Separate render, process and score give the same results as `run`; and the scoring of an external table.

use std::path::PathBuf;

use boresight::files::read_expected;
use contract::PixelPoint;
use serde_json::Value;
use sim::truth::{FrameTruth, ObjectKind};

use crate::support::{Bench, check_same_files, figure};

/// After the frames in which the pipeline learns the hot pixels: the target is detected in most of them.
const FRAMES: &str = "400..430";

/// Returns a bench with a run of [`FRAMES`] in `run`.
fn with_run() -> Bench {
    let bench = Bench::new();
    bench.boresight(&format!("run argon --frames {FRAMES} --out run")).done();
    bench
}

fn check_round_trip(format: &str) {
    let bench = with_run();
    bench.boresight(&format!("render argon --frames {FRAMES} --format {format} --out set")).done();
    bench.boresight("process set").done();
    check_same_files(&bench.tree("run/truth"), &bench.tree("set/truth"));
    for file in ["measurements.csv", "clusters.parquet", "run.toml", "camera.toml", "stars.csv"] {
        bench.check_same(&format!("run/{file}"), &format!("set/{file}"));
    }
    let score = bench.boresight("score set set/measurements.csv --json").done().json();
    assert_eq!(score, bench.json("run/score.json"));
    // Otherwise the score would have no value for this test.
    assert!(score["figures"]["correct_rate"]["count"].as_u64() > Some(0), "{score}");
}

#[test]
fn a_fits_dataset_processed_and_scored_gives_the_score_of_the_run() {
    check_round_trip("fits");
}

#[test]
fn a_png_dataset_processed_and_scored_gives_the_score_of_the_run() {
    check_round_trip("png");
}

#[test]
fn an_exr_dataset_processed_and_scored_gives_the_score_of_the_run() {
    check_round_trip("exr");
}

#[test]
fn a_run_with_images_is_a_dataset_too() {
    let bench = Bench::new();
    bench.boresight(&format!("run argon --frames {FRAMES} --save-frames png --out run")).done();
    bench.boresight("process run --out again/measurements.csv").done();
    for file in ["measurements.csv", "clusters.parquet"] {
        bench.check_same(&format!("again/{file}"), &format!("run/{file}"));
    }
}

#[test]
fn expected_images_are_the_mean_of_the_frames_and_change_nothing_else() {
    let bench = Bench::new();
    bench.boresight("render starting-point --frames 100..102 --format png --out plain").done();
    bench.boresight("render starting-point --frames 100..102 --format png --expected --out set").done();
    let mut files = bench.tree("set");
    let expected: Vec<PathBuf> =
        files.keys().filter(|file| file.starts_with("truth/expected")).cloned().collect();
    assert_eq!(expected, ["truth/expected/000100.exr", "truth/expected/000101.exr"].map(PathBuf::from));
    files.retain(|file, _| !expected.contains(file));
    check_same_files(&files, &bench.tree("plain"));

    for frame in ["000100", "000101"] {
        let expected = read_expected(&bench.path(&format!("set/truth/expected/{frame}.exr"))).unwrap();
        let image = image::open(bench.path(&format!("set/frames/{frame}.png"))).unwrap().into_luma16();
        let (bias_dn, gain_e_per_dn, saturation_e) = (40.0, 10.0, 40_000.0);
        let residuals_dn: Vec<f64> = image
            .iter()
            .zip(&expected.electrons)
            .map(|(dn, electrons)| (f64::from(*dn), f64::from(*electrons)))
            .filter(|(_, electrons)| *electrons < 0.9 * saturation_e)
            .map(|(dn, electrons)| dn - bias_dn - electrons / gain_e_per_dn)
            .collect();
        let n = residuals_dn.len() as f64;
        let mean_dn = residuals_dn.iter().sum::<f64>() / n;
        let variance_dn2 = residuals_dn.iter().map(|r| r * r).sum::<f64>() / n;
        assert!(n > 430_000.0, "{n} pixels below saturation");
        // Five standard errors of the mean: 0.012 DN. Comparison with the expected image of another frame, or
        // an omitted bias or rounding, would exceed this.
        assert!(mean_dn.abs() < 5.0 * (variance_dn2 / n).sqrt(), "frame {frame}: {mean_dn} DN");
        // Read noise of 15 e-, the shot noise of a few electrons of dark current and background, and
        // rounding.
        assert!((1.5..2.0).contains(&variance_dn2.sqrt()), "frame {frame}: {} DN", variance_dn2.sqrt());
    }
}

#[test]
fn a_run_scored_again_has_the_score_it_had() {
    let bench = with_run();
    let again = bench.boresight("score run run/measurements.csv --json").done().json();
    assert_eq!(again, bench.json("run/score.json"));
}

/// Without the clusters the oracle has less evidence for the causes; the figures do not depend on the
/// clusters.
#[test]
fn without_clusters_the_figures_are_the_same_and_every_miss_still_has_a_cause() {
    let bench = with_run();
    bench.write("alone/measurements.csv", bench.read("run/measurements.csv"));
    let alone = bench.boresight("score run alone/measurements.csv --json").done().json();
    let run = bench.json("run/score.json");
    assert_eq!(alone["figures"], run["figures"]);
    assert_eq!(total(&alone["misses"]), total(&run["misses"]));
    assert_eq!(total(&alone["wrong"]), total(&run["wrong"]));
    assert!(total(&run["misses"]) + total(&run["wrong"]) > 0, "no cause to be told");
    let words = "score run alone/measurements.csv --clusters run/clusters.parquet --json";
    assert_eq!(bench.boresight(words).done().json(), run);
}

fn total(counts: &Value) -> u64 {
    counts.as_object().unwrap().values().map(|count| count.as_u64().unwrap()).sum()
}

/// Score of an external table with four columns, whose rows are made from the truth.
fn score_of(bench: &Bench, row: impl Fn(&FrameTruth, PixelPoint) -> String) -> Value {
    let mut table = "frame,status,x_px,y_px\n".to_owned();
    for truth in bench.frames("run") {
        table += &row(&truth, truth.target_position.unwrap());
        table += "\n";
    }
    bench.write("outside.csv", table);
    bench.boresight("score run outside.csv --attitude true --json").done().json()
}

/// Score of the true positions, shifted.
fn score_of_positions(bench: &Bench, dx: f64, dy: f64) -> Value {
    score_of(bench, |truth, place| format!("{},detected,{},{}", truth.frame, place.x + dx, place.y + dy))
}

#[test]
fn the_true_positions_are_all_correct_and_without_error() {
    let score = score_of_positions(&with_run(), 0.0, 0.0);
    assert_eq!((figure(&score, "hit_rate"), figure(&score, "correct_rate")), (1.0, 1.0));
    for name in ["ra_within_1px", "ra_within_2px", "dec_within_1px", "dec_within_2px"] {
        assert_eq!(figure(&score, name), 1.0, "{name}");
    }
    // The true position is projected and inverted: rounding of 1e-13 px, and the tolerance of the iteration
    // that inverts the distortion, far below a millionth of a pixel (2.4e-8 degrees).
    for name in ["ra_rms_deg", "dec_rms_deg"] {
        assert!(figure(&score, name) < 2.4e-8, "{name} {}", figure(&score, name));
    }
    assert_eq!((total(&score["misses"]), total(&score["wrong"])), (0, 0));
}

/// Mean change of atan(offset) when every position moves by half a pixel, for a pinhole camera of Table 1,
/// degrees. `offset` returns the distance from the principal point in units of the focal length.
fn half_pixel_deg(bench: &Bench, pixel: f64, offset: impl Fn(PixelPoint) -> f64) -> f64 {
    let frames = bench.frames("run");
    let sum: f64 = frames
        .iter()
        .map(|truth| offset(truth.target_position.unwrap()))
        .map(|offset| (libm::atan(offset + 0.5 * pixel) - libm::atan(offset)).to_degrees())
        .sum();
    sum / frames.len() as f64
}

#[test]
fn a_shift_of_half_a_pixel_is_the_bias_and_nothing_else() {
    let bench = with_run();
    let (width, height) = (0.0086 / 20.187, 0.0083 / 20.187);
    let ra_deg = half_pixel_deg(&bench, width, |place| (place.x - 395.0) * width);
    let dec_deg = half_pixel_deg(&bench, height, |place| (place.y - 288.0) * height);
    for (dx, dy, bias) in [(0.5, 0.0, [ra_deg, 0.0]), (0.0, 0.5, [0.0, dec_deg])] {
        let score = score_of_positions(&bench, dx, dy);
        assert_eq!(figure(&score, "correct_rate"), 1.0);
        // The distortion missing from the pinhole changes the scale by less than 3 k1 r² = 0.2 % for r < 150
        // px.
        for (name, expected) in ["ra_mean_deg", "dec_mean_deg"].into_iter().zip(bias) {
            let met = figure(&score, name);
            assert!((met - expected).abs() < 0.002 * (ra_deg + dec_deg), "{name} is {met}, not {expected}");
        }
        let interval = &score["figures"][if dx > 0.0 { "ra_mean_deg" } else { "dec_mean_deg" }];
        assert!(interval["low"].as_f64() > Some(0.0), "the bias is significant: {interval}");
    }
}

/// Regression test: the true attitude used to be applied silently, and the resulting errors were listed
/// beside those of pipelines that had to determine their attitude.
#[test]
fn centroids_have_lines_of_sight_by_the_attitude_that_is_requested_alone() {
    let bench = with_run();
    let granted = score_of_positions(&bench, 0.5, 0.0);
    let none = bench.boresight("score run outside.csv --json").done().json();
    let telemetry = bench.boresight("score run outside.csv --attitude telemetry --json").done().json();
    for (score, word) in [(&none, "none"), (&granted, "true"), (&telemetry, "telemetry")] {
        assert_eq!(score["attitude"], word);
        for name in ["hit_rate", "correct_rate"] {
            assert_eq!(figure(score, name), 1.0, "{word}");
        }
        // The target's centre of brightness differs slightly from its origin.
        assert!((figure(score, "centroid_x_mean_px") - 0.5).abs() < 0.1, "{score}");
        assert!(figure(score, "centroid_y_rms_px") < 0.1, "{score}");
        assert_eq!(figure(score, "line_of_sight_rate"), 0.0);
    }
    for name in ["ra_within_1px", "dec_within_2px", "ra_rms_deg", "dec_mean_deg", "ra_median_deg"] {
        assert!(none["figures"][name]["value"].is_null(), "{name}");
    }
    // The nominal mounting has an error of 0.03°, and telemetry has noise.
    let size = |score: &Value| libm::hypot(figure(score, "ra_rms_deg"), figure(score, "dec_rms_deg"));
    assert!(size(&granted) < 0.015 && size(&telemetry) > 0.02, "{} {}", size(&granted), size(&telemetry));

    let table = |words: &str| bench.boresight(&format!("score run outside.csv {words}")).done().stdout;
    assert!(table("").contains("No measurement has a line of sight"));
    assert!(table("--attitude true").contains("by the attitude `true`"));

    // For a pipeline with its own line of sight, no attitude is provided.
    let own = bench.boresight("score run run/measurements.csv --attitude true --json").done().json();
    assert_eq!(own, bench.json("run/score.json"));
    assert_eq!((&own["attitude"], figure(&own, "line_of_sight_rate")), (&"own".into(), 1.0));
}

/// The option of a run is stored in its `run.toml`: scoring the run again uses it as well, with the same
/// bits.
#[test]
fn a_run_keeps_the_attitude_that_it_grants() {
    let bench = Bench::new();
    let program = format!("exec:python3 '{}/examples/brightest.py'", env!("CARGO_MANIFEST_DIR"));
    let words = ["run", "argon", "--frames", "8000..8006", "--attitude", "telemetry", "--out", "run"];
    bench.boresight_words(&[&words[..], &["--pipeline", &program]].concat()).done();
    let score = bench.json("run/score.json");
    assert_eq!(score["attitude"], "telemetry");
    assert!(score["figures"]["ra_rms_deg"]["of"].as_u64() > Some(0), "{score}");
    assert_eq!(bench.boresight("score run run/measurements.csv --json").done().json(), score);
    assert!(bench.read("run/report.html").contains("by the attitude <code>telemetry</code>"));
    let message = "requires a world whose measurements are lines of sight";
    bench
        .boresight("run docking --frames 0..2 --attitude true --out other")
        .refused(&["--attitude requires a world whose measurements are lines of sight"]);
    bench.boresight("run docking --frames 0..2 --no-report --out docking").done();
    bench.boresight("score docking docking/measurements.csv --attitude true").refused(&[message]);
}

#[test]
fn within_a_pixel_means_the_pixel_of_the_scenarios_own_camera() {
    let bench = Bench::new();
    bench.boresight("run starting-point --frames 0..2 --no-report --out run").done();
    let camera: toml::Table = bench.read("run/camera.toml").parse().unwrap();
    let number = |key: &str| camera["camera"][key].as_float().unwrap();
    let pixel = |side: &str| libm::atan(number(side) / (1000.0 * number("focal_length_mm"))).to_degrees();
    let figures = &bench.json("run/score.json")["figures"];
    for (name, expected) in [
        ("ra_within_1px", pixel("pixel_width_um")),
        ("dec_within_1px", pixel("pixel_height_um")),
        ("ra_within_2px", 2.0 * pixel("pixel_width_um")),
    ] {
        let limit = figures[name]["limit_deg"].as_f64().unwrap();
        assert!((limit / expected - 1.0).abs() < 1e-6, "{name}: {limit}, not {expected}");
    }
    // The limits of the paper, which a scenario states, and which are stored with it in run.toml.
    bench.boresight("run argon --frames 0..2 --no-report --out argon").done();
    let figures = &bench.json("argon/score.json")["figures"];
    assert_eq!(
        (&figures["ra_within_1px"]["limit_deg"], &figures["dec_within_2px"]["limit_deg"]),
        (&0.024.into(), &0.048.into())
    );
    assert!(bench.read("argon/run.toml").contains("within_deg = [0.024, 0.048]"));
    assert!(figures["hit_rate"].get("limit_deg").is_none());
}

#[test]
fn wrong_positions_are_detected_and_wrong() {
    let score = score_of_positions(&with_run(), 60.0, -40.0);
    assert_eq!(figure(&score, "hit_rate"), 1.0);
    assert_eq!((figure(&score, "correct_rate"), figure(&score, "wrong_rate")), (0.0, 1.0));
    assert_eq!(figure(&score, "ra_within_2px"), 0.0);
    assert_eq!((total(&score["misses"]), total(&score["wrong"])), (0, 30));
    assert_eq!(total(&score["wrong_taken"]), 30);
}

#[test]
fn a_position_on_a_hot_pixel_is_wrong_and_names_the_hot_pixel() {
    let bench = with_run();
    let objects = bench.objects("run");
    let hot_pixel = |frame: u64| {
        let hot =
            objects.iter().filter(|object| object.frame == frame && object.kind == ObjectKind::HotPixel);
        hot.max_by(|a, b| a.electrons.total_cmp(&b.electrons)).unwrap().position
    };
    let score = score_of(&bench, |truth, _| {
        let place = hot_pixel(truth.frame);
        format!("{},detected,{},{}", truth.frame, place.x, place.y)
    });
    assert_eq!(score["wrong_taken"], serde_json::json!({ "hot_pixel": 30 }));
}

#[test]
fn rows_left_out_and_rows_without_a_target_are_misses() {
    let bench = with_run();
    let mut table = "frame,status,x_px,y_px\n".to_owned();
    for truth in bench.frames("run").iter().skip(10) {
        table += &format!("{},no_target,,\n", truth.frame);
    }
    bench.write("outside.csv", table);
    let score = bench.boresight("score run outside.csv --json").done().json();
    assert_eq!((figure(&score, "hit_rate"), figure(&score, "miss_rate")), (0.0, 1.0));
    assert_eq!(score["misses"]["not_reported"], 10);
    assert_eq!(total(&score["misses"]), 30);
}
