//! Passes the commit of the source tree and the enabled features to the compiler, for `boresight --version`.

use std::env;
use std::path::Path;
use std::process::Command;

/// Commit of a tree that is not the top of a git repository, or on a machine without git.
const UNKNOWN: &str = "unknown";
/// Number of hexadecimal digits of the commit.
const DIGITS: usize = 12;
/// Files of a repository, one of which changes with every commit and every change of branch.
const TRACKED: [&str; 3] = ["HEAD", "logs/HEAD", "packed-refs"];

fn main() {
    // Without this line cargo would run this program after a change of any file of the package.
    println!("cargo::rerun-if-changed=build.rs");
    let commit = commit();
    println!("cargo::rustc-env=BORESIGHT_COMMIT={}", commit.as_deref().unwrap_or(UNKNOWN));
    println!("cargo::rustc-env=BORESIGHT_FEATURES={}", features());
}

/// Returns the names of the enabled features, in alphabetical order, or `none`.
fn features() -> String {
    // Cargo sets CARGO_FEATURE_NAME for each of them; `default` only stands for the others.
    let names = env::vars().filter_map(|(name, _)| Some(name.strip_prefix("CARGO_FEATURE_")?.to_lowercase()));
    let mut names: Vec<String> = names.filter(|name| name != "default").collect();
    names.sort();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

/// Returns the commit of this tree, and makes cargo run this program again after the next one.
fn commit() -> Option<String> {
    let root = env::var("CARGO_MANIFEST_DIR").ok()?;
    // A package that was unpacked inside of another repository has none of its commits.
    let top = git(&root, &["rev-parse", "--show-toplevel"])?;
    if Path::new(&top).canonicalize().ok()? != Path::new(&root).canonicalize().ok()? {
        return None;
    }
    for name in TRACKED {
        let path = git(&root, &["rev-parse", "--git-path", name]).map(|path| Path::new(&root).join(path));
        // A missing file would make cargo run this program for every build.
        if let Some(path) = path.filter(|path| path.exists()) {
            println!("cargo::rerun-if-changed={}", path.display());
        }
    }
    let commit = git(&root, &["rev-parse", "HEAD"])?;
    commit.get(..DIGITS).map(str::to_owned)
}

/// Returns the output of git in the directory `root`; `None` without git, or if it reports an error.
fn git(root: &str, words: &[&str]) -> Option<String> {
    let output = Command::new("git").current_dir(root).args(words).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
