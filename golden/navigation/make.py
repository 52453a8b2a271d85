#!/usr/bin/env python3
"""Makes the reference for relative navigation: an orbit from lines of sight by SciPy 1.17.1.

Simulates a day of lines of sight of one campaign and estimates the relative orbit from them. Both satellites
are integrated in Cartesian coordinates by DOP853 (Hairer, Norsett, Wanner) with the acceleration of J2; the
unknowns are the target's Cartesian state at the epoch and three constant rotations of the camera, found by
Gauss-Newton with central differences. Elements, transition matrices and
mean orbits, on which the navigators are built, do not occur.

    pip install -r golden/navigation/requirements.txt
    python3 golden/navigation/make.py --reason "why"

sights.csv: seconds, measured direction along ICRS, axes of the camera along ICRS. chaser.csv: the chaser's true
states. estimates.csv: position of the chaser along the target's R, T, N, m, its standard deviation, its truth.
"""

import csv
import pathlib
import sys

import numpy as np
from scipy.integrate import solve_ivp

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import manifest  # noqa: E402

GM, RADIUS, J2 = 398600.4415, 6378.1363, 1.0826266835e-3
ARCSEC = np.radians(1 / 3600)
WHITE, CONSTANT = 30 * ARCSEC, 20 * ARCSEC
MANOEUVRES = [(9000.0, (0.0, -0.05, 0.02)), (40000.0, (0.02, 0.03, -0.04)), (62000.0, (0.0, -0.04, 0.0))]
TIMES = np.arange(600.0, 86400.0, 120.0)
EPOCHS = np.array([0.0, 20000.0, 43200.0, 70000.0, 86000.0])


def derivative(_, y):
    r, v = y[:3], y[3:]
    r2 = r @ r
    z2 = 5 * r[2] ** 2 / r2
    k = 1.5 * J2 * GM * RADIUS**2 / r2**2.5
    return np.concatenate([v, -GM * r / r2**1.5 + k * r * np.array([z2 - 1, z2 - 1, z2 - 3])])


def axes(y):
    r = y[:3] / np.linalg.norm(y[:3])
    n = np.cross(y[:3], y[3:])
    n /= np.linalg.norm(n)
    return np.array([r, np.cross(n, r), n])


def fly(y, times, manoeuvres=()):
    """States at times in order, after impulses along the satellite's own R, T, N, m/s."""
    out, start = [], 0.0
    times = np.asarray(times)
    for end, dv in [*manoeuvres, (times[-1], None)]:
        inside = times[(times >= start) & ((times < end) | (dv is None))]
        solution = solve_ivp(derivative, (start, end), y, "DOP853", dense_output=True, max_step=60.0,
                             rtol=1e-12, atol=1e-12)
        out += [solution.sol(t) for t in inside]
        y = solution.y[:, -1].copy()
        if dv is not None:
            y[3:] += axes(y).T @ np.array(dv) * 1e-3
        start = end
    return np.array(out)


def state(a, e, i, raan, argp, m):
    big_e = m
    for _ in range(50):
        big_e -= (big_e - e * np.sin(big_e) - m) / (1 - e * np.cos(big_e))
    p = np.array([np.cos(raan) * np.cos(argp) - np.sin(raan) * np.sin(argp) * np.cos(i),
                  np.sin(raan) * np.cos(argp) + np.cos(raan) * np.sin(argp) * np.cos(i), np.sin(argp) * np.sin(i)])
    q = np.array([-np.cos(raan) * np.sin(argp) - np.sin(raan) * np.cos(argp) * np.cos(i),
                  -np.sin(raan) * np.sin(argp) + np.cos(raan) * np.cos(argp) * np.cos(i), np.cos(argp) * np.sin(i)])
    eta, rate = np.sqrt(1 - e * e), np.sqrt(GM / a**3) / (1 - e * np.cos(big_e))
    r = a * ((np.cos(big_e) - e) * p + eta * np.sin(big_e) * q)
    return np.concatenate([r, a * rate * (eta * np.cos(big_e) * q - np.sin(big_e) * p)])


def angles(d):
    return np.stack([np.arctan2(d[:, 0], d[:, 2]), np.arctan2(d[:, 1], d[:, 2])], 1)


def relative(chaser, target):
    return axes(target) @ (chaser[:3] - target[:3]) * 1e3


def main():
    arguments = manifest.begin()
    random = np.random.default_rng(20120423)
    target0 = state(7130.0, 0.003, np.radians(98.28), np.radians(126.4), np.radians(90), np.radians(270))
    # 15 km behind on the same orbit (-2.1 mrad), displaced by some hundred metres.
    chaser0 = state(7129.99, 0.00305, np.radians(98.281), np.radians(126.401), np.radians(90.5),
                    np.radians(270 - 0.5 - 0.12))
    chaser, target = fly(chaser0, TIMES, MANOEUVRES), fly(target0, TIMES)
    # Camera: x along -N, y along -R, z along T of the chaser.
    cameras = np.array([[-n, -r, t] for r, t, n in map(axes, chaser)])
    los = np.einsum("kij,kj->ki", cameras, target[:, :3] - chaser[:, :3])
    seen = angles(los) + WHITE * random.standard_normal((len(TIMES), 2))
    measured = np.column_stack([np.tan(seen), np.ones(len(TIMES))])
    measured += np.cross(CONSTANT * random.standard_normal(3), measured)
    measured /= np.linalg.norm(measured, axis=1)[:, None]
    observed = angles(measured)
    scale = np.array([1, 1, 1, 1e-3, 1e-3, 1e-3, 1e-4, 1e-4, 1e-4]) * 1e-2
    start = np.concatenate([target0, np.zeros(3)])  # The truth: the minimum is sought, not an initial orbit.

    def residuals(x):
        x = start + x * scale
        d = np.einsum("kij,kj->ki", cameras, fly(x[:6], TIMES)[:, :3] - chaser[:, :3])
        model = angles(d + np.cross(x[6:], d))
        return np.concatenate([((observed - model) / WHITE).ravel(), x[6:] / CONSTANT])

    def slopes_at(x):
        # Central differences with steps of 2 cm and 0.02 mm/s, which move the target by 5 m in a day. The
        # range is a small difference of large derivatives: steps of a metre would bias it by half its sigma.
        return np.array([(residuals(x + d) - residuals(x - d)) / 4e-3 for d in 2e-3 * np.eye(9)]).T

    x = np.zeros(9)
    for iteration in range(12):
        jacobian, right = slopes_at(x), -residuals(x)
        step = np.linalg.lstsq(jacobian, right, rcond=None)[0]
        covariance = np.linalg.inv(jacobian.T @ jacobian)
        x += step
        length = np.max(np.abs(step) / np.sqrt(np.diag(covariance)))
        print("iteration", iteration, "sum of squares", right @ right, "step / sigma", length)
        if length < 1e-3:
            break
    else:
        sys.exit("no convergence")
    x, covariance = start + x * scale, covariance * np.outer(scale, scale)
    chaser_at, truth_at = fly(chaser0, EPOCHS, MANOEUVRES), fly(target0, EPOCHS)

    def at(y):
        return np.array([relative(c, t) for c, t in zip(chaser_at, fly(y, EPOCHS))])

    centre, step = at(x[:6]), np.array([1e-3] * 3 + [1e-6] * 3)
    slopes = np.array([(at(x[:6] + d) - at(x[:6] - d)) / (2 * h) for d, h in zip(np.diag(step), step)])
    sigma = np.sqrt(np.einsum("iek,ij,jek->ek", slopes, covariance[:6, :6], slopes))
    true = np.array([relative(c, t) for c, t in zip(chaser_at, truth_at)])
    print("truth", true, "error / sigma", (centre - true) / sigma, "sigma", sigma, sep="\n")

    def write(name, header, rows):
        with open(HERE / name, "w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(header)
            writer.writerows([[f"{value:.17g}" for value in row] for row in rows])
        manifest.record(HERE / name, arguments.reason)

    icrs = np.einsum("kji,kj->ki", cameras, measured)
    axis = "x_axis_x,x_axis_y,x_axis_z,y_axis_x,y_axis_y,y_axis_z,z_axis_x,z_axis_y,z_axis_z".split(",")
    write("sights.csv", ["seconds", "los_x", "los_y", "los_z", *axis],
          np.column_stack([TIMES, icrs, cameras.reshape(-1, 9)]))
    times = np.arange(0.0, 86401.0, 300.0)
    write("chaser.csv", "seconds,x_km,y_km,z_km,vx_km_s,vy_km_s,vz_km_s".split(","),
          np.column_stack([times, fly(chaser0, times, MANOEUVRES)]))
    write("estimates.csv", "seconds,r_m,t_m,n_m,sigma_r_m,sigma_t_m,sigma_n_m,true_r_m,true_t_m,true_n_m".split(","),
          np.column_stack([EPOCHS, centre, sigma, true]))


if __name__ == "__main__":
    main()
