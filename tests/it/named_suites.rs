//! Suites named in scripts, workflows and pages exist: a filter that selects no test would pass.

use std::collections::BTreeMap;
use std::path::Path;

use crate::supply_chain::{ROOT, kept, read};

/// Text files that name suites; the change log is excluded because it describes the past.
fn texts() -> Vec<(String, String)> {
    let names_suites = |name: &String| {
        let is_text =
            ["md", "py", "rs", "toml", "yml"].iter().any(|kind| name.ends_with(&format!(".{kind}")));
        (is_text || name.starts_with(".ci/")) && name != "CHANGELOG.md" && !name.ends_with("named_suites.rs")
    };
    let names = kept().into_iter().map(|path| path.to_string_lossy().into_owned());
    let there = names.filter(names_suites).filter(|name| Path::new(ROOT).join(name).is_file());
    there.map(|name| (read(&name), name)).map(|(text, name)| (name, text)).collect()
}

/// Package that a file belongs to, by its directory: `sim` for `sim/tests/it/main.rs`, `` for files of the
/// root.
fn package_of(name: &str) -> &str {
    ["sim", "pipeline", "fuzz"]
        .into_iter()
        .find(|folder| name.starts_with(&format!("{folder}/")))
        .unwrap_or("")
}

/// Words of a text that may be paths or names of suites.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_ascii_alphanumeric() || "_/.:-".contains(c))).filter(|word| !word.is_empty())
}

#[test]
fn every_named_test_file_exists() {
    let (mut named, mut missing) = (0, Vec::new());
    for (name, text) in texts() {
        let is_test_file = |word: &&str| {
            word.ends_with(".rs")
                && (word.starts_with("tests/") || word.contains("/tests/"))
                && !word.contains("..")
        };
        for word in words(&text).filter(is_test_file) {
            named += 1;
            let beside = Path::new(ROOT).join(package_of(&name)).join(word);
            if !Path::new(ROOT).join(word).is_file() && !beside.is_file() {
                missing.push(format!("{name}: {word}"));
            }
        }
    }
    assert!(named > 20, "{named} files are named");
    assert_eq!(missing, Vec::<String>::new());
}

/// Tests of the programs `it`, by package, in the form in which they are selected: `suite::name`.
fn tests() -> BTreeMap<&'static str, Vec<String>> {
    let mut tests: BTreeMap<_, Vec<String>> = BTreeMap::new();
    for (name, text) in texts() {
        let Some((folder, file)) = name.split_once("tests/it/") else { continue };
        let package = match folder {
            "" => "",
            "sim/" => "sim",
            "pipeline/" => "pipeline",
            _ => continue,
        };
        let module = file.trim_end_matches(".rs").trim_end_matches("/mod").replace('/', "::");
        let after = text.split("#[test]\n").skip(1);
        let names = after.filter_map(|rest| rest.split("fn ").nth(1)?.split('(').next());
        tests.entry(package).or_default().extend(names.map(|test| format!("{module}::{test}")));
    }
    tests
}

/// `--test NAME` names a test program, and the words after it on the line select tests of this program.
#[test]
fn every_filter_of_a_command_chooses_tests() {
    let tests = tests();
    assert!(tests[""].len() > 300 && tests["sim"].len() > 100 && tests["pipeline"].len() > 30);
    let (mut filters, mut wrong) = (0, Vec::new());
    for (name, text) in texts().iter().filter(|(name, _)| name != "tests/saboteurs/run.py") {
        for line in text.lines().filter(|line| line.contains("--test ") && line.contains("cargo")) {
            let (command, rest) = line.split_once("--test ").unwrap();
            // The command ends at the end of its quotation, comment or line.
            let rest = rest.split(['`', '"', '#', ')', '|', ',']).next().unwrap();
            let mut words = rest.split_whitespace();
            let program = words.next().unwrap_or_default();
            if program != "it" {
                let is_of_fuzz = ["claims", "corpus"].contains(&program) && command.contains("fuzz");
                wrong.extend(
                    (!is_of_fuzz).then(|| format!("{name}: there is no program of tests `{program}`")),
                );
                continue;
            }
            let package = ["sim", "pipeline"]
                .into_iter()
                .find(|package| command.contains(&format!("-p boresight-{package}")))
                .unwrap_or("");
            for filter in words.filter(|word| !word.starts_with('-')) {
                filters += 1;
                if !tests[package].iter().any(|test| test.contains(filter)) {
                    wrong.push(format!("{name}: `{filter}` chooses no test"));
                }
            }
        }
    }
    assert!(filters >= 10, "{filters} filters");
    assert_eq!(wrong, Vec::<String>::new());
}
