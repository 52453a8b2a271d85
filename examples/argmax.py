"""Minimal pipeline for Boresight: --pipeline "exec:python3 examples/argmax.py"

The target is the brightest pixel. Needs numpy and astropy.
"""
import json, sys
import numpy as np
from astropy.io import fits

json.loads(input())  # the greeting: camera, mounting, star list
print(json.dumps({"boresight_pipeline": 1, "name": "argmax"}), flush=True)
for line in sys.stdin:
    request = json.loads(line)
    pixels = fits.getdata(request["image"])
    y, x = np.unravel_index(pixels.argmax(), pixels.shape)
    print(json.dumps({"frame": request["frame"], "status": "detected", "x_px": int(x), "y_px": int(y)}), flush=True)
