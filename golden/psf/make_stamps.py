"""Makes star stamps with GalSim, integrated over the pixels: the references for the point-spread functions.

Tools: galsim 2.8.5 (Rowe et al. 2015, Astronomy and Computing 10, 121), numpy 2.4.6.

    pip install -r golden/psf/requirements.txt
    python3 golden/psf/make_stamps.py --reason "why"

stamps.csv, one stamp a line: kind; its parameters, joined by spaces, in the order of PsfConfig's fields;
x_px, y_px of the centre (that of the first pixel is 0, 0); size (the stamp has so many columns and rows);
then size * size shares of the flux, row by row from row 0.

drawImage with its default method convolves with the pixel, in Fourier space, with the tolerances below. A
Gaussian, a Moffat and an Airy profile have unit flux over the whole plane in GalSim as they have here;
trunc=0 leaves the Moffat's wings whole. Airy takes lambda/D in the units of the pixel scale: with a scale of
1 that is lambda N over the pixel's width, lambda_n_px. The defocused disk is a TopHat convolved with a
Gaussian.
"""

import csv
import pathlib
import sys

import galsim

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import manifest  # noqa: E402

ACCURATE = galsim.GSParams(
    minimum_fft_size=1024,
    maximum_fft_size=32768,
    folding_threshold=1e-5,
    stepk_minimum_hlr=100,
    maxk_threshold=1e-7,
    kvalue_accuracy=1e-9,
    xvalue_accuracy=1e-9,
    table_spacing=0.2,
)
# For the Airy pattern, a thousandth of which lies beyond 200 lambda N: folded over the image it is 1e-8 a
# pixel. Also for the disk, whose transform the Gaussian limits.
FOLDED = galsim.GSParams(
    folding_threshold=1e-3,
    maxk_threshold=1e-6,
    kvalue_accuracy=1e-8,
    xvalue_accuracy=1e-8,
    table_spacing=0.2,
    maximum_fft_size=16384,
)
PHASES = [(0.0, 0.0), (0.25, -0.4), (-0.5, 0.5), (0.13, 0.37)]
SIZE, WIDE = 20, 61


def profiles():
    """Kind, parameters as in PsfConfig, profile, sizes of the stamps."""
    for sigma in (0.5, 0.8, 2.0):
        yield "gaussian", [sigma], galsim.Gaussian(sigma=sigma, gsparams=ACCURATE), [SIZE]
    for fwhm, beta in ((1.5, 2.5), (1.8, 3.0), (2.5, 4.765)):
        profile = galsim.Moffat(beta=beta, fwhm=fwhm, trunc=0, gsparams=ACCURATE)
        yield "moffat", [fwhm, beta], profile, [SIZE, WIDE] if beta == 3.0 else [SIZE]
    for lambda_n, obscuration in ((0.9, 0.0), (1.5, 0.0), (1.5, 0.3)):
        profile = galsim.Airy(lam_over_diam=lambda_n, obscuration=obscuration, gsparams=FOLDED)
        yield "airy", [lambda_n, obscuration], profile, [SIZE]
    for radius, sigma in ((2.5, 0.6),):
        parts = [galsim.TopHat(radius=radius), galsim.Gaussian(sigma=sigma)]
        profile = galsim.Convolve(parts, gsparams=FOLDED, propagate_gsparams=True)
        yield "defocus", [radius, sigma], profile, [SIZE]


def main():
    arguments = manifest.begin()
    path = HERE / "stamps.csv"
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        for kind, parameters, profile, sizes in profiles():
            for size in sizes:
                for phase in PHASES if size == SIZE else PHASES[-1:]:
                    image = galsim.ImageD(size, size)
                    middle = size // 2
                    x, y = middle + phase[0], middle + phase[1]
                    # GalSim's true centre of n pixels from 0 is (n - 1)/2.
                    centre = galsim.PositionD(x - (size - 1) / 2, y - (size - 1) / 2)
                    profile.drawImage(image, scale=1.0, offset=centre, method="auto")
                    shares = [f"{value:.6e}" for value in image.array.ravel()]
                    writer.writerow([kind, " ".join(map(str, parameters)), x, y, size, *shares])
    manifest.record(path, arguments.reason)
    for name in ("make_stamps.py", "requirements.txt"):
        manifest.record(HERE / name, arguments.reason)


if __name__ == "__main__":
    main()
