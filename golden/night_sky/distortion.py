#!/usr/bin/env python3
"""Share of frames solved with a distortion that the solver is not told: an external check of
docs/evidence/camera-fit.md.

    distortion.py PROGRAM [--frames 6] [--seed 1] [--fields 6,20,60]

Draws single frames with the sky and the projection of check.py (GalSim, ERFA, OpenCV) by cameras whose k1 moves the
corners by 0.5 to 8 % outwards or inwards, and fits each by `boresight camera fit` with the right field, and with one
that is 10 % too wide or too narrow. A frame is solved if it has an attitude; it is false if the centre or the roll is
off by more than 0.2 degrees or a hundredth of the field.

Printed: a line per field and distortion with the solved and the false frames. Exit status 0 when none is false.
Needs requirements.txt.
"""

import argparse
import pathlib
import sys
import tempfile

import galsim
import numpy as np
from astropy.time import Time

from check import MIN_DETECTABLE, Camera, Sky, draw
from hostile import EPOCH, Folder, fit_with_field, pointing_error_deg

SHARES = (0.005, 0.01, 0.02, 0.03, 0.05, 0.08)


def camera(field_deg, share):
    columns, rows, pixel_um = 800, 600, 5.0
    focal_px = columns / 2 / np.tan(np.radians(field_deg) / 2)
    corner = np.hypot(columns, rows) / 2 / focal_px
    limit = min(max(8.5 - 2.5 * np.log10(field_deg / 12), 5.5), 9.5)
    zero = 12 * np.sqrt(124) * 10 ** (0.4 * limit)
    return Camera(
        f"{field_deg} deg", EPOCH, columns, rows, float(focal_px * pixel_um / 1e3), pixel_um, (float(share / corner**2), 0.0, 0.0, 0.0, 0.0), 12, "png",
        float(zero), 1.0, 60, 8, 4.0, limit, galsim.Gaussian(sigma=0.9),
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--frames", type=int, default=6, help="frames of each field, distortion and sign")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--fields", default="6,20,60")
    arguments = parser.parse_args()
    sky, any_false = Sky(), 0
    for field_deg in map(float, arguments.fields.split(",")):
        for share in SHARES:
            counts = {"right field": [0, 0, 0], "10 % wrong": [0, 0, 0]}
            for trial in range(arguments.frames):
                random = np.random.default_rng([arguments.seed, int(field_deg), int(1000 * share), trial])
                lens = camera(field_deg, share * (-1) ** trial)
                detectable = 0
                while detectable < MIN_DETECTABLE:
                    q = random.normal(size=4)
                    truth = q / np.linalg.norm(q)
                    pixels, detectable, _ = draw(lens, truth, Time(EPOCH, scale="utc"), sky, random)
                for name, factor in (("right field", 1.0), ("10 % wrong", 1.1 if random.uniform() < 0.5 else 0.9)):
                    with tempfile.TemporaryDirectory() as folder:
                        found = fit_with_field(arguments.program, pathlib.Path(folder), Folder(lens, [pixels], [truth]), field_deg * factor, tolerance=0.14)
                    count = counts[name]
                    count[0] += 1
                    if found["ok"]:
                        count[1] += 1
                        count[2] += pointing_error_deg(found["frames"][0], truth) > max(0.2, 0.01 * field_deg)
            any_false += sum(count[2] for count in counts.values())
            line = "; ".join(f"{name}: {solved} of {tried} solved, {false} false" for name, (tried, solved, false) in counts.items())
            print(f"{field_deg:.0f} deg, corners moved by {100 * share:.1f} %: {line}", flush=True)
    return 0 if any_false == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
