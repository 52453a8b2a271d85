"""Degradations of the fields of a rendered docking dataset, by OpenCV and ffmpeg.

A sequence is an array (fields, rows, columns) of 8-bit grey values; fields alternate between the even and the
odd rows of a camera frame, first field first. Every function returns a new array. None of it uses the
television of the simulator.
"""

import subprocess

import cv2
import numpy as np

TURN_DEG = 2.0


def blurred(fields, sigma_px):
    """Each field by itself, through ffmpeg's Gaussian filter; σ in pixels of the field, along columns and
    rows."""
    _, rows, columns = fields.shape
    command = ["ffmpeg", "-v", "error", "-f", "rawvideo", "-pix_fmt", "gray", "-s", f"{columns}x{rows}", "-i", "-",
               "-vf", f"gblur=sigma={sigma_px}:steps=4", "-f", "rawvideo", "-pix_fmt", "gray", "-"]
    answer = subprocess.run(command, input=fields.tobytes(), stdout=subprocess.PIPE, check=True).stdout
    return np.frombuffer(answer, np.uint8).reshape(fields.shape).copy()


def blurred_frames(fields, sigma_px):
    """Both fields of a frame interleaved, blurred and separated again: each then contains a part of the
    other's time."""
    made = fields.copy()
    for k in range(0, len(fields) - 1, 2):
        frame = np.empty((2 * fields.shape[1], fields.shape[2]), np.uint8)
        frame[0::2], frame[1::2] = fields[k], fields[k + 1]
        frame = cv2.GaussianBlur(frame, (0, 0), sigma_px)
        made[k], made[k + 1] = frame[0::2], frame[1::2]
    return made


def jpeg(fields, quality):
    coded = (cv2.imencode(".jpg", field, [cv2.IMWRITE_JPEG_QUALITY, quality])[1] for field in fields)
    return np.stack([cv2.imdecode(code, cv2.IMREAD_GRAYSCALE) for code in coded])


def table(fields, function):
    """Each grey value by a function of it, 0 to 1 to 0 to 1."""
    values = np.clip(np.rint(255.0 * function(np.arange(256) / 255.0)), 0, 255).astype(np.uint8)
    return cv2.LUT(fields.reshape(-1, fields.shape[2]), values).reshape(fields.shape)


def share(count, part, seed):
    """Numbers of `part` of the fields from the third on, drawn."""
    drawn = np.random.default_rng(seed).random(count) < part
    return [k for k in range(2, count) if drawn[k]]


def black(fields, part, seed):
    made = fields.copy()
    made[share(len(fields), part, seed)] = 0
    return made


def repeated(fields, part, seed):
    """Replaces some fields by the preceding field of the same rows, bit for bit."""
    made = fields.copy()
    for k in share(len(fields), part, seed):
        made[k] = made[k - 2]
    return made


def turned(fields, principal, first_is_odd):
    """The picture turned about the principal point by TURN_DEG, its content from +x towards +y; each field by
    itself."""
    _, rows, columns = fields.shape
    cos, sin = np.cos(np.radians(TURN_DEG)), np.sin(np.radians(TURN_DEG))
    made = []
    for k, field in enumerate(fields):
        row0 = (k + first_is_odd) % 2
        # From a pixel of the new field to the camera, back by the turn, to the old field.
        to_camera = np.array([[1, 0, -principal[0]], [0, 2, row0 - principal[1]], [0, 0, 1.0]])
        back = np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1.0]])
        matrix = (np.linalg.inv(to_camera) @ back @ to_camera)[:2]
        flags = cv2.INTER_CUBIC | cv2.WARP_INVERSE_MAP
        made.append(cv2.warpAffine(field, matrix, (columns, rows), flags=flags, borderMode=cv2.BORDER_REPLICATE))
    return np.stack(made)


def everything(fields, scene):
    fields = turned(fields, scene["principal"], scene["first_is_odd"])
    fields = table(blurred(fields, 1.5), lambda v: 0.5 * v)
    return jpeg(repeated(fields, 0.1, scene["seed"]), 50)


# Name, True if the picture is turned, function of fields and scene.
KINDS = {
    "none": (False, lambda fields, scene: fields),
    "blur 1.5": (False, lambda fields, scene: blurred(fields, 1.5)),
    "blur 3": (False, lambda fields, scene: blurred(fields, 3.0)),
    "blur 1.5 frame": (False, lambda fields, scene: blurred_frames(fields, 1.5)),
    "jpeg 50": (False, lambda fields, scene: jpeg(fields, 50)),
    "contrast 0.5": (False, lambda fields, scene: table(fields, lambda v: 0.5 * v)),
    "gamma 0.6": (False, lambda fields, scene: table(fields, lambda v: v**0.6)),
    "black 10 %": (False, lambda fields, scene: black(fields, 0.1, scene["seed"])),
    "repeated 10 %": (False, lambda fields, scene: repeated(fields, 0.1, scene["seed"])),
    "turned 2 deg": (True, lambda fields, scene: turned(fields, scene["principal"], scene["first_is_odd"])),
    "all": (True, everything),
}
