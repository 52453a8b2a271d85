//! Command-line arguments.

use super::{check_refused, check_refused_words, dataset};
use crate::support::Bench;

#[test]
fn frames_outside_the_scenario_are_refused() {
    let bench = Bench::new();
    for command in ["run", "render"] {
        let words = format!("{command} starting-point --frames 399..401 --out out");
        check_refused(&bench, &words, &["--frames is 399..401", "0..400"]);
    }
}

#[test]
fn an_empty_or_invalid_range_of_frames_is_refused() {
    for range in ["5..5", "9..3", "5", "..5", "a..b", "-1..3"] {
        let words = format!("run argon --frames={range} --out out");
        check_refused(&Bench::new(), &words, &["--frames", &format!("`{range}`"), "A..B with A < B"]);
    }
}

#[test]
fn a_file_without_requirements_is_refused() {
    let bench = Bench::new();
    let text = include_str!("../../../scenarios/requirements/uasc-far-range.toml");
    bench.write("none.toml", text.split("[[requirements]]").next().unwrap());
    check_refused(&bench, "visibility none.toml", &["none.toml", "[[requirements]]", "at least one"]);
}

/// Names may come from any source; terminal control characters in them are printed as numbers.
#[test]
fn a_name_sends_no_control_characters_to_a_terminal() {
    let bench = Bench::new();
    let name = "\u{1b}[2J\u{1b}]0;mine\u{7}day";
    bench.scenario("mine.toml", "argon", |table| table["schedule"][0]["name"] = name.into());
    let answer = bench.boresight("run mine.toml --frames 1620..1650 --out run --no-report").done();
    assert!(!answer.stdout.contains('\u{1b}') && !answer.stdout.contains('\u{7}'), "{}", answer.stdout);
    assert!(answer.stdout.contains("\\u{1b}[2J"), "{}", answer.stdout);
}

#[test]
fn a_pipeline_that_is_unknown_gets_the_nearest() {
    let bench = Bench::new();
    let words = "run argon --frames 0..2 --out run --pipeline far_rnage";
    check_refused(&bench, words, &["`far_rnage`", "`exec:COMMAND`", "did you mean `far_range`?"]);
    check_refused(&bench, &words.replace("far_rnage", "docking"), &["`docking`", "`far_range`"]);
}

#[test]
fn an_invalid_command_is_refused_before_anything_is_written() {
    let bench = dataset();
    for (command, part) in [("exec:", "empty"), ("exec:python3 'a", "quotation")] {
        let run = ["run", "argon", "--frames", "0..2", "--out", "run", "--pipeline", command];
        check_refused_words(&bench, &run, &[part]);
        check_refused_words(&bench, &["process", "set", "--pipeline", command], &[part]);
    }
}

#[test]
fn an_invalid_timeout_is_refused_before_anything_is_written() {
    for timeout in ["0", "-1", "nan", "inf"] {
        let words = format!("run argon --frames 0..2 --out run --pipeline exec:true --timeout-s={timeout}");
        check_refused(&Bench::new(), &words, &["timeout", "expected above 0"]);
    }
}

#[test]
fn arguments_out_of_their_range_are_refused() {
    let bench = Bench::new();
    for (argument, parts) in [
        ("--jobs 0", ["--jobs", "'0'"]),
        ("--jobs many", ["--jobs", "'many'"]),
        ("--seed -1", ["-1", "unexpected"]),
        ("--seed 1.5", ["--seed", "'1.5'"]),
        ("--save-frames jpg", ["--save-frames", "fits, png or exr"]),
        ("--job 2", ["--job", "--jobs"]),
    ] {
        check_refused(&bench, &format!("run argon --frames 0..2 --out run {argument}"), &parts);
    }
    check_refused(&bench, "fly argon", &["fly"]);
    check_refused(&bench, "run", &["SCENARIO"]);
    check_refused(&bench, "render argon", &["--out"]);
}

/// TOML has no larger integers: a run with a larger seed could not be read.
#[test]
fn every_seed_that_is_accepted_gives_a_run_that_is_read() {
    let bench = Bench::new();
    for command in ["run", "render"] {
        for seed in ["9223372036854775808", "18446744073709551615", "-1", "1.5"] {
            let words = format!("{command} starting-point --frames 0..1 --seed={seed} --out out");
            check_refused(&bench, &words, &["--seed", seed]);
        }
    }
    for (run, seed) in [("small", "0"), ("large", "9223372036854775807")] {
        bench
            .boresight(&format!("run starting-point --frames 0..1 --seed {seed} --out {run} --no-report"))
            .done();
        bench.boresight(&format!("score {run} {run}/measurements.csv")).done();
        assert!(bench.read(&format!("{run}/run.toml")).contains(&format!("seed = {seed}")), "{run}");
    }
}
