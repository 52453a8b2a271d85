#!/usr/bin/env python3
"""Recomputes the score's figures of covariances with numpy, from the files only.

    check_covariances.py BORESIGHT DATASET

Makes measurements of a rendered far-range dataset: true positions and lines of sight with normal errors of
known covariances, in which every third frame is scaled so that covariances are too small by half. Runs
`BORESIGHT score` on them, and computes NEES, shares within 1 and 3 sigma and the rows of `consistency` from
`measurements.csv` and the tables of truth, by the definitions of docs/evidence/score.md and with matrices inverted by
numpy.

Prints a line a figure; exit 0 when all agree to 1e-9, 1 when one does not.
"""

import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import pyarrow.parquet

TOLERANCE = 1e-9
SMALL = 0.02  # the share from which on an image is cut or merged


def matrix(quaternion):
    w, x, y, z = quaternion
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


def table(path):
    return pyarrow.parquet.read_table(path).to_pylist()


def covariance(sigma_x, sigma_y, rho):
    return np.array([[sigma_x**2, rho * sigma_x * sigma_y], [rho * sigma_x * sigma_y, sigma_y**2]])


def angles(vector):
    return np.array([np.arctan2(vector[0], vector[2]), np.arctan2(vector[1], vector[2])])


def camera_from_icrs(frame):
    return matrix([frame[f"q_cam_j2000_{axis}"] for axis in "wxyz"])


def line_of_sight(row):
    return np.array([float(row[f"los_j2000_{axis}"]) for axis in "xyz"])


def target_of(objects):
    return next((o for o in objects if o["kind"] == "target"), None)


def make(frames, objects, path):
    """Measurements whose errors have the stated covariances, except for every third."""
    random = np.random.default_rng(7)
    rows = []
    for index, frame in enumerate(frames):
        target = target_of(objects[frame["frame"]])
        if target is None:
            continue
        row = {"frame": frame["frame"], "status": "detected", "attitude": ["stars", "too_few_stars", "no_match", ""][index % 4]}
        scale = 2.0 if index % 3 == 0 else 1.0
        px = (0.02 + 0.05 * random.random(), 0.02 + 0.05 * random.random(), 1.8 * random.random() - 0.9)
        x, y = [target["x_px"], target["y_px"]] + scale * random.multivariate_normal([0, 0], covariance(*px))
        deg = (0.001 + 0.01 * random.random(), 0.001 + 0.01 * random.random(), 1.8 * random.random() - 0.9)
        turn = camera_from_icrs(frame)
        error = np.radians(scale * random.multivariate_normal([0, 0], covariance(*deg)))
        measured = np.tan(angles(turn @ [frame[f"los_j2000_{axis}"] for axis in "xyz"]) + error)
        los = turn.T @ (np.append(measured, 1) / np.linalg.norm(np.append(measured, 1)))
        row |= {"x_px": x, "y_px": y} | {f"los_j2000_{axis}": value for axis, value in zip("xyz", los)}
        if index % 5:
            row |= dict(zip(["sigma_x_px", "sigma_y_px", "correlation_xy"], px))
        if index % 7:
            row |= dict(zip(["sigma_ra_deg", "sigma_dec_deg", "correlation_ra_dec"], deg))
        rows.append(row)
    names = list(dict.fromkeys(name for row in rows for name in row))
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, names, restval="")
        writer.writeheader()
        writer.writerows(rows)


def distance(a, b, bloom):
    return np.hypot(a["x_px"] - b["x_px"], max(abs(a["y_px"] - b["y_px"]) - bloom, 0))


def reach(o):
    return max(o["radius_px"], 1.5)


def holds(place, o):
    return distance(place, o, o["bloom_px"] / 2) <= max(o["radius_px"] / 2, 1.5)


def electrons(o):
    return o["electrons"] * (1 - o["cut"])


def judged(row, objects):
    """The state of the image of a correct answer; None of a wrong one."""
    target, place = target_of(objects), {"x_px": float(row["x_px"]), "y_px": float(row["y_px"])}
    others = [o for o in objects if o is not target]
    if not holds(place, target) or electrons(target) <= sum(electrons(o) for o in others if holds(place, o)):
        return None
    near = [o for o in others
            if holds(place, o) or distance(target, o, target["bloom_px"] + o["bloom_px"]) <= reach(target) + reach(o)]  # fmt: skip
    share = sum(map(electrons, near))
    return "merged" if share > SMALL * (electrons(target) + share) else "cut" if target["cut"] >= SMALL else "whole"


def normalised(error, stated):
    """NEES per dimension and both errors over their sigmas."""
    if "" in stated:
        return None
    c = covariance(*map(float, stated))
    return error @ np.linalg.inv(c) @ error / 2, error / np.sqrt(np.diag(c))


def figures(errors):
    of = {}
    for key, chosen in zip(["centroid", "line_of_sight"], zip(*errors) if errors else [[], []]):
        chosen = [error for error in chosen if error is not None]
        of[f"{key}_nees_mean"] = np.mean([nees for nees, _ in chosen]) if chosen else None
        for n in (1, 3):
            # A frame is the share of its two components.
            within = [np.mean(np.abs(over) <= n) for _, over in chosen]
            of[f"{key}_within_{n}sigma_rate"] = np.mean(within) if chosen else None
    return of


def main(boresight, dataset):
    dataset = pathlib.Path(dataset)
    frames = table(dataset / "truth/frames.parquet")
    objects = {frame["frame"]: [] for frame in frames}
    for o in table(dataset / "truth/objects.parquet"):
        objects[o["frame"]].append(o)
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "measurements.csv"
        make(frames, objects, path)
        answer = subprocess.run([boresight, "score", dataset, path, "--json"], check=True, stdout=subprocess.PIPE)
        with open(path, newline="") as file:
            rows = {int(row["frame"]): row for row in csv.DictReader(file)}
    score = json.loads(answer.stdout)

    correct = []
    for frame in frames:
        row, of_frame = rows.get(frame["frame"]), objects[frame["frame"]]
        state = row and judged(row, of_frame)
        if state is None:
            continue
        target = target_of(of_frame)
        place = np.array([float(row["x_px"]) - target["x_px"], float(row["y_px"]) - target["y_px"]])
        turn = camera_from_icrs(frame)
        truth = angles(turn @ [frame[f"los_j2000_{axis}"] for axis in "xyz"])
        direction = np.degrees(angles(turn @ line_of_sight(row)) - truth)
        errors = (
            normalised(place, [row["sigma_x_px"], row["sigma_y_px"], row["correlation_xy"]]),
            normalised(direction, [row["sigma_ra_deg"], row["sigma_dec_deg"], row["correlation_ra_dec"]]),
        )
        correct.append((state, row["attitude"] or "unstated", errors))

    failed = score["figures"]["correct_rate"]["count"] != len(correct)
    print(f"{'FAIL' if failed else 'ok  '} correct: {score['figures']['correct_rate']['count']}, here {len(correct)}")
    expected = {("all", ""): [errors for _, _, errors in correct]}
    for state, attitude, errors in correct:
        if any(error is not None for error in errors):
            expected.setdefault(("image", state), []).append(errors)
            expected.setdefault(("attitude", attitude), []).append(errors)
    found = {("all", ""): score["figures"]} | {(row["by"], row["value"]): row["figures"] for row in score["consistency"]}
    if set(found) != set(expected):
        failed = True
        print(f"FAIL rows: {sorted(found)}, here {sorted(expected)}")
    for kind in sorted(set(found) & set(expected)):
        for name, value in figures(expected[kind]).items():
            of_score = found[kind][name]["value"]
            same = of_score == value if None in (of_score, value) else abs(of_score - value) <= TOLERANCE * max(1, abs(value))
            failed |= not same
            print(f"{'ok  ' if same else 'FAIL'} {' '.join(kind).strip()} {name}: {of_score}, here {value}")
    return failed


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
