#!/usr/bin/env python3
"""Frames that a fit of a camera must not trust: an external check of docs/evidence/camera-fit.md.

    hostile.py PROGRAM [--folders 6] [--seed 1] [--kind NAME]... [--process]

Draws folders of frames with the sky and the projection of check.py (GalSim, ERFA, OpenCV), spoils each in one way
(KINDS), and runs `boresight camera fit` on it, with a field that is stated with an error of up to 9 %. With
`--process` the frames that are images of the right size also go through `boresight process` without a prior.

An answer is "right" if the focal length is within 0.3 % of the camera of most frames, no position in the image is
off by more than 1 px or the stated errors, and no attitude by more than 0.1 degrees; "named" if the program gives
no camera and states the words expected of the kind; "refused" with other words; "false" otherwise. Some kinds also
require words beside a camera, as a warning or as the reason of a frame that is left out: without them a right
answer is "silent". Printed: a line per kind. Exit status 0 when no answer is false or silent, every answer of a
kind that has a camera is right, and all other answers are named. Needs requirements.txt.
"""

import argparse
import collections
import csv
import dataclasses
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import cv2
import galsim
import numpy as np
from astropy.time import Time

from check import MIN_DETECTABLE, Camera, Sky, draw, telemetry, toml, turn, write

EPOCH = "2026-03-01T00:00:00"
FALSE_DEG, FOCAL, PLACE_PX = 0.1, 3e-3, 1.0
FULL_DN = 4095


@dataclasses.dataclass
class Folder:
    """Frames of a trial with their truth."""

    camera: Camera
    images: list
    # Attitude of each frame; None for a frame that has none, or whose attitude must not be found.
    truths: list
    # Frames that must be left out.
    left_out: tuple = ()
    time: str = EPOCH
    # Attitudes for `process`, where they are not those of `truths`.
    attitudes: list = None


def random_camera(random):
    """A camera of 8 to 30 degrees whose distortion moves the corners by up to some percent."""
    columns, rows, pixel_um = 800, 600, 5.0
    field = np.radians(np.exp(random.uniform(np.log(8), np.log(30))))
    focal_px = columns / 2 / np.tan(field / 2)
    corner = np.hypot(columns, rows) / 2 / focal_px
    radial = random.normal(0, 0.01)
    limit = min(max(8.5 - 2.5 * np.log10(np.degrees(field) / 12), 5.5), 9.0)
    zero = 12 * np.sqrt(124) * 10 ** (0.4 * limit)
    return Camera(
        f"{np.degrees(field):.1f} deg", EPOCH, columns, rows, float(focal_px * pixel_um / 1e3), pixel_um, (float(radial / corner**2), 0.0, 0.0, 0.0, 0.0), 12, "png", float(zero),
        1.0, 60, 8, 4.0, limit, galsim.Gaussian(sigma=random.uniform(0.7, 1.2)), gradient=random.uniform(0, 0.3), hot_pixels=int(random.integers(0, 20)),
    )


def attitude(random):
    q = random.normal(size=4)
    return q / np.linalg.norm(q)


def frame(camera, random, sky, time=EPOCH):
    """A frame with at least 20 detectable stars, and its attitude."""
    while True:
        truth = attitude(random)
        pixels, detectable, _ = draw(camera, truth, Time(time, scale="utc"), sky, random)
        if detectable >= 2 * MIN_DETECTABLE:
            return pixels, truth


def plain(camera, random, sky, count=3, time=EPOCH):
    images, truths = zip(*(frame(camera, random, sky, time) for _ in range(count)))
    return Folder(camera, list(images), list(truths))


def dark(camera, random, sky, stars):
    """Frames of noise with some stars at random."""
    images = []
    for _ in range(3):
        image = galsim.ImageF(camera.columns, camera.rows, init_value=camera.sky_e)
        for _ in range(stars):
            x, y = random.uniform(20, camera.columns - 20), random.uniform(20, camera.rows - 20)
            stamp = camera.psf.withFlux(2e4).drawImage(nx=41, ny=41, scale=1.0, center=galsim.PositionD(x, y))
            common = stamp.bounds & image.bounds
            image[common] += stamp[common]
        noisy = random.poisson(np.maximum(image.array, 0)) + random.normal(0, camera.read_noise_e, image.array.shape)
        images.append(np.clip(np.rint(64 + noisy / camera.gain_e_per_dn), 0, FULL_DN).astype(np.uint16))
    return Folder(camera, images, [None] * 3)


def noise_field(shape, random, scale):
    """A field of structure on scales of `scale` px and below, 0 to 1."""
    total = np.zeros(shape)
    while scale >= 4:
        coarse = random.normal(size=(max(2, int(shape[0] / scale) + 2), max(2, int(shape[1] / scale) + 2)))
        total += scale**0.8 * cv2.resize(coarse, shape[::-1], interpolation=cv2.INTER_CUBIC)
        scale /= 2
    low, high = np.percentile(total, [1, 99])
    return np.clip((total - low) / (high - low), 0, 1)


def clouds(camera, random, sky):
    """Clouds that hide about half of the stars, and glow."""
    folder = plain(camera, random, sky)
    for at, image in enumerate(folder.images):
        field = noise_field(image.shape, random, 200)
        cloud = np.clip((field - 0.45) / 0.15, 0, 1)
        through = np.exp(-4 * cloud)
        glow = random.uniform(100, 600) * cloud * (0.5 + field)
        dn = 64 + (image.astype(float) - 64) * through + random.poisson(glow * camera.gain_e_per_dn) / camera.gain_e_per_dn
        folder.images[at] = np.clip(np.rint(dn), 0, FULL_DN).astype(np.uint16)
    return folder


def trails(camera, random, sky):
    length, way = random.uniform(5, 40), random.uniform(0, 180) * galsim.degrees
    # The light of a star is spread over the trail: brighter stars keep as many detectable.
    trailed = dataclasses.replace(
        camera, name=f"{camera.name}, trails of {length:.0f} px", zero_e_per_s=camera.zero_e_per_s * (1 + length / 4),
        psf=galsim.Convolve(camera.psf, galsim.Box(length, 0.01).rotate(way), gsparams=galsim.GSParams(maximum_fft_size=16384)),
    )
    return plain(trailed, random, sky)


def moon(camera, random, sky):
    folder = plain(camera, random, sky)
    rows, columns = np.indices(folder.images[0].shape)
    for at, image in enumerate(folder.images):
        x, y, radius = random.uniform(0, camera.columns), random.uniform(0, camera.rows), random.uniform(20, 80)
        distance = np.hypot(columns - x, rows - y) / radius
        light = np.where(distance < 1, 1e6, 3000 / np.maximum(distance, 1) ** 2)
        dn = image + random.poisson(light * camera.gain_e_per_dn) / camera.gain_e_per_dn
        folder.images[at] = np.clip(np.rint(dn), 0, FULL_DN).astype(np.uint16)
    return folder


def two_cameras(camera, other, random, sky):
    """Four frames of a camera and two of another one, in random order."""
    first, second = plain(camera, random, sky, 4), plain(other, random, sky, 2)
    images, truths, attitudes = first.images + second.images, first.truths + [None] * 2, first.truths + second.truths
    order = random.permutation(6)
    left_out = tuple(int(at) for at in np.flatnonzero(order >= 4))
    return Folder(camera, [images[i] for i in order], [truths[i] for i in order], left_out, attitudes=[attitudes[i] for i in order])


def other_focal(camera, random, sky):
    share = random.choice([-1, 1]) * random.uniform(0.004, 0.08)
    return two_cameras(camera, dataclasses.replace(camera, focal_mm=camera.focal_mm * (1 + share)), random, sky)


def other_distortion(camera, random, sky):
    corner = np.hypot(camera.columns, camera.rows) / 2 / camera.focal_px
    more = random.choice([-1, 1]) * random.uniform(0.015, 0.04) / corner**2
    distortion = (camera.distortion[0] + float(more), *camera.distortion[1:])
    return two_cameras(camera, dataclasses.replace(camera, distortion=distortion), random, sky)


def other_size(camera, random, sky):
    folder = plain(camera, random, sky)
    at = int(random.integers(3))
    folder.images[at] = folder.images[at][: random.integers(300, 590), : random.integers(300, 790)]
    return dataclasses.replace(folder, left_out=(at,), truths=[None if i == at else truth for i, truth in enumerate(folder.truths)])


def mapped(change, keep_truth=False):
    def spoiled(camera, random, sky):
        folder = plain(camera, random, sky)
        return dataclasses.replace(folder, images=[change(image) for image in folder.images], truths=folder.truths if keep_truth else [None] * 3)

    return spoiled


def years(amount):
    def spoiled(camera, random, sky):
        return dataclasses.replace(plain(camera, random, sky, 6), time=str(np.datetime64(EPOCH) + np.timedelta64(int(amount * 365.25 * 86400), "s")))

    return spoiled


def text(camera, random, sky):
    """A page of a screen: windows with lines of text."""
    images = []
    for _ in range(3):
        image = np.full((camera.rows, camera.columns), random.choice([20, 245]), np.uint8)
        for _ in range(4):
            left, top = int(random.integers(0, 500)), int(random.integers(0, 400))
            ground = int(random.integers(0, 256))
            cv2.rectangle(image, (left, top), (left + 320, top + 240), ground, -1)
            for line in range(10):
                words = "".join(chr(random.integers(33, 123)) if random.uniform() < 0.85 else " " for _ in range(28))
                cv2.putText(image, words, (left + 6, top + 20 + 22 * line), int(random.integers(0, 4)), random.uniform(0.35, 0.55), int((ground + 128) % 256), 1, cv2.LINE_AA)
        images.append(image)
    return Folder(camera, images, [None] * 3)


def eight_bits(image):
    return np.clip(image >> 2, 0, 255).astype(np.uint8)


# Each kind: what draws it, whether a camera is expected (None: either), and the words that must be in the
# answer; of kinds without a decided answer only in a refusal.
KINDS = {
    "plain": (plain, True, None),
    "no stars": (lambda *of: dark(*of, 0), False, "star-like source"),
    "one star": (lambda *of: dark(*of, 1), False, "star-like source"),
    "clouds": (clouds, None, "star-like source"),
    "trails": (trails, None, "trails along"),
    "Moon": (moon, True, None),
    "other focal length": (other_focal, True, "own focal length|no set of them matches"),
    "other distortion": (other_distortion, True, "do not fit the camera of the other frames"),
    "other size": (other_size, False, "a camera has one size"),
    "a year wrong": (years(1), True, None),
    "half a year wrong": (years(0.5), True, None),
    "ten years wrong": (years(10), True, None),
    "left-right": (mapped(np.fliplr), False, "mirrored left to right"),
    "up-down": (mapped(np.flipud), False, "mirrored"),
    "bytes swapped": (mapped(lambda image: image.byteswap()), False, "bytes .* swapped"),
    "to 8 bits": (mapped(eight_bits, keep_truth=True), True, None),
    "negative": (mapped(lambda image: (FULL_DN - image).astype(np.uint16)), False, "negative"),
    "text": (text, False, "star-like sources"),
}


def angle_deg(q, truth):
    return np.degrees(2 * np.arccos(np.clip(abs(np.dot(q, truth)), 0, 1)))


def pointing_error_deg(frame, truth):
    """The larger error of the direction at the centre of the image and of the roll there. The attitude itself is no
    measure: in a narrow field, a shift of the principal point stands for a rotation."""
    x, y, z = cv2.Rodrigues(turn(truth))[0]
    ra, dec = np.radians([frame["ra_deg"], frame["dec_deg"]])
    found = np.array([np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)])
    north = np.array([-np.sin(dec) * np.cos(ra), -np.sin(dec) * np.sin(ra), np.cos(dec)])
    roll_deg = np.degrees(np.arctan2(x @ north, -y @ north))
    return max(np.degrees(np.arccos(min(found @ z, 1))), abs((frame["roll_deg"] - roll_deg + 180) % 360 - 180))


def fit(program, folder, images, random):
    camera = images.camera
    field_deg = 2 * np.degrees(np.arctan(camera.columns / 2 / camera.focal_px)) * (1 + random.uniform(-0.09, 0.09))
    return fit_with_field(program, folder, images, field_deg)


def fit_with_field(program, folder, images, field_deg, tolerance=0.1):
    """The answer of the program to a folder of images, with a stated field."""
    for at, image in enumerate(images.images):
        write(folder / f"{at:03}.png", image)
    done = subprocess.run(
        [program, "--json", "camera", "fit", folder, "--field-deg", f"{field_deg:.4f}", "--tolerance", str(tolerance), "--pixel-um", str(images.camera.pixel_um), "--time", images.time + "Z"],
        capture_output=True, text=True,
    )
    if done.returncode == 2:
        return {"ok": False, "error": done.stderr}
    found = json.loads(done.stdout)
    return {**found, "notes": done.stderr}


def largest_offset_px(found, camera):
    """Largest distance over the image between the places of the same directions by the fitted and the true camera,
    after the rotation that fits best: a shift of the principal point is mostly a rotation."""
    x, y = np.meshgrid(np.linspace(0, camera.columns - 1, 9), np.linspace(0, camera.rows - 1, 7))
    places = np.stack([x.ravel(), y.ravel()], axis=1)
    distorted = (places - [(camera.columns - 1) / 2, (camera.rows - 1) / 2]) / camera.focal_px
    rays = distorted.copy()
    # The cameras of this script have k1 alone.
    for _ in range(60):
        rays = distorted / (1 + camera.distortion[0] * (rays**2).sum(axis=1, keepdims=True))
    rays = np.column_stack([rays, np.ones(len(rays))])
    f = 1e3 * found["focal_length_mm"] / found["pixel_width_um"]
    matrix = np.array([[f, 0, found["principal_x_px"]], [0, f, found["principal_y_px"]], [0, 0, 1.0]])
    (a, b, c), (d, e) = found["radial"], found["tangential"]
    terms = np.array([a * f**2, b * f**4, d * f, e * f, c * f**6])
    rotation = np.zeros(3)
    for _ in range(5):
        fitted, slopes = cv2.projectPoints(rays, rotation, np.zeros(3), matrix, terms)
        rest = (places - fitted[:, 0]).ravel()
        rotation = rotation + np.linalg.lstsq(slopes[:, :3], rest, rcond=None)[0]
    return np.abs(rest).max()


def judged(found, images, has_camera, words):
    """The class of an answer, and what is to be said of it."""
    everything = json.dumps(found, ensure_ascii=False)
    named = words is None or re.search(words, everything) is not None or (has_camera is None and found["ok"])
    if not found["ok"]:
        error = found["error"].strip().splitlines()
        short = re.sub(r"^.*?: ", "", error[0])
        if len(error) > 1:
            short += " / " + re.sub(r"^\s*[^:]*: ", "", error[1]) + " / " + error[-1]
        return ("named" if named and not has_camera else "refused"), short
    off_px = largest_offset_px(found["camera"], images.camera)
    focal = found["camera"]["focal_length_mm"] / images.camera.focal_mm - 1
    wrong = []
    for frame in found["frames"]:
        at = int(frame["name"][:3])
        truth = images.truths[at]
        if at in images.left_out:
            wrong.append(f"{at} is of another camera")
        elif truth is None:
            wrong.append(f"{at} has no attitude")
        elif (off := pointing_error_deg(frame, truth)) > FALSE_DEG:
            wrong.append(f"{at} off by {off:.2f} degrees")
    if wrong or abs(focal) > FOCAL:
        return "false", f"focal {focal:+.4f}, {', '.join(wrong)}"
    sigma_focal = found["parameters"][0]["sigma"] / found["camera"]["focal_length_mm"]
    note = f"focal {focal / sigma_focal:+.1f} sigma, {off_px:.2f} px, {len(found['frames'])} of {len(images.images)}, warnings {found.get('warnings')}"
    if off_px > PLACE_PX and abs(focal) > 5 * sigma_focal:
        return "false", note
    return ("right" if named else "silent"), note


def processed(program, images):
    """Classes of the frames by `boresight process` without a prior: counts of right, none and false."""
    counts = collections.Counter()
    if any(image.shape != images.images[0].shape for image in images.images) or any(image.max() > FULL_DN for image in images.images):
        return counts
    camera = dataclasses.replace(images.camera, bits=8 if images.images[0].dtype == np.uint8 else 12)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "frames").mkdir()
        for at, image in enumerate(images.images):
            write(folder / "frames" / f"{at:06}.png", image)
        (folder / "camera.toml").write_text(toml(camera, "none"))
        (folder / "telemetry.csv").write_text(telemetry(camera, [(1, 0, 0, 0)] * len(images.images)))
        done = subprocess.run([program, "--json", "process", folder], capture_output=True, text=True)
        if done.returncode == 2:
            raise SystemExit(f"process: {done.stderr}")
        with open(folder / "measurements.csv") as file:
            for row, truth in zip(csv.DictReader(file), images.attitudes or images.truths, strict=True):
                if not row["q_cam_j2000_w"]:
                    counts["none"] += 1
                    continue
                q = np.array([float(row[f"q_cam_j2000_{c}"]) for c in "wxyz"])
                counts["right" if truth is not None and angle_deg(q, truth) < FALSE_DEG else "other"] += 1
    return counts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--folders", type=int, default=6, help="folders of each kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", action="append", choices=KINDS)
    parser.add_argument("--process", action="store_true")
    arguments = parser.parse_args()
    sky = Sky()
    holds = True
    for number, (kind, (spoil, has_camera, words)) in enumerate(KINDS.items()):
        if arguments.kind and kind not in arguments.kind:
            continue
        classes, notes, frames = collections.Counter(), [], collections.Counter()
        for trial in range(arguments.folders):
            random = np.random.default_rng([arguments.seed, number, trial])
            images = spoil(random_camera(random), random, sky)
            with tempfile.TemporaryDirectory() as folder:
                found = fit(arguments.program, pathlib.Path(folder), images, random)
            answer, note = judged(found, images, has_camera, words)
            classes[answer] += 1
            notes.append(f"    {answer}: {images.camera.name}: {note}")
            if arguments.process:
                frames += processed(arguments.program, images)
        good = {True: classes["right"], False: classes["named"], None: classes["right"] + classes["named"]}[has_camera]
        holds &= good == arguments.folders
        print(f"{kind}: {', '.join(f'{count} {name}' for name, count in sorted(classes.items()))}" + (f"; process: {dict(frames)}" if arguments.process else ""))
        print("\n".join(notes), flush=True)
    return 0 if holds else 1


if __name__ == "__main__":
    sys.exit(main())
