//! `boresight run`: its files, its JSON, its table, and identical bits for identical frames.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use boresight::far_range::rows::read_telemetry;
use boresight::far_range::scoring::{ARGON_TABLE_2, names};
use boresight::far_range::simulator;
use boresight::files::{format_utc, parse_utc};
use boresight::run::ScenarioSource;
use hifitime::Unit;
use serde_json::Value;
use sim::truth::{ObjectKind, ObjectTruth};

use crate::support::{Bench, check_same_files};

#[test]
fn a_run_directory_holds_every_file_of_a_run() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 300..303 --out run --save-frames fits").done();
    let files: BTreeSet<PathBuf> = bench.tree("run").into_keys().collect();
    let expected = [
        "SHA256SUMS",
        "camera.toml",
        "clusters.parquet",
        "frames/000300.fits",
        "frames/000301.fits",
        "frames/000302.fits",
        "measurements.csv",
        "report.html",
        "run.toml",
        "score.json",
        "stars.csv",
        "telemetry.csv",
        "truth/frames.parquet",
        "truth/manoeuvres.csv",
        "truth/objects.parquet",
    ];
    assert_eq!(files, expected.map(PathBuf::from).into());
}

/// Timestamps of the truth cannot represent second 60, and never decrease: a time within it is replaced by
/// the end of the leap second.
fn check_times(telemetry: &[String], truth: &[String]) {
    let expected = |text: &String| {
        if text.contains(":60.") { "2017-01-01T00:00:00.000000000Z".to_owned() } else { text.clone() }
    };
    assert!(telemetry.iter().any(|text| text.contains("23:59:60.")), "{telemetry:?}");
    assert_eq!(truth, telemetry.iter().map(expected).collect::<Vec<_>>());
    assert!(truth.is_sorted(), "{truth:?}");
}

#[test]
fn times_of_the_truth_go_through_a_leap_second_in_both_worlds() {
    let bench = Bench::new();
    bench.scenario("far.toml", "starting-point", |table| {
        table["orbit"]["epoch_utc"] = "2016-12-31T00:00:00Z".into();
        table["schedule"][0]["start_utc"] = "2016-12-31T23:59:10.75Z".into();
        table["schedule"][0]["cadence_s"] = 1.5.into();
    });
    bench.boresight("run far.toml --frames 0..40 --out far").done();
    let telemetry: Vec<String> =
        bench.csv("far/telemetry.csv").iter().map(|row| row["time_utc"].clone()).collect();
    let truth: Vec<String> = bench.frames("far").iter().map(|truth| format_utc(truth.time)).collect();
    check_times(&telemetry, &truth);
    bench.scenario("near.toml", "docking", |table| {
        table["start_utc"] = "2016-12-31T23:59:59.5Z".into();
    });
    bench.boresight("run near.toml --frames 0..100 --out near").done();
    let start = parse_utc("2016-12-31T23:59:59.5Z").unwrap();
    let time = |row: &BTreeMap<String, String>| {
        format_utc(start + Unit::Second * row["time_s"].parse::<f64>().unwrap())
    };
    let telemetry: Vec<String> = bench.csv("near/telemetry.csv").iter().map(time).collect();
    let truth: Vec<String> = bench.fields("near").iter().map(|truth| format_utc(truth.time)).collect();
    check_times(&telemetry, &truth);
}

#[test]
fn every_table_of_a_run_has_a_row_for_every_frame() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 300..310 --out run").done();
    let expected: Vec<u64> = (300..310).collect();
    for table in ["run/telemetry.csv", "run/measurements.csv"] {
        let frames: Vec<u64> = bench.csv(table).iter().map(|row| row["frame"].parse().unwrap()).collect();
        assert_eq!(frames, expected, "{table}");
    }
    assert_eq!(bench.frames("run").iter().map(|truth| truth.frame).collect::<Vec<_>>(), expected);
    for frame in expected {
        let targets = bench
            .objects("run")
            .iter()
            .filter(|object| object.frame == frame && object.kind == ObjectKind::Target)
            .count();
        assert_eq!(targets, 1, "frame {frame}");
    }
}

#[test]
fn run_toml_is_enough_to_repeat_a_run() {
    let bench = Bench::new();
    bench.boresight("run starting-point --frames 40..44 --seed 5 --out first --save-frames png").done();
    let run: toml::Table = bench.read("first/run.toml").parse().unwrap();
    bench.write("starting-point.toml", run["scenario"].as_table().unwrap().to_string());
    bench.boresight("run starting-point.toml --frames 40..44 --out again --save-frames png").done();
    check_same_files(&bench.tree("first"), &bench.tree("again"));
}

/// Checks the members of a figure, their types, and that its interval contains its value.
fn check_figure(name: &str, figure: &Value) {
    let members: Vec<_> = figure.as_object().unwrap().keys().collect();
    for expected in ["value", "count", "of", "low", "high"] {
        assert!(members.iter().any(|member| *member == expected), "{name}: {expected} in {figure}");
    }
    let (count, of) = (figure["count"].as_u64().unwrap(), figure["of"].as_u64().unwrap());
    assert!(count <= of, "{name}: {figure}");
    match figure["value"].as_f64() {
        None => assert!(of == 0 && figure["value"].is_null(), "{name}: {figure}"),
        Some(value) => {
            let holds = figure["low"].as_f64().is_none_or(|low| low <= value)
                && figure["high"].as_f64().is_none_or(|high| value <= high);
            assert!(holds, "{name}: {figure}");
            if name.ends_with("_rate") || name.contains("_within_") {
                assert_eq!(value, count as f64 / of as f64, "{name}");
            }
        }
    }
}

/// Sum of the counts in an object.
fn total(counts: &Value) -> u64 {
    counts.as_object().unwrap().values().map(|count| count.as_u64().unwrap()).sum()
}

#[test]
fn json_prints_one_document_of_the_documented_shape_and_nothing_else() {
    let bench = Bench::new();
    // Two days, to have two groups.
    let answer = bench.boresight("run argon --frames 1614..1664 --out run --json").done();
    let score = answer.json();
    assert_eq!(score, bench.json("run/score.json"));
    assert_eq!((score["scenario"].as_str(), score["seed"].as_u64()), (Some("argon"), Some(20_120_423)));
    assert_eq!(score["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(score["frames"], 50);
    let groups = score["groups"].as_object().unwrap();
    let frames: Vec<_> = groups.iter().map(|(name, group)| (name.as_str(), &group["frames"])).collect();
    assert_eq!(frames, [("day 1", &Value::from(20)), ("day 2", &Value::from(30))]);
    for scope in groups.values().chain([&score]) {
        let figures = scope["figures"].as_object().unwrap();
        for name in [
            names::HIT_RATE,
            names::RA_WITHIN_1PX,
            names::RA_WITHIN_2PX,
            names::DEC_WITHIN_1PX,
            names::DEC_WITHIN_2PX,
            names::CORRECT_RATE,
            names::WRONG_RATE,
        ] {
            assert!(figures.contains_key(name), "{name}");
        }
        figures.iter().for_each(|(name, figure)| check_figure(name, figure));
        let detected = scope["figures"][names::HIT_RATE]["count"].as_u64().unwrap();
        assert_eq!(detected + total(&scope["misses"]), scope["frames"].as_u64().unwrap());
    }
}

#[test]
fn the_table_has_a_column_for_each_day_and_one_for_all() {
    let bench = Bench::new();
    let answer = bench.boresight("run argon --frames 1614..1664 --out run").done();
    let cells = |label: &str| -> Vec<String> {
        let line = answer.stdout.lines().find(|line| line.trim_start().starts_with(label));
        line.unwrap_or_else(|| panic!("{label} in\n{}", answer.stdout))
            .split("  ")
            .map(str::trim)
            .filter(|cell| !cell.is_empty())
            .map(str::to_owned)
            .collect()
    };
    assert_eq!(cells("day 1"), ["day 1", "day 2", "all"]);
    assert_eq!(cells("images"), ["images", "20", "30", "50"]);
    for label in ["hit rate", "columns < 0.024°", "columns < 0.048°", "rows < 0.024°", "rows < 0.048°"] {
        let cells = cells(label);
        assert_eq!(cells.len(), 4, "{cells:?}");
        assert!(cells[1..].iter().all(|cell| cell.contains('(') && cell.contains('–')), "{cells:?}");
    }
    assert!(answer.stdout.contains("Misses by cause") && answer.stdout.contains("results in run"));
}

/// Frames are rendered in batches of 8 per thread: 20 frames fill several batches.
#[test]
fn every_file_is_the_same_bytes_at_any_number_of_threads() {
    let bench = Bench::new();
    for jobs in [1, 2, 3] {
        let words = format!("run argon --frames 500..520 --jobs {jobs} --out {jobs} --save-frames fits");
        bench.boresight(&words).done();
    }
    check_same_files(&bench.tree("1"), &bench.tree("2"));
    check_same_files(&bench.tree("1"), &bench.tree("3"));
}

/// Checks that the same frames from a longer and a shorter run agree: pixels, telemetry and truth.
fn check_slice(scenario: &str, long: &str, slice: std::ops::Range<u64>) {
    let bench = Bench::new();
    bench.boresight(&format!("run {scenario} --frames {long} --out long --save-frames png")).done();
    let words =
        format!("run {scenario} --frames {}..{} --out short --save-frames png", slice.start, slice.end);
    bench.boresight(&words).done();

    let mut images = bench.tree("long/frames");
    let names: BTreeSet<PathBuf> = slice.clone().map(|frame| format!("{frame:06}.png").into()).collect();
    images.retain(|name, _| names.contains(name));
    check_same_files(&images, &bench.tree("short/frames"));

    let of_slice = |frame: u64| slice.contains(&frame);
    let mut telemetry = bench.csv("long/telemetry.csv");
    telemetry.retain(|row| of_slice(row["frame"].parse().unwrap()));
    assert_eq!(telemetry, bench.csv("short/telemetry.csv"));
    let mut frames = bench.frames("long");
    frames.retain(|truth| of_slice(truth.frame));
    assert_eq!(frames, bench.frames("short"));
    let mut objects = bench.objects("long");
    objects.retain(|object| of_slice(object.frame));
    assert_eq!(objects, bench.objects("short"));
}

#[test]
fn a_slice_run_alone_has_the_pixels_telemetry_and_truth_of_the_whole() {
    check_slice("argon", "90..120", 100..110);
}

#[test]
fn a_slice_across_two_days_is_that_of_the_whole() {
    check_slice("argon", "1625..1645", 1632..1637);
}

#[test]
fn a_slice_of_whole_images_is_that_of_the_whole() {
    check_slice("starting-point", "50..62", 55..58);
}

/// A camera with zero suppression reports it to pipelines, in a run as in a dataset: a pipeline that would
/// use values below it is rejected.
#[test]
fn zero_suppression_is_known_to_pipelines_and_those_that_read_below_it_are_refused() {
    let bench = Bench::new();
    let scenario = |thresholds: &str| {
        bench.scenario("suppressed.toml", "argon", |table| {
            table.remove("roi");
            table.insert("zero_suppression_dn".into(), 67.into());
            let thresholds =
                format!("mode = 'paper'\nthresholds = {{ {thresholds} }}").parse::<toml::Table>().unwrap();
            table.insert("far_range".into(), thresholds.into());
        });
    };
    // Pixels from 68 DN on are transmitted.
    scenario("mode = 'constant', low = 0.0165, high = 0.03");
    bench.boresight("run suppressed.toml --frames 300..303 --out run").done();
    assert!(bench.csv("run/measurements.csv").iter().any(|row| row["status"] == "detected"));
    bench.boresight("render suppressed.toml --frames 300..303 --out data --format png").done();
    bench.boresight("process data").done();
    bench.check_same("run/measurements.csv", "data/measurements.csv");
    bench.unseal("data");
    bench.edit("data/camera.toml", "low = 0.0165", "low = 0.016");
    bench.boresight("process data --out low.csv").refused(&["thresholds.low is 0.016, 65 DN"]);
    scenario("mode = 'automatic'");
    bench
        .boresight("run suppressed.toml --frames 300..303")
        .refused(&["thresholds.mode is automatic", "constant"]);
}

#[test]
fn the_seed_changes_every_frame_but_not_the_hot_pixels() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 0..3 --out own --save-frames png").done();
    bench.boresight("run argon --frames 0..3 --seed 20120423 --out same --save-frames png").done();
    bench.boresight("run argon --frames 0..3 --seed 1 --out other --save-frames png").done();
    check_same_files(&bench.tree("own"), &bench.tree("same"));
    let (own, other) = (bench.tree("own/frames"), bench.tree("other/frames"));
    assert_eq!(own.len(), 3);
    for (name, image) in &own {
        assert_ne!(image, &other[name], "{name:?}");
    }
    let telemetry = |run| read_telemetry(&bench.path(run).join("telemetry.csv")).unwrap();
    for (own, other) in telemetry("own").iter().zip(telemetry("other")) {
        assert_ne!(own.telemetry.body_from_icrs, other.telemetry.body_from_icrs, "frame {}", own.frame);
    }
    // The seed determines which pixels are currently in the high state: some are telegraph pixels.
    let hot_pixels = |run| -> Vec<(u64, u32)> {
        let objects = bench.objects(run).into_iter().filter(|object| object.kind == ObjectKind::HotPixel);
        objects.map(|object| (object.frame, object.id)).collect()
    };
    assert_eq!(hot_pixels("own"), hot_pixels("other"));
}

#[test]
fn without_out_each_run_gets_the_next_numbered_directory() {
    let bench = Bench::new();
    bench.scenario("tiny.toml", "starting-point", |scenario| {
        scenario["schedule"][0]["count"] = 2.into();
    });
    for number in ["001", "002"] {
        let answer = bench.boresight("run tiny.toml").done();
        assert!(answer.stdout.contains(&format!("results in runs/tiny-{number}")), "{}", answer.stdout);
        assert_eq!(bench.json(&format!("runs/tiny-{number}/score.json"))["frames"], 2);
    }
    check_same_files(&bench.tree("runs/tiny-001"), &bench.tree("runs/tiny-002"));
}

/// A complete run of argon takes a minute: it is ended immediately after its start.
#[test]
fn a_reproduction_of_argon_has_a_numbered_directory() {
    let bench = Bench::new();
    let mut child = Command::new(env!("CARGO_BIN_EXE_boresight"))
        .args(["reproduce", "argon"])
        .current_dir(bench.path("."))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let run = bench.path("runs/argon-001/run.toml");
    let start = Instant::now();
    let names_argon = || std::fs::read_to_string(&run).is_ok_and(|text| text.contains("name = \"argon\""));
    while !names_argon() && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(10));
    }
    let begun = names_argon();
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(begun, "{} was not written", run.display());
}

#[test]
fn the_schedule_of_argon_is_that_of_table_2() {
    boresight::register_worlds();
    let source = ScenarioSource::read("argon").unwrap();
    let simulator = simulator(&source, source.typed("argon").unwrap()).unwrap();
    let schedule = simulator.schedule();
    assert_eq!(schedule.frame_count(), 16_077);
    let mut counts: BTreeMap<String, u32> = BTreeMap::new();
    for number in 0..schedule.frame_count() {
        let (day, _) = schedule.frame(number).unwrap();
        *counts.entry(day.to_owned()).or_default() += 1;
    }
    let days = (1..).map(|day| format!("day {day}"));
    assert_eq!(counts, days.zip(ARGON_TABLE_2.images).take(5).collect());
}

#[test]
fn regions_of_interest_change_no_telemetry_no_truth_and_no_transmitted_pixel() {
    let bench = Bench::new();
    bench.scenario("whole.toml", "argon", |scenario| {
        scenario.remove("roi").unwrap();
    });
    bench.boresight("run argon --frames 700..706 --out roi --save-frames png").done();
    bench.boresight("run whole.toml --frames 700..706 --out whole --save-frames png").done();

    let telemetry = |run| read_telemetry(&bench.path(run).join("telemetry.csv")).unwrap();
    let (regions, whole) = (telemetry("roi"), telemetry("whole"));
    assert_eq!(regions.len(), 6);
    for (with, without) in regions.iter().zip(&whole) {
        assert_eq!((with.frame, with.telemetry), (without.frame, without.telemetry));
        assert!(without.windows.is_none());
        let image = |run: &str| {
            let path = bench.path(run).join(with.file.as_deref().unwrap());
            image::open(path).unwrap().into_luma16()
        };
        let (cut, full) = (image("roi"), image("whole"));
        let windows = with.windows.as_deref().unwrap();
        for (x, y, pixel) in cut.enumerate_pixels() {
            let kept = windows.iter().any(|window| window.contains(x as usize, y as usize));
            let expected = if kept { *full.get_pixel(x, y) } else { image::Luma([0]) };
            assert_eq!(*pixel, expected, "frame {}, pixel ({x}, {y})", with.frame);
        }
    }
    assert_eq!(bench.frames("roi"), bench.frames("whole"));
    let uncut = |run| -> Vec<ObjectTruth> {
        bench.objects(run).into_iter().map(|object| ObjectTruth { cut: 0.0, ..object }).collect()
    };
    assert_eq!(uncut("roi"), uncut("whole"));
    assert_eq!(bench.objects("whole"), uncut("whole"));
    assert!(bench.objects("roi").iter().any(|object| object.cut > 0.0));
}
