"""Makes spectra.bin: spectra of stars along the colour sequence, and of the Sun, for magnitudes in electrons.

Sources: Pickles (1998, PASP 110, 863; CDS J/PASP/110/863), the UVKLIB spectra as the Space Telescope Science
Institute distributes them (pickles_uk_N.fits), and the extraterrestrial column of ASTM G173-03 (Gueymard
2004), 1 au.

    python3 make_spectra.py PICKLES_FOLDER ASTMG173.csv spectra.bin

Layout: little-endian f64, no header. One record a star of SEQUENCE: B-V, V-I (synthetic, mag), then BINS
means of the spectral irradiance of a star of V = 0; and a last record of BINS alone, the Sun at 1 au. W m^-2
nm^-1; bins of BIN_NM from START_NM on. sim/optics/src/radiometry/spectra.rs holds the same constants.

V, B-V and V-I are those of Bessell (1990, PASP 102, 1181), Table 2, as energy weights: magnitude 0 is the
mean irradiance of Bessell, Castelli & Plez (1998, A&A 333, 231), Table A2. Dwarfs to G8, giants beyond: among
the stars that a star tracker sees, the red ones are giants. B-V grows from record to record up to K4III, V-I
up to the end.
"""

import pathlib
import sys

import numpy as np
from astropy.io import fits

START_NM, BIN_NM, BINS = 300.0, 5.0, 160
BLUE = 27  # records whose B-V grows: to K4III
SEQUENCE = (  # type, number of its file
    ("O5V", 1), ("B0V", 3), ("B1V", 4), ("B3V", 5), ("B5-7V", 6), ("B8V", 7), ("B9V", 8), ("A0V", 9), ("A2V", 10),
    ("A3V", 11), ("A5V", 12), ("A7V", 13), ("F0V", 14), ("F2V", 15), ("F5V", 16), ("F8V", 20), ("G0V", 23), ("G2V", 26),
    ("G5V", 27), ("G8V", 30), ("G5III", 73), ("G8III", 76), ("K0III", 78), ("K1III", 81), ("K2III", 84), ("K3III", 87),
    ("K4III", 90), ("K5III", 93), ("M0III", 95), ("M1III", 96), ("M2III", 97), ("M3III", 98), ("M4III", 99),
    ("M5III", 100), ("M6III", 101), ("M7III", 102),
)  # fmt: skip

# Bessell (1990), Table 2: first wavelength and step, nm, and the response.
PASSBANDS = {
    "B": (360, 10, [0, .030, .134, .567, .920, .978, 1, .978, .935, .853, .740, .640, .536, .424, .325, .235, .150, .095,
                    .043, .009, 0]),
    "V": (470, 10, [0, .030, .163, .458, .780, .967, 1, .973, .898, .792, .684, .574, .461, .359, .270, .197, .135, .081,
                    .045, .025, .017, .013, .009, 0]),
    "I": (700, 10, [0, .024, .232, .555, .785, .910, .965, .985, .990, .995, 1, 1, .990, .980, .950, .910, .860, .750,
                    .560, .330, .150, .030, 0]),
}  # fmt: skip
ZERO_W_M2_NM = {"B": 632.0e-13, "V": 363.1e-13, "I": 112.6e-13}


def irradiance(band, wavelength_nm, spectrum):
    first, step, response = PASSBANDS[band]
    nodes = first + step * np.arange(len(response))
    grid = np.arange(nodes[0], nodes[-1] + 0.01, 0.25)
    weight = np.interp(grid, nodes, response)
    return np.trapezoid(np.interp(grid, wavelength_nm, spectrum) * weight, grid) / np.trapezoid(weight, grid)


def magnitude(band, wavelength_nm, spectrum):
    return -2.5 * np.log10(irradiance(band, wavelength_nm, spectrum) / ZERO_W_M2_NM[band])


def bin_means(wavelength_nm, spectrum):
    """Means over the bins, the spectrum being linear between its samples."""
    edges = START_NM + BIN_NM * np.arange(BINS + 1)
    integral = np.concatenate([[0.0], np.cumsum(np.diff(wavelength_nm) * (spectrum[1:] + spectrum[:-1]) / 2)])

    def integral_to(x):
        i = np.clip(np.searchsorted(wavelength_nm, x) - 1, 0, len(wavelength_nm) - 2)
        there = np.interp(x, wavelength_nm, spectrum)
        return integral[i] + (x - wavelength_nm[i]) * (spectrum[i] + there) / 2

    return np.diff(integral_to(edges)) / BIN_NM


def main():
    pickles, sun_file, output = map(pathlib.Path, sys.argv[1:])
    records = []
    last_b_v = last_v_i = -1.0
    for name, number in SEQUENCE:
        table = fits.getdata(pickles / f"pickles_uk_{number}.fits")
        wavelength = table["WAVELENGTH"].astype(float) / 10.0
        spectrum = table["FLUX"].astype(float)
        v = magnitude("V", wavelength, spectrum)
        b_v, v_i = magnitude("B", wavelength, spectrum) - v, v - magnitude("I", wavelength, spectrum)
        assert v_i > last_v_i and (b_v > last_b_v or len(records) >= BLUE), name
        last_b_v, last_v_i = b_v, v_i
        print(f"{name:6} B-V {b_v:+.3f}  V-I {v_i:+.3f}")
        means = bin_means(wavelength, spectrum) * 10.0 ** (0.4 * v)
        records.append(np.concatenate([[b_v, v_i], means]))
    sun = np.loadtxt(sun_file, delimiter=",", skiprows=2)
    print(f"Sun at 1 au: V {magnitude('V', sun[:, 0], sun[:, 1]):.4f}")
    records.append(bin_means(sun[:, 0], sun[:, 1]))
    output.write_bytes(np.concatenate(records).astype("<f8").tobytes())


if __name__ == "__main__":
    main()
