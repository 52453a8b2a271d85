#!/usr/bin/env python3
"""Twins of random cameras: an external check of docs/evidence/twin.md.

    twin.py PROGRAM [--cameras 20] [--seed 1] [--keep DIR]

Draws random cameras (field 6 to 40 degrees, distortion, noise of pixels, rows and columns, hot pixels, Gaussian
or Moffat profile), renders 3 to 6 frames of each by `boresight sky`, and compares (`boresight compare`) with

    itself    a scenario with the same camera, at the fitted pointings, with other noise
    twin      the scenario of `boresight twin`
    planted   scenarios of the same camera with one thing changed: stars 5 % wider, gain 3 % higher, 20 % more
              hot pixels, a focal length 0.1 % longer, row noise of a tenth of the noise of a pixel

Printed: the share of the figures that are indistinguishable, and of the planted changes that are named by the
figure that shows them, among those above the size that the comparison states as visible. Exit status 0 when 93 to
97 % of the figures of `itself` are indistinguishable, and 95 % of the visible changes are named. numpy alone.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

ITSELF = (0.93, 0.97)
NAMED = 0.95
# Each planted change with the figure that shows it.
FIGURES = {"width": "star_width", "gain": "star_flux", "hot": "hot_pixels", "scale": "focal_length", "rows": "row_noise"}


class Camera:
    """A random camera, in the terms of a camera file."""

    def __init__(self, random, **changes):
        self.columns, self.rows = int(random.integers(640, 1200)), int(random.integers(480, 900))
        self.field = float(np.exp(random.uniform(np.log(6), np.log(40))))
        self.focal_px = self.columns / 2 / np.tan(np.radians(self.field) / 2)
        half = np.hypot(self.columns, self.rows) / 2
        self.principal = [self.columns / 2 + random.normal(0, 8), self.rows / 2 + random.normal(0, 8)]
        self.k1 = random.normal(0, 0.01) / half**2
        self.bits = int(random.choice([8, 12, 14]))
        full = 2**self.bits
        self.gain = 20000 / full
        self.bias = 0.04 * full + random.uniform(0, 5)
        self.noise_dn = random.uniform(0.8, 2.0) * full / 256 if self.bits == 8 else random.uniform(3, 12)
        self.column_dn = 0.15 * self.noise_dn * int(random.integers(2))
        self.row_dn = 0.0
        self.hot = int(random.integers(300, 900))
        self.sigma = random.uniform(0.6, 1.2)
        self.beta = float(random.choice([0, 3.0]))
        # A star of the limiting magnitude of this field is ten times as bright as the noise of its pixels.
        limit = float(np.clip(8.5 - 2.5 * np.log10(self.field / 12), 6, 9.5))
        self.zero = 10 * self.noise_dn * self.gain * 4 * self.sigma * 10 ** (0.4 * limit)
        self.colour = random.normal(0, 0.2)

    def changed(self, kind):
        """The camera with one thing changed."""
        import copy

        other = copy.copy(self)
        if kind == "width":
            other.sigma = 1.05 * self.sigma
        elif kind == "gain":
            other.gain = 1.03 * self.gain
        elif kind == "hot":
            other.hot = int(1.2 * self.hot)
        elif kind == "scale":
            other.focal_px = 1.001 * self.focal_px
        elif kind == "rows":
            other.row_dn = 0.1 * self.noise_dn
        return other

    def text(self, base):
        """The tables of a camera file. Values in electrons are those of `base`, of which this is a change."""
        psf = f'kind = "gaussian"\nsigma_px = {self.sigma}'
        if self.beta:
            psf = f'kind = "moffat"\nfwhm_px = {2.2 * self.sigma}\nbeta = {self.beta}'
        # Bits between 8 and 16 are those of the file: 16.
        return f"""[camera]
columns = {self.columns}
rows = {self.rows}
focal_length_mm = {self.focal_px * 5e-3}
pixel_width_um = 5.0
pixel_height_um = 5.0
principal_x_px = {self.principal[0]}
principal_y_px = {self.principal[1]}
radial = [{self.k1}, 0.0, 0.0]
tangential = [0.0, 0.0]

[sensor]
bit_depth = {self.bits}
gain_e_per_dn = {self.gain}
bias_dn = {self.bias}
full_well_e = 1e6
read_noise_e = {self.noise_dn * base.gain}
dark_current_e_per_s = 0.0
background_e_per_s = 0.0
line_noise = {{ row_e = {self.row_dn * base.gain}, column_e = {self.column_dn * base.gain} }}

[sensor.hot_pixels]
count = {self.hot}
seed = 5
median_e_per_s = {15 * self.noise_dn * base.gain}
spread = 0.0
law = {{ kind = "pareto", index = 1.5 }}

[psf]
{psf}

[radiometry]
kind = "zero_point"
zero_point_e_per_s = {self.zero}
colour_term = {self.colour}
"""


def run(words, allowed=(0, 1)):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode not in allowed:
        raise RuntimeError(f"{' '.join(map(str, words))}: {done.stderr or done.stdout}")
    return done


def twin_with(text, camera_text):
    """The scenario of a twin with other tables of the camera."""
    tables = "camera|sensor|sensor\\.hot_pixels|psf|optics|radiometry"
    kept = re.sub(rf"(?ms)^\[({tables})\].*?(?=^\[(?!sensor\.)|\Z)", "", text)
    # `boresight sky` draws the zodiacal light.
    return kept + '\n[background]\nzodiacal = "on"\n\n' + camera_text


def compared(program, frames, scenario):
    done = run([program, "compare", frames, scenario, "--json"])
    document = json.loads(done.stdout)
    if "figures" not in document:
        raise RuntimeError(document)
    return {figure["code"]: figure for figure in document["figures"]}


def trial(program, camera, random, folder, kinds):
    """Comparisons of one camera, by kind."""
    frames = folder / "frames"
    frames.mkdir()
    (folder / "camera.toml").write_text(camera.text(camera))
    for number in range(int(random.integers(3, 7))):
        ra, dec, roll = random.uniform(0, 360), np.degrees(np.arcsin(random.uniform(-1, 1))), random.uniform(-180, 180)
        run([program, "sky", "--ra", ra, f"--dec={dec}", f"--roll={roll}", "--camera", folder / "camera.toml", "--raw",
             "--seed", 1000 + number, "-o", frames / f"{number}.png"], allowed=(0,))  # fmt: skip
    guess = camera.field * random.uniform(0.95, 1.05)
    run([program, "twin", frames, "--field-deg", guess, "-o", folder / "twin.toml"], allowed=(0,))
    text = (folder / "twin.toml").read_text()
    results = {"twin": compared(program, frames, folder / "twin.toml")}
    for kind in kinds:
        other = camera.changed(kind)
        # The hot pixels are those of another detector of the same kind.
        tables = other.text(camera).replace("seed = 5", "seed = 6")
        (folder / f"{kind}.toml").write_text(twin_with(text, tables))
        results[kind] = compared(program, frames, folder / f"{kind}.toml")
    return results


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--cameras", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path)
    arguments = parser.parse_args()
    program = arguments.program.absolute()
    random = np.random.default_rng(arguments.seed)
    counts = {"itself": [0, 0], "twin": [0, 0]}
    different = {"itself": {}, "twin": {}}
    named, visible, seen = {}, {}, {}
    for number in range(arguments.cameras):
        camera = Camera(random)
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            if arguments.keep:
                folder = arguments.keep / str(number)
                folder.mkdir(parents=True)
            try:
                results = trial(program, camera, random, folder, ["itself", *FIGURES])
            except RuntimeError as error:
                print(f"{number}: {error}", flush=True)
                continue
        for kind in counts:
            for code, figure in results[kind].items():
                is_alike = abs(figure["difference"]) <= figure["limit"]
                counts[kind][0] += is_alike
                counts[kind][1] += 1
                if not is_alike:
                    different[kind].setdefault(code, []).append(round(figure["difference"] / figure["limit"], 2))
        for kind, code in FIGURES.items():
            figure, null = results[kind].get(code), results["itself"].get(code)
            if figure is None or null is None:
                continue
            size = {"width": 5, "gain": 3, "scale": 0.1, "hot": 0.2 * (null["twin"] or 0),
                    "rows": (0.1 * camera.noise_dn) ** 2}[kind]  # fmt: skip
            is_named = abs(figure["difference"]) > figure["limit"]
            seen[kind] = seen.get(kind, 0) + is_named
            if size >= figure["visible"]:
                visible[kind] = visible.get(kind, 0) + 1
                named[kind] = named.get(kind, 0) + is_named
        print(f"{number}: {camera.columns} x {camera.rows}, {camera.field:.1f} deg, {camera.bits} bits: itself "
              f"{sum(abs(f['difference']) <= f['limit'] for f in results['itself'].values())}/"
              f"{len(results['itself'])}, twin "
              f"{sum(abs(f['difference']) <= f['limit'] for f in results['twin'].values())}/"
              f"{len(results['twin'])}", flush=True)  # fmt: skip
    shares = {kind: alike / max(of, 1) for kind, (alike, of) in counts.items()}
    for kind, (alike, of) in counts.items():
        print(f"{kind}: {alike} of {of} figures indistinguishable, {100 * shares[kind]:.1f} %; others {different[kind]}")
    for kind in FIGURES:
        print(f"{kind}: named {named.get(kind, 0)} of {visible.get(kind, 0)} visible, {seen.get(kind, 0)} of all")
    all_visible = sum(visible.values())
    share = sum(named.values()) / max(all_visible, 1)
    print(f"planted: {sum(named.values())} of {all_visible} visible changes named, {100 * share:.1f} %")
    is_right = ITSELF[0] <= shares["itself"] <= ITSELF[1] and share >= NAMED
    sys.exit(0 if is_right else 1)


if __name__ == "__main__":
    main()
