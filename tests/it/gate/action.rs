//! The script of the action for GitHub, run with a program that prints what a hostile run makes a gate print.

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

/// Returns the script of the action's only step.
fn script() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(".github/actions/gate/action.yml");
    let action = std::fs::read_to_string(path).unwrap();
    let (_, script) = action.split_once("      run: |\n").unwrap();
    script.lines().map(|line| format!("{}\n", line.strip_prefix("        ").unwrap_or(line))).collect()
}

/// Returns the verdict, the summary and the exit status of the action for a gate that prints `text` and ends
/// with `status`.
fn verdict_of(text: &str, status: i32) -> (String, String, i32) {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("text"), text).unwrap();
    let program = format!("#!/bin/sh\ncat '{}'\nexit {status}\n", at("text").display());
    std::fs::write(at("program"), program).unwrap();
    std::fs::set_permissions(at("program"), std::fs::Permissions::from_mode(0o755)).unwrap();
    let done = Command::new("bash")
        .args(["-e", "-o", "pipefail", "-c", &script()])
        .env("PROGRAM", at("program"))
        .env("BASELINE", "baseline")
        .env("RESULT", "result")
        .env("ARGUMENTS", "")
        .env("JUNIT", at("gate.xml"))
        .env("GITHUB_OUTPUT", at("output"))
        .env("GITHUB_STEP_SUMMARY", at("summary"))
        .output()
        .unwrap();
    let output = std::fs::read_to_string(at("output")).unwrap();
    let summary = std::fs::read_to_string(at("summary")).unwrap();
    (output.trim().to_owned(), summary, done.status.code().unwrap())
}

/// A reason in an answer, and the reason of a baseline, are printed below the verdict.
#[test]
fn texts_of_a_run_do_not_change_the_verdict_of_the_action() {
    let text = "argon: WORSE: hit rate\n 7  day 1  failed: x: CHANGED: y\nBaseline: a\nargon: CHANGED: b\n";
    let (verdict, _, status) = verdict_of(text, 1);
    assert_eq!((verdict.as_str(), status), ("verdict=worse", 1));
    let (verdict, ..) = verdict_of("argon: CHANGED: mean across columns\n 7  failed: x: WORSE: y\n", 1);
    assert_eq!(verdict, "verdict=changed");
    assert_eq!(verdict_of("argon: no worse\nx: WORSE: y\n", 0).0, "verdict=no_worse");
    assert_eq!(verdict_of("", 2).0, "verdict=cannot_compare");
}

#[test]
fn texts_of_a_run_stay_in_the_code_of_the_summary() {
    let (_, summary, _) = verdict_of("argon: no worse\n~~~\n# heading\n", 0);
    assert!(summary.lines().all(|line| line.is_empty() || line.starts_with("    ")), "{summary}");
}
