#!/usr/bin/env python3
"""Writes the scenarios of the project's gates from the built-in ones; they differ only in the times of
images.

    python3 scenarios/gates/make.py

`argon.toml`: thirty stretches of thirty images, six on each day, instead of 16,077 images. A stretch is a
block: the next one is hours away. They begin at positions of the golden ratio within equal parts of the day,
so that they sample all phases of every period of the orbit or of a drift.

`docking.toml`: from 30 m to contact in half a minute instead of from 500 m in eight minutes.

`empty.toml`: the starting point with a target of V = 20 at 1 km, which is never visible, in twelve stretches
of thirty images over the orbit.
"""

from datetime import datetime, timedelta
from pathlib import Path
import re

HERE = Path(__file__).parent
STRETCHES, IMAGES, GOLDEN = 6, 30, 0.6180339887498949

HEADER = "# Written by make.py from ../{name}.toml; {what}\n# Comments are there.\n"

SEGMENTS = [("to_d3_m = 12.0", 2.0), ("to_d3_m = 5.0", 1.0), ("to_d3_m = 2.0", 0.4), (None, 0.3)]


def without_comments(text):
    lines = [re.sub(r"\s+#.*$", "", line).rstrip() for line in text.splitlines() if not line.startswith("#")]
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines)).strip() + "\n"


def retitled(text, title):
    return re.sub(r'^title = ".*"$', f'title = "{title}"', text, count=1, flags=re.M)


def argon():
    text = without_comments((HERE / "../argon.toml").read_text())
    pattern = r'\[\[schedule\]\]\nname = "([^"]*)"\nstart_utc = "([^"]*)"\ncadence_s = ([0-9.]+)\ncount = ([0-9]+)\n'
    stretches = []
    for name, start, cadence, count in re.findall(pattern, text):
        start, cadence = datetime.fromisoformat(start.replace("Z", "+00:00")), float(cadence)
        part = int(count) // STRETCHES
        for i in range(STRETCHES):
            first = i * part + int((len(stretches) * GOLDEN) % 1.0 * (part - IMAGES))
            at = (start + timedelta(seconds=first * cadence)).strftime("%Y-%m-%dT%H:%M:%SZ")
            stretches.append(
                f'[[schedule]]\nname = "{name}, {i + 1}"\nstart_utc = "{at}"\ncadence_s = {cadence}\ncount = {IMAGES}\n'
            )
    text = re.sub(pattern, "", text).rstrip() + "\n\n" + "\n".join(stretches)
    return retitled(re.sub(r"\n{3,}", "\n\n", text), "ARGON for a gate: thirty stretches of thirty images over its five days")


def docking():
    text = without_comments((HERE / "../docking.toml").read_text())
    text = re.sub(r"start_d3_m = .*", "start_d3_m = 30.0", text)
    text = re.sub(r"lateral_at_start_m = .*", "lateral_at_start_m = [0.3, -0.15]", text)
    begin, end = text.index("[[approach.segments]]"), text.index("[[cameras]]")
    segments = [
        "[[approach.segments]]\nkind = \"glide\"\n" + (f"{to}\n" if to else "") + f"speed_m_s = {speed}\n"
        for to, speed in SEGMENTS
    ]
    text = text[:begin] + "\n".join(segments) + "\n" + text[end:]
    return retitled(text, "Docking for a gate: from 30 m to contact in half a minute")


def empty():
    text = without_comments((HERE / "../starting-point.toml").read_text())
    text = re.sub(
        r"(?s)\[target\]\n.*?\n\n", '[target]\nkind = "beacon"\nmagnitude_at_1_km = 20.0\n\n', text, count=1
    )
    begin = datetime.fromisoformat("2012-04-25T00:10:00+00:00")
    stretches = [
        f'[[schedule]]\nname = "stretch {i + 1}"\nstart_utc = "{begin + timedelta(minutes=9 * i):%Y-%m-%dT%H:%M:%SZ}"\n'
        f"cadence_s = 15.0\ncount = {IMAGES}\n"
        for i in range(12)
    ]
    text = text[: text.index("[[schedule]]")].rstrip() + "\n\n" + "\n".join(stretches)
    return retitled(text, "No target for a gate: twelve stretches of thirty images of stars")


for name, source, make, what in [
    ("argon", "argon", argon, "they differ in title and schedule alone."),
    ("docking", "docking", docking, "they differ in title and in the approach alone."),
    ("empty", "starting-point", empty, "they differ in title, target and schedule alone."),
]:
    (HERE / f"{name}.toml").write_text(HEADER.format(name=source, what=what) + make())
