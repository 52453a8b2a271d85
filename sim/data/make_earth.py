"""Makes earth.bin: the barycentric positions of the Earth and the Sun as Chebyshev polynomials.

Source: ERFA `epv00` (pyerfa 2.0.1.5, numpy 2.4.6), an analytical series fitted to DE405; by its documentation
the barycentric Earth is within 13.4 km and 4.9 mm/s of DE405 (1900-2100). Frame ICRS (BCRS axes), time TDB,
unit km.

    python3 make_earth.py earth.bin

Layout: little-endian f64, no header. PIECES records, each for PIECE_DAYS days from START_JD on, of 3 x
EARTH_TERMS coefficients (Earth x, then y, then z, the constant term first) and 3 x SUN_TERMS (the Sun's).
Argument of the polynomials: -1 at the start of a piece, +1 at its end. sim/truth/src/ephemeris.rs holds the
same constants.

Reason for 32 days and 18 terms: the Moon moves the Earth by 4700 km and 12 m/s every 27.3 days, and the last
terms must follow that and its harmonics. The polynomials are fitted to the velocity and integrated, because a
fit to the position is several times worse in velocity at the ends of a piece, and aberration needs the
velocity. The script measures the residuals and stops when they exceed the stated limits.
"""

import sys

import erfa
import numpy as np
from numpy.polynomial import chebyshev

START_JD = 2447892.5  # 1990-01-01 00:00 TDB
PIECE_DAYS = 32
PIECES = 685  # to 2050-01-06 00:00 TDB
EARTH_TERMS = 18
SUN_TERMS = 5
AU_KM = 149597870.7
DAY_S = 86400.0
NODES = 32

POSITION_LIMIT_KM = 1.0
VELOCITY_LIMIT_KM_S = 5e-6  # the error of epv00 itself is near 3e-6


def states(jd_piece_start, days):
    """Earth position, Earth velocity, Sun position (km, km/s), arrays ending in x, y, z."""
    heliocentric, barycentric = erfa.epv00(jd_piece_start, days)
    sun = (barycentric["p"] - heliocentric["p"]) * AU_KM
    return barycentric["p"] * AU_KM, barycentric["v"] * (AU_KM / DAY_S), sun


def coefficients(samples, terms):
    """Chebyshev coefficients, pieces x 3 x terms, of samples (pieces x NODES x 3) at the Chebyshev nodes."""
    angles = np.pi * (np.arange(NODES) + 0.5) / NODES
    basis = np.cos(np.outer(np.arange(terms), angles)) * (2.0 / NODES)
    basis[0] *= 0.5
    return np.einsum("kn,pnc->pck", basis, samples)


def main():
    starts = START_JD + PIECE_DAYS * np.arange(PIECES)
    nodes = np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
    position, velocity, sun = states(starts[:, None], (nodes[None, :] + 1.0) * (PIECE_DAYS / 2))
    sun = coefficients(sun, SUN_TERMS)
    slopes = coefficients(velocity, EARTH_TERMS - 1) * (PIECE_DAYS * DAY_S / 2)
    earth = chebyshev.chebint(slopes, axis=-1)
    # The integral leaves the constant open: the positions at the nodes give it.
    nodes_basis = chebyshev.chebvander(nodes, EARTH_TERMS - 1)
    earth[..., 0] += (position - np.einsum("nk,pck->pnc", nodes_basis, earth)).mean(axis=1)

    x = np.linspace(-1.0, 1.0, 65)
    true_position, true_velocity, true_sun = states(starts[:, None], (x[None, :] + 1.0) * (PIECE_DAYS / 2))
    values = chebyshev.chebvander(x, EARTH_TERMS - 1)
    position = np.einsum("nk,pck->pnc", values, earth)
    slopes = chebyshev.chebder(earth, axis=-1)
    velocity = np.einsum("nk,pck->pnc", values[:, : EARTH_TERMS - 1], slopes) * (2.0 / (PIECE_DAYS * DAY_S))
    sun_position = np.einsum("nk,pck->pnc", chebyshev.chebvander(x, SUN_TERMS - 1), sun)

    worst = {
        "Earth position, km": (np.linalg.norm(position - true_position, axis=-1).max(), POSITION_LIMIT_KM),
        "Earth velocity, km/s": (np.linalg.norm(velocity - true_velocity, axis=-1).max(), VELOCITY_LIMIT_KM_S),
        "Sun position, km": (np.linalg.norm(sun_position - true_sun, axis=-1).max(), POSITION_LIMIT_KM),
    }
    for name, (value, limit) in worst.items():
        print(f"largest difference from epv00, {name}: {value:.3g} (limit {limit:g})")
        if not value <= limit:
            sys.exit("the polynomials do not follow epv00 closely enough")

    records = np.concatenate([earth.reshape(PIECES, -1), sun.reshape(PIECES, -1)], axis=1)
    with open(sys.argv[1], "wb") as out:
        out.write(records.astype("<f8").tobytes())


main()
