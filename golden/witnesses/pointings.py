"""Frames over the whole sky: the camera of ARGON with every effect of its detector, at boresights spread evenly."""

import math

import astropy.units as u
import numpy as np
from astropy.coordinates import get_body_barycentric_posvel
from astropy.time import Time

import boresight

GOLDEN_TURN = math.pi * (3.0 - math.sqrt(5.0))


def lattice(count):
    """Right ascension, declination and roll, degrees, of a spherical Fibonacci lattice; the rolls go round by another irrational."""
    for k in range(count):
        declination = math.asin(1.0 - (2.0 * k + 1.0) / count)
        yield math.degrees(k * GOLDEN_TURN) % 360.0, math.degrees(declination), (k * math.sqrt(2.0) * 360.0) % 360.0


def scenario_at(base, ra_deg, dec_deg, roll_deg):
    """ARGON's camera looking there, whole images at its longest exposure: no regions, no shutter control."""
    guidance = {"mode": "inertial", "ra_deg": ra_deg, "dec_deg": dec_deg, "roll_deg": roll_deg}
    return base.with_values({
        "attitude.guidance": guidance,
        "roi": None,
        "shutter": {"mode": "fixed", "exposure_s": 0.25},
        "schedule[0].count": 1,
    })


def frames(count):
    """A frame a boresight, with its number, until there are `count` of them."""
    base = boresight.Scenario.load("argon")
    for k, pointing in enumerate(lattice(count)):
        yield k, scenario_at(base, *pointing).frame(0)


def observer_velocity_km_s(frame):
    """Of the camera against the barycentre, ICRS axes, km/s: the Earth by ERFA's ephemeris in astropy, and the true orbit."""
    time = Time(str(frame.truth["time_utc"]).removesuffix("Z"), scale="utc")
    _, earth = get_body_barycentric_posvel("earth", time)
    orbit = np.array([frame.truth[f"velocity_{axis}_km_s"] for axis in "xyz"])
    return earth.xyz.to_value(u.km / u.s) + orbit


def camera_from_icrs(frame):
    """The true rotation matrix, from the quaternion of the truth (Hamilton, scalar first)."""
    w, x, y, z = (frame.truth[f"q_cam_j2000_{part}"] for part in "wxyz")
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


class Camera:
    """ARGON's camera as its data sheet has it, written here once more: pixels to the plane of a pinhole of square pixels."""

    def __init__(self, camera):
        self.f = np.array([camera["focal_length_mm"] / (camera[f"pixel_{side}_um"] * 1e-3) for side in ("width", "height")])
        self.principal = np.array([camera["principal_x_px"], camera["principal_y_px"]])
        self.radial = camera["radial"]

    def undistorted(self, points):
        """Pinhole coordinates (X/Z, Y/Z) of pixels, by fixed-point iteration of the radial polynomial."""
        seen = np.asarray(points, float) - self.principal
        ideal = seen.copy()
        for _ in range(20):
            r2 = np.sum(ideal**2, axis=1, keepdims=True)
            ideal = seen / (1.0 + sum(k * r2 ** (i + 1) for i, k in enumerate(self.radial)))
        return ideal / self.f
