"""A navigator for Boresight in plain Python: --navigator "exec:python3 examples/prior_orbit.py"

It answers with the prior, moved along its orbit and through the manoeuvres, and uses no line of sight: the
error that a navigator must reduce. Equations of D'Amico (2010), chapter 2, without J2.
"""
import json, math, sys
from datetime import datetime

GM, IDENTITY = 3.986004415e14, [[float(i == j) for j in range(6)] for i in range(6)]

def seconds(text):  # "2012-04-25T00:00:00.000000000Z"
    return datetime.fromisoformat(text[:26] + "+00:00").timestamp()

def product(a, b):
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]

def orbit(setup):  # rate of the argument of latitude, and its value at the epoch
    if "chaser_mean_elements" in setup:
        mean = setup["chaser_mean_elements"]
        angle = math.radians(mean["argument_of_perigee_deg"] + mean["mean_anomaly_deg"])
        return math.sqrt(GM / (mean["semi_major_axis_km"] * 1e3) ** 3), angle
    first = setup["chaser_states"][0]
    r, v = ([1e3 * x for x in first[key]] for key in ("position_km", "velocity_km_s"))
    h = [r[i - 2] * v[i - 1] - r[i - 1] * v[i - 2] for i in range(3)]
    size = math.hypot(*r)
    axis = 1 / (2 / size - math.hypot(*v) ** 2 / GM)
    sin = r[2] * math.hypot(*h) / math.hypot(h[0], h[1])
    cos = (r[1] * h[0] - r[0] * h[1]) / math.hypot(h[0], h[1])
    rate = math.sqrt(GM / axis ** 3)
    return rate, math.atan2(sin, cos) + rate * (seconds(setup["epoch_utc"]) - seconds(first["time_utc"]))

def drift(rate, time_s):  # a δa moves a δλ
    matrix = [row[:] for row in IDENTITY]
    matrix[1][0] = -1.5 * rate * time_s
    return matrix

def state(rate, u):  # from elements to position and velocity along R, T, N
    s, c = math.sin(u), math.cos(u)
    return [[1, 0, -c, -s, 0, 0], [0, 1, 2 * s, -2 * c, 0, 0], [0, 0, 0, 0, s, -c],
            [0, 0, rate * s, -rate * c, 0, 0], [-1.5 * rate, 0, 2 * rate * c, 2 * rate * s, 0, 0],
            [0, 0, 0, 0, rate * c, rate * s]]

def impulse(rate, u, dv):  # change of the elements
    s, c = math.sin(u), math.cos(u)
    r, t, n = (x / rate for x in dv)
    return [2 * t, -2 * r, s * r + 2 * c * t, -c * r + 2 * s * t, c * n, s * n]

def estimate(setup, manoeuvres, time):
    if "prior" not in setup:
        return {"no_estimate": "no_initial_orbit"}
    epoch = seconds(setup["epoch_utc"])
    rate, u = orbit(setup)
    after = seconds(time) - epoch
    move = drift(rate, after)
    elements = [row[0] for row in product(move, [[x] for x in setup["prior"]["elements_m"]])]
    for manoeuvre in manoeuvres:
        at = seconds(manoeuvre["time_utc"]) - epoch
        if at <= after:
            change = impulse(rate, u + rate * at, manoeuvre["dv_rtn_m_s"])
            moved = product(drift(rate, after - at), [[x] for x in change])
            elements = [a + b[0] for a, b in zip(elements, moved)]
    covariance = product(product(move, setup["prior"]["covariance"]), list(zip(*move)))
    to_state = state(rate, u + rate * after)
    position = [row[0] for row in product(to_state, [[x] for x in elements])]
    in_rtn = product(product(to_state, covariance), list(zip(*to_state)))
    in_rtn = [[(in_rtn[i][j] + in_rtn[j][i]) / 2 for j in range(6)] for i in range(6)]
    position[0] -= position[1] ** 2 / 2 * (rate ** 2 / GM) ** (1 / 3)  # the orbit is curved
    return {"position_rtn_m": position[:3], "velocity_rtn_m_s": position[3:], "covariance": in_rtn,
            "elements_m": elements, "elements_covariance": covariance}

setup = json.loads(input())["setup"]
print(json.dumps({"boresight_navigator": 1, "name": "prior", "mode": "sequential"}), flush=True)
manoeuvres = []
for line in sys.stdin:
    (kind, content), = json.loads(line).items()
    if kind == "manoeuvre":
        manoeuvres.append(content)
    elif kind == "estimate":  # a request is answered by one line
        print(json.dumps({"estimates": [estimate(setup, manoeuvres, time) for time in content]}), flush=True)
