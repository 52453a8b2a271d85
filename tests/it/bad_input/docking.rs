//! Docking: scenarios, targets, television sequences.

use boresight::docking::STARTING_POINT as DOCKING;
use sim::scene::docking::TargetFile;

use super::check_refused;
use crate::support::Bench;

/// Renders one frame of the hold at 2 m as AVI in `set`, with its setup.
fn video() -> Bench {
    let bench = Bench::new();
    bench.boresight("render docking --frames 24000..24004 --format avi --out set").done();
    bench.unseal("set");
    bench
}

/// Checks that the built-in scenario with a replaced text, in `mine.toml`, is rejected at the line of the new
/// text.
fn check_edited(old: &str, new: &str, parts: &[&str]) {
    let bench = Bench::new();
    bench.write("mine.toml", DOCKING);
    bench.edit("mine.toml", old, new);
    let place = format!("mine.toml:{}:", 1 + DOCKING.split(old).next().unwrap().matches('\n').count());
    check_refused(&bench, "run mine.toml --frames 0..2 --out run", &[&[place.as_str()], parts].concat());
    let check = bench.boresight("scenario check mine.toml");
    assert_eq!(check.status, Some(1), "{}", check.stderr);
}

#[test]
fn a_world_that_is_unknown_gets_the_nearest() {
    check_edited(
        "world = \"docking\"",
        "world = \"dokcing\"",
        &["world", "`dokcing`", "did you mean `docking`?"],
    );
    for command in ["scenario schema", "scenario new mine.toml"] {
        let words = format!("{command} --world dokcing");
        check_refused(&Bench::new(), &words, &["--world", "'dokcing'", "a similar value exists: 'docking'"]);
    }
}

#[test]
fn a_target_that_is_unknown_gets_the_nearest() {
    check_edited(
        "target = \"progress\"",
        "target = \"progres\"",
        &["target", "progres", "did you mean `progress`?"],
    );
    check_edited("target = \"progress\"", "target = \"x.toml\"", &["x.toml", "built-in targets: ", "apollo"]);
}

#[test]
fn a_value_out_of_its_range_is_named_with_its_line() {
    check_edited("blur_sigma_px = 0.7", "blur_sigma_px = -0.7", &["lens.blur_sigma_px", "is -0.7, expected"]);
    check_edited("start_d3_m = 500.0", "start_d3_m = -5.0", &["approach.start_d3_m", "is -5, expected"]);
    check_edited(
        "focal_length_mm = 24.2111",
        "focal_length_mm = 1e300",
        &["cameras[0].camera.focal_length_mm", "is 1", "expected 0.01 to 1e6"],
    );
    check_edited("until_range_m = 2.8", "until_range_m = nan", &["until_range_m", "NaN"]);
    check_edited("white_radiance = 0.9", "white_radianc = 0.9", &["`white_radianc`", "`white_radiance`"]);
}

#[test]
fn a_mistake_in_a_target_file_has_its_position_there() {
    let target = TargetFile::built_in_text("progress").unwrap();
    for (old, new, parts) in [
        ("height_m = 0.30", "height_m = -0.3", ["cross.height_m", "is -0.3, expected"]),
        ("height_m = 0.30", "heigth_m = 0.3", ["`heigth_m`", "`height_m`"]),
    ] {
        assert!(target.contains(old), "{old}");
        let bench = Bench::new();
        bench.write("mine.toml", DOCKING.replace("target = \"progress\"", "target = \"aft.toml\""));
        bench.write("aft.toml", target.replacen(old, new, 1));
        let line = 1 + target.split(old).next().unwrap().matches('\n').count();
        let place = format!("aft.toml:{line}:");
        let parts = [place.as_str(), parts[0], parts[1]];
        check_refused(&bench, "run mine.toml --frames 0..2 --out run", &parts);
    }
}

#[test]
fn options_of_the_other_world_are_refused() {
    let bench = Bench::new();
    for (words, parts) in [
        ("run docking --inject roi --out a", ["--inject roi", "docking"]),
        ("run docking --pipeline far_range --out a", ["`far_range`", "`docking`"]),
        ("run docking --save-frames fits --out a", ["--save-frames: `fits`", "png, avi, mjpeg or y4m"]),
        ("render docking --format exr --out a", ["--format: `exr`", "png, avi, mjpeg or y4m"]),
        ("render docking --expected --out a", ["--expected", "docking"]),
        ("render docking --format avi --out -", ["--out -", "y4m"]),
        ("render docking --format avi --out a", ["fields", "mjpeg"]),
        ("run argon --renderer mitsuba --out a", ["--renderer mitsuba", "docking"]),
        ("run argon --mitsuba-rays 16 --out a", ["--mitsuba-rays", "--renderer mitsuba"]),
        ("render docking --mitsuba m --out a", ["--mitsuba", "--renderer mitsuba"]),
        ("run docking --frames 30000..30001 --out a", ["30000..30001", "0..25169"]),
    ] {
        check_refused(&bench, words, &parts);
    }
}

/// Nothing is written, because the first field is drawn before.
#[test]
fn a_missing_mitsuba_is_reported() {
    let bench = Bench::new();
    let words = ["render docking", "--frames 0..1 --renderer mitsuba --mitsuba-cache"].join(" ");
    let cache = tempfile::tempdir().unwrap();
    let words = format!("{words} {} --mitsuba /nowhere/mitsuba --out set", cache.path().display());
    check_refused(&bench, &words, &["/nowhere/mitsuba", "cannot be started"]);
    let rays = words.replace("--mitsuba /nowhere/mitsuba", "--mitsuba-rays 5");
    check_refused(&bench, &rays, &["samples is 5", "square"]);
}

#[test]
fn a_missing_or_unknown_sequence_is_refused() {
    let bench = Bench::new();
    check_refused(&bench, "process nowhere.avi --scenario docking", &["nowhere.avi", "No such file"]);
    bench.write("a.avi", "x");
    check_refused(&bench, "process a.avi", &["a.avi", "--scenario SCENARIO", "--setup FILE"]);
    check_refused(&bench, "process a.avi --scenario argon", &["argon", "docking"]);
    check_refused(&bench, "process a.avi --scenario docking --camera 2", &["camera", "`2`", "0 to 1"]);
    check_refused(&bench, "process a.avi --scenario docking --setup b.toml", &["--setup", "--scenario"]);
    check_refused(&bench, "process a.avi --setup nowhere.toml", &["nowhere.toml"]);
    bench.write("a.mov", "x");
    check_refused(&bench, "process a.mov --scenario docking", &["a.mov", "avi or y4m", "--raw 768x576"]);
    bench.write("empty/readme.txt", "x");
    check_refused(&bench, "process empty --scenario docking", &["empty", "images *.png"]);
    check_refused(&bench, "process empty", &["empty", "camera.toml", "setup.toml"]);
}

#[test]
fn an_invalid_field_order_rate_or_size_is_refused() {
    let bench = video();
    for (option, parts) in [
        ("--field-order odd", ["--field-order", "top or bottom"]),
        ("--frame-rate-hz 0", ["frames per second", "0.001 to"]),
        ("--frame-rate-hz fast", ["--frame-rate-hz", "'fast'"]),
        ("--raw 768", ["--raw", "768x576"]),
        ("--raw 640x480", ["640 × 480", "768 × 576"]),
    ] {
        check_refused(&bench, &format!("process set/fields.avi {option}"), &parts);
    }
}

/// The table of a directory specifies everything: an option would be ignored silently.
#[test]
fn an_option_that_a_table_makes_idle_is_refused() {
    let bench = video();
    for option in
        ["--camera 1", "--field-order bottom", "--progressive", "--frame-rate-hz 30", "--raw 768x576"]
    {
        let name = option.split(' ').next().unwrap();
        check_refused(&bench, &format!("process set {option}"), &[name, "set/telemetry.csv"]);
    }
    let both = "process set/fields.avi --progressive --field-order top";
    check_refused(&bench, both, &["--progressive", "--field-order"]);
}

#[test]
fn images_of_another_size_and_an_empty_input_are_refused() {
    let bench = video();
    let image = image::GrayImage::new(640, 480);
    let mut png = std::io::Cursor::new(Vec::new());
    image.write_to(&mut png, image::ImageFormat::Png).unwrap();
    bench.write("pictures/a1.png", png.into_inner());
    let size = ["pictures/a1.png", "`image size` is `640 × 480`", "expected 768 × 576"];
    check_refused(&bench, "process pictures --setup set/setup.toml", &size);
    // Standard input is empty.
    check_refused(&bench, "process - --setup set/setup.toml", &["standard input", "Y4M", "it is empty"]);
    check_refused(&bench, "process -", &["standard input", "--scenario SCENARIO", "--setup FILE"]);
    check_refused(&bench, "process set/fields.avi --camera 7", &["`camera` is `7`", "expected 0 to 1"]);
}

/// The files beside the measurements have fixed names: another directory avoids the conflict, another file
/// name does not.
#[test]
fn a_second_set_of_answers_in_a_folder_is_refused() {
    let bench = video();
    bench.boresight("process set/fields.avi --camera 1 --out first.csv").done();
    let again = "process set/fields.avi --camera 1 --out first.csv";
    check_refused(&bench, again, &["first.csv exists", "another folder with --out"]);
    std::fs::remove_file(bench.path("first.csv")).unwrap();
    check_refused(&bench, again, &["first.motion.csv exists", "another folder with --out"]);
}

/// Each value is reported with its line in the file.
#[test]
fn a_setup_with_a_value_that_cannot_be_is_named_with_its_line() {
    let bench = video();
    let good = bench.read("set/setup.toml");
    for (key, value, path) in [
        ("focal_length_mm", "1e300", "cameras[0].focal_length_mm"),
        ("principal_x_px", "1e9", "cameras[0].principal_x_px"),
        ("thickness_m", "0.0", "target.cross.thickness_m"),
        ("forgetting_position", "1.5", "docking.paper_portions.forgetting_position"),
        ("field_gate", "-1.0", "docking.motion.field_gate"),
    ] {
        let line = good.lines().position(|line| line.starts_with(&format!("{key} = "))).unwrap();
        let mut lines: Vec<String> = good.lines().map(str::to_owned).collect();
        lines[line] = format!("{key} = {value}");
        bench.write("wrong.toml", lines.join("\n"));
        let place = format!("wrong.toml:{}:", line + 1);
        let parts = [place.as_str(), path, ", expected "];
        check_refused(&bench, "process set/fields.avi --setup wrong.toml --camera 1 --out m.csv", &parts);
    }
}

#[test]
fn an_invalid_truncated_or_differently_sized_avi_is_refused() {
    let bench = video();
    let whole = std::fs::read(bench.path("set/fields.avi")).unwrap();
    let scenario = "--scenario docking --camera 1 --out m.csv";
    bench.write("none.avi", b"RIFX");
    check_refused(&bench, &format!("process none.avi {scenario}"), &["none.avi", "AVI"]);
    bench.write("cut.avi", &whole[..whole.len() / 2]);
    check_refused(&bench, &format!("process cut.avi {scenario}"), &["cut.avi", "ends"]);
    // Also within a dataset.
    bench.write("set/fields.avi", &whole[..whole.len() / 2]);
    check_refused(&bench, "process set", &["set/fields.avi", "ends"]);
    // Width in the header of the stream's format.
    let mut narrow = whole.clone();
    let format = whole.windows(4).position(|bytes| bytes == b"strf").unwrap();
    narrow[format + 12..format + 16].copy_from_slice(&640_u32.to_le_bytes());
    bench.write("narrow.avi", &narrow);
    check_refused(&bench, &format!("process narrow.avi {scenario}"), &["narrow.avi", "640", "768"]);
}

#[test]
fn a_video_that_does_not_fit_its_table_is_refused() {
    let bench = video();
    let table = bench.read("set/telemetry.csv");
    let lines: Vec<&str> = table.lines().collect();
    bench.write("set/telemetry.csv", lines[..3].join("\n") + "\n");
    check_refused(&bench, "process set", &["telemetry.csv", "frame without a row"]);
    let more = lines[4].replacen("24003", "24004", 1).replace(lines[4].split(',').nth(2).unwrap(), "500");
    bench.write("set/telemetry.csv", table.clone() + &more + "\n");
    check_refused(&bench, "process set", &["telemetry.csv, line 6", "24004", "ends before this row"]);
}

#[test]
fn a_run_that_kept_no_images_cannot_be_processed() {
    let bench = Bench::new();
    bench.boresight("run docking --frames 24000..24002 --out run").done();
    check_refused(&bench, "process run --out m.csv", &["telemetry.csv", "`file`", "--save-frames"]);
}

#[test]
fn measurements_of_another_world_or_of_other_fields_are_refused() {
    let bench = video();
    bench.write("far.csv", "frame,status,x_px,y_px\n0,no_target,,\n");
    check_refused(&bench, "score set far.csv", &["far.csv", "`frame`"]);
    let header = "field,status,d1_m,d2_m,d3_m,phi1_deg,phi2_deg,phi3_deg";
    bench.write("other.csv", format!("{header}\n7,no_target,,,,,,\n"));
    check_refused(&bench, "score set other.csv", &["other.csv", "`7`", "truth/fields.parquet"]);
    bench.write("bad.csv", format!("{header}\n24000,measured,0,0,x,0,0,0\n"));
    check_refused(&bench, "score set bad.csv", &["bad.csv, line 2", "`d3_m`", "`x`", "finite number"]);
    check_refused(&bench, "score set bad.csv --clusters c.parquet", &["--clusters", "far range"]);
}
