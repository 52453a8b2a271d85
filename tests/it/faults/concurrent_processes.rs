//! Two processes at one path at the same time: they cooperate, or one is rejected.

use std::process::{Child, Output, Stdio};

use super::{command, complete_files, small, stderr};
use crate::support::{Bench, check_same_files};

fn study(cases: u32, sigma_max: f64) -> String {
    format!(
        "title = \"two frames\"\nscenario = \"small.toml\"\nseed = 5\nframes = \"20..22\"\n[stop]\ncases = {cases}\n\
         [[vary]]\npath = \"psf.sigma_px\"\ndistribution = {{ kind = \"uniform\", min = 0.7, max = {sigma_max} }}\n"
    )
}

/// Starts commands as simultaneously as possible, and waits for all of them.
fn together(bench: &Bench, all: &[&str]) -> Vec<Output> {
    let start = |words: &&str| -> Child {
        command(bench, words).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    };
    let children: Vec<Child> = all.iter().map(start).collect();
    children.into_iter().map(|child| child.wait_with_output().unwrap()).collect()
}

#[test]
fn workers_of_the_same_study_make_it_together() {
    let bench = Bench::new();
    small(&bench);
    bench.write("study.toml", study(24, 0.9));
    let words = |out: &str| format!("study run study.toml --shards 8 --jobs 1 --out {out}");
    bench.boresight(&words("whole")).done();
    for round in 0..3 {
        let out = format!("out-{round}");
        for output in together(&bench, &[words(&out).as_str(); 3]) {
            assert!(output.status.success(), "{}", stderr(&output));
        }
        check_same_files(&bench.tree("whole"), &bench.tree(&out));
        // One process runs a shard while another merges all shards.
        let shard = format!("study run study.toml --shard 3/8 --out {out}");
        let merge = format!("study merge study.toml --out {out}");
        std::fs::remove_file(bench.path(&out).join("shards/3-of-8.parquet")).unwrap();
        let outputs = together(&bench, &[shard.as_str(), merge.as_str()]);
        assert!(outputs[0].status.success(), "{}", stderr(&outputs[0]));
        let is_early = stderr(&outputs[1]).contains("shards 3 of 8 are missing or damaged");
        assert!(outputs[1].status.success() || is_early, "{}", stderr(&outputs[1]));
        check_same_files(&bench.tree("whole"), &complete_files(&bench, &out));
    }
}

#[test]
fn of_two_studies_that_begin_in_one_directory_one_is_refused() {
    let bench = Bench::new();
    small(&bench);
    bench.write("a.toml", study(8, 0.9));
    bench.write("b.toml", study(8, 0.8));
    for name in ["a", "b"] {
        bench.boresight(&format!("study run {name}.toml --shards 4 --out whole-{name}")).done();
    }
    for round in 0..4 {
        let words =
            ["a", "b"].map(|name| format!("study run {name}.toml --shards 4 --jobs 1 --out out-{round}"));
        let outputs = together(&bench, &[words[0].as_str(), words[1].as_str()]);
        let done: Vec<bool> = outputs.iter().map(|output| output.status.success()).collect();
        let (winner, loser) = match done[..] {
            [true, false] => ("a", &outputs[1]),
            [false, true] => ("b", &outputs[0]),
            _ => panic!("{done:?}: {}{}", stderr(&outputs[0]), stderr(&outputs[1])),
        };
        assert_eq!(loser.status.code(), Some(2));
        assert!(stderr(loser).contains("contains another study"), "{}", stderr(loser));
        check_same_files(&bench.tree(&format!("whole-{winner}")), &bench.tree(&format!("out-{round}")));
    }
}

#[test]
fn of_two_runs_into_one_directory_one_is_refused() {
    let bench = Bench::new();
    small(&bench);
    let words =
        |seed: u32, out: &str| format!("run small.toml --frames 20..30 --jobs 1 --seed {seed} --out {out}");
    for seed in 1..=2 {
        bench.boresight(&words(seed, &format!("whole-{seed}"))).done();
    }
    for round in 0..6 {
        let out = format!("out-{round}");
        if round % 2 == 1 {
            std::fs::create_dir(bench.path(&out)).unwrap();
        }
        let outputs = together(&bench, &[words(1, &out).as_str(), words(2, &out).as_str()]);
        let winner = outputs.iter().position(|output| output.status.success());
        let winner = winner.unwrap_or_else(|| panic!("both were refused: {}", stderr(&outputs[0])));
        let loser = &outputs[1 - winner];
        assert_eq!(loser.status.code(), Some(2), "{}", stderr(loser));
        assert!(stderr(loser).contains("nothing is overwritten"), "{}", stderr(loser));
        check_same_files(&bench.tree(&format!("whole-{}", winner + 1)), &bench.tree(&out));
    }
    // Without separate directories, each run gets a number.
    let numbered = "run small.toml --frames 20..22 --no-report";
    for output in together(&bench, &[numbered; 3]) {
        assert!(output.status.success(), "{}", stderr(&output));
    }
    assert_eq!(std::fs::read_dir(bench.path("runs")).unwrap().count(), 3);
}

#[test]
fn of_two_that_measure_one_dataset_one_is_refused() {
    let bench = Bench::new();
    small(&bench);
    bench.boresight("render small.toml --frames 20..30 --out set").done();
    bench.boresight("process set --out whole.csv").done();
    for _ in 0..4 {
        let outputs = together(&bench, &["process set"; 2]);
        let winner = outputs.iter().position(|output| output.status.success());
        let winner = winner.unwrap_or_else(|| panic!("both were refused: {}", stderr(&outputs[0])));
        let loser = &outputs[1 - winner];
        assert_eq!(loser.status.code(), Some(2), "{}", stderr(loser));
        assert!(stderr(loser).contains("nothing is overwritten"), "{}", stderr(loser));
        assert_eq!(bench.read("set/measurements.csv"), bench.read("whole.csv"));
        assert!(!bench.tree("set").into_keys().any(|path| path.to_string_lossy().contains("partial")));
        for name in ["measurements.csv", "clusters.parquet"] {
            std::fs::remove_file(bench.path("set").join(name)).unwrap();
        }
    }
}
