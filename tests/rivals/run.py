#!/usr/bin/env python3
"""The built-in pipeline against programs that a competent user would write, on ARGON and four other cameras.

    python3 tests/rivals/run.py [--program target/release/boresight] [--frames 300]

Each of the five days of ARGON and each scenario of scenarios/comparison/ is processed by the best mode and by the examples argmax.py, brightest.py,
sep_brightest.py and photutils_brightest.py. A table has the share of correct answers and the RMS of the centroid along x and y, px. The exit status is 1
where the best mode is correct less often than a rival by more than 0.1 points, or where its centroid is worse. Needs what tests/python/requirements.txt names.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RIVALS = ["argmax", "brightest", "sep_brightest", "photutils_brightest"]
# First frame of each day of ARGON.
DAYS = {"argon, day 1": 0, "argon, day 2": 1634, "argon, day 3": 4612, "argon, day 4": 7931, "argon, day 5": 13346}


def scored(program, scenario, frames, pipeline):
    """Correct rate and centroid RMS of a run."""
    with tempfile.TemporaryDirectory() as out:
        command = [program, "run", str(scenario), "--no-report", "--json", "--out", f"{out}/run"]
        command += ["--frames", frames] if frames else []
        command += ["--pipeline", pipeline] if pipeline else []
        done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)}\n{done.stderr}")
        figures = json.loads((Path(out) / "run/score.json").read_text())["figures"]
    return [figures[name]["value"] for name in ("correct_rate", "centroid_x_rms_px", "centroid_y_rms_px")]


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
            best = scored(given.program, scenario, frames, None)
            line = [best]
            for rival in RIVALS:
                found = scored(given.program, scenario, frames, f"exec:{sys.executable} docs/examples/{rival}.py")
                line.append(found)
                if best[0] < found[0] - 0.001:
                    failures.append(f"{name}: {rival} is correct in {found[0]:.4f}, the best mode in {best[0]:.4f}")
                for axis in (1, 2):
                    if found[axis] is not None and (best[axis] is None or best[axis] > found[axis]):
                        failures.append(f"{name}: {rival} has a centroid RMS of {found[axis]} px, the best mode {best[axis]} px")
            cell = lambda v: f"{100 * v[0]:5.1f} %" + "".join(f" {x:6.3f}" if x is not None else "      –" for x in v[1:])
            print(f"{name:14}" + "".join(f"{cell(v):>23}" for v in line), flush=True)
    for failure in failures:
        print(failure)
    return 1 if failures else 0


if __name__ == "__main__":
    os.environ.setdefault("PYTHONPATH", "")
    sys.exit(main())
