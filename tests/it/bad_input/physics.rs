//! Scenarios with individually valid numbers that are impossible as a whole: rejected by check, run and
//! render alike, with file, field, value and expectation. Scenarios that are possible but probably unintended
//! give a warning.

use toml::{Table, Value};

use super::check_refused;
use crate::support::{Answer, Bench};

/// Writes a built-in scenario with a change to `mine.toml`.
fn with_change(built_in: &str, change: impl FnOnce(&mut Table)) -> Bench {
    let bench = Bench::new();
    bench.scenario("mine.toml", built_in, change);
    bench
}

/// Sets a value of a scenario, given its path.
fn set(table: &mut Table, path: &str, value: impl Into<Value>) {
    let (parents, key) = path.rsplit_once('.').unwrap();
    let table = parents.split('.').fold(table, |table, key| match table.get_mut(key).unwrap() {
        Value::Array(items) => items[0].as_table_mut().unwrap(),
        value => value.as_table_mut().unwrap(),
    });
    table.insert(key.to_owned(), value.into());
}

/// Checks that the scenario is rejected with its file and these parts of the message.
fn check_impossible(built_in: &str, parts: &[&str], change: impl FnOnce(&mut Table)) {
    let bench = with_change(built_in, change);
    let parts: Vec<&str> = parts.iter().copied().chain(["mine.toml:"]).collect();
    check_refused(&bench, "run mine.toml --frames 0..2 --out run", &parts);
    check_refused(&bench, "render mine.toml --frames 0..2 --out set", &parts);
    let check = bench.boresight("scenario check mine.toml");
    assert_eq!(check.status, Some(1), "{}", check.stderr);
    let told = check.stdout.replace("\n  | ", " ");
    assert!(parts.iter().all(|part| told.contains(part)), "{parts:?} in\n{told}");
}

#[test]
fn a_camera_inside_of_the_target_is_refused() {
    let parts =
        ["orbit.relative", "from the target's centre at frame ", "expected a camera outside the target"];
    check_impossible("starting-point", &parts, |table| {
        set(table, "target.radius_m", 400.0);
        set(table, "orbit.relative.a_dlambda_m", -10.0);
    });
    for place in [[0.0, 0.0, 0.1], [0.05, 0.0, 0.2]] {
        let parts = ["approach", "m at field 0", "expected a camera in front of the target"];
        check_impossible("docking", &parts, |table| {
            let place = place.map(Value::Float).to_vec();
            let approach: [(&str, Value); 3] = [
                ("kind", "constant_velocity".into()),
                ("position_m", Value::Array(place)),
                ("duration_s", 1.0.into()),
            ];
            let approach: Table = approach.map(|(key, value)| (key.to_owned(), value)).into_iter().collect();
            table.insert("approach".to_owned(), approach.into());
        });
    }
}

#[test]
fn an_epoch_outside_of_the_ephemerides_is_refused() {
    for epoch in ["1975-04-25T00:00:00Z", "2077-04-25T00:00:00Z"] {
        let parts = [
            "orbit.epoch_utc",
            epoch,
            "expected a time covered by the ephemerides, from 1990-01-01 to 2050-01-05",
        ];
        check_impossible("starting-point", &parts, |table| set(table, "orbit.epoch_utc", epoch));
    }
}

#[test]
fn an_angle_of_more_than_ten_turns_is_refused() {
    for angle in [3600.1, -1e6] {
        let parts = ["mounting.actual.psi_deg", &angle.to_string(), "expected -3600 to 3600"];
        check_impossible("starting-point", &parts, |table| set(table, "mounting.actual.psi_deg", angle));
    }
}

#[test]
fn an_exposure_longer_than_the_cadence_is_refused() {
    let parts =
        ["shutter.max_s", "is 16", "expected at most the shortest time from one frame to the next, 15 s"];
    check_impossible("starting-point", &parts, |table| set(table, "shutter.max_s", 16.0));
}

/// Such a frame of 128 × 96 pixels used to take 9.5 GB.
#[test]
fn more_hits_than_a_frame_may_have_are_refused() {
    let parts = [
        "sensor.cosmic_rays.rate_per_cm2_s",
        "hits in a frame of 0.25 s",
        "expected at most 1e5 hits per frame",
    ];
    check_impossible("starting-point", &parts, |table| {
        set(table, "camera.columns", 128);
        set(table, "camera.rows", 96);
        let rays = "rate_per_cm2_s = 1e4\nthickness_um = 1000.0\nreadout_s = 1000.0\nsouth_atlantic = { peak_factor = 10.0 }";
        set(table, "sensor.cosmic_rays", rays.parse::<Table>().unwrap());
    });
}

fn check(bench: &Bench) -> (Answer, serde_json::Value) {
    let document = bench.boresight("scenario check mine.toml --json").done().json();
    (bench.boresight("scenario check mine.toml").done(), document)
}

#[test]
fn a_distortion_beyond_sip_is_reported_and_its_fits_files_have_no_coordinates() {
    for (k1, from_px, to_px) in [(-4e-7, 350.0, 491.0), (2e-6, 100.0, 491.0), (5e-6, 50.0, 491.0)] {
        let bench = with_change("starting-point", |table| {
            set(table, "camera.radial", vec![Value::Float(k1), Value::Float(0.0), Value::Float(0.0)]);
        });
        let (answer, document) = check(&bench);
        let warning = document["warnings"][0].as_str().unwrap();
        assert!(answer.stdout.contains(warning), "{}", answer.stdout);
        let radius = warning.split_once("beyond ").and_then(|(_, rest)| rest.split_once(" px"));
        let radius: f64 = radius.unwrap().0.parse().unwrap();
        assert!((from_px..to_px).contains(&radius), "{k1}: {warning}");
        let rendered = bench.boresight("render mine.toml --frames 100..101 --out set").done();
        assert!(rendered.stderr.contains(warning), "{}", rendered.stderr);
        let image = std::fs::read(bench.path("set/frames/000100.fits")).unwrap();
        let header = String::from_utf8_lossy(&image[..3 * 2880]).into_owned();
        for keyword in ["CTYPE1", "CRVAL1", "CRPIX1", "CD1_1", "A_ORDER"] {
            assert!(!header.contains(keyword), "{keyword}: {header}");
        }
    }
    // If a corner has no direction, or more than one, the camera is invalid.
    let parts = ["camera.radial", "one-to-one on the detector: this one folds back 4"];
    check_impossible("starting-point", &parts, |table| {
        set(table, "camera.radial", vec![Value::Float(-7e-7), Value::Float(0.0), Value::Float(0.0)]);
    });
}

#[test]
fn a_slip_of_a_thousand_is_reported() {
    for (built_in, path, slip, told) in [
        ("starting-point", "camera.focal_length_mm", 0.020_187, "camera.focal_length_mm is 0.020187"),
        (
            "docking",
            "cameras.camera.focal_length_mm",
            24_211.2,
            "cameras[0].camera.focal_length_mm is 24211.2",
        ),
    ] {
        let (answer, document) = check(&with_change(built_in, |table| set(table, path, slip)));
        let warning = document["warnings"][0].as_str().unwrap();
        assert!(warning.starts_with(told) && warning.ends_with("meant?"), "{warning}");
        assert!(answer.stdout.contains(&format!("warning: {warning}")), "{}", answer.stdout);
    }
    let (_, document) = check(&with_change("starting-point", |table| {
        set(table, "shutter.max_s", 250.0);
        set(table, "schedule.cadence_s", 300.0);
        set(table, "schedule.count", 10);
    }));
    assert_eq!(document["warnings"][0], "shutter.max_s is 250, usually 0.00001 to 100; was 0.25 meant?");
    let principal =
        |y: f64| check(&with_change("starting-point", |table| set(table, "camera.principal_y_px", y))).1;
    let told = principal(1500.0)["warnings"][0].as_str().unwrap().to_owned();
    assert!(
        told.starts_with("camera.principal_y_px is 1500, far outside a detector of 580 pixels"),
        "{told}"
    );
    // A detector may cover a part of the image circle.
    assert_eq!(principal(-300.0)["warnings"].as_array().map(Vec::len), Some(0));
}
