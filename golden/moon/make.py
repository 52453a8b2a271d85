"""Makes the reference for the position of the Moon: JPL DE421 from skyfield-data 7.0.0, read with jplephem
2.24.

    pip install -r golden/moon/requirements.txt
    python3 golden/moon/make.py --reason "why"

moon_de421.csv: TDB since J2000.0 in s, and the centre of the Moon from the centre of the Earth, km, ICRS
axes, at 400 instants from 1990 to 2050, spread so that every phase of every term occurs.
"""

import pathlib
import sys

import numpy as np
import skyfield_data
from jplephem.spk import SPK

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import manifest  # noqa: E402

J2000_JD = 2451545.0


def main():
    arguments = manifest.begin()
    kernel = SPK.open(pathlib.Path(skyfield_data.get_skyfield_data_path()) / "de421.bsp")
    days = np.linspace(-3650.0, 18250.0, 400) + 0.123 * np.arange(400) % 7
    # Moon and Earth, both from their barycentre.
    moon = kernel[3, 301].compute(J2000_JD, days) - kernel[3, 399].compute(J2000_JD, days)
    path = HERE / "moon_de421.csv"
    lines = [f"{day * 86400.0:.1f},{x:.3f},{y:.3f},{z:.3f}\n" for day, (x, y, z) in zip(days, moon.T)]
    path.write_text("tdb_j2000_s,x_km,y_km,z_km\n" + "".join(lines))
    manifest.record(path, arguments.reason)


if __name__ == "__main__":
    main()
