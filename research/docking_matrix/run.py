#!/usr/bin/env python3
"""Docking on degraded television: kinds of degradation by ffmpeg and OpenCV (degrade.py), at three ranges, in
several motions.

    python3 research/docking_matrix/run.py --boresight target/release/boresight                # 1000 fields a cell
    python3 research/docking_matrix/run.py --boresight target/release/boresight --blocks 1     # 40 fields a cell, minutes
    python3 research/docking_matrix/run.py --boresight ... --blocks 1 --fields 12 --kinds none "blur 3" --check
    python3 research/docking_matrix/run.py --boresight ... --blocks 2 --cache CLEAN --kinds all --json CELLS

A cell is a kind, a range and a motion, measured in blocks of consecutive fields, each block by a new
pipeline. `constant` moves at constant velocity before a camera with noise only; `approach` is the scenario
`docking` with every artefact. `lateral` is `constant` at 0.3 m/s across, with jitter of the lines too; `roll N` is
`constant` with a roll of N degrees. `defocus` is not degraded: the simulator's lens has the blur. Printed per cell:
the share of measured, doubtful and grossly wrong fields, the share of wrong and not doubtful fields with the
upper end of its 95 % interval (Clopper and Pearson), NEES over its dimension, and the share of motion
parameters within 3 σ.

--renderer mitsuba renders the scene by Mitsuba (docs/evidence/mitsuba.md): half a minute of CPU a field at 64 rays,
which allows a sample of six fields a block; its images are kept in --mitsuba-cache.

    python3 research/docking_matrix/run.py --boresight ... --renderer mitsuba --mitsuba venv/bin/mitsuba --blocks 1 --fields 6 --motions constant

--check: exit status 1 when a field is grossly wrong and not doubtful, or a cell's NEES is above --max-nees.

Needs ffmpeg and the packages of requirements.txt.
"""

import argparse
import concurrent.futures
import hashlib
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile

import cv2
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

import degrade

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIO = ROOT / "scenarios" / "docking.toml"
PRINCIPAL_PX = (383.5, 287.5)
SEED = 27

# Constant velocity: d3 at the beginning and its rate; approach: first and last field of the scenario. Even
# numbers: whole frames.
RANGES = {
    "far": {"d3_m": 44.0, "rate_m_s": -0.6, "fields": (15850, 16550)},
    "middle": {"d3_m": 20.0, "rate_m_s": -0.4, "fields": (16850, 17650)},
    "near": {"d3_m": 5.0, "rate_m_s": -0.1, "fields": (21900, 22700)},
}
# Blur of the simulator's lens, px, at a distance.
ROLLS_DEG = [30, 45, 50, 60, 90, 135, 180]
DEFOCUS = [(2.2, 27.0), (3.0, 27.0), (5.0, 20.0), (3.0, 55.0)]


def scenario(approach_toml, blur_px=0.7, is_quiet=True, artefacts=("noise",)):
    """The scenario of this tree with another approach and blur; `quiet` keeps only these artefacts of the
    television."""
    kept_sections = [f"television.{name}" for name in artefacts]
    lines, section, kept = SCENARIO.read_text().splitlines(), "", []
    for line in lines:
        if line.startswith("["):
            section = line.strip("[] ").split("]")[0]
        is_dropped = section.startswith("approach") or (
            is_quiet and section.startswith("television.") and section not in kept_sections)
        if not is_dropped:
            kept.append(f"blur_sigma_px = {blur_px}" if line.startswith("blur_sigma_px") else line)
    return "\n".join(kept) + "\n" + approach_toml


def constant_velocity(d3_m, rate_m_s, count, lateral_m_s=0.01, roll_deg=0.5):
    begin_m = 0.012 * d3_m - (lateral_m_s - 0.01) * count / 100
    return f"""
[approach]
kind = "constant_velocity"
position_m = [{begin_m}, {-0.008 * d3_m}, {d3_m}]
velocity_m_s = [{lateral_m_s}, -0.005, {rate_m_s}]
phi_deg = [0.3, -0.2, {roll_deg}]
phi_rate_deg_s = [0.02, 0.01, -0.03]
duration_s = {(count + 2) / 50}
"""


class Cell:
    def __init__(self, motion, range_name, kind):
        self.motion, self.range, self.kind = motion, range_name, kind
        self.fields = self.measured = self.doubtful = self.wrong = self.wrong_doubtful = self.successes = 0
        self.nees_sum = self.nees_count = self.within_sum = self.within_count = 0.0

    def add(self, score):
        figures = score["figures"]

        def pooled(name):
            """Sum of a figure's values and their number; the sum of a rate is its `count`."""
            figure = figures.get(name) or {}
            value, number = figure.get("value"), figure.get("count" if name == "nees_mean" else "of", 0)
            return (0.0, 0) if value is None else (value * number, number)

        frames = score["frames"]
        self.fields += frames
        self.measured += round(pooled("measured_rate")[0])
        self.doubtful += round(pooled("doubtful_rate")[0])
        self.wrong_doubtful += round(pooled("doubtful_wrong_rate")[0])
        self.wrong += sum(score["wrong"].values())
        nees, count = pooled("nees_mean")
        self.nees_sum, self.nees_count = self.nees_sum + nees, self.nees_count + count
        within, count = pooled("motion_within_3_sigma")
        self.within_sum, self.within_count = self.within_sum + within, self.within_count + count

    def row(self):
        nees = f"{self.nees_sum / self.nees_count:8.2f}" if self.nees_count else "       -"
        within = f"{100 * self.within_sum / self.within_count:7.1f}" if self.within_count else "      -"
        n = max(self.fields, 1)
        return (f"{self.motion:9} {self.range:12} {self.kind:15} {self.fields:6} {100 * self.measured / n:7.1f} "
                f"{100 * self.doubtful / n:7.1f} {self.wrong:6} {100 * upper(self.wrong, n):7.2f} {nees} {within}")


HEAD = ("motion    range        kind                    fields measured doubtful wrong  <= %     NEES  motion within 3 sigma, %\n"
        "                                                           %        %")


def upper(count, of):
    """Upper end of the two-sided 95 % interval of a rate (Clopper and Pearson 1934); one-sided for a count of
    0."""
    if count >= of:
        return 1.0
    if count == 0:
        return 1.0 - 0.05 ** (1.0 / of)
    low, high = count / of, 1.0

    def at_most(p):
        terms = (math.lgamma(of + 1) - math.lgamma(k + 1) - math.lgamma(of - k + 1)
                 + k * math.log(p) + (of - k) * math.log1p(-p) for k in range(count + 1))
        return sum(map(math.exp, terms))

    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if at_most(middle) > 0.025 else (low, middle)
    return high


def boresight(program, *words):
    return subprocess.run([program, *map(str, words)], cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout


def turned_truth(table, turn_deg):
    """The truth of a camera that sees the turned picture: exp([phi']) = exp([phi]) Rz(-turn); see
    degrade.turned."""
    half = -0.5 * math.radians(turn_deg)
    turn = np.array([math.cos(half), 0.0, 0.0, math.sin(half)])

    def quaternion(v):
        angle = np.linalg.norm(v)
        return np.array([math.cos(angle / 2), *(0.5 * np.sinc(angle / 2 / math.pi) * v)])

    def product(a, b):
        return np.array([a[0] * b[0] - a[1:] @ b[1:], *(a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:]))])

    def vector(q):
        sine = np.linalg.norm(q[1:])
        return q[1:] * (2 * math.atan2(sine, q[0]) / sine if sine > 0 else 2.0)

    columns = {name: table[name].to_numpy().copy() for name in table.column_names
               if name.startswith("phi") and name.endswith(("_deg", "_deg_s"))}
    step = 1e-4
    for i in range(table.num_rows):
        phi = np.radians([columns[f"phi{k}_deg"][i] for k in (1, 2, 3)])
        rate = np.radians([columns[f"phi{k}_rate_deg_s"][i] for k in (1, 2, 3)])
        now = vector(product(quaternion(phi), turn))
        later = vector(product(quaternion(phi + step * rate), turn))
        for k in range(3):
            columns[f"phi{k + 1}_deg"][i] = math.degrees(now[k])
            columns[f"phi{k + 1}_rate_deg_s"][i] = math.degrees((later - now)[k] / step)
    for name, values in columns.items():
        index = table.column_names.index(name)
        table = table.set_column(index, table.schema.field(index), pa.array(values))
    return table


def render(arguments, work, toml, first, seed):
    """A dataset of a block's fields: rendered, or from the cache when program and scenario are the same."""
    frames = f"{first}..{first + arguments.fields}"
    words = ["render", "scenario.toml", "--frames", frames, "--seed", seed, "--jobs", 1]
    if arguments.renderer == "mitsuba":
        words += ["--renderer", "mitsuba", "--mitsuba-rays", arguments.mitsuba_rays]
        words += ["--mitsuba", arguments.mitsuba] if arguments.mitsuba else []
        words += ["--mitsuba-cache", arguments.mitsuba_cache] if arguments.mitsuba_cache else []
    if arguments.cache:
        digest = hashlib.sha256(f"{toml} {words}".encode()).hexdigest()[:20]
        work = arguments.cache / digest
        if (work / "complete").exists():
            return work / "clean"
        shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    (work / "scenario.toml").write_text(toml)
    words[1] = work / "scenario.toml"
    boresight(arguments.boresight, *words, "--out", work / "clean")
    (work / "complete").touch()
    return work / "clean"


def measure(arguments, clean, work, kind, first, keep):
    """Degrades a dataset, measures and scores it. `keep`: copy of the measurements."""
    degradation = degrade.KINDS[kind]
    shutil.copytree(clean, work)
    if kind != "none":
        files = sorted((work / "frames").iterdir())
        fields = np.stack([cv2.imread(str(file), cv2.IMREAD_UNCHANGED) for file in files])
        scene = {"principal": PRINCIPAL_PX, "first_is_odd": first % 2, "seed": SEED + first}
        for file, field in zip(files, degradation.function(fields, scene)):
            cv2.imwrite(str(file), field, [cv2.IMWRITE_PNG_COMPRESSION, 1])
        (work / "SHA256SUMS").unlink(missing_ok=True)
    truth = work / "truth" / "fields.parquet"
    if degradation.turn_deg:
        pq.write_table(turned_truth(pq.read_table(truth), degradation.turn_deg), truth)
    boresight(arguments.boresight, "process", work)
    score = json.loads(boresight(arguments.boresight, "score", work, work / "measurements.csv", "--json"))
    if keep:
        keep.mkdir(parents=True, exist_ok=True)
        shutil.copy(work / "measurements.csv", keep / "measurements.csv")
        shutil.copy(truth, keep / "fields.parquet")
    shutil.rmtree(work)
    return score["score"] if "score" in score else score


def jobs(arguments):
    """(motion, range name, scenario, first field, kinds) of every block."""
    count = arguments.fields
    for name, at in RANGES.items():
        if arguments.ranges and name not in arguments.ranges:
            continue
        for block in range(arguments.blocks):
            d3_m = at["d3_m"] + at["rate_m_s"] * block * count / 50
            toml = scenario(constant_velocity(d3_m, at["rate_m_s"], count))
            if "constant" in arguments.motions:
                yield "constant", name, toml, 0, arguments.kinds, block
            if "lateral" in arguments.motions:
                moving = constant_velocity(d3_m, at["rate_m_s"], count, lateral_m_s=0.3)
                yield "lateral", name, scenario(moving, artefacts=("noise", "line_jitter")), 0, arguments.kinds, block
            for roll_deg in ROLLS_DEG:
                if f"roll {roll_deg}" in arguments.motions:
                    rolled = scenario(constant_velocity(d3_m, at["rate_m_s"], count, roll_deg=roll_deg))
                    yield f"roll {roll_deg}", name, rolled, 0, arguments.kinds, block
            first, last = at["fields"]
            spread = max(last - first - count, 0) / max(arguments.blocks - 1, 1)
            begin = first + 2 * int(spread * block / 2)
            if "approach" in arguments.motions:
                yield "approach", name, SCENARIO.read_text(), begin, arguments.kinds, block
    if "defocus" in arguments.motions:
        for blur_px, d3_m in DEFOCUS:
            for block in range(arguments.blocks):
                toml = scenario(constant_velocity(d3_m - 0.2 * block, -0.3, count), blur_px, is_quiet=False)
                yield "defocus", f"{blur_px} px {d3_m:.0f} m", toml, 0, ["none"], block


def block(arguments, scratch, job):
    motion, name, toml, first, kinds, number = job
    place = f"{motion}-{name}-{number}".replace(" ", "_")
    work = pathlib.Path(scratch) / place
    clean = render(arguments, work, toml, first, SEED + number)
    work.mkdir(exist_ok=True)
    scores = []
    for kind in kinds:
        keep = arguments.keep and arguments.keep / kind.replace(" ", "_") / place
        scores.append((kind, measure(arguments, clean, work / "degraded", kind, first, keep)))
    shutil.rmtree(work)
    return motion, name, scores


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--boresight", required=True, type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("--blocks", type=int, default=25, help="blocks of a cell")
    parser.add_argument("--fields", type=int, default=40, help="fields of a block")
    parser.add_argument("--kinds", nargs="+", default=degrade.FIRST, choices=[*degrade.KINDS, "every", "new"],
                        metavar="KIND", help="kinds of degrade.py; `every`, or `new`: without those of the first matrix")
    parser.add_argument("--ranges", nargs="+", default=[], choices=list(RANGES))
    parser.add_argument("--motions", nargs="+", default=["constant", "approach", "defocus"])
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--renderer", choices=["fast", "mitsuba"], default="fast")
    parser.add_argument("--mitsuba", help="command of Mitsuba")
    parser.add_argument("--mitsuba-rays", type=int, default=64, help="a square number")
    parser.add_argument("--mitsuba-cache", type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--cache", type=lambda path: pathlib.Path(path).resolve(),
                        help="folder for clean renderings, used again for the same scenario and fields")
    parser.add_argument("--keep", type=pathlib.Path, help="copy measurements and truth of every block here")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--max-nees", type=float, default=math.inf)
    parser.add_argument("--json", type=pathlib.Path, help="write the cells here too")
    arguments = parser.parse_args()
    if "every" in arguments.kinds:
        arguments.kinds = list(degrade.KINDS)
    elif "new" in arguments.kinds:
        arguments.kinds = ["none", *(kind for kind in degrade.KINDS if kind not in degrade.FIRST)]
    cells = {}
    with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for motion, name, scores in pool.map(lambda job: block(arguments, scratch, job), jobs(arguments)):
            for kind, score in scores:
                cells.setdefault((motion, name, kind), Cell(motion, name, kind)).add(score)
    print(HEAD)
    for cell in cells.values():
        print(cell.row())
    fields, wrong = (sum(getattr(cell, what) for cell in cells.values()) for what in ("fields", "wrong"))
    print(f"\nwrong and not doubtful: {wrong} of {fields}, upper end {100 * upper(wrong, fields):.3f} %")
    if arguments.json:
        arguments.json.write_text(json.dumps([vars(cell) for cell in cells.values()], indent=1))
    if arguments.check:
        bad = [cell for cell in cells.values()
               if cell.wrong or cell.nees_count and cell.nees_sum / cell.nees_count > arguments.max_nees]
        for cell in bad:
            print("FAIL", cell.row())
        return 1 if bad else 0
    return 0


if __name__ == "__main__":
    sys.exit(main())
