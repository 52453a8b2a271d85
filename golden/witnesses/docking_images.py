#!/usr/bin/env python3
"""Compares Mitsuba's images of the docking target, made again, with the committed ones.

    docking_images.py COMMITTED MADE NAME...

With equal scene, version and random numbers the rays are equal. A machine gives equal bytes every time, on
one core or two; images of another machine differed from the committed ones in 1 to 4 pixels of 100,000, by
0.002 of full scale at most, half a ray: the last digit of a single-precision number decides on which side of
an edge a ray passes. Required of every image: no more than one pixel of 1000 differs (by more than a unit of
the stored half-precision numbers), none by more than four of its rays, and the mean by no more than 1e-6 of
full scale. (Noise of other rays would be 0.013 % of full scale on flats in every pixel, 0.44 % on edges.)

Prints the results; exit status 0 when all of it holds, 1 when not. Needs Mitsuba and numpy
(golden/docking/requirements.txt).
"""

import pathlib
import sys

import mitsuba
import numpy as np

RAYS = 256  # samples of cases.toml
MAX_PIXELS, MAX_APART, MAX_MEAN = 1e-3, 4.0 / RAYS, 1e-6
HALF_UNIT = 2.0**-10


def image(path):
    return np.array(mitsuba.Bitmap(str(path)), dtype=float).squeeze()


def main():
    committed, made = map(pathlib.Path, sys.argv[1:3])
    names = sys.argv[3:]
    mitsuba.set_variant("scalar_rgb")
    agree, same, pixels, apart, mean = len(names) > 0, 0, 0.0, 0.0, 0.0
    for name in names:
        if not (made / name).exists():
            print(f"FAIL {name} was not made")
            return 1
        if (committed / name).read_bytes() == (made / name).read_bytes():
            same += 1
            continue
        theirs, ours = image(committed / name), image(made / name)
        if theirs.shape != ours.shape:
            print(f"FAIL {name} has {ours.shape} pixels, expected {theirs.shape}")
            return 1
        difference = np.abs(ours - theirs)
        share, most, shift = np.mean(difference > HALF_UNIT * np.abs(theirs)), difference.max(), abs(np.mean(ours - theirs))
        print(f"{name}: {share:.1e} of the pixels differ, by up to {most:.4f} of full scale, the mean by {shift:.0e}")
        agree &= bool(share <= MAX_PIXELS and most <= MAX_APART and shift <= MAX_MEAN)
        pixels, apart, mean = max(pixels, share), max(apart, most), max(mean, shift)
    what = "the same bytes" if same == len(names) else f"{same} the same bytes, of the others up to {pixels:.0e} of the pixels differ, by up to {apart:.4f} of full scale"
    print(f"{'ok  ' if agree else 'FAIL'} {len(names)} images, {what}")
    return 0 if agree else 1


if __name__ == "__main__":
    sys.exit(main())
