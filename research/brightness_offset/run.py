#!/usr/bin/env python3
"""Computes the offset of the centre of brightness from the centre of mass for a class of targets.

    python3 research/brightness_offset/run.py [--targets 1000] [--seed 1]

The chaser is ahead of or behind the target on a circular orbit, and the target's attitude is fixed in the orbital
frame, so that the offset repeats with every revolution. Half of the targets are Lambert spheres; half are boxes of
three sides whose logarithms are uniform over a factor of 3, with six Lambert faces whose reflectances are log-uniform
from 0.1 to 0.6, in a random attitude. Nothing is measured in the Earth's shadow.

For elevations of the Sun above the plane of the orbit, the program prints root mean squares over the class of the
constant part of the offset, of its first two harmonics of the revolution and of the remainder, along R and N of the
orbit, in half the largest side or the sphere's radius, and the law that `worlds/far_range/navigate/src/knowledge.rs` states.
"""

import argparse
import math
import random

PHASES = 72
EARTH_OVER_ORBIT = 6378.0 / 7130.0
HARMONICS = 2
# The law of worlds/far_range/navigate/src/knowledge.rs.
CONSTANT, CONSTANT_BY_SIN = (0.15, 0.1), (0.0, 0.54)
BY_COS = ((0.47, 0.14, 0.08), (0.24, 0.1, 0.06))
# Weight of the condition that coefficients are of the size of the target: harmonics of an arc are not unique.
RIDGE = 0.01


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    length = math.sqrt(dot(a, a))
    return [x / length for x in a]


def random_axes(source):
    """Three random orthonormal vectors."""
    first = unit([source.gauss(0, 1) for _ in range(3)])
    other = [source.gauss(0, 1) for _ in range(3)]
    second = unit([x - dot(first, other) * y for x, y in zip(other, first)])
    third = [first[1] * second[2] - first[2] * second[1], first[2] * second[0] - first[0] * second[2],
             first[0] * second[1] - first[1] * second[0]]
    return [first, second, third]


def box(source):
    """Offset of a random box as a function of the directions to the Sun and to the chaser."""
    sides = [math.exp(source.uniform(0, math.log(3))) for _ in range(3)]
    half = max(sides) / 2
    axes = random_axes(source)
    faces = []
    for axis in range(3):
        area = sides[(axis + 1) % 3] * sides[(axis + 2) % 3]
        for sign in (1, -1):
            reflectance = math.exp(source.uniform(math.log(0.1), math.log(0.6)))
            normal = [sign * x for x in axes[axis]]
            faces.append((normal, reflectance * area, sides[axis] / 2 / half))

    def offset(sun, view):
        total, moment = 0.0, [0.0, 0.0, 0.0]
        for normal, size, distance in faces:
            flux = size * max(dot(normal, sun), 0.0) * max(dot(normal, view), 0.0)
            total += flux
            moment = [m + flux * distance * n for m, n in zip(moment, normal)]
        return [m / total for m in moment] if total > 0 else None

    return offset


def sphere(_source):
    """Offset of a Lambert sphere: towards the Sun's side of its disk."""

    def offset(sun, view):
        phase = math.acos(max(-1.0, min(1.0, dot(sun, view))))
        across = [s - dot(sun, view) * v for s, v in zip(sun, view)]
        if phase > math.radians(175) or dot(across, across) < 1e-12:
            return None if phase > 1 else [0.0, 0.0, 0.0]
        # Ratio of the first moment of the flux to the flux over the crescent.
        brightness = (math.pi - phase) * math.cos(phase) + math.sin(phase)
        size = 3 * math.pi / 16 * math.sin(phase) * (1 + math.cos(phase)) / brightness
        return [size * x for x in unit(across)]

    return offset


def solve(matrix, right):
    """Solution of linear equations with a positive definite matrix, by elimination."""
    rows = [row[:] + [value] for row, value in zip(matrix, right)]
    for k, pivot in enumerate(rows):
        for row in rows[k + 1:]:
            factor = row[k] / pivot[k]
            row[k:] = [x - factor * y for x, y in zip(row[k:], pivot[k:])]
    solution = [0.0] * len(rows)
    for k in range(len(rows) - 1, -1, -1):
        solution[k] = (rows[k][-1] - dot(rows[k][k + 1:-1], solution[k + 1:])) / rows[k][k]
    return solution


def parts(offset, elevation):
    """Mean squares of the parts along R and N: constant, harmonics, remainder. None if the target is rarely lit."""
    samples = []
    for step in range(PHASES):
        angle = 2 * math.pi * step / PHASES
        sun = [math.cos(elevation) * math.cos(angle), -math.cos(elevation) * math.sin(angle), math.sin(elevation)]
        if sun[0] < -math.sqrt(1 - EARTH_OVER_ORBIT**2):
            continue
        found = offset(sun, [0.0, -1.0, 0.0])
        if found:
            harmonics = [trig(k * angle) for k in range(1, HARMONICS + 1) for trig in (math.cos, math.sin)]
            samples.append(([1.0] + harmonics, found))
    if len(samples) < PHASES / 4:
        return None
    size = 1 + 2 * HARMONICS
    normal = [[sum(row[i] * row[j] for row, _ in samples) + (RIDGE * len(samples) if i == j else 0)
               for j in range(size)] for i in range(size)]
    result = []
    for axis in (0, 2):
        right = [sum(row[i] * found[axis] for row, found in samples) for i in range(size)]
        fit = solve(normal, right)
        rest = sum((found[axis] - dot(row, fit)) ** 2 for row, found in samples) / len(samples)
        of_harmonics = [(fit[2 * k - 1] ** 2 + fit[2 * k] ** 2) / 2 for k in range(1, HARMONICS + 1)]
        result.append([fit[0] ** 2] + of_harmonics + [rest])
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--targets", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    print("elevation: constant, first harmonic, second harmonic, remainder; in brackets those of the law")
    for degrees in (0, 15, 30, 45, 60, 75):
        source = random.Random(arguments.seed)
        elevation = math.radians(degrees)
        found = []
        for shape in (box, sphere):
            of_shape = []
            while len(of_shape) < arguments.targets / 2:
                result = parts(shape(source), elevation)
                if result:
                    of_shape += [result]
            found += of_shape
        for axis, name in enumerate("RN"):
            values = [math.sqrt(sum(column) / len(found)) for column in zip(*(target[axis] for target in found))]
            law = [math.hypot(CONSTANT[axis], CONSTANT_BY_SIN[axis] * math.sin(elevation))]
            law += [factor * math.cos(elevation) for factor in BY_COS[axis]]
            words = (f"{value:.2f} ({stated:.2f})" for value, stated in zip(values, law))
            print(f"{degrees:2}° {name}:", ", ".join(words))


if __name__ == "__main__":
    main()
