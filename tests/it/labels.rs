//! `boresight render --labels`: written files, refused requests, and readers of other projects.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::support::{Bench, check_same_files};

const ALL: &str = "coco,speed,bop,yolo";

/// Four fields at 10 m, where docking unit and station reach beyond the picture.
const FIELDS: &str = "20000..20004";

#[test]
fn labels_are_beside_the_truth_and_change_no_other_file() {
    let bench = Bench::new();
    let words = format!("render docking --frames {FIELDS} --out");
    bench.boresight(&format!("{words} plain")).done();
    let answer = bench.boresight(&format!("{words} labelled --labels {ALL}")).done();
    assert!(answer.stdout.contains("labels of 12 objects in truth/labels/"), "{}", answer.stdout);
    let (plain, mut labelled) = (bench.tree("plain"), bench.tree("labelled"));
    let sums = bench.read("labelled/SHA256SUMS");
    let count = labelled.len();
    labelled.retain(|path, _| !path.starts_with("truth/labels") && !path.ends_with("SHA256SUMS"));
    let without_sums = plain.into_iter().filter(|(path, _)| !path.ends_with("SHA256SUMS")).collect();
    check_same_files(&labelled, &without_sums);
    // 1 + 8 + 4 + 2 tables, and for four fields 3 × 2 masks and 2 texts.
    assert_eq!(count - labelled.len() - 1, 15 + 4 * (6 + 2));
    assert_eq!(sums.lines().filter(|line| line.contains("truth/labels/")).count(), 15);
    assert!(!bench.path("labelled/UNFINISHED.txt").exists());
}

#[test]
fn labels_do_not_depend_on_the_number_of_threads() {
    let bench = Bench::new();
    for jobs in [1, 3] {
        let words = format!("render docking --frames {FIELDS} --jobs {jobs} --labels {ALL} --out out-{jobs}");
        bench.boresight(&words).done();
    }
    check_same_files(&bench.tree("out-1"), &bench.tree("out-3"));
}

/// The pose of SPEED is that of the truth table: r = −Aᵀ d, and the quaternion turns target into camera.
#[test]
fn labels_state_the_pose_and_the_features_of_the_truth() {
    let bench = Bench::new();
    bench.boresight(&format!("render docking --frames {FIELDS} --labels coco,speed --out out")).done();
    let coco = bench.json("out/truth/labels/coco/annotations.json");
    let annotations = coco["annotations"].as_array().unwrap();
    for (index, truth) in bench.fields("out").iter().enumerate() {
        let view = if index % 2 == 0 { "even" } else { "odd" };
        let records = bench.json(&format!("out/truth/labels/speed/camera-0-{view}/labels.json"));
        let record = &records[index / 2];
        assert_eq!(record["filename"], format!("{:06}.png", truth.field));
        let position: [f64; 3] = numbers(&record["r_Vo2To_vbs_true"]);
        let length = position.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((length - truth.range_m).abs() < 1e-9, "{length} {}", truth.range_m);
        let keypoints: [f64; 54] = numbers(&annotations[3 * index]["keypoints"]);
        let cross = truth.cross_centre.unwrap();
        let row = (cross.y - (index % 2) as f64) / 2.0;
        assert!(
            (keypoints[3] - cross.x).abs() + (keypoints[4] - row).abs() < 1e-9,
            "{keypoints:?} {cross:?}"
        );
    }
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    let numbers: Vec<f64> = value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    numbers.try_into().unwrap()
}

/// A sphere of less than a pixel: its box is the pixel of its position, which the command states.
#[test]
fn a_target_smaller_than_a_pixel_has_the_box_of_its_pixel() {
    let bench = Bench::new();
    let answer =
        bench.boresight("render starting-point --frames 0..2 --labels coco,yolo --out out --json").done();
    assert_eq!(answer.json()["labels"], serde_json::json!({ "objects": 2, "points": 2 }));
    let coco = bench.json("out/truth/labels/coco/annotations.json");
    for (truth, annotation) in bench.frames("out").iter().zip(coco["annotations"].as_array().unwrap()) {
        let position = truth.target_position.unwrap();
        let [x, y, width, height] = numbers(&annotation["bbox"]);
        assert_eq!([width, height], [1.0, 1.0]);
        assert_eq!([x, y], [(position.x + 0.5).floor(), (position.y + 0.5).floor()]);
    }
    let refused = bench.boresight("render starting-point --frames 0..2 --labels bop --out no");
    refused.refused(&["--labels bop", "expected a target with an orientation"]);
    assert!(!bench.path("no").exists());
}

#[test]
fn a_beacon_is_named_in_a_warning() {
    let bench = Bench::new();
    bench.scenario("beacon.toml", "starting-point", |table| {
        table["target"] = toml::from_str("kind = \"beacon\"\nmagnitude_at_1_km = 0.0").unwrap();
    });
    let answer = bench.boresight("render beacon.toml --frames 0..1 --labels yolo --out out").done();
    assert!(answer.stderr.contains("the target is a beacon, a point without extent"), "{}", answer.stderr);
}

#[test]
fn requests_without_labels_are_refused_before_anything_is_written() {
    let bench = Bench::new();
    for (words, parts) in [
        ("docking --labels kitti", ["--labels", "`kitti` is no format of labels", "coco, speed, bop, yolo"]),
        ("docking --labels coco,coco", ["--labels", "`coco` is named twice", "separated by commas"]),
        ("docking --labels coco --format avi", ["--format is `avi`", "expected png", "--labels coco"]),
        ("argon --labels yolo --format fits", ["--format is `fits`", "expected png", "--labels yolo"]),
        ("middle-range --labels coco", ["--labels", "a world that labels its images", "middle_range"]),
        ("argon --labels speed", ["--labels speed", "distortion of camera `camera`", "square pixels"]),
    ] {
        bench.boresight(&format!("render {words} --frames 0..2 --out out")).refused(&parts);
        assert!(!bench.path("out").exists(), "{words}");
    }
    bench
        .boresight("render docking --labels coco --frames 0..2 --out -")
        .refused(&["--out -", "a directory"]);
}

/// A target of forty pixels, drawn whole by a camera with square pixels and a distortion of 30 px in the
/// corner.
fn write_near_target(bench: &Bench) {
    bench.scenario("near.toml", "argon", |table| {
        table.remove("roi");
        table["camera"]["pixel_height_um"] = 8.6.into();
        table["camera"]["radial"] = vec![2.6e-7, 0.0, 0.0].into();
        let target = &mut table["target"];
        target["boxes"][0]["size_m"] = vec![32.0, 30.0, 12.8].into();
        let plate = &mut target["plates"][0];
        plate["centre_m"] = vec![0.0, 0.0, 6.6].into();
        plate["width_m"] = 32.0.into();
        plate["height_m"] = 30.0.into();
    });
}

#[test]
#[ignore = "needs Python with tests/python/requirements.txt; BORESIGHT_PYTHON names it, python3 otherwise"]
fn readers_of_other_projects_agree_with_the_labels() {
    let bench = Bench::new();
    write_near_target(&bench);
    bench.scenario("bent.toml", "docking", |table| {
        for camera in table["cameras"].as_array_mut().unwrap() {
            let camera = camera["camera"].as_table_mut().unwrap();
            camera.insert("radial".to_owned(), vec![4e-8, 0.0, 0.0].into());
            camera.insert("tangential".to_owned(), vec![2e-7, -3e-7].into());
        }
    });
    // Docking: far away, at 10 m, and in front of the target with the second camera.
    for (number, words) in [
        "docking --frames 0..4",
        "docking --frames 20000..20004",
        "bent.toml --frames 20000..20004",
        "bent.toml --frames 25100..25104",
        "near.toml --frames 15990..16000",
    ]
    .iter()
    .enumerate()
    {
        let out = format!("out-{number}");
        bench.boresight(&format!("render {words} --labels {ALL} --out {out}")).done();
        check_by_python(&bench.path(&out));
    }
}

fn check_by_python(dataset: &Path) {
    let python = std::env::var("BORESIGHT_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/python/check_labels.py");
    let output = Command::new(python).arg(script).arg(dataset).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    println!("{}\n{text}{}", dataset.display(), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{text}");
    for check in ["COCO evaluation segm", "BOP poses", "SPEED poses", "YOLO keypoints", "truth table"] {
        assert!(text.contains(&format!("ok   {check}")), "{check} in {text}");
    }
}
