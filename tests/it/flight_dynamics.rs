//! Files of flight dynamics: a run that flies the exported motion of another run is that run.

use std::path::Path;

use boresight::flight_dynamics::{Aem, CAMERA_FRAME, Oem};
use contract::{CameraFrame, Icrs, Rotation};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use toml::{Table, Value};

use crate::support::Bench;

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
        bench.boresight("scenario check late.toml").found(&[
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

/// The bench of [`exported`] after a navigation in `nav`, and a function that reads a number of a row.
fn navigated() -> Bench {
    let bench = Bench::new();
    bench.scenario("first.toml", "argon", first_scenario);
    bench.boresight("run first.toml --out first --no-report").done();
    bench.boresight("navigate first --navigator sequential --every 30 --out nav").done();
    bench
}

fn vector(row: &std::collections::BTreeMap<String, String>, names: [&str; 3]) -> Vector3<f64> {
    names.map(|name| row[name].parse::<f64>().unwrap()).into()
}

/// Axes R, T, N of a state as rows.
fn rtn(position: &Vector3<f64>, velocity: &Vector3<f64>) -> Matrix3<f64> {
    let radial = position.normalize();
    let normal = position.cross(velocity).normalize();
    Matrix3::from_rows(&[radial.transpose(), normal.cross(&radial).transpose(), normal.transpose()])
}

#[test]
fn the_exported_estimate_of_the_target_is_the_chaser_minus_the_relative_orbit() {
    let bench = navigated();
    bench.boresight("export first --format oem --out chaser.oem").done();
    let rows = bench.csv("nav/navigation.csv");
    assert_eq!(rows.len(), 8);
    let chaser = Oem::read(&bench.path("chaser.oem")).unwrap().ephemeris();
    for notation in ["kvn", "xml"] {
        let words = format!("--estimates --navigation nav --notation {notation} --out target.{notation}");
        bench.boresight(&format!("export first --format oem {words}")).done();
        let oem = Oem::read(&bench.path(&format!("target.{notation}"))).unwrap();
        let [segment] = oem.segments.as_slice() else { panic!("{} segments", oem.segments.len()) };
        assert_eq!(segment.object_name, "TARGET");
        assert_eq!((segment.states.len(), segment.covariances.len()), (8, 8));
        for ((row, node), covariance) in rows.iter().zip(&segment.states).zip(&segment.covariances) {
            let chaser = chaser.state_at(node.time).unwrap();
            let axes = rtn(&node.position_km, &node.velocity_km_s);
            let relative_m = axes * (chaser.position_km - node.position_km) * 1e3;
            let expected = vector(row, ["true_r_m", "true_t_m", "true_n_m"])
                + vector(row, ["error_r_m", "error_t_m", "error_n_m"]);
            // The interpolated orbit of the chaser is exact to 1e-8 km.
            assert!((relative_m - expected).norm() < 2e-5, "{}", (relative_m - expected).norm());
            // Position block of the covariance, km²: its largest part is along T.
            let [xx, yx, yy, zx, zy, zz] = [0, 1, 2, 3, 4, 5].map(|index| covariance.lower_triangle[index]);
            let block = Matrix3::new(xx, yx, zx, yx, yy, zy, zx, zy, zz);
            let sigma_t_m = (axes * block * axes.transpose())[(1, 1)].sqrt() * 1e3;
            let expected = vector(row, ["sigma_r_m", "sigma_t_m", "sigma_n_m"]).y;
            assert!((sigma_t_m / expected - 1.0).abs() < 0.01, "{sigma_t_m} {expected}");
        }
    }
    // Estimates at other times lie on the same orbit: the polynomial between them is that of the motion.
    let sparse = Oem::read(&bench.path("target.kvn")).unwrap().ephemeris();
    let target = Oem::read(&bench.path("target.kvn")).unwrap();
    let nodes = &target.segments[0].states;
    let middle = nodes[3].time + (nodes[4].time - nodes[3].time) * 0.5;
    let (state, before) = (sparse.state_at(middle).unwrap(), sparse.state_at(nodes[3].time).unwrap());
    let straight = before.position_km + before.velocity_km_s * 15.0;
    // 15 s of gravity, 7.8 m/s², are 0.88 km.
    assert!(((state.position_km - straight).norm() - 0.88).abs() < 0.05);
}

#[test]
fn a_missing_estimate_ends_a_segment_and_a_lone_one_is_left_out() {
    let bench = navigated();
    let table = bench.read("nav/navigation.csv");
    let without = |places: &[usize]| {
        let lines = table.lines().enumerate().map(|(place, line)| {
            let mut cells: Vec<&str> = line.split(',').collect();
            if places.contains(&place) {
                cells[1] = "no_convergence";
                // Truth stays; the other cells are those of an estimate.
                let head: Vec<&str> = table.lines().next().unwrap().split(',').collect();
                for (cell, name) in cells.iter_mut().zip(head).skip(2) {
                    if !name.starts_with("true_") {
                        *cell = "";
                    }
                }
            }
            cells.join(",") + "\n"
        });
        lines.collect::<String>()
    };
    let export = "export first --format oem --estimates --navigation nav --json --out";
    bench.write("nav/navigation.csv", without(&[4]));
    assert_eq!(bench.boresight(&format!("{export} a.oem")).done().json()["left_out"], 0);
    let oem = Oem::read(&bench.path("a.oem")).unwrap();
    assert_eq!(oem.segments.iter().map(|segment| segment.states.len()).collect::<Vec<_>>(), [3, 4]);
    bench.write("nav/navigation.csv", without(&[3, 5]));
    let answer = bench.boresight(&format!("{export} b.oem")).done().json();
    assert_eq!((answer["states"].as_u64(), answer["left_out"].as_u64()), (Some(5), Some(1)));
    bench.write("nav/navigation.csv", without(&[1, 3, 4, 6, 7]));
    bench
        .boresight("export first --format oem --estimates --navigation nav --out c.oem")
        .refused(&["nav/navigation.csv", "no two successive estimates"]);
    assert!(!bench.path("c.oem").exists());

    // A table without correlations, as of earlier versions, has no covariances.
    let kept: Vec<bool> = table.lines().next().unwrap().split(',').map(|n| !n.starts_with("rho_")).collect();
    let old = table.lines().map(|line| {
        let cells = line.split(',').zip(&kept).filter(|(_, kept)| **kept).map(|(cell, _)| cell);
        cells.collect::<Vec<_>>().join(",") + "\n"
    });
    bench.write("nav/navigation.csv", old.collect::<String>());
    bench.boresight(&format!("{export} d.oem")).done();
    let oem = Oem::read(&bench.path("d.oem")).unwrap();
    assert_eq!((oem.segments[0].states.len(), oem.segments[0].covariances.len()), (8, 0));
}

#[test]
fn estimates_that_do_not_fit_are_refused() {
    let bench = navigated();
    let export = "export first --format oem --estimates --navigation";
    bench.boresight("export first --format oem --estimates --out a.oem").refused(&["first/navigation.json"]);
    bench
        .boresight(&format!("{export} nav --object chaser --out a.oem"))
        .refused(&["--object is chaser, expected target"]);
    for (words, part) in [
        ("--format tdm --estimates", "--estimates applies only to --format oem or aem"),
        ("--format aem --object target", "--object applies only to --format oem"),
        ("--format aem --step-s 10", "--step-s applies only to the truth of --format oem"),
        ("--format oem --frame camera", "--frame applies only to --format aem"),
        ("--format aem --estimates --navigation nav", "--navigation applies only to --format oem"),
        ("--format oem --navigation nav", "--estimates"),
    ] {
        bench.boresight(&format!("export first {words} --out a.oem")).refused(&[part]);
    }
    let table = bench.read("nav/navigation.csv");
    let line = table.lines().nth(3).unwrap();
    let rho = line.split(',').nth(20).unwrap();
    bench.write("nav/navigation.csv", table.replace(line, &line.replacen(&format!(",{rho},"), ",1.5,", 1)));
    bench
        .boresight(&format!("{export} nav --out a.oem"))
        .refused(&["nav/navigation.csv, line 4", "positive definite"]);
    let late = line.replace("2012-04-23T08:4", "2012-04-23T18:4");
    bench.write("nav/navigation.csv", table.replace(line, &late));
    bench.boresight(&format!("{export} nav --out a.oem")).refused(&[
        "nav/navigation.csv, line 4",
        "time_utc",
        "a sixth of a revolution",
    ]);
    bench.write("nav/navigation.csv", &table);
    let hash = bench.json("nav/navigation.json")["hash"].as_str().unwrap().to_owned();
    bench.edit("nav/navigation.json", &hash, "0123");
    bench.boresight(&format!("{export} nav --out a.oem")).refused(&[
        "navigation.json: `hash` is `0123`",
        &hash,
        "estimates of this run",
    ]);
    bench.write("nav/navigation.json", "{\n\"scenario\": 3}");
    bench
        .boresight(&format!("{export} nav --out a.oem"))
        .refused(&["navigation.json, line 2", "the figures of a navigator"]);
    assert!(!bench.path("a.oem").exists());
}

#[test]
fn the_exported_attitude_is_that_which_the_pipeline_states() {
    let bench = exported();
    let rows = bench.csv("first/measurements.csv");
    let stated = |row: &std::collections::BTreeMap<String, String>| -> Rotation<CameraFrame, Icrs> {
        let [w, x, y, z] = ["w", "x", "y", "z"].map(|c| row[&format!("q_cam_j2000_{c}")].parse().unwrap());
        Rotation::from_unit_quaternion(UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)))
    };
    let nodes = |file: &str| -> Vec<UnitQuaternion<f64>> {
        let aem = Aem::read(&bench.path(file)).unwrap();
        let all = aem.segments.iter().flat_map(|segment| segment.attitudes.clone());
        // A quaternion of CCSDS is the conjugate of ours.
        all.map(|node| {
            let [q1, q2, q3, qc] = node.q1_q2_q3_qc;
            UnitQuaternion::new_normalize(Quaternion::new(qc, -q1, -q2, -q3))
        })
        .collect()
    };
    for notation in ["kvn", "xml"] {
        let words = format!("--estimates --frame camera --notation {notation} --out camera.{notation}");
        bench.boresight(&format!("export first --format aem {words}")).done();
        let camera = nodes(&format!("camera.{notation}"));
        assert_eq!(camera.len(), 15);
        for (row, node) in rows.iter().zip(&camera) {
            assert!(stated(row).quaternion().angle_to(node) < 1e-12, "{}", row["frame"]);
        }
    }
    let aem = Aem::read(&bench.path("camera.kvn")).unwrap();
    assert_eq!((aem.segments.len(), aem.segments[0].body_frame.as_str()), (1, CAMERA_FRAME));

    // Truth of body and camera differ by the actual mounting, estimates by the nominal one; the estimated
    // camera is near the true one.
    for words in ["--estimates --out body.aem", "--frame camera --out true_camera.aem"] {
        bench.boresight(&format!("export first --format aem {words}")).done();
    }
    let (body, camera) = (nodes("body.aem"), nodes("camera.kvn"));
    let between = |a: &[UnitQuaternion<f64>], b: &[UnitQuaternion<f64>]| -> Vec<UnitQuaternion<f64>> {
        a.iter().zip(b).map(|(a, b)| a * b.inverse()).collect()
    };
    let mountings = between(&camera, &body);
    assert!(mountings.iter().all(|mounting| mounting.angle_to(&mountings[0]) < 1e-12));
    let (true_body, true_camera) = (nodes("chaser.aem"), nodes("true_camera.aem"));
    assert_eq!((true_body.len(), true_camera.len()), (17, 17));
    let actual = between(&true_camera, &true_body);
    // The rounding of quaternions in the truth's table.
    assert!(actual.iter().all(|mounting| mounting.angle_to(&actual[0]) < 1e-7));
    let apart = actual[0].angle_to(&mountings[0]).to_degrees() * 3600.0;
    assert!(apart > 1.0 && apart < 1800.0, "{apart}");
    for (camera, true_camera) in camera.iter().zip(&true_camera[1..16]) {
        assert!(camera.angle_to(true_camera).to_degrees() * 3600.0 < 400.0);
    }

    // An instrument's attitude is not the body's; and a frame without an attitude ends a segment.
    bench.scenario("instrument.toml", "argon", |scenario| {
        first_scenario(scenario);
        let guidance: Table = "mode = \"aem\"\nfile = \"camera.kvn\"".parse().unwrap();
        scenario["attitude"].as_table_mut().unwrap().insert("guidance".into(), guidance.into());
    });
    bench
        .boresight("scenario check instrument.toml")
        .found(&["camera.kvn, line", "`REF_FRAME_B` is `INSTRUMENT_1`, expected SC_BODY_1"]);
    let table = bench.read("first/measurements.csv");
    let row = table.lines().find(|line| line.starts_with("6,")).unwrap();
    let mut cells: Vec<&str> = row.split(',').collect();
    cells[7..12].fill("");
    let head: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    assert_eq!((head[7], head[11]), ("q_cam_j2000_w", "attitude"));
    bench.write("first/measurements.csv", table.replace(row, &cells.join(",")));
    bench.boresight("export first --format aem --estimates --out gap.aem").done();
    let spans = Aem::read(&bench.path("gap.aem")).unwrap();
    assert_eq!(spans.segments.iter().map(|s| s.attitudes.len()).collect::<Vec<_>>(), [6, 8]);
}

/// Both messages of a run of a part of the frames are of that part.
#[test]
fn messages_of_a_part_of_the_frames_cover_that_part() {
    let bench = Bench::new();
    bench.scenario("first.toml", "argon", first_scenario);
    bench.boresight("run first.toml --frames 3..8 --out part --no-report").done();
    bench.boresight("export part --format oem --step-s 10 --out a.oem").done();
    bench.boresight("export part --format aem --out a.aem").done();
    let stated = |file: &str, keyword: &str| {
        let text = bench.read(file);
        let lines: Vec<&str> = text.lines().filter(|line| line.starts_with(keyword)).collect();
        lines.iter().map(|line| line.rsplit_once('T').unwrap().1.to_owned()).collect::<Vec<_>>()
    };
    // Frames at 08:43:45 to 08:44:45, a step about them, and the next segment from the manoeuvre on.
    let starts = stated("a.oem", "START_TIME");
    assert!(starts[0].starts_with("08:43:35") && starts[1].starts_with("08:44:50"), "{starts:?}");
    assert!(stated("a.oem", "STOP_TIME")[1].starts_with("08:44:55"));
    assert!(stated("a.aem", "START_TIME")[0].starts_with("08:43:44"));
    assert!(stated("a.aem", "STOP_TIME")[0].starts_with("08:44:45"));
}

#[test]
fn one_file_for_both_spacecraft_is_refused_at_the_key_of_the_target() {
    let bench = exported();
    bench.scenario("same.toml", "argon", |scenario| {
        from_files(scenario);
        scenario["trajectory"].as_table_mut().unwrap().insert("target".into(), "chaser.oem".into());
    });
    let text = bench.read("same.toml");
    let line = 1 + text[..text.find("target = \"chaser.oem\"").unwrap()].matches('\n').count();
    bench.boresight("scenario check same.toml").found(&[
        &format!("same.toml:{line}:"),
        "trajectory.target",
        "0.000 m from the target's centre at frame 0",
        "expected a separation of 1 m or more",
    ]);
    // Two spans without a common instant.
    bench.boresight("export first --format oem --object target --step-s 10 --out later.oem").done();
    let later = bench.read("later.oem").replace("2012-04-23T", "2013-04-23T");
    bench.write("later.oem", later);
    bench.scenario("apart.toml", "argon", |scenario| {
        from_files(scenario);
        scenario["trajectory"].as_table_mut().unwrap().insert("target".into(), "later.oem".into());
    });
    bench.boresight("scenario check apart.toml").found(&["later.oem: `covered time` is `2013-04-23T"]);
}

#[test]
fn bad_files_of_a_trajectory_are_found_by_the_check_of_the_scenario() {
    let bench = exported();
    bench.scenario("second.toml", "argon", from_files);
    let good = bench.read("chaser.oem");
    let second = good.match_indices("START_TIME").nth(1).unwrap().0;
    let (head, tail) = good.split_at(second);
    let gap = format!("{head}{}", tail.replacen("08:44:50", "08:44:51", 2));
    for (content, parts) in [
        (gap.as_str(), ["chaser.oem, line ", "usable span of the segment", "there must be no gap"]),
        ("", ["chaser.oem, line 1", "`content` is `empty`", "CCSDS_OEM_VERS"]),
        (&good.replace("= GCRF", "= ITRF"), ["chaser.oem, line ", "`REF_FRAME` is `ITRF`", "expected ICRF"]),
    ] {
        bench.write("chaser.oem", content);
        bench.boresight("scenario check second.toml").found(&parts);
        bench.boresight("run second.toml --out second").refused(&parts);
    }
    std::fs::remove_file(bench.path("chaser.oem")).unwrap();
    bench.boresight("scenario check second.toml").found(&["chaser.oem", "cannot read"]);
    assert!(!Path::new(&bench.path("second")).exists());
}
