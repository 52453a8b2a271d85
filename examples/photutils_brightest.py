"""A pipeline for Boresight with photutils: --pipeline "exec:python3 examples/photutils_brightest.py"

Background and noise by clipping, segments above five sigmas, and among those away from listed stars the
brightest. Needs numpy, astropy and photutils.
"""
import json, sys, warnings
import numpy as np
from astropy.io import fits
from astropy.stats import sigma_clipped_stats
from photutils.segmentation import SourceCatalog, detect_sources
from listed_stars import is_listed, places, transmitted

def target(request):
    pixels = fits.getdata(request["image"]).astype(float)
    mask = ~transmitted(request["windows"], pixels.shape)
    if mask.all():
        return None
    _, level, noise = sigma_clipped_stats(pixels, mask=mask)
    segments = detect_sources(pixels - level, 5 * max(noise, 0.3), 3, mask=mask)  # of three pixels or more
    if segments is None:
        return None
    objects = SourceCatalog(pixels - level, segments, mask=mask)
    at = np.atleast_2d(objects.centroid)
    unknown = ~is_listed(at, places(greeting, request["telemetry"]))
    if not unknown.any():
        return None
    flux = np.atleast_1d(objects.segment_flux)
    return at[unknown][flux[unknown].argmax()].clip(-0.5, np.array(pixels.shape[::-1]) - 0.5)

warnings.simplefilter("ignore")  # photutils warns of an image without a source
greeting = json.loads(input())
print(json.dumps({"boresight_pipeline": 1, "name": "photutils"}), flush=True)
for line in sys.stdin:
    request = json.loads(line)
    found = target(request)
    answer = {"frame": request["frame"], "status": "no_target" if found is None else "detected"}
    if found is not None:
        answer["x_px"], answer["y_px"] = found.tolist()
    print(json.dumps(answer), flush=True)
