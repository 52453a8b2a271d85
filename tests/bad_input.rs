//! Bad input: a message that names the place, exit status 2, nothing written and nothing overwritten.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

mod support;

use std::fs;

use boresight::scenario::{BUILT_IN, STARTING_POINT};
use support::Bench;

/// The command refuses these words with a message that has these parts; with `--json` the message is one JSON
/// document on stdout as well. No file appears, vanishes or changes.
fn check_refused(bench: &Bench, words: &str, parts: &[&str]) {
    check_refused_words(bench, &words.split_whitespace().collect::<Vec<_>>(), parts);
}

fn check_refused_words(bench: &Bench, words: &[&str], parts: &[&str]) {
    let before = bench.tree(".");
    let answer = bench.boresight_words(words).refused(parts);
    assert_eq!(answer.stdout, "");
    let document = bench.boresight_words(&[words, &["--json"]].concat()).refused(parts).json();
    let members = document.as_object().unwrap();
    assert_eq!(members.keys().collect::<Vec<_>>(), ["error"]);
    let message = members["error"].as_str().unwrap();
    for part in parts.iter().filter(|part| !part.starts_with("did you mean")) {
        assert!(message.contains(part), "`{part}` in {message}");
    }
    let after = bench.tree(".");
    let names = |tree: &std::collections::BTreeMap<_, _>| tree.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&before), names(&after));
    support::check_same_files(&before, &after);
}

mod scenarios {
    use super::*;

    /// A scenario file with a text replaced is refused, at the line of the new text.
    fn check_edited(old: &str, new: &str, parts: &[&str]) {
        let text = STARTING_POINT.split(old).next().unwrap();
        let place = format!("mine.toml:{}:", 1 + text.matches('\n').count());
        check_mistake(old, new, &[&[place.as_str()], parts].concat());
    }

    /// A scenario file with a text replaced is refused by the commands that would use it, and by the one that checks it.
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
    fn a_file_that_is_not_there_is_named_and_the_built_in_scenarios_are_told() {
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
        check_refused(
            &Bench::new(),
            "run . --out run",
            &["`.` is neither a built-in scenario nor a TOML file"],
        );
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
        // The place is that of the table.
        check_mistake("sigma_px = 0.8\n", "", &["mine.toml:43:1: psf", "`sigma_px`"]);
    }

    #[test]
    fn a_value_of_the_wrong_type_is_named() {
        check_edited("seed = 1 #", "seed = \"one\" #", &["seed", "string \"one\"", "a whole number"]);
        check_edited("kind = \"gaussian\"", "kind = \"square\"", &["`square`", "`gaussian`"]);
    }

    #[test]
    fn a_value_out_of_its_range_is_named_with_its_line_and_its_range() {
        for (old, new, parts) in [
            ("gain_e_per_dn = 10.0", "gain_e_per_dn = -1.0", ["sensor.gain_e_per_dn", "is -1, expected"]),
            ("bit_depth = 12", "bit_depth = 17", ["sensor.bit_depth", "is 17, expected"]),
            ("bias_dn = 40.0", "bias_dn = 5000.0", ["sensor.bias_dn", "is 5000, expected"]),
            (
                "magnitude_limit = 6.5",
                "magnitude_limit = 99",
                ["star_list.magnitude_limit", "is 99, expected"],
            ),
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
    fn a_time_that_is_none_is_refused() {
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
        check_refused(&bench, "scenario new nowhere/mine.toml", &["nowhere/mine.toml", "No such file"]);
    }
}

mod catalogues {
    use super::*;

    /// A scenario whose catalogue is the file `stars.EXTENSION` with this text.
    fn check(extension: &str, text: Option<&str>, parts: &[&str]) {
        let bench = Bench::new();
        let file = format!("stars.{extension}");
        bench.scenario("mine.toml", "starting-point", |scenario| {
            scenario["catalog"]["source"] = file.clone().into();
        });
        if let Some(text) = text {
            bench.write(&file, text);
        }
        let parts = [&[file.as_str()], parts].concat();
        check_refused(&bench, "run mine.toml --frames 0..2 --out run", &parts);
        check_refused(&bench, "scenario check mine.toml", &parts);
    }

    #[test]
    fn a_catalogue_that_is_not_there_is_named() {
        check("csv", None, &["No such file"]);
        check("dat", None, &["No such file"]);
    }

    #[test]
    fn a_catalogue_of_no_known_format_is_refused() {
        check("dat", Some("Sirius, Canopus, Arcturus\n"), &["the format is not known", "hip2.dat"]);
        check("dat", Some(""), &["the format is not known"]);
    }

    #[test]
    fn a_malformed_cell_is_named_by_line_and_column() {
        let good = "id,ra_deg,dec_deg,v_mag\n1,10.0,20.0,5.0\n";
        check(
            "csv",
            Some(&format!("{good}2,10.0,120.0,5.0\n")),
            &["line 3", "column 8", "`120.0`", "expected"],
        );
        check(
            "csv",
            Some(&format!("{good}2,east,20.0,5.0\n")),
            &["line 3", "column 3", "`east`", "expected"],
        );
        check("csv", Some(&format!("{good}1,10.0,20.0,5.0\n")), &["line 3", "id 1", "line 2"]);
        check("csv", Some("id,ra_deg,v_mag\n"), &["dec_deg", "missing"]);
    }
}

mod output {
    use super::*;

    #[test]
    fn a_directory_that_is_not_empty_is_left_as_it_is() {
        let bench = Bench::new();
        bench.write("out/precious", "mine");
        for command in ["run", "render"] {
            let words = format!("{command} argon --frames 0..2 --out out");
            check_refused(&bench, &words, &["out exists and is not empty", "--out"]);
        }
    }

    #[test]
    fn a_file_is_no_directory_and_has_none_below_it() {
        let bench = Bench::new();
        bench.write("file", "mine");
        check_refused(&bench, "run argon --frames 0..2 --out file", &["file exists and is not a directory"]);
        check_refused(&bench, "run argon --frames 0..2 --out file/run", &["file/run", "cannot create"]);
        check_refused(&bench, "render argon --frames 0..2 --out file/a/b", &["file/a/b", "cannot create"]);
    }

    #[test]
    fn a_place_for_numbered_runs_that_is_a_file_is_refused() {
        let bench = Bench::new();
        bench.write("runs", "mine");
        check_refused(&bench, "run argon --frames 0..2", &["runs", "cannot create"]);
    }

    #[test]
    fn measurements_are_not_overwritten() {
        let bench = dataset();
        bench.write("mine.csv", "mine");
        check_refused(&bench, "process set --out mine.csv", &["mine.csv", "exists", "--out"]);
        check_refused(&bench, "process set --out nowhere/mine.csv", &["nowhere/mine.csv", "cannot create"]);
        bench.write("new/clusters.parquet", "mine");
        check_refused(&bench, "process set --out new/mine.csv", &["new/clusters.parquet", "exists"]);
    }
}

mod usage {
    use super::*;

    #[test]
    fn frames_outside_the_scenario_are_refused() {
        let bench = Bench::new();
        for command in ["run", "render"] {
            let words = format!("{command} starting-point --frames 399..401 --out out");
            check_refused(&bench, &words, &["--frames is 399..401", "0..400"]);
        }
    }

    #[test]
    fn a_range_of_frames_that_is_empty_or_none_is_refused() {
        for range in ["5..5", "9..3", "5", "..5", "a..b", "-1..3"] {
            let words = format!("run argon --frames={range} --out out");
            check_refused(&Bench::new(), &words, &["--frames", &format!("`{range}`"), "A..B with A < B"]);
        }
    }

    #[test]
    fn a_pipeline_that_is_unknown_gets_the_nearest() {
        let bench = Bench::new();
        let words = "run argon --frames 0..2 --out run --pipeline far_rnage";
        check_refused(&bench, words, &["`far_rnage`", "`exec:COMMAND`", "did you mean `far_range`?"]);
        check_refused(&bench, &words.replace("far_rnage", "docking"), &["`docking`", "`far_range`"]);
    }

    #[test]
    fn a_command_that_is_none_is_refused_before_anything_is_written() {
        let bench = dataset();
        for (command, part) in [("exec:", "empty"), ("exec:python3 'a", "quotation")] {
            let run = ["run", "argon", "--frames", "0..2", "--out", "run", "--pipeline", command];
            check_refused_words(&bench, &run, &[part]);
            check_refused_words(&bench, &["process", "set", "--pipeline", command], &[part]);
        }
    }

    #[test]
    fn a_timeout_that_is_none_is_refused_before_anything_is_written() {
        for timeout in ["0", "-1", "nan", "inf"] {
            let words =
                format!("run argon --frames 0..2 --out run --pipeline exec:true --timeout-s={timeout}");
            check_refused(&Bench::new(), &words, &["timeout", "expected above 0"]);
        }
    }

    #[test]
    fn arguments_out_of_their_range_are_refused() {
        let bench = Bench::new();
        for (argument, parts) in [
            ("--jobs 0", ["--jobs", "'0'"]),
            ("--jobs many", ["--jobs", "'many'"]),
            ("--seed -1", ["-1", "unexpected"]),
            ("--seed 1.5", ["--seed", "'1.5'"]),
            ("--save-frames jpg", ["--save-frames", "fits, png or exr"]),
            ("--job 2", ["--job", "--jobs"]),
        ] {
            check_refused(&bench, &format!("run argon --frames 0..2 --out run {argument}"), &parts);
        }
        check_refused(&bench, "fly argon", &["fly"]);
        check_refused(&bench, "run", &["SCENARIO"]);
        check_refused(&bench, "render argon", &["--out"]);
    }
}

/// A rendered dataset of three frames in `set`, PNG.
fn dataset() -> Bench {
    dataset_of("png")
}

fn dataset_of(format: &str) -> Bench {
    let bench = Bench::new();
    bench.boresight(&format!("render argon --frames 20..23 --format {format} --out set")).done();
    bench
}

mod telemetry {
    use super::*;

    /// A dataset whose telemetry has been changed, cell by cell, is refused. Lines count from 1, the header.
    fn check(change: impl FnOnce(&mut Vec<Vec<String>>), parts: &[&str]) {
        let bench = dataset();
        let mut table: Vec<Vec<String>> = bench
            .read("set/telemetry.csv")
            .lines()
            .map(|line| line.split(',').map(str::to_owned).collect())
            .collect();
        change(&mut table);
        let lines: Vec<String> = table.iter().map(|row| row.join(",")).collect();
        bench.write("set/telemetry.csv", lines.join("\n"));
        check_refused(&bench, "process set", &[&["set/telemetry.csv"], parts].concat());
    }

    /// One cell changed.
    fn check_cell(line: usize, column: &str, value: &str, parts: &[&str]) {
        check(
            |table| {
                let column = table[0].iter().position(|name| name == column).unwrap();
                table[line - 1][column] = value.to_owned();
            },
            &[&[format!("line {line}").as_str()], parts].concat(),
        );
    }

    #[test]
    fn a_frame_whose_image_is_missing_is_named() {
        check_cell(3, "file", "frames/000099.png", &["`frames/000099.png`", "frame 21", "missing"]);
        check_cell(3, "file", "", &["frame 21", "not named"]);
        check_cell(3, "file", "frames", &["`frames`", "not a file"]);
    }

    #[test]
    fn a_frame_whose_row_is_missing_is_named_by_its_image() {
        check(|table| drop(table.remove(2)), &["frames/000021.png", "the frame's telemetry is missing"]);
    }

    #[test]
    fn an_image_outside_the_dataset_is_refused() {
        check_cell(2, "file", "../set/frames/000020.png", &["outside the dataset"]);
        check_cell(2, "file", "/etc/passwd", &["outside the dataset"]);
    }

    #[test]
    fn a_number_that_is_none_is_named_by_line_and_column() {
        check_cell(2, "q_sc_j2000_w", "NaN", &["`q_sc_j2000_w` is `NaN`", "finite number"]);
        check_cell(4, "exposure_s", "inf", &["`exposure_s` is `inf`", "finite number"]);
        check_cell(4, "exposure_s", "-0.1", &["`exposure_s` is `-0.1`", "0 or greater"]);
        check_cell(3, "v_orbital_j2000_y_km_s", "", &["`v_orbital_j2000_y_km_s` is ``", "finite number"]);
        check_cell(3, "time_utc", "2012-04-23", &["`time_utc` is `2012-04-23`", "expected"]);
        check_cell(3, "windows", "1 2 3", &["`windows` is `1 2 3`", "expected"]);
    }

    #[test]
    fn a_quaternion_that_is_not_a_unit_is_refused() {
        check_cell(3, "q_sc_j2000_w", "0.9999", &["`q_sc_j2000_w`", "a unit quaternion"]);
    }

    #[test]
    fn frames_given_twice_or_out_of_order_are_refused() {
        check_cell(4, "frame", "21", &["`frame` is `21`", "expected"]);
        check(|table| table.swap(2, 3), &["line 4", "`frame` is `21`", "expected"]);
        check_cell(
            4,
            "time_utc",
            "2012-04-22T00:00:00Z",
            &["`time_utc`", "later than the time of the row above"],
        );
    }

    #[test]
    fn a_column_that_is_missing_or_unknown_is_named() {
        check(
            |table| table.iter_mut().for_each(|row| drop(row.remove(3))),
            &["column `exposure_s` is missing"],
        );
        check(
            |table| table[0][3] = "exposure_ms".to_owned(),
            &["unknown column `exposure_ms`", "did you mean `exposure_s`"],
        );
        check(|table| drop(table[1].pop()), &["line 2", "number of cells"]);
    }

    #[test]
    fn a_table_without_rows_and_no_table_are_refused() {
        check(|table| table.truncate(1), &["number of rows", "at least 1"]);
        check(Vec::clear, &["column `frame` is missing"]);
        let bench = dataset();
        fs::remove_file(bench.path("set/telemetry.csv")).unwrap();
        check_refused(&bench, "process set", &["set/telemetry.csv", "No such file"]);
        check_refused(&bench, "process nowhere", &["nowhere/camera.toml", "No such file"]);
    }
}

mod cameras {
    use super::*;

    fn check(old: &str, new: &str, parts: &[&str]) {
        let bench = dataset();
        bench.edit("set/camera.toml", old, new);
        check_refused(&bench, "process set", &[&["set/camera.toml"], parts].concat());
    }

    #[test]
    fn a_mistake_in_the_camera_is_named() {
        check("columns = 752", "columns = ", &["camera.toml:12:11"]);
        check("focal_length_mm", "focal_length", &["`focal_length`", "did you mean `focal_length_mm`?"]);
        check(
            "focal_length_mm = 20.187",
            "focal_length_mm = 0.0",
            &["camera.focal_length_mm", "0", "greater"],
        );
        check("bit_depth = 12", "bit_depth = 20", &["`bit_depth` is `20`", "1 to 16"]);
        check("magnitude_limit = 7.0", "magnitude_limit = 70.0", &["`magnitude_limit` is `70`", "-2 to 15"]);
        check("star_epoch_utc = \"2012", "star_epoch_utc = \"20-12", &["`star_epoch_utc`", "20-12"]);
        check("low_sigmas = 3.0", "low_sigmas = -3.0", &["low_sigmas", "-3", "expected"]);
    }

    #[test]
    fn a_star_list_with_a_mistake_is_named() {
        let bench = dataset();
        bench.write("set/stars.csv", "id,ra_deg,dec_deg,magnitude\n1,10,20,5\n2,10,95,5\n");
        check_refused(&bench, "process set", &["set/stars.csv, line 3", "`dec_deg` is `95`", "expected"]);
    }
}

mod images {
    use super::*;

    /// The second image of a dataset replaced by these bytes.
    fn check(format: &str, bytes: impl FnOnce(Vec<u8>) -> Vec<u8>, parts: &[&str]) {
        let bench = dataset_of(format);
        let name = format!("set/frames/000021.{format}");
        let image = fs::read(bench.path(&name)).unwrap();
        bench.write(&name, bytes(image));
        check_refused(&bench, "process set", &[&[name.as_str()], parts].concat());
    }

    fn cut_to(length: usize) -> impl FnOnce(Vec<u8>) -> Vec<u8> {
        move |mut bytes| {
            bytes.truncate(length);
            bytes
        }
    }

    /// A header card replaced; the length of the file stays.
    fn with_card(keyword: &'static str, card: &'static str) -> impl FnOnce(Vec<u8>) -> Vec<u8> {
        move |mut bytes| {
            let at = bytes.chunks_exact(80).position(|old| old.starts_with(keyword.as_bytes())).unwrap() * 80;
            bytes[at..at + 80].copy_from_slice(format!("{card:80}").as_bytes());
            bytes
        }
    }

    #[test]
    fn a_fits_file_cut_short_is_refused() {
        check("fits", cut_to(0), &["ends within a header"]);
        check("fits", cut_to(1000), &["ends within a header"]);
        check("fits", cut_to(100_000), &["bytes of data", "the file ends there"]);
    }

    #[test]
    fn a_fits_header_that_lies_about_the_size_is_refused() {
        check(
            "fits",
            with_card("NAXIS1", "NAXIS1  =                75200"),
            &["bytes of data", "the file ends"],
        );
        check("fits", with_card("NAXIS1", "NAXIS1  =  9223372036854775807"), &["NAXISn", "fits 64 bits"]);
        check("fits", with_card("NAXIS1", "NAXIS1  =                   -1"), &["NAXIS1", "`-1`"]);
        check("fits", with_card("NAXIS2", "NAXIS2  =                  579"), &["752 × 579", "752 × 580"]);
        check("fits", with_card("BITPIX", "BITPIX  =                   12"), &["BITPIX", "`12`"]);
        check("fits", with_card("BITDEPTH", "BITDEPTH=                   14"), &["`14`", "12"]);
    }

    #[test]
    fn what_is_not_of_its_format_is_refused() {
        for format in ["fits", "png", "exr"] {
            check(format, |_| b"GIF89a".repeat(1000), &["not a readable"]);
        }
    }

    #[test]
    fn a_png_file_cut_short_is_refused() {
        check("png", cut_to(0), &["not a readable"]);
        check("png", |bytes| bytes[..bytes.len() / 2].to_vec(), &["not a readable"]);
    }

    #[test]
    fn an_exr_file_cut_short_is_refused() {
        check("exr", |bytes| bytes[..bytes.len() / 2].to_vec(), &["not a readable"]);
    }

    fn png(image: impl Into<image::DynamicImage>) -> Vec<u8> {
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.into().write_to(&mut bytes, image::ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn a_colour_image_is_refused() {
        check("png", |_| png(image::RgbImage::new(752, 580)), &["Rgb8", "grey"]);
    }

    #[test]
    fn an_image_of_another_size_is_refused() {
        check("png", |_| png(image::GrayImage::new(580, 752)), &["580 × 752", "752 × 580"]);
    }

    #[test]
    fn a_value_above_full_scale_names_its_pixel() {
        let bright = |_| {
            let mut image = image::ImageBuffer::<image::Luma<u16>, _>::new(752, 580);
            image.put_pixel(300, 200, image::Luma([4096]));
            png(image)
        };
        check("png", bright, &["pixel (300, 200)", "`4096`", "4095"]);
    }

    #[test]
    fn an_extension_that_is_no_image_format_is_refused() {
        let bench = dataset();
        fs::rename(bench.path("set/frames/000021.png"), bench.path("set/frames/000021.jpg")).unwrap();
        bench.edit("set/telemetry.csv", "000021.png", "000021.jpg");
        check_refused(&bench, "process set", &["000021.jpg", "`jpg`", "fits"]);
    }
}

mod measurements {
    use super::*;

    const HEADER: &str = "frame,status,x_px,y_px";

    /// A run of three frames, 20 to 22, whose measurements are these rows.
    fn check(rows: &[&str], parts: &[&str]) {
        let bench = dataset();
        bench.write("mine.csv", format!("{HEADER}\n{}\n", rows.join("\n")));
        check_refused(&bench, "score set mine.csv", &[&["mine.csv"], parts].concat());
    }

    #[test]
    fn a_frame_that_the_truth_does_not_have_is_refused() {
        for foreign in [["3", "20"], ["20", "23"], ["22", "99"]] {
            let rows = foreign.map(|frame| format!("{frame},no_target,,"));
            let named = foreign.into_iter().find(|frame| !["20", "21", "22"].contains(frame)).unwrap();
            check(
                &rows.each_ref().map(String::as_str),
                &[&format!("`frame` is `{named}`"), "frames.parquet"],
            );
        }
    }

    #[test]
    fn a_frame_answered_twice_or_out_of_order_is_refused() {
        check(&["20,no_target,,", "20,no_target,,"], &["line 3", "`frame` is `20`", "expected"]);
        check(&["21,no_target,,", "20,no_target,,"], &["line 3", "`frame` is `20`", "expected"]);
    }

    #[test]
    fn a_cell_that_is_none_is_named() {
        check(&["20,detected,NaN,1"], &["line 2", "`x_px` is `NaN`", "finite number"]);
        check(&["20,detected,1,"], &["line 2", "`y_px` is ``", "finite number"]);
        check(&["20,,1,1"], &["line 2", "`status`"]);
        check(&["20,detcted,1,1"], &["line 2", "`x_px` is `1`", "`detcted`"]);
        check(&["twenty,detected,1,1"], &["line 2", "`frame` is `twenty`"]);
        check(&["20,detected,1"], &["line 2", "number of cells"]);
    }

    #[test]
    fn a_table_that_is_not_there_or_lacks_a_column_is_named() {
        let bench = dataset();
        check_refused(&bench, "score set nowhere.csv", &["nowhere.csv", "No such file"]);
        bench.write("mine.csv", "frame,status,x_px\n");
        check_refused(&bench, "score set mine.csv", &["mine.csv", "column `y_px` is missing"]);
    }

    #[test]
    fn a_directory_without_truth_or_with_damaged_truth_is_refused() {
        let bench = dataset();
        bench.write("mine.csv", format!("{HEADER}\n20,no_target,,\n"));
        check_refused(&bench, "score nowhere mine.csv", &["nowhere/run.toml", "No such file"]);
        bench.edit("set/run.toml", "gain_e_per_dn = 10.0", "gain_e_per_dn = 11.0");
        check_refused(&bench, "score set mine.csv", &["set/run.toml:4:8: hash", "edited after the run"]);
        bench.edit("set/run.toml", "gain_e_per_dn = 11.0", "gain_e_per_dn = 10.0");
        bench.write("set/clusters.parquet", "no table");
        let words = "score set mine.csv --clusters set/clusters.parquet";
        check_refused(&bench, words, &["set/clusters.parquet", "not a readable"]);
        let table = fs::read(bench.path("set/truth/objects.parquet")).unwrap();
        bench.write("set/truth/objects.parquet", &table[..table.len() / 2]);
        check_refused(&bench, "score set mine.csv", &["set/truth/objects.parquet", "not a readable"]);
        fs::remove_file(bench.path("set/truth/frames.parquet")).unwrap();
        check_refused(&bench, "score set mine.csv", &["set/truth/"]);
    }
}
