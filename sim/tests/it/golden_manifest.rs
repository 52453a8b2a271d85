//! Every file of golden/ is in the manifest, unchanged, and every file in the manifest exists.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use sha2::{Digest, Sha256};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Manifest {
    script: Vec<Script>,
    reference: Vec<Reference>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Script {
    path: String,
    sha256: String,
    reason: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Reference {
    path: String,
    sha256: String,
    reason: String,
    script: String,
    origin: String,
    tools: String,
    tolerance: String,
    tolerance_reason: String,
}

fn golden() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../golden")
}

fn manifest() -> Manifest {
    toml::from_str(&fs::read_to_string(golden().join("manifest.toml")).unwrap()).unwrap()
}

/// Collects the paths below golden/, written with `/`. Excluded are the manifest, the README, files that
/// Python leaves behind, and the witnesses, which examine current simulations and store nothing to compare
/// with.
fn files(folder: &Path, found: &mut BTreeSet<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            if name != "__pycache__" && name != "witnesses" {
                files(&path, found);
            }
        } else if name != "manifest.toml" && name != "README.md" {
            let below = path.strip_prefix(golden()).unwrap();
            found.insert(
                below.components().map(|c| c.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/"),
            );
        }
    }
}

#[test]
fn every_golden_file_is_the_one_in_the_manifest() {
    let manifest = manifest();
    let scripts = manifest.script.iter().map(|s| (&s.path, &s.sha256));
    let references = manifest.reference.iter().map(|r| (&r.path, &r.sha256));
    let listed: BTreeMap<_, _> = scripts.chain(references).collect();
    assert_eq!(listed.len(), manifest.script.len() + manifest.reference.len(), "a path is listed twice");

    let mut present = BTreeSet::new();
    files(&golden(), &mut present);
    for path in &present {
        assert!(listed.contains_key(path), "golden/{path} is not in golden/manifest.toml");
    }
    for (path, sha256) in listed {
        assert!(present.contains(path), "golden/{path} is in the manifest and missing");
        let bytes = fs::read(golden().join(path)).unwrap();
        let found: String = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(&found, sha256, "golden/{path} has changed");
    }
}

#[test]
fn every_reference_states_its_origin_and_tolerance() {
    let manifest = manifest();
    for script in &manifest.script {
        assert!(!script.reason.trim().is_empty(), "{}: no reason", script.path);
    }
    for r in &manifest.reference {
        for (field, text) in [
            ("reason", &r.reason),
            ("origin", &r.origin),
            ("tools", &r.tools),
            ("tolerance", &r.tolerance),
            ("tolerance_reason", &r.tolerance_reason),
        ] {
            assert!(!text.trim().is_empty(), "{}: {field} is empty", r.path);
        }
        assert!(manifest.script.iter().any(|s| s.path == r.script), "{}: {} is not listed", r.path, r.script);
    }
}
