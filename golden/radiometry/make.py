"""Makes the references for the radiometry: electrons a second of stars that the simulator's spectra were not
made from.

Tools: numpy 2.4.6, astropy 8.0.2. Data: spectra of the Bruzual-Persson-Gunn-Stryker atlas (Gunn & Stryker
1983, ApJS 52, 121) from EXOSIMS 3.6.6; Vega and the Sun of CALSPEC (Bohlin et al.), and the passband of Gaia
G (revised DR2, Evans et al. 2018, Maiz Apellaniz & Weiler 2018) from pyphot 2.1.1; B, V, I of Bessell (1990)
from astro-sedpy 0.4.1; absorption length of silicon from GalSim 2.8.5. Packages are unpacked, not run:
EXOSIMS_FOLDER is the folder `EXOSIMS` of its wheel, the others are folders of the same name where they are
installed.

    pip install -r golden/radiometry/requirements.txt
    python3 golden/radiometry/make.py EXOSIMS_FOLDER PYPHOT_FOLDER SEDPY_FOLDER GALSIM_FOLDER --reason "why"

gaia_g.csv: the passband, photoelectrons per photon entering the telescope, every 5 nm.

stars.csv: synthetic B-V and V-I (zero points of Bessell, Castelli & Plez 1998), and photoelectrons a second
and cm2 of a star of V = 0: of the simulator's plain silicon CCD (60 % entering, 0.25 um of gates, 10 um of
collecting depth), here with the absorption of GalSim's table, and of Gaia G. Integrated by the trapezoid
rule, every angstrom.
"""

import argparse
import pathlib
import sys

import numpy as np
from astropy.io import fits

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import manifest  # noqa: E402

HC_ERG_AA = 6.62607015e-27 * 2.99792458e18
ZERO = {"B": 632.0e-11, "V": 363.1e-11, "I": 112.6e-11}  # erg/(s cm2 A)
GRID_AA = np.arange(3000.0, 11000.1, 1.0)


def numbers(path, separator=None):
    """The lines of a text table that are two numbers or more."""
    rows = []
    for line in path.read_text().splitlines():
        try:
            rows.append([float(word) for word in line.split(separator)[:2]])
        except ValueError:
            continue
    return np.array([row for row in rows if len(row) == 2])


def main():
    parser = argparse.ArgumentParser()
    for name in ("exosims", "pyphot", "sedpy", "galsim"):
        parser.add_argument(name, type=pathlib.Path)
    arguments = manifest.begin(parser)

    bands = {name: numbers(arguments.sedpy / f"data/filters/bessell_{name}.par") for name in ZERO}
    gaia = numbers(arguments.pyphot / "libs/ascii_sources/gaiadr2v2_g.csv", ",")
    silicon = numbers(arguments.galsim / "share/sensors/abs_length.dat")

    def magnitude(flux, name):
        weight = np.interp(GRID_AA, bands[name][:, 0], bands[name][:, 1], left=0, right=0) * GRID_AA  # per photon there
        return -2.5 * np.log10(np.trapezoid(flux * weight, GRID_AA) / np.trapezoid(weight, GRID_AA) / ZERO[name])

    length_um = np.interp(GRID_AA / 10, silicon[:, 0], silicon[:, 1])
    ccd = 0.60 * np.exp(-0.25 / length_um) * (1 - np.exp(-10.0 / length_um))
    g = np.interp(GRID_AA / 10, gaia[:, 0], gaia[:, 1], left=0, right=0)

    files = [("vega", arguments.pyphot / "libs/alpha_lyr_stis_011.fits")]
    files += [("sun", arguments.pyphot / "libs/sun_reference_stis_001.fits")]
    for path in sorted((arguments.exosims / "TargetList/bpgs").glob("*.fits")):
        files.append((fits.getheader(path)["TARGETID"].strip().lower(), path))
    rows = []
    for name, path in files:
        table = fits.getdata(path)
        flux = np.interp(GRID_AA, table["WAVELENGTH"].astype(float), table["FLUX"].astype(float))
        v = magnitude(flux, "V")
        b_v, v_i = magnitude(flux, "B") - v, v - magnitude(flux, "I")
        photons = flux * 10 ** (0.4 * v) * GRID_AA / HC_ERG_AA
        rates = [np.trapezoid(photons * response, GRID_AA) for response in (ccd, g)]
        rows.append(f"{name},{b_v:.4f},{v_i:.4f},{rates[0]:.6e},{rates[1]:.6e}\n")
    stars = HERE / "stars.csv"
    stars.write_text("name,b_v,v_i,silicon_e_per_s_cm2,gaia_g_e_per_s_cm2\n" + "".join(rows))
    passband = HERE / "gaia_g.csv"
    nodes = np.arange(320, 1100, 5)
    passband.write_text(
        "wavelength_nm,response\n"
        + "".join(f"{nm},{value:.6f}\n" for nm, value in zip(nodes, np.interp(nodes, gaia[:, 0], gaia[:, 1])))
    )
    for path in (stars, passband):
        manifest.record(path, arguments.reason)


if __name__ == "__main__":
    main()
