#!/usr/bin/env python3
"""Independent extractor: SEP (Source Extractor) with a matched filter finds Boresight's stars.

    extractor.py [--pointings 40]

Frames of ARGON's camera with every effect of its detector, at boresights spread evenly over the sky.
Requirements are predicted by closed forms from the truth table's `electrons` and positions and from the data
sheet; nothing is fitted. S² = sigma² + 1/12 is the width of an image (a Gaussian, and the pixel), F its
electrons without the halo, b the variance of a pixel without stars, electrons².
- Recall. The filter output at a pixel d from the star has the mean F/sqrt(4 pi S² b) exp(-d²/4S²) plus that
  of the halo, the variance 1 + F/(3 pi S² b), and the correlation exp(-d²/4S²) between pixels; a star is
  found when the output exceeds the threshold at any pixel within 2 px. The share found in every bin of the
  signal-to-noise ratio agrees within 2 points and three standard errors; above twice the threshold at least
  99 % are found.
- Positions. SEP's windowed centre, with a window as wide as the image, has in each coordinate the variance 8
  pi S⁴ b/F² + (16/9) S²/F: that of the best estimate where the background dominates the noise, 4/3 of its
  root where the star's shot noise does. The root of the mean square, in units of that, is 1 within 8 % and
  three standard errors in every bin; the median of all errors is 0 within 0.01 px.
- Electrons. The sum over a circle of 3 px about the true position, less the mean of a ring, times the gain,
  over the closed form's share of the star's flux there (a Gaussian of variance sigma² + 1/6: collected by
  pixels and cut by the circle; and the halo's), is `electrons`: the ratio, by least squares, is 1 within 0.3
  % and 3.5 standard errors in every bin, and within 0.3 % and three of all stars together, so that an error
  of 1 % shows. The 0.3 % allow for effects outside the closed form: stars too faint for the table, dark
  current that differs from pixel to pixel. The scatter is that of signal, dark current, readout and rounding
  within 5 % and three standard errors, which confirms gain and noise.
- The level of the background, in the rings, is bias, dark current and sky within 0.05 DN.

Excluded are stars that saturate, that have a neighbour within 6 px or a hot pixel within 4, or lie within 8
px of the edge; for electrons also those within 12 px of the edge, with less than half of their ring free of
others, or with more than 1 % of a brighter neighbour's halo in the circle.

Prints the results; exit status 0 when all of it holds, 1 when not. Needs the package `boresight` (pip install
./python) and requirements.txt.
"""

import argparse
import math
import sys

import numpy as np
import sep

import pointings

THRESHOLD = 5.0
SIGMA_PX, HALO_PX, HALO_SHARE = 0.8, 4.0, 0.0434
WIDTH_PX = math.sqrt(SIGMA_PX**2 + 1.0 / 12.0)
GAIN_E, BIAS_DN, FULL_DN = 10.0, 40.0, 4095
READ_NOISE_E, DARK_E_PER_S, EXPOSURE_S = 15.0, 40.0, 0.25
# The simulator cuts an image off below this level; a Gaussian halo then lacks 2 pi HALO_PX² times as much,
# for every star.
FLOOR_E = 0.01

RECALL_EDGES = [3, 4, 4.5, 5, 5.5, 6, 7, 8, 10]
RECALL_APART, MIN_RECALL = 0.02, 0.99
PLACE_EDGES = [8, 12, 20, 35, 60]
PLACE_APART, MAX_BIAS_PX, OUTLIER, MAX_OUTLIERS = 0.08, 0.01, 8.0, 0.005
FLUX_EDGES = [5, 8, 12, 20, 35, 60, 150]
FLUX_APART, SCATTER_APART, FLUX_OUTLIER = 0.003, 0.05, 6.0
LEVEL_APART_DN = 0.05
CIRCLE_PX, RING_PX = 3.0, (7.0, 11.0)
RING_AREA = math.pi * (RING_PX[1] ** 2 - RING_PX[0] ** 2)
CIRCLE_AREA = math.pi * CIRCLE_PX**2


def kernel():
    x = np.arange(-3, 4)
    return np.exp(-0.5 * (x[:, None] ** 2 + x[None, :] ** 2) / WIDTH_PX**2)


def lone(stars, others, columns, rows):
    """Mask of the stars without a neighbour."""
    keep = (stars[:, 0] > 8) & (stars[:, 0] < columns - 9) & (stars[:, 1] > 8) & (stars[:, 1] < rows - 9)
    for i, star in enumerate(stars):
        distances = np.hypot(*(others[:, :2] - star[:2]).T)
        # The star itself is one of them, at distance 0.
        keep[i] &= np.sum(distances < others[:, 2]) == 1
    return keep


def beyond(radius_px, variance):
    """Fraction of a round Gaussian outside a circle."""
    return math.exp(-(radius_px**2) / (2.0 * variance))


def halo_at(electrons, distance_px):
    """Electrons a pixel of a star's halo."""
    variance = HALO_PX**2 + 1.0 / 12.0
    return HALO_SHARE * electrons / (2.0 * math.pi * variance) * np.exp(-(distance_px**2) / (2.0 * variance))


# Fraction of a star's flux in the circle, less its contribution to the ring.
CORE, HALO = SIGMA_PX**2 + 1.0 / 6.0, HALO_PX**2 + 1.0 / 6.0
CAUGHT = ((1.0 - HALO_SHARE) * (1.0 - beyond(CIRCLE_PX, CORE)) + HALO_SHARE * (1.0 - beyond(CIRCLE_PX, HALO))
          - HALO_SHARE * (beyond(RING_PX[0], HALO) - beyond(RING_PX[1], HALO)) * CIRCLE_AREA / RING_AREA)

# Pixels cut by the circle count by the square of their share: the noise is less than that of the area, by 1/6
# px² for every px of the edge, in every direction of the edge (1/6 along rows, 0.165 at 45 degrees).
CIRCLE_NOISE = CIRCLE_AREA - 2.0 * math.pi * CIRCLE_PX / 6.0

# Noise of the filter on the pixels about a star; each star's prediction has its own DRAWS.
DRAWS = 400
_GRID = np.array([(x, y) for y in range(-3, 4) for x in range(-3, 4)], float)
_CORRELATION = np.exp(-np.sum((_GRID[:, None] - _GRID[None]) ** 2, axis=2) / (4.0 * WIDTH_PX**2))
_NOISE = np.random.default_rng(0).standard_normal((250 * DRAWS, len(_GRID))) @ np.linalg.cholesky(_CORRELATION + 1e-9 * np.eye(len(_GRID))).T


def chance(number, x, y, electrons, variance_e2):
    """Probability that the filter exceeds the threshold at a pixel within 2 px of a star."""
    draws = _NOISE[DRAWS * (number % 250) :][:DRAWS]
    squares = np.sum((_GRID - [x - round(x), y - round(y)]) ** 2, axis=1)
    near = squares < 4.0
    core = (1.0 - HALO_SHARE) * electrons
    # A level as broad as the halo passes the filter with its sum over the root of the sum of its squares.
    answer = (core / math.sqrt(4.0 * math.pi * WIDTH_PX**2) * np.exp(-squares[near] / (4.0 * WIDTH_PX**2))
              + 2.0 * math.sqrt(math.pi) * WIDTH_PX * halo_at(electrons, np.sqrt(squares[near] + WIDTH_PX**2))) / math.sqrt(variance_e2)
    spread = math.sqrt(1.0 + core / (3.0 * math.pi * WIDTH_PX**2 * variance_e2))
    return np.mean(np.max(answer + spread * draws[:, near], axis=1) > THRESHOLD)


def covered(objects, shape):
    """Pixels covered by any object of the truth table, with a margin."""
    mask = np.zeros(shape, bool)
    for x, y, radius in objects:
        x0, x1 = int(max(x - radius, 0)), int(min(x + radius + 2, shape[1]))
        y0, y1 = int(max(y - radius, 0)), int(min(y + radius + 2, shape[0]))
        if x0 < x1 and y0 < y1:
            rows, columns = np.mgrid[y0:y1, x0:x1]
            mask[y0:y1, x0:x1] |= np.hypot(columns - x, rows - y) < radius
    return mask


def electrons_of(image, stars, mask):
    """SEP's sums about true positions: electrons of the stars, the fraction of each ring that is free of
    others, and the level in it, DN."""
    sums, _, _ = sep.sum_circle(image, stars[:, 0], stars[:, 1], CIRCLE_PX, subpix=0)
    free, _, _ = sep.sum_circann((~mask).astype(float), stars[:, 0], stars[:, 1], *RING_PX)
    lit, _, _ = sep.sum_circann(np.where(mask, 0.0, image), stars[:, 0], stars[:, 1], *RING_PX)
    level = lit / np.maximum(free, 1.0)
    return GAIN_E * (sums - CIRCLE_AREA * level) / CAUGHT, free / RING_AREA, level


def looked_at(frame, dither):
    """SEP's results for a frame's stars: for each its truth (x, y, snr, electrons), b, prediction and
    measurement."""
    image = frame.pixels.astype(float)
    rows, columns = image.shape
    # SEP computes the background by median and mode, which are off by up to half of one for integers: the
    # image is dithered.
    background = sep.Background(image + dither.uniform(-0.5, 0.5, image.shape), bw=64, bh=64).back()
    # Noise of a pixel without stars by the data sheet: SEP's estimate also suffers from integers.
    light_e = EXPOSURE_S * (DARK_E_PER_S + frame.truth["background_e_per_s"])
    variance_e2 = READ_NOISE_E**2 + light_e + GAIN_E**2 / 12.0
    noise = np.full_like(image, math.sqrt(variance_e2) / GAIN_E)
    seen = sep.extract(image - background, THRESHOLD, err=noise, minarea=1, filter_kernel=kernel(), filter_type="matched", deblend_cont=1.0, clean=False)
    x, y, _ = sep.winpos(image - background, seen["x"], seen["y"], WIDTH_PX)

    objects = frame.objects
    kinds = np.array(list(objects["kind"]))
    table = np.column_stack([np.asarray(objects[name], float) for name in ("x_px", "y_px", "snr", "electrons", "peak_electrons", "radius_px", "bloom_px")])
    is_star = kinds == "star"
    # Distances that exclude a star: large for stars and planets, small for hot pixels and cosmic-ray hits.
    reach = np.where(is_star | (kinds == "planet"), 6.0, 4.0)
    matter = table[:, 2] > 1.0
    stars = table[is_star & (table[:, 2] > 2.0) & (table[:, 4] < 0.5 * (FULL_DN - BIAS_DN) * GAIN_E)]
    stars = stars[lone(stars, np.column_stack([table[:, :2], reach])[matter], columns, rows)]

    mask = covered(np.column_stack([table[:, :2], table[:, 5] + table[:, 6] + 3.0])[matter], image.shape)
    # The star's own pixels end before its ring begins.
    flux, free, level = electrons_of(image, stars, mask)
    found = []
    for i, star in enumerate(stars):
        distance = np.hypot(seen["xpeak"] - star[0], seen["ypeak"] - star[1]) if len(x) else np.array([9.0])
        nearest = int(np.argmin(distance))
        is_found = distance[nearest] < 2.0
        apart = np.hypot(table[:, 0] - star[0], table[:, 1] - star[1])
        strange = CIRCLE_AREA * np.sum(np.where(apart > 0.0, halo_at(table[:, 3], apart), 0.0)[apart < 30.0])
        inside = 12 < star[0] < columns - 13 and 12 < star[1] < rows - 13
        measured = inside and free[i] > 0.5 and strange < 0.01 * star[3] + 3.0 and star[5] + star[6] + 3.0 < RING_PX[0]
        found.append((*star[:4], variance_e2, chance(i, *star[:2], star[3], variance_e2), is_found, *((x[nearest] - star[0], y[nearest] - star[1]) if is_found else (math.nan, math.nan)),
                      flux[i] if measured else math.nan, free[i], level[i] - BIAS_DN - light_e / GAIN_E))
    return found


def bins(edges, snr):
    for low, high in zip(edges, edges[1:]):
        inside = (snr >= low) & (snr < high)
        if inside.any():
            yield f"snr {low:>4} to {high:>4}", inside


def recall_holds(snr, expected, found):
    holds = True
    for name, inside in bins(RECALL_EDGES, snr):
        share, law = found[inside].mean(), expected[inside].mean()
        allowed = RECALL_APART + 3.0 * math.sqrt(law * (1.0 - law) / inside.sum())
        holds &= abs(share - law) <= allowed
        print(f"  {name}: {100 * share:5.1f} % of {int(inside.sum()):4d} found, {100 * law:5.1f} % predicted, ± {100 * allowed:.1f}")
    return bool(holds)


def places_hold(snr, electrons, variance_e2, found, errors):
    """Checks that the positions scatter as predicted, and that few are outliers."""
    core = (1.0 - HALO_SHARE) * electrons
    sigma = np.sqrt(8.0 * math.pi * WIDTH_PX**4 * variance_e2 / core**2 + 16.0 / 9.0 * WIDTH_PX**2 / core)
    # A cosmic-ray hit on a star, or a diverging windowed centre: counted, and outside the prediction.
    far = np.max(np.abs(np.nan_to_num(errors)), axis=1) * snr > OUTLIER * WIDTH_PX
    holds = True
    for name, inside in bins(PLACE_EDGES, snr):
        inside = inside & found & ~far
        pull = math.sqrt(np.mean((errors[inside] / sigma[inside, None]) ** 2))
        rms = math.sqrt(np.mean(errors[inside] ** 2))
        allowed = PLACE_APART + 3.0 / math.sqrt(4.0 * inside.sum())
        holds &= abs(pull - 1.0) <= allowed
        print(f"  {name}: places RMS {rms:.4f} px a coordinate, {pull:.3f} times what is predicted (± {allowed:.3f}), {int(inside.sum())} stars")
    counted = found & (snr >= PLACE_EDGES[0]) & (snr < PLACE_EDGES[-1])
    outliers = np.sum(far & counted) / max(counted.sum(), 1)
    print(f"{int(np.sum(far & counted))} of them are off by more than {OUTLIER} sigma/snr ({100 * outliers:.2f} %)")
    return bool(holds), bool(outliers <= MAX_OUTLIERS)


def electrons_hold(snr, electrons, variance_e2, flux, free):
    """Checks that the electrons agree with the truth table in every bin and over all, and scatter as
    predicted."""
    lit = electrons + 2.0 * math.pi * HALO_PX**2 * FLOOR_E
    # The subtracted level contains the noise of the ring.
    sigma = np.sqrt(variance_e2 * (CIRCLE_NOISE + CIRCLE_AREA**2 / (RING_AREA * np.maximum(free, 0.1))) + CAUGHT * lit) / CAUGHT
    pulls = (flux - lit) / sigma
    measured = np.isfinite(flux)
    far = measured & (np.abs(np.nan_to_num(pulls)) > FLUX_OUTLIER)
    every, together, scatter = True, None, True
    for name, inside in [*bins(FLUX_EDGES, snr), (f"snr {FLUX_EDGES[0]:>4} to {FLUX_EDGES[-1]:>4}", (snr >= FLUX_EDGES[0]) & (snr < FLUX_EDGES[-1]))]:
        inside = inside & measured & ~far
        weight = np.sum((lit[inside] / sigma[inside]) ** 2)
        ratio, error = np.sum(flux[inside] * lit[inside] / sigma[inside] ** 2) / weight, 1.0 / math.sqrt(weight)
        spread, spread_error = np.std(pulls[inside]), 1.0 / math.sqrt(2.0 * inside.sum())
        print(f"  {name}: electrons {ratio:.4f} ± {error:.4f} of the truth's, scatter {spread:.3f} ± {spread_error:.3f} times what is predicted, {int(inside.sum())} stars")
        every &= abs(ratio - 1.0) <= FLUX_APART + 3.5 * error
        scatter &= abs(spread - 1.0) <= SCATTER_APART + 3.0 * spread_error
        together = abs(ratio - 1.0) <= FLUX_APART + 3.0 * error  # The last are all.
    share = np.sum(far) / max(np.sum(measured), 1)
    print(f"{int(np.sum(far))} of {int(np.sum(measured))} are off by more than {FLUX_OUTLIER:.0f} sigma ({100 * share:.2f} %)")
    return bool(every), bool(together), bool(scatter), bool(share <= MAX_OUTLIERS)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pointings", type=int, default=40)
    dither = np.random.default_rng(1)
    rows = [row for _, frame in pointings.frames(parser.parse_args().pointings) for row in looked_at(frame, dither)]
    _, _, snr, electrons, variance_e2, expected, found, dx, dy, flux, free, level = np.array(rows, float).T
    found = found > 0.0
    errors = np.column_stack([dx, dy])
    print(f"{len(snr)} stars apart from others, {int(found.sum())} found")

    bright = snr > 2 * THRESHOLD
    recall = found[bright].mean()
    print(f"above {2 * THRESHOLD:.0f}, {100 * recall:.2f} % of {int(bright.sum())} are found")
    as_many = recall_holds(snr, expected, found)
    places, few_far = places_hold(snr, electrons, variance_e2, found, errors)
    bias = np.nanmedian(errors[found & (snr > 8)], axis=0)
    print(f"position bias {bias[0]:+.4f}, {bias[1]:+.4f} px")
    every, together, scatter, few_wrong = electrons_hold(snr, electrons, variance_e2, flux, free)
    clear = free > 0.9
    background = np.mean(level[clear])
    print(f"background {background:+.4f} DN from bias, dark current and sky, {int(clear.sum())} rings")

    holds = {
        f"as many found as predicted within {100 * RECALL_APART:.0f} points and three standard errors, at every snr": as_many,
        f"at least {100 * MIN_RECALL:.0f} % found above twice the threshold": bool(recall >= MIN_RECALL),
        f"places scatter as predicted within {100 * PLACE_APART:.0f} % and three standard errors, at every snr": places,
        f"no more than {100 * MAX_OUTLIERS} % of the places far off": few_far,
        f"no bias of position above {MAX_BIAS_PX} px": bool(np.all(np.abs(bias) <= MAX_BIAS_PX)),
        f"electrons within {100 * FLUX_APART} % and 3.5 standard errors at every snr": every,
        f"electrons within {100 * FLUX_APART} % and three standard errors over all": together,
        f"electrons scatter as predicted within {100 * SCATTER_APART:.0f} % and three standard errors": scatter,
        f"no more than {100 * MAX_OUTLIERS} % of the electrons far off": few_wrong,
        f"background within {LEVEL_APART_DN} DN": bool(abs(background) <= LEVEL_APART_DN),
    }
    for claim, is_so in holds.items():
        print(f"{'ok  ' if is_so else 'FAIL'} {claim}")
    return 0 if all(holds.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
