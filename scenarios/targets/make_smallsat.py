#!/usr/bin/env python3
"""Writes smallsat.obj, smallsat.mtl and smallsat.glb beside this file: a small satellite of our own making.

    python3 scenarios/targets/make_smallsat.py

The satellite stands for no real one; dimensions and reflectances are assumed. Body frame, metres: the body is
a box about the origin, the wings along y, the antenna towards +x, the nozzle towards -z. Every part is a closed
shell whose triangles run counter-clockwise as seen from outside; parts may enter each other.
"""

import json
import math
import pathlib
import struct

HERE = pathlib.Path(__file__).resolve().parent

# Diffuse share, specular share, width of the lobe (Ward's alpha): assumed.
MATERIALS = {
    "foil": (0.28, 0.20, 0.25),  # crinkled multi-layer insulation
    "cells": (0.05, 0.12, 0.05),  # solar cells under glass
    "white": (0.70, 0.05, 0.30),  # white paint
    "black": (0.04, 0.04, 0.40),  # black paint
    "metal": (0.10, 0.45, 0.15),  # bare aluminium
}
# Digits of a coordinate, m. Equal corners are equal in the files.
DIGITS = 6


class Mesh:
    def __init__(self):
        self.triangles = []

    def add(self, material, *corners):
        """Adds a convex polygon as a fan."""
        corners = [tuple(round(value, DIGITS) + 0.0 for value in corner) for corner in corners]
        for second, third in zip(corners[1:], corners[2:]):
            if len({corners[0], second, third}) == 3:
                self.triangles.append((material, corners[0], second, third))

    def box(self, centre, size, materials):
        """Adds a box; `materials` are those of the faces +x, -x, +y, -y, +z, -z."""
        for axis in range(3):
            for side, material in ((1, materials[2 * axis]), (-1, materials[2 * axis + 1])):
                corners = []
                for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                    offset = [0.0, 0.0, 0.0]
                    offset[axis] = side
                    offset[(axis + 1) % 3] = u * side
                    offset[(axis + 2) % 3] = v
                    corners.append([c + 0.5 * s * o for c, s, o in zip(centre, size, offset)])
                self.add(material, *corners)

    def revolve(self, base, axis, profile, sides, materials):
        """Adds a body of revolution about an axis of the frame ("+x" or "-z" and the like) through `base`.

        `profile` are pairs of radius and height in the order in which an observer outside, with the axis
        upwards and the body to the left, meets them from below; it closes to the first pair. `materials` are
        those of the bands.
        """
        sign = 1 if axis[0] == "+" else -1
        along = "xyz".index(axis[1])
        u, v = (along + 1) % 3, (along + 2) % 3

        def corner(radius, height, i):
            angle = 2 * math.pi * (i % sides) / sides
            at = list(base)
            at[along] += sign * height
            at[u] += radius * math.cos(angle)
            at[v] += sign * radius * math.sin(angle)
            return at

        for (low, high), material in zip(zip(profile, profile[1:] + profile[:1]), materials):
            for i in range(sides):
                self.add(material, corner(*low, i), corner(*low, i + 1), corner(*high, i + 1), corner(*high, i))


def satellite():
    mesh = Mesh()
    mesh.box((0, 0, 0), (0.60, 0.60, 0.80), ["foil", "foil", "foil", "foil", "white", "foil"])
    for side in (1, -1):
        # Wing of three panels, cells towards +x, and its boom.
        for panel in range(3):
            mesh.box((0.0, side * (0.75 + 0.52 * panel), 0.0), (0.02, 0.50, 0.70), ["cells", "white"] + ["metal"] * 4)
        mesh.box((0.0, side * 0.95, 0.0), (0.016, 1.46, 0.05), ["metal"] * 6)
    # Dish: its front, then the rim and the back, 4 mm thick, on a mast.
    radius, depth, rings = 0.25, 0.09, 5
    front = [(radius * i / rings, 0.16 + depth * (i / rings) ** 2) for i in range(rings, -1, -1)]
    back = [(r, h - 0.004) for r, h in reversed(front)]
    mesh.revolve((0.30, 0.0, 0.12), "+x", back + front, 24, ["black"] * rings + ["metal"] + ["white"] * rings + ["white"])
    mesh.revolve((0.29, 0.0, 0.12), "+x", [(0.0, 0.0), (0.03, 0.0), (0.03, 0.18), (0.0, 0.18)], 12, ["metal"] * 4)
    # Nozzle: outside, rim, inside, closed by a cone at the throat.
    nozzle = [(0.0, 0.0), (0.03, 0.0), (0.09, 0.14), (0.085, 0.14), (0.02, 0.03), (0.0, 0.02)]
    mesh.revolve((0.0, 0.0, -0.39), "-z", nozzle, 16, ["metal", "metal", "metal", "black", "black", "black"])
    # Baffle of a star tracker: a tube with a floor.
    baffle = [(0.0, 0.0), (0.06, 0.0), (0.06, 0.15), (0.055, 0.15), (0.055, 0.02), (0.0, 0.02)]
    mesh.revolve((-0.12, 0.14, 0.39), "+z", baffle, 16, ["black"] * 6)
    # Four rod antennas.
    for x, y in ((0.25, 0.25), (-0.25, 0.25), (0.25, -0.25), (-0.25, -0.25)):
        mesh.revolve((x, y, -0.39), "-z", [(0.0, 0.0), (0.006, 0.0), (0.006, 0.4), (0.0, 0.4)], 6, ["metal"] * 4)
    return mesh


def metallic_roughness(diffuse, specular, alpha):
    """Returns base colour, metalness and roughness of glTF with these reflectances.

    diffuse = 0.96 (1 - m) Y and specular = 0.04 (1 - m) + Y m, where specular rises with m from 0.04.
    """
    low, high = 0.0, 1.0 - 1e-9
    for _ in range(200):
        m = 0.5 * (low + high)
        y = diffuse / (0.96 * (1 - m))
        low, high = (m, high) if 0.04 * (1 - m) + y * m < specular else (low, m)
    return diffuse / (0.96 * (1 - low)), low, math.sqrt(alpha)


def write_obj(mesh):
    numbers = {}
    lines = ["# Written by scenarios/targets/make_smallsat.py. Metres.", "mtllib smallsat.mtl"]
    for _, *corners in mesh.triangles:
        for corner in corners:
            if corner not in numbers:
                numbers[corner] = len(numbers) + 1
                lines.append("v " + " ".join(f"{value:.{DIGITS}f}" for value in corner))
    used = None
    for material, *corners in sorted(mesh.triangles, key=lambda triangle: triangle[0]):
        if material != used:
            lines.append(f"usemtl {material}")
            used = material
        lines.append("f " + " ".join(str(numbers[corner]) for corner in corners))
    (HERE / "smallsat.obj").write_text("\n".join(lines) + "\n")


def write_mtl():
    lines = ["# Written by scenarios/targets/make_smallsat.py. Kd: diffuse share, Ks: specular share, Ns: 2/alpha^2 - 2."]
    for name, (diffuse, specular, alpha) in sorted(MATERIALS.items()):
        lines += ["", f"newmtl {name}", f"Kd {diffuse} {diffuse} {diffuse}", f"Ks {specular} {specular} {specular}"]
        lines += [f"Ns {2 / alpha**2 - 2:.6f}"]
    (HERE / "smallsat.mtl").write_text("\n".join(lines) + "\n")


def write_glb(mesh):
    names = sorted(MATERIALS)
    data, views, accessors, primitives = b"", [], [], []

    def view(content):
        nonlocal data
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(content)})
        data += content + b"\0" * (-len(content) % 4)
        return len(views) - 1

    for index, name in enumerate(names):
        triangles = [corners for material, *corners in mesh.triangles if material == name]
        numbers = {}
        indices = [numbers.setdefault(corner, len(numbers)) for corners in triangles for corner in corners]
        positions = [struct.unpack("<3f", struct.pack("<3f", *corner)) for corner in numbers]
        low, high = ([limit(axis) for axis in zip(*positions)] for limit in (min, max))
        at = {"bufferView": view(b"".join(struct.pack("<3f", *position) for position in positions))}
        accessors.append(at | {"componentType": 5126, "count": len(positions), "type": "VEC3", "min": low, "max": high})
        at = {"bufferView": view(struct.pack(f"<{len(indices)}H", *indices))}
        accessors.append(at | {"componentType": 5123, "count": len(indices), "type": "SCALAR"})
        attributes = {"POSITION": len(accessors) - 2}
        primitives.append({"attributes": attributes, "indices": len(accessors) - 1, "material": index})
    materials = []
    for name in names:
        base, metallic, roughness = (round(value, 9) for value in metallic_roughness(*MATERIALS[name]))
        model = {"baseColorFactor": [base] * 3 + [1.0], "metallicFactor": metallic, "roughnessFactor": roughness}
        materials.append({"name": name, "pbrMetallicRoughness": model})
    document = {
        "asset": {"version": "2.0", "generator": "scenarios/targets/make_smallsat.py"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "smallsat", "mesh": 0}],
        "meshes": [{"name": "smallsat", "primitives": primitives}],
        "materials": materials,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(data)}],
    }
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    (HERE / "smallsat.glb").write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def main():
    mesh = satellite()
    write_obj(mesh)
    write_mtl()
    write_glb(mesh)
    farthest = max(math.hypot(*corner) for _, *corners in mesh.triangles for corner in corners)
    print(f"{len(mesh.triangles)} triangles, farthest corner at {farthest:.4f} m")


if __name__ == "__main__":
    main()
