#!/usr/bin/env python3
"""Independent plate solver: astrometry.net with its extractor and the Tycho-2 catalogue.

    astrometry_net.py [--pointings 300]

Frames of plate_solve.py. The extractor (image2xy) and the lost-in-space identification (solve-field, given
only that a pixel is 1 to 2 arcmin wide) are astrometry.net's. Identified stars are fitted here by one
rotation (Kabsch 1976), because astrometry.net's result is a linear projection on a catalogue without
aberration. Required, as in plate_solve.py:
- at least 99 % of the frames with ten or more detectable stars (SNR of 5 or more in the truth table) are
  solved;
- no bias of the boresight above 0.02 px along columns or rows, nor of the roll by more than that at the edge
  of the field;
- the scatter about the truth is that of the stars about the fit, within a factor of two.

Prints the results; exit status 0 when all of it holds, 1 when not. Needs the package `boresight` (pip install
./python), requirements.txt, and Debian's `astrometry.net` and `astrometry-data-tycho2-10-19`.
"""

import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np
from astropy.io import fits

import pointings

DETECTABLE_SNR = 5.0
MIN_STARS = 10
MIN_SOLVED = 0.99
MAX_BIAS_PX = 0.02
LIGHT_SPEED_KM_S = 299792.458
# Larger distances mean a wrong match, or an image merged with a neighbour's: three times the width of a star.
MAX_APART_PX = 2.5


def extracted(frame, directory):
    """Positions found by image2xy, pixels from 0, with their flux, the brightest first."""
    image, found = directory / "frame.fits", directory / "found.fits"
    fits.PrimaryHDU(frame.pixels.astype(np.float32)).writeto(image, overwrite=True)
    subprocess.run(["image2xy", "-O", "-o", found, image], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    rows = fits.getdata(found, 1)
    order = np.argsort(rows["FLUX"])[::-1]
    return np.column_stack([rows["X"] - 1.0, rows["Y"] - 1.0])[order].astype(float), rows["FLUX"][order].astype(float)


def identified(places, flux, size, directory):
    """Result of solve-field for positions in a pinhole image: positions and catalogued unit vectors of the
    identified stars; None without a solution."""
    columns, rows = size
    table = fits.BinTableHDU.from_columns([
        fits.Column(name="X", format="D", array=places[:, 0] + 1.0),
        fits.Column(name="Y", format="D", array=places[:, 1] + 1.0),
        fits.Column(name="FLUX", format="D", array=flux),
    ])
    source, pairs = directory / "places.xyls", directory / "pairs.fits"
    pairs.unlink(missing_ok=True)
    table.writeto(source, overwrite=True)
    subprocess.run(
        ["solve-field", source, "--overwrite", "--no-plots", "--dir", directory, "--width", str(columns), "--height", str(rows), "--x-column", "X", "--y-column", "Y",
         "--sort-column", "FLUX", "--scale-units", "arcminwidth", "--scale-low", str(columns), "--scale-high", str(2 * columns), "--cpulimit", "60", "--tweak-order", "1",
         "--corr", pairs, "--new-fits", "none", "--solved", "none", "--match", "none", "--rdls", "none", "--index-xyls", "none"],
        check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    if not pairs.exists():
        return None
    found = fits.getdata(pairs, 1)
    ra, dec = np.radians(found["index_ra"]), np.radians(found["index_dec"])
    stars = np.column_stack([np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)])
    return np.column_stack([found["field_x"] - 1.0, found["field_y"] - 1.0]), stars


def rotation(seen, stars):
    """The rotation that takes `stars` nearest to `seen`, least squares over unit vectors (Kabsch 1976)."""
    u, _, vt = np.linalg.svd(seen.T @ stars)
    return u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt


def fitted(pinhole, stars, scale):
    """Rotation of the camera from stars at pinhole positions, without outliers; sigmas about its axes, rad,
    from the scatter of the others."""
    seen = np.column_stack([pinhole, np.ones(len(pinhole))])
    seen /= np.linalg.norm(seen, axis=1, keepdims=True)
    kept = np.ones(len(seen), bool)
    for _ in range(5):
        turn = rotation(seen[kept], stars[kept])
        off = scale * np.linalg.norm(seen - stars @ turn.T, axis=1)
        kept = off < min(MAX_APART_PX, 3.0 * 1.4826 * np.median(off[kept]) + 0.01)
    sigma = np.sqrt(np.sum((off[kept] / scale) ** 2) / (2.0 * kept.sum() - 3.0))
    # Information about small turns: a turn by w moves the star s by w × s.
    information = sum(np.eye(3) - np.outer(s, s) for s in seen[kept])
    return turn, sigma * np.sqrt(np.diag(np.linalg.inv(information))), int(kept.sum())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pointings", type=int, default=300)
    count = parser.parse_args().pointings
    if shutil.which("solve-field") is None:
        sys.exit("solve-field is not there: apt-get install astrometry.net astrometry-data-tycho2-10-19")

    camera = pointings.Camera(pointings.boresight.Scenario.load("argon").value("camera"))
    scale = camera.f[0]
    detectable, solved, wrong, stars_used, errors, claims = 0, 0, 0, [], [], []
    with tempfile.TemporaryDirectory() as folder:
        directory = pathlib.Path(folder)
        for k, frame in pointings.frames(count):
            rows, columns = frame.pixels.shape
            objects = frame.objects
            is_star = np.array([kind == "star" for kind in objects["kind"]])
            if int(np.sum(is_star & (np.nan_to_num(np.asarray(objects["snr"])) >= DETECTABLE_SNR))) < MIN_STARS:
                continue
            detectable += 1
            places, flux = extracted(frame, directory)
            middle = np.array([(columns - 1) / 2, (rows - 1) / 2])
            # Pinhole image with square pixels about its middle, the projection that solve-field assumes.
            known = identified(camera.undistorted(places) * scale + middle, flux, (columns, rows), directory)
            if known is None:
                print(f"pointing {k}: not solved, {len(places)} places")
                continue
            pinhole, stars = known
            # Aberration turns each star towards the camera's motion; its second order, 1e-8 rad, is left out.
            apparent = stars + pointings.observer_velocity_km_s(frame) / LIGHT_SPEED_KM_S
            apparent /= np.linalg.norm(apparent, axis=1, keepdims=True)
            turn, sigma, used = fitted((pinhole - middle) / scale, apparent, scale)
            difference = turn @ pointings.camera_from_icrs(frame).T
            about = 0.5 * np.array([difference[2, 1] - difference[1, 2], difference[0, 2] - difference[2, 0], difference[1, 0] - difference[0, 1]])
            if np.linalg.norm(difference - np.eye(3)) > 0.02:
                wrong += 1
                print(f"pointing {k}: wrong by {np.degrees(np.linalg.norm(about)):.2f} degrees")
                continue
            solved += 1
            errors.append(about)
            claims.append(sigma)
            stars_used.append(used)
    errors, claims = np.array(errors), np.array(claims)

    to_px = np.array([scale, scale, columns / 2])
    bias_px = errors.mean(axis=0) * to_px
    error_px = errors.std(axis=0) * to_px / np.sqrt(len(errors))
    pull = np.sqrt(np.mean((errors / claims) ** 2, axis=0))
    share = solved / max(detectable, 1)
    print(f"{count} pointings, {detectable} with {MIN_STARS} detectable stars or more: {solved} solved ({100 * share:.1f} %), {wrong} wrong; {np.mean(stars_used):.0f} stars a frame")
    for i, axis in enumerate(["about x (rows)", "about y (columns)", "roll, at the edge"]):
        rms = np.sqrt(np.mean(errors[:, i] ** 2)) * to_px[i]
        print(f"{axis}: bias {bias_px[i]:+.4f} ± {error_px[i]:.4f} px, RMS {rms:.4f} px, {pull[i]:.2f} times what the stars' scatter tells")
    holds = {
        f"{100 * MIN_SOLVED:.0f} % solved": share >= MIN_SOLVED and wrong == 0,
        f"no bias above {MAX_BIAS_PX} px": bool(np.all(np.abs(bias_px) <= MAX_BIAS_PX)),
        "scatter as the stars', within a factor of two": bool(np.all((pull > 0.5) & (pull < 2.0))),
    }
    for claim, is_so in holds.items():
        print(f"{'ok  ' if is_so else 'FAIL'} {claim}")
    return 0 if all(holds.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
