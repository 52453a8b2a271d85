#!/usr/bin/env python3
"""Navigates stored cases of a study again and prints their consistency.

    boresight study replay STUDY --case K --no-report --out CASES/K      # for every K, once
    python3 research/navigation_cases/run.py CASES [--boresight target/release/boresight] [--jobs 2]

CASES holds a run directory per case. The program prints NEES per dimension, the share of the errors within three
standard deviations and RMS error over RMS σ along R, T, N, each with a 95 % interval of the mean over cases, and the
elapsed time. `boresight study run` gives the same figures from the scenario, and those over the bound.
"""

import argparse
import json
import math
import pathlib
import subprocess
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor


def navigate(run, boresight, navigator):
    """Score of a run's navigation; None if it failed."""
    with tempfile.TemporaryDirectory() as folder:
        words = [boresight, "navigate", run, "--navigator", navigator, "--json", "--out", pathlib.Path(folder) / "out"]
        done = subprocess.run(words, capture_output=True, check=False, text=True)
    score = json.loads(done.stdout)["score"] if done.returncode == 0 else None
    return score if score and score["estimates"] else None


def mean(values):
    """Mean and half of its 95 % interval."""
    values = list(values)
    middle = sum(values) / len(values)
    spread = math.sqrt(sum((value - middle) ** 2 for value in values) / max(len(values) - 1, 1) / len(values))
    return middle, 1.96 * spread


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", type=pathlib.Path)
    parser.add_argument("--boresight", default="target/release/boresight")
    parser.add_argument("--navigator", default="batch")
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    runs = [path.parent for path in arguments.cases.glob("*/run.toml")]
    runs.sort(key=lambda run: (len(run.name), run.name))
    start = time.monotonic()
    with ThreadPoolExecutor(arguments.jobs) as pool:
        answers = list(pool.map(lambda run: navigate(run, arguments.boresight, arguments.navigator), runs))
    elapsed = time.monotonic() - start
    scores = [score for score in answers if score]
    print(f"{len(runs)} cases in {elapsed:.0f} s, {len(runs) - len(scores)} without an estimate")
    for name in ("nees_position_per_dimension", "nees_state_per_dimension"):
        print(name, "{:.2f} ± {:.2f}".format(*mean(score[name] for score in scores)))
    axes = [[score["position_m"][axis] for axis in "rtn"] for score in scores]
    print("within 3 sigma, % {:.2f} ± {:.2f}".format(
        *mean(100 * sum(axis["within_3_sigma"] for axis in case) / 3 for case in axes)))
    for number, name in enumerate("RTN"):
        squares, variances = (mean(case[number][key] ** 2 for case in axes)[0] for key in ("rms", "sigma_rms"))
        print(f"{name}: RMS {math.sqrt(squares):.3f} m, over RMS sigma {math.sqrt(squares / variances):.2f}")
    worst = sorted(zip(runs, answers), key=lambda pair: -(pair[1] or {}).get("nees_position_per_dimension", math.inf))
    print("worst:", ", ".join(f"{run.name} ({score['nees_position_per_dimension']:.1f})" if score else run.name
                              for run, score in worst[:8]))


if __name__ == "__main__":
    main()
