//! Scenario files that are missing, malformed or out of range.

use boresight::far_range::STARTING_POINT;
use boresight::scenario::BUILT_IN;

use super::check_refused;
use crate::support::Bench;

/// Checks that a scenario file with a replaced text is rejected at the line of the new text.
fn check_edited(old: &str, new: &str, parts: &[&str]) {
    let text = STARTING_POINT.split(old).next().unwrap();
    let place = format!("mine.toml:{}:", 1 + text.matches('\n').count());
    check_mistake(old, new, &[&[place.as_str()], parts].concat());
}

/// Checks that a scenario file with a replaced text is rejected by the commands that would use it, and by the
/// command that checks it.
fn check_mistake(old: &str, new: &str, parts: &[&str]) {
    let bench = Bench::new();
    bench.boresight("scenario new mine.toml").done();
    bench.edit("mine.toml", old, new);
    check_refused(&bench, "run mine.toml --frames 0..2 --out run", parts);
    check_refused(&bench, "render mine.toml --frames 0..2 --out set", parts);
    let check = bench.boresight("scenario check mine.toml");
    assert_eq!(check.status, Some(1), "{}", check.stderr);
    assert!(parts.iter().all(|part| check.stdout.contains(part)), "{parts:?} in\n{}", check.stdout);
    let check = bench.boresight("scenario check mine.toml --json");
    assert_eq!(check.status, Some(1), "{}", check.stderr);
    assert_eq!(check.json()["ok"], false);
}

#[test]
fn a_missing_file_is_named_and_the_built_in_scenarios_are_listed() {
    let bench = Bench::new();
    check_refused(&bench, "run nowhere.toml", &["`nowhere.toml`", "argon", "starting-point"]);
}

#[test]
fn a_name_that_is_unknown_gets_the_nearest() {
    let bench = Bench::new();
    for words in ["run argonn --out run", "render argonn --out set", "scenario check argonn"] {
        check_refused(&bench, words, &["`argonn`", "did you mean `argon`?"]);
    }
}

#[test]
fn a_directory_is_no_scenario() {
    check_refused(&Bench::new(), "run . --out run", &["`.` is neither a built-in scenario nor a TOML file"]);
}

#[test]
fn bytes_that_are_not_text_are_refused() {
    let bench = Bench::new();
    bench.write("mine.toml", [0xff, 0xfe, 0x00]);
    check_refused(&bench, "run mine.toml --out run", &["`mine.toml`", "UTF-8"]);
}

#[test]
fn text_that_is_not_toml_has_line_and_column() {
    check_edited("seed = 1 #", "seed = = 1 #", &[":8: "]);
    check_edited("[psf]", "[psf", &[":5: "]);
}

#[test]
fn an_unknown_key_gets_the_nearest_name() {
    check_edited(
        "gain_e_per_dn = 10.0",
        "gian_e_per_dn = 10.0",
        &["`gian_e_per_dn`", "did you mean `gain_e_per_dn`?"],
    );
    check_edited("[shutter]", "[shuter]", &["`shuter`", "did you mean `shutter`?"]);
}

#[test]
fn a_missing_key_is_named_with_its_table() {
    // The reported location is that of the table.
    check_mistake("sigma_px = 0.8\n", "", &["mine.toml:44:1: psf", "`sigma_px`"]);
}

#[test]
fn a_value_of_the_wrong_type_is_named() {
    check_edited("seed = 1 #", "seed = \"one\" #", &["seed", "string \"one\"", "an integer"]);
    check_edited("kind = \"gaussian\"", "kind = \"square\"", &["`square`", "`gaussian`"]);
}

#[test]
fn a_value_out_of_its_range_is_named_with_its_line_and_its_range() {
    for (old, new, parts) in [
        ("gain_e_per_dn = 10.0", "gain_e_per_dn = -1.0", ["sensor.gain_e_per_dn", "is -1, expected"]),
        ("bit_depth = 12", "bit_depth = 17", ["sensor.bit_depth", "is 17, expected"]),
        ("bias_dn = 40.0", "bias_dn = 5000.0", ["sensor.bias_dn", "is 5000, expected"]),
        ("magnitude_limit = 6.5", "magnitude_limit = 99", ["star_list.magnitude_limit", "is 99, expected"]),
        ("columns = 752", "columns = 0", ["camera.columns", "is 0, expected"]),
        ("sigma_px = 0.8", "sigma_px = nan", ["psf.sigma_px", "is NaN, expected"]),
        ("cadence_s = 15.0", "cadence_s = 0.0", ["schedule[0].cadence_s", "is 0, expected"]),
        ("eccentricity = 0.003", "eccentricity = 1.5", ["orbit.target.eccentricity", "is 1.5, expected"]),
        ("radius_m = 0.4", "radius_m = -0.4", ["target.radius_m", "is -0.4, expected"]),
        ("lag_s = 30.0", "lag_s = -30.0", ["shutter.lag_s", "is -30, expected"]),
        ("min_s = 0.001", "min_s = 0.0", ["shutter.min_s", "is 0, expected"]),
        ("latency_s = 0.0", "latency_s = inf", ["knowledge.latency_s", "is inf, expected"]),
    ] {
        check_edited(old, new, &parts);
    }
}

#[test]
fn an_array_of_fixed_length_has_exactly_its_values() {
    for (old, new, parts) in [
        (
            "radial = [2.6e-8, 0.0, 0.0]",
            "radial = [2.6e-8, 0.0, 0.1, 0.1, 0.0]",
            ["camera.radial", "OpenCV's order is k1, k2, p1, p2, k3"],
        ),
        (
            "tangential = [0.0, 0.0]",
            "tangential = [0.0, 0.0, 0.0]",
            ["camera.tangential", "3, expected an array of length 2"],
        ),
        (
            "noise_arcsec = [20.0, 20.0, 20.0]",
            "noise_arcsec = [20.0, 20.0, 20.0, 5.0]",
            ["knowledge.noise_arcsec", "4, expected an array of length 3"],
        ),
        (
            "nominal = { phi_deg = -90.0, theta_deg = 0.0, psi_deg = 0.0 }",
            "nominal = [-90.0, 0.0, 0.0]",
            ["mounting.nominal", "expected a table"],
        ),
    ] {
        check_edited(old, new, &parts);
    }
    // In a table whose `kind` determines its keys, the reported location is that of the table.
    check_mistake(
        "kind = \"gaussian\" # or one of these, instead of the two lines here:\nsigma_px = 0.8",
        "kind = \"airy\"\nlambda_n_px = [1.2, 1.2, 0.3]",
        &["psf", "invalid length 3"],
    );
}

#[test]
fn invalid_limits_and_unknown_attitudes_are_refused() {
    let with = |line: &str| format!("[score]\n{line}\n\n[target]\n");
    for (line, parts) in [
        ("within_deg = [0.0, 1.0]", ["score.within_deg[0]", "1e-6 to 180"]),
        ("within_deg = [nan, 1.0]", ["score.within_deg[0]", "1e-6 to 180"]),
        ("within_deg = [0.048, 0.024]", ["score.within_deg[1]", "more than 0.048"]),
        ("within_deg = [0.024, 0.048, 0.1]", ["score.within_deg", "2"]),
        ("attitude = \"own\"", ["score.attitude", "telemetry"]),
        ("within = 1", ["score.within", "within_deg"]),
    ] {
        check_mistake("[target]\n", &with(line), &parts);
    }
}

#[test]
fn an_invalid_time_is_refused() {
    check_edited(
        "start_utc = \"2012-04-25T00:10:00Z\"",
        "start_utc = \"yesterday\"",
        &["schedule[0].start_utc", "yesterday"],
    );
}

#[test]
fn a_mistake_in_a_later_group_or_manoeuvre_is_found_there() {
    let argon = BUILT_IN.iter().find(|scenario| scenario.name == "argon").unwrap().text;
    for (old, new, path) in [
        ("count = 5415", "count = 0", "schedule[3].count"),
        ("time_utc = \"2012-04-25T22:24:07Z\"", "time_utc = \"later\"", "orbit.manoeuvres[6].time_utc"),
    ] {
        let bench = Bench::new();
        bench.write("mine.toml", argon.replace(old, new));
        let line = 1 + argon.split(old).next().unwrap().matches('\n').count();
        check_refused(&bench, "run mine.toml --out run", &[&format!("mine.toml:{line}:"), path]);
    }
}

#[test]
fn a_new_scenario_does_not_overwrite_a_file() {
    let bench = Bench::new();
    bench.write("mine.toml", "precious");
    check_refused(&bench, "scenario new mine.toml", &["mine.toml", "exists"]);
    bench.write("file", "mine");
    check_refused(&bench, "scenario new file/mine.toml", &["file/mine.toml", "cannot be created"]);
    bench.boresight("scenario new folder/new.toml").done();
}
