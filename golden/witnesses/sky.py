#!/usr/bin/env python3
"""Number of stars in a circular field: our list of stars against Tycho-2 and against the literature.

    sky.py

Counts to magnitude 5, 6 and 7 in circular fields 8, 12 and 20 degrees wide around 200,000 centres spread
evenly over the sky: their mean and the emptiest field. Required:
- the mean number of stars from 5 to 6 and to 7 is that of Tycho-2 (Hog et al. 2000, as packed by
  astrometry.net, V_T converted to V for a star of B-V = 0.5) to 5 %; a seventh of the stars brighter than 5
  are missing in that packing, which the table shows without a requirement;
- the mean is that of Liebe's fit, 6.57 exp(1.08 M) stars brighter than M over the sky (2002, IEEE Trans.
  Aerosp. Electron. Syst. 38, 587), to 25 %, the accuracy of a fit of two numbers: to V = 7 it has 12 to 24 %
  less than every count below;
- the whole list has as many stars as published counts of the whole sky (PUBLISHED, each with source and
  accuracy);
- the emptiest field has as many stars as that of Tycho-2, within 2 or a fifth.

No publication was found with the least number in a field for these magnitudes and widths: Kleiman (An
Analytical Approach to the Determination of Stellar Fields of View, 36 pages) tabulates the width of a
circular field that holds 1, 2 and 3 stars in every direction, of 1064 stars to 4.7, and only the abstract
could be read. Tycho-2 alone confirms it.

Prints the table; exit status 0 when all of it holds, 1 when not. Needs the package `boresight` (pip install
./python), requirements.txt and Debian's `astrometry-data-tycho2-10-19`.
"""

import pathlib
import sys

import boresight
import numpy as np
from astropy.io import fits
from scipy.spatial import cKDTree

import pointings

TYCHO2 = pathlib.Path("/usr/share/astrometry/index-tycho2-10.littleendian.fits")
CENTRES = 200_000
MAGNITUDES, WIDTHS_DEG = (5.0, 6.0, 7.0), (8.0, 12.0, 20.0)
# V = V_T - 0.090 (B-V)_T (ESA 1997, The Hipparcos and Tycho Catalogues, vol. 1, section 1.3), with (B-V)_T =
# 0.59 for B-V = 0.5.
V_MINUS_VT = -0.053

# Name, {magnitude: stars of that or smaller magnitude over the sky}, tolerance.
PUBLISHED = [
    # Counts of the first Hipparcos Catalogue, whose second reduction is ours: other stars would be a fault of
    # our reader; a few per cent come from the definition of V.
    ("Hipparcos (OEIS A053406)", {5.0: 1600, 6.0: 4968, 7.0: 15328}, 0.03),
    # Counts of Tycho (stargazing.net/david/constel/howmanystars.html, quoted by astro.chilie.dk), between
    # integer magnitudes: 0.05 mag is 5 %.
    ("Tycho (stargazing.net)", {5.5: 2822, 6.5: 8768}, 0.05),
    # Tycho-2 with UCAC4 (hnsky.com/star_count.htm), in an unstated magnitude: V_T, if used, is fainter than V
    # by 0.05, 6 % of the stars.
    ("Tycho-2 and UCAC4 (HNSKY)", {5.0: 1744, 6.0: 5326, 7.0: 16503}, 0.10),
    # log10 N a square degree = -0.0003 m^3 + 0.0019 m^2 + 0.484 m - 3.82 from 4 to 25 (Space Math, "How many
    # stars are in the sky?"): three digits, so 1 %, of a polynomial over 21 magnitudes.
    ("polynomial of Space Math", {m: 41252.96 * 10.0 ** (-0.0003 * m**3 + 0.0019 * m**2 + 0.484 * m - 3.82) for m in MAGNITUDES}, 0.05),
    # A rounded table printed in newspapers (neagle.com, 2013-03-28), of older photometry whose zero is that
    # of V to 0.1 mag, 10 % of the stars.
    ("round table", {5.0: 1620, 6.0: 4850, 7.0: 14300}, 0.10),
    # A catalogue complete to 6.5 (Hoffleit & Jaschek 1991), with some fainter stars.
    ("Bright Star Catalogue", {6.5: 9096}, 0.10),
]


def unit_vectors(ra_deg, dec_deg):
    ra, dec = np.radians(ra_deg), np.radians(dec_deg)
    return np.column_stack([np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)])


def ours():
    """Unit vectors and V of our list of stars, at the epoch of the scenario."""
    stars = boresight.Scenario.load("argon").with_values({"star_list.magnitude_limit": MAGNITUDES[-1]}).setup["stars"]
    return np.array([star["icrs"] for star in stars]), np.array([star["magnitude"] for star in stars])


def tycho2():
    """Unit vectors and V of the stars of an index of astrometry.net: coordinates are packed into 32 bits
    each, over the range stated in the index."""
    with fits.open(TYCHO2) as index:
        data = {hdu.columns[0].name: hdu.data for hdu in index[1:]}
        lowest = np.frombuffer(data["kdtree_range_stars"].tobytes(), "<f8")
        packed = np.frombuffer(data["kdtree_data_stars"].tobytes(), "<u4").reshape(-1, 3)
        magnitude = np.asarray(data["MAG_VT"]["MAG_VT"], float) + V_MINUS_VT
    directions = lowest[:3] + packed / lowest[6]
    return directions / np.linalg.norm(directions, axis=1, keepdims=True), magnitude


def counts(directions, centres, width_deg):
    """Number of stars in the circular field about each centre."""
    radius = 2.0 * np.sin(np.radians(width_deg) / 4.0)
    return cKDTree(directions).query_ball_point(centres, radius, return_length=True)


def main():
    if not TYCHO2.exists():
        sys.exit(f"{TYCHO2} is not there: apt-get install astrometry-data-tycho2-10-19")
    lattice = np.array([(ra, dec) for ra, dec, _ in pointings.lattice(CENTRES)])
    centres = unit_vectors(lattice[:, 0], lattice[:, 1])
    catalogues = [ours(), tycho2()]
    means, as_liebe, emptiest = True, True, True
    brighter = {}
    print("V    width   mean ours  Tycho-2  Liebe     fewest ours  Tycho-2")
    for magnitude in MAGNITUDES:
        for width_deg in WIDTHS_DEG:
            found = [counts(d[m <= magnitude], centres, width_deg) for d, m in catalogues]
            (mean, least), (their_mean, their_least) = [(number.mean(), int(number.min())) for number in found]
            brighter.setdefault(width_deg, (mean, their_mean))
            share = (1.0 - np.cos(np.radians(width_deg / 2.0))) / 2.0
            liebe = 6.57 * np.exp(1.08 * magnitude) * share
            print(f"{magnitude:.0f}  {width_deg:4.0f} deg  {mean:8.2f}  {their_mean:8.2f}  {liebe:6.2f}  {least:9d}  {their_least:8d}")
            if magnitude > MAGNITUDES[0]:
                means &= abs((mean - brighter[width_deg][0]) / (their_mean - brighter[width_deg][1]) - 1.0) < 0.05
            as_liebe &= abs(mean / liebe - 1.0) < 0.25
            emptiest &= abs(least - their_least) <= max(2.0, 0.2 * their_least)
    as_published = []
    for name, whole_sky, nearness in PUBLISHED:
        ratios = {m: np.sum(catalogues[0][1] <= m) / number for m, number in whole_sky.items()}
        as_published.append(all(abs(ratio - 1.0) <= nearness for ratio in ratios.values()))
        print(f"{name}: " + ", ".join(f"to {m} {whole_sky[m]:.0f}, ours {ratio:.3f} times that" for m, ratio in ratios.items()) + f" (± {nearness:.2f})")
    holds = {
        "mean of the stars fainter than 5 as in Tycho-2, 5 %": means,
        "mean as in Liebe's fit, 25 %": as_liebe,
        "emptiest field as in Tycho-2, within 2 or a fifth": emptiest,
        "as many stars over the sky as six published counts, each as near as it is good for (3 to 10 %)": all(as_published),
    }
    for claim, is_so in holds.items():
        print(f"{'ok  ' if is_so else 'FAIL'} {claim}")
    return 0 if all(holds.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
