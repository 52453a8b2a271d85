#!/usr/bin/env python3
"""Makes docs/images/frame.png, the picture of the README, from frames that Boresight renders.

    pip install -r tests/python/requirements.txt
    cargo build --release
    python3 docs/images/make_frame.py target/release/boresight docs/images/frame.png

Left: a whole frame of the scenario `starting-point`, circles from the truth table. Right: the region of interest
around the target in `argon`, on day 1 (whole) and on day 4 (its lower part cut off on board), enlarged.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyarrow.parquet as parquet
from PIL import Image, ImageDraw, ImageFont

BLACK_DN, WHITE_DN = 38.0, 140.0
COLOURS = {"target": (255, 176, 64), "star": (96, 200, 255), "hot_pixel": (255, 96, 112)}


def render(boresight, scenario, frame, folder):
    """One frame: its DN, its objects."""
    out = Path(folder) / f"{scenario}-{frame}"
    command = [boresight, "render", scenario, "--frames", f"{frame}..{frame + 1}", "--format", "png", "--out", out]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    dn = np.array(Image.open(out / f"frames/{frame:06}.png")).astype(float)
    return dn, parquet.read_table(out / "truth/objects.parquet").to_pylist()


def stretched(dn, black=BLACK_DN, white=WHITE_DN):
    grey = np.arcsinh(10 * np.clip((dn - black) / (white - black), 0, 1)) / np.arcsinh(10)
    return Image.fromarray((255 * grey).astype("uint8")).convert("RGB")


def whole(dn, objects):
    picture = stretched(dn)
    draw = ImageDraw.Draw(picture)
    for thing in objects:
        if thing["snr"] < 12:
            continue
        radius = 14 if thing["kind"] == "target" else 7
        x, y = thing["x_px"], thing["y_px"]
        draw.ellipse([x - radius, y - radius, x + radius, y + radius], outline=COLOURS.get(thing["kind"], (200, 200, 200)), width=2)
    return picture


def enlarged(dn, objects, side=32, scale=9):
    target = next(thing for thing in objects if thing["kind"] == "target")
    x, y = round(target["x_px"]) - side // 2, round(target["y_px"]) - side // 2
    cutout = stretched(dn[y : y + side, x : x + side], 0.0, 4095.0)
    picture = cutout.resize((side * scale, side * scale), Image.Resampling.NEAREST)
    cross = [(target["x_px"] - x + 0.5) * scale, (target["y_px"] - y + 0.5) * scale]
    draw = ImageDraw.Draw(picture)
    draw.line([cross[0] - 8, cross[1], cross[0] + 8, cross[1]], fill=COLOURS["target"], width=2)
    draw.line([cross[0], cross[1] - 8, cross[0], cross[1] + 8], fill=COLOURS["target"], width=2)
    return picture


def main(boresight, path):
    font = ImageFont.load_default(15)
    with tempfile.TemporaryDirectory() as folder:
        left = whole(*render(boresight, "starting-point", 200, folder))
        panels = [
            (enlarged(*render(boresight, "argon", 300, folder)), "day 1, 30 km: whole"),
            (enlarged(*render(boresight, "argon", 12800, folder)), "day 4, 8 km: cut on board"),
        ]
    sheet = Image.new("RGB", (left.width + 4 + panels[0][0].width, left.height), (24, 24, 28))
    sheet.paste(left, (0, 0))
    for i, (panel, caption) in enumerate(panels):
        top = i * (left.height // 2 + 2)
        sheet.paste(panel.crop((0, 0, panel.width, left.height // 2 - 2)), (left.width + 4, top))
        ImageDraw.Draw(sheet).text((left.width + 12, top + 6), caption, font=font, fill=(235, 235, 235))
    sheet.quantize(64).save(path, optimize=True)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
