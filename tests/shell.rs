//! `boresight completions` and `boresight man`, and the book: made of the command itself and of files that are there.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

mod support;

use std::collections::BTreeSet;
use std::path::Path;

use support::Bench;

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
    // Again, into the same folder.
    bench.boresight("man --out pages").done();
}

/// A chapter that is missing would be made empty, and a page that no chapter names would never be found.
#[test]
fn every_page_is_a_chapter_of_the_book() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let summary = std::fs::read_to_string(folder.join("SUMMARY.md")).unwrap();
    let chapters: BTreeSet<String> =
        summary.split("](").skip(1).map(|rest| rest.split(')').next().unwrap().to_owned()).collect();
    let entries = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name());
    let pages: BTreeSet<String> = entries
        .map(|name| name.to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".md") && name != "SUMMARY.md")
        .collect();
    assert_eq!(chapters, pages);
}

/// Links from page to page, and to their headings, lead somewhere.
#[test]
fn links_between_pages_lead_somewhere() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let heading = |line: &str| -> String {
        let kept = line.trim_start_matches('#').trim().to_lowercase();
        let kept = kept.chars().filter(|c| c.is_alphanumeric() || "_- ".contains(*c));
        kept.collect::<String>().replace(' ', "-")
    };
    let mut broken = Vec::new();
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "md") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split([')', ' ']).next()) {
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            if link.contains("://") || link.is_empty() {
                continue;
            }
            let target = if file.is_empty() { path.clone() } else { folder.join(file) };
            let is_there = target.exists()
                && (anchor.is_empty()
                    || std::fs::read_to_string(&target)
                        .is_ok_and(|text| text.lines().any(|l| l.starts_with('#') && heading(l) == anchor)));
            if !is_there {
                broken.push(format!("{}: {link}", path.display()));
            }
        }
    }
    assert_eq!(broken, Vec::<String>::new());
}

/// What a reader copies from a page is accepted.
#[test]
fn the_examples_of_the_pages_are_accepted() {
    let bench = Bench::new();
    let page = |name: &str| {
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(name)).unwrap()
    };
    let first = |page: &str| page.split("```toml\n").nth(1).unwrap().split("```").next().unwrap().to_owned();
    for name in ["tutorial-performance.md", "studies.md"] {
        bench.write("study.toml", first(&page(name)));
        bench.boresight("study check study.toml").done();
    }
    // The law alone, of fewer pointings than the page's.
    let camera = first(&page("tutorial-camera.md")).replace("[sky]", "[sky]\npointings = 500");
    bench.write("camera.toml", camera);
    bench.boresight("visibility camera.toml --frames 0").done();
    let text = page("tutorial-performance.md");
    let stage = text.split("--inject ").nth(1).unwrap().split_whitespace().next().unwrap();
    bench.boresight(&format!("run argon --frames 0..1 --no-report --inject {stage}")).done();
}
