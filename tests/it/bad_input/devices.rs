//! Pipes and devices instead of files: they may have no end, or no process at the other end.

use std::fs;
use std::os::unix::fs::symlink;
use std::process::Command;

use super::dataset;
use crate::support::Bench;

/// Checks that a pipe without a writer, and then a device without end, are rejected by name, at once.
fn check(bench: &Bench, words: &str, name: &str) {
    let path = bench.path(name);
    let _ = fs::remove_file(&path);
    assert!(Command::new("mkfifo").arg(&path).status().unwrap().success());
    let is_refused = || bench.boresight(words).refused(&[name, "not a regular file"]);
    is_refused();
    fs::remove_file(&path).unwrap();
    symlink("/dev/zero", &path).unwrap();
    is_refused();
    fs::remove_file(&path).unwrap();
}

#[test]
fn tables_are_regular_files() {
    for name in ["stars.csv", "telemetry.csv", "camera.toml"] {
        check(&dataset(), "process set", &format!("set/{name}"));
    }
    let bench = dataset();
    bench.boresight("process set").done();
    for name in ["answers.csv", "clusters.parquet"] {
        let words = match name {
            "answers.csv" => "score set answers.csv",
            _ => "score set set/measurements.csv --clusters clusters.parquet",
        };
        check(&bench, words, name);
    }
    check(&bench, "score set set/measurements.csv", "set/truth/frames.parquet");
}

#[test]
fn videos_are_regular_files() {
    let bench = Bench::new();
    for name in ["live.avi", "live.y4m"] {
        check(&bench, &format!("process {name} --scenario docking"), name);
    }
}
