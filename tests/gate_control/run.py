#!/usr/bin/env python3
"""Tests the claims of the gate, with runs of the program itself.

    python3 tests/gate_control/run.py                                   # all parts, hours on two cores
    python3 tests/gate_control/run.py sequences --trials 40             # one part, fewer trials

Null control, 400 pairs of results that differ only by their seed; at most 31 may be found worse (20 are
expected at 5 %):
  sequences   single sequences of 400 images (scenarios/starting-point.toml)
  studies     studies of 12 draws, 16 images each
  sweeps      studies of 8 draws at two points of a sweep

Faults planted in the measurements of 100 runs, on the same frames:
  far_range   scenarios/gates/argon.toml
  docking     scenarios/gates/docking.toml

A fault whose effect is at least the gate's stated smallest visible change must be found in 95 of 100 runs;
among fewer than 20 such runs in all except one, among fewer than four in all.

Needs Python's standard library and the program, built (`cargo build --release --locked`, or --program).
"""

import argparse
import collections
import concurrent.futures
import csv
import json
import math
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SCENARIOS = ROOT / "scenarios"
NULL = ("sequences", "studies", "sweeps")
FAULTS = ("far_range", "docking")
TRIALS = {name: 400 for name in NULL} | {name: 100 for name in FAULTS}

STUDY = """title = "null control"
scenario = "argon"
seed = {seed}
frames = "2000..2016"

[stop]
cases = {cases}

[[vary]]
path = "psf.sigma_px"
distribution = {{ kind = "normal", mean = 0.8, sigma = 0.15, min = 0.4, max = 1.6 }}

[[vary]]
path = "sensor.read_noise_e"
distribution = {{ kind = "log_normal", median = 15.0, sigma_ln = 0.4 }}
"""
SWEEP = """
[[sweep]]
path = "roi.threshold_dn"
values = [60, 90]
"""


class Control:
    """The program, and a folder for its output."""

    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)

    def run(self, *words, expected=(0,)):
        done = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True)
        if done.returncode not in expected:
            sys.exit(f"{' '.join(map(str, words))}: {done.stderr}")
        return done

    def baseline(self, result, out):
        self.run("gate", "baseline", result, "--out", out, "--reason", "a control")

    def gate(self, baseline, result):
        """The report, or `None` where there is too little data for any figure."""
        done = self.run("gate", baseline, result, "--json", expected=(0, 1, 2))
        if done.returncode == 2:
            if "cannot compare: " not in done.stderr or "are too few to find any figure" not in done.stderr:
                sys.exit(done.stderr)
            return None
        return json.loads(done.stdout)

    def result(self, kind, seed, out):
        if kind == "sequences":
            self.run("run", SCENARIOS / "starting-point.toml", "--seed", seed, "--out", out)
            return
        study = self.folder / f"{kind}-{seed}.toml"
        text = STUDY.format(seed=seed, cases=12 if kind == "studies" else 16)
        study.write_text(text + (SWEEP if kind == "sweeps" else ""))
        self.run("study", "run", study, "--out", out)
        study.unlink()


def null_pair(control, kind, pair):
    """Compares two results that differ only by their seed; also returns the number of figures with too little
    data, and the number of all."""
    folders = [control.folder / f"{kind}-{pair}-{side}" for side in "ab"]
    baseline = control.folder / f"{kind}-{pair}-baseline"
    for side, folder in enumerate(folders):
        control.result(kind, 2 * pair + side + 1, folder)
    control.baseline(folders[0], baseline)
    report = control.gate(baseline, folders[1])
    for folder in (*folders, baseline):
        shutil.rmtree(folder)
    if report is None:
        return [], 1, 1
    verdicts = {name: figure["verdict"] for name, figure in report["figures"].items()}
    alarms = [name for name, verdict in verdicts.items() if verdict in ("worse", "gone", "changed")]
    return alarms, list(verdicts.values()).count("too_little_data"), len(verdicts)


def null_control(control, kind, trials, jobs):
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        pairs = list(pool.map(lambda pair: null_pair(control, kind, pair), range(trials)))
    alarms = sum(bool(alarms) for alarms, _, _ in pairs)
    names = collections.Counter(name for alarms, _, _ in pairs for name in alarms)
    little = sum(little for _, little, _ in pairs) / sum(count for _, _, count in pairs)
    # 31 of 400: two and a half standard deviations above the expectation.
    most = math.floor(0.05 * trials + 2.55 * math.sqrt(0.05 * 0.95 * trials))
    print(f"{kind}: {alarms} of {trials} pairs rejected, at most {most} allowed; too little data for {little:.1%} of the figures", flush=True)
    print(f"  {dict(names.most_common(6))}", flush=True)
    return alarms <= most


def read_rows(run):
    with open(run / "measurements.csv", newline="") as file:
        return list(csv.DictReader(file))


def write_rows(run, rows):
    with open(run / "measurements.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def lost(row, status):
    """The row of a frame without an answer."""
    kept = list(row)[0]
    return {key: value if key == kept else "" for key, value in row.items()} | {"status": status}


def blackout(begin, end, status):
    def plant(rows, _):
        first, last = round(begin * len(rows)), round(end * len(rows))
        return [lost(row, status) if first <= place < last else row for place, row in enumerate(rows)]

    return plant


def blackouts(status):
    places = {"begin": lambda share: 0.0, "middle": lambda share: 0.5 - share / 2, "end": lambda share: 1.0 - share}
    return {
        f"{share:.0%} lost in a row, {place}": blackout(begin(share), begin(share) + share, status)
        for share in (0.05, 0.1, 0.25)
        for place, begin in places.items()
    }


def dropped(share, status):
    return lambda rows, rng: [lost(row, status) if rng.random() < share else row for row in rows]


def stale(rows, _):
    """Every answer is that of the frame before."""
    number = list(rows[0])[0]
    return [rows[0]] + [before | {number: row[number]} for before, row in zip(rows, rows[1:])]


def shifted(column, by):
    """Adds a constant to a column of a measurement; positions stay on the detector."""
    last = {"x_px": 751.0, "y_px": 579.0}[column]

    def plant(rows, _):
        def change(row):
            value = min(max(float(row[column]) + by, 0.0), last)
            return row | {column: repr(value)}

        return [change(row) if row[column] else row for row in rows]

    return plant


def wrong(share, columns, by):
    """So much of the answers is far from the truth."""

    def plant(rows, rng):
        def change(row):
            if not row[columns[0]] or rng.random() >= share:
                return row
            # Towards the middle of the detector.
            away = {column: -by if float(row[column]) > 300.0 else by for column in columns}
            return row | {column: repr(float(row[column]) + away[column]) for column in columns}

        return [change(row) for row in rows]

    return plant


def without_line_of_sight(plant):
    """A fault of the centroid: the line of sight is left to the program, by the attitude of the answer."""

    def both(rows, rng):
        return [
            row | {column: "" for column in row if column.startswith("los_")} for row in plant(rows, rng)
        ]

    return both


def scaled_sigma(factor):
    """All standard deviations and covariances of the answer times a factor."""

    def plant(rows, _):
        def scale(column, value):
            if not value:
                return value
            if column.startswith("sigma_"):
                return repr(float(value) * factor)
            return repr(float(value) * factor**2) if column.startswith("cov_") else value

        return [{column: scale(column, value) for column, value in row.items()} for row in rows]

    return plant


def far_range_faults():
    biases = {
        f"bias {by:+} px in {axis}": without_line_of_sight(shifted(f"{axis}_px", by))
        for axis in "xy"
        for by in (-1.0, -0.3, -0.1, 0.1, 0.3, 1.0)
    }
    return (
        blackouts("no_target")
        | biases
        | {
            "stale by a frame": stale,
            "1 % wrong": without_line_of_sight(wrong(0.01, ["x_px", "y_px"], 40.0)),
            "3 % dropped": dropped(0.03, "no_target"),
        }
    )


def docking_faults():
    return blackouts("no_target") | {
        "sigma × 0.8": scaled_sigma(0.8),
        "sigma × 0.5": scaled_sigma(0.5),
        "stale by a field": stale,
        "1 % wrong": wrong(0.01, ["d3_m"], 3.0),
        "3 % dropped": dropped(0.03, "no_target"),
    }


def plan_of(world):
    return {"far_range": ("argon", far_range_faults()), "docking": ("docking", docking_faults())}[world]


def faults_of_seed(control, world, seed):
    """For each fault: True if it was found, and True if the gate states a change of its size as visible."""
    scenario, faults = plan_of(world)
    run = control.folder / f"{world}-{seed}"
    baseline, faulty = run.with_suffix(".baseline"), run.with_suffix(".faulty")
    control.run("run", SCENARIOS / "gates" / f"{scenario}.toml", "--seed", seed, "--out", run)
    # Removes files that are not measurements: the faults do not change them.
    for name in ("SHA256SUMS", "score.json", "report.html", "motion.csv"):
        (run / name).unlink(missing_ok=True)
    rows = read_rows(run)
    # Faults of centroids have no line of sight of the pipeline, nor has the baseline that they are compared
    # with.
    plain = without_line_of_sight(lambda rows, _: rows)
    found = {}
    for name, fault in faults.items():
        is_of_centroid = world == "far_range" and ("px" in name or "wrong" in name)
        write_rows(run, plain(rows, None) if is_of_centroid else rows)
        shutil.rmtree(baseline, ignore_errors=True)
        control.baseline(run, baseline)
        shutil.copytree(run, faulty)
        write_rows(faulty, fault(plain(rows, None) if is_of_centroid else rows, random.Random(f"{seed} {name}")))
        report = control.gate(baseline, faulty)
        shutil.rmtree(faulty)
        found[name] = (report is not None and report["verdict"] != "no_worse", report is not None and is_visible(report))
    shutil.rmtree(run)
    shutil.rmtree(baseline)
    return found


def is_visible(report):
    """Returns true if any figure differs, for the worse or from a best value, by the gate's smallest visible
    change."""

    def of_figure(figure):
        run = figure["loss_run"]
        if run and run["won"] == 0 and run["smallest_visible"] and run["longest"] >= run["smallest_visible"] and figure["worse_by"] > figure["tolerance"]:
            return True
        size, change = figure["smallest_visible"], figure["worse_by"]
        if figure["better"].startswith("near") and figure["difference"] is not None:
            change = abs(figure["difference"])
        return size is not None and change is not None and change >= size > 0.0

    return any(of_figure(figure) for figure in report["figures"].values())


def planted_faults(control, world, trials, jobs):
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        seeds = list(pool.map(lambda seed: faults_of_seed(control, world, seed), range(1, trials + 1)))
    is_kept = True
    print(f"{world}: fault, found of {trials}; of those above the stated size")
    for name in plan_of(world)[1]:
        found = sum(seed[name][0] for seed in seeds)
        visible = sum(seed[name][1] for seed in seeds)
        both = sum(all(seed[name]) for seed in seeds)
        is_found = both >= visible - max(visible // 20, int(visible >= 4))
        print(f"  {name:32} {found:4}   {both} of {visible}{'' if is_found else '   TOO FEW'}", flush=True)
        is_kept &= is_found
    return is_kept


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"which of {', '.join(NULL + FAULTS)}; all without")
    parser.add_argument("--trials", type=int, help="pairs or runs of each part")
    parser.add_argument("--jobs", type=int, default=2, help="how many at a time")
    parser.add_argument("--program", default=ROOT / "target/release/boresight", help="the program to hold to its promises")
    arguments = parser.parse_args()
    for part in arguments.parts:
        if part not in TRIALS:
            parser.error(f"there is no part `{part}`, expected one of {', '.join(TRIALS)}")
    is_kept = True
    with tempfile.TemporaryDirectory() as folder:
        control = Control(arguments.program, folder)
        for part in arguments.parts or TRIALS:
            trials = arguments.trials or TRIALS[part]
            measure = null_control if part in NULL else planted_faults
            is_kept &= measure(control, part, trials, arguments.jobs)
    sys.exit(0 if is_kept else 1)


if __name__ == "__main__":
    main()
