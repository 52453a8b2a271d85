//! Embeds the monitor's page, which is built separately, if its directory exists.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

const DIST: &str = "../../monitor/dist";

/// Writes `page.rs`: a sorted table of names and `include_bytes!` for the files of the page; an empty table
/// before it is built.
fn main() -> io::Result<()> {
    // A missing path would count as changed in every build. Before the page is built, the parent of its
    // directory is therefore watched: `dist` will appear in it.
    let is_built = Path::new(DIST).is_dir();
    println!("cargo::rerun-if-changed={}", if is_built { DIST } else { "../../monitor" });

    let mut files = Vec::new();
    if is_built {
        collect_files(&fs::canonicalize(DIST)?, "", &mut files)?;
    }
    files.sort();
    let mut table = "&[\n".to_owned();
    for (name, path) in &files {
        println!("cargo::rerun-if-changed={}", path.display());
        let written = writeln!(table, "    ({name:?}, include_bytes!({path:?})),");
        written.map_err(io::Error::other)?;
    }
    table.push_str("]\n");
    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("OUT_DIR is not set by cargo"))?;
    fs::write(Path::new(&out).join("page.rs"), table)
}

/// Collects the files below `folder`, each with its name relative to the page: `prefix` and the components of
/// its path, joined by slashes.
fn collect_files(folder: &Path, prefix: &str, files: &mut Vec<(String, PathBuf)>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let Some(name) = path.file_name().and_then(|name| name.to_str()) else {
            return Err(io::Error::other(format!("{} has a name that is not UTF-8", path.display())));
        };
        let name = format!("{prefix}{name}");
        if path.is_dir() {
            collect_files(&path, &format!("{name}/"), files)?;
        } else {
            files.push((name, path));
        }
    }
    Ok(())
}
