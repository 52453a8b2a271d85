"""Makes cip.bin: the celestial intermediate pole and origin as Chebyshev polynomials.

Source: ERFA `xys06a` (pyerfa 2.0.1.5, numpy 2.4), the IAU 2006 precession and the IAU 2000A nutation (IERS
Conventions 2010, Ch. 5). X and Y are the coordinates of the pole in the GCRS, Z = s + XY/2 the small part of the
origin's locator; radians, time TT.

    python3 make_cip.py cip.bin

Layout: little-endian f64, no header. PIECES records, each for PIECE_DAYS days from START_JD on, of TERMS
coefficients of X, TERMS of Y and LOCATOR_TERMS of Z (the constant term first). Argument of the polynomials: -1 at
the start of a piece, +1 at its end. sim/truth/src/numerical/orientation.rs holds the same constants.

The limit of 1e-10 rad is 0.7 mm at the Earth's surface and 20 microarcseconds; pole offsets observed since 2000
reach 500 microarcseconds.
"""

import sys

import erfa
import numpy as np
from numpy.polynomial import chebyshev

START_JD = 2447892.5  # 1990-01-01 00:00 TT
PIECE_DAYS = 32
PIECES = 685  # to 2050-01-06 00:00 TT
TERMS = 26
LOCATOR_TERMS = 6
NODES = 48
LIMIT_RAD = 1e-10


def angles(jd, days):
    x, y, s = erfa.xys06a(jd, days)
    return np.stack([x, y, s + x * y / 2], axis=-1)


def main():
    starts = START_JD + PIECE_DAYS * np.arange(PIECES)
    turns = np.pi * (np.arange(NODES) + 0.5) / NODES
    samples = angles(starts[:, None], (np.cos(turns)[None, :] + 1.0) * (PIECE_DAYS / 2))
    basis = np.cos(np.outer(np.arange(TERMS), turns)) * (2.0 / NODES)
    basis[0] *= 0.5
    coefficients = np.einsum("kn,pnc->pck", basis, samples)
    coefficients[:, 2, LOCATOR_TERMS:] = 0.0

    x = np.linspace(-1.0, 1.0, 97)
    true = angles(starts[:, None], (x[None, :] + 1.0) * (PIECE_DAYS / 2))
    values = np.einsum("nk,pck->pnc", chebyshev.chebvander(x, TERMS - 1), coefficients)
    worst = np.abs(values - true).max(axis=(0, 1))
    print(f"largest differences from xys06a, rad: X {worst[0]:.2g}, Y {worst[1]:.2g}, s + XY/2 {worst[2]:.2g}")
    if not worst.max() <= LIMIT_RAD:
        sys.exit(f"the polynomials do not follow xys06a to {LIMIT_RAD:g} rad")
    records = np.concatenate(
        [coefficients[:, 0], coefficients[:, 1], coefficients[:, 2, :LOCATOR_TERMS]], axis=1
    )
    with open(sys.argv[1], "wb") as out:
        out.write(records.astype("<f8").tobytes())


main()
