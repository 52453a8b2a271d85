//! Faults of the machine while an external pipeline runs: the command ends with status 2 and scores nothing.

use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;

use crate::support::Bench;

/// A program that finds no target.
const PATIENT: &str = r#"
import json, os, sys
os.chdir("/")
sys.stdin.readline()
print(json.dumps({"boresight_pipeline": 1, "name": "patient"}), flush=True)
for line in sys.stdin:
    asked = json.loads(line)
    open(asked["image"], "rb").close()
    print(json.dumps({"frame": asked["frame"], "status": "no_target"}), flush=True)
"#;

fn bench() -> Bench {
    let bench = Bench::new();
    bench.scenario("sky.toml", "starting-point", |scenario| {
        scenario["star_list"]["magnitude_limit"] = 3.0.into();
    });
    bench.write("patient.py", PATIENT);
    bench
}

const RUN: [&str; 8] = ["run", "sky.toml", "--frames", "0..2", "--no-report", "--out", "out", "--pipeline"];

fn run(bench: &Bench) -> crate::support::Answer {
    let words: Vec<&str> = RUN.into_iter().chain(["exec:python3 patient.py"]).collect();
    bench.boresight_words(&words)
}

#[test]
fn an_image_that_cannot_be_written_ends_the_run() {
    let bench = bench();
    // An image has 870 kB: it exceeds the limit of 410 kB for a file, as on a full disk. The run's own files
    // are smaller with a short list of stars.
    let program = env!("CARGO_BIN_EXE_boresight");
    let output = std::process::Command::new("sh")
        .args(["-c", "trap '' XFSZ; ulimit -f 800; exec \"$0\" \"$@\"", program])
        .args(RUN)
        .arg("exec:python3 patient.py")
        .current_dir(bench.path(""))
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{text}");
    for part in ["frame 0", "cannot be written", "File too large", "nothing was scored"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(!bench.path("out/score.json").exists());
}

#[test]
fn a_name_of_the_temporary_directory_that_is_no_text_ends_the_run() {
    let mut bench = bench();
    let name = bench.path("").join(OsStr::from_bytes(b"caf\xe9"));
    std::fs::create_dir(&name).unwrap();
    bench.set("TMPDIR", name);
    run(&bench).refused(&["frame 0", "is not UTF-8", "nothing was scored"]);
    assert!(!bench.path("out/score.json").exists());
}

#[test]
fn a_relative_temporary_directory_is_found_by_a_program_elsewhere() {
    let mut bench = bench();
    std::fs::create_dir(bench.path("scratch")).unwrap();
    bench.set("TMPDIR", "scratch");
    run(&bench).done();
    assert_eq!(bench.csv("out/measurements.csv")[1]["status"], "no_target");
}

#[test]
fn a_dataset_is_not_processed_without_its_images() {
    let mut bench = bench();
    bench.boresight("render sky.toml --frames 0..2 --out set").done();
    let name = bench.path("").join(OsStr::from_bytes(b"caf\xe9"));
    std::fs::create_dir(&name).unwrap();
    bench.set("TMPDIR", name);
    let words = ["process", "set", "--out", "answers.csv", "--pipeline", "exec:python3 patient.py"];
    bench.boresight_words(&words).refused(&["is not UTF-8", "nothing was scored"]);
    assert!(!bench.path("answers.csv").exists());
}
