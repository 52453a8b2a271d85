#!/usr/bin/env python3
"""Plans the approach of the scenario `argon`: prints orbit and schedule as TOML, or checks them (--check).

    python3 scenarios/argon_plan.py            # prints [orbit] and [[schedule]], to be put into scenarios/argon.toml
    python3 scenarios/argon_plan.py --check    # prints ranges, field angles, light

The seed paper gives the frame of the ARGON experiment (30 km to 3 km, 23 to 27 April 2012, about 16 km on 25
April 11:30 to 13:00 UTC, a relative orbit that shrinks) and no manoeuvre. Everything else here is assumed.
The plan is flown ground-in-the-loop: at each event the relative elements are computed exactly, and a pair of
impulses half an orbit apart is chosen by linear theory (D'Amico 2010, chapter 2) to meet the next waypoint:
    da   = 2 (dv1 + dv2) / n            sets the drift of lambda, -3/2 n da
    |de| = 2 (dv1 - dv2) / n            along the mean argument of latitude of the first impulse
    |di| = dvn / n                      along the same, given with the first impulse
Both vectors are set along +y: with dix = 0 the chaser's node does not drift away from the target's, and with
de parallel to di the separation across the flight direction never vanishes, so that an unplanned drift past
the target is safe. The turn of de with the perigee (-3 deg a day, 80 m in the end) is left alone.

It is a second implementation of the simulator's orbits, in another language: the simulator's tests compare
the two.
"""

import math
import sys
from datetime import datetime, timedelta, timezone

GM, RE, J2 = 398600.4415, 6378.1363, 1.0826266835e-3  # EGM96, as in sim/truth/src/orbit.rs
EPOCH = datetime(2012, 4, 23, tzinfo=timezone.utc)
DAY = 86400.0

# PRISMA's orbit, assumed: near-circular, 750 km high, Sun-synchronous, northbound in the evening.
A_KM, ECC, INC_DEG, LTAN_H = 7130.0, 0.003, 98.28, 18.0 + 10.0 / 60.0
ARGP_DEG, M_DEG = 90.0, 270.0

# Relative elements at the epoch, m.
LAMBDA0, DE0, DI0 = -30000.0, 400.0, 400.0

# Event time (UTC, not before), waypoint of lambda at the next event's time, |de| and |di| after the event
# (m). The chaser rests at 30 km until the first event. DI None: no normal impulse.
EVENTS = [
    (datetime(2012, 4, 23, 8, 0), -27000.0, 385.0, None),
    (datetime(2012, 4, 24, 0, 0), -20000.0, 350.0, 350.0),
    (datetime(2012, 4, 25, 0, 0), -13600.0, 310.0, 300.0),
    (datetime(2012, 4, 25, 22, 0), -7000.0, 265.0, 250.0),
    (datetime(2012, 4, 27, 0, 0), -3000.0, 225.0, 210.0),
]
END = datetime(2012, 4, 28, 0, 0)

# Images: the counts are the paper's (Table 2), hours and cadence are assumed. One cadence for all days; 15 s
# fits the 5415 images of day 4 into a day. Day 3 is shifted by 6 s so that its image 1516 is at 12:18:54, the
# time of the sample image in the paper.
CADENCE_S = 15.0
DAYS = [
    ("day 1", "2012-04-23T07:00:00", 1634),
    ("day 2", "2012-04-24T06:00:00", 2978),
    ("day 3", "2012-04-25T05:59:54", 3319),
    ("day 4", "2012-04-26T00:30:00", 5415),
    ("day 5", "2012-04-27T12:00:00", 2731),
]


def seconds(utc):
    return (utc.replace(tzinfo=timezone.utc) - EPOCH).total_seconds()  # no leap second in these days


def wrap(x):
    return math.remainder(x, 2.0 * math.pi)


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    norm = math.sqrt(dot(a, a))
    return tuple(p / norm for p in a)


def drifted(el, dt):
    """Elements (a, e, i, raan, argp, m) dt seconds later, with the secular rates of J2."""
    a, e, i, raan, argp, m = el
    n = math.sqrt(GM / a**3)
    gamma = 1.5 * J2 * (RE / (a * (1 - e * e))) ** 2 * n
    return (
        a, e, i,
        raan - gamma * math.cos(i) * dt,
        argp + 0.5 * gamma * (5 * math.cos(i) ** 2 - 1) * dt,
        m + (n + 0.5 * gamma * math.sqrt(1 - e * e) * (3 * math.cos(i) ** 2 - 1)) * dt,
    )


def state(el):
    """Position (km) and velocity (km/s) from the true anomaly, a method that differs from the simulator's."""
    a, e, i, raan, argp, m = el
    anomaly = m
    for _ in range(50):
        anomaly = m + e * math.sin(anomaly)  # fixed point: e is small
    nu = 2 * math.atan2(math.sqrt(1 + e) * math.sin(anomaly / 2), math.sqrt(1 - e) * math.cos(anomaly / 2))
    p = a * (1 - e * e)
    r = p / (1 + e * math.cos(nu))
    u = argp + nu

    def plane(x, y):
        return (
            x * math.cos(raan) - y * math.cos(i) * math.sin(raan),
            x * math.sin(raan) + y * math.cos(i) * math.cos(raan),
            y * math.sin(i),
        )

    k = math.sqrt(GM / p)
    position = plane(r * math.cos(u), r * math.sin(u))
    velocity = plane(-k * (math.sin(u) + e * math.sin(argp)), k * (math.cos(u) + e * math.cos(argp)))
    return position, velocity


def elements(r, v):
    h = cross(r, v)
    w = unit(h)
    distance = math.sqrt(dot(r, r))
    a = 1 / (2 / distance - dot(v, v) / GM)
    i = math.acos(w[2])
    raan = math.atan2(w[0], -w[1])
    node = (math.cos(raan), math.sin(raan), 0.0)
    ev = tuple(c / GM - x / distance for c, x in zip(cross(v, h), r))
    e = math.sqrt(dot(ev, ev))
    argp = math.atan2(dot(ev, cross(w, node)), dot(ev, node))
    u = math.atan2(dot(r, cross(w, node)), dot(r, node))
    nu = u - argp
    anomaly = 2 * math.atan2(math.sqrt(1 - e) * math.sin(nu / 2), math.sqrt(1 + e) * math.cos(nu / 2))
    return (a, e, i, raan, argp, anomaly - e * math.sin(anomaly))


def rtn(el):
    r, v = state(el)
    radial, normal = unit(r), unit(cross(r, v))
    return radial, cross(normal, radial), normal


def kicked(el, dv_rtn):
    r, v = state(el)
    axes = rtn(el)
    v = tuple(v[k] + sum(dv_rtn[j] * 1e-3 * axes[j][k] for j in range(3)) for k in range(3))
    return elements(r, v)


def roe(chaser, target):
    """(da, dlambda, dex, dey, dix, diy) times a, m."""
    a, e, i, raan, argp, m = target
    am = a * 1000.0
    d_raan = wrap(chaser[3] - raan)
    d_u = wrap(chaser[4] + chaser[5] - argp - m)
    return (
        (chaser[0] - a) * 1000.0,
        am * (d_u + d_raan * math.cos(i)),
        am * (chaser[1] * math.cos(chaser[4]) - e * math.cos(argp)),
        am * (chaser[1] * math.sin(chaser[4]) - e * math.sin(argp)),
        am * (chaser[2] - i),
        am * d_raan * math.sin(i),
    )


def from_roe(rel, target):
    a, e, i, raan, argp, m = target
    am = a * 1000.0
    d_raan = rel[5] / am / math.sin(i)
    ex, ey = e * math.cos(argp) + rel[2] / am, e * math.sin(argp) + rel[3] / am
    u = argp + m + rel[1] / am - d_raan * math.cos(i)
    w = math.atan2(ey, ex)
    return (a + rel[0] / 1000.0, math.hypot(ex, ey), i + rel[4] / am, raan + d_raan, w, u - w)


def mean_sun_ra(t):
    """Right ascension of the mean Sun, rad: its mean longitude (Astronomical Almanac, page C5)."""
    days = (EPOCH - datetime(2000, 1, 1, 12, tzinfo=timezone.utc)).total_seconds() / DAY + t / DAY
    return math.radians(280.460 + 0.9856474 * days)


def sun(t):
    """Unit vector to the Sun, good to 0.01 degrees (Astronomical Almanac, page C5)."""
    days = (EPOCH - datetime(2000, 1, 1, 12, tzinfo=timezone.utc)).total_seconds() / DAY + t / DAY
    g = math.radians(357.528 + 0.9856003 * days)
    longitude = math.radians(280.460 + 0.9856474 * days + 1.915 * math.sin(g) + 0.020 * math.sin(2 * g))
    tilt = math.radians(23.439)
    return (math.cos(longitude), math.cos(tilt) * math.sin(longitude), math.sin(tilt) * math.sin(longitude))


def target_at_epoch():
    raan_deg = round(math.degrees(mean_sun_ra(2.5 * DAY)) % 360.0 + 15.0 * (LTAN_H - 12.0), 1) % 360.0
    return raan_deg, (A_KM, ECC, *map(math.radians, (INC_DEG, raan_deg, ARGP_DEG, M_DEG)))


def plan():
    """Target, and the chaser's arcs [(start, elements)], and the manoeuvres [(time, (r, t, n) in m/s)]."""
    _, target = target_at_epoch()
    n = math.sqrt(GM / A_KM**3)
    period = 2 * math.pi / n
    arcs = [(0.0, from_roe((0.0, LAMBDA0, 0.0, DE0, 0.0, DI0), target))]
    manoeuvres = []

    def relative(t):
        start, chaser = arcs[-1]
        return roe(drifted(chaser, t - start), drifted(target, t))

    def fly(t, dv):
        dv = tuple(round(x, 5) for x in dv)
        start, chaser = arcs[-1]
        arcs.append((t, kicked(drifted(chaser, t - start), dv)))
        manoeuvres.append((t, dv))

    for k, (utc, waypoint, de, di) in enumerate(EVENTS):
        not_before = seconds(utc)
        # The first time at or after which the mean argument of latitude is +-90 degrees.
        u = sum(drifted(target, not_before)[4:6])
        t1 = round(not_before + ((math.pi / 2 - u) % math.pi) / n)
        t2 = round(t1 + period / 2)
        t_next = seconds(EVENTS[k + 1][0]) if k + 1 < len(EVENTS) else seconds(END)
        sign = math.sin(sum(drifted(target, t1)[4:6]))  # +1 at the northernmost point, -1 at the southernmost

        now = relative(t1)
        total = -now[0]  # of da: from what it is to what it must be; refined below
        rounds = 4
        for attempt in range(rounds):
            split = sign * (de - now[3])
            dv1, dv2 = n / 4 * (total + split), n / 4 * (total - split)
            dvn = sign * n * (di - now[5]) if di is not None else 0.0
            kept = len(arcs), len(manoeuvres)
            fly(t1, (0.0, dv1, dvn))
            fly(t2, (0.0, dv2, 0.0))
            miss = waypoint - relative(t_next)[1]
            total -= miss / (1.5 * n * (t_next - (t1 + t2) / 2))
            if attempt < rounds - 1:
                del arcs[kept[0]:], manoeuvres[kept[1]:]
    return target, arcs, manoeuvres


def chaser_at(arcs, t):
    start, el = max((arc for arc in arcs if arc[0] <= t), key=lambda arc: arc[0])
    return drifted(el, t - start)


def stamp(t):
    return (EPOCH + timedelta(seconds=t)).strftime("%Y-%m-%dT%H:%M:%SZ")


def toml():
    raan_deg, _ = target_at_epoch()
    _, _, manoeuvres = plan()
    ltan = f"{int(LTAN_H)}:{round(LTAN_H % 1 * 60):02d}"
    lines = [
        "# Written by scenarios/argon_plan.py; assumed, not ARGON's own orbit or manoeuvres.",
        "[orbit]",
        f'epoch_utc = "{stamp(0.0)}"',
        "",
        f"# Dawn-dusk: ascending node at {ltan} local mean solar time; no eclipse in these days.",
        "[orbit.target]",
        f"semi_major_axis_km = {A_KM}",
        f"eccentricity = {ECC}",
        f"inclination_deg = {INC_DEG}",
        f"raan_deg = {raan_deg}",
        f"argument_of_perigee_deg = {ARGP_DEG}",
        f"mean_anomaly_deg = {M_DEG}",
        "",
        "# The chaser is 30 km behind, on a relative orbit with parallel eccentricity and inclination vectors.",
        "[orbit.relative]",
        "a_da_m = 0.0",
        f"a_dlambda_m = {LAMBDA0}",
        "a_dex_m = 0.0",
        f"a_dey_m = {DE0}",
        "a_dix_m = 0.0",
        f"a_diy_m = {DI0}",
    ]
    for t, dv in manoeuvres:
        components = ", ".join(f"{x + 0.0:.5f}" for x in dv)  # + 0.0 turns -0.0 into 0.0
        lines += ["", "[[orbit.manoeuvres]]", f'time_utc = "{stamp(t)}"', f"dv_rtn_m_s = [{components}]"]
    lines += ["", "# Counts from the paper; hours and cadence assumed."]
    for name, start, count in DAYS:
        lines += ["[[schedule]]", f'name = "{name}"', f'start_utc = "{start}Z"', f"cadence_s = {CADENCE_S}",
                  f"count = {count}", ""]
    return "\n".join(lines).rstrip()


def check():
    target, arcs, manoeuvres = plan()
    total = sum(math.sqrt(dot(dv, dv)) for _, dv in manoeuvres)
    print(f"{len(manoeuvres)} manoeuvres, {total * 100:.1f} cm/s in total")
    print("UTC                     range_m       da   dlambda   dex   dey   dix   diy")
    for hours in range(0, 121, 6):
        t = hours * 3600.0
        tgt, chs = drifted(target, t), chaser_at(arcs, t)
        gap = math.dist(state(chs)[0], state(tgt)[0]) * 1000.0
        print(stamp(t), f"{gap:11.4f}", " ".join(f"{x:8.1f}" for x in roe(chs, tgt)))

    # Angles of the target off T, seen from the chaser: columns along R, rows along N; and the shadow.
    widest, shadowed, phases, beta = {}, 0, [], []
    for k in range(0, int(5 * DAY), 60):
        tgt, chs = drifted(target, k), chaser_at(arcs, float(k))
        r = state(tgt)[0]
        los = tuple(p - q for p, q in zip(r, state(chs)[0]))
        axes = rtn(chs)
        seen = [dot(los, axis) for axis in axes]
        day = int(k // DAY) + 1
        angles = [math.degrees(math.atan2(abs(seen[j]), seen[1])) for j in (0, 2)]
        widest[day] = [max(p, q) for p, q in zip(widest.get(day, (0, 0)), angles)]
        s = sun(k)
        along = dot(r, s)
        shadowed += along < 0 and math.sqrt(dot(r, r) - along**2) < RE + 30.0  # 30 km: more than the penumbra's rim
        phases.append(math.degrees(math.acos(-dot(unit(los), s))))
        beta.append(math.degrees(math.asin(dot(s, axes[2]))))
    for day, (across, up) in widest.items():
        print(f"day {day}: target at most {across:.2f} deg off along columns, {up:.2f} deg along rows (field 9.1, 6.8)")
    for name, start, count in DAYS:
        first = seconds(datetime.fromisoformat(start))
        last = first + (count - 1) * CADENCE_S
        ends = [-roe(chaser_at(arcs, t), drifted(target, t))[1] / 1000.0 for t in (first, last)]
        print(f"{name}: {stamp(first)} to {stamp(last)}, {ends[0]:.1f} to {ends[1]:.1f} km")
    print(f"minutes in shadow: {shadowed}; beta {min(beta):.1f} to {max(beta):.1f} deg (eclipses below 63.5)")
    print(f"phase angle {min(phases):.0f} to {max(phases):.0f} deg")


if __name__ == "__main__":
    if sys.argv[1:] == ["--check"]:
        check()
    elif not sys.argv[1:]:
        print(toml())
    else:
        sys.exit(__doc__)
