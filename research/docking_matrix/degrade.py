"""Degradations of the fields of a rendered docking dataset, by OpenCV and ffmpeg.

A sequence is an array (fields, rows, columns) of 8-bit grey values; fields alternate between the even and the
odd rows of a camera frame, first field first. Every function returns a new array. None of it uses the
television of the simulator.
"""

import dataclasses
import pathlib
import subprocess
import tempfile
import typing

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


def turned(fields, principal, first_is_odd, angle_deg=TURN_DEG):
    """The picture turned about the principal point by an angle, its content from +x towards +y; each field by
    itself."""
    _, rows, columns = fields.shape
    cos, sin = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
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


def grey(values):
    """Grey values rounded and clipped to 8 bits."""
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)


def camera_rows(fields, k, first_is_odd):
    """Rows of the camera of field `k`."""
    return 2 * np.arange(fields.shape[1]) + (k + first_is_odd) % 2


def frames_of(fields, first_is_odd):
    """Fields 0 and 1, 2 and 3, … interleaved, the even rows from the field with the even rows."""
    count, rows, columns = fields.shape
    frames = np.empty((count // 2, 2 * rows, columns), np.uint8)
    frames[:, first_is_odd::2], frames[:, 1 - first_is_odd :: 2] = fields[0::2], fields[1::2]
    return frames


def fields_of(frames, first_is_odd):
    """Inverse of `frames_of`."""
    count, rows, columns = frames.shape
    fields = np.empty((2 * count, rows // 2, columns), np.uint8)
    fields[0::2], fields[1::2] = frames[:, first_is_odd::2], frames[:, 1 - first_is_odd :: 2]
    return fields


def through_ffmpeg(pictures, filters, rate=50):
    """Pictures through filters of ffmpeg that keep number and size."""
    count, rows, columns = pictures.shape
    raw = ["-f", "rawvideo", "-pix_fmt", "gray", "-s", f"{columns}x{rows}", "-r", str(rate)]
    command = ["ffmpeg", "-v", "error", *raw, "-i", "-", "-vf", f"format=yuv444p,{filters},format=gray", *raw, "-"]
    made = subprocess.run(command, input=pictures.tobytes(), stdout=subprocess.PIPE, check=True).stdout
    return np.frombuffer(made, np.uint8).reshape(count, rows, columns).copy()


def coded(pictures, coder, rate=50):
    """Pictures coded and decoded by ffmpeg; `coder` are its arguments. The levels keep their full range."""
    count, rows, columns = pictures.shape
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "coded.mkv"
        raw = ["-f", "rawvideo", "-s", f"{columns}x{rows}"]
        scale = "scale=in_range=pc:out_range=tv,format=yuv420p"
        subprocess.run(["ffmpeg", "-v", "error", *raw, "-pix_fmt", "gray", "-r", str(rate), "-i", "-", "-vf", scale,
                        *coder, "-threads", "1", str(file)], input=pictures.tobytes(), check=True)
        made = subprocess.run(["ffmpeg", "-v", "error", "-i", str(file), "-fps_mode", "passthrough", "-vf",
                               "scale=in_range=tv:out_range=pc,format=gray", *raw, "-pix_fmt", "gray", "-"],
                              stdout=subprocess.PIPE, check=True).stdout
    return np.frombuffer(made, np.uint8).reshape(count, rows, columns).copy()


def h264(kbit_s):
    """Coder of H.264 at a rate, without frames from the future."""
    return ["-c:v", "libx264", "-preset", "medium", "-tune", "zerolatency", "-b:v", f"{kbit_s}k", "-maxrate",
            f"{kbit_s}k", "-bufsize", f"{kbit_s // 2}k"]


def mpeg2(kbit_s):
    return ["-c:v", "mpeg2video", "-b:v", f"{kbit_s}k", "-maxrate", f"{kbit_s}k", "-bufsize", f"{kbit_s}k", "-bf", "0",
            "-g", "12"]


def coded_frames(fields, scene, coder):
    """Frames of two fields through a coder; each frame then mixes its two times."""
    return fields_of(coded(frames_of(fields, scene["first_is_odd"]), coder, 25), scene["first_is_odd"])


def resampled(fields, columns, down=cv2.INTER_AREA, up=cv2.INTER_CUBIC, rows=None):
    """Each field to another number of columns (and rows) and back."""
    _, height, width = fields.shape
    return np.stack([cv2.resize(cv2.resize(field, (columns, rows or height), interpolation=down), (width, height),
                                interpolation=up) for field in fields])


def resampled_frames(fields, scene, columns, rows, kernel):
    """Whole frames to another size and back, by ffmpeg."""
    frames = frames_of(fields, scene["first_is_odd"])
    _, height, width = frames.shape
    filters = f"scale={columns}:{rows}:flags={kernel},scale={width}:{height}:flags={kernel}"
    return fields_of(through_ffmpeg(frames, filters, 25), scene["first_is_odd"])


def single_field_resampled(fields, scene, columns):
    """What a digitiser of 352 x 288 keeps: one field of each frame, both fields of the output made from it."""
    made = resampled(fields, columns)
    made[1::2] = made[0::2]
    return made


def remapped(fields, scene, source):
    """Each field from the position `source(x, y)`, in pixels of the camera, of the old one."""
    _, rows, columns = fields.shape
    made = []
    for k, field in enumerate(fields):
        at = camera_rows(fields, k, scene["first_is_odd"])
        x, y = np.meshgrid(np.arange(columns, dtype=float), at.astype(float))
        x, y = source(x, y)
        made.append(cv2.remap(field, x.astype(np.float32), ((y - at[0]) / 2).astype(np.float32), cv2.INTER_CUBIC,
                              borderMode=cv2.BORDER_REPLICATE))
    return np.stack(made)


def distorted(fields, scene, share):
    """Radial distortion that the camera file does not state; `share` at the corner of the picture, 480 px."""
    px, py = scene["principal"]

    def source(x, y):
        grows = 1.0 - share * ((x - px) ** 2 + (y - py) ** 2) / 480.0**2
        return px + (x - px) * grows, py + (y - py) * grows

    return remapped(fields, scene, source)


def stretched(fields, scene, share):
    """Columns wider by a share: pixels that are not square as the camera file states."""
    px = scene["principal"][0]
    return remapped(fields, scene, lambda x, y: (px + (x - px) / (1.0 + share), y))


def sheared(fields, scene, share):
    """Rows displaced along the line by a share of their distance from the middle."""
    py = scene["principal"][1]
    return remapped(fields, scene, lambda x, y: (x - share * (y - py), y))


def line_by_line(fields, scene, begin, end):
    """Rolling shutter: the first line is exposed `begin` fields after the field's time, the last one `end`. A
    line is linear in time between fields of the same rows."""
    count, rows, _ = fields.shape
    late = np.linspace(begin, end, rows)[:, None]
    made = fields.copy()
    for k in range(count):
        before, after = max(k - 2, 0), min(k + 2, count - 1)
        now = fields[k].astype(float)
        slope = np.where(late < 0, now - fields[before], fields[after] - now.astype(float)) / 2.0
        made[k] = grey(now + late * slope)
    return made


def flagged(fields, scene, amplitude_px, lines, spread_px=0.0):
    """Sync flagging of a tape: the first lines of a field are displaced, by `amplitude_px` exp(−line/lines).
    `spread_px`: scatter of the amplitude from field to field."""
    drawn = np.random.default_rng(scene["seed"])
    _, rows, columns = fields.shape
    made = []
    for field in fields:
        amplitude = amplitude_px + spread_px * drawn.normal()
        x, y = np.meshgrid(np.arange(columns, dtype=np.float32), np.arange(rows, dtype=np.float32))
        x -= amplitude * np.exp(-y / lines)
        made.append(cv2.remap(field, x, y, cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE))
    return np.stack(made)


def jittered(fields, scene, sigma_px, correlation=0.0):
    """Every line displaced by a random number; `correlation` of neighbouring lines (a tape)."""
    drawn = np.random.default_rng(scene["seed"])
    _, rows, columns = fields.shape
    made = []
    for field in fields:
        shift = drawn.normal(size=rows) * sigma_px
        for i in range(1, rows):
            shift[i] = correlation * shift[i - 1] + np.sqrt(1.0 - correlation**2) * shift[i]
        x, y = np.meshgrid(np.arange(columns, dtype=np.float32), np.arange(rows, dtype=np.float32))
        x -= shift[:, None].astype(np.float32)
        made.append(cv2.remap(field, x, y, cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE))
    return np.stack(made)


def frozen(fields, scene, begin, end):
    """Fields `begin` to `end` replaced by the two fields before them, each by the one of the same rows."""
    made = fields.copy()
    for k in range(begin, min(end, len(fields))):
        made[k] = made[k - 2]
    return made


def noisy(fields, scene, sigma_dn):
    noise = np.random.default_rng(scene["seed"]).normal(size=fields.shape)
    return grey(fields + sigma_dn * noise)


def of_other_rows(field, is_odd):
    """A field of even rows interpolated at the odd rows, or the reverse."""
    shifted = np.roll(field, 1 if is_odd else -1, axis=0).astype(float)
    return 0.5 * (field + shifted)


def lagging(fields, scene, share):
    """Image lag of a camera tube: `share` of the last field's picture remains."""
    made = fields.astype(float)
    for k in range(1, len(fields)):
        was_odd = (k - 1 + scene["first_is_odd"]) % 2
        made[k] = (1.0 - share) * fields[k] + share * of_other_rows(made[k - 1], not was_odd)
    return grey(made)


def averaged(fields, scene, share):
    """Recursive noise reduction over fields of the same rows."""
    made = fields.astype(float)
    for k in range(2, len(fields)):
        made[k] = (1.0 - share) * fields[k] + share * made[k - 2]
    return grey(made)


def ghosted(fields, scene, share, shift_px):
    """Echo of a cable or an antenna: the signal again, later on the line; negative shift: before."""
    echo = np.roll(fields, shift_px, axis=2).astype(float)
    if shift_px > 0:
        echo[:, :, :shift_px] = fields[:, :, :1]
    else:
        echo[:, :, shift_px:] = fields[:, :, -1:]
    return grey(fields + share * (echo - fields.mean()))


def unsharp(fields, scene, sigma_px, amount):
    """Unsharp mask along lines and rows."""
    return np.stack([grey(f + amount * (f.astype(float) - cv2.GaussianBlur(f.astype(float), (0, 0), sigma_px)))
                     for f in fields])


def rung(fields, scene, share, period_px, decay_px):
    """Ringing to the right of every edge of a line: a damped wave."""
    x = np.arange(1, 40)
    wave = share * np.exp(-x / decay_px) * np.cos(2 * np.pi * x / period_px)
    edges = np.diff(fields.astype(float), axis=2, prepend=fields[:, :, :1])
    made = fields.astype(float)
    for step, value in zip(x, wave):
        made[:, :, step:] += value * edges[:, :, :-step]
    return grey(made)


def swapped(fields, scene):
    """The two fields of a frame exchanged: wrong order of fields."""
    made = fields.copy()
    made[0::2], made[1::2] = fields[1::2], fields[0::2]
    return made


def bled(fields, scene, share, lines, carrier_dn):
    """Colour decoded badly: a part of the luminance comes a second time, broad and late, and the subcarrier
    remains as a pattern of fine dots."""
    broad = np.stack([cv2.GaussianBlur(f.astype(float), (0, 0), 4.0) for f in fields])
    late = np.roll(np.roll(broad, 6, axis=2), lines, axis=1)
    x, y = np.meshgrid(np.arange(fields.shape[2]), np.arange(fields.shape[1]))
    made = fields + share * (late - broad)
    for k in range(len(fields)):
        made[k] += carrier_dn * np.cos(2 * np.pi * (0.284 * x + 0.25 * y + 0.25 * k))
    return grey(made)


def stepped(fields, scene, share, every, row=None):
    """Gain that changes by ±`share` every few fields; with `row` within the field, from this row on."""
    made = fields.astype(float)
    for k in range(len(fields)):
        gain = 1.0 + share if (k // every) % 2 else 1.0 - share
        made[k, (row or 0) :] *= gain
    return grey(made)


def vignetted(fields, scene, share):
    x, y = np.meshgrid(np.linspace(-1, 1, fields.shape[2]), np.linspace(-1, 1, fields.shape[1]))
    return grey(fields * (1.0 - share * (x**2 + y**2) / 2.0))


def hummed(fields, scene, amplitude_dn, periods):
    """Hum of the mains: slow bars that roll through the picture."""
    y = np.arange(fields.shape[1]) / fields.shape[1]
    made = [f + amplitude_dn * np.sin(2 * np.pi * (periods * y + 0.07 * k))[:, None] for k, f in enumerate(fields)]
    return grey(np.stack(made))


def bent(fields, scene, amplitude_px, periods):
    """Lines displaced by a wave down the picture that stands still: geometry of a scan."""
    return remapped(fields, scene, lambda x, y: (x + amplitude_px * np.sin(2 * np.pi * periods * y / 576.0), y))


def specked(fields, scene, share):
    """Impulses: single pixels black or white."""
    drawn = np.random.default_rng(scene["seed"]).random(fields.shape)
    made = fields.copy()
    made[drawn < share / 2], made[drawn > 1 - share / 2] = 0, 255
    return made


def smeared(fields, scene, columns):
    """Motion blur along the line."""
    return np.stack([cv2.blur(field, (columns, 1)) for field in fields])


def line_doubled(fields, scene):
    """Only every second line of a field is sent, and repeated."""
    made = fields.copy()
    made[:, 1::2] = fields[:, 0::2]
    return made


def bobbed(fields, scene):
    """Deinterlaced to frames by interpolation, and interlaced again."""
    frames = frames_of(fields, scene["first_is_odd"])
    return fields_of(through_ffmpeg(frames, "yadif=mode=send_frame:deint=all", 25), scene["first_is_odd"])


def everything(fields, scene):
    fields = turned(fields, scene["principal"], scene["first_is_odd"])
    fields = table(blurred(fields, 1.5), lambda v: 0.5 * v)
    return jpeg(repeated(fields, 0.1, scene["seed"]), 50)


def turned_by(angle_deg):
    return lambda fields, scene: turned(fields, scene["principal"], scene["first_is_odd"], angle_deg)


def upside_down(fields, scene):
    """The frame turned by 180°: the rows of the even field are then those of the odd one, reversed."""
    made = fields.copy()
    made[0::2], made[1::2] = fields[1::2, ::-1, ::-1], fields[0::2, ::-1, ::-1]
    return made


@dataclasses.dataclass
class Kind:
    """A degradation: function of fields and scene, and the angle by which it turns the picture."""

    function: typing.Callable
    turn_deg: float = 0.0


def seeded(function, part):
    return Kind(lambda fields, scene: function(fields, part, scene["seed"]))


def kind(function, *arguments, **words):
    """A kind whose function has the fields and the scene as its first arguments."""
    return Kind(lambda fields, scene: function(fields, scene, *arguments, **words))


def plain(function, *arguments, **words):
    """A kind whose function has the fields alone as its first argument."""
    return Kind(lambda fields, scene: function(fields, *arguments, **words))


# The kinds of the first matrix.
FIRST = ["none", "blur 1.5", "blur 3", "blur 1.5 frame", "jpeg 50", "contrast 0.5", "gamma 0.6", "black 10 %",
         "repeated 10 %", "turned 2 deg", "all"]

KINDS = {
    "none": plain(lambda fields: fields),
    "blur 1.5": plain(blurred, 1.5),
    "blur 3": plain(blurred, 3.0),
    "blur 1.5 frame": plain(blurred_frames, 1.5),
    "jpeg 50": plain(jpeg, 50),
    "contrast 0.5": plain(table, lambda v: 0.5 * v),
    "gamma 0.6": plain(table, lambda v: v**0.6),
    "black 10 %": seeded(black, 0.1),
    "repeated 10 %": seeded(repeated, 0.1),
    "turned 2 deg": Kind(turned_by(TURN_DEG), TURN_DEG),
    "all": Kind(everything, TURN_DEG),
    # Time within a field, and of fields.
    "rolling shutter": kind(line_by_line, -0.5, 0.5),
    "rolling shutter late": kind(line_by_line, 0.0, 1.0),
    "lag 0.5": kind(lagging, 0.5),
    "lag 0.2": kind(lagging, 0.2),
    "average 0.5": kind(averaged, 0.5),
    "freeze": kind(frozen, 12, 62),
    "freeze noise 1": kind(lambda f, s: noisy(frozen(f, s, 12, 62), s, 1.0)),
    "freeze h264": kind(lambda f, s: coded(frozen(f, s, 12, 62), h264(2000))),
    "fields swapped": kind(swapped),
    "yadif": kind(bobbed),
    # Geometry of the scan.
    "upside down": Kind(upside_down, 180.0),
    "mirrored": plain(lambda fields: fields[:, :, ::-1].copy()),
    "flagging": kind(flagged, 8.0, 60.0),
    "flagging unsteady": kind(flagged, 8.0, 60.0, 2.0),
    "tape jitter": kind(jittered, 0.5, 0.95),
    "bent": kind(bent, 1.0, 1.5),
    "sheared 0.5 %": kind(sheared, 0.005),
    "distortion 1 %": kind(distorted, 0.01),
    "distortion -3 %": kind(distorted, -0.03),
    "pixels 2 % wide": kind(stretched, 0.02),
    # Size.
    "cif fields": plain(resampled, 352),
    "cif fields nearest": plain(resampled, 352, cv2.INTER_NEAREST, cv2.INTER_NEAREST),
    "cif fields linear": plain(resampled, 352, cv2.INTER_LINEAR, cv2.INTER_LINEAR),
    "cif one field": kind(single_field_resampled, 352),
    "cif frames": kind(resampled_frames, 352, 288, "bicubic"),
    "640 x 480 frames": kind(resampled_frames, 640, 480, "lanczos"),
    "720 x 288 fields": plain(resampled, 720, cv2.INTER_LINEAR, cv2.INTER_LINEAR),
    "lines doubled": kind(line_doubled),
    # Coding.
    "h264 200": plain(coded, h264(200)),
    "h264 500": plain(coded, h264(500)),
    "h264 1000": plain(coded, h264(1000)),
    "h264 frames 500": kind(coded_frames, h264(500)),
    "h264 interlaced 500": kind(coded_frames, [*h264(500), "-flags", "+ildct+ilme"]),
    "mpeg2 500": plain(coded, mpeg2(500)),
    "mpeg2 frames 1500": kind(coded_frames, mpeg2(1500)),
    "jpeg 10": plain(jpeg, 10),
    "jpeg 25": plain(jpeg, 25),
    # The signal.
    "ghost 15 %": kind(ghosted, 0.15, 25),
    "ghost 8 % near": kind(ghosted, 0.08, 5),
    "unsharp": kind(unsharp, 1.5, 1.0),
    "ringing": kind(rung, 0.2, 8.0, 6.0),
    "bled": kind(bled, 0.15, 1, 3.0),
    "gain steps": kind(stepped, 0.15, 8),
    "gain step in field": kind(stepped, 0.15, 8, 140),
    "hqdn3d": plain(through_ffmpeg, "hqdn3d=4:3:12:9"),
    # Not on any list.
    "vignette": kind(vignetted, 0.5),
    "hum": kind(hummed, 12.0, 1.5),
    "specks": kind(specked, 0.01),
    "smear 5 px": kind(smeared, 5),
    "noise 8": kind(noisy, 8.0),
    "posterised": plain(table, lambda v: np.round(v * 12) / 12),
    "negative": plain(table, lambda v: 1.0 - v),
    "gamma 1.8": plain(table, lambda v: v**1.8),
    "median": plain(lambda fields: np.stack([cv2.medianBlur(field, 3) for field in fields])),
    "bilateral": plain(lambda fields: np.stack([cv2.bilateralFilter(field, 5, 25, 3) for field in fields])),
    "equalised": plain(lambda fields: np.stack([cv2.createCLAHE(3.0, (8, 8)).apply(field) for field in fields])),
    "turned -5 deg": Kind(turned_by(-5.0), -5.0),
    "white clip": plain(table, lambda v: 1.6 * v),
}
