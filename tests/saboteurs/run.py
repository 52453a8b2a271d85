#!/usr/bin/env python3
"""Tests the tests: plants each fault of `faults/` and reports the suites that catch it.

Every fault is a patch that puts wrong code behind a switch, `contract::sabotage("NAME")`. All patches are
applied to one copy of the tree, the tests are compiled once, and run for each fault with
BORESIGHT_SABOTAGE=NAME. The tree itself is not changed.

    python3 tests/saboteurs/run.py --check            every patch applies to the current tree (no compiler needed)
    python3 tests/saboteurs/run.py                    all faults, the fast suites; exit 1 when one is not caught
    python3 tests/saboteurs/run.py --only gain-inverted
    python3 tests/saboteurs/run.py --suites first     only until one suite catches it: for a new fault
    python3 tests/saboteurs/run.py --suites all       slow tests too

A suite is the unit tests of a crate (`sim/src`) or a module of its integration tests
(`sim/tests/pixel_distribution`). A result for a fault is reused while the suite's executable is unchanged: an
interrupted run continues.
"""

import argparse
import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HERE = ROOT / "tests" / "saboteurs"

# All packages of the workspace are compiled and run except these: the Python package computes nothing, the
# fuzzer only feeds the readers, and the research programs have no tests.
LEFT_OUT = {"boresight-python", "boresight-fuzz", "boresight-research"}

# Fails at any change of the code, right or wrong, and so is no witness against a fault.
FROZEN = re.compile(r"frozen")

# Suites about the tree rather than its computations: the switches of the faults change it.
OF_THE_TREE = {"tests/architecture", "tests/supply_chain"}

# Left out unless `--suites all`: suites about the command line, a browser or another program, and …
SLOW_SUITES = {"tests/monitor", "tests/mitsuba", "tests/shell", "tests/bad_input"}
# … tests that take long, by suite and name; others of their kind are run.
SLOW_TESTS = {
    "pipeline/src": ["wide_at_1_m_errors", "narrow_at_3_m_errors", "narrow_at_5_m_errors"],
    "tests/gate": ["null_control", "frames_taken_for_independent"],
}

# Shortest time limit of a test: one that hangs has noticed something.
MIN_LIMIT_S = 180.0
# Time limit of a suite without a fault.
MAX_LIMIT_S = 3600.0


def faults() -> list[Path]:
    return sorted((HERE / "faults").glob("*.patch"))


def patches() -> list[Path]:
    return [HERE / "switch.patch", *faults()]


def sentence(patch: Path) -> str:
    """Description of a fault: the text above its changes."""
    return " ".join(patch.read_text().split("\n--- ", 1)[0].split())


def touched(patch: Path, crates: Iterable[str]) -> set[str]:
    """Crates that a fault changes, by folder; the root package is ''."""
    files = re.findall(r"^\+\+\+ b/(\S+)", patch.read_text(), re.MULTILINE)
    return {max((crate for crate in crates if not crate or file.startswith(f"{crate}/")), key=len) for file in files}


def check() -> int:
    """Checks that all patches apply to the current tree, each alone and all together."""
    bad = [p for p in faults() if git_apply(ROOT, [HERE / "switch.patch", p], "--check").returncode]
    together = git_apply(ROOT, patches(), "--check")
    for patch in bad:
        print(f"{patch.relative_to(ROOT)}: does not apply to the tree; make it anew for the code as it is now")
    if together.returncode and not bad:
        print(f"each patch applies, and not all together: two change the same lines\n{together.stderr}", end="")
    names = {p.stem: p.read_text() for p in faults()}
    unswitched = [name for name, text in names.items() if f'sabotage("{name}")' not in text]
    for name in unswitched:
        print(f'faults/{name}.patch: nothing in it hangs on sabotage("{name}")')
    if not (bad or unswitched or together.returncode):
        print(f"{len(names)} faults, every patch applies")
        return 0
    return 1


def git_apply(folder: Path, files: list[Path], *options: str) -> subprocess.CompletedProcess:
    # One line of context is enough: neighbouring lines change, the line of the fault does not.
    command = ["git", "apply", "-C1", *options, *map(str, files)]
    environment = os.environ | {"GIT_CEILING_DIRECTORIES": str(folder.parent)}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)


def plant(tree: Path) -> None:
    """Makes `tree` the tree with all faults. Unchanged files keep their times, so that little is compiled
    again."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True)
    names = [name for name in listed.stdout.decode().split("\0") if name and (ROOT / name).is_file()]
    with tempfile.TemporaryDirectory() as folder:
        stage = Path(folder) / "tree"
        for name in names:
            (stage / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / name, stage / name)
        applied = git_apply(stage, patches())
        if applied.returncode:
            sys.exit(f"the patches do not apply (see --check):\n{applied.stderr}")
        wanted = {file.relative_to(stage) for file in stage.rglob("*") if file.is_file()}
        for file in [file for file in tree.rglob("*") if file.is_file()]:
            if file.relative_to(tree) not in wanted and file.relative_to(tree).parts[0] != ".git":
                file.unlink()
        for name in wanted:
            source, goal = stage / name, tree / name
            if not goal.exists() or goal.read_bytes() != source.read_bytes():
                goal.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source, goal)
    # Some suites list the files by git.
    for command in (["init", "--quiet"], ["add", "--all"]):
        subprocess.run(["git", *command], cwd=tree, check=True, stderr=subprocess.DEVNULL)


class Suite:
    """Tests of one executable: the unit tests of a crate, or a module of its integration tests."""

    def __init__(self, name: str, crate: str, folder: Path, executable: Path, identity: str, tests: list[str]):
        self.name, self.crate, self.folder, self.executable, self.identity, self.tests = name, crate, folder, executable, identity, tests


def metadata(tree: Path) -> list[dict]:
    """The packages of the workspace, as cargo describes them."""
    asked = subprocess.run(["cargo", "metadata", "--format-version", "1", "--no-deps", "--locked"], cwd=tree, check=True, capture_output=True)
    return json.loads(asked.stdout)["packages"]


def names_of_tests(executable: Path, folder: Path) -> list[str]:
    """The tests of an executable, those that are ignored too."""
    listed = subprocess.run([executable, "--list", "--format", "terse"], cwd=folder, check=True, capture_output=True, text=True)
    return [line.removesuffix(": test") for line in listed.stdout.splitlines() if line.endswith(": test")]


def by_module(unit: str, kind: str, tests: list[str]) -> dict[str, list[str]]:
    """The suites of an executable: of integration tests one per module at the root (`tests/NAME`), else one
    of all tests."""
    if kind != "test":
        return {unit: tests}
    suites: dict[str, list[str]] = {}
    for test in tests:
        module, separator, _ = test.partition("::")
        suites.setdefault(f"tests/{module}" if separator else unit, []).append(test)
    return suites


def compile_tests(tree: Path, target: Path, cargo: list[str]) -> list[Suite]:
    packages = [word for package in metadata(tree) if package["name"] not in LEFT_OUT for word in ("-p", package["name"])]
    command = ["cargo", "test", "--locked", *cargo, *packages, "--lib", "--bins", "--tests", "--no-run", "--message-format=json-render-diagnostics"]
    made = subprocess.run(command, cwd=tree, env=os.environ | {"CARGO_TARGET_DIR": str(target)}, stdout=subprocess.PIPE, text=True)
    if made.returncode:
        sys.exit("the tree with its faults does not compile")
    messages = [json.loads(line) for line in made.stdout.splitlines() if line.startswith("{")]
    built = [m for m in messages if m["reason"] == "compiler-artifact" and m.get("executable")]
    program = next((m["executable"] for m in built if not m["profile"]["test"] and "bin" in m["target"]["kind"]), None)
    suites = []
    for message in (m for m in built if m["profile"]["test"]):
        folder, kind = Path(message["manifest_path"]).parent, message["target"]["kind"][0]
        crate = "" if folder == tree else folder.relative_to(tree).as_posix()
        unit = "src" if kind == "lib" else "src/main.rs" if kind == "bin" else f"tests/{message['target']['name']}"
        executable = Path(message["executable"])
        # End-to-end tests run the program: with another program they are other tests.
        files = [executable] + ([Path(program)] if program and crate == "" and kind == "test" else [])
        identity = hashlib.sha256(b"".join(hashlib.sha256(file.read_bytes()).digest() for file in files)).hexdigest()
        for name, tests in by_module(unit, kind, names_of_tests(executable, folder)).items():
            suites.append(Suite("/".join(filter(None, [crate, name])), crate, folder, executable, identity, tests))
    return suites


def dependents(tree: Path) -> dict[str, set[str]]:
    """For each crate the crates whose tests may notice a fault in it: itself and what depends on it."""
    packages = metadata(tree)
    crate_of = lambda path: Path(path).resolve().relative_to(tree.resolve()).as_posix().removeprefix(".")
    uses = {
        crate_of(Path(p["manifest_path"]).parent): {crate_of(d["path"]) for d in p["dependencies"] if d.get("path")}
        for p in packages
    }
    reached = {crate: {crate} for crate in uses}
    for _ in uses:
        for crate, used in uses.items():
            for of in reached.values():
                if of & used:
                    of.add(crate)
    return reached


def run_suite(suite: Suite, fault: str, threads: int, skipped: list[str], limit_s: float) -> dict:
    """Runs the tests of a suite with a fault on, or none (''): which passed, which failed, how long it took.
    """
    environment = os.environ | {
        "BORESIGHT_SABOTAGE": fault,
        "CARGO_MANIFEST_DIR": str(suite.folder),
        "PROPTEST_MAX_SHRINK_ITERS": "0",
        "RUST_BACKTRACE": "0",
    }
    chosen = [test for test in suite.tests if not any(word in test for word in skipped)]
    # No name chooses all tests.
    command = [str(suite.executable), "--test-threads", str(threads), "--exact", *chosen] if chosen else ["true"]
    start = time.monotonic()
    process = subprocess.Popen(command, cwd=suite.folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True)
    try:
        output = process.communicate(timeout=limit_s)[0].decode(errors="replace")
        end = f"ends with status {process.returncode}"
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        output, end = process.communicate()[0].decode(errors="replace"), f"takes longer than {limit_s:.0f} s"
    results = re.findall(r"^test (\S+)(?: - .*?)? \.\.\. (ok|FAILED)$", output, re.MULTILINE)
    listed = re.findall(r"^    (\S+)(?: - .*)?$", output.rpartition("\nfailures:\n")[2], re.MULTILINE) if "\nfailures:\n" in output else []
    failed = sorted({name for name, how in results if how == "FAILED"} | set(listed))
    passed = sorted(name for name, how in results if how == "ok")
    died = "" if process.returncode in (0, 101) and (failed or process.returncode == 0) else end
    return {"passed": passed, "failed": failed, "died": died, "seconds": round(time.monotonic() - start, 2)}


class Kept:
    """Earlier results in a file: (fault, suite, executable of the suite) to result."""

    def __init__(self, path: Path):
        self.path = path
        self.runs = json.loads(path.read_text()) if path.exists() else {}

    def seconds(self, suite: Suite) -> float:
        """Duration of a suite without a fault, if it was ever run."""
        of = [run["seconds"] for key, run in self.runs.items() if key.startswith(f"- {suite.name} ")]
        return of[-1] if of else float("inf")

    def run(self, suite: Suite, fault: str, threads: int, skipped: list[str], limit_s: float) -> dict:
        key = " ".join([fault or "-", suite.name, suite.identity, *skipped])
        if key not in self.runs:
            self.runs[key] = run_suite(suite, fault, threads, skipped, limit_s)
            written = self.path.with_suffix(".part")
            written.write_text(json.dumps(self.runs, indent=0))
            written.replace(self.path)
        return self.runs[key]


def control(run: Callable[[Suite, str, float], dict], suite: Suite) -> dict:
    """Runs a suite without any fault: everything must pass."""
    sound = run(suite, "", MAX_LIMIT_S)
    if sound["failed"] or sound["died"]:
        tests = ", ".join(sound["failed"]) or sound["died"]
        sys.exit(f"without any fault {suite.name} fails, expected all its tests to pass: {tests}")
    return sound


def caught_by(suite: Suite, with_fault: dict, sound: dict) -> dict[str, list[str]]:
    """By suite, the tests that pass without the fault and fail with it, except frozen ones."""
    names = [name for name in with_fault["failed"] if name in sound["passed"] and not FROZEN.search(name)]
    if not names and with_fault["died"]:
        names = [f"({with_fault['died']})"]
    return {suite.name: names} if names else {}


def table(rows: list[tuple[Path, dict[str, list[str]]]]) -> str:
    lines = ["| fault | description | caught by | a test | tests |", "| --- | --- | --- | --- | --- |"]
    for patch, caught in rows:
        suites = ", ".join(f"`{suite}` ({len(names)})" for suite, names in caught.items())
        first = next(iter(caught.values()), [""])[0].rpartition("::")[2]
        count = sum(map(len, caught.values()))
        lines.append(f"| `{patch.stem}` | {sentence(patch)} | {suites or '**nothing**'} | {f'`{first}`' if first else ''} | {count} |")
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description="Plants faults and reports the suites that catch them.")
    parser.add_argument("--check", action="store_true", help="only check that every patch applies")
    parser.add_argument("--only", action="append", metavar="NAME", help="only this fault; may be repeated")
    parser.add_argument("--suites", choices=["first", "fast", "all"], default="fast", help="suites until one catches the fault; all but slow ones (default); all")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="threads of a suite (all processors)")
    parser.add_argument("--target-dir", type=Path, help="build directory (default: saboteurs/build in the target directory)")
    parser.add_argument("cargo", nargs="*", help="further arguments of cargo, after --")
    options = parser.parse_args()
    if options.check:
        return check()
    known = {patch.stem: patch for patch in faults()}
    for name in options.only or []:
        if name not in known:
            parser.error(f"--only names `{name}`, expected a fault of {HERE.relative_to(ROOT)}/faults")
    chosen = [known[name] for name in options.only] if options.only else list(known.values())

    folder = Path(os.environ.get("CARGO_TARGET_DIR") or ROOT / "target").resolve() / "saboteurs"
    tree, target = folder / "tree", (options.target_dir or folder / "build").resolve()
    tree.mkdir(parents=True, exist_ok=True)
    plant(tree)
    suites = compile_tests(tree, target, options.cargo)
    reach = dependents(tree)
    is_fast = options.suites != "all"
    left_out = OF_THE_TREE | (SLOW_SUITES if is_fast else set())
    suites = [suite for suite in suites if suite.name not in left_out]
    skipped = SLOW_TESTS if is_fast else {}

    kept = Kept(folder / "results.json")
    start = time.monotonic()
    run = lambda suite, fault, limit_s: kept.run(suite, fault, options.jobs, skipped.get(suite.name, []), limit_s)
    if options.suites != "first":
        count = sum(len(control(run, suite)["passed"]) for suite in suites)
        took = sum(control(run, suite)["seconds"] for suite in suites)
        print(f"no fault: {count} tests of {len(suites)} suites pass, {took:.0f} s", flush=True)

    rows, missed = [], []
    for patch in chosen:
        own = touched(patch, reach)
        crates = set().union(*(reach[crate] for crate in own))
        able = [suite for suite in suites if suite.crate in crates]
        # In order of duration. With `--suites first`, suites of the fault's crate come first, and only stored
        # durations are used.
        near = lambda suite: (suite.crate not in own, kept.seconds(suite), suite.name)
        able.sort(key=near if options.suites == "first" else lambda suite: control(run, suite)["seconds"])
        caught, took = {}, 0.0
        for suite in able:
            sound = control(run, suite)
            with_fault = run(suite, patch.stem, max(MIN_LIMIT_S, 10.0 * sound["seconds"]))
            took += with_fault["seconds"]
            caught |= caught_by(suite, with_fault, sound)
            if caught and options.suites == "first":
                break
        rows.append((patch, caught))
        missed += [] if caught else [patch.stem]
        told = ", ".join(f"{suite} ({len(names)})" for suite, names in caught.items())
        print(f"{patch.stem}: {told or 'NOT CAUGHT'}; {took:.0f} s", flush=True)
    print(f"\n{table(rows)}")
    print(f"{len(rows) - len(missed)} of {len(rows)} faults caught, {time.monotonic() - start:.0f} s")
    if missed:
        print(f"not caught: {', '.join(missed)}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
