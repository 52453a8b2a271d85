#!/usr/bin/env python3
"""Compares the built-in pipeline with programs that a competent user would write, on ARGON and four other
cameras.

    python3 tests/rivals/run.py [--program target/release/boresight] [--frames 300]

The best mode and the examples argmax.py, brightest.py, sep_brightest.py and photutils_brightest.py process
each of the five days of ARGON and each scenario of scenarios/comparison/. A table has the share of correct
outcomes and the RMS of the centroid along x and y, px, over the frames in which a program measured the
target. The exit status is 1 if the best mode is correct less often than a rival by more than 0.1 points, or
if its centroid is worse in the frames in which both measured the target. Needs the packages of
tests/python/requirements.txt.
"""

import argparse
import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from pyarrow import parquet

ROOT = Path(__file__).resolve().parents[2]
RIVALS = ["argmax", "brightest", "sep_brightest", "photutils_brightest"]
# A centroid this near to the target's, px, is of the target: its longest column of charge is twelve pixels.
TAKEN_PX = 8.0
# First frame of each day of ARGON.
DAYS = {"argon, day 1": 0, "argon, day 2": 1634, "argon, day 3": 4612, "argon, day 4": 7931, "argon, day 5": 13346}


def scored(program, scenario, frames, pipeline):
    """Correct rate of a run, and the errors of its centroids in the frames where it took the target: {frame:
    (x, y)}, px."""
    with tempfile.TemporaryDirectory() as out:
        command = [program, "run", str(scenario), "--no-report", "--json", "--out", f"{out}/run"]
        command += ["--frames", frames] if frames else []
        command += ["--pipeline", pipeline] if pipeline else []
        done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)}\n{done.stderr}")
        run = Path(out) / "run"
        figures = json.loads((run / "score.json").read_text())["figures"]
        objects = parquet.read_table(run / "truth/objects.parquet", columns=["frame", "kind", "x_px", "y_px"]).to_pylist()
        targets = {row["frame"]: (row["x_px"], row["y_px"]) for row in objects if row["kind"] == "target"}
        with open(run / "measurements.csv") as file:
            answers = {int(row["frame"]): row for row in csv.DictReader(file) if row["x_px"]}
    errors = {
        frame: (float(answers[frame]["x_px"]) - x, float(answers[frame]["y_px"]) - y)
        for frame, (x, y) in targets.items()
        if frame in answers
    }
    return figures["correct_rate"]["value"], {frame: e for frame, e in errors.items() if math.hypot(*e) < TAKEN_PX}


def rms(errors, frames):
    """RMS along x and y over some frames, px."""
    return [math.sqrt(sum(errors[frame][axis] ** 2 for frame in frames) / len(frames)) if frames else math.nan for axis in (0, 1)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "target/release/boresight"))
    parser.add_argument("--frames", type=int, default=300, help="frames of each day and scenario")
    given = parser.parse_args()
    failures = []
    with tempfile.TemporaryDirectory() as folder:
        argon = Path(folder) / "argon.toml"
        argon.write_text(re.sub(r'^mode = "paper".*$', 'mode = "best"', (ROOT / "scenarios/argon.toml").read_text(), flags=re.M))
        cases = [(name, argon, f"{first + 500}..{first + 500 + given.frames}") for name, first in DAYS.items()]
        cases += [(path.stem, path, f"0..{min(given.frames, 200)}") for path in sorted((ROOT / "scenarios/comparison").glob("*.toml"))]
        print(f"{'':14} {'best mode':>22}" + "".join(f"{rival:>22}" for rival in RIVALS))
        for name, scenario, frames in cases:
            correct, best = scored(given.program, scenario, frames, None)
            line = [(correct, rms(best, best))]
            for rival in RIVALS:
                found_correct, found = scored(given.program, scenario, frames, f"exec:{sys.executable} examples/{rival}.py")
                line.append((found_correct, rms(found, found)))
                if correct < found_correct - 0.001:
                    failures.append(f"{name}: {rival} is correct in {found_correct:.4f}, the best mode in {correct:.4f}")
                common = best.keys() & found.keys()
                for axis, (ours, theirs) in enumerate(zip(rms(best, common), rms(found, common))):
                    if not ours < theirs:
                        failures.append(
                            f"{name}: in the {len(common)} frames of both {rival} has a centroid RMS of {theirs:.4f} px along {'xy'[axis]}, the best mode {ours:.4f} px"
                        )
            cell = lambda rate, errors: f"{100 * rate:5.1f} %" + "".join(f" {error:6.4f}" for error in errors)
            print(f"{name:14}" + "".join(f"{cell(*v):>23}" for v in line), flush=True)
    for failure in failures:
        print(failure)
    return 1 if failures else 0


if __name__ == "__main__":
    os.environ.setdefault("PYTHONPATH", "")
    sys.exit(main())
