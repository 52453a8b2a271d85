//! Files of flight dynamics: a run that flies the exported motion of another run is that run.

use crate::support::Bench;
use toml::{Table, Value};

/// ARGON with fifteen frames of day 1, across the manoeuvre of 08:44:50, and an attitude without jitter.
fn first_scenario(scenario: &mut Table) {
    let group: Table =
        "name = \"a\"\nstart_utc = \"2012-04-23T08:43:00Z\"\ncadence_s = 15.0\ncount = 15".parse().unwrap();
    scenario.insert("schedule".into(), Value::Array(vec![group.into()]));
    let attitude = scenario["attitude"].as_table_mut().unwrap();
    attitude.remove("control");
}

fn exported() -> Bench {
    let bench = Bench::new();
    bench.scenario("first.toml", "argon", first_scenario);
    bench.boresight("run first.toml --out first --no-report").done();
    for words in [
        "oem --object chaser --step-s 20 --out chaser.oem",
        "oem --object target --notation xml --out target.oem",
        "aem --out chaser.aem",
        "tdm --out sights.tdm",
    ] {
        bench.boresight(&format!("export first --format {words}")).done();
    }
    bench
}

fn from_files(scenario: &mut Table) {
    first_scenario(scenario);
    let trajectory: Table =
        "kind = \"oem\"\nchaser = \"chaser.oem\"\ntarget = \"target.oem\"".parse().unwrap();
    scenario.insert("trajectory".into(), trajectory.into());
    scenario.remove("orbit");
    let guidance: Table = "mode = \"aem\"\nfile = \"chaser.aem\"".parse().unwrap();
    scenario["attitude"].as_table_mut().unwrap().insert("guidance".into(), guidance.into());
}

#[test]
fn a_run_from_exported_files_has_the_truth_of_the_run_that_wrote_them() {
    let bench = exported();
    bench.scenario("second.toml", "argon", from_files);
    bench.boresight("run second.toml --out second --no-report").done();
    let (first, second) = (bench.frames("first"), bench.frames("second"));
    assert_eq!((first.len(), second.len()), (15, 15));
    for (a, b) in first.iter().zip(&second) {
        // Interpolation over 20 s and times of milliseconds: rounding is left.
        assert!((a.position_km - b.position_km).norm() < 1e-8, "{}", a.frame);
        assert!((a.velocity_km_s - b.velocity_km_s).norm() < 1e-11, "{}", a.frame);
        assert!((a.range_km - b.range_km).abs() < 1e-8);
        assert!(a.line_of_sight.separation(&b.line_of_sight).degrees() < 1e-9);
        // At the frames, which are the nodes of the message.
        assert!(a.body_from_icrs.angle_to(&b.body_from_icrs).degrees() < 1e-12);
    }
    // The files are recorded by their content.
    let run_file = bench.read("second/run.toml");
    for role in ["trajectory.chaser", "trajectory.target", "attitude.guidance.file"] {
        assert!(run_file.contains(&format!("\"{role}\" = \"")), "{role}\n{run_file}");
    }
    let hash = |run: &str| bench.read(run).lines().find(|line| line.starts_with("hash")).unwrap().to_owned();
    bench.edit("target.oem", "UNKNOWN", "2010-028F");
    bench.boresight("run second.toml --out third --no-report").done();
    assert_ne!(hash("second/run.toml"), hash("third/run.toml"));
}

#[test]
fn frames_outside_the_files_are_refused_with_file_and_span() {
    let bench = exported();
    for (start, file, begin) in [
        ("2012-04-23T08:48:00Z", "chaser.aem", "2012-04-23T08:47:59.875"),
        ("2012-04-23T08:30:00Z", "chaser.oem", "2012-04-23T08:29:59.875"),
    ] {
        bench.scenario("late.toml", "argon", |scenario| {
            let orbit = scenario["orbit"].clone();
            from_files(scenario);
            scenario["schedule"][0].as_table_mut().unwrap().insert("start_utc".into(), start.into());
            if file == "chaser.oem" {
                scenario["attitude"].as_table_mut().unwrap().remove("guidance");
                let guidance: Table = "mode = \"target_pointing\"".parse().unwrap();
                scenario["attitude"].as_table_mut().unwrap().insert("guidance".into(), guidance.into());
            } else {
                scenario.remove("trajectory");
                scenario.insert("orbit".into(), orbit);
            }
        });
        bench.boresight("scenario check late.toml").refused(&[
            file,
            "`covered time` is `2012-04-23T08:4",
            "that contain",
            begin,
        ]);
    }
}

#[test]
fn requests_without_a_message_are_refused() {
    let bench = exported();
    bench.boresight("export first --format oem --out chaser.oem").refused(&["chaser.oem", "exists"]);
    bench.boresight("export first --format oem --step-s 0 --out a.oem").refused(&["--step-s is 0"]);
    bench.boresight("export nowhere --format oem --out a.oem").refused(&["run.toml"]);
    bench.boresight("export first --format oem --out -").refused(&["expected a path"]);
}

/// The file has plan, execution and report of each manoeuvre, and the truth of the export jumps where it
/// states.
#[test]
fn a_numerical_run_states_its_manoeuvres_and_its_export_has_a_segment_for_each_part() {
    let bench = Bench::new();
    bench.scenario("numerical.toml", "argon-numerical", first_scenario);
    bench.boresight("run numerical.toml --out run --no-report").done();
    let table = bench.read("run/truth/manoeuvres.csv");
    let mut lines = table.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let cell = |row: usize, name: &str| rows[row][names.iter().position(|n| *n == name).unwrap()];
    let number = |row: usize, name: &str| cell(row, name).parse::<f64>().unwrap();
    assert_eq!(rows.len(), 10);
    assert_eq!(cell(0, "start_utc"), "2012-04-23T08:44:50.000000000Z");
    assert_eq!(cell(0, "end_utc"), "2012-04-23T08:45:00.000000000Z");
    assert_eq!(cell(0, "reported_utc"), "2012-04-23T08:55:00.000000000Z");
    assert_eq!((number(0, "duration_s"), number(0, "planned_dv_t_m_s")), (10.0, -0.01352));
    let size = |row: usize, kind: &str| {
        let part = |axis: &str| number(row, &format!("{kind}_dv_{axis}_m_s"));
        ["r", "t", "n"].map(|axis| part(axis) * part(axis)).iter().sum::<f64>().sqrt()
    };
    for row in 0..10 {
        let error = size(row, "executed") / size(row, "planned") - 1.0;
        assert!((error - number(row, "size_error")).abs() < 1e-12);
        // Five standard deviations of 1 % and 0.5°.
        assert!(error != 0.0 && error.abs() < 0.05, "{error}");
        assert!(
            (0.0..3.6).contains(&number(row, "direction_error_deg"))
                && number(row, "direction_error_deg") > 0.0
        );
    }
    bench.boresight("export run --format oem --out chaser.oem").done();
    let oem = bench.read("chaser.oem");
    let spans: Vec<&str> = oem.lines().filter(|line| line.starts_with("START_TIME")).collect();
    assert_eq!(spans.len(), 3, "{spans:?}");
    assert!(spans[1].contains("08:44:50") && spans[2].contains("08:45:00"), "{spans:?}");
    bench.boresight("export run --format oem --object target --out target.oem").done();
    assert_eq!(bench.read("target.oem").matches("START_TIME").count(), 1);
    // The exported files, flown, give the truth of the run; no polynomial crosses the burn.
    bench.boresight("export run --format aem --out chaser.aem").done();
    bench.scenario("second.toml", "argon-numerical", from_files);
    bench.boresight("run second.toml --out second --no-report").done();
    for (a, b) in bench.frames("run").iter().zip(&bench.frames("second")) {
        // The quintic polynomials of the truth are within 1e-5 m and 1e-6 m/s of smooth motion.
        assert!((a.position_km - b.position_km).norm() < 2e-8, "{}", a.frame);
        let speed_km_s = (a.velocity_km_s - b.velocity_km_s).norm();
        assert!(speed_km_s < 2e-9, "{}: {speed_km_s:e}", a.frame);
    }
    // Segments of the file are those of its export.
    bench.boresight("export second --format oem --out again.oem").done();
    assert_eq!(bench.read("again.oem").matches("START_TIME").count(), 3);
    // A file has no manoeuvres to report.
    assert!(!bench.path("second/truth/manoeuvres.csv").exists());
}

#[test]
fn an_orbit_beside_files_and_none_without_files_are_refused() {
    let bench = exported();
    bench.scenario("both.toml", "argon", |scenario| {
        let orbit = scenario["orbit"].clone();
        from_files(scenario);
        scenario.insert("orbit".into(), orbit);
    });
    bench.boresight("run both.toml --out a").refused(&["both.toml", "orbit", "no table [orbit]", "\"oem\""]);
    bench.scenario("none.toml", "argon", |scenario| {
        scenario.remove("orbit");
    });
    bench.boresight("run none.toml --out a").refused(&["none.toml", "orbit", "missing", "mean_elements"]);
}
