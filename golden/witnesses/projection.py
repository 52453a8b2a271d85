#!/usr/bin/env python3
"""Independent projection: star positions on the detector against cv2.projectPoints, with radial and
tangential distortion.

    projection.py [--pointings 12]

The camera of ARGON with square pixels (OpenCV's polynomial uses directions, ours pixels: with square ones the
numbers are equal in other units), with distortion of some ten pixels at the corners, at boresights spread
evenly over the sky. Directions of the stars are those of the truth table, without aberration, which is added
here by another formula (special relativity) with the Earth's velocity of ERFA's ephemeris. Required: every
star, up to the corners, within 0.001 px. (Deflection by the Sun, omitted here, is below 0.0003 px more than
50 degrees from it.)

Prints the results; exit status 0 when it holds, 1 when not. Needs the package `boresight` (pip install
./python) and requirements.txt.
"""

import argparse
import sys

import cv2
import numpy as np

import pointings

LIGHT_SPEED_KM_S = 299792.458
MAX_APART_PX = 0.001
PIXEL_UM = 8.6
RADIAL, TANGENTIAL = (8e-8, -3e-14, 2e-20), (4e-6, -6e-6)  # px^-2, px^-4, px^-6; px^-1


def aberrated(directions, velocity_km_s):
    """Unit vectors as a moving observer sees them (Klioner 2003, Astron. J. 125, 1580, eq. 33 without
    gravitation)."""
    beta = velocity_km_s / LIGHT_SPEED_KM_S
    inverse_gamma = np.sqrt(1.0 - beta @ beta)
    along = directions @ beta
    return (inverse_gamma * directions + np.outer(1.0 + along / (1.0 + inverse_gamma), beta)) / (1.0 + along)[:, None]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pointings", type=int, default=12)
    base = pointings.boresight.Scenario.load("argon")
    camera = {**base.value("camera"), "pixel_width_um": PIXEL_UM, "pixel_height_um": PIXEL_UM, "radial": list(RADIAL), "tangential": list(TANGENTIAL)}
    focal_px = camera["focal_length_mm"] / (PIXEL_UM * 1e-3)
    matrix = np.array([[focal_px, 0.0, camera["principal_x_px"]], [0.0, focal_px, camera["principal_y_px"]], [0.0, 0.0, 1.0]])
    # k1, k2, p1, p2, k3 of OpenCV's polynomial in units of the focal length.
    coefficients = np.array([RADIAL[0] * focal_px**2, RADIAL[1] * focal_px**4, TANGENTIAL[0] * focal_px, TANGENTIAL[1] * focal_px, RADIAL[2] * focal_px**6])

    apart, moved = [], []
    for _, frame in pointings.frames(parser.parse_args().pointings, base.with_values({"camera": camera})):
        objects = frame.objects
        is_star = np.array([kind == "star" for kind in objects["kind"]])
        places = np.column_stack([np.asarray(objects[name], float)[is_star] for name in ("x_px", "y_px")])
        ra, dec = (np.radians(np.asarray(objects[name], float)[is_star]) for name in ("ra_deg", "dec_deg"))
        stars = np.column_stack([np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)])
        seen = aberrated(stars, pointings.observer_velocity_km_s(frame)) @ pointings.camera_from_icrs(frame).T
        expected, undistorted = (cv2.projectPoints(seen, np.zeros(3), np.zeros(3), matrix, k)[0][:, 0] for k in (coefficients, None))
        apart.extend(np.linalg.norm(places - expected, axis=1))
        moved.extend(np.linalg.norm(undistorted - expected, axis=1))
    apart = np.array(apart)
    print(f"{len(apart)} stars, moved by up to {max(moved):.1f} px by the distortion: {np.median(apart):.1e} px apart in the median, {apart.max():.1e} px at worst")
    holds = bool(len(apart) > 100 and apart.max() <= MAX_APART_PX)
    print(f"{'ok  ' if holds else 'FAIL'} every star within {MAX_APART_PX} px of OpenCV's place")
    return 0 if holds else 1


if __name__ == "__main__":
    sys.exit(main())
