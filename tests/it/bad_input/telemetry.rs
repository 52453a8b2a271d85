//! Telemetry of a dataset.

use std::fs;

use super::{check_refused, dataset};

/// Checks that a dataset with changed telemetry cells is rejected. Lines count from 1, the header.
fn check(change: impl FnOnce(&mut Vec<Vec<String>>), parts: &[&str]) {
    let bench = dataset();
    let mut table: Vec<Vec<String>> = bench
        .read("set/telemetry.csv")
        .lines()
        .map(|line| line.split(',').map(str::to_owned).collect())
        .collect();
    change(&mut table);
    let lines: Vec<String> = table.iter().map(|row| row.join(",")).collect();
    bench.write("set/telemetry.csv", lines.join("\n") + "\n");
    check_refused(&bench, "process set", &[&["set/telemetry.csv"], parts].concat());
}

/// Checks the rejection of telemetry with one changed cell.
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
    check(|table| drop(table.remove(2)), &["frames/000021.png", "the telemetry of this image is missing"]);
}

#[test]
fn an_image_outside_the_dataset_is_refused() {
    check_cell(2, "file", "../set/frames/000020.png", &["outside the dataset"]);
    check_cell(2, "file", "/etc/passwd", &["outside the dataset"]);
}

#[test]
fn an_invalid_number_is_named_by_line_and_column() {
    check_cell(2, "q_sc_j2000_w", "NaN", &["`q_sc_j2000_w` is `NaN`", "finite number"]);
    check_cell(4, "exposure_s", "inf", &["`exposure_s` is `inf`", "finite number"]);
    check_cell(4, "exposure_s", "-0.1", &["`exposure_s` is `-0.1`", "1e-9 or greater"]);
    check_cell(4, "exposure_s", "1e-320", &["`exposure_s` is `1e-320`", "1e-9 or greater"]);
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
        &["`time_utc`", "later than the time of the previous row"],
    );
}

#[test]
fn a_column_that_is_missing_or_unknown_is_named() {
    check(|table| table.iter_mut().for_each(|row| drop(row.remove(3))), &["column `exposure_s` is missing"]);
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
    check_refused(&bench, "process nowhere", &["nowhere", "No such file"]);
}
