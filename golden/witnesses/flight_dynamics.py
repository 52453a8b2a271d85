"""Reads messages that `boresight export` writes with packages of others, and compares them with the run.

    python3 golden/witnesses/flight_dynamics.py target/debug/boresight

Needs `oem` (MIT), `ccsds-ndm` (GPL-3.0, used as a program) and Orekit (Apache-2.0, with Java 11 or later),
pinned in ../flight_dynamics/exported_requirements.txt, and pyarrow for the truth tables. `ok` lines are the claims that hold; exit status 1 if one does not.
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

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "flight_dynamics"))
import orekit_data

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
        boresight("navigate", "run", "--navigator", "sequential", "--every", "60", "--out", "nav")
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
            # Those of the frames lie between the begin of the first and the end of the last exposure.
            read = quaternions(aem)[1:-1]
            worst = (1 - np.abs((read * attitude).sum(axis=1))).max() if read.shape == attitude.shape else math.inf
            claim(worst < 1e-14, f"ccsds-ndm, {notation}: {len(read)} attitudes to {worst:.0e}")

            tdm = NdmIo().from_path(pathlib.Path(folder) / f"tdm.{notation}")
            angles = [(o.angle_1, o.angle_2) for segment in tdm.body.segment for o in segment.data.observation]
            ascensions = [float(value(a)) for a, _ in angles if a is not None]
            declinations = [float(value(d)) for _, d in angles if d is not None]
            rows = [row for row in csv.DictReader((run / "measurements.csv").open()) if row["los_j2000_x"]]
            directions = np.array([[float(row[f"los_j2000_{axis}"]) for axis in "xyz"] for row in rows])
            read = np.array([[math.cos(d) * math.cos(a), math.cos(d) * math.sin(a), math.sin(d)] for a, d in zip(np.radians(ascensions), np.radians(declinations))])
            worst = np.abs(read - directions).max() if read.shape == directions.shape else math.inf
            claim(len(rows) > 5 and worst < 1e-12, f"ccsds-ndm, {notation}: {len(read)} directions to {worst:.0e}")
            boresight("export", "run", "--format", "aem", "--estimates", "--frame", "camera", "--notation", notation, "--out", f"camera.{notation}")
            stated = list(csv.DictReader((run / "measurements.csv").open()))
            stated = np.array([[float(row[f"q_cam_j2000_{axis}"]) for axis in "wxyz"] for row in stated])
            aem = NdmIo().from_path(pathlib.Path(folder) / f"camera.{notation}")
            read = quaternions(aem)
            worst = (1 - np.abs((read * stated).sum(axis=1))).max() if read.shape == stated.shape else math.inf
            claim(worst < 1e-14, f"ccsds-ndm, {notation}: {len(read)} measured attitudes of the camera to {worst:.0e}")

        estimates(pathlib.Path(folder), boresight, epochs, position)
        orekit(pathlib.Path(folder), attitude)
    return 1 if FAILED else 0


def estimates(folder, boresight, epochs, chaser_km):
    """The exported orbit of the target against the table of the navigator: whole, and with a missing estimate."""
    table = folder / "nav" / "navigation.csv"
    rows = list(csv.DictReader(table.open()))
    numbers = lambda row, *names: np.array([float(row[name]) for name in names])
    for missing in (None, 4):
        if missing is not None:
            rows[missing] = {name: cell if name == "time_utc" or name.startswith("true_") else "" for name, cell in rows[missing].items()}
            rows[missing]["status"] = "no_convergence"
            with table.open("w", newline="") as file:
                writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows)
        for notation in ("kvn", "xml"):
            name = f"estimate-{missing}.{notation}"
            boresight("export", "run", "--format", "oem", "--estimates", "--navigation", "nav", "--notation", notation, "--out", name)
            message = OrbitEphemerisMessage.open(folder / name)
            read = NdmIo().from_path(folder / name).body.segment
            segments = list(message.segments)
            counts = [sum(1 for _ in segment.states) for segment in segments]
            expected = [len(rows)] if missing is None else [missing, len(rows) - missing - 1]
            claim(counts == expected and [len(segment.data.state_vector) for segment in read] == expected, f"oem, ccsds-ndm, {notation}: {counts} estimates by segment")
            states = [state for segment in segments for state in segment.states]
            covariances = [covariance for segment in segments for covariance in segment.covariances]
            claim(len(covariances) == len(states) == sum(len(segment.data.covariance_matrix) for segment in read), f"oem, ccsds-ndm, {notation}: {len(covariances)} covariances")
            worst_m, worst_sigma = 0.0, 0.0
            for row, state, covariance in zip([row for row in rows if row["status"] == "estimated"], states, covariances):
                # The frames are 15 s apart: one is at the time of each estimate.
                frame = np.abs((epochs - state.epoch).sec).argmin()
                radial = state.position / np.linalg.norm(state.position)
                normal = np.cross(state.position, state.velocity)
                normal /= np.linalg.norm(normal)
                axes = np.array([radial, np.cross(normal, radial), normal])
                relative_m = axes @ (chaser_km[frame] - state.position) * 1e3
                stated = numbers(row, "true_r_m", "true_t_m", "true_n_m") + numbers(row, "error_r_m", "error_t_m", "error_n_m")
                worst_m = max(worst_m, np.abs(relative_m - stated).max())
                sigma_t_m = math.sqrt((axes @ covariance.matrix[:3, :3] @ axes.T)[1, 1]) * 1e3
                worst_sigma = max(worst_sigma, abs(sigma_t_m / float(row["sigma_t_m"]) - 1))
            claim(worst_m < 1e-5, f"oem, {notation}: relative position of {len(states)} estimates to {worst_m:.0e} m")
            claim(worst_sigma < 0.01, f"oem, {notation}: standard deviation along T to {worst_sigma:.0e} of it")


def orekit(folder, attitude):
    """Compares the content that Orekit reads: states and times with those of `oem`, attitudes and angles with the run."""
    orekit_data.begin()
    from java.io import File
    from org.hipparchus.geometry.euclidean.threed import Vector3D
    from org.orekit.data import DataSource
    from org.orekit.files.ccsds.ndm import ParserBuilder
    from org.orekit.time import TimeScalesFactory

    tai = TimeScalesFactory.getTAI()
    parsers = ParserBuilder()
    parse = lambda parser, name: parser.parseMessage(DataSource(File(str(folder / name))))
    for notation in ("kvn", "xml"):
        for name in (f"oem-chaser.{notation}", f"oem-target.{notation}", f"estimate-4.{notation}"):
            segments = parse(parsers.buildOemParser(), name).getSegments()
            others = list(OrbitEphemerisMessage.open(folder / name).segments)
            worst_km, worst_s, count = 0.0, 0.0, 0
            for segment, other in zip(segments, others):
                coordinates = segment.getData().getCoordinates()
                states = list(other.states)
                for index in sorted({*range(0, len(states), 50), len(states) - 1}):
                    read, state = coordinates.get(index), states[index]
                    worst_km = max(worst_km, np.abs(np.array(read.getPosition().toArray()) / 1e3 - state.position).max())
                    stated = Time(str(read.getDate().toStringWithoutUtcOffset(tai, 9)), scale="tai")
                    worst_s = max(worst_s, abs((stated - state.epoch).sec))
                count += coordinates.size() if coordinates.size() == len(states) else math.nan
            claim(len(others) == segments.size() and count > 0 and worst_km < 1e-9 and worst_s < 1e-6, f"Orekit, {name}: {count} states, positions to {worst_km:.0e} km, times to {worst_s:.0e} s")
        coordinates = [c for segment in parse(parsers.buildAemParser(), f"aem.{notation}").getSegments() for c in segment.getAngularCoordinates()]
        # Orekit's rotation applied to an axis gives its components along the body, as our matrix.
        worst = 0.0
        for read, (w, x, y, z) in zip(coordinates[1:-1], attitude):
            first = [w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)]
            worst = max(worst, np.abs(np.array(read.getRotation().applyTo(Vector3D.PLUS_I).toArray()) - first).max())
        claim(len(coordinates) == len(attitude) + 2 and worst < 1e-12, f"Orekit, {notation}: {len(coordinates)} attitudes to {worst:.0e}")
        blocks = [segment.getData().getObservations() for segment in parse(parsers.buildTdmParser(), f"tdm.{notation}").getSegments()]
        rows = [row for row in csv.DictReader((folder / "run" / "measurements.csv").open()) if row["los_j2000_x"]]
        first = math.atan2(float(rows[0]["los_j2000_y"]), float(rows[0]["los_j2000_x"])) % (2 * math.pi)
        read = float(blocks[0].get(0).getMeasurement()) % (2 * math.pi)
        claim(blocks[0].size() == 2 * len(rows) and abs(read - first) < 1e-12, f"Orekit, {notation}: {blocks[0].size()} angles")


def quaternions(aem):
    """Our quaternions of an AEM that `ccsds-ndm` read, scalar first: a row per attitude."""
    read = [state.quaternion_state.quaternion for segment in aem.body.segment for state in segment.data.attitude_state]
    return np.array([[value(q.qc), -value(q.q1), -value(q.q2), -value(q.q3)] for q in read])


def value(number):
    """A number with or without a unit."""
    return float(getattr(number, "value", number))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
