#!/usr/bin/env python3
"""Mutation testing (cargo-mutants) of the oracle's core: score, gate, statistics, astrometry, cameras,
attitude.

A mutant is compiled in seconds: the crates of the oracle are small, and in a copy of the tree the simulator
and the pipelines are pruned to the modules in question and their dependencies; a module has the same code,
and is tested by its own tests. Survivors that are no faults are explained in `.cargo/mutants.toml`.

    python3 tests/mutants/run.py                  every group; exit 1 when a mutant survives
    python3 tests/mutants/run.py score sim        some
    python3 tests/mutants/run.py --shard 0/8      every group, each eighth mutant: a sample in a part of the time
    python3 tests/mutants/run.py --list           the groups and how many mutants they have

Needs cargo-mutants 27 (`cargo install --locked cargo-mutants@27.1.0`). The result of each mutant is in
target/mutants/GROUP/mutants.out.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# By group: package, files, suites of integration tests beside the tests of the library, words that select
# tests and words that exclude tests.
GROUPS = {
    "score": ("boresight-score", ["oracle/score/src/**"], [], [], []),
    # The verdicts and figures of the worlds.
    "far-range": ("boresight-far-range", ["worlds/far_range/src/scoring/**"], [], [], []),
    "docking": ("boresight-docking", ["worlds/docking/src/scoring/**"], [], [], []),
    # Intervals are tried by thousands of samples, which without optimisation takes a minute.
    "statistics": ("boresight-statistics", ["oracle/statistics/src/**"], [], [], ["covers_the_truth", "wild_laws", "cover_the_truth"]),
    # Runs and studies are read by tests of the whole program: read.rs has no mutants here.
    "gate": ("boresight-gate", [f"oracle/gate/src/{glob}.rs" for glob in ("[!r]*", "baseline/*", "comparison/*", "dependence/[!r]*", "report/*")], [], [], []),
    "contract": ("boresight-contract", ["contract/src/camera.rs"], [], ["camera"], []),
    "optics": ("boresight-optics", ["sim/optics/src/projection.rs"], [], ["projection"], []),
    "truth": ("boresight-truth", ["sim/truth/src/apparent.rs"], ["golden_apparent"], ["apparent"], []),
    "pipeline": (
        "boresight-pipeline",
        [f"pipeline/src/{name}.rs" for name in ("camera_model", "far_range/aberration", "far_range/attitude", "far_range/line_of_sight")],
        [],
        [],
        [],
    ),
}

# Remaining module trees of large crates, by the folder of the crate.
PRUNED = {
    "pipeline": {
        "pipeline/src/lib.rs": "mod camera_model;\nmod error;\npub mod far_range;\npub use camera_model::CameraModel;\npub use error::PipelineError;",
        "pipeline/src/far_range/mod.rs": "mod aberration;\nmod attitude;\nmod line_of_sight;\n"
        "pub use aberration::aberration_correction;\npub use attitude::{AttitudeConfig, StarWeights};",
    },
}


def prune(tree: Path, group: str) -> None:
    """Makes `tree` the pruned copy that a group is tested in."""
    package, files, suites, _, _ = GROUPS[group]
    shutil.rmtree(tree, ignore_errors=True)
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True)
    for name in listed.stdout.decode().split("\0"):
        first, *rest = Path(name).parts or [""]
        inner = rest[0] if first in ("contract", "sim", "pipeline") and rest else first
        is_test = "tests" in Path(name).parts[:3] and Path(name).stem not in suites
        if not name or is_test or inner in ("benches", "examples") or first in ("python", "fuzz", "monitor", "docs") or not (ROOT / name).is_file():
            continue
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, tree / name)
    for name, text in PRUNED.get(group, {}).items():
        (tree / name).write_text(f"//! Pruned.\n#![allow(missing_docs, dead_code, unused, unreachable_pub)]\n{text}\n" if name.endswith("lib.rs") else f"//! Pruned.\n{text}\n")
    if suites:
        modules = "".join(f"mod {suite};\n" for suite in suites)
        (tree / files[0].split("/src/")[0] / "tests" / "it" / "main.rs").write_text(f"//! Pruned.\n{modules}")
    for manifest in tree.rglob("Cargo.toml"):
        text = re.sub(r"\[\[bench\]\][^\[]*", "", manifest.read_text())
        manifest.write_text(text.replace('"python", "fuzz"', "").replace(", ,", ",").replace(", ]", "]"))


def run(group: str, tree: Path, arguments: list[str]) -> int:
    package, files, suites, chosen, skipped = GROUPS[group]
    cargo = [f"--cargo-arg={word}" for word in ["--lib", *(["--test", "it"] if suites else [])]]
    files = [word for file in files for word in ("-f", file)]
    filters = chosen + [word for name in skipped for word in ("--skip", name)]
    command = ["cargo", "mutants", "-d", str(tree), "--package", package, *files, *arguments]
    if "--list" not in arguments:
        command += ["--timeout", "120", "--no-shuffle", "--output", str(tree.parent / group), *cargo, "--", "--", *filters]
    environment = os.environ | {"CARGO_PROFILE_DEV_OPT_LEVEL": "0", "CARGO_PROFILE_DEV_DEBUG": "false"}
    environment.pop("CARGO_TARGET_DIR", None)  # a target directory that is shared would take one mutant for another
    return subprocess.run(command, env=environment).returncode


def main() -> int:
    parser = argparse.ArgumentParser(description="Mutation testing of score, gate, statistics, astrometry, cameras and attitude.")
    parser.add_argument("groups", nargs="*", metavar="GROUP", help=f"of {', '.join(GROUPS)} (all)")
    parser.add_argument("--shard", metavar="K/N", help="each N-th mutant, from the K-th on, counted from 0 (all)")
    parser.add_argument("--list", action="store_true", help="only what there is to test")
    options = parser.parse_args()
    for group in options.groups:
        if group not in GROUPS:
            parser.error(f"`{group}` is no group, expected one of {', '.join(GROUPS)}")
    if shutil.which("cargo-mutants") is None:
        sys.exit("cargo-mutants is not installed: cargo install --locked cargo-mutants@27.1.0")
    folder = ROOT / "target" / "mutants"
    failed = []
    for group in options.groups or GROUPS:
        print(f"{group}:", flush=True)
        tree = folder / f"{group}-tree"
        prune(tree, group)
        part = ["--shard", options.shard, "--sharding", "round-robin"] if options.shard else []
        if run(group, tree, part + (["--list"] if options.list else [])):
            failed.append(group)
    if failed:
        print(f"mutants survive in: {', '.join(failed)}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
