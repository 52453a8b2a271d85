#!/usr/bin/env python3
"""Makes docs/images/docking.png, the picture of the README, from fields that Boresight draws and measures.

    pip install -r tests/python/requirements.txt
    cargo build --release
    python3 docs/images/make_docking.py target/release/boresight docs/images/docking.png

The scenario `docking` at 400, 20, 5 and 1.5 m: two fields as one frame, and over it what the pipeline recognised in the
second one, from its features.parquet.
"""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import pyarrow.parquet as parquet
from PIL import Image, ImageDraw, ImageFont

# The last of the fields that are run; the pipeline starts this many before it.
FIELDS, LEAD = [1667, 16773, 21195, 24665], 40
COLOURS = {
    "cross": (255, 176, 64),
    "circle": (96, 200, 255),
    "station": (150, 230, 120),
    "docking_unit": (225, 130, 225),
    "used": (96, 200, 255),
    "rejected": (255, 80, 80),
}


def run(boresight, field, folder):
    out = Path(folder) / f"run-{field}"
    command = [boresight, "run", "docking", "--frames", f"{field - LEAD}..{field + 1}", "--save-frames", "png", "--out", out]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return out


def woven(out, field):
    """The frame of a field and the one before it."""
    with open(out / "telemetry.csv", newline="") as table:
        rows = {int(row["field"]): row for row in csv.DictReader(table)}
    frame = None
    for number in (field - 1, field):
        image = Image.open(out / rows[number]["file"])
        if frame is None:
            frame = Image.new("L", (image.width, 2 * image.height))
        first = {"even": 0, "odd": 1}[rows[number]["lines"]]
        for row in range(image.height):
            frame.paste(image.crop((0, row, image.width, row + 1)), (0, 2 * row + first))
    return frame.convert("RGB")


def ring(draw, x, y, radius, colour, width=2):
    draw.ellipse([x - radius, y - radius, x + radius, y + radius], outline=colour, width=width)


def panel(out, field, font):
    picture = woven(out, field)
    draw = ImageDraw.Draw(picture)
    for feature in parquet.read_table(out / "features.parquet").to_pylist():
        if feature["field"] != field:
            continue
        kind, x, y = feature["kind"], feature["x_px"], feature["y_px"]
        if kind == "mark" and feature["usage"] in COLOURS:
            draw.rectangle([x - 7, y - 7, x + 7, y + 7], outline=COLOURS[feature["usage"]], width=2)
        elif kind == "cross":
            draw.line([x - 14, y, x + 14, y], fill=COLOURS[kind], width=2)
            draw.line([x, y - 14, x, y + 14], fill=COLOURS[kind], width=2)
        elif kind != "mark" and feature["radius_px"]:
            ring(draw, x, y, feature["radius_px"], COLOURS[kind])
    truth = next(row for row in parquet.read_table(out / "truth/fields.parquet", columns=["field", "d3_m"]).to_pylist() if row["field"] == field)
    with open(out / "measurements.csv", newline="") as table:
        answer = next(row for row in csv.DictReader(table) if int(row["field"]) == field)
    d3 = answer["d3_m"] or answer["range_m"]
    said = f"{answer['status']} {float(d3):.3f} m" if d3 else answer["status"]
    text = f"true d3 {truth['d3_m']:.3f} m, {said}"
    draw.rectangle([0, 0, 18 + draw.textlength(text, font=font), 30], fill=(0, 0, 0))
    draw.text((8, 4), text, font=font, fill=(255, 255, 255))
    return picture


def main(boresight, path):
    font = ImageFont.load_default(20)
    with tempfile.TemporaryDirectory() as folder:
        panels = [panel(run(boresight, field, folder), field, font) for field in FIELDS]
    columns, rows = panels[0].size
    sheet = Image.new("RGB", (2 * columns + 6, 2 * rows + 6), (24, 24, 28))
    for number, picture in enumerate(panels):
        sheet.paste(picture, ((number % 2) * (columns + 6), (number // 2) * (rows + 6)))
    sheet = sheet.resize((1000, round(1000 * sheet.height / sheet.width)), Image.Resampling.LANCZOS)
    # Greys stay grey: a palette of our own, of 56 greys and each colour bright and half as bright.
    greys = [(grey, grey, grey) for grey in (round(255 * i / 55) for i in range(56))]
    colours = sorted(set(COLOURS.values()))
    dim = [tuple(part // 2 for part in colour) for colour in colours]
    palette = Image.new("P", (1, 1))
    palette.putpalette([part for colour in greys + colours + dim for part in colour])
    sheet.quantize(palette=palette, dither=Image.Dither.NONE).save(path, optimize=True)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
