//! Writes the sources of the book, the pages of `docs/` and the reference pages that come from the program:
//! `cargo run -p boresight-examples --example book -- target/debug/boresight OUT`.

mod command_line;
mod formats;
mod pages;
mod scenario_keys;

use std::fs;
use std::path::Path;
use std::process::Command;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [program, out] = arguments.as_slice() else {
        return Err("expected two arguments: the program `boresight` and the folder to write".into());
    };
    let examples = Path::new(env!("CARGO_MANIFEST_DIR"));
    let docs = &examples.join("../docs");
    let (book, pages) = (Path::new(out), Path::new(out).join("src"));
    copy(docs, &pages)?;
    copy_examples(examples, &pages)?;
    fs::rename(pages.join("book.toml"), book.join("book.toml"))?;
    for folder in ["", "evidence", "notebooks"] {
        pages::complete(&docs.join(folder), &pages.join(folder))?;
    }
    let names = ["formats.md", "evidence/formats.md"].map(|name| pages.join(name));
    let mut texts = names.iter().map(fs::read_to_string).collect::<Result<Vec<_>, _>>()?;
    formats::fill(&mut texts)?;
    for (name, text) in names.iter().zip(texts) {
        fs::write(name, text)?;
    }
    fs::write(pages.join("command-line.md"), command_line::page(program)?)?;
    let mut keys =
        "# Scenario keys\n\nEvery key of a scenario file with its type, range and default, from the \
                    JSON Schema (`boresight scenario schema`). Unknown keys are refused.\n"
            .to_owned();
    for (world, title) in [("far_range", "Far range"), ("docking", "Docking")] {
        let schema = output(program, &["scenario", "schema", "--world", world])?;
        keys.push_str(&scenario_keys::section(title, &serde_json::from_str(&schema)?)?);
    }
    fs::write(pages.join("scenario-keys.md"), keys)?;
    Ok(())
}

/// Copies the example files that pages name into the book, and changes the links to them.
fn copy_examples(examples: &Path, pages: &Path) -> std::io::Result<()> {
    let folder = pages.join("examples");
    fs::create_dir_all(&folder)?;
    for entry in fs::read_dir(examples)? {
        let path = entry?.path();
        let is_example = path.extension().is_some_and(|extension| extension == "py" || extension == "toml");
        if let Some(name) = path.file_name().filter(|_| is_example) {
            fs::copy(&path, folder.join(name))?;
        }
    }
    // In the tree the examples are beside docs/, in the book they are inside.
    change_links(pages, "](../examples/", "](examples/")?;
    change_links(&pages.join("evidence"), "](../../examples/", "](../examples/")
}

/// Replaces the text `old` by `new` in every page of a folder.
fn change_links(folder: &Path, old: &str, new: &str) -> std::io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "md") {
            let text = fs::read_to_string(&path)?;
            fs::write(&path, text.replace(old, new))?;
        }
    }
    Ok(())
}

/// Copies a folder with its subfolders.
fn copy(from: &Path, to: &Path) -> std::io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy(&entry.path(), &target)?;
        } else {
            fs::copy(entry.path(), target)?;
        }
    }
    Ok(())
}

/// Returns the standard output of a command of the program.
fn output(program: &str, words: &[&str]) -> Result<String, Box<dyn std::error::Error>> {
    let answer = Command::new(program).args(words).output()?;
    if !answer.status.success() {
        return Err(
            format!("{program} {}: {}", words.join(" "), String::from_utf8_lossy(&answer.stderr)).into()
        );
    }
    Ok(String::from_utf8(answer.stdout)?)
}
