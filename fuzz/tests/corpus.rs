//! Runs every input of the corpus through its target: fixed faults stay fixed.

#![allow(clippy::unwrap_used, reason = "tests and their helpers fail by panicking")]

use std::collections::BTreeSet;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

use boresight_fuzz::{Sandbox, TARGETS, Target};

const CORPUS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/corpus");
/// Longest time for one input, on a busy machine; an input that hangs never ends.
const LONGEST: Duration = Duration::from_secs(10);

fn inputs(target: &Target) -> Vec<std::path::PathBuf> {
    let entries = fs::read_dir(Path::new(CORPUS).join(target.name)).unwrap();
    let mut inputs: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    inputs.sort();
    inputs
}

#[test]
fn every_target_has_seeds_and_every_folder_a_target() {
    let folders: BTreeSet<String> = fs::read_dir(CORPUS)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let names: Vec<&str> = TARGETS.iter().map(|target| target.name).collect();
    assert!(names.is_sorted(), "{names:?}");
    assert_eq!(folders, names.iter().map(|name| (*name).to_owned()).collect());
    assert!(TARGETS.iter().all(|target| !inputs(target).is_empty()));
}

#[test]
fn the_corpus_is_small() {
    let bytes: u64 = TARGETS.iter().flat_map(inputs).map(|path| fs::metadata(path).unwrap().len()).sum();
    assert!(bytes < 1_000_000, "{bytes} bytes, expected less than a megabyte: it is read by every test");
}

#[test]
fn no_input_of_the_corpus_panics_or_hangs() {
    let sandbox = Sandbox::new().unwrap();
    let mut failures = Vec::new();
    for target in TARGETS {
        for path in inputs(target) {
            let bytes = fs::read(&path).unwrap();
            let begin = Instant::now();
            let outcome = catch_unwind(AssertUnwindSafe(|| target.run(&sandbox, &bytes)));
            if outcome.is_err() {
                failures.push(format!("{}: panics", path.display()));
            }
            if begin.elapsed() > LONGEST {
                failures.push(format!("{}: takes {:?}", path.display(), begin.elapsed()));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
