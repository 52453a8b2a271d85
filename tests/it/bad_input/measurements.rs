//! Measurements to be scored, and the truth to which they are compared.

use std::fs;

use super::{check_refused, dataset};

const HEADER: &str = "frame,status,x_px,y_px";

/// Checks the rejection of a run of three frames, 20 to 22, with the given rows as measurements.
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
        check(&rows.each_ref().map(String::as_str), &[&format!("`frame` is `{named}`"), "frames.parquet"]);
    }
}

#[test]
fn a_frame_answered_twice_or_out_of_order_is_refused() {
    check(&["20,no_target,,", "20,no_target,,"], &["line 3", "`frame` is `20`", "expected"]);
    check(&["21,no_target,,", "20,no_target,,"], &["line 3", "`frame` is `20`", "expected"]);
}

#[test]
fn an_invalid_cell_is_named() {
    check(&["20,detected,NaN,1"], &["line 2", "`x_px` is `NaN`", "finite number"]);
    check(&["20,detected,1,"], &["line 2", "`y_px` is ``", "finite number"]);
    check(&["20,,1,1"], &["line 2", "`status`"]);
    check(&["20,detcted,1,1"], &["line 2", "`status` is `detcted`", "`detected`"]);
    check(&["20,no_target,,", "21,ok,,"], &["line 3", "`status` is `ok`", "`no_target`"]);
    check(&["20,no_target,,", "21,\"detected\n\",3,4"], &["line 3", "`status` is `detected"]);
    check(&["20,detected,4000,4"], &["line 2", "`x_px` is `4000`", "752 × 580"]);
    check(&["20,no_target,1,1"], &["line 2", "`x_px` is `1`", "`no_target`"]);
    check(&["twenty,detected,1,1"], &["line 2", "`frame` is `twenty`"]);
    check(&["20,detected,1"], &["line 2", "number of cells"]);
}

#[test]
fn a_missing_table_or_column_is_named() {
    let bench = dataset();
    check_refused(&bench, "score set nowhere.csv", &["nowhere.csv", "No such file"]);
    bench.write("mine.csv", "frame,status,x_px\n");
    check_refused(&bench, "score set mine.csv", &["mine.csv", "column `y_px` is missing"]);
}

#[test]
fn a_run_of_a_later_version_is_refused() {
    let bench = dataset();
    bench.write("mine.csv", format!("{HEADER}\n20,no_target,,\n"));
    let version = env!("CARGO_PKG_VERSION");
    for other in ["99", "99.0.0", "one"] {
        bench.edit("set/run.toml", &format!("version = \"{version}\""), &format!("version = \"{other}\""));
        let parts = ["set/run.toml:2:11: version", other, "or earlier"];
        check_refused(&bench, "score set mine.csv", &parts);
        bench.edit("set/run.toml", &format!("version = \"{other}\""), &format!("version = \"{version}\""));
    }
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
