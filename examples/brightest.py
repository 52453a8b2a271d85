"""A pipeline for Boresight in plain Python: --pipeline "exec:python3 examples/brightest.py"

The target is the brightest cluster of two pixels or more that has moved by less than 8 px since the frame
before: right while the camera follows the target and the stars stream through. It measures in the image only.
"""
import array, json, math, sys

def read_fits(path):  # 16 bits; what is stored is the digital number minus 32768, so 0 is -32768
    data = open(path, "rb").read()
    end = next(i for i in range(0, len(data), 80) if data[i:i + 8] == b"END     ")
    card = {data[i:i + 8].strip(): data[i + 10:i + 30] for i in range(0, end, 80)}
    columns, start = int(card[b"NAXIS1"]), (end // 2880 + 1) * 2880
    stored = array.array("h", data[start:start + 2 * columns * int(card[b"NAXIS2"])])
    if sys.byteorder == "little":  # FITS is big-endian
        stored.byteswap()
    return columns, stored

def clusters(columns, stored):  # signal and brightness centre of each set of connected pixels that stand out
    sample = sorted(value for value in stored[::7] if value > -32768) or [0]  # outside transmitted regions there is 0
    median, low = sample[len(sample) // 2], sample[len(sample) * 16 // 100]
    threshold = median + 6 * max(1, median - low)  # six standard deviations
    left = {i for i, value in enumerate(stored) if value > threshold}
    while left:
        members = [left.pop()]
        for i in members:  # grows while it is walked
            beside = [dx for dx in (-1, 0, 1) if 0 <= i % columns + dx < columns]
            near = left.intersection(i + dx + dy for dx in beside for dy in (-columns, 0, columns))
            left -= near
            members += near
        if len(members) > 1:  # a single one is a hot pixel
            weights = [stored[i] - median for i in members]
            moments = (sum(w * (i % columns) for w, i in zip(weights, members)),
                       sum(w * (i // columns) for w, i in zip(weights, members)))
            yield sum(weights), *(moment / sum(weights) for moment in moments)

json.loads(input())  # the greeting: camera, mounting, star list
print(json.dumps({"boresight_pipeline": 1, "name": "brightest"}), flush=True)
previous = None
for line in sys.stdin:
    request = json.loads(line)
    found = list(clusters(*read_fits(request["image"])))
    near = [c for c in found if any(math.dist(c[1:], p[1:]) < 8 for p in previous or [])]
    answer = {"frame": request["frame"], "status": "no_previous_frame" if previous is None else "no_target"}
    if near:
        _, answer["x_px"], answer["y_px"] = max(near)
        answer["status"] = "detected"
    previous = found
    print(json.dumps(answer), flush=True)
