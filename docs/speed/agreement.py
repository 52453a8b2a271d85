"""Whether frames of two simulators are frames of one law: differences of means and variances in their standard errors."""

import numpy as np

# A comparison has some thirty differences, of which one in a hundred and fifty thousand is beyond 4.5 by chance.
LIMIT = 4.5


def dn_variance(scene, mean_e):
    """Variance of a digital number: shot noise, read noise, rounding."""
    return (mean_e + scene.read_e**2) / scene.gain**2 + 1.0 / 12.0


def differences(scene, ours, theirs):
    """Of as many frames (frame, row, column) from two simulators: the background's mean and variance, the light of all stars, and
    the pixels of stars one by one (chi-square, whose standard deviation is that of its own law)."""
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
    """How far the mean of frames is from the expected image, which scipy's error function gives and no simulator."""
    stars = scene.star_map()
    lit = stars > 1.0
    mean_e = stars[lit] + scene.sky_e + scene.dark_e
    offs = frames.astype(float).mean(axis=0)[lit] - (mean_e / scene.gain + scene.bias)
    return chi_square(offs, dn_variance(scene, mean_e) / len(frames))


def chi_square(offs, variances):
    """Σ offs²/variance, as standard deviations from its mean."""
    return float(((offs**2 / variances).sum() - offs.size) / np.sqrt(2.0 * offs.size))
