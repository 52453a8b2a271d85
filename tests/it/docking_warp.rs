//! A camera file that does not fit the video: the residuals show it, σ contains it, and the output says it.

use crate::support::{Bench, figure};

/// Fields 3.7 m from the target.
const FIELDS: &str = "21600..21624";

/// Renders fields, replaces a value in the camera file, and processes them. Returns the answer as JSON, the
/// text for the user, and the fields' NEES.
fn processed(old: &str, new: &str) -> (serde_json::Value, String, f64) {
    let bench = Bench::new();
    bench.boresight(&format!("render docking --frames {FIELDS} --format png --out set")).done();
    bench.unseal("set");
    let text = bench.read("set/setup.toml").replacen(old, new, 1);
    bench.write("set/setup.toml", text);
    let document = bench.boresight("process set --json").done().json();
    let score = bench.boresight("score set set/measurements.csv --json").done().json();
    let words = bench.boresight("process set --out again.csv").done().stdout;
    (document, words, figure(&score, "nees_mean"))
}

#[test]
fn a_camera_file_that_fits_is_not_mentioned() {
    let (document, words, nees) = processed("radial", "radial");
    assert_eq!(document.get("picture"), None, "{words}");
    assert!(nees < 2.0, "{nees}");
}

/// One per cent in the corner, 480 px from the middle: 0.01 / 480² px⁻².
#[test]
fn a_distortion_that_the_camera_file_lacks_is_found_in_its_size() {
    let (document, words, nees) = processed("radial = [0.0,", "radial = [-4.34e-8,");
    assert!(document["picture"]["warped"].as_u64() > Some(12), "{document}");
    let percent: f64 =
        words.split("radial distortion of ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((percent - 1.0).abs() < 0.3, "{words}");
    assert!(nees < 2.0, "{nees}");
}

/// Rows 1.2 % lower than those of the camera.
#[test]
fn pixels_of_another_height_are_found_in_their_size() {
    let (document, words, nees) = processed("pixel_height_um = 8.3", "pixel_height_um = 8.2");
    assert!(document["picture"]["warped"].as_u64() > Some(12), "{document}");
    assert!(words.contains("rows 1.") && words.contains("closer together"), "{words}");
    assert!(nees < 2.0, "{nees}");
}
