"""Detection of stars by other tools, each as its documentation recommends.

A detector is a function from digital numbers (rows, columns; 16 bit) to the positions found, px (n, 2), x
first, with (0, 0) at the centre of the first pixel. Each starts from the image that the pipeline receives,
and estimates background and noise itself.
"""

import cv2
import numpy as np
import sep
import tetra3rs
from photutils.detection import DAOStarFinder

cv2.setNumThreads(1)


def level_and_noise(image):
    """Median, and standard deviation without stars, of every sixth row."""
    sample = image[::6]
    level = np.median(sample)
    low = np.percentile(sample, 15.865525)
    return level, sample[sample < level + 10.0 * (level - low)].std()


def sep_default(image):
    """Steps of SEP's tutorial: background, then 1.5 sigmas with the default filter, deblending and cleaning.
    """
    data = image.astype(np.float32)
    background = sep.Background(data)
    background.subfrom(data)
    found = sep.extract(data, 1.5, err=background.globalrms)
    return np.column_stack([found["x"], found["y"]])


def sep_fast(image):
    """Three sigmas in three pixels and more, without filter, deblending and cleaning."""
    data = image.astype(np.float32)
    background = sep.Background(data, bw=128, bh=128)
    background.subfrom(data)
    found = sep.extract(
        data, 3.0, err=background.globalrms, minarea=3, filter_kernel=None, deblend_cont=1.0, clean=False
    )
    return np.column_stack([found["x"], found["y"]])


def tetra3rs_fast(image):
    found = tetra3rs.extract_centroids_fast(image, threads=1)
    return places(found, image)


def tetra3rs_full(image):
    found = tetra3rs.extract_centroids(image, threads=1)
    return places(found, image)


def places(found, image):
    """tetra3rs counts from the middle of the image."""
    middle = np.array([image.shape[1] - 1, image.shape[0] - 1]) / 2.0
    return np.array([[star.x, star.y] for star in found.centroids]).reshape(-1, 2) + middle


def opencv_components(image):
    """Connected components above three sigmas, with unweighted (geometric) centres."""
    level, noise = level_and_noise(image)
    mask = (image > level + 3.0 * noise).view(np.uint8)
    count, labels, _, centres = cv2.connectedComponentsWithStats(mask, connectivity=8, ltype=cv2.CV_32S)
    bright = np.unique(labels[image > level + 6.0 * noise])
    return centres[bright]


def photutils_dao(image):
    level, noise = level_and_noise(image)
    found = DAOStarFinder(threshold=6.0 * noise, fwhm=1.9)(image - level)
    return np.column_stack([found["x_centroid"], found["y_centroid"]])


# Name in the table, function of an image.
DETECTORS = [
    ("tetra3rs 0.14: `extract_centroids_fast`", tetra3rs_fast),
    ("tetra3rs 0.14: `extract_centroids`", tetra3rs_full),
    ("OpenCV 5: `connectedComponentsWithStats`", opencv_components),
    ("SEP 1.4: no filter, no deblending", sep_fast),
    ("SEP 1.4: as its tutorial", sep_default),
    ("photutils 3: `DAOStarFinder`", photutils_dao),
]
