"""Estimates the pose of docking frames with OpenCV: the reference of research/src/bin/docking_accuracy.

    python docking_pnp.py FOLDER [--quiet]

FOLDER holds setup.json (camera and target), poses.csv (frame, file, truth, and a prior whose position is off
by 1 % of the range) and the frames, progressive PNG. For every frame: the target is found near the position
predicted by the prior (normalised correlation with a drawing of the target); the marks and the arms of the
cross are centroids of adaptively thresholded blobs, weighted by their excess over the dark plate; then the
iterative solvePnP uses the 12 mark centres, the cross's centre and the centres of its four arms, without
RANSAC (which sometimes rejects the stand-off cross), starting at the prior. A mark whose residual is beyond 3
sigma of the others' (and half a pixel) is cut by a shadow and left out; a pose more than 10 % of the range
off the prior is no answer. Written to opencv.csv: frame, d1_m, d2_m, d3_m, phi1_rad, phi2_rad, phi3_rad;
empty where OpenCV has no answer. The truth is only read for the printed errors.
"""

import argparse
import csv
import json
import pathlib

import cv2
import numpy as np

NAMES = ["d1_m", "d2_m", "d3_m", "phi1_rad", "phi2_rad", "phi3_rad"]
IDEAL = np.diag([1.0, -1.0, -1.0])
SEARCH_PX = 48  # more than 1 % of the range moves the image: 29 px with the narrow lens
SCALE = 4  # of the drawing, samples a pixel along a side


class Target:
    def __init__(self, setup):
        target = setup["target"]
        cross = target["cross"]
        half, width, height = cross["half_length_m"], cross["width_m"], cross["height_m"]
        self.marks = np.array([[[x, y, 0.0] for x, y in mark] for mark in target["marks"]])
        self.mark_centres = self.marks.mean(axis=1)
        arms = []
        for direction in np.array([[1, 0], [-1, 0], [0, 1], [0, -1]], float):
            # From beyond the crossing to the end.
            side = np.array([-direction[1], direction[0]]) * width / 2
            begin, end = direction * width, direction * half
            arms.append([[*(begin - side), height], [*(end - side), height], [*(end + side), height], [*(begin + side), height]])
        self.arms = np.array(arms)
        self.arm_centres = self.arms.mean(axis=1)
        self.cross_centre = np.array([0.0, 0.0, height])
        self.cross_square = np.array([[x, y, height] for x, y in [(-1, -1), (1, -1), (1, 1), (-1, 1)]]) * [width, width, 1]
        self.plate_radius = target["plate_radius_m"]
        fx, fy = setup["focal_px"]
        cx, cy = setup["principal_px"]
        self.camera = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])

    def project(self, points, pose):
        """Pixels, the centre of the first being (0, 0). x_camera = Aᵀ (y − d)."""
        rvec, tvec = to_opencv(pose)
        pixels, _ = cv2.projectPoints(points.reshape(-1, 3), rvec, tvec, self.camera, None)
        return pixels.reshape(*points.shape[:-1], 2)


def to_opencv(pose):
    d, phi = np.asarray(pose[:3]), np.asarray(pose[3:])
    rotation = (IDEAL @ cv2.Rodrigues(phi)[0]).T
    return cv2.Rodrigues(rotation)[0], (-rotation @ d).reshape(3, 1)


def from_opencv(rvec, tvec):
    rotation = cv2.Rodrigues(rvec)[0]
    phi = cv2.Rodrigues(IDEAL @ rotation.T)[0].ravel()
    return np.concatenate([(-rotation.T @ tvec).ravel(), phi])


def drawing(target, pose, shape):
    """Black plate on grey, white marks and cross, for the correlation."""
    image = np.full((shape[0] * SCALE, shape[1] * SCALE), 60, np.uint8)
    angles = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    plate = np.stack([target.plate_radius * np.cos(angles), target.plate_radius * np.sin(angles), 0 * angles], axis=1)
    for polygon, value in [(plate, 20), *[(mark, 200) for mark in target.marks], *[(arm, 200) for arm in target.arms], (target.cross_square, 200)]:
        corners = (target.project(polygon, pose) + 0.5) * SCALE - 0.5
        cv2.fillPoly(image, [np.round(corners * 16).astype(np.int32)], value, shift=4)
    return cv2.resize(image, (shape[1], shape[0]), interpolation=cv2.INTER_AREA)


def shift_of_prior(image, target, prior):
    """Shift of the target from its predicted position, in integer pixels."""
    outline = np.concatenate([target.marks.reshape(-1, 3), target.arms.reshape(-1, 3)])
    pixels = target.project(outline, prior)
    low = np.floor(pixels.min(axis=0) - 3).astype(int)
    high = np.ceil(pixels.max(axis=0) + 4).astype(int)
    rows, columns = image.shape
    model = drawing(target, prior, image.shape)
    low = np.clip(low, 0, [columns - 1, rows - 1])
    high = np.clip(high, 1, [columns, rows])
    template = model[low[1] : high[1], low[0] : high[0]]
    padded = cv2.copyMakeBorder(image, *[SEARCH_PX] * 4, cv2.BORDER_REPLICATE)
    window = padded[low[1] : high[1] + 2 * SEARCH_PX, low[0] : high[0] + 2 * SEARCH_PX]
    score = cv2.matchTemplate(window, template, cv2.TM_CCOEFF_NORMED)
    _, best, _, place = cv2.minMaxLoc(score)
    return np.array(place, float) - SEARCH_PX, best


def centroid(image, binary, corners, centre_guess):
    """Sub-pixel centre of the blob of a feature: brightness above the plate, inside the dilated blob next to
    the guess."""
    size = np.ptp(corners, axis=0)
    reach = np.ceil(0.5 * size + 3).astype(int)
    middle = np.round(centre_guess).astype(int)
    x0, y0 = middle - reach
    x1, y1 = middle + reach + 1
    rows, columns = image.shape
    if x0 < 0 or y0 < 0 or x1 > columns or y1 > rows:
        return None
    count, labels, statistics, centres = cv2.connectedComponentsWithStats(binary[y0:y1, x0:x1], connectivity=8)
    if count < 2:
        return None
    distance = np.linalg.norm(centres[1:] - (centre_guess - [x0, y0]), axis=1)
    label = 1 + int(distance.argmin())
    expected = cv2.contourArea(corners.astype(np.float32))
    area = statistics[label, cv2.CC_STAT_AREA]
    if not 0.3 * expected <= area <= 3.0 * expected + 4:
        return None
    blob = cv2.dilate((labels == label).astype(np.uint8), np.ones((3, 3), np.uint8), iterations=2)
    patch = image[y0:y1, x0:x1].astype(float)
    ground = np.median(patch[blob == 0]) if (blob == 0).any() else patch.min()
    weights = np.where(blob > 0, patch - ground, 0.0)
    if weights.sum() <= 0:
        return None
    y, x = np.mgrid[y0:y1, x0:x1]
    return np.array([(weights * x).sum(), (weights * y).sum()]) / weights.sum()


def arm_centre(image, corners):
    """The arm's middle by the weighted centroid of the quadrilateral's surroundings, which touch the
    crossing: only the axis is measured, by the rows or columns across the arm; the middle along it is that of
    the quadrilateral."""
    direction = corners[1] - corners[0]
    length = np.linalg.norm(direction)
    if length < 2:
        return None
    along = direction / length
    across = np.array([-along[1], along[0]])
    width = np.linalg.norm(corners[3] - corners[0])
    offsets = np.arange(-(width / 2 + 3), width / 2 + 3.01, 0.25)
    stations = np.linspace(0.15, 0.85, max(4, int(length)))
    middle = corners.mean(axis=0)
    begin = middle - direction / 2
    grid = begin + stations[:, None, None] * direction + offsets[None, :, None] * across
    values = cv2.remap(image.astype(np.float32), grid[..., 0].astype(np.float32), grid[..., 1].astype(np.float32), cv2.INTER_LINEAR)
    values = values - np.minimum(values[:, :1], values[:, -1:])
    values = np.clip(values, 0, None)
    total = values.sum(axis=1)
    if (total <= 0).any():
        return None
    shift = np.median((values * offsets).sum(axis=1) / total)
    return middle + shift * across


def measure(image, target, prior):
    shift, score = shift_of_prior(image, target, prior)
    if score < 0.3:
        return None
    blurred = cv2.GaussianBlur(image, (3, 3), 0)
    block = int(max(11, 2 * (np.ptp(target.project(target.marks[0], prior), axis=0).max() // 1) + 9)) | 1
    binary = cv2.adaptiveThreshold(blurred, 1, cv2.ADAPTIVE_THRESH_MEAN_C, cv2.THRESH_BINARY, block, -8)
    pose = np.array(prior, float)
    estimate = None
    for _ in range(3):
        points, pixels = [], []
        for corners, centre in zip(target.marks, target.mark_centres):
            found = centroid(image, binary, target.project(corners, pose) + shift, target.project(centre[None], pose)[0] + shift)
            if found is not None:
                points.append(centre)
                pixels.append(found)
        arms = [arm_centre(image, target.project(corners, pose) + shift) for corners in target.arms]
        for arm, centre in zip(arms, target.arm_centres):
            if arm is not None:
                points.append(centre)
                pixels.append(arm)
        if all(arm is not None for arm in arms):
            # The centre: where the lines through opposite arms meet.
            (a, b), (c, e) = (arms[0], arms[1]), (arms[2], arms[3])
            matrix = np.stack([b - a, c - e], axis=1)
            pixels.append(a + np.linalg.solve(matrix, c - a)[0] * (b - a))
            points.append(target.cross_centre)
        if len(points) < 8 or sum(p[2] == 0 for p in points) < 4:
            return None
        rvec, tvec = to_opencv(pose)
        points, pixels = np.array(points), np.array(pixels)
        use = np.ones(len(points), bool)
        for _ in range(3):
            if use.sum() < 8:
                return None
            done, rvec, tvec = cv2.solvePnP(
                points[use], pixels[use], target.camera, None, rvec, tvec, useExtrinsicGuess=True, flags=cv2.SOLVEPNP_ITERATIVE
            )
            if not done:
                return None
            residuals = np.linalg.norm(target.project(points, from_opencv(rvec, tvec)) - pixels, axis=1)
            gate = max(0.5, 3 * 1.4826 * np.median(residuals[use]))
            use = (residuals < gate) | (points[:, 2] > 0)
        pose = estimate = from_opencv(rvec, tvec)
        shift = np.zeros(2)
    prior_position = np.asarray(prior[:3])
    off = np.linalg.norm(estimate[:3] - prior_position)
    return estimate if np.isfinite(estimate).all() and off < 0.1 * np.linalg.norm(prior_position) else None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--quiet", action="store_true")
    arguments = parser.parse_args()
    cv2.setNumThreads(1)
    target = Target(json.loads((arguments.folder / "setup.json").read_text()))
    errors = []
    with (arguments.folder / "poses.csv").open() as table, (arguments.folder / "opencv.csv").open("w", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(["frame", *NAMES])
        rows = list(csv.DictReader(table))
        for row in rows:
            image = cv2.imread(str(arguments.folder / row["file"]), cv2.IMREAD_GRAYSCALE)
            pose = measure(image, target, [float(row["prior_" + name]) for name in NAMES])
            writer.writerow([row["frame"], *([""] * 6 if pose is None else map(repr, map(float, pose)))])
            if pose is not None:
                truth = np.array([float(row[name]) for name in NAMES])
                distance = np.linalg.norm(truth[:3])
                range_error = (np.linalg.norm(pose[:3]) - distance) / distance
                errors.append([100 * range_error, *(1e3 * (pose - truth)[:2]), *np.degrees((pose - truth)[3:5])])
    if not arguments.quiet and errors:
        squares = np.square(errors).mean(axis=0)
        figures = np.sqrt([squares[0], squares[1:3].mean(), squares[3:5].mean()])
        print(f"{arguments.folder.name}: {len(errors)}/{len(rows)}, rms range {figures[0]:.3f} %, lateral {figures[1]:.2f} mm, phi {figures[2]:.3f} deg")


if __name__ == "__main__":
    main()
