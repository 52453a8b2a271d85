#!/usr/bin/env python3
"""Variants of the scenario `docking`, drawn by a study: tests the consistency of sigma at every range.

    python3 research/docking_variants/run.py --boresight target/release/boresight --out variants [--cases 30] [--jobs 1]

The draws are those of study.toml (Sun, television, lens, approach), the approach is approach.toml, everything
else is scenarios/docking.toml. Every case is run with `boresight study replay`; existing cases are not
repeated. Printed by bin of true range and lens: NEES of single fields over its dimension, accuracy, doubtful
and wrong fields, and for each parameter of the motion the share of reports within three standard deviations.
The intervals are of 95 %, clustered by run: Student's t over the runs' sums (a ratio's linearised scatter).

Needs only Python.
"""

import argparse
import concurrent.futures
import json
import math
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent
PARAMETERS = ["range", "range_rate", "alpha", "beta", "phi1", "phi2", "phi3"]
# Two-sided 95 % of Student's t by degrees of freedom (Abramowitz and Stegun, table 26.10); for others the
# next smaller entry is used.
STUDENT = {1: 12.71, 2: 4.30, 3: 3.18, 4: 2.78, 5: 2.57, 7: 2.36, 9: 2.26, 14: 2.14, 19: 2.09, 29: 2.045, 59: 2.00, 119: 1.98}


def write_study(out):
    """Study and scenario: docking with this folder's approach."""
    out.mkdir(parents=True, exist_ok=True)
    kept, section = [], ""
    for line in (ROOT / "scenarios" / "docking.toml").read_text().splitlines():
        section = line.strip("[] ").split("]")[0] if line.startswith("[") else section
        if not section.startswith("approach"):
            kept.append(line)
    (out / "scenario.toml").write_text("\n".join(kept) + "\n" + (HERE / "approach.toml").read_text())
    (out / "study.toml").write_text((HERE / "study.toml").read_text())


def fly(program, out, case):
    run = out / f"case-{case:03d}"
    if not (run / "score.json").is_file():
        words = ["study", "replay", out / "study.toml", "--case", case, "--out", run, "--no-report"]
        subprocess.run([program, *map(str, words)], check=True, stdout=subprocess.DEVNULL)
    return json.loads((run / "score.json").read_text())


def pooled(pairs):
    """A ratio of sums over runs, and half the width of its interval; pairs: (sum, count) of each run."""
    pairs = [(total, count) for total, count in pairs if count]
    n, count = len(pairs), sum(count for _, count in pairs)
    if not count:
        return None, None
    ratio = sum(total for total, _ in pairs) / count
    if n < 2:
        return ratio, None
    scatter = sum((total - ratio * k) ** 2 for total, k in pairs) * n / (n - 1)
    student = STUDENT[max(k for k in STUDENT if k <= n - 1)]
    return ratio, student * math.sqrt(scatter) / count


def sums(score, name):
    """(sum, count) of a mean or a rate."""
    figure = score["figures"].get(name) or {}
    value, count = figure.get("value"), figure.get("of" if name.endswith(("_rate", "_sigma")) else "count", 0)
    return (0.0, 0) if value is None else (value * count, count)


def squares(score, name):
    figure = score["figures"].get(name) or {}
    value, count = figure.get("value"), figure.get("count", 0)
    return (0.0, 0) if value is None else (value * value * count, count)


def cell(value, half, scale=1.0, digits=2):
    if value is None:
        return "-"
    return f"{scale * value:.{digits}f}" + ("" if half is None else f" +- {scale * half:.{digits}f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--boresight", required=True, type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("--out", required=True, type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--cases", type=int, default=30)
    parser.add_argument("--jobs", type=int, default=1)
    arguments = parser.parse_args()
    write_study(arguments.out)
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        scores = list(pool.map(lambda case: fly(arguments.boresight, arguments.out, case), range(arguments.cases)))
    bins = {}
    for score in scores:
        for name, group in score["groups"].items():
            bins.setdefault(name, []).append(group)
    bins["all"] = scores
    print(f"{len(scores)} runs")
    print("range, lens | runs | fields | NEES | doubtful % | wrong | range rms m | range rate rms m/s")
    for name, groups in bins.items():
        nees = pooled([sums(group, "nees_mean") for group in groups])
        doubtful = pooled([sums(group, "doubtful_rate") for group in groups])
        wrong = sum(sum(group["wrong"].values()) for group in groups)
        rms = [pooled([squares(group, key) for group in groups])[0] for key in ("range_rms_m", "motion_range_rate_rms_m_s")]
        rms = ["-" if value is None else f"{math.sqrt(value):.3g}" for value in rms]
        fields = sum(group["frames"] for group in groups)
        print(" | ".join([name, str(len(groups)), str(fields), cell(*nees), cell(*doubtful, 100.0), str(wrong), *rms]))
    print("\nmotion reports within 3 sigma, %")
    print(" | ".join(["range, lens", *PARAMETERS]))
    for name, groups in bins.items():
        shares = [pooled([sums(group, f"motion_{key}_within_3_sigma") for group in groups]) for key in PARAMETERS]
        print(" | ".join([name, *(cell(*share, 100.0) for share in shares)]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
