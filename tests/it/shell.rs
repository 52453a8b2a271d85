//! `boresight completions` and `boresight man`, and the book: generated from the command itself and from
//! existing files.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::support::Bench;

#[test]
fn every_shell_has_completions_of_every_command() {
    let bench = Bench::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = bench.boresight(&format!("completions {shell}")).done().stdout;
        for word in ["visibility", "save-frames", "replay"] {
            assert!(script.contains(word), "{shell} has no {word}");
        }
    }
    bench.boresight("completions bash --json").refused(&["completions", "--json"]);
    bench.boresight("completions tcsh").refused(&["tcsh", "bash"]);
}

#[test]
fn every_command_has_a_manual_page() {
    let bench = Bench::new();
    let pages = bench.boresight("man --out pages --json").done().json();
    let names: BTreeSet<String> = pages
        .as_array()
        .unwrap()
        .iter()
        .map(|path| Path::new(path.as_str().unwrap()).file_name().unwrap().to_string_lossy().into_owned())
        .collect();
    for name in ["boresight.1", "boresight-run.1", "boresight-study-replay.1", "boresight-gate-baseline.1"] {
        assert!(names.contains(name), "{names:?}");
    }
    let page = bench.read("pages/boresight-study-run.1");
    assert!(page.contains(".TH boresight-study-run") && page.contains("\\-\\-shard"), "{page}");
    // The synopsis shows the value that an option takes.
    let page = bench.read("pages/boresight-report.1");
    assert!(page.contains("[\\-\\-budget <all|DIR>]"), "{page}");
    // A second time, into the same directory.
    bench.boresight("man --out pages").done();
}

/// Returns the pages of the book.
fn chapters() -> BTreeSet<String> {
    let summary = std::fs::read_to_string(docs().join("SUMMARY.md")).unwrap();
    summary.split("](").skip(1).map(|rest| rest.split(')').next().unwrap().to_owned()).collect()
}

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

/// Returns the text of a page; if it has the mark of an included page, that page.
fn page(name: &str) -> String {
    let path = docs().join(name);
    let text = std::fs::read_to_string(&path).unwrap();
    let included = text.split_once("<!-- include ").and_then(|(_, rest)| rest.split_once(" -->"));
    match included {
        Some((file, _)) if file.ends_with(".md") => {
            std::fs::read_to_string(path.with_file_name("").join(file)).unwrap()
        }
        _ => text,
    }
}

/// Returns the path of a linked file from the root of the repository.
fn resolved(from: &str, link: &str) -> String {
    let mut parts: Vec<&str> = std::iter::once("docs").chain(from.split('/')).collect();
    parts.pop();
    for part in link.split('/') {
        if part == ".." {
            parts.pop();
        } else {
            parts.push(part);
        }
    }
    parts.join("/")
}

/// Pages that `examples/book` writes when the book is built.
const GENERATED: [&str; 2] = ["command-line.md", "scenario-keys.md"];

/// A missing chapter would be created empty, and a page without a chapter would never be found.
#[test]
fn every_page_is_a_chapter_of_the_book() {
    let names = |folder: &str| -> Vec<String> {
        let entries = std::fs::read_dir(docs().join(folder)).unwrap();
        entries.map(|entry| format!("{folder}{}", entry.unwrap().file_name().to_string_lossy())).collect()
    };
    let pages: BTreeSet<String> = ["", "evidence/", "notebooks/"]
        .into_iter()
        .flat_map(names)
        .filter(|name| name.ends_with(".md") && name != "SUMMARY.md")
        .chain(GENERATED.map(str::to_owned))
        .collect();
    assert_eq!(chapters(), pages);
}

/// Links between pages, and to their headings, have a target in the book: one of its chapters, or one of the
/// files of `docs/` that are not pages. Other links are to files of the repository.
#[test]
fn links_between_pages_lead_somewhere() {
    let heading = |line: &str| -> String {
        let kept = line.trim_start_matches('#').trim().to_lowercase();
        let kept = kept.chars().filter(|c| c.is_alphanumeric() || "_- ".contains(*c));
        kept.collect::<String>().replace(' ', "-")
    };
    let chapters = chapters();
    let leads = |from: &str, link: &str| {
        let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
        let path = if file.is_empty() { format!("docs/{from}") } else { resolved(from, file) };
        let Some(chapter) = path.strip_prefix("docs/").filter(|path| path.ends_with(".md")) else {
            return anchor.is_empty() && docs().join("..").join(path).is_file();
        };
        let has = |text: String| text.lines().any(|line| line.starts_with('#') && heading(line) == anchor);
        let is_chapter = chapters.contains(chapter);
        is_chapter && (anchor.is_empty() || GENERATED.contains(&chapter) || has(page(chapter)))
    };
    let mut broken = Vec::new();
    for name in chapters.iter().filter(|name| !GENERATED.contains(&name.as_str())) {
        let text = page(name);
        let links = text.split("](").skip(1).filter_map(|rest| rest.split([')', ' ']).next());
        let dead = links.filter(|link| !link.is_empty() && !link.contains("://") && !leads(name, link));
        broken.extend(dead.map(|link| format!("{name}: {link}")));
    }
    assert_eq!(broken, Vec::<String>::new());
}

/// An example copied from a page is accepted.
#[test]
fn the_examples_of_the_pages_are_accepted() {
    let bench = Bench::new();
    let first = |page: &str| page.split("```toml\n").nth(1).unwrap().split("```").next().unwrap().to_owned();
    for name in ["tutorial-performance.md", "studies.md"] {
        bench.write("study.toml", first(&page(name)));
        bench.boresight("study check study.toml").done();
    }
    // Only the detection model, with fewer pointings than on the page.
    let camera = first(&page("tutorial-camera.md")).replace("[sky]", "[sky]\npointings = 500");
    bench.write("camera.toml", camera);
    bench.boresight("visibility camera.toml --frames 0").done();
    let text = page("tutorial-performance.md");
    let stage = text.split("--inject ").nth(1).unwrap().split_whitespace().next().unwrap();
    bench.boresight(&format!("run argon --frames 0..1 --no-report --inject {stage}")).done();
}
