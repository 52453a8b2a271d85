//! `--sandbox`: a program can read its frames and its own files, but no truth, at any path.

use crate::support::Bench;

/// A program that answers every frame with a list of everything it could reach; it reads the image and a
/// module beside it in any case.
const CURIOUS: &str = r#"
import json, os, pathlib, socket, subprocess, sys, tempfile
import beside

json.loads(sys.stdin.readline())
print(json.dumps({"boresight_pipeline": 1, "name": "curious"}), flush=True)

def attempts(image):
    parent = f"/proc/{os.getppid()}"
    yield "truth", lambda: any(path.read_bytes() for path in pathlib.Path("out").rglob("run.toml"))
    yield "earlier truth", lambda: any(path.read_bytes() for path in pathlib.Path("earlier/truth").iterdir())
    yield "scenario", lambda: pathlib.Path("sky.toml").read_text()
    yield "command line", lambda: pathlib.Path(parent, "cmdline").read_text()
    yield "memory", lambda: open(f"{parent}/mem", "rb")
    yield "foreign folder", lambda: pathlib.Path(os.environ["FOREIGN"]).read_text()
    yield "variable", lambda: os.environ["BORESIGHT_SECRET"]
    yield "writing", lambda: pathlib.Path("left.txt").write_text("seen")
    yield "network", lambda: socket.create_connection(("127.0.0.1", int(os.environ["PORT"])), 5).close()
    yield "datagrams", lambda: socket.socket(socket.AF_INET, socket.SOCK_DGRAM).close()
    yield "shared memory", lambda: open("/dev/shm/boresight-sandbox-test", "wb").close()
    yield "simulator", lambda: subprocess.run(["boresight", "--version"], check=True, stdout=subprocess.DEVNULL)

for line in sys.stdin:
    asked = json.loads(line)
    assert pathlib.Path(asked["image"]).read_bytes()[:6] == b"SIMPLE" and beside.WORD == "own"
    with tempfile.NamedTemporaryFile() as file:
        file.write(b"own")
    reached = []
    for name, attempt in attempts(asked["image"]):
        try:
            if attempt() is not False:
                reached.append(name)
        except (OSError, KeyError):
            pass
    print(json.dumps({"frame": asked["frame"], "status": "failed: " + ",".join(reached or ["nothing"])}), flush=True)
"#;

/// Returns the list that the program could reach in a run.
fn reached(bench: &Bench, more: &str) -> String {
    let words = format!("run sky.toml --frames 0..2 --no-report {more}");
    let mut words: Vec<&str> = words.split_whitespace().collect();
    words.extend(["--pipeline", "exec:python3 curious.py"]);
    bench.boresight_words(&words).done();
    let out = words.iter().skip_while(|word| **word != "--out").nth(1).unwrap();
    bench.csv(&format!("{out}/measurements.csv"))[1]["status"].clone()
}

#[test]
fn the_truth_is_out_of_reach() {
    let mut bench = Bench::new();
    let elsewhere = Bench::new();
    elsewhere.write("notes.txt", "where the target is");
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    bench.set("FOREIGN", elsewhere.path("notes.txt"));
    bench.set("PORT", listener.local_addr().unwrap().port().to_string());
    bench.set("BORESIGHT_SECRET", "4");
    let program = std::path::Path::new(env!("CARGO_BIN_EXE_boresight")).parent().unwrap();
    let search_path = std::env::var_os("PATH").unwrap();
    let search_path = [program.to_owned()].into_iter().chain(std::env::split_paths(&search_path));
    bench.set("PATH", std::env::join_paths(search_path).unwrap());
    bench.scenario("sky.toml", "starting-point", |_| {});
    bench.write("curious.py", CURIOUS);
    bench.write("beside.py", "WORD = 'own'\n");
    bench.boresight("run sky.toml --frames 0..2 --out earlier --no-report").done();

    // Without a sandbox a program has the rights of its caller; Boresight's own environment variables are not
    // passed on.
    let all = reached(&bench, "--out out-1");
    let open = ["earlier truth", "scenario", "command line", "foreign folder", "writing", "network"];
    for name in open.into_iter().chain(["datagrams", "shared memory", "simulator"]) {
        assert!(all.contains(name), "{name}: {all}");
    }
    std::fs::remove_file("/dev/shm/boresight-sandbox-test").unwrap();
    assert!(!all.contains("variable"), "{all}");
    std::fs::remove_file(bench.path("left.txt")).unwrap();

    assert_eq!(reached(&bench, "--out out --sandbox"), "failed: nothing");
    assert!(!bench.path("left.txt").exists());

    let readable = elsewhere.path("").display().to_string();
    let more = format!("--out out-2 --sandbox --sandbox-read {readable}");
    assert_eq!(reached(&bench, &more), "failed: foreign folder");
}

/// A program that is started by its own name lies beside the scenario and the results, as a script does.
#[test]
fn the_folder_of_the_program_hides_the_truth_as_well() {
    let bench = Bench::new();
    bench.scenario("sky.toml", "starting-point", |_| {});
    bench.write("beside.py", "WORD = 'own'\n");
    bench.boresight("run sky.toml --frames 0..2 --out earlier --no-report").done();
    let words = ["run", "sky.toml", "--frames", "0..2", "--no-report", "--sandbox"];
    for (program, out) in [("curious", "out"), ("bin/curious", "out-bin")] {
        bench.write(
            program,
            format!("#!/usr/bin/env python3\n{}", CURIOUS.replace("\"out\"", &format!("{out:?}"))),
        );
        bench.write("bin/beside.py", "WORD = 'own'\n");
        make_executable(&bench, program);
        let pipeline = format!("exec:./{program}");
        let words: Vec<&str> = words.into_iter().chain(["--out", out, "--pipeline", &pipeline]).collect();
        bench.boresight_words(&words).done();
        assert_eq!(
            bench.csv(&format!("{out}/measurements.csv"))[1]["status"],
            "failed: nothing",
            "{program}"
        );
    }
}

fn make_executable(bench: &Bench, program: &str) {
    let permissions = std::os::unix::fs::PermissionsExt::from_mode(0o755);
    std::fs::set_permissions(bench.path(program), permissions).unwrap();
}

/// Copies the interpreter and its standard library to a directory.
const COPY_PYTHON: &str = r#"
import os, pathlib, shutil, sys, sysconfig

target, library = pathlib.Path(sys.argv[1]), pathlib.Path(sysconfig.get_path("stdlib"))
left_out = shutil.ignore_patterns("test", "*-packages", "__pycache__", "idlelib", "tkinter", "config-*")
shutil.copytree(library, target / "lib" / library.name, ignore=left_out)
(target / "bin").mkdir()
shutil.copy(os.path.realpath(sys.executable), target / "bin" / "python3")
"#;

/// Python environments outside the search path, based on a Python outside it: a script of the environment,
/// and an environment with a copy of the interpreter in place of a link to it.
#[test]
fn a_python_environment_outside_the_search_path_starts() {
    let mut bench = Bench::new();
    bench.scenario("sky.toml", "starting-point", |_| {});
    let base = Bench::new();
    base.write("copy_python.py", COPY_PYTHON);
    let copied = std::process::Command::new("/usr/bin/python3")
        .arg(base.path("copy_python.py"))
        .arg(base.path("python"))
        .status();
    assert!(copied.unwrap().success());
    let python = base.path("python/bin/python3").display().to_string();
    bench.set("PATH", "/usr/bin:/bin");
    bench.write("beside.py", "WORD = 'own'\n");
    for (environment, options) in [("linked", "--symlinks"), ("copied", "--copies")] {
        let made = std::process::Command::new(&python)
            .args(["-m", "venv", options, "--without-pip"])
            .arg(base.path(environment))
            .status();
        assert!(made.unwrap().success());
        let interpreter = base.path(environment).join("bin/python3").display().to_string();
        bench.write(environment, format!("#!{interpreter}\n{CURIOUS}"));
        make_executable(&bench, environment);
        bench.write("curious.py", CURIOUS);
        for (index, command) in
            [format!("{interpreter} curious.py"), format!("./{environment}")].iter().enumerate()
        {
            let out = format!("out-{environment}-{index}");
            let pipeline = format!("exec:{command}");
            let words = [
                "run",
                "sky.toml",
                "--frames",
                "0..2",
                "--no-report",
                "--sandbox",
                "--out",
                &out,
                "--pipeline",
                &pipeline,
            ];
            bench.boresight_words(&words).done();
            assert_eq!(
                bench.csv(&format!("{out}/measurements.csv"))[1]["status"],
                "failed: nothing",
                "{command}"
            );
        }
    }
    // What a program lacks nevertheless is named, with the remedy.
    bench.write("mine.py", format!("import sys\nsys.path.append({:?})\nimport weights\n", base.path("own")));
    base.write("own/weights.py", "");
    let words =
        ["run", "sky.toml", "--frames", "0..3", "--no-report", "--sandbox", "--out", "out", "--pipeline"];
    let words: Vec<&str> = words.into_iter().chain(["exec:python3 mine.py"]).collect();
    bench.boresight_words(&words).refused(&["No module named 'weights'", "--sandbox-read"]);
}

#[test]
fn a_dataset_hides_its_truth_as_well() {
    let bench = Bench::new();
    bench.scenario("sky.toml", "starting-point", |_| {});
    bench.boresight("render sky.toml --frames 0..2 --out data").done();
    let peeking = CURIOUS.replace("\"out\"", "\"data\"").replace("earlier/truth", "data/truth");
    bench.write("curious.py", peeking);
    bench.write("beside.py", "WORD = 'own'\n");
    let words =
        ["process", "data", "--out", "mine.csv", "--sandbox", "--pipeline", "exec:python3 curious.py"];
    bench.boresight_words(&words).done();
    assert_eq!(bench.csv("mine.csv")[0]["status"], "failed: scenario");
}

/// A blind run has a seed that the program cannot know, and can be repeated afterwards.
#[test]
fn a_blind_run_draws_a_secret_seed() {
    let bench = Bench::new();
    bench.scenario("sky.toml", "starting-point", |_| {});
    bench.write("curious.py", CURIOUS);
    bench.write("beside.py", "WORD = 'own'\n");
    let blind = |out: &'static str| {
        let words =
            ["run", "sky.toml", "--frames", "0..1", "--no-report", "--out", out, "--sandbox", "--blind"];
        let words: Vec<&str> = words.into_iter().chain(["--pipeline", "exec:python3 curious.py"]).collect();
        bench.boresight_words(&words).done();
        assert_eq!(bench.csv(&format!("{out}/measurements.csv"))[0]["status"], "failed: nothing");
        let run = bench.read(&format!("{out}/run.toml"));
        let seed = run.lines().find_map(|line| line.strip_prefix("seed = ")).unwrap();
        seed.parse::<u64>().unwrap()
    };
    let seeds = ["out-1", "out-2"].map(blind);
    assert!(seeds[0] != seeds[1] && seeds.iter().all(|seed| *seed > 1_000_000), "{seeds:?}");
    let words = format!("run sky.toml --frames 0..1 --no-report --out again --seed {}", seeds[0]);
    bench.boresight(&words).done();
    assert_eq!(bench.tree("again/truth"), bench.tree("out-1/truth"));

    bench.boresight("run sky.toml --out out-3 --blind").refused(&["--sandbox"]);
}

#[test]
fn a_path_to_be_read_needs_a_sandbox() {
    let bench = Bench::new();
    let words = "run argon --frames 0..1 --out out --pipeline exec:true --sandbox-read .";
    bench.boresight(words).refused(&["--sandbox"]);
}

/// Runs its arguments as if the kernel had no Landlock: a seccomp filter answers `landlock_create_ruleset`
/// with ENOSYS.
const WITHOUT_LANDLOCK: &str = r#"
import ctypes, os, struct, sys

LOAD, EQUAL, RETURN = 0x20, 0x15, 0x06
CREATE_RULESET, ENOSYS = 444, 38
steps = [(LOAD, 0, 0, 0), (EQUAL, 0, 1, CREATE_RULESET), (RETURN, 0, 0, 0x00050000 | ENOSYS), (RETURN, 0, 0, 0x7FFF0000)]
code = ctypes.create_string_buffer(b"".join(struct.pack("HBBI", *step) for step in steps))

class Program(ctypes.Structure):
    _fields_ = [("length", ctypes.c_ushort), ("code", ctypes.c_void_p)]

libc = ctypes.CDLL(None, use_errno=True)
assert libc.prctl(38, 1, 0, 0, 0) == 0, "PR_SET_NO_NEW_PRIVS"
filter = Program(len(steps), ctypes.addressof(code))
assert libc.prctl(22, 2, ctypes.byref(filter), 0, 0) == 0, "PR_SET_SECCOMP"
os.execv(sys.argv[1], sys.argv[1:])
"#;

#[cfg(target_os = "linux")]
#[test]
fn a_kernel_that_cannot_enforce_it_ends_the_command() {
    let bench = Bench::new();
    bench.scenario("sky.toml", "starting-point", |_| {});
    bench.write("without.py", WITHOUT_LANDLOCK);
    bench.write("own.py", "");
    let run = |more: &[&str]| {
        let mut command = std::process::Command::new("python3");
        command.arg("without.py").arg(env!("CARGO_BIN_EXE_boresight")).current_dir(bench.path(""));
        command.args(["run", "sky.toml", "--frames", "0..2", "--no-report"]).args(more);
        command.output().unwrap()
    };
    let refused = run(&["--out", "out", "--sandbox", "--pipeline", "exec:python3 own.py"]);
    let told = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{told}");
    assert!(told.contains("Landlock"), "{told}");
    assert!(!bench.path("out").exists());
    // The filter blocks nothing else.
    assert_eq!(run(&["--out", "out"]).status.code(), Some(0));
}
