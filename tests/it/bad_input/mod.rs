//! Invalid input: a message with the location, exit status 2, nothing written and nothing overwritten.

mod cameras;
mod catalogues;
#[cfg(unix)]
mod devices;
mod docking;
mod images;
mod measurements;
mod output;
mod physics;
mod scenarios;
mod second_round;
mod telemetry;
mod usage;

use crate::support::{Bench, check_same_files};

/// Checks that the command rejects these words with a message that contains the given parts; with `--json`
/// the message is also one JSON document on stdout. No file is created, removed or changed.
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

/// Renders a dataset of three frames in `set`, PNG, without checksums: any damage therefore counts as
/// original content.
fn dataset() -> Bench {
    dataset_of("png")
}

fn dataset_of(format: &str) -> Bench {
    let bench = Bench::new();
    bench.boresight(&format!("render argon --frames 20..23 --format {format} --out set")).done();
    bench.unseal("set");
    bench
}
