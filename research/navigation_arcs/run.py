#!/usr/bin/env python3
"""Determines the relative orbit at each ground contact from the lines of sight of the hours before.

    python3 research/navigation_arcs/run.py RUN [--boresight target/release/boresight] [--hours 24]

RUN is the directory of a far-range run. A contact is every six hours after the first line of sight. For each, the
measurements of the last HOURS are given to `boresight navigate`, in a directory of their own. The program prints
the root mean square errors over the last orbit in R, T, N, m, and their root mean square over all contacts.
"""

import argparse
import csv
import datetime
import pathlib
import shutil
import subprocess
import tempfile

CONTACT = datetime.timedelta(hours=6)
ORBIT_S = 6000.0
EVERY_S = 600.0


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def time(text):
    return datetime.datetime.fromisoformat(text[:19])


def last_orbit(run, boresight, measurements):
    """Root mean square errors in R, T, N, m, of an orbit from these measurements; None without an estimate."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name in ("run.toml", "camera.toml", "telemetry.csv"):
            shutil.copy(run / name, folder)
        with open(folder / "measurements.csv", "w", newline="") as file:
            writer = csv.DictWriter(file, measurements[0].keys(), lineterminator="\n")
            writer.writeheader()
            writer.writerows(measurements)
        out = folder / "out"
        subprocess.run([boresight, "navigate", folder, "--every", str(EVERY_S), "--out", out],
                       capture_output=True, check=False)
        if not (out / "navigation.csv").exists():
            return None
        estimated = [row for row in rows(out / "navigation.csv") if row["status"] == "estimated"]
    last = estimated[-int(ORBIT_S / EVERY_S):]
    return [root_mean_square(float(row[f"error_{axis}_m"]) for row in last) for axis in "rtn"] if last else None


def root_mean_square(values):
    values = list(values)
    return (sum(value * value for value in values) / len(values)) ** 0.5


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=pathlib.Path)
    parser.add_argument("--boresight", default="target/release/boresight")
    parser.add_argument("--hours", type=float, default=24.0)
    arguments = parser.parse_args()
    times = {row["frame"]: time(row["time_utc"]) for row in rows(arguments.run / "telemetry.csv")}
    measurements = [row for row in rows(arguments.run / "measurements.csv") if row["status"] == "detected"]
    first, last = times[measurements[0]["frame"]], times[measurements[-1]["frame"]]
    errors, contact = [], first.replace(minute=0, second=0) + 4 * CONTACT
    while contact < last + CONTACT:
        begin = contact - datetime.timedelta(hours=arguments.hours)
        arc = [row for row in measurements if begin <= times[row["frame"]] < contact]
        error = last_orbit(arguments.run, arguments.boresight, arc) if arc else None
        if error:
            errors.append(error)
            print(contact.isoformat(), len(arc), *(f"{value:.2f}" for value in error), flush=True)
        contact += CONTACT
    print("all contacts", *(f"{root_mean_square(column):.2f}" for column in zip(*errors)))


if __name__ == "__main__":
    main()
