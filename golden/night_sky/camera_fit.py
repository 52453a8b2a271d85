#!/usr/bin/env python3
"""Cameras fitted to night-sky images drawn by GalSim: an external check of docs/evidence/camera-fit.md.

    camera_fit.py PROGRAM [--cameras 40] [--seed 1]

Draws random cameras (field 5 to 60 degrees, distortion in OpenCV's terms, hot pixels, point-spread function, 1 to
20 frames) with the sky and the projection of check.py, fits each by `boresight camera fit` with a field that is
told with an error of up to 9 %, and compares the parameters that the fit calls determined with the truth.

Printed: a line per camera, and over all the share of errors within 3 sigma and the NEES per dimension. Exit
status 0 when at least 98.5 % of the errors are within 3 sigma, the NEES is within 0.8 to 1.25, and every camera
with a frame of ten detectable stars is found. Needs requirements.txt.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import galsim
import numpy as np

from check import MIN_DETECTABLE, Camera, Sky, draw, information, write

WITHIN, NEES = 0.985, (0.8, 1.25)
# Names of the parameters of a fit, with their true values.
PARAMETERS = {
    "focal length, mm": lambda camera, principal: camera.focal_mm,
    "principal point x, px": lambda camera, principal: principal[0],
    "principal point y, px": lambda camera, principal: principal[1],
    "k1, px^-2": lambda camera, principal: camera.distortion[0] / camera.focal_px**2,
    "k2, px^-4": lambda camera, principal: camera.distortion[1] / camera.focal_px**4,
    "p1, px^-1": lambda camera, principal: camera.distortion[2] / camera.focal_px,
    "p2, px^-1": lambda camera, principal: camera.distortion[3] / camera.focal_px,
    "k3, px^-6": lambda camera, principal: camera.distortion[4] / camera.focal_px**6,
}


def random_camera(random):
    """A camera whose distortion moves the corners by up to some percent."""
    columns, rows = int(random.integers(640, 1600)), int(random.integers(480, 1200))
    pixel_um = 5.0
    field = np.radians(np.exp(random.uniform(np.log(5), np.log(60))))
    focal_px = columns / 2 / np.tan(field / 2)
    corner = np.hypot(columns, rows) / 2 / focal_px
    # Parts of the corner's distance by k1, k2, and of the tangential terms.
    radial, second, tangential = random.normal(0, [0.02, 0.004, 0.0005])
    distortion = (radial / corner**2, second / corner**4, tangential / corner, tangential / corner * random.normal(), 0.0)
    sigma = random.uniform(0.6, 1.4)
    psf = [galsim.Gaussian(sigma=sigma), galsim.Moffat(beta=3.5, fwhm=2.2 * sigma)][int(random.integers(2))]
    exposure_s = 1.0
    # The star of the tenth magnitude per 5 degrees of field is near the limit.
    limit = 8.5 - 2.5 * np.log10(np.degrees(field) / 12)
    noise = np.sqrt(60 + 64)
    zero = 12 * noise * 10 ** (0.4 * min(max(limit, 5.5), 9.5))
    bits = int(random.choice([8, 12, 14]))
    gain = {8: 60.0, 12: 6.0, 14: 2.0}[bits]
    return Camera(
        f"{np.degrees(field):.1f} deg, {bits} bits", "2026-03-01T00:00:00", columns, rows, focal_px * pixel_um / 1e3, pixel_um, distortion, bits, "png", zero,
        exposure_s, 60, 8, gain, limit, psf, gradient=random.uniform(0, 0.5), hot_pixels=int(random.integers(0, 60)),
    )


def fitted(program, folder, camera, told_deg):
    done = subprocess.run(
        [program, "--json", "camera", "fit", folder, "--field-deg", f"{told_deg:.4f}", "--pixel-um", str(camera.pixel_um), "--time", "2026-03-01T00:00:00Z"],
        capture_output=True, text=True,
    )
    if done.returncode == 2:
        raise SystemExit(f"{folder}: {done.stderr}")
    return json.loads(done.stdout)


def bound_px(camera, stars):
    """Root mean square along an axis of the errors that no unbiased position of these stars can undercut
    (Cramer and Rao), with shot noise, read noise and rounding."""
    fluxes, known = information(camera, camera.psf)
    variance = 0.5 * np.trace(np.linalg.inv(known), axis1=1, axis2=2)
    electrons = np.array([star["flux_dn"] for star in stars]) * camera.gain_e_per_dn
    return float(np.sqrt(np.mean(np.exp(np.interp(np.log(electrons), np.log(fluxes), np.log(variance))))))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--cameras", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    sky = Sky()
    errors, ratios, missed, unsolved, frames_with_stars = [], [], 0, 0, 0
    for number in range(arguments.cameras):
        random = np.random.default_rng([arguments.seed, number])
        camera = random_camera(random)
        frames = int(random.choice([1, 2, 3, 5, 10, 20]))
        principal = ((camera.columns - 1) / 2, (camera.rows - 1) / 2)
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            rich = 0
            for frame in range(frames):
                q = random.normal(size=4)
                # One time for all frames, as the command takes it.
                pixels, detectable, _ = draw(camera, q / np.linalg.norm(q), camera.times(1)[0], sky, random)
                pixels = pixels.astype(np.uint8) if camera.bits == 8 else pixels
                write(folder / f"{frame:03}.png", pixels)
                rich += detectable >= MIN_DETECTABLE
            field_deg = 2 * np.degrees(np.arctan(camera.columns / 2 / camera.focal_px))
            found = fitted(arguments.program, folder, camera, field_deg * (1 + random.uniform(-0.09, 0.09)))
        frames_with_stars += rich
        if not found["ok"]:
            missed += rich > 0
            print(f"{camera.name}, {frames} frames, {rich} with {MIN_DETECTABLE} stars: no camera")
            continue
        unsolved += max(0, rich - len(found["frames"]))
        line = []
        for parameter in found["parameters"]:
            if not parameter["determined"]:
                line.append("-")
                continue
            error = (parameter["value"] - PARAMETERS[parameter["name"]](camera, principal)) / parameter["sigma"]
            errors.append(error)
            line.append(f"{error:+.1f}")
        left_out = found["left_out_rms_px"]
        bound = bound_px(camera, found["matched_stars"])
        if left_out is not None:
            ratios.append(left_out / bound)
        print(
            f"{camera.name}, {frames} frames, {rich} with {MIN_DETECTABLE} stars, {len(found['frames'])} solved, {found['stars']} stars, "
            f"left out {left_out if left_out is None else round(left_out, 3)} px (bound {bound:.3f}), errors in sigma {' '.join(line)}",
            flush=True,
        )
    errors = np.array(errors)
    within, nees = np.mean(np.abs(errors) < 3), np.mean(errors**2)
    print(f"{within:.1%} of {len(errors)} within 3 sigma, NEES per dimension {nees:.2f}, {missed} cameras not found, {unsolved} of {frames_with_stars} frames with stars not solved")
    print(f"stars left out over the bound of their positions: median {np.median(ratios):.2f}, {np.quantile(ratios, 0.1):.2f} to {np.quantile(ratios, 0.9):.2f}")
    return 0 if within >= WITHIN and NEES[0] <= nees <= NEES[1] and missed == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
