//! `boresight visibility`: the analytic detection model compared with simulated frames, the sky compared with
//! closed forms and published numbers, the search for a parameter compared with simulation on both sides of
//! the result, and the command's output.

use std::path::Path;

use boresight::far_range::FarRangeScenario;
use boresight::run::ScenarioSource;
use boresight::statistics::clopper_pearson;
use boresight::visibility::{
    Bench as TestBench, CameraConfig, CameraModel, Curves, Demand, Design, DetectionRule, MotionGuidance,
    MotionTable, Pointing, Requirements, Sky, SkyStatistic, SkyTable, StarTrial,
};
use serde_json::Value;
use sim::optics::{OpticsConfig, PsfConfig, RadiometryConfig};
use sim::{SimError, Simulator};

use crate::support::{Bench, check_same_files};

const MOTION: MotionTable =
    MotionTable { guidance: MotionGuidance::LocalOrbital, semi_major_axis_km: 7130.0 };
const STILL: MotionTable = MotionTable { guidance: MotionGuidance::Inertial, ..MOTION };

/// Returns a requirement file for ARGON's camera, with additional lines.
fn file(lines: &str) -> String {
    format!(
        r#"
title = "a test"
n_min = 10
probability = 0.9
detection = {{ kind = "dn", low_dn = 46, high_dn = 67 }}
exposure = {{ nominal_s = 0.1, min_s = 0.01, max_s = 0.25 }}
motion = {{ guidance = "local_orbital", semi_major_axis_km = 7130.0 }}
camera.scenario = "argon"
sky.sun_exclusion_deg = 40.0
{lines}
"#
    )
}

fn requirements(lines: &str) -> Requirements {
    Requirements::parse("test".to_owned(), Path::new(""), Path::new("test.toml"), &file(lines)).unwrap()
}

fn argon() -> FarRangeScenario {
    boresight::register_worlds();
    ScenarioSource::read("argon").unwrap().typed::<FarRangeScenario>("a test").unwrap().clone()
}

fn camera() -> CameraConfig {
    requirements("").camera
}

/// Boresights outside the exclusion angle of the Sun: nearer to the Sun the background is not uniform over
/// the field, as the detection model assumes.
fn pointings(count: usize, motion: &MotionTable) -> Vec<Pointing> {
    let sky = SkyTable { sun_exclusion_deg: 40.0, ..SkyTable::default() };
    let all = (0..count).map(|i| Pointing::from_lattice(i, count, motion, &sky).unwrap());
    all.filter(|pointing| pointing.excluded.is_none()).collect()
}

/// Compares the stars of simulated frames, in bins of their analytic probability, with the detection model:
/// the number of detections agrees within 4 standard deviations of a sum of independent events, plus the
/// fraction that the model neglects: two stars that form one cluster (`crowded`) and, where a star is
/// detected only by chance, the wings of a bright neighbour.
fn check_detection_model(trials: &[StarTrial], crowded: f64, what: &str) {
    for (low, high) in [(0.02, 0.15), (0.15, 0.4), (0.4, 0.6), (0.6, 0.85), (0.85, 0.98), (0.999, 1.1)] {
        let bin: Vec<_> = trials.iter().filter(|trial| (low..high).contains(&trial.chance)).collect();
        assert!(bin.len() > 60, "{what}: {} stars between {low} and {high}", bin.len());
        let expected: f64 = bin.iter().map(|trial| trial.chance).sum();
        let variance: f64 = bin.iter().map(|trial| trial.chance * (1.0 - trial.chance)).sum();
        let detected = bin.iter().filter(|trial| trial.is_detected).count() as f64;
        let left_out = crowded * bin.len() as f64;
        assert!(
            (detected - expected).abs() < 4.0 * variance.sqrt() + left_out,
            "{what}: {detected} of {} between {low} and {high}, {expected:.1} expected",
            bin.len()
        );
    }
}

fn trials(
    camera: &CameraConfig,
    rule: DetectionRule,
    motion: &MotionTable,
    exposure_s: f64,
) -> Vec<StarTrial> {
    let bench = TestBench { camera, rule: &rule, motion, seed: 11 };
    let frames = bench.stars(&pointings(120, motion), exposure_s).unwrap();
    frames.into_iter().flat_map(|frame| frame.stars).collect()
}

#[test]
fn the_detection_model_is_that_of_simulated_frames_at_thresholds_in_digital_numbers() {
    let rule = DetectionRule::Dn { low_dn: 46, high_dn: 67 };
    check_detection_model(&trials(&camera(), rule, &MOTION, 0.25), 0.02, "smeared, 0.25 s");
    check_detection_model(&trials(&camera(), rule, &STILL, 0.08), 0.02, "still, 0.08 s");
    // 1.0 s at 2.5 px/s: a trail of 2.5 px.
    let dark = CameraConfig { background: Default::default(), ..camera() };
    check_detection_model(&trials(&dark, rule, &MOTION, 1.0), 0.05, "a longer trail");
}

/// An integer threshold of 53 DN represents thresholds from 53.0 to 54.0, and the noise estimates of a frame
/// come within some hundredths of these limits: a camera whose threshold is not close to an integer agrees.
#[test]
fn the_detection_model_is_that_of_simulated_frames_at_thresholds_in_standard_deviations() {
    let mut camera = camera();
    (camera.sensor.gain_e_per_dn, camera.background) = (2.0, Default::default());
    let rule = DetectionRule::Sigmas { low: 3.0, high: 6.0 };
    let model = CameraModel::new(&camera).unwrap();
    // b = 40 + 40 · 0.25/2 = 45, σ = sqrt((10 + 225)/4 + 1/12) = 7.67: 45 + 46.03 = 91.03.
    assert_eq!(rule.thresholds(&model, 10.0).high_dn, 91.0);
    camera.sensor.bias_dn = 40.5;
    check_detection_model(&trials(&camera, rule, &STILL, 0.25), 0.02, "six standard deviations");
}

/// The analytic probability of a design lies in the interval of the rate of frames with enough stars.
#[test]
fn enough_stars_are_detected_as_often_as_the_model_predicts() {
    let requirements = requirements("");
    let design = Design::new(&requirements, &requirements.camera, 3000, 0.25).unwrap();
    for exposure_s in [0.07, 0.1] {
        let expected = design.stars_chance(exposure_s, 10, SkyStatistic::Sky).unwrap();
        let rule = DetectionRule::Dn { low_dn: 46, high_dn: 67 };
        let bench = TestBench { camera: &requirements.camera, rule: &rule, motion: &MOTION, seed: 3 };
        let frames = bench.stars(&pointings(220, &MOTION), exposure_s).unwrap();
        let (enough, of) =
            (frames.iter().filter(|frame| frame.detected >= 10).count() as u64, frames.len() as u64);
        // Two-sided interval of 99.9 %.
        let (low, high) = clopper_pearson(enough, of, 0.999);
        assert!((low..high).contains(&expected), "{exposure_s} s: {enough} of {of}, {expected}");
    }
}

/// A camera with monochromatic light, without vignetting or distortion, and with the principal point in the
/// middle: the number of stars to a magnitude follows by counting.
fn plain(side_px: usize, focal_length_mm: f64) -> CameraModel {
    let mut config = camera();
    config.radiometry = RadiometryConfig::ZeroPoint { zero_point_e_per_s: 1e6, colour_term: 0.0 };
    (config.optics, config.background) = (OpticsConfig::default(), Default::default());
    let camera = &mut config.camera;
    (camera.columns, camera.rows, camera.radial) = (side_px, side_px, [0.0; 3]);
    (camera.pixel_width_um, camera.pixel_height_um, camera.focal_length_mm) = (10.0, 10.0, focal_length_mm);
    (camera.principal_x_px, camera.principal_y_px) =
        ((side_px as f64 - 1.0) / 2.0, (side_px as f64 - 1.0) / 2.0);
    CameraModel::new(&config).unwrap()
}

fn mean_stars(camera: &CameraModel, magnitude: f64, count: usize) -> f64 {
    let least_e_per_s = 1e6 * libm::pow(10.0, -0.4 * magnitude);
    let sky = Sky::new(camera, &STILL, &SkyTable::default(), count, least_e_per_s).unwrap();
    sky.fields.iter().map(|field| field.stars.len() as f64).sum::<f64>() / count as f64
}

/// The mean over an equal-area sky is the total number of stars times the field's fraction of the sphere: a
/// rectangle whose half angles have the tangents a and b has the solid angle 4 asin(ab/sqrt((1 + a²)(1 +
/// b²))).
#[test]
fn the_stars_of_all_fields_add_up_to_the_catalogue() {
    let camera = plain(600, 20.0);
    let tangent = 600.0 * 0.010 / (2.0 * 20.0);
    let solid_angle = 4.0 * libm::asin(tangent * tangent / (1.0 + tangent * tangent));
    let share = solid_angle / (4.0 * std::f64::consts::PI);
    for magnitude in [5.0, 6.5] {
        let stars = sim::catalog::Catalog::hipparcos2();
        let all = stars.stars().iter().filter(|star| star.v_mag() <= magnitude).count() as f64;
        let mean = mean_stars(&camera, magnitude, 8000);
        // A star is in about 46 of 8000 fields; the error of a lattice is some hundredths of this,
        // independently for each star.
        assert!((mean / (all * share) - 1.0).abs() < 0.004, "V {magnitude}: {mean}, {}", all * share);
    }
}

/// Liebe (2002, IEEE Trans. Aerosp. Electron. Syst. 38, 587): the sky has 6.57 exp(1.08 M) stars brighter
/// than M. A fit to counts, accurate to about 20 %: 1450, 4280 and 12,600 stars to 5, 6 and 7.
#[test]
fn the_density_of_stars_is_that_of_the_literature() {
    let camera = plain(600, 20.0);
    let tangent = 600.0 * 0.010 / (2.0 * 20.0);
    let share = libm::asin(tangent * tangent / (1.0 + tangent * tangent)) / std::f64::consts::PI;
    for magnitude in [5.0, 6.0, 7.0] {
        let published = 6.57 * libm::exp(1.08 * magnitude) * share;
        let mean = mean_stars(&camera, magnitude, 1000);
        assert!(
            (mean / published - 1.0).abs() < 0.25,
            "V {magnitude}: {mean:.2} stars, {published:.2} published"
        );
    }
}

#[test]
fn a_flight_of_a_prepared_simulator_is_that_of_a_new_one() {
    let scenario = argon();
    let mut other = scenario.simulation().unwrap();
    other.seed = 99;
    other.trajectory.orbit_mut().unwrap().relative.a_dlambda_m = -9000.0;
    other.schedule.truncate(2);
    let made = |simulator: &Simulator| simulator.camera().unwrap().expose(2000).unwrap();
    let fresh = Simulator::new(&other, Path::new("")).unwrap();
    let mut flown = Simulator::new(&scenario.simulation().unwrap(), Path::new("")).unwrap();
    let before = made(&flown);
    other.schedule[0].count = 0;
    assert!(matches!(flown.fly(&other), Err(SimError::OutOfRange(_))));
    assert!(made(&flown) == before, "a flight that is refused changes nothing");
    other.schedule[0].count = scenario.schedule[0].count;
    flown.fly(&other).unwrap();
    assert!(made(&flown) == made(&fresh));
}

/// Returns the JSON output of the command for a file with these lines, and its exit status.
fn answer(lines: &str, options: &str) -> (Value, Option<i32>) {
    let bench = Bench::new();
    bench.write("r.toml", file(lines));
    let answer = bench.boresight(&format!("visibility r.toml --json {options}"));
    (answer.json(), answer.status)
}

#[test]
fn the_smallest_exposure_meets_the_requirement_and_a_step_below_does_not() {
    let (report, status) = answer(
        r#"
sky.pointings = 2000
confirm.frames = 150
[[requirements]]
id = "R-1"
text = "stars"
demand = { kind = "stars", probability = 0.8 }
find = { parameter = "exposure_s", from = 0.01, to = 0.25 }
"#,
        "",
    );
    let verdict = &report["requirements"][0];
    assert_eq!((status, verdict["status"].as_str()), (Some(0), Some("met_simulated")), "{verdict:#}");
    assert!(
        verdict["evidence"].as_str().unwrap().contains("at which 150 frames prove the required 80.0 %"),
        "{verdict:#}"
    );
    let found = &verdict["found"];
    assert!(found["aimed"].as_f64().unwrap() > 0.8);
    let number = |name: &str| found[name].as_f64().unwrap();
    assert!(
        number("failing_value") < number("threshold_value") && number("threshold_value") < number("value")
    );
    assert!(number("probability") > 0.8 && number("failing_probability") < 0.8, "{found:#}");
    assert!(found["simulated"]["low"].as_f64().unwrap() >= 0.8, "{found:#}");
    assert!(found["failing_simulated"]["high"].as_f64().unwrap() < 0.8, "{found:#}");
    assert_eq!(found["is_monotone"], true);
}

/// By the detection model only: a larger aperture or a wider field yields more stars.
#[test]
fn the_smallest_aperture_and_the_longest_focal_length_are_found() {
    let (report, status) = answer(
        r#"
sky.pointings = 400
confirm.frames = 0
[[requirements]]
id = "R-APERTURE"
text = "stars"
demand = { kind = "stars" }
find = { parameter = "aperture_diameter_mm", from = 5.0, to = 40.0 }
[[requirements]]
id = "R-FIELD"
text = "stars"
demand = { kind = "stars", exposure_s = 0.2 }
find = { parameter = "focal_length_mm", want = "largest", from = 10.0, to = 60.0 }
"#,
        "",
    );
    assert_eq!(status, Some(0), "{report:#}");
    for (verdict, [low, high]) in
        report["requirements"].as_array().unwrap().iter().zip([[9.0, 16.0], [20.0, 40.0]])
    {
        let found = &verdict["found"];
        let value = found["value"].as_f64().unwrap();
        assert!((low..high).contains(&value), "{found:#}");
        // The search uses fewer boresights than the final result.
        assert!((found["probability"].as_f64().unwrap() - 0.9).abs() < 0.02, "{found:#}");
    }
}

#[test]
fn an_impossible_requirement_names_the_binding_constraint() {
    let (report, status) = answer(
        r#"
sky.pointings = 500
confirm.frames = 0
target = { body = { kind = "lambert_sphere", radius_m = 0.4, albedo = 0.3 }, light = { kind = "phases", phases_deg = [30.0, 90.0] }, ranges_km = [1.0, 50.0] }
[[requirements]]
id = "FIELD"
text = "more stars than there are"
demand = { kind = "stars", n_min = 1000 }
find = { parameter = "exposure_s", from = 0.01, to = 0.25 }
[[requirements]]
id = "SMEAR"
text = "faint stars in seconds"
demand = { kind = "limiting_magnitude", magnitude = 7.62 }
find = { parameter = "exposure_s", from = 0.1, to = 0.9 }
[[requirements]]
id = "BACKGROUND"
text = "a faint star in a frame that is full of light"
demand = { kind = "limiting_magnitude", magnitude = 8.0 }
find = { parameter = "exposure_s", from = 5.0, to = 20.0 }
[[requirements]]
id = "SATURATION"
text = "both, at 2 km"
demand = { kind = "exposure_window", from_km = 2.0, to_km = 10.0 }
find = { parameter = "focal_length_mm", from = 15.0, to = 30.0 }
[[requirements]]
id = "SIGNAL"
text = "a faint star in a short exposure"
demand = { kind = "limiting_magnitude", magnitude = 9.0, exposure_s = 0.05 }
find = { parameter = "aperture_diameter_mm", from = 5.0, to = 15.0 }
"#,
        "",
    );
    assert_eq!(status, Some(1), "{report:#}");
    for (verdict, binds) in report["requirements"].as_array().unwrap().iter().zip([
        "field",
        "smear",
        "background",
        "saturation",
        "signal",
    ]) {
        assert_eq!(verdict["status"], "impossible", "{verdict:#}");
        assert!(verdict["binds"].as_str().unwrap().starts_with(binds), "{verdict:#}");
    }
}

/// The flux of a Lambert sphere decreases with the square of the range. The range from which it is detected
/// is therefore predictable: the greatest range decreases with the phase angle as the square root of
/// Lambert's law.
#[test]
fn the_greatest_range_of_a_sphere_follows_its_phase_law() {
    let (report, _) = answer(
        r#"
sky.pointings = 200
confirm.frames = 60
target = { body = { kind = "lambert_sphere", radius_m = 0.4, albedo = 0.3 }, light = { kind = "phases", phases_deg = [0.0, 90.0] }, ranges_km = [1.0, 50.0] }
[[requirements]]
id = "T"
text = "seen from afar"
demand = { kind = "target_detected", from_km = 10.0, to_km = 60.0, phase_max_deg = 90.0 }
"#,
        "",
    );
    let ranges: Vec<f64> =
        (0..2).map(|i| report["target_range"][i]["nominal_km"].as_f64().unwrap()).collect();
    // Φ(90°) = 1/π; the bisection ends within one part in 300.
    let ratio = ranges[1] / ranges[0] * std::f64::consts::PI.sqrt();
    assert!((ratio - 1.0).abs() < 0.01, "{ranges:?}");
    let verdict = &report["requirements"][0];
    assert_eq!(verdict["status"], "met_simulated", "{verdict:#}");
    assert!(
        (verdict["margin"].as_f64().unwrap() - (ranges[1] - 60.0)).abs() < 0.01 * ranges[1],
        "{verdict:#}"
    );
    assert_eq!(verdict["simulated"]["count"], 60, "{verdict:#}");
}

/// Simulated at a range where the target is often missed: the rate of the detection model lies in the
/// interval.
#[test]
fn the_target_is_detected_as_often_as_the_model_predicts() {
    let lines = r#"
target = { body = { kind = "lambert_sphere", radius_m = 0.4, albedo = 0.3 }, light = { kind = "phases", phases_deg = [60.0] }, ranges_km = [1.0, 50.0] }
"#;
    let requirements = requirements(lines);
    let design = Design::new(&requirements, &requirements.camera, 200, 0.1).unwrap();
    let groups = design.groups(None);
    let scale = |range_km| design.target_chance(&groups, range_km, 0.1).unwrap().0;
    let (mut near, mut far) = (10.0, 1000.0);
    for _ in 0..40 {
        let middle = 0.5 * (near + far);
        if scale(middle) > 0.6 { near = middle } else { far = middle }
    }
    let rule = DetectionRule::Dn { low_dn: 46, high_dn: 67 };
    let bench = TestBench { camera: &requirements.camera, rule: &rule, motion: &MOTION, seed: 3 };
    let body = requirements.target.as_ref().unwrap();
    let count = bench.target(body, None, &groups[0].aspects, near, 0.1, 200).unwrap();
    // The background of the target's frames differs from the median of the sky by a few electrons, 0.02 of
    // the probability.
    let (low, high) = clopper_pearson(count, 200, 0.999);
    assert!((low - 0.02..high + 0.02).contains(&0.6), "{count} of 200 at {near} km");
}

#[test]
fn the_built_in_example_shows_where_the_stars_are_lost_and_does_not_depend_on_threads() {
    let bench = Bench::new();
    let one = bench.boresight("visibility uasc-far-range --frames 10 --jobs 1 --json --out a");
    let two = bench.boresight("visibility uasc-far-range --frames 10 --jobs 2 --json --out b");
    // On days 4 and 5 no exposure both spares the target and leaves ten stars.
    assert_eq!((one.status, two.status), (Some(1), Some(1)), "{}", one.stderr);
    assert_eq!(one.json(), two.json());
    check_same_files(&bench.tree("a"), &bench.tree("b"));
    let report = bench.json("a/visibility.json");
    assert_eq!(report, one.json());
    // In the run of `argon`, half of the frames have ten stars at 7.2 km (docs/evidence/visibility.md).
    let lost_km = report["stars_lost"]["half_of_frames_km"].as_f64().unwrap();
    assert!((6.2..8.2).contains(&lost_km), "{lost_km}");
    let statuses: Vec<_> = report["requirements"].as_array().unwrap().iter().map(|r| &r["status"]).collect();
    // Ten frames cannot demonstrate 90 %: 0.9^10 = 0.35. All requirements but one are met only by the
    // detection model, for this reason or because nothing could be simulated.
    assert_eq!(statuses.iter().filter(|status| **status == "met_model").count(), statuses.len() - 1);
    assert_eq!(bench.csv("a/sky.csv").len(), 10_000);
    for name in ["detection", "limiting_magnitude", "exposure_window", "target_range"] {
        assert!(!bench.csv(&format!("a/{name}.csv")).is_empty(), "{name}");
    }
    assert!(bench.read("a/visibility.md").contains("| REQ-STAR-01 |"));
    bench.boresight("visibility uasc-far-range --frames 0 --out a").refused(&["not empty"]);
}

/// A requirement that the frames could never demonstrate is met by the detection model, and the report states
/// this; with the number of frames that it requests, the requirement is demonstrated.
#[test]
fn too_few_frames_show_nothing() {
    let lines = |frames: u64| {
        format!(
            "sky.pointings = 500\nconfirm.frames = {frames}\n[[requirements]]\nid = \"R\"\ntext = \"stars\"\n\
             demand = {{ kind = \"stars\", n_min = 1, probability = 0.97 }}\n"
        )
    };
    let (report, status) = answer(&lines(10), "");
    let verdict = &report["requirements"][0];
    assert_eq!((status, &verdict["status"]), (Some(0), &"met_model".into()), "{verdict:#}");
    let evidence = verdict["evidence"].as_str().unwrap();
    // 0.97^98 = 0.0505, 0.97^99 = 0.0490; the number is searched in steps of a tenth.
    assert!(evidence.contains("too few frames for a proof: about 1"), "{evidence}");
    let (report, status) = answer(&lines(110), "");
    let verdict = &report["requirements"][0];
    assert_eq!((status, &verdict["status"]), (Some(0), &"met_simulated".into()), "{verdict:#}");
}

#[test]
fn all_met_is_exit_status_0() {
    let lines = "sky.pointings = 200\nconfirm.frames = 0\n[[requirements]]\nid = \"R-1\"\ntext = \"stars\"\n\
                 demand = { kind = \"stars\", probability = 0.01 }\n";
    let (report, status) = answer(lines, "");
    assert_eq!(status, Some(0), "{report:#}");
    let bench = Bench::new();
    assert!(bench.boresight("visibility --schema").done().json()["properties"]["requirements"].is_object());
    assert!(bench.boresight("visibility --list").done().stdout.contains("uasc-far-range"));
}

/// A built-in camera alone has all that the model needs; beside a scenario it replaces geometry and detector
/// only.
#[test]
fn a_preset_is_a_whole_camera() {
    boresight::register_worlds();
    let read = |camera: &str| {
        let text = file("").replace("camera.scenario = \"argon\"", camera);
        Requirements::parse("test".to_owned(), Path::new(""), Path::new("test.toml"), &text).unwrap().camera
    };
    let alone = read("camera.preset = \"rosetta-navcam\"");
    assert_eq!((alone.camera.focal_length_mm, alone.sensor.read_noise_e), (152.5, 25.0));
    assert_eq!(alone.psf, PsfConfig::Gaussian { sigma_px: 0.45 });
    let both = read("camera.preset = \"rosetta-navcam\"\ncamera.scenario = \"argon\"");
    assert_eq!((&both.camera, &both.sensor), (&alone.camera, &alone.sensor));
    assert_eq!((&both.psf, &both.radiometry), (&camera().psf, &camera().radiometry));
    let own =
        read("camera.preset = \"rosetta-navcam\"\ncamera.psf = { kind = \"gaussian\", sigma_px = 1.5 }");
    assert_eq!(own.psf, PsfConfig::Gaussian { sigma_px: 1.5 });
}

#[test]
fn mistakes_are_reported_with_their_position() {
    let bench = Bench::new();
    let refused = |text: String, parts: &[&str]| {
        bench.write("r.toml", text);
        bench.boresight("visibility r.toml").refused(parts);
    };
    refused(file("n_stars = 3"), &["r.toml:", "n_stars"]);
    refused(file("").replace("n_min = 10", "n_min = 0"), &["r.toml:3:", "n_min", "1 to 1000"]);
    refused(file("").replace("\"argon\"", "\"argo\""), &["camera.scenario", "argon"]);
    refused(file("camera.preset = \"hubble\""), &["camera.preset", "uasc-far-range"]);
    refused(file("camera.focal_length_mm = -3.0"), &["camera.focal_length_mm", "0.01 to 1e6"]);
    refused(file("").replace("high_dn = 67", "high_dn = 5000"), &["detection.high_dn", "4095"]);
    refused(file("").replace("nominal_s = 0.1", "nominal_s = 3.0"), &["exposure.nominal_s"]);
    refused(file("sky.when = { kind = \"epoch\", utc = \"noon\" }"), &["sky.when"]);
    let demand = "[[requirements]]\nid = \"A\"\ntext = \"t\"\ndemand = ";
    let target = "{ kind = \"target_detected\", from_km = 1.0, to_km = 2.0 }";
    refused(file(&format!("{demand}{target}")), &["requirements[0].demand", "[target]"]);
    let stars = "{ kind = \"stars\" }\n";
    refused(file(&format!("{demand}{stars}{demand}{stars}")), &["requirements[1].id", "`A`"]);
    let find = "find = { parameter = \"exposure_s\", from = 2.0, to = 1.0 }";
    refused(file(&format!("{demand}{stars}{find}")), &["requirements[0].find.to"]);
    bench.boresight("visibility nowhere.toml").refused(&["nowhere.toml", "uasc-far-range"]);
    assert!(bench.boresight("visibility nowhere.toml --json").json()["error"].is_string());
}

/// The curve of a requirement file equals the curves of its parts: between two levels, the background is
/// interpolated.
#[test]
fn chances_between_levels_of_the_background_are_those_of_the_level() {
    let model = CameraModel::new(&camera()).unwrap();
    let rule = DetectionRule::Dn { low_dn: 46, high_dn: 67 };
    let wide = Curves::new(&model, &rule, &MOTION, 0.25, [10.0, 400.0]);
    for background in [10.0, 33.0, 150.0, 400.0] {
        let own = Curves::new(&model, &rule, &MOTION, 0.25, [background, background]);
        for ln_e_per_s in [7.5, 8.0, 8.3, 8.6] {
            let (a, b) = (wide.chance(ln_e_per_s, background), own.chance(ln_e_per_s, background));
            // A tenth of the variance between levels.
            assert!((a - b).abs() < 0.01, "{background}, {ln_e_per_s}: {a} {b}");
        }
    }
}

#[test]
fn a_requirement_uses_the_probability_of_the_file_unless_it_has_its_own() {
    let own = Demand::LimitingMagnitude { magnitude: 5.0, probability: Some(0.7), exposure_s: None };
    let none = Demand::LimitingMagnitude { magnitude: 5.0, probability: None, exposure_s: None };
    assert_eq!((own.probability(0.9), none.probability(0.9)), (0.7, 0.9));
}
