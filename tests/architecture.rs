//! The direction of dependencies: src -> sim, pipeline, contract; sim -> contract; pipeline -> contract; nothing else.

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
    let expected = BTreeMap::from([
        ("boresight".to_owned(), to(&["contract", "pipeline", "sim"])),
        ("boresight-contract".to_owned(), to(&[])),
        ("boresight-pipeline".to_owned(), to(&["contract"])),
        ("boresight-sim".to_owned(), to(&["contract"])),
    ]);
    assert_eq!(arrows, expected);
}
