"""Frames over the whole sky: the camera of ARGON with every effect of its detector, at boresights spread
evenly.
"""

import math

import astropy.units as u
import numpy as np
from astropy.coordinates import get_body_barycentric_posvel
from astropy.time import Time

import boresight

EARTH_RADIUS_KM = 6378.1
SUN_EXCLUSION_DEG, EARTH_EXCLUSION_DEG = 50.0, 35.0
GOLDEN_TURN = math.pi * (3.0 - math.sqrt(5.0))


def lattice(count):
    """Right ascension, declination and roll, degrees, of a spherical Fibonacci lattice; the rolls advance by
    another irrational."""
    for k in range(count):
        declination = math.asin(1.0 - (2.0 * k + 1.0) / count)
        yield math.degrees(k * GOLDEN_TURN) % 360.0, math.degrees(declination), (k * math.sqrt(2.0) * 360.0) % 360.0


def scenario_at(base, start_utc, ra_deg, dec_deg, roll_deg):
    """ARGON's camera at a boresight and time, whole images at its longest exposure: no regions, no exposure
    control."""
    return base.with_values({
        "attitude.guidance": {"mode": "inertial", "ra_deg": ra_deg, "dec_deg": dec_deg, "roll_deg": roll_deg},
        "roi": None,
        "shutter": {"mode": "fixed", "exposure_s": 0.25},
        "schedule": [{"name": "witness", "start_utc": start_utc, "cadence_s": 1.0, "count": 1}],
    })


def moments(base):
    """Times with the directions to the Sun and to the centre of the Earth: eight along an orbit, in April and
    in October."""
    for day in ("2012-04-23T07", "2012-10-23T07"):
        for eighth in range(8):
            seconds = eighth * 741
            start_utc = f"{day}:{seconds // 60:02d}:{seconds % 60:02d}Z" if seconds < 3600 else f"{day[:-1]}8:{seconds // 60 - 60:02d}:{seconds % 60:02d}Z"
            truth = scenario_at(base, start_utc, 0.0, 0.0, 0.0).frame(0).truth
            earth = -np.array([truth[f"position_{axis}_km"] for axis in "xyz"])
            sun = np.array([truth[f"sun_j2000_{axis}"] for axis in "xyz"])
            limb_deg = math.degrees(math.asin(EARTH_RADIUS_KM / np.linalg.norm(earth)))
            yield start_utc, sun, earth / np.linalg.norm(earth), limb_deg


def clear_moment(known, ra_deg, dec_deg):
    """Time at which Sun and limb of the Earth are farthest from a boresight, each beyond its exclusion angle.
    """
    ra, dec = math.radians(ra_deg), math.radians(dec_deg)
    boresight = np.array([math.cos(dec) * math.cos(ra), math.cos(dec) * math.sin(ra), math.sin(dec)])
    angle = lambda other: math.degrees(math.acos(float(np.clip(boresight @ other, -1.0, 1.0))))
    room = [min(angle(sun) - SUN_EXCLUSION_DEG, angle(earth) - limb_deg - EARTH_EXCLUSION_DEG) for _, sun, earth, limb_deg in known]
    best = int(np.argmax(room))
    return known[best][0], room[best]


def frames(count, base=None):
    """Yields a frame per boresight, with its number, at a time when neither Sun nor Earth is near, as a
    camera requires. The scenario is ARGON, or `base`, a similar one."""
    base = base or boresight.Scenario.load("argon")
    known = list(moments(base))
    for k, (ra_deg, dec_deg, roll_deg) in enumerate(lattice(count)):
        start_utc, room_deg = clear_moment(known, ra_deg, dec_deg)
        if room_deg < 0.0:
            print(f"pointing {k}: Sun or Earth are {-room_deg:.0f} degrees too near at all times")
        yield k, scenario_at(base, start_utc, ra_deg, dec_deg, roll_deg).frame(0)


def observer_velocity_km_s(frame):
    """Velocity of the camera against the barycentre, ICRS axes, km/s: the Earth by ERFA's ephemeris in
    astropy, and the true orbit."""
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
    """ARGON's camera by its data sheet, implemented independently: pixels to the plane of a pinhole of square
    pixels."""

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
