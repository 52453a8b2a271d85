"""Makes the reference for the directions of the planets: JPL DE421 (skyfield-data 7.0.0), read with jplephem
2.24.

    pip install -r golden/apparent/requirements.txt
    python3 golden/planets/make.py --reason "why"

planets.csv: seconds of TDB since J2000.0, number of the planet (1 to 8, without the Earth), and its direction
(unit vector, ICRS axes) and distance (au) from the centre of the Earth: light time applied, no aberration.
Giant planets are the barycentres of their systems.
"""

import csv
import pathlib
import sys

import numpy as np
import skyfield_data
from jplephem.spk import SPK

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import manifest  # noqa: E402

AU_KM = 149597870.7
LIGHT_KM_PER_DAY = 299792.458 * 86400.0
J2000 = 2451545.0
PLANETS = [1, 2, 4, 5, 6, 7, 8]


def main():
    reason = manifest.begin().reason
    kernel = SPK.open(str(pathlib.Path(skyfield_data.get_skyfield_data_path()) / "de421.bsp"))

    rows = []
    # 1990-01-11 to 2049-12, 50 epochs, by a step that is no fraction of any period.
    for epoch in range(50):
        jd = J2000 - 3642.0 + 446.137 * epoch
        earth = kernel[0, 3].compute(jd) + kernel[3, 399].compute(jd)
        for planet in PLANETS:
            light_days = 0.0
            for _ in range(5):
                offset = kernel[0, planet].compute(jd - light_days) - earth
                light_days = np.linalg.norm(offset) / LIGHT_KM_PER_DAY
            distance = np.linalg.norm(offset)
            seconds = (jd - J2000) * 86400.0
            rows.append([f"{seconds:.3f}", planet, *(f"{c:.9f}" for c in offset / distance), f"{distance / AU_KM:.7f}"])
    path = HERE / "planets.csv"
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["tdb_j2000_s", "planet", "x", "y", "z", "distance_au"])
        writer.writerows(rows)
    manifest.record(HERE / "make.py", reason)
    manifest.record(path, reason)


if __name__ == "__main__":
    main()
