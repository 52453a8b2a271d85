"""A docking pipeline for Boresight in plain Python: --pipeline "exec:python3 examples/fixed_pose.py"

It measures nothing and always reports that the camera is 10 m in front of the target. It shows the protocol,
with a setting for the digitiser in its first answer.
"""
import json, sys

greeting = json.loads(input())  # cameras, target
assert greeting["world"] == "docking"
print(json.dumps({"boresight_pipeline": 1, "name": "fixed pose"}), flush=True)
first = True
for line in sys.stdin:
    field = json.loads(line)  # field, image, lines, time_s, camera, contrast, brightness
    answer = {"field": field["field"], "status": "measured", "d_m": [0, 0, 10], "phi_deg": [0, 0, 0],
              "sigma_d_m": [0.1, 0.1, 0.1], "sigma_phi_deg": [1, 1, 1]}
    if first:
        answer.update(contrast=1.2, brightness=0.05)
    first = False
    print(json.dumps(answer), flush=True)
