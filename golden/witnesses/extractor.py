#!/usr/bin/env python3
"""An extractor that nobody here wrote finds our stars: SEP (Source Extractor), with a matched filter.

    extractor.py [--pointings 40]

Frames of ARGON's camera with every effect of its detector, at boresights spread evenly over the sky. The truth table gives each star a signal-to-noise ratio, that of a matched filter on its own place. Demanded:
- recall goes with it: of a filter of threshold t a star is found with P = Q(h - snr), and h is t but for the grid: SEP's filter sits on whole pixels, which costs some of the ratio between them, and asks whether any of them passes, which
  gains some. So h, fitted, lies within 15 % of t; the share found in every bin of snr is that of the law within 6 points or three standard errors; and of stars above 2 t at least 99 % are found;
- position errors go with it: between the bound of light alone, sigma/snr, and twice that of a background, sqrt(2) sigma/snr (SEP's windowed centres are no maximum-likelihood estimate), for snr of 8 to 60;
- no bias of position above 0.02 px (the median of all above an snr of 8).
Stars that saturate, that have a neighbour within 6 px or a hot pixel within 4, or lie within 8 px of the edge, are left out.

Prints what was found; exit status 0 when all of it holds, 1 when not. Needs the package `boresight` (pip install ./python) and requirements.txt.
"""

import argparse
import math
import sys

import numpy as np
import sep

import pointings

THRESHOLD = 5.0
SIGMA_PX = math.sqrt(0.8**2 + 1.0 / 12.0)  # the point-spread function, and the pixel
GAIN_E, BIAS_DN, FULL_DN = 10.0, 40.0, 4095
READ_NOISE_E, DARK_E_PER_S = 15.0, 40.0
MOST_BIAS_PX = 0.02
OUTLIER = 8.0


def kernel():
    x = np.arange(-3, 4)
    return np.exp(-0.5 * (x[:, None] ** 2 + x[None, :] ** 2) / SIGMA_PX**2)


def lone(stars, others, columns, rows):
    """Which stars have nobody near."""
    keep = (stars[:, 0] > 8) & (stars[:, 0] < columns - 9) & (stars[:, 1] > 8) & (stars[:, 1] < rows - 9)
    for i, star in enumerate(stars):
        distances = np.hypot(*(others[:, :2] - star[:2]).T)
        # The star itself is one of them, at no distance.
        keep[i] &= np.sum(distances < others[:, 2]) == 1
    return keep


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pointings", type=int, default=40)
    snr, found, errors = [], [], []
    dither = np.random.default_rng(1)
    for _, frame in pointings.frames(parser.parse_args().pointings):
        image = frame.pixels.astype(float)
        rows, columns = image.shape
        # SEP finds the background by median and mode, which of whole numbers are off by up to half of one: it looks at a dithered image.
        background = sep.Background(image + dither.uniform(-0.5, 0.5, image.shape), bw=64, bh=64)
        # What the data sheet says of a pixel without stars: SEP's own estimate is of whole numbers too.
        light_e = 0.25 * (DARK_E_PER_S + frame.truth["background_e_per_s"])
        noise = np.full_like(image, math.sqrt((READ_NOISE_E**2 + light_e) / GAIN_E**2 + 1.0 / 12.0))
        image -= background.back()
        seen = sep.extract(image, THRESHOLD, err=noise, minarea=1, filter_kernel=kernel(), filter_type="matched", deblend_cont=1.0, clean=False)
        x, y, _ = sep.winpos(image, seen["x"], seen["y"], SIGMA_PX)
        objects = frame.objects
        kinds = np.array(list(objects["kind"]))
        table = np.column_stack([np.asarray(objects[name], float) for name in ("x_px", "y_px", "snr", "peak_electrons")])
        is_star = kinds == "star"
        # Beside stars that matter themselves; hot pixels and tracks only close by.
        reach = np.where(is_star | (kinds == "planet"), 6.0, 4.0)
        others = np.column_stack([table[:, :2], reach])[table[:, 2] > 1.0]
        stars = table[is_star & (table[:, 2] > 2.0) & (table[:, 3] < 0.5 * (FULL_DN - BIAS_DN) * GAIN_E)]
        stars = stars[lone(stars, others, columns, rows)]
        for star in stars:
            distance = np.hypot(seen["xpeak"] - star[0], seen["ypeak"] - star[1]) if len(x) else np.array([9.0])
            nearest = int(np.argmin(distance))
            is_found = distance[nearest] < 2.0
            snr.append(star[2])
            found.append(is_found)
            errors.append((x[nearest] - star[0], y[nearest] - star[1]) if is_found else (math.nan, math.nan))
    snr, found, errors = np.array(snr), np.array(found), np.array(errors)
    print(f"{len(snr)} stars apart from others, {int(found.sum())} found")

    # Half are found: where a logistic curve in snr, fitted by maximum likelihood on a grid, crosses.
    half = min(np.linspace(0.8 * THRESHOLD, 1.5 * THRESHOLD, 141), key=lambda h: -np.sum(
        np.where(found, -np.log1p(np.exp(-1.7 * (snr - h))), -np.log1p(np.exp(1.7 * (snr - h))))))
    bright = snr > 2 * THRESHOLD
    recall = found[bright].mean()
    print(f"half are found at an snr of {half:.2f} (threshold {THRESHOLD:.1f}); above {2 * THRESHOLD:.0f}, {100 * recall:.2f} % of {int(bright.sum())}")
    edges = [3, 4, 4.5, 5, 5.5, 6, 7, 8, 10]
    is_law = True
    for low, high in zip(edges, edges[1:]):
        inside = (snr >= low) & (snr < high)
        if inside.any():
            expected = np.mean([0.5 * math.erfc((half - s) / math.sqrt(2.0)) for s in snr[inside]])
            share = found[inside].mean()
            is_law &= abs(share - expected) <= max(0.06, 3.0 * math.sqrt(expected * (1.0 - expected) / inside.sum()))
            print(f"  snr {low:>4} to {high:>4}: {100 * share:5.1f} % of {int(inside.sum()):4d}, {100 * expected:5.1f} % by the law")
    holds = {
        "half are found within 15 % of the threshold": 0.85 * THRESHOLD <= half <= 1.15 * THRESHOLD,
        "as many are found as the law says, at every snr": bool(is_law),
        "at least 99 % are found above twice the threshold": recall >= 0.99,
    }
    within, outliers = True, 0
    for low, high in [(8, 12), (12, 20), (20, 35), (35, 60)]:
        inside = found & (snr >= low) & (snr < high)
        if inside.sum() < 30:
            continue
        # A particle's track through a star, or a windowed centre that runs away: counted, and no part of the law.
        apart = np.max(np.abs(errors), axis=1) * snr > OUTLIER * SIGMA_PX
        inside &= ~apart
        outliers += int(np.sum(apart & found & (snr >= low) & (snr < high)))
        rms = math.sqrt(np.nanmean(errors[inside] ** 2))
        least = SIGMA_PX * math.sqrt(np.mean(snr[inside] ** -2.0))
        print(f"  snr {low} to {high}: position RMS {rms:.4f} px a coordinate, bounds {least:.4f} (light) and {math.sqrt(2) * least:.4f} (background), {int(inside.sum())} stars")
        within &= least * 0.95 <= rms <= 2.0 * math.sqrt(2.0) * least
    bias = np.nanmedian(errors[found & (snr > 8)], axis=0)
    print(f"position bias {bias[0]:+.4f}, {bias[1]:+.4f} px")
    share = outliers / max(int(np.sum(found & (snr >= 8) & (snr < 60))), 1)
    print(f"{outliers} of them are off by more than {OUTLIER} sigma/snr ({100 * share:.2f} %)")
    holds["position errors between the bound and twice it"] = within
    holds["no more than 0.5 % of them far off"] = share <= 0.005
    holds[f"no bias of position above {MOST_BIAS_PX} px"] = bool(np.all(np.abs(bias) <= MOST_BIAS_PX))
    for claim, is_so in holds.items():
        print(f"{'ok  ' if is_so else 'FAIL'} {claim}")
    return 0 if all(holds.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
