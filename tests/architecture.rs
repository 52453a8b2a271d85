//! The direction of dependencies: python -> src; src -> sim, pipeline, contract; sim -> contract; pipeline -> contract; nothing else.
//! python/ hands values of all of them on, and nothing depends on it.

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
        ("boresight-contract".to_owned(), to(&[])),
        ("boresight-pipeline".to_owned(), to(&["contract"])),
        ("boresight-python".to_owned(), all),
        ("boresight-sim".to_owned(), to(&["contract"])),
    ]);
    assert_eq!(arrows, expected);
}
