#!/usr/bin/env python3
"""Checks the labels of a rendered dataset with readers that this project did not write.

    check_labels.py DATASET [--overlay FRAME FILE]

DATASET is the directory of `boresight render ... --labels coco,speed,bop,yolo`; formats without a folder in
DATASET/truth/labels are left out, except coco, which the others are compared with.
- COCO by pycocotools: masks, boxes and areas agree, and an evaluation of the annotations as detections is
  perfect.
- BOP by the rules of docs/bop_datasets_format.md and scripts/calc_gt_info.py of bop_toolkit: counts and boxes
  of the masks, masks equal to those of COCO, named points by pose and cam_K at the keypoints of COCO.
- SPEED by the formulas of the published starter kit (quat2dcm, project) and the distortion of OpenCV, at the
  keypoints of COCO.
- YOLO by supervision: boxes of COCO; keypoints by the published rule of a line.
- The truth tables: the target's position in the image, which the labels do not use; and the corners of a target
  of plates, which its mask reaches.

Prints one line of figures a check; exit 0 when all hold, 1 when one does not, 2 when the labels cannot be read.
"""

import argparse
import contextlib
import csv
import io
import json
import pathlib
import sys
import tempfile
import tomllib

import numpy as np
import pyarrow.parquet
import supervision
from PIL import Image, ImageDraw
from pycocotools import mask as coco_mask
from pycocotools.coco import COCO
from pycocotools.cocoeval import COCOeval

# Both sides compute in double precision, from quaternions or matrices with 16 digits.
TOLERANCE_PX = 1e-6


class Report:
    """Figures of every check, and True if any of them failed."""

    def __init__(self):
        self.failed = False

    def check(self, holds, name, figures):
        self.failed |= not holds
        print(f"{'ok  ' if holds else 'FAIL'} {name}: {figures}")


class Labels:
    """Folders of a dataset, its COCO annotations by image, and the model of its target."""

    def __init__(self, dataset):
        self.frames = dataset / "frames"
        self.folder = dataset / "truth" / "labels"
        with contextlib.redirect_stdout(io.StringIO()):
            self.coco = COCO(str(self.folder / "coco" / "annotations.json"))
        self.annotations = {number: {} for number in self.coco.getImgIds()}
        for annotation in self.coco.loadAnns(self.coco.getAnnIds()):
            self.annotations[annotation["image_id"]][annotation["category_id"]] = annotation
        self.points_m = named_points(dataset)
        self.camera = Camera(dataset)

    def keypoints(self, number, category):
        """Keypoints of an annotation: positions, px, and visibilities."""
        values = np.array(self.annotations[number][category]["keypoints"]).reshape(-1, 3)
        return values[:, :2], values[:, 2]

    def has(self, name):
        return (self.folder / name).is_dir()


class Camera:
    """Distortion of a dataset's cameras in pixels, as CONVENTIONS.md states it."""

    def __init__(self, dataset):
        setup = dataset / "setup.toml"
        document = tomllib.loads((setup if setup.exists() else dataset / "camera.toml").read_text())
        self.cameras = document.get("cameras") or [document["camera"]]
        with open(dataset / "telemetry.csv", newline="", encoding="utf-8") as file:
            self.rows = {int(row.get("field") or row["frame"]): row for row in csv.DictReader(file)}

    def project(self, number, points):
        """Image positions, px, of points in the camera frame."""
        row = self.rows[number]
        camera = self.cameras[int(row.get("camera") or 0)]
        fx, fy = (camera["focal_length_mm"] * 1e3 / camera[key] for key in ("pixel_width_um", "pixel_height_um"))
        u, v = fx * points[:, 0] / points[:, 2], fy * points[:, 1] / points[:, 2]
        r2 = u * u + v * v
        (k1, k2, k3), (p1, p2) = camera["radial"], camera["tangential"]
        radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
        x = camera["principal_x_px"] + u * radial + 2 * p1 * u * v + p2 * (r2 + 2 * u * u)
        y = camera["principal_y_px"] + v * radial + p1 * (r2 + 2 * v * v) + 2 * p2 * u * v
        first, step = {"even": (0, 2), "odd": (1, 2)}.get(row.get("lines"), (0, 1))
        return np.column_stack([x, (y - first) / step])


def named_points(dataset):
    """Named points of the target, m, in the order of the keypoints, from the files beside the labels."""
    setup = dataset / "setup.toml"
    if setup.exists():
        target = tomllib.loads(setup.read_text())["target"]
        length, height = target["cross"]["half_length_m"], target["cross"]["height_m"]
        cross = [[0, 0], [length, 0], [0, length], [-length, 0], [0, -length]]
        marks = [[*np.mean(corners, axis=0), 0] for corners in target["marks"]]
        return np.array([[0, 0, 0], *[[*end, height] for end in cross], *marks])
    target = tomllib.loads((dataset / "run.toml").read_text())["scenario"]["target"]
    points = [np.zeros(3)]
    for box in target.get("boxes", []):
        signs = [[i & 1, i >> 1 & 1, i >> 2 & 1] for i in range(8)]
        points += [np.array(box["centre_m"]) + (np.array(sign) - 0.5) * box["size_m"] for sign in signs]
    for plate in target.get("plates", []):
        normal = np.array(plate["normal"]) / np.linalg.norm(plate["normal"])
        up = np.array(plate["up"]) - normal * np.dot(plate["up"], normal)
        up /= np.linalg.norm(up)
        right = np.cross(up, normal)
        for x, y in [(-1, -1), (1, -1), (1, 1), (-1, 1)]:
            offset = 0.5 * (x * plate["width_m"] * right + y * plate["height_m"] * up)
            points.append(np.array(plate["centre_m"]) + offset)
    return np.array(points)


def worst(values):
    return float(np.max(values)) if len(values) else 0.0


def check_coco(labels, report):
    coco = labels.coco
    sizes, masks, keypoints = [], [], []
    for image in coco.loadImgs(coco.getImgIds()):
        with Image.open(labels.frames / image["file_name"]) as file:
            sizes.append(file.size == (image["width"], image["height"]))
    for annotation in coco.loadAnns(coco.getAnnIds()):
        run_lengths = coco.annToRLE(annotation)
        area, box = coco_mask.area(run_lengths), coco_mask.toBbox(run_lengths)
        masks.append(area == annotation["area"] and list(box) == annotation["bbox"])
        points = np.array(annotation["keypoints"]).reshape(-1, 3)
        expected = len(coco.loadCats(annotation["category_id"])[0]["keypoints"])
        keypoints.append(len(points) == expected and np.sum(points[:, 2] > 0) == annotation["num_keypoints"])
    report.check(sizes and all(sizes), "COCO images", f"{len(sizes)} of the size of their files")
    report.check(masks and all(masks), "COCO masks", f"{len(masks)} with their area and box by pycocotools")
    report.check(all(keypoints), "COCO keypoints", f"{len(keypoints)} lists of the length of their category")
    detections = [dict(annotation, score=1.0, segmentation=coco.annToRLE(annotation))
                  for annotation in coco.loadAnns(coco.getAnnIds())]
    for kind in ("bbox", "segm"):
        with contextlib.redirect_stdout(io.StringIO()):
            evaluation = COCOeval(coco, coco.loadRes(detections), kind)
            evaluation.evaluate()
            evaluation.accumulate()
            evaluation.summarize()
        precision = evaluation.stats[0]
        report.check(abs(precision - 1) < 1e-9, f"COCO evaluation {kind}", f"average precision {precision:.3f}")


def box_2d(xs, ys):
    """Box as calc_2d_bbox of bop_toolkit computes it."""
    return [int(xs.min()), int(ys.min()), int(xs.max() - xs.min()), int(ys.max() - ys.min())]


def load_mask(path):
    with Image.open(path) as image:
        values = np.asarray(image)
    if not set(np.unique(values)) <= {0, 255}:
        raise ValueError(f"{path}: values {np.unique(values)}, expected 0 and 255")
    return values > 0


def check_bop(labels, report):
    scene = labels.folder / "bop" / "train" / "000000"
    poses, info, cameras = (json.loads((scene / name).read_text())
                            for name in ("scene_gt.json", "scene_gt_info.json", "scene_camera.json"))
    distances, rotations, boxes, same = [], [], [], []
    for number in map(int, poses):
        K = np.array(cameras[str(number)]["cam_K"]).reshape(3, 3)
        for index, (pose, facts) in enumerate(zip(poses[str(number)], info[str(number)], strict=True)):
            R, t = np.array(pose["cam_R_m2c"]).reshape(3, 3), np.array(pose["cam_t_m2c"])
            rotations.append(max(np.abs(R @ R.T - np.eye(3)).max(), abs(np.linalg.det(R) - 1)))
            name = f"{number:06d}_{index:06d}.png"
            whole, visible = (load_mask(scene / kind / name) for kind in ("mask", "mask_visib"))
            ys, xs = visible.nonzero()
            boxes.append(facts["px_count_visib"] == visible.sum() and facts["px_count_valid"] == whole.sum()
                         and facts["px_count_all"] >= whole.sum() and not (visible & ~whole).any()
                         and facts["bbox_visib"] == (box_2d(xs, ys) if len(xs) else [-1] * 4)
                         and abs(facts["visib_fract"] - visible.sum() / facts["px_count_all"]) < 1e-12)
            annotation = labels.annotations[number].get(pose["obj_id"])
            if annotation is None:
                same.append(not visible.any())
                continue
            same.append(np.array_equal(labels.coco.annToMask(annotation) > 0, visible))
            if pose["obj_id"] != 1:
                continue
            in_camera_mm = labels.points_m * 1000 @ R.T + t
            found = labels.camera.project(number, in_camera_mm)
            if all(camera["radial"] == [0, 0, 0] for camera in labels.camera.cameras):
                homogeneous = in_camera_mm @ K.T
                found = homogeneous[:, :2] / homogeneous[:, 2:]
            positions, visibility = labels.keypoints(number, 1)
            distances += list(np.linalg.norm(found - positions, axis=1)[visibility > 0])
    report.check(worst(rotations) < 1e-12, "BOP rotations", f"{len(rotations)}, worst {worst(rotations):.1e}")
    report.check(boxes and all(boxes), "BOP boxes and counts", f"{len(boxes)} equal to those of their masks")
    report.check(same and all(same), "BOP visible masks", f"{len(same)} equal to those of COCO")
    report.check(distances and worst(distances) < TOLERANCE_PX, "BOP poses",
                 f"{len(distances)} keypoints, worst {worst(distances):.1e} px")
    models = json.loads((labels.folder / "bop" / "models" / "models_info.json").read_text())
    low, high = labels.points_m.min(axis=0) * 1000, labels.points_m.max(axis=0) * 1000
    model = models["1"]
    contains = all(model[f"min_{axis}"] <= low[i] + 1e-9 and
                   model[f"min_{axis}"] + model[f"size_{axis}"] >= high[i] - 1e-9
                   for i, axis in enumerate("xyz"))
    report.check(contains, "BOP models", f"{len(models)}, the first of diameter {model['diameter']:.1f} mm")


def quat2dcm(q):
    """Direction cosine matrix of the starter kit: body components from those of the camera."""
    w, x, y, z = q / np.linalg.norm(q)
    return np.array([
        [2 * w * w - 1 + 2 * x * x, 2 * x * y + 2 * w * z, 2 * x * z - 2 * w * y],
        [2 * x * y - 2 * w * z, 2 * w * w - 1 + 2 * y * y, 2 * y * z + 2 * w * x],
        [2 * x * z + 2 * w * y, 2 * y * z - 2 * w * x, 2 * w * w - 1 + 2 * z * z],
    ])


def distort(points, coefficients):
    """Distortion of OpenCV on x' = X/Z and y' = Y/Z."""
    k1, k2, p1, p2, k3 = coefficients
    x, y = points[:, 0] / points[:, 2], points[:, 1] / points[:, 2]
    r2 = x * x + y * y
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    return np.column_stack([
        x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
        y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
        np.ones(len(x)),
    ])


def check_speed(labels, report):
    distances, images = [], set()
    for folder in sorted((labels.folder / "speed").iterdir()):
        camera = json.loads((folder / "camera.json").read_text())
        K = np.array(camera["cameraMatrix"])
        focal_px = np.array([camera["fx"] / camera["ppx"], camera["fy"] / camera["ppy"]])
        assert np.allclose(focal_px, [K[0, 0], K[1, 1]], rtol=1e-12) and K[0, 2] == camera["ccx"]
        for record in json.loads((folder / "labels.json").read_text()):
            number = int(pathlib.Path(record["filename"]).stem)
            images.add(number)
            with Image.open(labels.frames / record["filename"]) as image:
                assert image.size == (camera["Nu"], camera["Nv"])
            dcm = quat2dcm(np.array(record["q_vbs2tango"]))
            in_camera = labels.points_m @ dcm + record["r_Vo2To_vbs_true"]
            found = (distort(in_camera, camera["distCoeffs"]) @ K.T)[:, :2]
            positions, visibility = labels.keypoints(number, 1)
            distances += list(np.linalg.norm(found - positions, axis=1)[visibility > 0])
    with_target = {number for number, objects in labels.annotations.items() if 1 in objects}
    report.check(images == with_target, "SPEED images", f"{len(images)}, all with a visible target")
    report.check(distances and worst(distances) < TOLERANCE_PX, "SPEED poses",
                 f"{len(distances)} keypoints by the starter kit's formulas, worst {worst(distances):.1e} px")


def check_yolo(labels, report):
    errors, points = [], []
    categories = labels.coco.loadCats(labels.coco.getCatIds())
    most = max(len(category["keypoints"]) for category in categories)
    for variant in ("detect", "pose"):
        folder = labels.folder / "yolo" / variant
        # The box of a line of the pose variant is the same as that of the other.
        lines = {path.stem: path.read_text().splitlines() for path in (folder / "labels").glob("*.txt")}
        with tempfile.TemporaryDirectory() as text_folder:
            for stem, rows in lines.items():
                boxes = "\n".join(" ".join(row.split()[:5]) for row in rows)
                (pathlib.Path(text_folder) / f"{stem}.txt").write_text(boxes)
            dataset = supervision.DetectionDataset.from_yolo(
                images_directory_path=str(labels.frames),
                annotations_directory_path=text_folder,
                data_yaml_path=str(folder / "data.yaml"),
            )
        assert dataset.classes == [category["name"] for category in categories]
        for path, detections in dataset.annotations.items():
            number = int(pathlib.Path(path).stem)
            expected = sorted(labels.annotations[number].items())
            assert list(detections.class_id) == [category - 1 for category, _ in expected]
            for corners, (_, annotation) in zip(detections.xyxy, expected, strict=True):
                x, y, width, height = annotation["bbox"]
                errors.append(np.abs(corners - [x, y, x + width, y + height]).max())
    for path in sorted((labels.folder / "yolo" / "pose" / "labels").glob("*.txt")):
        number = int(path.stem)
        image = labels.coco.loadImgs(number)[0]
        for line in path.read_text().splitlines():
            values = np.array(line.split(), dtype=float)
            assert len(values) == 5 + 3 * most
            positions, visibility = labels.keypoints(number, int(values[0]) + 1)
            found = values[5:].reshape(-1, 3)[: len(positions)]
            assert list(found[:, 2]) == list(visibility) and ((0 <= found[:, :2]) & (found[:, :2] <= 1)).all()
            at = found[:, :2] * [image["width"], image["height"]] - 0.5
            points += list(np.linalg.norm(at - positions, axis=1)[visibility > 0])
    # supervision stores boxes in single precision.
    report.check(errors and worst(errors) < 1e-3, "YOLO boxes",
                 f"{len(errors)} by supervision, worst {worst(errors):.1e} px from those of COCO")
    report.check(worst(points) < TOLERANCE_PX, "YOLO keypoints",
                 f"{len(points)}, worst {worst(points):.1e} px from those of COCO")


def check_truth(labels, dataset, report):
    """The position of the target in the truth table, which the labels do not use."""
    fields = dataset / "truth" / "fields.parquet"
    is_field = fields.exists()
    table = pyarrow.parquet.read_table(fields if is_field else dataset / "truth" / "frames.parquet")
    key, x, y = ("field", "cross_x_px", "cross_y_px") if is_field else ("frame", "target_x_px", "target_y_px")
    distances = []
    for row in table.select([key, x, y]).to_pylist():
        number = row[key]
        if 1 not in labels.annotations[number] or row[x] is None:
            continue
        first, step = {"even": (0, 2), "odd": (1, 2)}.get(labels.camera.rows[number].get("lines"), (0, 1))
        positions, visibility = labels.keypoints(number, 1)
        index = 1 if is_field else 0
        if visibility[index] > 0:
            distances.append(np.linalg.norm(positions[index] - [row[x], (row[y] - first) / step]))
    report.check(distances and worst(distances) < TOLERANCE_PX, "truth table",
                 f"{len(distances)} positions of the target, worst {worst(distances):.1e} px")


def check_extent(labels, report):
    """The box of a far-range target of plates ends at its outermost corners."""
    errors = []
    for number, objects in labels.annotations.items():
        if 1 not in objects:
            continue
        positions, visibility = labels.keypoints(number, 1)
        x, y, width, height = objects[1]["bbox"]
        if len(positions) > 1 and visibility.all():
            # A mask ends before a right-angled corner: half a pixel where its tip is narrower than a pixel,
            # and up to one more to the next centre.
            corners = [*positions.min(axis=0), *positions.max(axis=0)]
            errors.append(np.abs(np.array([x, y, x + width - 1, y + height - 1]) - corners).max())
    report.check(worst(errors) <= 1.5, "extent", f"{len(errors)} boxes, worst {worst(errors):.2f} px from the corners")


COLOURS = [(255, 170, 0), (0, 200, 255), (190, 110, 255)]


def draw(labels, number, path):
    """Draws masks, boxes and keypoints (green visible, red hidden) over an image; a field at twice its height.
    """
    image = labels.coco.loadImgs(number)[0]
    with Image.open(labels.frames / image["file_name"]) as file:
        values = np.asarray(file).astype(float)
    values = np.clip(255 * values / max(values.max(), 1), 0, 255)
    picture = np.repeat(values[:, :, None], 3, axis=2)
    for category, annotation in labels.annotations[number].items():
        covered = labels.coco.annToMask(annotation) > 0
        picture[covered] = 0.65 * picture[covered] + 0.35 * np.array(COLOURS[(category - 1) % 3])
    sx = max(1, 1536 // image["width"])
    is_field = labels.camera.rows[number].get("lines") in ("even", "odd")
    sy = sx * (2 if is_field else 1)
    size = (image["width"] * sx, image["height"] * sy)
    canvas = Image.fromarray(picture.astype(np.uint8)).resize(size, Image.NEAREST)
    pen = ImageDraw.Draw(canvas)
    for category, annotation in labels.annotations[number].items():
        x, y, width, height = annotation["bbox"]
        box = [x * sx, y * sy, (x + width) * sx - 1, (y + height) * sy - 1]
        pen.rectangle(box, outline=COLOURS[(category - 1) % 3], width=2)
        # The centre of the first pixel is at half a pixel from its corner.
        for (x, y), visibility in zip(*labels.keypoints(number, category)):
            if visibility > 0:
                at = ((x + 0.5) * sx, (y + 0.5) * sy)
                colour = (0, 255, 0) if visibility == 2 else (255, 0, 0)
                pen.ellipse([at[0] - 4, at[1] - 4, at[0] + 4, at[1] + 4], outline=colour, width=2)
    canvas.save(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dataset", type=pathlib.Path)
    parser.add_argument("--overlay", nargs=2, metavar=("FRAME", "FILE"), help="draw the labels of a frame")
    arguments = parser.parse_args()
    try:
        labels = Labels(arguments.dataset)
    except (OSError, KeyError, ValueError) as error:
        print(f"{arguments.dataset}: {error}", file=sys.stderr)
        return 2
    report = Report()
    check_coco(labels, report)
    check_truth(labels, arguments.dataset, report)
    if not (arguments.dataset / "setup.toml").exists():
        check_extent(labels, report)
    for name, check in (("bop", check_bop), ("speed", check_speed), ("yolo", check_yolo)):
        if labels.has(name):
            check(labels, report)
    if arguments.overlay:
        draw(labels, int(arguments.overlay[0]), arguments.overlay[1])
    return 1 if report.failed else 0


if __name__ == "__main__":
    sys.exit(main())
