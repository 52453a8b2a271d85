//! Results that must keep their bits: `golden/frozen/` contains the hashes of the output and the files of a
//! list of commands.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use boresight::sha256::sha256_hex;
use serde::Deserialize;

use crate::support::Bench;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Commands {
    command: Vec<Command>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Command {
    words: String,
    #[serde(default)]
    long: bool,
}

fn golden(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("golden/frozen").join(name)
}

/// Frozen hashes by command: of its output, and of each file that it writes.
fn frozen() -> BTreeMap<String, BTreeMap<String, String>> {
    let mut commands: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
    let mut command = String::new();
    for line in fs::read_to_string(golden("hashes.txt")).unwrap().lines() {
        let (hash, name) = line.split_once("  ").unwrap();
        if let Some((_, words)) = name.split_once(" boresight ") {
            words.clone_into(&mut command);
        }
        commands.entry(command.clone()).or_default().insert(name.to_owned(), hash.to_owned());
    }
    commands
}

#[test]
fn results_have_their_frozen_bits() {
    let bench = Bench::new();
    for name in ["far-range.toml", "docking.toml"] {
        bench.write(name, fs::read(golden(name)).unwrap());
    }
    let commands: Commands = toml::from_str(&fs::read_to_string(golden("commands.toml")).unwrap()).unwrap();
    let mut frozen = frozen();
    let all: BTreeSet<&str> = commands.command.iter().map(|command| command.words.as_str()).collect();
    assert!(
        frozen.keys().all(|words| all.contains(words.as_str())),
        "hashes of a command that is not listed"
    );
    let (mut seen, mut changed, mut count) = (BTreeSet::new(), Vec::new(), 0);
    seen.extend(bench.tree(".").into_keys());
    for Command { words, long } in &commands.command {
        let mut expected = frozen.remove(words).unwrap_or_else(|| panic!("no hashes of `{words}`"));
        if *long {
            continue;
        }
        let answer = bench.boresight(words);
        let mut results =
            vec![(format!("{} boresight {words}", answer.status.unwrap()), sha256_hex(&answer.stdout))];
        for (path, bytes) in bench.tree(".") {
            if path.file_name().unwrap() != "report.html" && seen.insert(path.clone()) {
                results.push((path.to_string_lossy().into_owned(), sha256_hex(bytes)));
            }
        }
        count += results.len();
        changed
            .extend(results.into_iter().filter(|(name, hash)| expected.remove(name).as_ref() != Some(hash)));
        changed.extend(expected);
    }
    let names: Vec<&String> = changed.iter().map(|(name, _)| name).collect();
    assert!(
        changed.is_empty(),
        "of {count} results these have other bits; when that is meant, remake them: \
         python3 golden/frozen/make.py --reason \"...\"\n{names:#?}"
    );
    assert!(count > 100, "{count} results");
}
