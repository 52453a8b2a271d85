//! Property over every reader and writer: whatever is read can be written, and is the same when it is read
//! again. The inputs are those of the corpus with some of their numbers replaced by numbers that formats
//! treat in different ways.

#![allow(clippy::unwrap_used, reason = "tests and their helpers fail by panicking")]

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use boresight_fuzz::{Sandbox, TARGETS};

const CORPUS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/corpus");

/// Changed inputs per input of the corpus.
const CHANGES: u64 = 40;

/// Numbers at the ends of types, between types, and without an exact decimal form.
const NUMBERS: [&str; 22] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "0.1",
    "1e-9",
    "1e-320",
    "5e-324",
    "1e15",
    "123456789.123456789",
    "3.0000000000000004",
    "1e22",
    "1.7976931348623157e308",
    "nan",
    "inf",
    "255",
    "65536",
    "4294967296",
    "9007199254740993",
    "9223372036854775807",
    "9223372036854775808",
    "18446744073709551615",
];

/// Returns the next number of a linear congruential sequence (Knuth, MMIX), its upper bits below `limit`.
fn next(state: &mut u64, limit: usize) -> usize {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    ((*state >> 33) as usize) % limit.max(1)
}

/// Returns the ranges of the numbers in a text.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let mut ranges = Vec::new();
    let mut start = None;
    for (at, letter) in text.char_indices().chain([(text.len(), ' ')]) {
        let is_of_number = letter.is_ascii_digit() || ".+-eE".contains(letter);
        match (start, is_of_number) {
            (None, true) => start = Some(at),
            (Some(first), false) => {
                if text[first..at].parse::<f64>().is_ok() {
                    ranges.push(first..at);
                }
                start = None;
            }
            _ => {}
        }
    }
    ranges
}

/// Replaces up to three numbers of a text; in other bytes, replaces up to three bytes.
fn changed(bytes: &[u8], state: &mut u64) -> Vec<u8> {
    let changes = 1 + next(state, 3);
    let Ok(text) = std::str::from_utf8(bytes) else {
        let mut bytes = bytes.to_vec();
        for _ in 0..changes {
            let at = next(state, bytes.len());
            if let Some(byte) = bytes.get_mut(at) {
                *byte = next(state, 256) as u8;
            }
        }
        return bytes;
    };
    let mut text = text.to_owned();
    for _ in 0..changes {
        let ranges = numbers(&text);
        if let Some(range) = ranges.get(next(state, ranges.len())) {
            text.replace_range(range.clone(), NUMBERS[next(state, NUMBERS.len())]);
        }
    }
    text.into_bytes()
}

#[test]
fn every_accepted_input_can_be_written_and_read_again_unchanged() {
    let sandbox = Sandbox::new().unwrap();
    let mut failures = Vec::new();
    let mut state = 40;
    for target in TARGETS {
        let mut inputs: Vec<_> = fs::read_dir(Path::new(CORPUS).join(target.name))
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .collect();
        inputs.sort();
        for path in inputs {
            let bytes = fs::read(&path).unwrap();
            for change in 0..CHANGES {
                let input = changed(&bytes, &mut state);
                if catch_unwind(AssertUnwindSafe(|| target.run(&sandbox, &input))).is_err() {
                    let kept = std::env::temp_dir().join(format!("change-{}-{change}", target.name));
                    fs::write(&kept, &input).unwrap();
                    failures.push(format!("{} changed: kept as {}", path.display(), kept.display()));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
