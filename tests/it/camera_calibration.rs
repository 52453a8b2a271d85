//! `boresight camera import` and `export`: calibrations of OpenCV, ROS and Kalibr, and their use in both
//! worlds.

use std::path::Path;

use boresight::files::read_calibration;
use contract::{Camera, Direction};
use nalgebra::Vector3;
use pipeline::CameraModel;

use crate::support::Bench;

const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/golden/calibrations");

/// A calibration in the shape of OpenCV's calibration sample.
const OPENCV: &str = "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   \
                      cols: 3\n   dt: d\n   data: [ 657.5, 0., 319.5, 0., 657.5, 239.25, 0., 0., 1. ]\n\
                      distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n   data: [ -0.25, \
                      0.125, 0.001, -0.002, 0. ]\n";

/// Images of points by the cameras that OpenCV wrote, by the camera model of the pipelines and by OpenCV.
#[test]
fn calibrations_of_opencv_project_as_opencv_does() {
    let text = std::fs::read_to_string(format!("{GOLDEN}/projections.csv")).unwrap();
    // Square pixels: the rounding of the reference. Others: the displacement that the conversion states.
    for (file, camera, limit_px) in [
        ("square.yaml", "square", Some(1e-6)),
        ("square.json", "square", Some(1e-6)),
        ("other.yaml", "other", None),
    ] {
        let lens = read_calibration(&Path::new(GOLDEN).join(file), None).unwrap();
        let conversion = lens.to_camera(lens.size_px.unwrap(), 5.0).unwrap();
        assert_eq!(conversion.displacement_px == 0.0, limit_px.is_some(), "{file}");
        assert!(conversion.displacement_px < 0.1, "{file}: {} px", conversion.displacement_px);
        let model = CameraModel::new(&conversion.value).unwrap();
        let mut worst_px = 0.0_f64;
        let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
        let rows = rows.iter().filter(|row| row[0] == camera);
        for row in rows.clone() {
            let [x, y, column, line]: [f64; 4] = [1, 2, 3, 4].map(|index| row[index].parse().unwrap());
            let direction = Direction::from_vector(Vector3::new(x, y, 1.0)).unwrap();
            let seen = model.project(&direction).unwrap();
            let is_on_image = (-0.5..1279.5).contains(&column) && (-0.5..959.5).contains(&line);
            if is_on_image || limit_px.is_some() {
                worst_px = worst_px.max(libm::hypot(seen.x - column, seen.y - line));
            }
        }
        assert_eq!(rows.count(), 400);
        assert!(worst_px <= limit_px.unwrap_or(conversion.displacement_px), "{file}: {worst_px} px");
    }
}

#[test]
fn a_calibration_is_imported_used_and_exported() {
    let bench = Bench::new();
    bench.write("cal.yaml", OPENCV);
    let document = bench.boresight("camera import cal.yaml --pixel-um 4.8 -o mine.toml --json").done().json();
    assert_eq!(document["displacement_px"], 0.0, "{document}");
    let camera: Camera = serde_json::from_value(document["camera"].clone()).unwrap();
    assert!((camera.focal_length_mm - 3.156).abs() < 1e-12 && camera.pixel_height_um == 4.8, "{camera:?}");
    assert!((camera.radial[0] + 0.25 / 657.5 / 657.5).abs() < 1e-20, "{camera:?}");
    let table: toml::Table = bench.read("mine.toml").parse().unwrap();
    assert_eq!(table["camera"].clone().try_into::<Camera>().unwrap(), camera);
    bench.boresight("sky --ra 83.6 --dec -5.4 --camera mine.toml -o orion.png").done();
    for (format, file) in [("opencv", "a.yaml"), ("opencv", "a.json"), ("ros", "b.yaml"), ("kalibr", "c.yml")]
    {
        bench.boresight(&format!("camera export mine.toml --format {format} -o {file}")).done();
        let words = format!("camera import {file} --pixel-um 4.8 -o {file}.toml --json");
        let again: Camera =
            serde_json::from_value(bench.boresight(&words).done().json()["camera"].clone()).unwrap();
        assert!((again.radial[0] / camera.radial[0] - 1.0).abs() < 1e-14, "{file}: {again:?}");
        assert_eq!((again.columns, again.principal_x_px), (640, 319.5), "{file}");
    }
    let text = bench.boresight("camera import cal.yaml -o other.toml").done().stdout;
    assert!(text.contains("640 × 480 px") && text.contains("field about 51.90° × 40.11°"), "{text}");
    bench.boresight("camera import cal.yaml -o other.toml").refused(&["other.toml", "exists"]);
    bench.boresight("camera export tv-docking --format opencv -o tv.yaml").done();
    bench.boresight("camera export tv-docking --format opencv -o tv.yaml").refused(&["tv.yaml", "exists"]);
}

#[test]
fn pixels_that_are_not_square_are_converted_within_a_stated_displacement() {
    let bench = Bench::new();
    bench.write("near.yaml", OPENCV.replace("0., 657.5, 239", "0., 658., 239"));
    let answer = bench.boresight("camera import near.yaml -o near.toml").done();
    assert!(answer.stderr.contains("warning: fx is 657.500 and fy 658.000 px"), "{}", answer.stderr);
    assert!(bench.read("near.toml").contains("# Warning: fx is 657.500"));
    bench.write("far.yaml", OPENCV.replace("0., 657.5, 239", "0., 690., 239"));
    bench.boresight("camera import far.yaml -o far.toml").refused(&[
        "fx is 657.500",
        "at most 0.1 px",
        "--max-displacement-px",
    ]);
    bench.boresight("camera import far.yaml --max-displacement-px 5 -o far.toml").done();
    bench.boresight("camera export far.toml --format ros -o far.yml").refused(&["at most 0.1 px"]);
    bench.boresight("camera export far.toml --format ros --max-displacement-px 5 -o far.yml").done();
    // A distortion that folds the image before its corners.
    bench.write("folded.yaml", OPENCV.replace("-0.25, 0.125", "-1.2, 0."));
    let answer = bench.boresight("camera import folded.yaml -o folded.toml").done();
    assert!(
        answer.stderr.contains("pixels as (0, 0), ") && answer.stderr.contains("no direction"),
        "{}",
        answer.stderr
    );
}

#[test]
fn calibrations_that_cannot_be_read_are_refused_with_the_reason() {
    let bench = Bench::new();
    bench.write("cal.yaml", OPENCV);
    let refused = |name: &str, text: &str, words: &str, parts: &[&str]| {
        bench.write(name, text);
        bench.boresight(&format!("camera import {name} {words} -o never.toml")).refused(parts);
        assert!(!bench.path("never.toml").exists());
    };
    let without_size = OPENCV.replace("image_width: 640\nimage_height: 480\n", "");
    refused("size.yaml", &without_size, "", &["size.yaml", "--columns N --rows N"]);
    refused("size.yaml", &without_size, "--columns 640", &["--rows"]);
    bench.boresight("camera import size.yaml --columns 640 --rows 480 -o sized.toml").done();
    refused("cal.yaml", OPENCV, "--columns 320 --rows 240", &["320 and 240", "640 × 480"]);
    refused("cal.yaml", OPENCV, "--name cam0", &["no name"]);
    refused("cal.yaml", OPENCV, "--pixel-um 0", &["--pixel-um", "0.01 to 10000"]);
    let rational = OPENCV.replace("-0.002, 0. ]", "-0.002, 0., 0.1, 0., 0. ]").replace("rows: 5", "rows: 8");
    refused("rational.yaml", &rational, "", &["rational.yaml, line 10", "k4", "rational model"]);
    refused("wide.yaml", &OPENCV.replace("image_width: 640", "image_width: 99999"), "", &["line 3", "16384"]);
    refused(
        "cal.xml",
        "<?xml version=\"1.0\"?>\n<opencv_storage>\n</opencv_storage>\n",
        "",
        &["cal.xml", "it is XML"],
    );
    refused("notes.yaml", "a: 1\n", "", &["notes.yaml", "no camera", "camera_matrix"]);
    refused("broken.yaml", "a: [1\n", "", &["broken.yaml", "line"]);
    refused("focal.yaml", &OPENCV.replace("657.5", "1e-9"), "", &["camera.focal_length_mm"]);
    bench.boresight("camera import nowhere.yaml -o never.toml").refused(&["nowhere.yaml", "No such file"]);
    for (words, parts) in [
        ("nothing --format opencv -o x.yaml", ["nothing", "built-in"]),
        ("tv-docking --format opencv -o x.xml", ["x.xml", ".yaml or .yml, or .json"]),
        ("tv-docking --format kalibr -o x.json", ["x.json", ".yaml or .yml"]),
        ("tv-docking --format matlab -o x.yaml", ["matlab", "kalibr"]),
    ] {
        bench.boresight(&format!("camera export {words}")).refused(&parts);
    }
    bench.write("k3.yaml", OPENCV.replace("-0.002, 0. ]", "-0.002, 0.01 ]"));
    bench.boresight("camera import k3.yaml -o k3.toml").done();
    bench.boresight("camera export k3.toml --format kalibr -o x.yaml").refused(&["k3", "radtan"]);
}

/// Fields of the hold at 2 m, wide lens.
const NEAR: &str = "24000..24010";

/// A docking camera is the same table: with a calibration the measured poses are those of the scenario's
/// camera, and without its distortion they are wrong.
#[test]
fn a_calibration_serves_docking() {
    let bench = Bench::new();
    // 8.7565 mm and 8.3 µm, the second camera of the scenario; barrel distortion of a wide lens.
    let (focal_px, [k1, k2, p1, p2]) = (1055.0, [-0.12, 0.03, 4e-4, -3e-4]);
    bench.scenario("bent.toml", "docking", |scenario| {
        let camera = scenario["cameras"][1]["camera"].as_table_mut().unwrap();
        let f2 = focal_px * focal_px;
        camera.insert("radial".into(), vec![k1 / f2, k2 / f2 / f2, 0.0].into());
        camera.insert("tangential".into(), vec![p1 / focal_px, p2 / focal_px].into());
    });
    bench.boresight(&format!("render bent.toml --frames {NEAR} --out set")).done();
    bench.write(
        "charuco.yaml",
        format!(
            "%YAML:1.0\n---\nimage_width: 768\nimage_height: 576\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   \
             cols: 3\n   dt: d\n   data: [ {focal_px:?}, 0., 383.5, 0., {focal_px:?}, 287.5, 0., 0., 1. ]\n\
             distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n   data: [ {k1}, {k2}, \
             {p1}, {p2}, 0. ]\n"
        ),
    );
    bench.boresight("camera import charuco.yaml --pixel-um 8.3 -o lens.toml").done();
    let lens: toml::Table = bench.read("lens.toml").parse().unwrap();
    let poses = |folder: &str, change: &dyn Fn(&mut toml::Value)| -> Vec<[f64; 6]> {
        let mut setup: toml::Table = bench.read("set/setup.toml").parse().unwrap();
        change(&mut setup["cameras"][1]);
        bench.write(&format!("{folder}/setup.toml"), setup.to_string());
        let words = format!("process set --setup {folder}/setup.toml -o {folder}/measurements.csv");
        bench.boresight(&words).done();
        let names = ["d1_m", "d2_m", "d3_m", "phi1_deg", "phi2_deg", "phi3_deg"];
        let rows = bench.csv(&format!("{folder}/measurements.csv"));
        rows.iter().map(|row| names.map(|name| row[name].parse().unwrap_or(f64::NAN))).collect()
    };
    let stated = poses("stated", &|_| {});
    let calibrated = poses("calibrated", &|camera| *camera = lens["camera"].clone());
    let plain = poses("plain", &|camera| {
        let camera = camera.as_table_mut().unwrap();
        camera.remove("radial");
        camera.remove("tangential");
    });
    let truth = bench.fields("set");
    assert_eq!((stated.len(), truth.len()), (10, 10));
    let error_m = |poses: &[[f64; 6]]| {
        let errors = poses.iter().zip(&truth).map(|(pose, truth)| {
            let d = truth.pose.position_m;
            libm::sqrt((0..3).map(|axis| (pose[axis] - d[axis]) * (pose[axis] - d[axis])).sum())
        });
        errors.fold(0.0_f64, |worst, error| if error.is_nan() { f64::INFINITY } else { worst.max(error) })
    };
    for (a, b) in stated.iter().zip(&calibrated) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6), "{a:?} {b:?}");
    }
    assert!(error_m(&calibrated) < 0.01, "{} m", error_m(&calibrated));
    assert!(
        error_m(&plain) > 2.0 * error_m(&calibrated),
        "{} and {} m",
        error_m(&plain),
        error_m(&calibrated)
    );
}
