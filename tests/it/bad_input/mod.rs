//! Bad input: a message that names the place, exit status 2, nothing written and nothing overwritten.

mod cameras;
mod catalogues;
#[cfg(unix)]
mod devices;
mod docking;
mod further;
mod images;
mod measurements;
mod output;
mod physics;
mod scenarios;
mod telemetry;
mod usage;

use crate::support::{Bench, check_same_files};

/// The command refuses these words with a message that has these parts; with `--json` the message is one JSON
/// document on stdout as well. No file appears, vanishes or changes.
fn check_refused(bench: &Bench, words: &str, parts: &[&str]) {
    check_refused_words(bench, &words.split_whitespace().collect::<Vec<_>>(), parts);
}

fn check_refused_words(bench: &Bench, words: &[&str], parts: &[&str]) {
    let before = bench.tree(".");
    let answer = bench.boresight_words(words).refused(parts);
    assert_eq!(answer.stdout, "");
    let document = bench.boresight_words(&[words, &["--json"]].concat()).refused(parts).json();
    let members = document.as_object().unwrap();
    assert_eq!(members.keys().collect::<Vec<_>>(), ["error"]);
    let message = members["error"].as_str().unwrap();
    for part in parts.iter().filter(|part| !part.starts_with("did you mean")) {
        assert!(message.contains(part), "`{part}` in {message}");
    }
    let after = bench.tree(".");
    let names = |tree: &std::collections::BTreeMap<_, _>| tree.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&before), names(&after));
    check_same_files(&before, &after);
}

/// A rendered dataset of three frames in `set`, PNG, without checksums: what is wrong is wrong from the beginning.
fn dataset() -> Bench {
    dataset_of("png")
}

fn dataset_of(format: &str) -> Bench {
    let bench = Bench::new();
    bench.boresight(&format!("render argon --frames 20..23 --format {format} --out set")).done();
    bench.unseal("set");
    bench
}
