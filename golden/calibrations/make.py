"""Calibrations written by OpenCV, and the images of points by OpenCV's model.

    make.py --reason "..."

Writes `square.yaml`, `square.json` and `other.yaml` by cv2.FileStorage, with the keys of OpenCV's calibration
sample, and `projections.csv`: the images of 400 points for each of the two cameras by cv2.projectPoints. The
pixels of `square` are square, those of `other` differ by 0.1 %. Needs requirements.txt.
"""

import pathlib
import sys

import cv2
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import manifest  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
SIZE = (1280, 960)
# fx, fy, cx, cy; k1, k2, p1, p2, k3.
CAMERAS = {
    "square": ((912.25, 912.25, 655.5, 470.125), (-0.271, 0.0925, 8.1e-4, -4.3e-4, -0.0107)),
    "other": ((912.25, 913.1, 655.5, 470.125), (-0.271, 0.0925, 8.1e-4, -4.3e-4, -0.0107)),
}


def matrix(focal_and_centre):
    """Returns the camera matrix of fx, fy, cx, cy."""
    fx, fy, cx, cy = focal_and_centre
    return np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1.0]])


def write(path, focal_and_centre, coefficients):
    """Writes a calibration by OpenCV, in the format of the file name's end."""
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    storage.write("image_width", SIZE[0])
    storage.write("image_height", SIZE[1])
    storage.write("camera_matrix", matrix(focal_and_centre))
    storage.write("distortion_coefficients", np.array(coefficients).reshape(5, 1))
    storage.release()


def main():
    arguments = manifest.begin()
    rows = ["camera,x,y,column,row"]
    for name, (focal_and_centre, coefficients) in CAMERAS.items():
        random = np.random.default_rng(5)
        # Tangents over the image, rounded as they are written.
        points = np.round(random.uniform((-0.75, -0.55), (0.72, 0.58), (400, 2)), 6)
        spatial = np.column_stack([points, np.ones(len(points))])
        images, _ = cv2.projectPoints(spatial, np.zeros(3), np.zeros(3), matrix(focal_and_centre), np.array(coefficients))
        rows += [f"{name},{x:.6f},{y:.6f},{u:.9f},{v:.9f}" for (x, y), (u, v) in zip(points, images.reshape(-1, 2))]
        write(HERE / f"{name}.yaml", focal_and_centre, coefficients)
    write(HERE / "square.json", *CAMERAS["square"])
    (HERE / "projections.csv").write_text("\n".join(rows) + "\n")
    for name in ["square.yaml", "square.json", "other.yaml", "projections.csv"]:
        manifest.record(HERE / name, arguments.reason)


if __name__ == "__main__":
    main()
