"""A pipeline for Boresight in plain Python: python3 docs/examples/brightest.py

Takes for the target the brightest cluster that is within 8 px of a cluster of the previous frame. That works while
the camera follows the target and the stars stream through. It knows no star list, so a hot pixel, or a bright
star in a frame sequence that does not move, fools it. No line of sight is given: it measures in the image only.
"""
import array, json, math, sys

def read_fits(path):  # 16 bits, BZERO 32768: rows of big-endian numbers after header blocks of 2880 bytes
    with open(path, "rb") as file:
        cards = {}
        while "END" not in cards:
            block = file.read(2880).decode("ascii")
            cards |= {block[i:i + 8].strip(): block[i + 10:i + 80].split("/")[0].strip() for i in range(0, len(block), 80)}
        columns, rows = int(cards["NAXIS1"]), int(cards["NAXIS2"])
        pixels = array.array("h", file.read(2 * columns * rows))
    if sys.byteorder == "little":
        pixels.byteswap()
    return columns, [value + 32768 for value in pixels]

def clusters(columns, dn):  # brightness centre and total above the median of each set of connected pixels
    ordered = sorted(dn)
    median = ordered[len(dn) // 2]
    threshold = median + 6 * max(1, median - ordered[len(dn) * 16 // 100])
    left = {i for i, value in enumerate(dn) if value > threshold}
    while left:
        members = [left.pop()]
        for i in members:  # grows while it is walked
            x = i % columns
            for j in (i + dy * columns + dx for dy in (-1, 0, 1) for dx in (-1, 0, 1) if 0 <= x + dx < columns):
                if j in left:
                    left.remove(j)
                    members.append(j)
        total = sum(dn[i] - median for i in members)
        yield (total, sum((dn[i] - median) * (i % columns) for i in members) / total,
               sum((dn[i] - median) * (i // columns) for i in members) / total)

json.loads(input())  # the greeting: camera, mounting, star list
print(json.dumps({"boresight_pipeline": 1, "name": "brightest"}), flush=True)
previous = None
for line in sys.stdin:
    request = json.loads(line)
    found = sorted(clusters(*read_fits(request["image"])), reverse=True)
    near = [c for c in found if any(math.dist(c[1:], p[1:]) < 8 for p in previous or [])]
    answer = {"frame": request["frame"], "status": "no_previous_frame" if previous is None else "no_target"}
    if near:
        answer |= {"status": "detected", "x_px": near[0][1], "y_px": near[0][2]}
    previous = found
    print(json.dumps(answer), flush=True)
