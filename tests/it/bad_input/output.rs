//! Paths that must not be written to.

use super::{check_refused, dataset};
use crate::support::{Bench, STUDY};

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
fn a_file_in_place_of_a_directory_is_refused() {
    let bench = Bench::new();
    bench.write("file", "mine");
    check_refused(&bench, "run argon --frames 0..2 --out file", &["file exists and is not a directory"]);
    check_refused(&bench, "run argon --frames 0..2 --out file/run", &["file/run", "cannot create"]);
    check_refused(&bench, "render argon --frames 0..2 --out file/a/b", &["file/a/b", "cannot create"]);
}

#[test]
fn a_path_for_numbered_runs_that_is_a_file_is_refused() {
    let bench = Bench::new();
    bench.write("runs", "mine");
    check_refused(&bench, "run argon --frames 0..2", &["runs", "cannot create"]);
}

#[test]
fn a_report_replaces_only_a_report() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 0..40 --out run --no-report").done();
    bench.boresight("gate baseline run --out base --reason x --block-length 2").done();
    bench.write("scenario.toml", "mine");
    bench.write("mine.html", "<!doctype html><title>mine</title>");
    for name in ["run/measurements.csv", "scenario.toml", "mine.html"] {
        let parts = [name, "a file of another kind", "earlier report"];
        check_refused(&bench, &format!("report run --out {name}"), &parts);
        check_refused(&bench, &format!("gate base run --report {name}"), &parts);
        check_refused(&bench, &format!("visibility uasc-far-range --report {name}"), &parts);
    }
    check_refused(&bench, "report run --out base", &["base", "not a regular file"]);
    bench.boresight("report run --out page.html").done();
    bench.boresight("report run --out page.html").done();
    #[cfg(unix)]
    {
        let set_mode = |mode| {
            let permissions = std::os::unix::fs::PermissionsExt::from_mode(mode);
            std::fs::set_permissions(bench.path("page.html"), permissions).unwrap();
        };
        set_mode(0o444);
        check_refused(&bench, "report run --out page.html", &["page.html", "is read-only"]);
        std::os::unix::fs::symlink(bench.path("page.html"), bench.path("link.html")).unwrap();
        check_refused(&bench, "report run --out link.html", &["link.html", "not a regular file"]);
        check_refused(&bench, "report run --out /dev/null", &["/dev/null", "not a regular file"]);
    }
}

#[test]
fn standard_output_is_refused_where_nothing_is_written_to_it() {
    let bench = dataset();
    for words in [
        "render argon --frames 0..2 --out -",
        "process set --out -",
        "run argon --frames 0..2 --out -",
        "report set --out -",
        "man --out -",
        "gate baseline set --reason x --out -",
        "gate set set --junit -",
        "gate set set --report -",
        "visibility uasc-far-range --out -",
    ] {
        bench.boresight(words).refused(&["standard output"]);
        assert!(!bench.path("-").exists(), "{words}");
    }
}

#[test]
fn a_manual_replaces_only_its_pages() {
    let bench = Bench::new();
    for _ in 0..2 {
        bench.boresight("man --out man").done();
    }
    bench.write("man/boresight-run.1", "mine");
    bench.boresight("man --out man").refused(&["man/boresight-run.1", "a file of another kind"]);
    assert_eq!(bench.read("man/boresight-run.1"), "mine");
}

/// A run's checksums are the last evidence of its files.
#[test]
fn the_checksums_of_a_run_stay() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 0..40 --out run --no-report").done();
    bench.write("study.toml", STUDY);
    let parts = ["run/SHA256SUMS", "a file of another kind"];
    check_refused(&bench, "gate baseline run --out run --reason x --block-length 2", &parts);
    check_refused(&bench, "gate baseline run --out run --reason x --block-length 2 --replace", &parts);
    check_refused(&bench, "study run study.toml --out run", &parts);
    bench.write("other/summary.json", "mine");
    check_refused(&bench, "study run study.toml --out other", &["other/summary.json", "plan.json"]);
}

#[test]
fn checksums_name_files_of_their_directory_alone() {
    let bench = dataset();
    bench.boresight("process set").done();
    for name in ["/proc/kmsg", "../set/telemetry.csv"] {
        bench.write("set/SHA256SUMS", format!("{}  {name}\n", "0".repeat(64)));
        check_refused(&bench, "score set set/measurements.csv", &["set/SHA256SUMS, line 1", name]);
    }
}

#[test]
fn measurements_are_not_overwritten() {
    let bench = dataset();
    bench.write("mine.csv", "mine");
    check_refused(&bench, "process set --out mine.csv", &["mine.csv", "exists", "--out"]);
    check_refused(&bench, "process set --out mine.csv/mine.csv", &["mine.csv/mine.csv", "cannot create"]);
    bench.write("new/mine.clusters.parquet", "mine");
    check_refused(&bench, "process set --out new/mine.csv", &["new/mine.clusters.parquet", "exists"]);
}
