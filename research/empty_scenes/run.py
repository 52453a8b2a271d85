#!/usr/bin/env python3
"""Scenes without a visible target, and scenes with a faint one, for the best mode.

    research/empty_scenes/run.py --boresight target/release/boresight --out DIR [--set tuned|withheld|faint|all]

Each cell is a built-in scenario with a few changed lines. In the sets `tuned` and `withheld` the target is a
beacon of V = 20 at 1 km, which no camera here detects; the constants of the tracks were chosen on `tuned`
only. In the set `faint` the target is near the detection limit. Prints frames, correct and wrong ones of each
cell; docs/evidence/best-mode.md has the table. Needs Python's standard library.
"""

import argparse
import json
import pathlib
import re
import shutil
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
BASES = {
    "start": "scenarios/starting-point.toml",
    "cmos": "scenarios/comparison/cmos.toml",
    "inertial": "scenarios/comparison/inertial.toml",
    "irradiated": "scenarios/comparison/irradiated.toml",
    "narrow": "scenarios/comparison/narrow.toml",
    "argon": "scenarios/gates/argon.toml",
}
EMPTY = 'kind = "beacon"\nmagnitude_at_1_km = 20.0\n'


def beacon(magnitude):
    return f'kind = "beacon"\nmagnitude_at_1_km = {magnitude}\n'


def sphere(radius_m):
    return f'kind = "lambert_sphere"\nradius_m = {radius_m}\nalbedo = 0.3\n'


# Name, base, seed, content of [target], substitutions (pattern, replacement).
TUNED = [
    ("starting point", "start", 1, EMPTY, []),
    ("starting point, every drawn star listed", "start", 1, EMPTY, [(r"magnitude_limit = 6\.5", "magnitude_limit = 8.0")]),
    ("starting point, inertial pointing", "start", 2, EMPTY, [(r'mode = "local_orbital"', 'mode = "target_pointing"')]),
    ("narrow camera", "narrow", 1, EMPTY, []),
    ("ARGON", "argon", 1, EMPTY, []),
]
WITHHELD = [
    ("starting point, other seed", "start", 77, EMPTY, []),
    ("CMOS", "cmos", 78, EMPTY, []),
    ("pointing held", "inertial", 79, EMPTY, []),
    ("irradiated, regions", "irradiated", 80, EMPTY, []),
    ("1000 hot pixels", "start", 81, EMPTY, [(r"(?m)^count = 10$", "count = 1000")]),
    ("list to V = 5, stars to V = 9", "start", 82, EMPTY,
     [(r"magnitude_limit = 6\.5", "magnitude_limit = 5.0"), (r"magnitude_limit = 8\.0", "magnitude_limit = 9.0")]),
    ("cosmic rays, 20 /cm² s", "start", 83, EMPTY,
     [(r"(?m)^\[shutter\]", "[sensor.cosmic_rays]\nrate_per_cm2_s = 20.0\nthickness_um = 15.0\nreadout_s = 0.1\n\n[shutter]")]),
    ("Moon and planets", "start", 84, EMPTY, [(r"# solar_system", "solar_system")]),
    ("every minute", "start", 85, EMPTY, [(r"cadence_s = 15\.0", "cadence_s = 60.0")]),
    ("every second", "start", 86, EMPTY, [(r"cadence_s = 15\.0", "cadence_s = 1.0")]),
    ("telemetry off by 100 arcsec", "start", 87, EMPTY,
     [(r"noise_arcsec = \[20\.0, 20\.0, 20\.0\]", "noise_arcsec = [100.0, 100.0, 100.0]")]),
    ("defocused", "start", 88, EMPTY, [(r'kind = "gaussian" # or.*\nsigma_px = 0\.8', 'kind = "defocus"\nradius_px = 2.5\nsigma_px = 0.5')]),
    ("sharp", "start", 89, EMPTY, [(r"sigma_px = 0\.8", "sigma_px = 0.45")]),
    ("narrow camera, other seed", "narrow", 90, EMPTY, []),
]
FAINT = [
    *[(f"starting point, V = {v} at 1 km", "start", 5, beacon(v), []) for v in (1.0, 1.5, 2.0, 2.5)],
    *[(f"narrow camera, radius {r} m", "narrow", 1, sphere(r), []) for r in (0.03, 0.02, 0.016, 0.013)],
    ("narrow camera, radius 0.02 m, seed 23", "narrow", 23, sphere(0.02), []),
    ("CMOS, V = 4 at 1 km", "cmos", 1, beacon(4.0), []),
]
SETS = {"tuned": TUNED, "withheld": WITHHELD, "faint": FAINT}


def scenario(base, seed, target, substitutions):
    """The text of a cell's scenario; every substitution must apply."""
    text = (ROOT / BASES[base]).read_text()
    text, changed = re.subn(r"(?m)^seed = \d+", f"seed = {seed}", text, count=1)
    assert changed == 1
    text, changed = re.subn(r"(?ms)^\[target\]\n.*?(?=^\[(?!\[target))", f"[target]\n{target}\n", text, count=1)
    assert changed == 1
    for pattern, replacement in substitutions:
        text, changed = re.subn(pattern, replacement, text)
        assert changed >= 1, pattern
    return text


def cell(program, directory, base, seed, target, substitutions):
    """Frames, and how many of them are correct and wrong."""
    directory.mkdir(parents=True, exist_ok=True)
    file = directory / "scenario.toml"
    file.write_text(scenario(base, seed, target, substitutions).replace('mode = "paper"', 'mode = "best"'))
    run = directory / "run"
    shutil.rmtree(run, ignore_errors=True)
    subprocess.run([program, "run", file, "--out", run], check=True, stdout=subprocess.DEVNULL)
    figures = json.loads((run / "score.json").read_text())["figures"]
    return [figures["hit_rate"]["of"], figures["correct_rate"]["count"], figures["wrong_rate"]["count"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--boresight", type=pathlib.Path, default=ROOT / "target/release/boresight")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--set", choices=[*SETS, "all"], default="all")
    parser.add_argument("--seeds", type=int, default=0, help="number added to every seed")
    options = parser.parse_args()
    for name in SETS if options.set == "all" else [options.set]:
        for i, (title, base, seed, target, substitutions) in enumerate(SETS[name]):
            directory = options.out / f"{name}-{i}"
            frames, correct, wrong = cell(
                options.boresight.resolve(), directory, base, seed + options.seeds, target, substitutions
            )
            print(f"{name:9} {title:45} {frames:6} frames {correct:6} correct {wrong:6} wrong", flush=True)


if __name__ == "__main__":
    main()
