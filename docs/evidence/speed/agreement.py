"""Statistical agreement of frames from two simulators: differences of means and variances in standard errors.
"""

import numpy as np

# A comparison has some thirty differences, of which one in a hundred and fifty thousand exceeds 4.5 by
# chance.
LIMIT = 4.5


def dn_variance(scene, mean_e):
    """Variance of a digital number: shot noise, read noise, rounding."""
    return (mean_e + scene.read_e**2) / scene.gain**2 + 1.0 / 12.0


def differences(scene, ours, theirs):
    """Compares equal numbers of frames (frame, row, column) from two simulators: mean and variance of the
    background, total flux of the stars, and single pixels of stars (chi-square, with the standard deviation
    of its distribution)."""
    stars = scene.star_map()
    dark, lit = stars < 1e-3, stars > 1.0
    count = len(ours)
    a, b = ours.astype(float), theirs.astype(float)
    pixels = dark.sum() * count
    variance = a[:, dark].var()
    mean = (b[:, dark].mean() - a[:, dark].mean()) / np.sqrt(2.0 * variance / pixels)
    # The variance of the sample variance of a nearly normal number is 2 σ⁴/n, and there are two of them.
    spread = (b[:, dark].var() - variance) / (2.0 * variance / np.sqrt(pixels))
    variances = 2.0 * dn_variance(scene, stars[lit] + scene.sky_e + scene.dark_e) / count
    offs = (b - a).mean(axis=0)[lit]
    light = offs.sum() / np.sqrt(variances.sum())
    return {
        "background's mean": float(mean),
        "background's variance": float(spread),
        "light of stars": float(light),
        "star pixels": chi_square(offs, variances),
    }


def from_expectation(scene, frames):
    """Deviation of the mean of frames from the expected image, which comes from scipy's error function and
    from no simulator."""
    stars = scene.star_map()
    lit = stars > 1.0
    mean_e = stars[lit] + scene.sky_e + scene.dark_e
    offs = frames.astype(float).mean(axis=0)[lit] - (mean_e / scene.gain + scene.bias)
    return chi_square(offs, dn_variance(scene, mean_e) / len(frames))


def chi_square(offs, variances):
    """Σ deviation²/variance, as standard deviations from its mean."""
    return float(((offs**2 / variances).sum() - offs.size) / np.sqrt(2.0 * offs.size))
