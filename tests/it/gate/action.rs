//! The script of the action for GitHub, run with a program that prints what a hostile run makes a gate print.

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

/// Returns the script of the action's step that compares.
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

/// Makes a wheel `boresight-0.0.1-py3-none-any.whl`, whose command prints `boresight 0.0.1`, in the folder of
/// its first argument.
const MAKE_WHEEL: &str = r#"
import sys, zipfile
name = "boresight-0.0.1"
files = {
    "boresight.py": "def main():\n    print('boresight 0.0.1')\n",
    f"{name}.dist-info/METADATA": "Metadata-Version: 2.1\nName: boresight\nVersion: 0.0.1\n",
    f"{name}.dist-info/WHEEL":
        "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
    f"{name}.dist-info/entry_points.txt": "[console_scripts]\nboresight = boresight:main\n",
}
files[f"{name}.dist-info/RECORD"] = "".join(f"{path},,\n" for path in files)
with zipfile.ZipFile(f"{sys.argv[1]}/{name}-py3-none-any.whl", "w") as wheel:
    for path, text in files.items():
        wheel.writestr(path, text)
"#;

/// Runs the script of the action `install` in `folder`, which is also the folder of the job's files.
fn install(folder: &Path, wheel: &str, version: &str) -> Output {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join(".github/actions/install/install.sh");
    Command::new("bash")
        .arg(script)
        .current_dir(folder)
        .env("WHEEL", wheel)
        .env("VERSION", version)
        .env("RUNNER_TEMP", folder)
        .env("GITHUB_PATH", folder.join("path"))
        .env("GITHUB_OUTPUT", folder.join("output"))
        .output()
        .unwrap()
}

#[test]
fn inputs_of_the_installation_that_are_no_wheel_and_no_version_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (wheel, version, message) in [
        ("", "", "expected exactly one of the inputs"),
        ("a.whl", "0.1.0", "expected exactly one of the inputs"),
        ("missing.whl", "", "no file \"missing.whl\""),
        ("", "0.1.0 --index-url x", "expected a version such as 0.1.0"),
    ] {
        let done = install(folder.path(), wheel, version);
        let error = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(2), "{error}");
        assert!(error.contains(message), "{error}");
    }
}

/// Needs Python with venv: `.ci/gates`.
#[test]
#[ignore = "needs Python with venv"]
fn the_command_of_a_wheel_is_put_on_the_path() {
    let folder = tempfile::tempdir().unwrap();
    let made = Command::new("python3").args(["-c", MAKE_WHEEL]).arg(folder.path()).status().unwrap();
    assert!(made.success());
    let done = install(folder.path(), "boresight-0.0.1-py3-none-any.whl", "");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let added = std::fs::read_to_string(folder.path().join("path")).unwrap();
    let printed = Command::new(Path::new(added.trim()).join("boresight")).output().unwrap();
    assert_eq!(String::from_utf8(printed.stdout).unwrap().trim(), "boresight 0.0.1");
    let output = std::fs::read_to_string(folder.path().join("output")).unwrap();
    assert_eq!(output, format!("program={}/boresight\n", added.trim()));
}
