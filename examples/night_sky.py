#!/usr/bin/env python3
"""Makes a folder of night-sky images for docs/tutorial-night-sky.md, or compares attitudes with the true
ones.

    python3 examples/night_sky.py make sky
    python3 examples/night_sky.py compare sky

Needs numpy. Uses nothing of Boresight except its copy of the Hipparcos catalogue (sim/data/hipparcos2.bin):
stars are Gaussians with Poisson noise, at the positions of the date of telemetry.csv (proper motion in a
straight line from the catalogue's epoch, J1991.25; no parallax and no aberration), imaged at random attitudes
by a camera of 24.1 x 19.3 degrees. The attitude in telemetry.csv is the identity. `sky-truth.csv`, beside the folder, has the
attitudes of the camera.
"""

import csv
import pathlib
import sys

import numpy as np

COLUMNS, ROWS, FOCAL_MM, PIXEL_UM, K1 = 1280, 1024, 16.0, 5.3, -2.0e-8
PRINCIPAL = (639.5, 511.5)
FRAMES, EXPOSURE_S, ZERO_MAGNITUDE_E_PER_S = 20, 0.5, 4.0e6
SIGMA_PX, GAIN_E_PER_DN, BIAS_DN, READ_NOISE_E, BACKGROUND_E = 0.9, 10.0, 100.0, 12.0, 60.0
HOT_PIXELS = 15
# Date of the images, and its distance from the epoch of the catalogue in Julian years.
DATE = "2026-03-01"
YEARS = 2026.164 - 1991.25

CAMERA = f"""bit_depth = 12
magnitude_limit = 7.0

[camera]
columns = {COLUMNS}
rows = {ROWS}
focal_length_mm = {FOCAL_MM}
pixel_width_um = {PIXEL_UM}
pixel_height_um = {PIXEL_UM}
principal_x_px = {PRINCIPAL[0]}
principal_y_px = {PRINCIPAL[1]}
radial = [{K1}, 0.0, 0.0]
tangential = [0.0, 0.0]

[far_range]
mode = "best"
aberration = "ignore" # these images have none; leave this line out for a real sky

[far_range.best]
sequence = false
prior = "none"
"""


def stars():
    """Unit vectors of the date and magnitudes (Hp) of Hipparcos to 8.5; the format is at the head of
    sim/data/make_hipparcos2.py."""
    here = pathlib.Path(__file__).resolve().parent
    # `boresight examples` writes the catalogue beside this file; in the source tree the simulator has it.
    places = (here / "hipparcos2.bin", here.parent / "sim/data/hipparcos2.bin")
    data = next(place for place in places if place.exists()).read_bytes()[48:]
    rows = np.frombuffer(data, np.uint8).reshape(-1, 29).astype(np.int64)

    def number(first, size):
        value = sum(rows[:, first + i] << (8 * i) for i in range(size))
        return np.where(value >> (8 * size - 1), value - (1 << (8 * size)), value)

    ra = sum(rows[:, 3 + i] << (8 * i) for i in range(5)) * 1e-10
    dec, magnitude = number(8, 5) * 1e-10, number(22, 3) * 1e-4
    # From units of 0.01 mas per year; the motion in right ascension is that along the parallel.
    along_ra, along_dec = (np.radians(number(first, 3) * 1e-5 / 3600) * YEARS for first in (16, 19))
    east = np.stack([-np.sin(ra), np.cos(ra), np.zeros_like(ra)], axis=1)
    north = np.stack([-np.sin(dec) * np.cos(ra), -np.sin(dec) * np.sin(ra), np.cos(dec)], axis=1)
    vectors = np.stack([np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)], axis=1)
    vectors = vectors + along_ra[:, None] * east + along_dec[:, None] * north
    vectors /= np.linalg.norm(vectors, axis=1)[:, None]
    return vectors[magnitude < 8.5], magnitude[magnitude < 8.5]


def matrix(q):
    """The matrix of v_to = q v q*, scalar first."""
    w, x, y, z = q
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


def image(random, vectors, magnitudes, q):
    seen = vectors @ matrix(q).T
    front = seen[:, 2] > 0.8
    focal_px = 1e3 * FOCAL_MM / PIXEL_UM
    u, v = (focal_px * seen[front, i] / seen[front, 2] for i in (0, 1))
    scale = 1 + K1 * (u * u + v * v)
    x, y = PRINCIPAL[0] + u * scale, PRINCIPAL[1] + v * scale
    electrons = EXPOSURE_S * ZERO_MAGNITUDE_E_PER_S * 10 ** (-0.4 * magnitudes[front])
    expected = np.full((ROWS, COLUMNS), BACKGROUND_E)
    for x, y, electrons in zip(x, y, electrons):
        left, top = int(np.floor(x)) - 8, int(np.floor(y)) - 8
        columns = np.arange(max(left, 0), min(left + 17, COLUMNS))
        lines = np.arange(max(top, 0), min(top + 17, ROWS))
        if columns.size and lines.size:
            # Five samples a pixel along each axis.
            part = lambda at, centre: np.mean(
                [np.exp(-0.5 * ((at + s - centre) / SIGMA_PX) ** 2) for s in (-0.4, -0.2, 0, 0.2, 0.4)], axis=0
            ) / (SIGMA_PX * np.sqrt(2 * np.pi))
            expected[np.ix_(lines, columns)] += electrons * np.outer(part(lines, y), part(columns, x))
    hot = random.integers(0, ROWS * COLUMNS, HOT_PIXELS)
    expected.flat[hot] += random.uniform(3e3, 3e4, HOT_PIXELS)
    electrons = random.poisson(np.minimum(expected, 4e4)) + random.normal(0, READ_NOISE_E, expected.shape)
    return np.clip(np.rint(BIAS_DN + electrons / GAIN_E_PER_DN), 0, 4095).astype(np.uint16)


def write_fits(path, pixels):
    cards = [("SIMPLE", "T"), ("BITPIX", 16), ("NAXIS", 2), ("NAXIS1", COLUMNS), ("NAXIS2", ROWS), ("BSCALE", 1), ("BZERO", 32768)]
    header = "".join(f"{key:8}= {value:>20}".ljust(80) for key, value in cards) + "END".ljust(80)
    data = (pixels.astype(np.int32) - 32768).astype(">i2").tobytes()
    pad = lambda size: -size % 2880
    path.write_bytes(header.encode() + b" " * pad(len(header)) + data + b"\0" * pad(len(data)))


def make(directory):
    (directory / "frames").mkdir(parents=True)
    (directory / "camera.toml").write_text(CAMERA)
    random = np.random.default_rng(26)
    vectors, magnitudes = stars()
    telemetry = ["frame,file,time_utc,exposure_s,q_sc_j2000_w,q_sc_j2000_x,q_sc_j2000_y,q_sc_j2000_z"]
    truth = ["frame,w,x,y,z"]
    for frame in range(FRAMES):
        q = random.normal(size=4)
        q /= np.linalg.norm(q)
        name = f"frames/{frame:06}.fits"
        write_fits(directory / name, image(random, vectors, magnitudes, q))
        telemetry.append(f"{frame},{name},{DATE}T21:{frame:02}:00Z,{EXPOSURE_S},1,0,0,0")
        truth.append(",".join([str(frame), *map(repr, map(float, q))]))
    (directory / "telemetry.csv").write_text("\n".join(telemetry) + "\n")
    directory.with_name(directory.name + "-truth.csv").write_text("\n".join(truth) + "\n")


def compare(directory):
    with open(directory.with_name(directory.name + "-truth.csv")) as file:
        truth = {row["frame"]: [float(row[c]) for c in "wxyz"] for row in csv.DictReader(file)}
    across, about, missing = [], [], 0
    with open(directory / "measurements.csv") as file:
        for row in csv.DictReader(file):
            if not row["q_cam_j2000_w"]:
                missing += 1
                continue
            found = matrix([float(row[f"q_cam_j2000_{c}"]) for c in "wxyz"])
            turn = found @ matrix(truth[row["frame"]]).T
            x, y, z = (0.5 * (turn[i] - turn[j]) for i, j in (((2, 1), (1, 2)), ((0, 2), (2, 0)), ((1, 0), (0, 1))))
            scale = np.degrees(1) * 3600
            across.append(scale * np.hypot(x, y) if turn[2, 2] > 0 else 180 * 3600)
            about.append(scale * abs(z))
    print(f"{len(across)} attitudes, {missing} frames without one")
    print(f"largest error across the boresight {max(across):.2f} arcsec, about it {max(about):.1f} arcsec")


if __name__ == "__main__":
    {"make": make, "compare": compare}[sys.argv[1]](pathlib.Path(sys.argv[2]))
