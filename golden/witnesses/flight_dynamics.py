"""Reads messages that `boresight export` writes with packages of others, and compares them with the run.

    python3 golden/witnesses/flight_dynamics.py target/debug/boresight

Needs `oem` (MIT) and `ccsds-ndm` (GPL-3.0, used as a program), pinned in flight_dynamics_requirements.txt, and
pyarrow for the truth tables. `ok` lines are the claims that hold; exit status 1 if one does not.
"""

import csv
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import pyarrow.parquet
from astropy.time import Time
from ccsds_ndm.ndm_io import NdmIo
from oem import OrbitEphemerisMessage

FAILED = []


def claim(holds, text):
    print(("ok   " if holds else "FAIL ") + text)
    if not holds:
        FAILED.append(text)


def times(stamps):
    """Times of a truth table: nanoseconds of UTC."""
    return Time([stamp.as_py().isoformat().replace("+00:00", "") for stamp in stamps], scale="utc")


def main(program):
    program = pathlib.Path(program).resolve()
    with tempfile.TemporaryDirectory() as folder:
        run = pathlib.Path(folder) / "run"

        def boresight(*words):
            subprocess.run([program, *map(str, words)], cwd=folder, check=True, stdout=subprocess.DEVNULL)

        # Day 1 begins at 07:00:00 with 15 s between frames: the manoeuvre of 08:44:50 is after frame 419.
        boresight("run", "argon", "--frames", "400..440", "--out", "run", "--jobs", "2")
        truth = pyarrow.parquet.read_table(run / "truth/frames.parquet")
        column = lambda name: np.array(truth.column(name).to_pylist())
        vector = lambda *names: np.stack([column(name) for name in names], axis=1)
        epochs = times(truth.column("time_utc"))
        position = vector("position_x_km", "position_y_km", "position_z_km")
        velocity = vector("velocity_x_km_s", "velocity_y_km_s", "velocity_z_km_s")
        sight = vector("los_j2000_x", "los_j2000_y", "los_j2000_z") * column("range_km")[:, None]
        attitude = vector("q_sc_j2000_w", "q_sc_j2000_x", "q_sc_j2000_y", "q_sc_j2000_z")

        for notation in ("kvn", "xml"):
            for thing, extra in [("oem", ["--object", "chaser"]), ("oem", ["--object", "target"]), ("aem", []), ("tdm", [])]:
                name = f"{'-'.join([thing, *extra[1:]])}.{notation}"
                boresight("export", "run", "--format", thing, *extra, "--notation", notation, "--out", name)

            for who, expected in [("chaser", position), ("target", position + sight)]:
                message = OrbitEphemerisMessage.open(pathlib.Path(folder) / f"oem-{who}.{notation}")
                states = [message(epoch) for epoch in epochs]
                worst = np.abs(np.array([state.position for state in states]) - expected).max()
                claim(worst < 1e-8, f"oem, {notation}, {who}: positions of {len(states)} frames to {worst:.0e} km")
                if who == "chaser":
                    worst = np.abs(np.array([state.velocity for state in states]) - velocity).max()
                    # `oem` evaluates polynomials in powers of seconds, which cost it digits.
                    claim(worst < 1e-7, f"oem, {notation}, chaser: velocities to {worst:.0e} km/s")
                read = NdmIo().from_path(pathlib.Path(folder) / f"oem-{who}.{notation}")
                segments = read.body.segment
                count = sum(len(segment.data.state_vector) for segment in segments)
                claim(count == sum(sum(1 for _ in segment.states) for segment in message.segments), f"ccsds-ndm, {notation}, {who}: {len(segments)} segments, {count} states")

            # A quaternion of CCSDS turns axes: the conjugate of ours, which turns components.
            aem = NdmIo().from_path(pathlib.Path(folder) / f"aem.{notation}")
            worst, count = 0.0, 0
            for segment in aem.body.segment:
                for state in segment.data.attitude_state:
                    read = state.quaternion_state.quaternion
                    ours = np.array([value(read.qc), -value(read.q1), -value(read.q2), -value(read.q3)])
                    worst = max(worst, 1 - abs(ours @ attitude[count]))
                    count += 1
            claim(count == len(attitude) and worst < 1e-14, f"ccsds-ndm, {notation}: {count} attitudes to {worst:.0e}")

            tdm = NdmIo().from_path(pathlib.Path(folder) / f"tdm.{notation}")
            angles = [(o.angle_1, o.angle_2) for segment in tdm.body.segment for o in segment.data.observation]
            ascensions = [float(value(a)) for a, _ in angles if a is not None]
            declinations = [float(value(d)) for _, d in angles if d is not None]
            rows = [row for row in csv.DictReader((run / "measurements.csv").open()) if row["los_j2000_x"]]
            directions = np.array([[float(row[f"los_j2000_{axis}"]) for axis in "xyz"] for row in rows])
            read = np.array([[math.cos(d) * math.cos(a), math.cos(d) * math.sin(a), math.sin(d)] for a, d in zip(np.radians(ascensions), np.radians(declinations))])
            worst = np.abs(read - directions).max() if read.shape == directions.shape else math.inf
            claim(len(rows) > 5 and worst < 1e-12, f"ccsds-ndm, {notation}: {len(read)} directions to {worst:.0e}")
    return 1 if FAILED else 0


def value(number):
    """A number with or without a unit."""
    return float(getattr(number, "value", number))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
