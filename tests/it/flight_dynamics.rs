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
    for (start, file) in [("2012-04-23T08:48:00Z", "chaser.aem"), ("2012-04-23T08:30:00Z", "chaser.oem")] {
        bench.scenario("late.toml", "argon", |scenario| {
            from_files(scenario);
            scenario["schedule"][0].as_table_mut().unwrap().insert("start_utc".into(), start.into());
            if file == "chaser.oem" {
                scenario["attitude"].as_table_mut().unwrap().remove("guidance");
                let guidance: Table = "mode = \"target_pointing\"".parse().unwrap();
                scenario["attitude"].as_table_mut().unwrap().insert("guidance".into(), guidance.into());
            } else {
                scenario.remove("trajectory");
            }
        });
        bench.boresight("scenario check late.toml").refused(&[
            file,
            "`covered time` is `2012-04-23T08:4",
            "that contain",
            &start[..16],
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
