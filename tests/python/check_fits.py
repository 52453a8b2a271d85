#!/usr/bin/env python3
"""Checks a rendered dataset with astropy, pyarrow and Pillow: readers that this project did not write.

    check_fits.py DATASET [--png DIR]

For each FITS frame that DATASET/telemetry.csv names:
- its world coordinates against DATASET/truth/objects.parquet: stars on the detector, from ra_deg and dec_deg
  to x_px and y_px, within 0.05 px with SIP over the whole field, and within 0.05 px without SIP near the
  principal point, where distortion is below a hundredth of a pixel;
- its exposure and its times against telemetry.csv, and the cards that make a frame repeatable;
- its pixels against the 16-bit PNG of the same frame, if there is one beside it or in --png.

Prints one line of figures a check; exit 0 when all hold, 1 when one does not, 2 when the dataset cannot be
read.
"""

import argparse
import csv
import pathlib
import sys
import warnings

import numpy as np
import pyarrow.parquet
from astropy.io import fits
from astropy.time import Time
from astropy.wcs import WCS, FITSFixedWarning
from PIL import Image

# The fit guarantees 0.01 px; the remainder allows for rounding in the truth table and errors of a centroid.
TOLERANCE_PX = 0.05
# Distortion k1 r^3 of the flight camera (2.6e-8 px^-2) stays below 0.007 px within this radius.
CENTRE_RADIUS_PX = 64.0
# Telemetry has nanoseconds; Time keeps them in two doubles.
TOLERANCE_S = 1e-6
REQUIRED_CARDS = ["EXPTIME", "DATE-BEG", "DATE-AVG", "DATE-END", "TIMESYS", "RADESYS", "BITDEPTH", "SEED", "CREATOR",
                  "CONFHASH", "FRAMENO", "CHECKSUM", "DATASUM", "OBSVELX", "OBSVELY", "OBSVELZ"]


class Report:
    """Figures of every check, and True if all of them held."""

    def __init__(self):
        self.failed = False

    def check(self, holds, name, figures):
        self.failed |= not holds
        print(f"{'ok  ' if holds else 'FAIL'} {name}: {figures}")


def worst(distances):
    return float(np.max(distances)) if len(distances) else 0.0


def check_wcs(header, stars, frame):
    """Distances, px, between truth and world coordinates: with SIP everywhere, without SIP near the centre.
    """
    with warnings.catch_warnings():
        # A note that DATE-BEG has filled in MJD-BEG is not a fault of the header.
        warnings.simplefilter("ignore", FITSFixedWarning)
        wcs = WCS(header)
    if wcs.sip is None:
        raise ValueError(f"frame {frame} has no SIP polynomials")
    columns, rows = header["NAXIS1"], header["NAXIS2"]
    x, y = stars["x_px"], stars["y_px"]
    seen = (x > -0.5) & (x < columns - 0.5) & (y > -0.5) & (y < rows - 0.5)
    x, y, ra, dec = x[seen], y[seen], stars["ra_deg"][seen], stars["dec_deg"][seen]
    if len(x) == 0:
        return np.array([]), np.array([]), np.array([])
    with_sip = np.hypot(*(np.array(wcs.all_world2pix(ra, dec, 0, tolerance=1e-6)) - [x, y]))
    # The inverse polynomials, which all_world2pix does not use: from the linear plane by AP and BP.
    linear = np.array(wcs.wcs_world2pix(ra, dec, 0))
    foc = linear + 1 - wcs.wcs.crpix[:, None]
    by_inverse = np.hypot(*(linear + inverse_sip(wcs.sip, foc) - [x, y]))
    centre = np.hypot(x - (header["CRPIX1"] - 1), y - (header["CRPIX2"] - 1)) < CENTRE_RADIUS_PX
    without_sip = np.hypot(*(linear[:, centre] - [x[centre], y[centre]]))
    return with_sip, by_inverse, without_sip


def inverse_sip(sip, offset):
    """AP and BP at offsets from CRPIX in the undistorted plane."""
    return np.array([np.polynomial.polynomial.polyval2d(offset[0], offset[1], c) for c in (sip.ap, sip.bp)])


def check_times(header, row):
    """Largest disagreement, s, between the header's times and telemetry."""
    times = {key: Time(header[key], scale="utc") for key in ("DATE-BEG", "DATE-AVG", "DATE-END")}
    middle = Time(row["time_utc"].rstrip("Z"), scale="utc")
    exposure = float(row["exposure_s"])
    return max(
        abs(header["EXPTIME"] - exposure),
        abs((times["DATE-AVG"] - middle).sec),
        abs((times["DATE-END"] - times["DATE-BEG"]).sec - exposure),
    )


def png_of(path, directory):
    candidates = [path.with_suffix(".png")] + ([directory / f"{path.stem}.png"] if directory else [])
    return next((candidate for candidate in candidates if candidate.exists()), None)


def stars_by_frame(path):
    columns = ["frame", "kind", "x_px", "y_px", "ra_deg", "dec_deg"]
    table = pyarrow.parquet.read_table(path, columns=columns, filters=[("kind", "==", "star")])
    values = {name: table[name].to_numpy() for name in columns if name != "kind"}
    frames, starts = np.unique(values["frame"], return_index=True)
    ends = list(starts[1:]) + [len(values["frame"])]
    return {
        int(frame): {name: column[start:end] for name, column in values.items()}
        for frame, start, end in zip(frames, starts, ends)
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dataset", type=pathlib.Path)
    parser.add_argument("--png", type=pathlib.Path, help="directory with the same frames as 16-bit PNG")
    arguments = parser.parse_args()
    try:
        with open(arguments.dataset / "telemetry.csv", newline="", encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if row["file"].endswith(".fits")]
        stars = stars_by_frame(arguments.dataset / "truth" / "objects.parquet")
        truth = pyarrow.parquet.read_table(arguments.dataset / "truth" / "frames.parquet")
    except (OSError, KeyError, pyarrow.ArrowException) as error:
        print(f"{arguments.dataset}: {error}", file=sys.stderr)
        return 2

    report = Report()
    report.check(len(rows) > 0, "frames", f"{len(rows)} FITS frames in telemetry.csv")
    true_frames = set(truth["frame"].to_pylist())
    untrue = [row["frame"] for row in rows if int(row["frame"]) not in true_frames]
    report.check(not untrue, "truth", f"{len(true_frames)} rows in frames.parquet, without truth: {untrue}")

    distances = {"with SIP": [], "by AP and BP": [], "without SIP near the centre": []}
    times, compared, different, missing = [], 0, [], []
    for row in rows:
        frame, path = int(row["frame"]), arguments.dataset / row["file"]
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            with fits.open(path, checksum=True) as hdus:
                hdus.verify("exception")
                header, pixels = hdus[0].header, hdus[0].data
        missing += [f"{warning.message} of frame {frame}" for warning in told if "verification failed" in str(warning.message)]
        missing += [f"{key} of frame {frame}" for key in REQUIRED_CARDS if key not in header]
        if header["FRAMENO"] != frame:
            missing.append(f"FRAMENO {header['FRAMENO']} of frame {frame}")
        times.append(check_times(header, row))
        if frame in stars:
            for found, new in zip(distances.values(), check_wcs(header, stars[frame], frame)):
                found.extend(new)
        png = png_of(path, arguments.png)
        if png is not None:
            compared += 1
            with Image.open(png) as image:
                if not np.array_equal(np.asarray(image).astype(np.uint16), pixels):
                    different.append(frame)

    for name, found in distances.items():
        figures = f"{len(found)} stars, median {np.median(found or [0]):.5f} px, worst {worst(found):.5f} px"
        report.check(len(found) > 0 and worst(found) < TOLERANCE_PX, f"world coordinates {name}", figures)
    report.check(worst(times) < TOLERANCE_S, "times", f"worst {worst(times):.1e} s")
    report.check(not missing, "cards", f"missing or wrong: {missing[:5]}")
    report.check(not different, "pixels", f"{compared} frames compared with PNG, different: {different[:5]}")
    return 1 if report.failed else 0


if __name__ == "__main__":
    sys.exit(main())
