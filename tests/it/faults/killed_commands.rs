//! Commands that are killed while running: their files are complete or rejected, and the next command reports
//! this.

use std::path::PathBuf;
use std::time::Instant;

use super::kill::{Dice, KillTime, ProcessEnd, kill_at};
use super::{command, complete_files, small};
use crate::support::{Answer, Bench, check_same_files};

fn small_bench() -> Bench {
    let bench = Bench::new();
    small(&bench);
    bench
}

/// Checks that a command that reads the remaining files gives the same answer as for the complete files, or
/// rejects them.
fn check_answer_or_refusal(bench: &Bench, words: &str, whole: &Answer, kill_time: KillTime) {
    let answer = bench.boresight(words);
    match answer.status {
        Some(0) => assert_eq!(answer.stdout, whole.stdout, "{words} after {kill_time:?}"),
        _ => {
            let answer = answer.refused(&[]);
            assert!(
                answer.stderr.contains("half"),
                "{words} after {kill_time:?} names no file: {}",
                answer.stderr
            );
        }
    }
}

/// Kills a command that creates a directory; `readers` are commands on the directory `half`, whose answers
/// for the complete directory are known.
fn check_directory(bench: &Bench, making: &str, files: u64, readers: &[&str], seed: u64) {
    let begun = Instant::now();
    bench.boresight(&format!("{making} --out whole")).done();
    let life = begun.elapsed();
    std::fs::rename(bench.path("whole"), bench.path("half")).unwrap();
    let answers: Vec<Answer> = readers.iter().map(|words| bench.boresight(words).done()).collect();
    std::fs::rename(bench.path("half"), bench.path("whole")).unwrap();
    let whole = bench.tree("whole");
    let mut dice = Dice::new(seed);
    let mut killed = 0;
    for round in 0..10 {
        let places: Vec<PathBuf> = ["half", "half/truth"].map(|name| bench.path(name)).to_vec();
        let kill_time = KillTime::draw(&mut dice, life, files);
        let end = kill_at(command(bench, &format!("{making} --out half")), kill_time, &places);
        killed += u32::from(end == ProcessEnd::Killed);
        if bench.path("half").exists() {
            for (path, bytes) in complete_files(bench, "half") {
                // A partly written image is harmless: without telemetry no command reads it.
                if !path.starts_with("frames") {
                    assert!(
                        whole[&path] == bytes,
                        "{} after {kill_time:?} is there and not whole",
                        path.display()
                    );
                }
            }
            for (words, answer) in readers.iter().zip(&answers) {
                check_answer_or_refusal(bench, words, answer, kill_time);
            }
            // Existing files are not touched, and the message reports that they exist.
            let before = bench.tree("half");
            let again = bench.boresight(&format!("{making} --out half"));
            if again.status != Some(0) {
                again.refused(&["half", "nothing is overwritten", "--out"]);
                check_same_files(&before, &bench.tree("half"));
            }
            std::fs::remove_dir_all(bench.path("half")).unwrap();
        }
        assert!(round < 9 || killed >= 3, "of ten kills {killed} came in time");
    }
}

#[test]
fn a_run_that_is_killed_is_whole_or_refused() {
    let readers = [
        "score half half/measurements.csv --json",
        "report half --out page.html --json",
        "gate baseline half --out base --reason x --replace --block-length 2 --json",
    ];
    check_directory(
        &small_bench(),
        "run small.toml --frames 20..60 --save-frames fits --no-report",
        10,
        &readers,
        3,
    );
}

#[test]
fn a_dataset_that_is_killed_is_whole_or_refused() {
    for format in ["fits", "png"] {
        let making = format!("render small.toml --frames 20..60 --format {format} --jobs 1");
        check_directory(&small_bench(), &making, 6, &["process half --out half/a.csv --json"], 5);
    }
}

#[test]
fn a_docking_run_that_is_killed_is_whole_or_refused() {
    let bench = Bench::new();
    let readers = ["score half half/measurements.csv --json", "report half --out page.html --json"];
    check_directory(
        &bench,
        "run docking --frames 18000..18010 --save-frames png --no-report",
        8,
        &readers,
        6,
    );
}

#[test]
fn a_docking_dataset_that_is_killed_is_whole_or_refused() {
    for format in ["png", "y4m"] {
        let making = format!("render docking --frames 18000..18010 --format {format}");
        check_directory(&Bench::new(), &making, 4, &["process half --out half/a.csv --json"], 7);
    }
}

/// The measurements of a killed `process` are complete or absent, and the next call writes them.
#[test]
fn a_process_that_is_killed_is_done_again() {
    let bench = small_bench();
    bench.boresight("render small.toml --frames 20..60 --format png --out set").done();
    let begun = Instant::now();
    bench.boresight("process set").done();
    let life = begun.elapsed();
    let whole = complete_files(&bench, "set");
    let mut dice = Dice::new(8);
    let mut killed = 0;
    for _ in 0..8 {
        for name in ["measurements.csv", "clusters.parquet"] {
            let _ = std::fs::remove_file(bench.path("set").join(name));
        }
        let kill_time = KillTime::draw(&mut dice, life, 2);
        let end = kill_at(command(&bench, "process set"), kill_time, &[bench.path("set")]);
        killed += u32::from(end == ProcessEnd::Killed);
        let left = complete_files(&bench, "set");
        let is_named = |name: &str| left.contains_key(std::path::Path::new(name));
        for name in ["measurements.csv", "clusters.parquet"] {
            let path = PathBuf::from(name);
            assert!(left.get(&path).is_none_or(|bytes| *bytes == whole[&path]), "{name} after {kill_time:?}");
        }
        let again = bench.boresight("process set");
        if is_named("measurements.csv") || is_named("clusters.parquet") {
            again.refused(&["exists; nothing is overwritten"]);
        } else {
            again.done();
            check_same_files(&whole, &complete_files(&bench, "set"));
        }
    }
    assert!(killed >= 2, "of eight kills {killed} came in time");
}

/// The output of a gate, a baseline and its reports, is complete or absent.
#[test]
fn a_gate_that_is_killed_leaves_nothing_half_written() {
    let bench = small_bench();
    bench.boresight("run small.toml --frames 0..300 --out run --no-report").done();
    bench.boresight("gate baseline run --out whole --reason first").done();
    let gate = "gate whole run --junit out/gate.xml --report out/gate.html";
    std::fs::create_dir(bench.path("out")).unwrap();
    bench.boresight(gate).done();
    let (baseline, reports) = (bench.tree("whole"), bench.tree("out"));
    let mut killed = 0;
    for files in 0..3 {
        let making = "gate baseline run --out base --reason first";
        let end = kill_at(command(&bench, making), KillTime::Writing(files), &[bench.path("base")]);
        killed += u32::from(end == ProcessEnd::Killed);
        for (path, bytes) in complete_files(&bench, "base") {
            assert!(baseline[&path] == bytes, "{}", path.display());
        }
        let compared = bench.boresight("gate base run --json");
        if compared.status != Some(0) {
            compared.refused(&["base"]);
        }
        bench.boresight(&format!("{making} --replace")).done();
        check_same_files(&baseline, &complete_files(&bench, "base"));
        std::fs::remove_dir_all(bench.path("base")).unwrap();

        std::fs::remove_dir_all(bench.path("out")).unwrap();
        std::fs::create_dir(bench.path("out")).unwrap();
        kill_at(command(&bench, gate), KillTime::Writing(files), &[bench.path("out")]);
        for (path, bytes) in complete_files(&bench, "out") {
            assert!(reports[&path] == bytes, "{}", path.display());
        }
    }
    assert!(killed >= 2, "of three kills {killed} came in time");
}

/// A process that is requested to end removes its temporary directory; the directory of a killed process is
/// removed by the next process.
#[cfg(unix)]
#[test]
fn temporary_directories_go_with_their_process() {
    let bench = small_bench();
    // Long enough that no run ends before it is killed.
    let long =
        std::fs::read_to_string(bench.path("small.toml")).unwrap().replace("count = 400", "count = 1000000");
    bench.write("long.toml", &long);
    std::fs::create_dir(bench.path("tmp")).unwrap();
    let left = || {
        std::fs::read_dir(bench.path("tmp")).unwrap().map(|entry| entry.unwrap().path()).collect::<Vec<_>>()
    };
    for (signal, count) in [("INT", 0), ("TERM", 0), ("KILL", 1)] {
        let mut command = command(&bench, &format!("run long.toml --out {signal}"));
        let mut child = command.env("TMPDIR", bench.path("tmp")).spawn().unwrap();
        // With its mark file: a directory without one could belong to the user.
        while !left().iter().any(|path| path.join(".boresight-scratch").exists()) {
            assert!(child.try_wait().unwrap().is_none(), "it ended too soon");
        }
        let kill =
            std::process::Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status();
        assert!(kill.unwrap().success() && !child.wait().unwrap().success());
        assert_eq!(left().len(), count, "{signal}");
    }
    let next = |out: &str| {
        let mut command = command(&bench, &format!("run small.toml --frames 0..1 --out {out}"));
        assert!(command.env("TMPDIR", bench.path("tmp")).status().unwrap().success());
    };
    next("young");
    assert_eq!(left().len(), 1, "it may not have locked it yet");
    let hours_ago = std::time::SystemTime::now() - std::time::Duration::from_secs(7200);
    std::fs::File::open(&left()[0]).unwrap().set_modified(hours_ago).unwrap();
    next("old");
    assert_eq!(left().len(), 0);
}

/// An interrupted command reports which results are kept and how to continue.
#[cfg(unix)]
#[test]
fn an_interrupted_command_reports_the_kept_files() {
    let bench = small_bench();
    let long =
        std::fs::read_to_string(bench.path("small.toml")).unwrap().replace("count = 400", "count = 1000000");
    bench.write("long.toml", &long);
    let study =
        "title = \"t\"\nscenario = \"small.toml\"\nseed = 5\nframes = \"0..40\"\n[stop]\ncases = 100000\n";
    bench.write("study.toml", study);
    let interrupted = |words: &str, has_begun: &dyn Fn() -> bool| {
        let mut child = command(&bench, words).stderr(std::process::Stdio::piped()).spawn().unwrap();
        while !has_begun() {
            assert!(child.try_wait().unwrap().is_none(), "it ended too soon");
        }
        let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        let output = child.wait_with_output().unwrap();
        assert!(kill.unwrap().success() && !output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let unfinished = |out: &str| bench.path(out).join("UNFINISHED.txt").exists();
    for words in ["run long.toml --out", "render long.toml --out"] {
        let out = words.split(' ').next().unwrap();
        let told = interrupted(&format!("{words} {out}"), &|| bench.path(out).join("run.toml").exists());
        assert!(told.contains(&format!("interrupted: {out} contains an unfinished run")), "{told}");
        assert!(
            unfinished(out) && bench.read(&format!("{out}/UNFINISHED.txt")).contains("cannot be continued")
        );
        bench.boresight(&format!("{words} {out}")).refused(&[out, "in progress, killed or failed"]);
        for reader in [format!("report {out}"), format!("score {out} {out}/measurements.csv")] {
            bench.boresight(&reader).refused(&[out, "UNFINISHED.txt exists"]);
        }
    }

    // In a shard of 32 cases or more, finished cases are not repeated.
    let journal = || std::fs::read_dir(bench.path("study/shards")).into_iter().flatten().flatten().next();
    let lines = |path: PathBuf| std::fs::read_to_string(path).unwrap_or_default().lines().count();
    let begun = || journal().is_some_and(|entry| lines(entry.path()) > 6);
    let told = interrupted("study run study.toml --shards 1 --out study", &begun);
    let kept =
        told.split("interrupted: ").nth(1).and_then(|text| text.split(' ').next()?.parse::<u64>().ok());
    assert!(kept.unwrap() >= 3 && told.contains("the same command continues"), "{told}");
    let before = bench.read(&format!("study/shards/{}", journal().unwrap().file_name().display()));
    let told = interrupted("study run study.toml --shards 1 --out study", &|| {
        lines(journal().unwrap().path()) > before.lines().count() + 6
    });
    let after = bench.read(&format!("study/shards/{}", journal().unwrap().file_name().display()));
    assert!(after.starts_with(&before), "{told}");
    let cases: Vec<&str> =
        after.lines().filter_map(|line| line.split_once(' ')?.1.split(',').next()).collect();
    let distinct: std::collections::BTreeSet<&&str> = cases.iter().collect();
    assert_eq!(distinct.len(), cases.len(), "no case was made twice");
}

#[test]
fn an_unfinished_run_is_marked_as_such() {
    let bench = small_bench();
    let places = [bench.path("out/truth")];
    let words = "run small.toml --frames 0..300 --out out";
    assert_eq!(kill_at(command(&bench, words), KillTime::Writing(1), &places), ProcessEnd::Killed);
    let reason = "contains an incomplete run (in progress, killed or failed); nothing is overwritten";
    bench.boresight(words).refused(&["out", reason, "--out"]);
    bench.boresight("process out").refused(&["out/telemetry.csv"]);
    bench.write("mine.csv", "frame,status,x_px,y_px\n0,no_target,,\n");
    bench.boresight("score out mine.csv").refused(&["out", "UNFINISHED.txt exists"]);
    bench.boresight("report out").refused(&["out", "UNFINISHED.txt exists"]);
}
