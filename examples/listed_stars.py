"""Positions of the listed stars in a frame, for the examples with SEP and photutils, which exclude stars."""
import numpy as np

def rotated(quaternion, vectors):  # v_b = q v_a q*, Hamilton, scalar first
    w, axis = quaternion[0], np.array(quaternion[1:])
    return vectors + 2 * np.cross(axis, np.cross(axis, vectors) + w * vectors)

def places(greeting, telemetry):  # x and y of the stars ahead, px, by the measured attitude and the nominal mounting
    camera = greeting["camera"]
    stars = np.array([star["icrs"] for star in greeting["stars"]]).reshape(-1, 3)
    x, y, z = rotated(greeting["q_cam_sc"], rotated(telemetry["q_sc_j2000"], stars)).T
    ahead = z > 0.5
    u = x[ahead] / z[ahead] * camera["focal_length_mm"] * 1e3 / camera["pixel_width_um"]
    v = y[ahead] / z[ahead] * camera["focal_length_mm"] * 1e3 / camera["pixel_height_um"]
    radial = 1 + sum(k * (u**2 + v**2) ** (i + 1) for i, k in enumerate(camera["radial"]))
    return np.column_stack([camera["principal_x_px"] + u * radial, camera["principal_y_px"] + v * radial])

def is_listed(positions, stars, reach_px=5):  # attitude and mounting are some arc minutes off
    apart = np.hypot(*(positions[:, None] - stars[None]).T)
    return (apart < reach_px).any(axis=0)

def transmitted(windows, shape):  # outside the regions of interest pixels are 0 and mean nothing
    inside = np.zeros(shape, bool)
    for x, y, columns, rows in [(0, 0, shape[1], shape[0])] if windows is None else windows:
        inside[y:y + rows, x:x + columns] = True
    return inside
