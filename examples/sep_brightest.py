"""A pipeline for Boresight with SEP: --pipeline "exec:python3 examples/sep_brightest.py"

Subtracts the median, detects objects above five sigmas, and takes the brightest away from listed stars, at
its windowed centre. Needs numpy, astropy and sep.
"""
import json, sys
import numpy as np, sep
from astropy.io import fits
from listed_stars import is_listed, places, transmitted

def target(request):
    pixels = fits.getdata(request["image"]).astype(float)
    mask = ~transmitted(request["windows"], pixels.shape)
    if mask.all():
        return None
    signal = pixels - np.median(pixels[~mask])  # sep.Background needs whole images
    noise = max(1.4826 * np.median(np.abs(signal[~mask])), 0.3)  # rounding to whole numbers alone has 0.3
    objects = sep.extract(signal, 5, err=noise, mask=mask, minarea=3)
    x, y, _ = sep.winpos(signal, objects["x"], objects["y"], np.full(len(objects), 1.2), mask=mask)
    at = np.column_stack([x, y])
    unknown = ~is_listed(at, places(greeting, request["telemetry"]))
    if not unknown.any():
        return None
    return at[unknown][objects["flux"][unknown].argmax()].clip(-0.5, np.array(pixels.shape[::-1]) - 0.5)

sep.set_extract_pixstack(10**6)
greeting = json.loads(input())
print(json.dumps({"boresight_pipeline": 1, "name": "sep"}), flush=True)
for line in sys.stdin:
    request = json.loads(line)
    found = target(request)
    answer = {"frame": request["frame"], "status": "no_target" if found is None else "detected"}
    if found is not None:
        answer["x_px"], answer["y_px"] = found.tolist()
    print(json.dumps(answer), flush=True)
