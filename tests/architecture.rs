//! The direction of dependencies: python -> src; src -> sim, pipeline, contract; sim -> contract; pipeline -> contract; nothing else.
//! python/ hands values of all of them on, fuzz/ feeds their readers, and nothing depends on either. Readers may not panic.

use std::collections::{BTreeMap, BTreeSet};

use cargo_metadata::MetadataCommand;

#[test]
fn dependencies_point_down_and_nowhere_else() {
    let metadata = MetadataCommand::new()
        .manifest_path(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"))
        .no_deps()
        .exec()
        .expect("cargo metadata runs wherever cargo test does");
    let ours: BTreeSet<String> = metadata.packages.iter().map(|p| p.name.to_string()).collect();
    // All kinds of dependencies: a test that reached across would share mathematics as well.
    let arrows: BTreeMap<String, BTreeSet<String>> = metadata
        .packages
        .iter()
        .map(|package| {
            let targets =
                package.dependencies.iter().map(|d| d.name.clone()).filter(|name| ours.contains(name));
            (package.name.to_string(), targets.collect())
        })
        .collect();
    let to = |names: &[&str]| names.iter().map(|name| format!("boresight-{name}")).collect::<BTreeSet<_>>();
    let mut all = to(&["contract", "pipeline", "sim"]);
    all.insert("boresight".to_owned());
    let expected = BTreeMap::from([
        ("boresight".to_owned(), to(&["contract", "pipeline", "sim"])),
        ("boresight-fuzz".to_owned(), all.clone()),
        ("boresight-contract".to_owned(), to(&[])),
        ("boresight-pipeline".to_owned(), to(&["contract"])),
        ("boresight-python".to_owned(), all),
        ("boresight-sim".to_owned(), to(&["contract"])),
    ]);
    assert_eq!(arrows, expected);
}

/// The modules that meet input of anybody's making: those that the lints below are on for, with all that is under them.
const READERS: [&str; 42] = [
    "pipeline/src/external/docking_protocol.rs",
    "pipeline/src/external/process.rs",
    "pipeline/src/external/protocol.rs",
    "python/src/json.rs",
    "python/src/run.rs",
    "python/src/score.rs",
    "sim/src/catalog/catalog.rs",
    "sim/src/catalog/read/mod.rs",
    "sim/src/optics/psf/sampled.rs",
    "sim/src/regular_file.rs",
    "sim/src/scene/docking/target_file.rs",
    "src/command/dataset.rs",
    "src/docking_run.rs",
    "src/files/mod.rs",
    "src/gate/baseline.rs",
    "src/gate/read.rs",
    "src/gate/rows.rs",
    "src/mitsuba/cache.rs",
    "src/monitor/assets.rs",
    "src/monitor/feed.rs",
    "src/monitor/guard.rs",
    "src/monitor/listener.rs",
    "src/monitor/server.rs",
    "src/report/docking/run.rs",
    "src/report/far_range/run.rs",
    "src/report/read.rs",
    "src/report/visibility.rs",
    "src/run.rs",
    "src/run_file.rs",
    "src/scenario/mod.rs",
    "src/study/cases.rs",
    "src/study/definition.rs",
    "src/study/file.rs",
    "src/study/law.rs",
    "src/study/overlay.rs",
    "src/study/record.rs",
    "src/study/shard.rs",
    "src/study_engine.rs",
    "src/toml_file.rs",
    "src/visibility/definition.rs",
    "src/visibility/requirement.rs",
    "src/visibility/write.rs",
];
/// What a panic is made of; `unwrap_used` and `todo` are denied everywhere.
const LINTS: [&str; 5] = ["indexing_slicing", "string_slice", "expect_used", "panic", "unreachable"];

/// What reads bytes that it did not write.
const READS: [&str; 21] = [
    "File::open(",
    "fs::read(",
    "fs::read_to_string(",
    "regular_file::read",
    "toml_file::parse",
    "serde_json::from_",
    "csv::Reader",
    "ParquetFile::open(",
    "open_regular(",
    "TableReader::",
    "Dataset::open(",
    "FieldSource::open(",
    "read_field_measurements(",
    "read_field_telemetry(",
    "read_measurements(",
    "read_motion(",
    "read_radiance(",
    "read_stars(",
    "read_telemetry(",
    "read_until(",
    "stdin()",
];
/// Files that do so and are no readers of input, each with the reason.
const NO_READERS: [(&str, &str); 3] = [
    ("src/pipeline_choice.rs", "hashes files and looks at no byte"),
    ("sim/src/docking/simulator.rs", "hands the text on to serde"),
    ("src/scenario/cameras.rs", "reads what is built in"),
];

#[test]
fn no_reader_can_panic() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    // However the list is broken into lines.
    let denied = |text: &str| {
        let text: String = text.chars().filter(|c| !c.is_whitespace()).collect();
        let list =
            text.split_once("#![cfg_attr(not(test),deny(").and_then(|(_, rest)| rest.split_once("))]"));
        list.map_or_else(String::new, |(list, _)| list.to_owned())
    };
    for reader in READERS {
        let text = std::fs::read_to_string(root.join(reader)).expect("a reader that is listed is there");
        for lint in LINTS {
            let is_denied = denied(&text).split(',').any(|name| name.strip_prefix("clippy::") == Some(lint));
            assert!(is_denied, "{reader}: clippy::{lint} is not denied");
        }
    }
    // And what reads is listed.
    let folders: Vec<&str> = READERS.iter().filter_map(|reader| reader.strip_suffix("mod.rs")).collect();
    let is_known = |name: &str| {
        READERS.contains(&name)
            || folders.iter().any(|folder| name.starts_with(folder))
            || NO_READERS.iter().any(|(known, _)| *known == name)
    };
    for folder in ["src", "sim/src", "pipeline/src", "contract/src", "python/src"] {
        for path in sources(&root.join(folder)) {
            let name = path.strip_prefix(root).expect("inside").to_string_lossy().replace('\\', "/");
            let text = std::fs::read_to_string(&path).expect("a source is text");
            let code = text.split("#[cfg(test)]").next().unwrap_or_default();
            let is_test = name.ends_with("tests.rs") || name.contains("/tests/");
            let reads = code.lines().filter(|line| !line.trim_start().starts_with("//"));
            let reads = reads.flat_map(|line| READS.iter().filter(|call| line.contains(**call))).next();
            assert!(
                is_test || is_known(&name) || reads.is_none(),
                "{name} calls {reads:?} and is not in READERS"
            );
        }
    }
}

/// The Rust files under a folder.
fn sources(folder: &std::path::Path) -> Vec<std::path::PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder of sources");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    paths
        .flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .collect()
}
