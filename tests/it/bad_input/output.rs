//! Places where nothing may be written.

use super::{check_refused, dataset};
use crate::support::Bench;

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
