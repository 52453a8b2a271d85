#!/usr/bin/env python3
"""Calibrations by OpenCV, and files in the shapes of other tools: a check of docs/evidence/calibrations.md.

    calibrations.py PROGRAM [--cameras 20] [--seed 1]

- `random`: cameras written by cv2.FileStorage in YAML and JSON are imported; 1000 points are projected by the
  formula of CONVENTIONS.md with the imported numbers, and by cv2.projectPoints. Exported again in every format,
  the files are read by cv2.FileStorage and PyYAML and project the same points. XML is refused.
- `boards`: a chessboard and a ChArUco board are drawn through a known camera, found and calibrated by OpenCV,
  written by cv2.FileStorage and imported; the imported camera projects points as the known one.
- `shapes`: files with the keys and notations of other programs, read or refused for the stated reason.

Exit status 0 when all hold. Needs ../calibrations/requirements.txt.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import tomllib

import cv2
import numpy as np
import yaml

from calibration_shapes import SHAPES

# Square pixels: the rounding of double precision at 1000 px. Others: the figure that the program states.
EXACT_PX = 1e-9
# A calibration by 25 views against the known camera: twice the larger of the two figures.
MAX_RMS_PX = 0.2


def run(program, *words):
    """Runs the program; its exit status, its JSON document and its messages."""
    done = subprocess.run([program, *map(str, words), "--json"], capture_output=True, text=True, check=False)
    return done.returncode, json.loads(done.stdout) if done.returncode == 0 else None, done.stderr


def projected(camera, points):
    """Images of points (x, y) = (X/Z, Y/Z) by the formula of CONVENTIONS.md."""
    u = points[:, 0] * 1000 * camera["focal_length_mm"] / camera["pixel_width_um"]
    v = points[:, 1] * 1000 * camera["focal_length_mm"] / camera["pixel_height_um"]
    (k1, k2, k3), (p1, p2) = camera["radial"], camera["tangential"]
    r2 = u * u + v * v
    radial = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
    return np.column_stack([
        camera["principal_x_px"] + u * radial + 2 * p1 * u * v + p2 * (r2 + 2 * u * u),
        camera["principal_y_px"] + v * radial + p1 * (r2 + 2 * v * v) + 2 * p2 * u * v,
    ])


def by_opencv(matrix, coefficients, points):
    """Images of points (x, y) by OpenCV."""
    spatial = np.column_stack([points, np.ones(len(points))])
    return cv2.projectPoints(spatial, np.zeros(3), np.zeros(3), matrix, coefficients)[0].reshape(-1, 2)


def write(path, size, matrix, coefficients):
    """Writes a calibration by OpenCV in the format of the file name's end."""
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    for key, value in [("image_width", size[0]), ("image_height", size[1]), ("camera_matrix", matrix), ("distortion_coefficients", coefficients)]:
        storage.write(key, value)
    storage.release()


def read_back(path, form):
    """Matrix and coefficients of an exported file, by a reader that is not ours."""
    if form == "opencv":
        storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_READ)
        return storage.getNode("camera_matrix").mat(), storage.getNode("distortion_coefficients").mat().ravel()
    data = yaml.safe_load(path.read_text())
    if form == "ros":
        return np.array(data["camera_matrix"]["data"], float).reshape(3, 3), np.array(data["distortion_coefficients"]["data"], float)
    fx, fy, cx, cy = data["cam0"]["intrinsics"]
    return np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1.0]]), np.array(data["cam0"]["distortion_coeffs"], float)


def random_camera(random, square, has_k3):
    """A camera whose distortion moves the corners by some percent, invertible over the image."""
    size = int(random.integers(320, 4000)), int(random.integers(240, 3000))
    focal = size[0] / 2 / np.tan(np.radians(random.uniform(8, 80)) / 2)
    centre = np.array(size) / 2 + random.normal(0, 0.01, 2) * size
    fy = focal if square else focal * (1 + random.normal(0, 1e-3))
    matrix = np.array([[focal, 0, centre[0]], [0, fy, centre[1]], [0, 0, 1.0]])
    corner = np.hypot(*size) / 2 / focal
    shares = random.normal(0, [0.03, 0.01, 0.001, 0.001, 0.003])
    coefficients = shares / corner ** np.array([2, 4, 1, 1, 6])
    if not has_k3:
        coefficients[4] = 0.0
    # Points whose images are on the detector, or nearly.
    half = np.array(size) / 2 / focal
    return size, matrix, coefficients, random.uniform(-half, half, (1000, 2))


def random_cameras(program, folder, arguments):
    """Cameras written by OpenCV, imported and exported."""
    random = np.random.default_rng(arguments.seed)
    worst, worst_share, forms, refused = 0.0, 0.0, 0, 0
    for number in range(arguments.cameras):
        square = number % 2 == 0
        size, matrix, coefficients, points = random_camera(random, square, number % 4 < 2)
        truth = by_opencv(matrix, coefficients, points)
        on_image = np.all((truth >= -0.5) & (truth <= np.array(size) - 0.5), axis=1)
        for end in ["yaml", "json", "xml"]:
            path = folder / f"{number}.{end}"
            write(path, size, matrix, coefficients)
            toml = folder / f"{number}-{end}.toml"
            status, document, said = run(program, "camera", "import", path, "-o", toml, "--max-displacement-px", 5)
            if end == "xml":
                assert status == 2 and "it is XML" in said, said
                refused += 1
                continue
            assert status == 0, said
            camera = tomllib.loads(toml.read_text())["camera"]
            assert (camera["columns"], camera["rows"]) == size
            error = np.linalg.norm(projected(camera, points) - truth, axis=1)
            if square:
                worst = max(worst, error.max())
            else:
                assert 0 < document["displacement_px"], document
                worst_share = max(worst_share, error[on_image].max() / document["displacement_px"])
        for form, end in [("opencv", "yml"), ("opencv", "json"), ("ros", "yaml"), ("kalibr", "yaml")]:
            path = folder / f"{number}-{form}.{end}"
            status, document, said = run(program, "camera", "export", folder / f"{number}-yaml.toml", "--format", form, "-o", path, "--max-displacement-px", 5)
            if form == "kalibr" and coefficients[4] != 0.0:
                assert status == 2 and "k3" in said, said
                refused += 1
                continue
            assert status == 0, said
            forms += 1
            again = by_opencv(*read_back(path, form), points)
            error = np.linalg.norm(again - projected(camera, points), axis=1)
            if square:
                worst = max(worst, error.max())
            else:
                worst_share = max(worst_share, error[on_image].max() / document["displacement_px"])
    assert worst < EXACT_PX, worst
    assert worst_share <= 1.0, worst_share
    print(f"ok   random: {arguments.cameras} cameras, {forms} exported files; square pixels within {worst:.1e} px, others within {worst_share:.2f} of the stated displacement; {refused} refused as they should be")


# Boards of 10 x 7 squares, 60 px each in the drawing, 0.03 m in space.
SQUARES, SIDE_PX, SIDE_M = (10, 7), 60, 0.03


def board_image(kind):
    """Drawing of a board with a white margin of one square, and its detector: image -> (points, images)."""
    if kind == "charuco":
        board = cv2.aruco.CharucoBoard(SQUARES, SIDE_M, 0.7 * SIDE_M, cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_5X5_100))
        drawing = board.generateImage((SQUARES[0] * SIDE_PX, SQUARES[1] * SIDE_PX))
        finder = cv2.aruco.CharucoDetector(board)

        def find(image):
            corners, numbers, _, _ = finder.detectBoard(image)
            if numbers is None or len(numbers) < 12:
                return None
            points = np.array(board.getChessboardCorners(), np.float32)[np.asarray(numbers).ravel()]
            return points, np.asarray(corners, np.float32).reshape(-1, 2)

    else:
        parity = np.add.outer(np.arange(SQUARES[1]), np.arange(SQUARES[0])) % 2
        drawing = np.kron(parity * 255, np.ones((SIDE_PX, SIDE_PX))).astype(np.uint8)
        inner = (SQUARES[0] - 1, SQUARES[1] - 1)
        grid = np.array([[(x + 1) * SIDE_M, (y + 1) * SIDE_M, 0] for y in range(inner[1]) for x in range(inner[0])], np.float32)

        def find(image):
            found, corners = cv2.findChessboardCornersSB(image, inner, flags=cv2.CALIB_CB_ACCURACY)
            return (grid, corners.reshape(-1, 2)) if found else None

    return cv2.copyMakeBorder(drawing, SIDE_PX, SIDE_PX, SIDE_PX, SIDE_PX, cv2.BORDER_CONSTANT, value=255), find


# Rays per pixel along columns and rows.
FINE = 3


def rays_of(size, matrix, coefficients):
    """Rays (x, y, 1) of an image, FINE x FINE per pixel."""
    columns, rows = (np.arange(n * FINE) / FINE - (FINE - 1) / 2 / FINE for n in size)
    pixels = np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 1, 2)
    until = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_COUNT, 60, 1e-12)
    rays = cv2.undistortPoints(pixels, matrix, coefficients, criteria=until)
    return np.column_stack([rays.reshape(-1, 2), np.ones(len(pixels))])


def view(drawing, size, rays, rotation, translation):
    """Image of a board through a camera: its rays meet the board's plane."""
    turn = cv2.Rodrigues(rotation)[0]
    # R p + t = s ray, with p in the plane z = 0.
    normal = turn[:, 2]
    scale = (normal @ translation) / (rays @ normal)
    board = (rays * scale[:, None] - translation) @ turn
    # The first pixel of the drawing is half a pixel inside of the margin.
    where = (board[:, :2] / SIDE_M + 1) * SIDE_PX - 0.5
    shape = (size[1] * FINE, size[0] * FINE)
    maps = [where[:, axis].astype(np.float32).reshape(shape) for axis in (0, 1)]
    fine_image = cv2.remap(drawing, *maps, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=128)
    image = cv2.resize(fine_image, size, interpolation=cv2.INTER_AREA)
    return cv2.GaussianBlur(image, (0, 0), 0.7)


def boards(program, folder, arguments):
    """Calibrations by OpenCV of images drawn through a known camera, imported."""
    size = (768, 576)
    matrix = np.array([[1055.0, 0, 389.5], [0, 1055.0, 284.0], [0, 0, 1]])
    coefficients = np.array([-0.22, 0.09, 8e-4, -5e-4, 0.0])
    rays = rays_of(size, matrix, coefficients)
    figures = []
    for kind in ["chessboard", "charuco"]:
        random = np.random.default_rng(arguments.seed)
        drawing, find = board_image(kind)
        found = []
        for _ in range(60):
            rotation = random.normal(0, [0.3, 0.3, 0.3])
            turn = cv2.Rodrigues(rotation)[0]
            # The board's middle somewhere in the field.
            depth = random.uniform(0.42, 0.65)
            middle = np.array([*random.uniform((-0.18, -0.12), (0.18, 0.12)), 1]) * depth
            translation = middle - turn @ (np.array([*SQUARES, 0]) / 2 * SIDE_M)
            image = view(drawing, size, rays, rotation, translation)
            image = np.clip(image + random.normal(0, 1.5, image.shape), 0, 255).round().astype(np.uint8)
            pair = find(image)
            if pair is not None:
                found.append(pair)
            if len(found) == 25:
                break
        rms, fitted, terms, _, _ = cv2.calibrateCamera([points for points, _ in found], [images for _, images in found], size, None, None)
        path, toml = folder / f"{kind}.yaml", folder / f"{kind}.toml"
        write(path, size, fitted, terms)
        status, document, said = run(program, "camera", "import", path, "--pixel-um", 8.3, "-o", toml)
        assert status == 0, said
        camera = tomllib.loads(toml.read_text())["camera"]
        points = random.uniform((-0.36, -0.27), (0.36, 0.27), (1000, 2))
        truth = by_opencv(matrix, coefficients, points)
        on_image = np.all((truth >= -0.5) & (truth <= np.array(size) - 0.5), axis=1)
        # A shift of the principal point is a turn of the camera: the best shift is taken off.
        difference = (projected(camera, points) - truth)[on_image]
        difference -= difference.mean(axis=0)
        rms_px = np.sqrt((difference**2).sum(axis=1).mean())
        same = (projected(camera, points) - by_opencv(fitted, terms, points))[on_image]
        same_px = np.linalg.norm(same, axis=1).max()
        assert same_px <= document["displacement_px"] + EXACT_PX, (same_px, document)
        assert rms_px < MAX_RMS_PX, rms_px
        figures.append(f"{kind} {len(found)} views, rms {rms:.3f} px, camera off by {rms_px:.3f} px rms, conversion {same_px:.1e} px")
    print(f"ok   boards: {'; '.join(figures)}")


def shapes(program, folder, arguments):
    """Files in the shapes of other programs."""
    count = {"read": 0, "refused": 0}
    for number, (title, text, words, expected) in enumerate(SHAPES):
        path, toml = folder / f"shape-{number}.yaml", folder / f"shape-{number}.toml"
        path.write_text(text)
        status, document, said = run(program, "camera", "import", path, "-o", toml, *words.split())
        if isinstance(expected, str):
            assert status == 2 and expected in said, f"{title}: {said or document}"
            count["refused"] += 1
            continue
        assert status == 0, f"{title}: {said}"
        camera = document["camera"]
        focal = 1000 * camera["focal_length_mm"] / camera["pixel_width_um"]
        seen = [focal, camera["principal_x_px"], camera["principal_y_px"], camera["columns"], camera["radial"][0] * focal**2, camera["tangential"][1] * focal]
        assert np.allclose(seen, expected, rtol=1e-12, atol=1e-15), f"{title}: {seen}, expected {expected}"
        count["read"] += 1
    print(f"ok   shapes: {len(SHAPES)} files in the shapes of other programs, {count['read']} read, {count['refused']} refused for their reason")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--cameras", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    program = str(pathlib.Path(arguments.program).resolve())
    failed = False
    for check in [random_cameras, boards, shapes]:
        with tempfile.TemporaryDirectory() as folder:
            try:
                check(program, pathlib.Path(folder), arguments)
            except AssertionError as why:
                print(f"FAIL {check.__name__}: {why}")
                failed = True
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
