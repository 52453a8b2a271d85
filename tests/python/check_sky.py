#!/usr/bin/env python3
"""Compares a picture of `boresight sky` with astropy: where five stars of Orion are, and which way is up.

    boresight sky --ra 83.6 --dec -5.4 --camera uasc-far-range --exposure 0.05 -o orion.fits
    python3 tests/python/check_sky.py orion.fits

The positions are those of SIMBAD (ICRS, J2000, with proper motion), not of the catalogue of Boresight. Each is
brought to the time of the picture, converted to a pixel by the world coordinates in the header, and compared
with the centroid of the pixels there.
"""

import sys

import astropy.units as u
import numpy as np
from astropy.coordinates import SkyCoord
from astropy.io import fits
from astropy.time import Time
from astropy.wcs import WCS

# Name, right ascension, declination, proper motion in both (mas a year, the first with cos dec).
STARS = [
    ("Rigel", "05h14m32.27210s", "-08d12m05.8981s", 1.31, 0.50),
    ("Saiph", "05h47m45.38884s", "-09d40m10.5777s", 1.46, -1.28),
    ("Alnitak", "05h40m45.52666s", "-01d56m34.2649s", 3.19, 2.03),
    ("Alnilam", "05h36m12.81335s", "-01d12m06.9089s", 1.44, -0.78),
    ("Mintaka", "05h32m00.40009s", "-00d17m56.7424s", 0.64, -0.69),
]
# Three times the largest of the five errors, 0.017 px: noise of the centroids.
TOLERANCE_PX = 0.05
# Half of the side of the square around a star.
REACH_PX = 4


def centroid(image, x, y):
    """The centre of the brightness above the surroundings, near a position, in pixels from 0."""
    column, row = round(float(x)), round(float(y))
    window = image[row - REACH_PX : row + REACH_PX + 1, column - REACH_PX : column + REACH_PX + 1].astype(float)
    light = np.clip(window - np.median(image) - 4.0 * np.median(np.abs(image - np.median(image))), 0.0, None)
    rows, columns = np.mgrid[row - REACH_PX : row + REACH_PX + 1, column - REACH_PX : column + REACH_PX + 1]
    return (light * columns).sum() / light.sum(), (light * rows).sum() / light.sum()


def main():
    with fits.open(sys.argv[1]) as file:
        header, image = file[0].header, file[0].data
    wcs = WCS(header)
    time = Time(header["DATE-AVG"], scale="utc")
    worst = 0.0
    for name, ra, dec, pm_ra, pm_dec in STARS:
        star = SkyCoord(
            ra, dec, pm_ra_cosdec=pm_ra * u.mas / u.yr, pm_dec=pm_dec * u.mas / u.yr, obstime=Time("J2000"), frame="icrs"
        ).apply_space_motion(new_obstime=time)
        expected = wcs.all_world2pix(star.ra.deg, star.dec.deg, 0)
        found = centroid(image, *expected)
        error = float(np.hypot(found[0] - expected[0], found[1] - expected[1]))
        worst = max(worst, error)
        print(f"{name}: expected {expected[0]:.2f}, {expected[1]:.2f}, found {found[0]:.2f}, {found[1]:.2f}, {error:.3f} px apart")
    # The rows of the file run from top to bottom: north is up if the declination falls with the row.
    top, bottom, left, right = (wcs.all_pix2world(x, y, 0) for x, y in ((395, 100), (395, 400), (100, 288), (600, 288)))
    is_upright = top[1] > bottom[1] and left[0] > right[0]
    print(f"{len(STARS)} stars within {worst:.3f} px; north {'up, east left' if is_upright else 'not up'}")
    return 0 if worst < TOLERANCE_PX and is_upright else 1


if __name__ == "__main__":
    sys.exit(main())
