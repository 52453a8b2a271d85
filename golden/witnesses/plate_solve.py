#!/usr/bin/env python3
"""Independent plate solver: tetra3rs with its extractor and its catalogue (Gaia DR3) solves Boresight's
frames.

    plate_solve.py [--pointings 300]

Frames of ARGON's camera with every effect of its detector, at boresights spread evenly over the sky, whole
images of 0.25 s. Each is solved lost in space. Required:
- at least 99 % of the frames with ten or more detectable stars (SNR of 5 or more in the truth table) are
  solved;
- no bias of the boresight above 0.02 px along columns or rows, nor of the roll by more than that at the edge
  of the field;
- the scatter about the truth is that stated by the solver, within a factor of two (it models neither colours
  nor the wings of bright stars).

Prints the results; exit status 0 when all of it holds, 1 when not. Needs the package `boresight` (pip install
./python) and requirements.txt.
"""

import argparse
import sys

import numpy as np
import tetra3rs

import pointings

DETECTABLE_SNR = 5.0
MIN_STARS = 10
MIN_SOLVED = 0.99
MAX_BIAS_PX = 0.02
ARCSEC = 206264.806


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pointings", type=int, default=300)
    count = parser.parse_args().pointings

    database = tetra3rs.SolverDatabase.generate_from_gaia(max_fov_deg=20.0, min_fov_deg=12.0, epoch_proper_motion_year=2012.3, star_max_magnitude=7.0)
    camera = None
    detectable, solved, wrong, errors, claims = 0, 0, 0, [], []
    for k, frame in pointings.frames(count):
        if camera is None:
            setup = pointings.boresight.Scenario.load("argon").value("camera")
            camera = pointings.Camera(setup)
            scale = camera.f[0]
            rows, columns = frame.pixels.shape
            model = tetra3rs.CameraModel.from_fov(float(np.degrees(2 * np.arctan(columns / 2 / scale))), columns, rows)
        objects = frame.objects
        is_star = np.array([kind == "star" for kind in objects["kind"]])
        stars = int(np.sum(is_star & (np.nan_to_num(np.asarray(objects["snr"])) >= DETECTABLE_SNR)))
        found = tetra3rs.extract_centroids(frame.pixels, max_centroids=100, min_pixels=2, local_bg_block_size=48, matched_filter_sigma=0.85)
        if stars < MIN_STARS:
            continue
        detectable += 1
        # Pixels of the solver: of a pinhole, square, from the principal point, in widths of a pixel. Its
        # extractor counts from the middle of the image.
        places = np.array([(c.x + (columns - 1) / 2, c.y + (rows - 1) / 2, c.brightness) for c in found.centroids])
        ideal = camera.undistorted(places[:, :2]) * scale
        result = database.solve_from_centroids(
            np.column_stack([ideal, places[:, 2]]), camera_model=model, observer_velocity_km_s=list(pointings.observer_velocity_km_s(frame)))
        if not result:
            print(f"pointing {k}: {result.status}, {stars} detectable stars, {len(places)} centroids")
            continue
        # Small rotation about the camera's axes from the truth to the solution.
        difference = np.asarray(result.rotation_matrix_icrs_to_camera) @ pointings.camera_from_icrs(frame).T
        about = 0.5 * np.array([difference[2, 1] - difference[1, 2], difference[0, 2] - difference[2, 0], difference[1, 0] - difference[0, 1]])
        if np.linalg.norm(about) > 0.01:
            wrong += 1
            print(f"pointing {k}: wrong by {np.degrees(np.linalg.norm(about)):.2f} degrees")
            continue
        solved += 1
        errors.append(about)
        theta, xi, eta = result.attitude_sigma_rad
        claims.append((eta, xi, theta))
    errors, claims = np.array(errors), np.array(claims)

    bias_px = errors.mean(axis=0) * np.array([scale, scale, columns / 2])
    error_px = errors.std(axis=0) * np.array([scale, scale, columns / 2]) / np.sqrt(len(errors))
    pull = np.sqrt(np.mean((errors / claims) ** 2, axis=0))
    rms = np.sqrt(np.mean(errors**2, axis=0)) * ARCSEC
    share = solved / max(detectable, 1)
    print(f"{count} pointings, {detectable} with {MIN_STARS} detectable stars or more: {solved} solved ({100 * share:.1f} %), {wrong} wrong")
    for i, axis in enumerate(["about x (rows)", "about y (columns)", "roll, at the edge"]):
        print(f"{axis}: bias {bias_px[i]:+.4f} ± {error_px[i]:.4f} px, RMS {rms[i]:.2f} arcsec, {pull[i]:.2f} times what is claimed")
    holds = {
        f"{100 * MIN_SOLVED:.0f} % solved": share >= MIN_SOLVED and wrong == 0,
        f"no bias above {MAX_BIAS_PX} px": bool(np.all(np.abs(bias_px) <= MAX_BIAS_PX)),
        "scatter as claimed, within a factor of two": bool(np.all((pull > 0.5) & (pull < 2.0))),
    }
    for claim, is_so in holds.items():
        print(f"{'ok  ' if is_so else 'FAIL'} {claim}")
    return 0 if all(holds.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
