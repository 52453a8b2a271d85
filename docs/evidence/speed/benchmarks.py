#!/usr/bin/env python3
"""Runs the criterion benchmarks; writes benchmarks.json, benchmarks.md and cost.svg in docs/speed.

    python3 docs/evidence/speed/benchmarks.py --python venv/bin/python [--no-run]

The interpreter needs matplotlib (docs/evidence/speed/requirements.txt). With `--no-run` the estimates of the last run
are read. Times are processor times of one thread, criterion's medians. Exit 0: done; 2: something is missing.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys

import page

ROOT = pathlib.Path(__file__).resolve().parents[3]
BENCHMARKS = [("boresight-sim", "frame"), ("boresight-pipeline", "far_range")]
DETECTORS = ["even", "uneven", "row offsets"]
DETECTOR_WORDS = {"even": "even detector", "uneven": "every pixel its own", "row offsets": "and rows with offsets"}
DAYS = {"0": 1, "1700": 2, "5000": 3, "9000": 4, "14000": 5}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--python", help="the interpreter that has matplotlib; this one otherwise")
    parser.add_argument("--no-run", action="store_true", help="read the estimates of the last run")
    parser.add_argument("--dry", action="store_true", help="print the tables, write nothing")
    given = parser.parse_args()
    if given.python and not os.environ.get("BORESIGHT_BENCHMARKS"):
        os.environ["BORESIGHT_BENCHMARKS"] = "1"
        try:
            os.execv(given.python, [given.python, *sys.argv])
        except OSError as error:
            parser.error(f"--python is {given.python}: {error.strerror}")
    return given


def estimates():
    """Median time of every benchmark, ns: by group, function and value."""
    command = ["cargo", "metadata", "--no-deps", "--format-version", "1"]
    metadata = json.loads(subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, check=True).stdout)
    found = {}
    for file in pathlib.Path(metadata["target_directory"], "criterion").glob("**/new/benchmark.json"):
        name = json.loads(file.read_text())
        estimate = json.loads((file.parent / "estimates.json").read_text())
        group = found.setdefault(name["group_id"], {}).setdefault(name["function_id"], {})
        group[name["value_str"]] = estimate["median"]["point_estimate"]
    return found


def by_number(values):
    return sorted(values, key=int)


def size_table(found):
    """ns a pixel by the size of the frame, the floors beside them."""
    sizes = by_number(found["size"]["even"])
    head = ["frame of 160 stars, ns a pixel", *(f"{int(size) / 1000:g} Mpx" for size in sizes)]
    lines = {DETECTOR_WORDS[name]: found["size"][name] for name in DETECTORS}
    lines["floor: the image's memory filled"] = found["floor"]["memory filled"]
    lines["floor: a 64-bit random word a pixel, one by one"] = found["floor"]["random words one by one"]
    lines["far-range pipeline, 160 stars"] = found["pipeline"]["size"]
    lines["floor: one read of every pixel"] = found["pipeline floor"]["largest pixel"]
    rows = [[f"{line[size] / (1000 * int(size)):.3f}" for size in sizes] for line in lines.values()]
    return page.table(head, rows, lines)


def star_table(found):
    counts = by_number(found["stars"]["even"])
    head = ["frame of 1 Mpx, ms", *(f"{int(count):,} stars" for count in counts)]
    rows = [[f"{found['stars'][name][count] / 1e6:.2f}" for count in counts] for name in DETECTORS]
    return page.table(head, rows, [DETECTOR_WORDS[name] for name in DETECTORS])


def pipeline_star_table(found):
    counts = by_number(found["pipeline"]["stars"])
    head = ["frame of 752 × 580 pixels, ms", *(f"{int(count):,} stars" for count in counts)]
    return page.table(head, [[f"{found['pipeline']['stars'][count] / 1e6:.3f}" for count in counts]], ["far-range pipeline"])


def stage_table(found):
    head = ["stage of a frame of 752 × 580 pixels, ms", *(DETECTOR_WORDS[name] for name in DETECTORS)]
    rows = [[f"{stage[name] / 1e6:.3f}" for name in DETECTORS] for stage in found["stage"].values()]
    return page.table(head, rows, found["stage"])


def argon_table(found):
    starts = by_number(found["argon"]["40 regions"])
    head = ["complete frame of ARGON, ms", *(f"day {DAYS[start]}" for start in starts)]
    rows = [[f"{drawn[start] / 1e6:.2f}" for start in starts] for drawn in found["argon"].values()]
    return page.table(head, rows, found["argon"])


def chart(found, file):
    """Cost against size and against the number of stars, on logarithmic axes."""
    import matplotlib

    matplotlib.use("svg")
    # Equal numbers give equal files.
    matplotlib.rcParams.update({"svg.hashsalt": "boresight", "svg.fonttype": "none", "font.size": 9})
    from matplotlib import pyplot

    figure, (by_size, by_stars) = pyplot.subplots(1, 2, figsize=(9, 3.6), layout="constrained", sharey=True)

    def line(axes, values, scale, **style):
        numbers = by_number(values)
        axes.plot([int(n) * scale for n in numbers], [values[n] / 1e6 for n in numbers], **style)

    colours = ["#0072b2", "#d55e00", "#009e73"]
    for name, colour in zip(DETECTORS, colours):
        style = {"color": colour, "marker": "o", "markersize": 4, "label": DETECTOR_WORDS[name]}
        line(by_size, found["size"][name], 1e-3, **style)
        line(by_stars, found["stars"][name], 1, **style)
    line(by_size, found["pipeline"]["size"], 1e-3, color="#cc79a7", marker="s", markersize=4, label="pipeline")
    floors = [("memory filled", ":"), ("random words one by one", "--")]
    for name, dashes in floors:
        line(by_size, found["floor"][name], 1e-3, color="#555555", linestyle=dashes, label=f"floor: {name}")
    by_size.set(xlabel="Mpx, 160 stars", ylabel="ms a frame")
    by_stars.set(xlabel="stars on 1 Mpx")
    for axes in (by_size, by_stars):
        axes.set(xscale="log", yscale="log")
        axes.grid(alpha=0.3)
        axes.legend(fontsize=7, frameon=False)
    figure.savefig(file, metadata={"Date": None})


def main():
    given = arguments()
    if not given.no_run:
        for package, benchmark in BENCHMARKS:
            command = ["cargo", "bench", "-p", package, "--bench", benchmark, "--", "--noplot"]
            if subprocess.run(command, cwd=ROOT, stdout=sys.stderr).returncode != 0:
                sys.exit(2)
    found = estimates()
    try:
        tables = [make(found) for make in (argon_table, stage_table, size_table, star_table, pipeline_star_table)]
    except KeyError as missing:
        print(f"criterion has no estimate of {missing}: run without --no-run", file=sys.stderr)
        sys.exit(2)
    text = "\n\n".join([f"{page.machine()}.", *tables, "![Cost against size and star count](cost.svg)"])
    if given.dry:
        print(text)
        return
    try:
        chart(found, page.FOLDER / "cost.svg")
    except ImportError as error:
        print(f"{error}; {sys.executable} needs docs/evidence/speed/requirements.txt", file=sys.stderr)
        sys.exit(2)
    report = {"machine": page.machine(), "median_ns": found}
    (page.FOLDER / "benchmarks.json").write_text(json.dumps(report, indent=1, sort_keys=True) + "\n")
    page.replace("benchmarks", text)


if __name__ == "__main__":
    main()
