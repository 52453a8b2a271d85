#!/usr/bin/env python3
"""Sensors measured from stacks of frames made by Pyxel: an external check of docs/evidence/camera-sensor.md.

    sensor_stacks.py PROGRAM [--sensors 10] [--seed 1]

Pyxel (ESA) makes bias, dark and flat frames of random sensors: photons with shot noise, quantum efficiency per
pixel (PRNU, dead pixels), dark current, full well, curved response, noise of the output node, converter of 8 to 16
bits. Its dark-current and fixed-pattern models draw a new pattern in every frame, so the pattern of the dark
current (DSNU), hot pixels, offsets of columns and noise of rows are added by numpy between its steps. Each sensor is
measured by `boresight camera sensor`, and its figures are compared with those that the frames were made with.

Printed: a line per sensor with errors in sigma, and over all the share of figures within 2 % or 3 sigma and the NEES
per dimension. Exit status 0 when gain, read noise, dark current, PRNU and full well of every sensor that the program
determines are within 2 % or 3 sigma, the NEES per dimension is within 0.8 to 1.25, no limit is below the truth, and
at least four of the five figures that the frames show are determined. Needs sensor_requirements.txt.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import warnings

import numpy as np
from PIL import Image
from pyxel.detectors import CCD, CCDGeometry, Characteristics, Environment
from pyxel.detectors.characteristics import ChargeToVoltSettings
from pyxel.models.charge_collection import simple_collection, simple_full_well
from pyxel.models.charge_generation import conversion_with_qe_map
from pyxel.models.charge_measurement import dc_offset, output_node_linearity_poly, output_node_noise, simple_measurement
from pyxel.models.photon_collection import illumination, shot_noise
from pyxel.models.readout_electronics import simple_adc, simple_amplifier

NEES, SHARE, SIGMAS = (0.8, 1.25), 0.02, 3.0
WANTED = ("gain_e_per_dn", "read_noise_e", "dark_current_e_per_s", "prnu_fraction", "full_well_e")
ALSO = ("bias_dn", "non_linearity", "dark_current_spread_e_per_s", "column_offset_e", "row_noise_e")
CHARGE_TO_VOLT, VOLTS = 1e-6, 2.0


class Sensor:
    """A random sensor, with the figures that its frames should show."""

    def __init__(self, random, folder):
        self.random = random
        self.rows, self.columns = int(random.integers(240, 400)), int(random.integers(240, 400))
        self.bits = int(random.choice([8, 10, 12, 14, 16]))
        self.gain = float(np.exp(random.uniform(np.log(0.2), np.log(30))))
        self.read_noise = float(np.exp(random.uniform(np.log(1), np.log(30))))
        # A converter whose range is below 300 electrons is no camera's.
        while self.gain * 2**self.bits < 20 * self.read_noise or self.gain * 2**self.bits < 300:
            self.gain *= 1.5
        top = 2**self.bits - 1
        # A bias of eight times the noise, at a random fraction of a digital number.
        self.bias = 8 * self.read_noise / self.gain + random.uniform(1, 3)
        end = (top - self.bias) * self.gain
        self.well_first = bool(random.random() < 0.5)
        self.full_well = end * (random.uniform(0.5, 0.9) if self.well_first else random.uniform(1.1, 2))
        self.dark = float(random.choice([0.0, random.uniform(0.1, 5), random.uniform(5, 100)]))
        self.dark_spread = float(self.dark * random.uniform(0, 0.4))
        self.prnu = float(random.choice([0.0, random.uniform(0.002, 0.03)]))
        self.curvature = float(random.choice([0.0, random.uniform(0, 0.06)]))
        self.column_offset = float(random.choice([0.0, self.read_noise * random.uniform(0.2, 1)]))
        self.row_noise = float(random.choice([0.0, self.read_noise * random.uniform(0.1, 0.5)]))
        self.hot = int(random.choice([0, random.integers(5, 200)]))
        self.dead = int(random.choice([0, random.integers(1, 40)]))
        self.frames = int(random.choice([2, 2, 3, 5]))
        shape = (self.rows, self.columns)
        places = random.permutation(self.rows * self.columns)
        self.response = 1 + self.prnu * random.normal(size=shape)
        self.response.flat[places[: self.dead]] = 0
        # A log-normal dark current, as silicon has it.
        width = np.sqrt(np.log1p((self.dark_spread / self.dark) ** 2)) if self.dark else 0.0
        self.darks = self.dark * np.exp(width * random.normal(size=shape) - width**2 / 2)
        hot = places[self.dead : self.dead + self.hot]
        self.darks.flat[hot] += (20 + 10 * self.dark + 20 * self.read_noise) * np.exp(random.normal(size=self.hot))
        self.darks.flat[places[: self.dead]] = 0
        self.columns_e = self.column_offset * random.normal(size=self.columns)
        self.qe = folder / "qe.npy"
        np.save(self.qe, np.clip(0.5 * self.response, 0, 1))
        # The converter of Pyxel truncates: half a digital number below the rounded one.
        self.offset_v = (self.bias + 0.5) * self.gain * CHARGE_TO_VOLT
        self.detector = CCD(
            geometry=CCDGeometry(row=self.rows, col=self.columns),
            environment=Environment(),
            characteristics=Characteristics(
                quantum_efficiency=0.5,
                charge_to_volt=ChargeToVoltSettings(CHARGE_TO_VOLT),
                pre_amplification=VOLTS / (top * self.gain * CHARGE_TO_VOLT),
                full_well_capacity=min(self.full_well, 1e7),
                adc_bit_resolution=self.bits,
                adc_voltage_range=(0.0, VOLTS),
            ),
        )

    def truth(self, end_e):
        """Figures in the terms of the program; the curvature is that at the end which the program states."""
        return {
            "gain_e_per_dn": self.gain,
            "read_noise_e": self.read_noise,
            "dark_current_e_per_s": self.dark,
            "prnu_fraction": self.prnu,
            "full_well_e": self.full_well if self.well_first else None,
            "bias_dn": self.bias + float(self.columns_e.mean()) / self.gain,
            "non_linearity": self.curvature * end_e / self.full_well if end_e else None,
            "dark_current_spread_e_per_s": self.dark_spread,
            "column_offset_e": self.column_offset,
            "row_noise_e": self.row_noise,
        }

    def frame(self, time_s, electrons_per_s):
        """A frame with a mean of photoelectrons, step by step of the pipeline."""
        detector = self.detector
        detector.empty()
        detector.set_readout(times=[max(time_s, 1e-6)], start_time=0.0)
        detector.time = detector.time_step = max(time_s, 1e-6)
        illumination(detector, level=2 * electrons_per_s)
        shot_noise(detector)
        conversion_with_qe_map(detector, filename=self.qe)
        detector.charge.add_charge_array(np.random.poisson(self.darks * time_s).astype(float))
        simple_collection(detector)
        simple_full_well(detector)
        simple_measurement(detector)
        volt_well = self.full_well * CHARGE_TO_VOLT
        output_node_linearity_poly(detector, coefficients=[0.0, 1.0, -self.curvature / volt_well])
        output_node_noise(detector, std_deviation=self.read_noise * CHARGE_TO_VOLT)
        lines = self.columns_e + self.row_noise * np.random.normal(size=(self.rows, 1))
        detector.signal.array = detector.signal.array + lines * CHARGE_TO_VOLT
        dc_offset(detector, offset=min(self.offset_v, VOLTS))
        simple_amplifier(detector)
        simple_adc(detector)
        return np.asarray(detector.image.array).astype(np.uint8 if self.bits == 8 else np.uint16)

    def write(self, folder, time_s, electrons_per_s, frames):
        folder.mkdir(parents=True)
        for number in range(frames):
            Image.fromarray(self.frame(time_s, electrons_per_s)).save(folder / f"{number}.png")

    def write_stacks(self, folder):
        self.write(folder / "bias", 0.0, 0.0, max(self.frames, 3))
        # Two dark exposures up to some hundred electrons, at most a fifth of the range.
        range_e = min(self.full_well, (2**self.bits - 1 - self.bias) * self.gain)
        longest = min(60.0, 0.2 * range_e / max(self.dark, 0.1))
        for time_s in (longest / 4, longest):
            self.write(folder / "dark" / f"{time_s:.6f}s", float(f"{time_s:.6f}"), 0.0, self.frames)
        levels = int(self.random.choice([5, 8, 12]))
        end_s = float(np.exp(self.random.uniform(np.log(0.2), np.log(3))))
        saturates = self.random.random() < 0.8
        light = range_e * (1.25 if saturates else 0.85) / end_s
        for time_s in np.linspace(end_s / levels, end_s, levels):
            self.write(folder / "flat" / f"{time_s:.6f}s", float(f"{time_s:.6f}"), light, self.frames)
        return levels, saturates


def measured(program, folder):
    done = subprocess.run(
        [program, "--json", "camera", "sensor", "--bias", folder / "bias", "--dark", folder / "dark", "--flat", folder / "flat"],
        capture_output=True, text=True,
    )
    if done.returncode == 2:
        raise SystemExit(f"{folder}: {done.stdout}{done.stderr}")
    return json.loads(done.stdout)


def compare(name, truth, found):
    """The words of a figure, its error in sigma if it has one, and true if it is as wanted."""
    if "missing" in found:
        return "-", None, True
    if "below" in found:
        # A limit is two standard deviations above the value: as wanted if the truth is below three.
        return f"<{found['below']:.3g}", None, truth is None or truth <= 1.5 * found["below"]
    if truth is None:
        return f"({found['value']:.3g})", None, False
    error = (found["value"] - truth) / found["sigma"]
    close = abs(found["value"] - truth) <= SHARE * abs(truth)
    return f"{error:+.1f}", error, close or abs(error) <= SIGMAS


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--sensors", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path, help="a folder in which the frames stay")
    arguments = parser.parse_args()
    warnings.filterwarnings("ignore")
    errors, others, wrong, few = [], [], 0, 0
    by_name = {name: [] for name in WANTED + ALSO}
    for number in range(arguments.sensors):
        np.random.seed(1000 * arguments.seed + number)
        with tempfile.TemporaryDirectory() as folder:
            folder = arguments.keep / f"{arguments.seed}-{number}" if arguments.keep else pathlib.Path(folder)
            folder.mkdir(parents=True, exist_ok=True)
            sensor = Sensor(np.random.default_rng([arguments.seed, number]), folder)
            levels, saturates = sensor.write_stacks(folder)
            document = measured(arguments.program, folder)
        truth, found = sensor.truth(document["end_e"]), document["figures"]
        words = []
        for name in WANTED + ALSO:
            word, error, is_good = compare(name, truth[name], found[name])
            words.append(word)
            if error is not None:
                (errors if name in WANTED else others).append(error)
                by_name[name].append(error)
            if name in WANTED and not is_good:
                wrong += 1
                words[-1] += "!"
                print(f"    {name}: {found[name]}, truth {truth[name]}")
        shown = [name for name in WANTED if (truth[name] or 0) > 0 and (name != "full_well_e" or saturates)]
        few += sum("value" in found[name] for name in shown) < min(4, len(shown)) - 1
        print(
            f"{sensor.columns} x {sensor.rows}, {sensor.bits} bits, {sensor.gain:.2f} e/DN, read {sensor.read_noise:.1f} e, dark {sensor.dark:.1f} "
            f"e/s, PRNU {sensor.prnu:.2%}, curvature {sensor.curvature:.3f}, {'well' if sensor.well_first else 'converter'} first, {levels} levels"
            f"{'' if saturates else ' (none saturated)'}, {sensor.frames} frames, hot {document['defects']['hot']} of {sensor.hot}, dead "
            f"{document['defects']['dead']} of {sensor.dead}; errors in sigma {' '.join(words)}",
            flush=True,
        )
    for name in WANTED + ALSO:
        if by_name[name]:
            print(f"    {name}: NEES {np.mean(np.square(by_name[name])):.2f} over {len(by_name[name])}")
    errors, others = np.array(errors), np.array(others)
    nees = float(np.mean(errors**2))
    print(
        f"{wrong} of gain, read noise, dark current, PRNU, full well wrong; NEES per dimension {nees:.2f} over {len(errors)}, largest "
        f"{np.abs(errors).max():.1f} sigma; bias, curvature, spread of dark currents, columns, rows: NEES {np.mean(others**2):.2f} over {len(others)}"
    )
    return 0 if wrong == 0 and few == 0 and NEES[0] <= nees <= NEES[1] else 1


if __name__ == "__main__":
    sys.exit(main())
