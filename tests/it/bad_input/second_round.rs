//! Inputs of a second round of attacks (24 November 2026), about sixty that no earlier test contained: each
//! is rejected with its location, or is valid.

use super::check_refused;
use crate::support::{Bench, STUDY};

/// Writes a built-in scenario with one changed line.
fn with_change(bench: &Bench, old: &str, new: &str) {
    let text = far_range::STARTING_POINT;
    assert!(text.contains(old), "`{old}`");
    bench.write("s.toml", text.replacen(old, new, 1));
}

const RENDER: &str = "render s.toml --frames 0..1 --out out";

#[test]
fn numbers_dates_and_names_of_scenarios() {
    let bench = Bench::new();
    for (old, new, parts) in [
        ("gain_e_per_dn = 10.0", "gain_e_per_dn = 1e400", &["sensor.gain_e_per_dn", "overflowed"][..]),
        ("seed = 1 ", "seed = -1 ", &["s.toml:", "seed", "-1"]),
        ("seed = 1 ", "seed = 1.5 ", &["seed", "1.5", "an integer"]),
        ("[sensor]", "[s\u{435}nsor]", &["s.toml:", "unquoted key"]),
        ("title = ", "world = \"\"\ntitle = ", &["world", "far_range"]),
        ("count = 400", "count = 0", &["schedule[0].count", "1 to 1e8"]),
        ("count = 400", "count = 1152921504606846976", &["schedule[0].count", "1 to 1e8"]),
        ("cadence_s = 15.0", "cadence_s = -15.0", &["schedule[0].cadence_s", "-15"]),
        ("cadence_s = 15.0", "cadence_s = nan", &["schedule[0].cadence_s", "NaN"]),
        // Printed as written, without three hundred zeros.
        ("cadence_s = 15.0", "cadence_s = 1e300", &["schedule[0].cadence_s: is 1e300, expected"]),
        ("pixel_width_um = 8.6", "pixel_width_um = 1e-300", &["camera.pixel_width_um: is 1e-300, expected"]),
        (
            "2012-04-25T00:10:00Z",
            "2012-02-30T00:10:00Z",
            &["schedule[0].start_utc", "an existing date and time"],
        ),
        (
            "2012-04-25T00:10:00Z",
            "2012-04-25T24:00:00Z",
            &["schedule[0].start_utc", "an existing date and time"],
        ),
        ("2012-04-25T00:10:00Z", "2012-04-25T00:10:00", &["schedule[0].start_utc", "a UTC time"]),
        ("2012-04-25T00:10:00Z", "2013-06-30T23:59:60Z", &["schedule[0].start_utc", "leap second"]),
        ("columns = 752", "columns = 1000000", &["camera.columns", "16384"]),
        ("columns = 752", "columns = 752.0", &["camera.columns", "an integer"]),
        ("focal_length_mm = 20.187", "focal_length_mm = -0.0", &["camera.focal_length_mm", "-0"]),
        ("principal_x_px = 395.0", "principal_x_px = 1e9", &["camera.principal_x_px"]),
        ("radial = [2.6e-8, 0.0, 0.0]", "radial = [nan, 0.0, 0.0]", &["camera.radial[0]", "NaN"]),
        ("eccentricity = 0.003", "eccentricity = 1.0", &["orbit.target.eccentricity", "0 to 0.9"]),
        // Reported at its key, with the expected range.
        (
            "eccentricity = 0.003",
            "eccentricity = 0.9",
            &["orbit.target.semi_major_axis_km", "7130", "at least 64781"],
        ),
        (
            "semi_major_axis_km = 7130.0",
            "semi_major_axis_km = 100.0",
            &["orbit.target.semi_major_axis_km: is 100,"],
        ),
        ("a_dlambda_m = -10000.0", "a_dlambda_m = -1e12", &["orbit.relative.a_dlambda_m"]),
        ("\"silicon_ccd\"", "[[700.0, 0.5], [600.0, 0.5]]", &["radiometry.quantum_efficiency", "increasing"]),
        (
            "\"silicon_ccd\"",
            "[[500.0, 1.5], [600.0, 0.5]]",
            &["radiometry.quantum_efficiency[0][1]", "0 to 1"],
        ),
        ("\"silicon_ccd\"", "[[500.0, 0.5]]", &["radiometry.quantum_efficiency", "a list of 2"]),
        ("step_factor = 1.189207115002721", "step_factor = 1.0", &["shutter.step_factor"]),
        ("min_s = 0.001", "min_s = 0.9", &["shutter.min_s", "shutter.max_s"]),
        ("bias_dn = 40.0", "bias_dn = 5000.0", &["sensor.bias_dn"]),
        ("count = 10\n", "count = 4000000\n", &["sensor.hot_pixels.count", "a tenth"]),
        ("name = \"first orbit\"", "name = \"\"", &["schedule[0].name", "empty"]),
        ("source = \"hipparcos2\"", "source = \".\"", &["not a regular file"]),
        ("source = \"hipparcos2\"", "source = \"\"", &["catalog.source", "is empty"]),
        ("source = \"hipparcos2\"", "source = \"s.toml\"", &["s.toml", "unknown format"]),
    ] {
        with_change(&bench, old, new);
        check_refused(&bench, RENDER, parts);
    }
    // Both are valid.
    for (old, new) in [("\n", "\r\n"), ("name = \"first orbit\"", "name = \"a\\u001b[2Jb,\\\"c\\nd\"")] {
        bench.write("s.toml", far_range::STARTING_POINT.replace(old, new));
        bench.boresight("scenario check s.toml").done();
    }
}

#[test]
fn texts_that_are_no_scenario() {
    let bench = Bench::new();
    let text = far_range::STARTING_POINT;
    let utf16: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    for (content, part) in [
        (Vec::new(), "missing field `title`"),
        (utf16, "s.toml:1:2"),
        (format!("{text}\0").into_bytes(), "s.toml:"),
        (format!("a = {}{}", "[".repeat(20_000), "]".repeat(20_000)).into_bytes(), "recursion"),
        (format!("a = {}1{}", "{a=".repeat(5000), "}".repeat(5000)).into_bytes(), "recursion"),
        (format!("#{}\n{text}", "x".repeat(20_000_000)).into_bytes(), "at most 16777216"),
        (text.replacen("seed = 1", "seed = 1\nseed = 2", 1).into_bytes(), "duplicate key"),
    ] {
        bench.write("s.toml", content);
        check_refused(&bench, RENDER, &[part]);
    }
}

#[test]
fn tables_beside_a_scenario() {
    let bench = Bench::new();
    with_change(&bench, "source = \"hipparcos2\"", "source = \"c.csv\"");
    let head = "id,ra_deg,dec_deg,hp_mag\n";
    for (content, part) in [
        (format!("{head}1,0,91,3\n"), "dec_deg is `91`"),
        (format!("{head}1,0,0,nan\n"), "hp_mag is `nan`"),
        (format!("{head}-1,0,0,3\n"), "id is `-1`"),
        (format!("{head}\"1,0,0,3\n"), "line 2"),
        (head.replace(',', ";"), "unknown column"),
        (format!("id,{head}1,1,0,0,3\n"), "occurs twice"),
    ] {
        bench.write("c.csv", content);
        check_refused(&bench, RENDER, &["c.csv", part]);
    }
    with_change(&bench, "kind = \"gaussian\"", "kind = \"sampled\"\npath = \"p.csv\"\noversampling = 4");
    bench.edit("s.toml", "\nsigma_px = 0.8", "");
    for (content, part) in [
        ("1,2,3\n1,2\n1,2,3\n", "line 2 has 2 cells"),
        ("1,2,3\n1,-2,3\n1,2,3\n", "line 2, cell 2"),
        ("0,0,0\n0,0,0\n0,0,0\n", "its sum is 0"),
        ("1e308,1e308,1e308\n1,1,1\n1,1,1\n", "cell 1 is `1e308`, expected a number of 0 to 1e100"),
        ("", "it has 0 rows, expected 3 to 2048"),
    ] {
        bench.write("p.csv", content);
        check_refused(&bench, RENDER, &["p.csv", part]);
    }
}

#[test]
fn words_of_the_command_line_and_of_studies() {
    let bench = Bench::new();
    // An empty name used to mean the current directory.
    for words in [
        &["run", "argon", "--frames", "0..1", "--out", ""][..],
        &["render", "argon", "--frames", "0..1", "--out", ""],
        &["study", "run", "study.toml", "--out", ""],
        &["gate", "baseline", "run", "--reason", "x", "--out", ""],
        &["report", "run", "--out", ""],
    ] {
        bench.boresight_words(words).refused(&["--out"]);
        assert!(!bench.path("truth").exists());
    }
    bench.boresight("run argon --frames 0..1 --out out --sandbox").refused(&["--pipeline"]);
    for (more, parts) in [
        (
            "[[sweep]]\npath = \"target.albedo\"\nvalues = [nan, 0.5]\n",
            &["sweep[0].values[0]", "not finite"][..],
        ),
        (
            "[[sweep]]\npath = \"target.albedo\"\nvalues = [0.5, -inf]\n",
            &["sweep[0].values[1]", "not finite"],
        ),
        (
            "[[vary]]\npath = \"target.albedo\"\ndistribution = { kind = \"choice\", values = [nan] }\n",
            &["vary[2].distribution.values[0]", "not finite"],
        ),
        (
            "[[sweep]]\npath = \"schedule[99].count\"\nvalues = [1]\n",
            &["sweep[0].path", "this list has 5 elements"],
        ),
    ] {
        bench.write("study.toml", format!("{STUDY}{more}"));
        check_refused(&bench, "study check study.toml", parts);
    }
}

#[test]
fn a_row_of_a_frame_that_the_truth_lacks_has_its_line() {
    let bench = super::dataset();
    bench.write("mine.csv", "frame,status,x_px,y_px\n20,no_target,,\n99,no_target,,\n");
    check_refused(
        &bench,
        "score set mine.csv",
        &["mine.csv, line 3", "`frame` is `99`", "truth/frames.parquet"],
    );
}
