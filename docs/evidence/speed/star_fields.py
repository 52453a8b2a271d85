#!/usr/bin/env python3
"""Cost of a frame of a star field in a study, by number of stars: table 'Star fields of a study' of
docs/evidence/speed.md.

    python3 docs/evidence/speed/star_fields.py

Star fields of the camera of `argon` with 40 regions, rendered, processed by the far-range pipeline and
scored, on one thread: processor time of cases of 2,000 frames less that of the same number of cases of 20
frames. Exit 0: done; 2: the program failed.
"""

import json
import pathlib
import resource
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
PROGRAM = ROOT / "target" / "release" / "boresight"
LIMITS = [3.0, 4.0, 5.0, 6.0, 7.0]
CASES = 4
FRAMES, FEW = 2000, 20
TURNS = 5

STUDY = """
title = "A star field"
scenario = "argon"
seed = 1
frames = "0..{frames}"

[stop]
cases = {cases}

[[vary]]
path = "sensor.read_noise_e"
distribution = {{ kind = "uniform", min = 14.9, max = 15.1 }}
"""
# Values that turn the frames of `argon` into a star field, one each.
VALUES = {
    "solar_system": "off",
    "shutter": {"mode": "fixed", "exposure_s": 0.25},
    "psf": {"kind": "gaussian", "sigma_px": 0.8},
    "background": {},
    "sensor.background_e_per_s": 40.0,
    "sensor.hot_pixels.count": 0,
    "sensor.cosmic_rays.rate_per_cm2_s": 0.0,
    "sensor.cosmic_rays.south_atlantic.peak_factor": 1.0,
}


def toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{name} = {toml(each)}" for name, each in value.items()) + " }"
    return json.dumps(value)


def processor_s(folder, limit, frames):
    """Processor time of a study, s."""
    values = VALUES | {"catalog.magnitude_limit": limit}
    sweeps = "".join(f'\n[[sweep]]\npath = "{path}"\nvalues = [{toml(value)}]\n' for path, value in values.items())
    study = folder / f"study-{limit}-{frames}.toml"
    study.write_text(STUDY.format(frames=frames, cases=CASES) + sweeps)
    with tempfile.TemporaryDirectory(dir=folder) as out:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        command = [PROGRAM, "study", "run", study, "--out", out, "--jobs", "1", "--no-report"]
        done = subprocess.run(command, stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(2)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    built = subprocess.run(["cargo", "build", "--release", "--bin", "boresight"], cwd=ROOT)
    if built.returncode != 0:
        sys.exit(2)
    print("| stars to V | ms a frame | frames a second |\n| --- | ---: | ---: |")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for limit in LIMITS:
            times = [processor_s(folder, limit, FRAMES) - processor_s(folder, limit, FEW) for _ in range(TURNS)]
            each_s = min(times) / (CASES * (FRAMES - FEW))
            print(f"| {limit} | {1e3 * each_s:.3f} | {1 / each_s:,.0f} |", flush=True)


if __name__ == "__main__":
    main()
