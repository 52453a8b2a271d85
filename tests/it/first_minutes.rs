//! The first minutes of a user: help without a command, version, demo, reproduction of the papers.

use std::fs;
use std::path::Path;

use boresight::scenario::BUILT_IN;
use serde_json::Value;

use crate::support::{Bench, figure};

#[test]
fn the_command_alone_prints_its_help_and_runs_nothing() {
    let bench = Bench::new();
    let alone = bench.boresight("").done();
    for part in ["Usage: boresight", "boresight demo", "boresight reproduce argon", "scenario new"] {
        assert!(alone.stdout.contains(part), "{part} in\n{}", alone.stdout);
    }
    assert!(alone.stderr.is_empty(), "{}", alone.stderr);
    assert!(bench.tree(".").is_empty());
    bench.boresight("--json").refused(&["--json", "without a command"]);
}

/// The commit is that of git in this tree, or `unknown` without a repository.
#[test]
fn the_version_names_commit_and_features() {
    let version = Bench::new().boresight("--version").done().stdout;
    let package = format!("boresight {} (commit ", env!("CARGO_PKG_VERSION"));
    let rest = version.trim_end().strip_prefix(&package).unwrap_or_else(|| panic!("{version}"));
    let (commit, features) = rest.strip_suffix(')').unwrap().split_once("; features: ").unwrap();
    let is_hash = commit.len() == 12 && commit.chars().all(|c| c.is_ascii_hexdigit());
    assert!(is_hash || commit == "unknown", "{version}");
    let has = |name: &str| features.split(", ").any(|feature| feature == name);
    assert_eq!(has("report"), cfg!(feature = "report"), "{version}");
    assert_eq!(has("monitor"), cfg!(feature = "monitor"), "{version}");
    assert_eq!(has("mitsuba"), cfg!(feature = "mitsuba"), "{version}");
    assert!(!has("default"), "{version}");
}

/// Each example of the source tree that runs without a compiler is written, byte for byte.
#[test]
fn the_examples_are_those_of_the_source_tree() {
    let bench = Bench::new();
    let document = bench.boresight("examples --json").done().json();
    let written: Vec<&str> =
        document["files"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut compared = 0;
    for entry in fs::read_dir(root.join("examples")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if (name.ends_with(".py") || name.ends_with(".toml")) && name != "Cargo.toml" {
            assert!(written.contains(&name.as_str()), "{name} is missing in src/command/examples.rs");
            assert_eq!(fs::read(bench.path(&format!("examples/{name}"))).unwrap(), fs::read(path).unwrap());
            compared += 1;
        }
    }
    assert!(compared >= 10, "{compared} files");
    for name in written {
        assert!(bench.path(&format!("examples/{name}")).is_file(), "{name}");
    }
    bench.boresight("examples").refused(&["examples", "not empty"]);
    bench.boresight("examples --out other").done();
    bench.boresight("study check other/argon-optics.toml").done();
}

/// The links of a page to other files, without those inside of the page.
fn links(page: &str) -> Vec<&str> {
    let targets = page.split("<a href=\"").skip(1).filter_map(|rest| rest.split('"').next());
    targets.filter(|target| !target.starts_with('#')).collect()
}

/// The figures of the summary are those of the runs in the directory, and the runs are those of the built-in
/// scenarios: nothing is stored. No browser is opened, because standard output is not a terminal.
#[test]
#[cfg_attr(not(unix), ignore = "the opener of the test is a script")]
fn the_demo_shows_its_own_runs() {
    let mut bench = Bench::new();
    bench.write("bin/xdg-open", "#!/bin/sh\ntouch \"$OPENED\"\n");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(bench.path("bin/xdg-open"), fs::Permissions::from_mode(0o755)).unwrap();
    }
    let opened = bench.path("opened");
    bench.set("PATH", format!("{}:/usr/bin:/bin", bench.path("bin").display()));
    bench.set("DISPLAY", ":0");
    bench.set("OPENED", opened.clone());
    let summary = bench.boresight("demo --json --out demo").done().json();
    assert!(!opened.exists(), "a browser was opened");

    // Each half of the summary is the score of a run.
    let score = |folder: &str| bench.json(&format!("demo/{folder}/score.json"));
    let (best, paper, docking) = (score("far-range"), score("far-range-2012"), score("docking"));
    assert_eq!(summary["far_range"]["best"]["figures"], best["figures"]);
    assert_eq!(summary["far_range"]["paper"]["figures"], paper["figures"]);
    assert_eq!(summary["docking"]["figures"], docking["figures"]);
    // 426 images less 66 of the warm-up; 12 s of 50 fields a second, first and last included.
    assert_eq!(
        (&best["frames"], &paper["frames"], &docking["frames"]),
        (&360.into(), &360.into(), &601.into())
    );

    // Both methods have the same images, and the truth of the built-in scenario.
    bench.check_same("demo/far-range/truth/frames.parquet", "demo/far-range-2012/truth/frames.parquet");
    bench.boresight("render demo-far-range --frames 0..426 --out set --format png").done();
    bench.check_same("demo/far-range/truth/frames.parquet", "set/truth/frames.parquet");

    // The best method finds every target and beats the paper's.
    assert_eq!(figure(&best, "correct_rate"), 1.0);
    assert!(figure(&paper, "correct_rate") < 0.95);
    for (better, worse) in
        [("range_rms_m", "paper_range_rms_m"), ("attitude_rms_deg", "paper_attitude_rms_deg")]
    {
        assert!(figure(&docking, better) < figure(&docking, worse), "{better}");
    }

    // The page leads to reports that exist, and names the method of 2012 in its first figure.
    if cfg!(feature = "report") {
        let page = bench.read("demo/index.html");
        let targets = links(&page);
        assert_eq!(targets.len(), 3, "{targets:?}");
        for target in targets {
            assert!(bench.path(&format!("demo/{target}")).is_file(), "{target}");
        }
        let first = page.split("<figure class=\"chart\">").nth(1).unwrap().split("</figure>").next().unwrap();
        for part in ["best method (the default)", "method of the 2012 paper", "of the paper of 2012"] {
            assert!(first.contains(part), "{part} in the first figure");
        }
        assert_eq!(page.matches("<figure class=\"picture\">").count(), 6);
    }

    bench.boresight("demo --out demo").refused(&[
        "demo",
        "exists and is not empty",
        "nothing is overwritten",
    ]);
    bench.write("file", "mine");
    bench.boresight("demo --out file").refused(&["file", "exists and is not a directory"]);
    bench.boresight("demo --jobs 0").refused(&["--jobs", "0"]);
}

/// A command that the demo proposes exists.
#[test]
fn the_demo_proposes_commands_that_exist() {
    let source = include_str!("../../src/command/demo/mod.rs");
    let next = source.split("const NEXT").nth(1).unwrap().split("];").next().unwrap();
    let commands: Vec<&str> = next.split('"').filter(|text| text.starts_with("boresight ")).collect();
    assert_eq!(commands.len(), 3);
    for command in commands {
        let subcommand = command.split(' ').nth(1).unwrap();
        let help = Bench::new().boresight(&format!("{subcommand} --help")).done().stdout;
        for option in command.split(' ').filter(|word| word.starts_with("--")) {
            assert!(help.contains(option), "{command}");
        }
    }
}

/// The reproduction is the run of the built-in scenario, and states which rows are published.
#[test]
fn a_paper_is_reproduced_by_its_scenario() {
    let bench = Bench::new();
    let reproduced = bench.boresight("reproduce argon --frames 0..30 --no-report --out a").done();
    for part in ["Table 2", "`published`", "`best mode`"] {
        assert!(reproduced.stdout.contains(part), "{part} in\n{}", reproduced.stdout);
    }
    bench.boresight("run argon --frames 0..30 --no-report --out b").done();
    bench.check_same("a/score.json", "b/score.json");
    let reproduced = bench.boresight("reproduce docking --frames 20000..20020 --no-report --out c").done();
    assert!(reproduced.stdout.contains("no published rows"), "{}", reproduced.stdout);
    let run: Value = bench.json("c/score.json");
    assert_eq!(run["scenario"], "docking");
    bench.boresight("reproduce middle-range").refused(&["middle-range", "argon", "docking"]);
    bench.boresight("reproduce argon --frames 0..99999").refused(&["--frames is 0..99999", "0..16077"]);
}

/// The scenarios of the demo are reduced forms of `argon` and `docking`: the tables that describe the world
/// are the same.
#[test]
fn the_scenarios_of_the_demo_have_the_worlds_of_argon_and_docking() {
    let table = |name: &str| -> toml::Table {
        BUILT_IN.iter().find(|scenario| scenario.name == name).unwrap().text.parse().unwrap()
    };
    for (demo, original, different) in [
        ("demo-far-range", "argon", &["title", "schedule", "score", "far_range"][..]),
        ("demo-docking", "docking", &["title", "approach"][..]),
    ] {
        let (demo, original) = (table(demo), table(original));
        assert_eq!(demo.keys().collect::<Vec<_>>(), original.keys().collect::<Vec<_>>());
        for (key, value) in &original {
            assert_eq!(demo[key] == *value, !different.contains(&key.as_str()), "{key}");
        }
    }
}
