//! External pipeline programs with the worst faults: each loses its frames with a reason, stays within the
//! limits of time and memory, and leaves nothing behind. In `run` and `process` of both worlds, and in
//! studies.

use std::os::unix::process::ExitStatusExt;
use std::process::Command;
use std::time::{Duration, Instant};

use crate::support::{Answer, Bench};

/// Common beginning of all programs of this suite: `note` records the numbers of their processes, `hello`
/// sends a correct greeting, `ask` returns the number of the next frame, `none` answers it.
const PRELUDE: &str = r#"
import json, os, signal, subprocess, sys, time
def note(pid):
    with open(os.environ["PIDS"], "a") as file:
        file.write(f"{pid}\n")
note(os.getpid())
def ask():
    line = sys.stdin.readline()
    if not line:
        sys.exit()
    request = json.loads(line)
    return request.get("frame", request.get("field"))
def say(text):
    sys.stdout.write(text + "\n")
    sys.stdout.flush()
def hello():
    ask()
    say('{"boresight_pipeline": 1, "name": "faulty"}')
def none(number):
    say(json.dumps({KEY: number, "status": "no_target"}))
"#;

/// A faulty program, and the reason reported for it.
struct Faulty {
    name: &'static str,
    body: &'static str,
    reason: &'static str,
}

const fn faulty(name: &'static str, body: &'static str, reason: &'static str) -> Faulty {
    Faulty { name, body, reason }
}

const LATE: &str = "it gave no answer within 1 s";

impl Faulty {
    /// Short for programs that give no answer; long for programs that end by themselves, on a busy machine.
    fn timeout_s(&self) -> &'static str {
        if self.reason.starts_with(LATE) { "1" } else { "30" }
    }
}

/// Programs that answer no frame.
const PROGRAMS: [Faulty; 14] = [
    faulty("hangs", "hello()\nask()\ntime.sleep(100)", LATE),
    faulty(
        "hangs on every signal but one",
        "for s in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGPIPE):\n    signal.signal(s, signal.SIG_IGN)\nhello()\nask()\nwhile True:\n    time.sleep(100)",
        LATE,
    ),
    faulty(
        "crashes",
        "hello()\nask()\nsys.exit('the film is full')",
        "exit status: 1; last error output: the film is full",
    ),
    faulty(
        "dies of a signal",
        "hello()\nask()\nos.kill(os.getpid(), signal.SIGABRT)",
        "it ended with signal: 6",
    ),
    faulty(
        "says garbage before it dies",
        "hello()\nask()\nsay('\\x00\\x07 Paris')\nsys.exit(0)",
        "cannot be read",
    ),
    faulty(
        "floods its output with one endless line",
        "hello()\nask()\nwhile True:\n    sys.stdout.write('x' * 65536)",
        "it wrote a line longer than 1048576 bytes",
    ),
    faulty(
        "floods its error output and does not answer",
        "hello()\nask()\nwhile True:\n    sys.stderr.write('grumble ' * 8192 + '\\n')",
        LATE,
    ),
    faulty("answers far too late", "hello()\nn = ask()\ntime.sleep(3)\nnone(n)\ntime.sleep(100)", LATE),
    faulty(
        "speaks before it is asked",
        // In the same write as the greeting: a later line could be mistaken for the answer to the first
        // request.
        "ask()\nsay('{\"boresight_pipeline\": 1, \"name\": \"faulty\"}\\n{}\\n{}')\ntime.sleep(100)",
        "it wrote a line without a request",
    ),
    faulty(
        "closes its output and lives on",
        "hello()\nask()\nos.close(1)\ntime.sleep(100)",
        "it closed its output",
    ),
    faulty("never reads what it is asked", "hello()\ntime.sleep(100)", LATE),
    faulty(
        "leaves a child that holds its pipes",
        "hello()\nask()\nnote(subprocess.Popen(['sleep', '100']).pid)\nos._exit(3)",
        "it gave no answer within 1 s, and had ended with exit status: 3",
    ),
    faulty(
        "moves into the group of whoever started it",
        "hello()\nask()\nos.setpgid(0, os.getpgid(os.getppid()))\ntime.sleep(100)",
        LATE,
    ),
    faulty(
        "takes all the memory there is",
        "hello()\nask()\nhoard = []\nfor i in range(300):\n    hoard.append(bytearray(10_000_000))\ntime.sleep(100)",
        "MemoryError",
    ),
];

/// Memory limit of a program, MB: enough for Python, less than the memory hoarder would use.
const MEMORY_MB: &str = "500";

struct World {
    key: &'static str,
    scenario: &'static str,
    frames: &'static str,
    count: usize,
}

const FAR_RANGE: World = World { key: "frame", scenario: "starting-point", frames: "100..103", count: 3 };
const DOCKING: World = World { key: "field", scenario: "docking", frames: "18000..18003", count: 3 };

fn write_program(bench: &Bench, world: &World, body: &str) {
    bench.write("program.py", format!("KEY = \"{}\"\n{PRELUDE}\n{body}\n", world.key));
}

/// Runs the command with the external program; checks that all its processes are gone when the command ends.
fn with_program(bench: &Bench, words: &[&str], timeout_s: &str) -> Answer {
    bench.write("pids", "");
    let limits = ["--timeout-s", timeout_s, "--memory-mb", MEMORY_MB];
    // Set by `env`, because all suites start the command in the same way.
    let pipeline = format!("exec:env PIDS={} python3 program.py", bench.path("pids").display());
    let begun = Instant::now();
    let words = [words, &["--pipeline", &pipeline], &limits].concat();
    let answer = bench.boresight_words(&words);
    // Start, greeting and one time limit per frame, on a busy machine.
    assert!(begun.elapsed() < Duration::from_secs(60), "{words:?} took {:?}", begun.elapsed());
    check_none_left(bench);
    answer
}

/// Checks that none of the processes noted by the programs is running.
fn check_none_left(bench: &Bench) {
    let pids = bench.read("pids");
    assert!(!pids.is_empty(), "the program was not started");
    let deadline = Instant::now() + Duration::from_secs(5);
    for pid in pids.lines() {
        while is_running(pid) {
            assert!(Instant::now() < deadline, "the process {pid} of {pids:?} was left");
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}

/// Returns true if a process is running; a zombie that its adoptive parent has not reaped does not count.
fn is_running(pid: &str) -> bool {
    let output = Command::new("ps").args(["-o", "stat=", "-p", pid]).output().unwrap();
    let state = String::from_utf8(output.stdout).unwrap();
    !state.trim().is_empty() && !state.trim_start().starts_with('Z')
}

/// Checks that every frame has a row with a failure for the given reason.
fn check_rows(bench: &Bench, name: &str, measurements: &str, world: &World, reason: &str) {
    let rows = bench.csv(measurements);
    assert_eq!(rows.len(), world.count, "{name}");
    for row in rows {
        let status = &row["status"];
        assert!(status.starts_with("failed: "), "{name}: {status}");
        // The last output before its death costs one frame, the death costs the others.
        assert!(status.contains(reason) || status.contains("it ended with"), "{name}: {status}");
    }
    assert!(bench.read(measurements).contains(reason), "{name}: {}", bench.read(measurements));
}

/// Checks each program, several concurrently: most of the time is spent waiting for them.
fn with_each(check: impl Fn(&Faulty) + Sync) {
    const AT_A_TIME: usize = 4;
    std::thread::scope(|scope| {
        for first in 0..AT_A_TIME {
            let check = &check;
            scope.spawn(move || PROGRAMS.iter().skip(first).step_by(AT_A_TIME).for_each(check));
        }
    });
}

fn check_runs(world: &World) {
    with_each(|faulty @ Faulty { name, body, reason }| {
        let bench = Bench::new();
        write_program(&bench, world, body);
        let answer = with_program(
            &bench,
            &["run", world.scenario, "--frames", world.frames, "--out", "run", "--no-report"],
            faulty.timeout_s(),
        );
        assert!(answer.stderr.contains("the pipeline failed, first at frame"), "{name}: {}", answer.stderr);
        answer.done();
        check_rows(&bench, name, "run/measurements.csv", world, reason);
        let score = bench.json("run/score.json");
        assert_eq!(score["frames"], world.count, "{name}");
    });
}

#[test]
fn in_a_far_range_run_each_failure_is_an_outcome_with_its_reason_and_no_process_is_left() {
    check_runs(&FAR_RANGE);
}

#[test]
fn in_a_docking_run_each_failure_is_an_outcome_with_its_reason_and_no_process_is_left() {
    check_runs(&DOCKING);
}

#[test]
fn over_a_dataset_each_failure_is_an_outcome_with_its_reason_and_no_process_is_left() {
    for world in [FAR_RANGE, DOCKING] {
        let rendered = Bench::new();
        let words = format!("render {} --frames {} --format png --out set", world.scenario, world.frames);
        rendered.boresight(&words).done();
        let set = rendered.path("set").to_str().unwrap().to_owned();
        with_each(|faulty @ Faulty { name, body, reason }| {
            let bench = Bench::new();
            write_program(&bench, &world, body);
            let out = "answers/measurements.csv";
            std::fs::create_dir(bench.path("answers")).unwrap();
            with_program(&bench, &["process", &set, "--out", out], faulty.timeout_s()).done();
            check_rows(&bench, name, out, &world, reason);
        });
    }
}

/// A study continues past a failing program, reports the affected cases, and gives the same results when it
/// is run again.
#[test]
fn in_a_study_each_failure_is_a_failed_case_and_the_study_continues() {
    with_each(|faulty @ Faulty { name, body, .. }| {
        let bench = Bench::new();
        bench.write(
            "study.toml",
            "title = \"two frames\"\nscenario = \"starting-point\"\nseed = 5\nframes = \"100..102\"\n[stop]\ncases = 2\n\
             [[vary]]\npath = \"psf.sigma_px\"\ndistribution = { kind = \"uniform\", min = 0.7, max = 0.9 }\n",
        );
        write_program(&bench, &FAR_RANGE, body);
        let answer = with_program(
            &bench,
            &["study", "run", "study.toml", "--out", "study", "--json", "--no-report"],
            faulty.timeout_s(),
        );
        assert!(answer.stderr.contains("the pipeline failed, first in case 0"), "{name}: {}", answer.stderr);
        let summary = answer.done().json();
        assert_eq!((&summary["cases"], &summary["failed_cases"]), (&2.into(), &2.into()), "{name}");
        assert_eq!(summary["figures"]["hit_rate"]["all"]["value"], 0.0, "{name}");
    });
}

/// Programs that never send a greeting: a missing program, one that ends, and one with another version.
const NEVER_GREET: [(&str, &str); 3] = [
    ("exec:python3 missing.py", "missing.py"),
    ("exec:python3 -c 'raise SystemExit(\"no film\")'", "no film"),
    (
        r#"exec:sh -c 'read line; echo "{\"boresight_pipeline\": 2, \"name\": \"x\"}"; read line'"#,
        "version 2",
    ),
];

/// A program that does not start ends a run after three frames: these are scored, the others are not run, and
/// none of the latter is a miss.
#[test]
fn a_program_that_never_greets_ends_a_run_in_both_worlds() {
    for (scenario, frames) in [("starting-point", "100..110"), ("docking", "18000..18010")] {
        for (pipeline, reason) in NEVER_GREET {
            let bench = Bench::new();
            let run =
                ["run", scenario, "--frames", frames, "--out", "run", "--no-report", "--pipeline", pipeline];
            let parts =
                ["failed to start 3 times in a row", reason, "3 frames were run and scored, 7 were not run"];
            bench.boresight_words(&run).refused(&parts);
            let rows = bench.csv("run/measurements.csv");
            assert_eq!(rows.len(), 3);
            assert!(rows.iter().all(|row| row["status"].contains(reason)), "{rows:?}");
            let score = bench.json("run/score.json");
            assert_eq!((&score["frames"], &score["not_flown"]["frames"]), (&3.into(), &7.into()));
            assert!(score["not_flown"]["reason"].as_str().unwrap().contains(reason), "{score}");
            // The partial run can be used like any other run.
            let again = bench.boresight("score run run/measurements.csv --json").done();
            assert!(again.stderr.contains("7 were not run"), "{}", again.stderr);
            assert_eq!(again.json()["not_flown"], score["not_flown"]);
            bench.boresight("report run -o report.html").done();
            assert!(
                bench.read("report.html").contains("The run is not complete: the pipeline failed to start")
            );
        }
    }
}

/// A run too short for three starts is incomplete as well.
#[test]
fn a_run_of_two_frames_without_a_start_is_refused() {
    let bench = Bench::new();
    let run = "run starting-point --frames 100..102 --out run --no-report --json --pipeline".split(' ');
    let words: Vec<&str> = run.chain(["exec:python3 missing.py"]).collect();
    let answer = bench.boresight_words(&words);
    let score = answer.json();
    answer.refused(&["failed to start 2 times in a row", "0 were not run"]);
    assert_eq!(score["not_flown"]["frames"], 0);
}

/// One failed start costs its frame; the program is started again, because it has no state yet.
#[test]
fn a_program_that_starts_late_is_used() {
    let bench = Bench::new();
    let body = "if len(open(os.environ['PIDS']).readlines()) < 3:\n    sys.exit('not yet')\nhello()\nwhile True:\n    none(ask())";
    write_program(&bench, &FAR_RANGE, body);
    let words = ["run", "starting-point", "--frames", "100..105", "--out", "run", "--no-report"];
    with_program(&bench, &words, "30").done();
    let rows = bench.csv("run/measurements.csv");
    let statuses: Vec<&str> = rows.iter().map(|row| row["status"].as_str()).collect();
    assert!(statuses[..2].iter().all(|status| status.contains("not yet")), "{statuses:?}");
    assert_eq!(statuses[2..], ["no_target"; 3]);
    assert!(bench.json("run/score.json").get("not_flown").is_none());
}

/// For a dataset nothing is written: there is no truth with which the frames could be scored.
#[test]
fn a_program_that_never_greets_answers_no_dataset() {
    for (scenario, frames) in [("starting-point", "100..105"), ("docking", "18000..18005")] {
        let bench = Bench::new();
        bench.boresight(&format!("render {scenario} --frames {frames} --format png --out set")).done();
        for out in ["answers.csv", "-"] {
            if out == "-" && scenario != "docking" {
                continue;
            }
            let words = ["process", "set", "--out", out, "--pipeline", "exec:python3 missing.py"];
            bench.boresight_words(&words).refused(&["failed to start 3 times in a row", "missing.py"]);
        }
        assert!(!bench.path("answers.csv").exists());
    }
}

/// A case without a start is a failed row of its three frames, as in its replay; ten such cases before any
/// other end the study.
#[test]
fn cases_without_a_start_are_failed_rows_and_the_first_ten_end_a_study() {
    let study = |cases: u64| {
        format!(
            "title = \"four frames\"\nscenario = \"starting-point\"\nseed = 5\nframes = \"100..104\"\n[stop]\ncases = {cases}\n\
             [[vary]]\npath = \"psf.sigma_px\"\ndistribution = {{ kind = \"uniform\", min = 0.7, max = 0.9 }}\n"
        )
    };
    let bench = Bench::new();
    let run = |cases: u64, out: &str, more: &[&str]| {
        bench.write("study.toml", study(cases));
        let words = ["study", "run", "study.toml", "--out", out, "--json", "--no-report", "--pipeline"];
        bench.boresight_words(&[words.as_slice(), &["exec:python3 missing.py"], more].concat())
    };
    let summary = run(9, "nine", &[]).done().json();
    assert_eq!((&summary["cases"], &summary["failed_cases"]), (&9.into(), &9.into()));
    let replay =
        ["study", "replay", "study.toml", "--case", "8", "--out", "replay", "--no-report", "--pipeline"];
    let replay = bench.boresight_words(&[replay.as_slice(), &["exec:python3 missing.py"]].concat());
    replay.refused(&["failed to start 3 times in a row", "1 were not run"]);
    assert_eq!(bench.json("replay/score.json")["frames"], 3);
    for (out, more) in [("whole", [].as_slice()), ("pieces", &["--shards", "6"]), ("one", &["--jobs", "1"])] {
        run(12, out, more).refused(&["did not start in any of the first 10 cases", "missing.py"]);
        assert!(!bench.path(&format!("{out}/cases.parquet")).exists(), "{out}");
    }
}

/// An unusable answer costs only its frame.
#[test]
fn invalid_output_fails_only_its_frame_in_both_worlds() {
    let body = "hello()\nfor text in ('Paris', '[1, 2', '{\"KEY\": 99, \"status\": \"no_target\"}'):\n    n = ask()\n    \
                say(text.replace('KEY', KEY))\nwhile True:\n    none(ask())";
    for (world, frames) in [(FAR_RANGE, "100..105"), (DOCKING, "18000..18005")] {
        let bench = Bench::new();
        write_program(&bench, &world, body);
        let words = ["run", world.scenario, "--frames", frames, "--out", "run", "--no-report"];
        with_program(&bench, &words, "30").done();
        let rows = bench.csv("run/measurements.csv");
        let statuses: Vec<&str> = rows.iter().map(|row| row["status"].as_str()).collect();
        for (status, part) in statuses.iter().zip(["Paris", "[1, 2", "99"]) {
            assert!(status.starts_with("failed: ") && status.contains(part), "{status}");
        }
        assert_eq!(statuses[3..], ["no_target", "no_target"]);
    }
}

/// An endless stream of lines fills a queue of four and then the pipe; an endless line ends at a mebibyte.
/// The command itself is limited to 700 MB here: it would take seconds to read more than that from a program
/// that writes as fast as possible.
#[test]
fn a_flood_takes_no_memory() {
    for (body, reason) in [
        ("hello()\nask()\nwhile True:\n    os.write(1, b'x' * 65536)", "it wrote a line longer"),
        ("hello()\nask()\nwhile True:\n    os.write(1, b'{}\\n' * 20000)", "cannot be read"),
        (
            "hello()\nask()\nwhile True:\n    os.write(2, b'grumble\\n' * 8000)",
            "it gave no answer within 3 s",
        ),
        ("while True:\n    os.write(1, b'x' * 65536)", "during the greeting, it wrote a line longer"),
    ] {
        let bench = Bench::new();
        write_program(&bench, &FAR_RANGE, body);
        bench.write("pids", "");
        let script = format!(
            "ulimit -d 700000 && exec '{}' run starting-point --frames 100..103 --jobs 1 --no-report --out run \
             --timeout-s 3 --pipeline 'exec:env PIDS={} python3 program.py'",
            assert_cmd::cargo::cargo_bin!("boresight").display(),
            bench.path("pids").display(),
        );
        let output = Command::new("sh").args(["-c", &script]).current_dir(bench.path("")).output().unwrap();
        let expected = if reason.starts_with("during the greeting") { 2 } else { 0 };
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(expected), "{body}\n{told}");
        check_none_left(&bench);
        let status = bench.csv("run/measurements.csv")[0]["status"].clone();
        assert!(status.contains(reason), "{body}: {status}");
    }
}

/// The limit can be set for a program, and applies to its children too.
#[test]
fn memory_is_limited_as_requested_in_children_too() {
    let hoard = "hello()\nn = ask()\nhoard = bytearray(200_000_000)\nnone(n)\nwhile True:\n    none(ask())";
    let child = "hello()\nn = ask()\nchild = subprocess.run([sys.executable, '-c', 'bytearray(200_000_000)'])\n\
                 if child.returncode:\n    sys.exit('the child had no memory')\nnone(n)\nwhile True:\n    none(ask())";
    for body in [hoard, child] {
        for (memory_mb, has_failed) in [("100", true), ("1000", false)] {
            let bench = Bench::new();
            write_program(&bench, &FAR_RANGE, body);
            bench.write("pids", "");
            let pipeline = format!("exec:env PIDS={} python3 program.py", bench.path("pids").display());
            let words = ["run", "starting-point", "--frames", "100..102", "--out", "run", "--no-report"];
            let more = ["--pipeline", &pipeline, "--memory-mb", memory_mb];
            bench.boresight_words(&[words.as_slice(), &more].concat()).done();
            let statuses = bench.read("run/measurements.csv");
            assert_eq!(statuses.contains("failed: "), has_failed, "{memory_mb} MB: {statuses}");
            assert!(!has_failed || statuses.contains("emory"), "{memory_mb} MB: {statuses}");
        }
    }
    let bench = Bench::new();
    for memory_mb in ["0", "1000001"] {
        let words = format!(
            "run starting-point --frames 0..2 --out run --pipeline exec:true --memory-mb {memory_mb}"
        );
        bench.boresight(&words).refused(&["memory_mb", memory_mb, "1 to 1e6"]);
    }
    assert!(!bench.path("run").exists());
}

/// When requested to end, the command also ends its programs, even hanging programs and their children, which
/// receive no interrupt from a terminal.
#[test]
fn programs_end_with_a_command_that_is_interrupted() {
    for signal in ["INT", "TERM", "HUP"] {
        let bench = Bench::new();
        let body = "signal.signal(signal.SIGINT, signal.SIG_IGN)\nhello()\nask()\n\
                    note(subprocess.Popen(['sleep', '100']).pid)\nnote(os.getpid())\ntime.sleep(100)";
        write_program(&bench, &FAR_RANGE, body);
        bench.write("pids", "");
        let pipeline = format!("exec:env PIDS={} python3 program.py", bench.path("pids").display());
        let mut child = Command::new(assert_cmd::cargo::cargo_bin!("boresight"))
            .args(["run", "starting-point", "--frames", "100..103", "--out", "run", "--timeout-s", "100"])
            .args(["--pipeline", &pipeline])
            .current_dir(bench.path(""))
            .spawn()
            .unwrap();
        let deadline = Instant::now() + Duration::from_secs(30);
        while bench.read("pids").lines().count() < 3 {
            assert!(Instant::now() < deadline, "the program did not come so far");
            std::thread::sleep(Duration::from_millis(5));
        }
        let sent =
            Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status().unwrap();
        assert!(sent.success());
        let status = child.wait().unwrap();
        assert!(status.signal().is_some(), "{signal}: {status}");
        check_none_left(&bench);
    }
}
