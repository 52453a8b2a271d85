//! A study that is killed repeatedly and continued: the final files are those of an undisturbed study.

use std::time::{Duration, Instant};

use super::kill::{Dice, KillTime, ProcessEnd, kill_at, partial_files};
use super::{command, complete_files, small};
use crate::support::{Bench, check_same_files};

const STUDY: &str = r#"
title = "eight small frames"
scenario = "small.toml"
seed = 5
frames = "20..28"
[stop]
cases = 36
[[vary]]
path = "psf.sigma_px"
distribution = { kind = "normal", mean = 0.8, sigma = 0.1 }
[[vary]]
path = "sensor.hot_pixels.count"
distribution = { kind = "integer", min = 0, max = 40 }
"#;

const RUN: &str = "study run study.toml --shards 12 --jobs 2 --out";
/// Number of files that a complete study writes: plan, shards, record, cases, summary, checksums, report.
const FILES: u64 = 18;

/// Returns a bench with a study, run undisturbed in `whole`, and the duration of that run.
fn bench() -> (Bench, Duration) {
    let bench = Bench::new();
    small(&bench);
    bench.write("study.toml", STUDY);
    let begun = Instant::now();
    bench.boresight(&format!("{RUN} whole")).done();
    (bench, begun.elapsed())
}

/// Kills a study `kills` times at times drawn from a seed, and continues it until it is complete, in as many
/// directories as necessary.
fn check_kills(kills: u32, seed: u64) {
    let (bench, life) = bench();
    let whole = complete_files(&bench, "whole");
    let mut dice = Dice::new(seed);
    let mut killed = 0;
    let (mut folders, mut while_writing, mut last_files) = (0, 0, 0);
    while killed < kills {
        folders += 1;
        let out = format!("out-{folders}");
        let places = [bench.path(&out), bench.path(&out).join("shards")];
        loop {
            let kill_time = KillTime::draw(&mut dice, life, FILES);
            if killed == kills {
                bench.boresight(&format!("{RUN} {out}")).done();
                break;
            }
            if kill_at(command(&bench, &format!("{RUN} {out}")), kill_time, &places) == ProcessEnd::Done {
                break;
            }
            killed += 1;
            let left: usize = places.iter().map(|place| partial_files(place).len()).sum();
            let shards =
                (1..=12).filter(|i| places[1].join(format!("{i:02}-of-12.parquet")).exists()).count();
            while_writing += usize::from(left > 0);
            last_files += usize::from(shards == 12);
            eprintln!("kill {killed} {kill_time:?}: {shards} of 12 shards there, {left} unfinished files");
        }
        check_same_files(&whole, &complete_files(&bench, &out));
        // Merging the existing shards again changes nothing.
        bench.boresight(&format!("study merge study.toml --out {out}")).done();
        check_same_files(&whole, &complete_files(&bench, &out));
    }
    eprintln!(
        "{killed} kills in {folders} folders, life {life:?}: {while_writing} of them with a file unfinished, {last_files} after the last shard"
    );
    assert!(while_writing > 0, "no kill came while a file was being written");
}

#[test]
fn a_study_killed_at_eight_times_ends_as_if_undisturbed() {
    check_kills(8, 1);
}

#[test]
#[ignore = "minutes: fifty kills; scheduled"]
fn a_study_killed_at_fifty_times_ends_as_if_undisturbed() {
    check_kills(50, 2);
}

/// If a merge is killed, the final files are complete or absent, and another merge writes them.
#[test]
fn a_merge_that_is_killed_is_done_again() {
    let (bench, _) = bench();
    let whole = complete_files(&bench, "whole");
    let ends = ["study.json", "cases.parquet", "summary.json", "SHA256SUMS", "report.html"];
    let mut killed = 0;
    for files in 0..5 {
        for name in ends {
            let _ = std::fs::remove_file(bench.path("whole").join(name));
        }
        let places = [bench.path("whole")];
        let merge = command(&bench, "study merge study.toml --out whole");
        killed += u32::from(kill_at(merge, KillTime::Writing(files), &places) == ProcessEnd::Killed);
        for (path, bytes) in complete_files(&bench, "whole") {
            assert!(whole[&path] == bytes, "{} is there and not whole", path.display());
        }
        bench.boresight("study merge study.toml --out whole").done();
        check_same_files(&whole, &complete_files(&bench, "whole"));
    }
    assert!(killed >= 3, "of five kills {killed} came in time");
}

/// Files left by killed processes are removed by a later process, after an hour.
#[test]
fn old_leftovers_of_killed_processes_are_removed() {
    let (bench, _) = bench();
    bench.write("whole/shards/.partial-old-01-of-12.parquet", "half");
    bench.write("whole/shards/.partial-new-01-of-12.parquet", "half");
    let old =
        std::fs::File::options().append(true).open(bench.path("whole/shards/.partial-old-01-of-12.parquet"));
    old.unwrap().set_modified(std::time::SystemTime::now() - Duration::from_secs(3700)).unwrap();
    bench.boresight(&format!("{RUN} whole")).done();
    let left = partial_files(&bench.path("whole/shards"));
    assert_eq!(left, [bench.path("whole/shards/.partial-new-01-of-12.parquet")]);
}
