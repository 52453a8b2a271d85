//! The build uses only locked dependencies: every dependency of every language has one version and, if its
//! registry provides one, a hash. Third-party files in the tree have hashes too.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use boresight::sha256::sha256_hex;

pub(crate) const ROOT: &str = env!("CARGO_MANIFEST_DIR");

pub(crate) fn read(name: &str) -> String {
    fs::read_to_string(Path::new(ROOT).join(name)).unwrap()
}

/// Returns the files tracked by git.
pub(crate) fn kept() -> Vec<PathBuf> {
    let answer = Command::new("git").args(["-C", ROOT, "ls-files", "-z"]).output().unwrap();
    assert!(answer.status.success(), "{}", String::from_utf8_lossy(&answer.stderr));
    let names = String::from_utf8(answer.stdout).unwrap();
    names.split_terminator('\0').map(PathBuf::from).collect()
}

/// Returns true if the requirement is of the form `name==1.2.3`, optionally with an extra in brackets.
fn is_pinned(requirement: &str) -> bool {
    let is_version =
        |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || ".+!".contains(c));
    requirement
        .split_once("==")
        .is_some_and(|(name, version)| !name.contains(['<', '>', '~', '!']) && is_version(version))
}

#[test]
fn every_crate_is_of_the_registry_with_its_checksum_or_ours() {
    assert!(kept().iter().any(|path| path == Path::new("Cargo.lock")), "Cargo.lock is not committed");
    let lock: toml::Table = read("Cargo.lock").parse().unwrap();
    let packages = lock["package"].as_array().unwrap();
    assert!(packages.len() > 100);
    for package in packages {
        let name = package["name"].as_str().unwrap();
        match package.get("source").and_then(|source| source.as_str()) {
            None => assert!(name.starts_with("boresight"), "{name} has no source"),
            Some(source) => {
                let checksum = package.get("checksum").and_then(|sum| sum.as_str()).unwrap_or_default();
                assert!(
                    source.starts_with("registry+") && source.contains("crates.io-index"),
                    "{name}: {source}"
                );
                assert!(
                    checksum.len() == 64 && checksum.bytes().all(|b| b.is_ascii_hexdigit()),
                    "{name}: {checksum}"
                );
            }
        }
    }
}

#[test]
fn every_third_party_file_has_the_documented_hash_and_a_licence() {
    let kept = kept();
    let manifests: Vec<_> =
        kept.iter().filter(|path| path.ends_with("SHA256SUMS") && is_third_party(path)).collect();
    assert!(!manifests.is_empty(), "no third_party/*/SHA256SUMS");
    let mut listed = Vec::new();
    for manifest in manifests {
        let folder = manifest.parent().unwrap();
        assert!(Path::new(ROOT).join(folder).join("README.md").is_file(), "{}", folder.display());
        for line in read(&manifest.to_string_lossy()).lines() {
            let (expected, name) = line.split_once("  ").unwrap();
            let bytes = fs::read(Path::new(ROOT).join(folder).join(name)).unwrap();
            assert_eq!(sha256_hex(bytes), expected, "{}", folder.join(name).display());
            listed.push(folder.join(name));
        }
        assert!(listed.contains(&folder.join("LICENSE")), "{} has no licence", folder.display());
    }
    // The remaining files belong to the project: descriptions of the files, and the script that downloads
    // them.
    let ours = ["SHA256SUMS", "README.md", "fetch.py", ".gitattributes"];
    for path in kept.iter().filter(|path| is_third_party(path)) {
        let is_ours = ours.iter().any(|name| path.ends_with(name));
        assert!(is_ours || listed.contains(path), "{} is in no SHA256SUMS", path.display());
    }
}

fn is_third_party(path: &Path) -> bool {
    path.components().any(|part| part.as_os_str() == "third_party")
}

#[test]
fn every_package_of_the_page_has_one_version_and_a_hash() {
    let lock: serde_json::Value = serde_json::from_str(&read("monitor/package-lock.json")).unwrap();
    let packages = lock["packages"].as_object().unwrap();
    assert!(packages.len() > 10);
    for (path, package) in packages.iter().filter(|(path, _)| !path.is_empty()) {
        let text = |key: &str| package[key].as_str().unwrap_or_default();
        assert!(path.starts_with("node_modules/"), "{path} is not of the registry");
        assert!(!text("version").is_empty(), "{path} has no version");
        assert!(text("integrity").starts_with("sha512-"), "{path}: `integrity` is `{}`", text("integrity"));
        // If present, it is the address of a registry, not of a repository or directory.
        assert!(
            text("resolved").is_empty() || text("resolved").starts_with("https://"),
            "{path}: {}",
            text("resolved")
        );
        assert!(
            package.get("hasInstallScript").is_none() || path.ends_with("/esbuild"),
            "{path} runs a script when it is installed"
        );
    }
    let manifest: serde_json::Value = serde_json::from_str(&read("monitor/package.json")).unwrap();
    for kind in ["dependencies", "devDependencies"] {
        for (name, version) in manifest[kind].as_object().unwrap() {
            let version = version.as_str().unwrap();
            assert!(
                version.starts_with(|c: char| c.is_ascii_digit()) && !version.contains([' ', 'x', '*']),
                "{name}: {version}"
            );
        }
    }
}

#[test]
fn every_requirement_of_python_names_one_version() {
    let is_list = |path: &PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy();
        name.ends_with("requirements.txt") || name.ends_with("constraints.txt")
    };
    let lists: Vec<_> = kept().into_iter().filter(is_list).collect();
    assert!(lists.len() > 5, "{lists:?}");
    for path in lists {
        for line in read(&path.to_string_lossy()).lines() {
            let requirement = line.split('#').next().unwrap().trim();
            assert!(requirement.is_empty() || is_pinned(requirement), "{}: {line}", path.display());
        }
    }
}

/// `pip install` accepts lists, the project's own package or wheel with constraints, or `name==version`;
/// cargo installs locked versions.
#[test]
fn packages_of_continuous_integration_are_pinned() {
    let (mut packages, mut tools, mut pages) = (0, 0, 0);
    let is_script = |path: &PathBuf| path.starts_with(".ci") || path.starts_with(".github");
    for file in kept().into_iter().filter(is_script) {
        let file = file.to_string_lossy();
        for line in read(&file).lines() {
            if let Some((_, words)) = line.split_once("pip\" install").or(line.split_once("pip install")) {
                let words: Vec<&str> = words.split("&&").next().unwrap().split_whitespace().collect();
                packages += 1;
                let constrained = words.contains(&"-c");
                let mut words = words.iter().map(|word| word.trim_matches(['\'', '"']));
                while let Some(word) = words.next() {
                    if matches!(word, "-r" | "-c") {
                        let list = words.next().unwrap();
                        assert!(Path::new(ROOT).join(list).is_file(), "{file}: {list}");
                    } else if word.starts_with("./python") || word.starts_with("dist/") {
                        assert!(constrained, "{file}: {line}");
                    } else if word == "${WHEEL:-boresight==$VERSION}" {
                        // The choice of the user of the action, who pins it.
                        assert_eq!(file, ".github/actions/install/install.sh");
                    } else {
                        assert!(word.starts_with('-') || is_pinned(word), "{file}: `{word}` of {line}");
                    }
                }
            }
            pages += usize::from(line.contains("npm ci"));
            if line.contains("cargo install") {
                tools += 1;
                assert!(line.contains("--locked"), "{file}: {line}");
            }
            assert!(!line.contains("npm install"), "{file}: npm ci keeps to the lock file: {line}");
        }
    }
    // An installation method unknown to this test must not pass.
    assert!(packages >= 5 && tools >= 2 && pages >= 1, "{packages} by pip, {tools} by cargo, {pages} by npm");
}
