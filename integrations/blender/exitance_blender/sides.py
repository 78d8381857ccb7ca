"""Fronts of faces. Blender shows both sides of a face; exitance bakes the front. Needs no Blender."""
from __future__ import annotations

import numpy as np


def parts(triangles: np.ndarray) -> np.ndarray:
    """Returns for each triangle (n, 3) of point indices the number of its connected part: the least point index in it."""
    points, inverse = np.unique(triangles, return_inverse=True)
    corners = inverse.reshape(-1, 3)
    label = np.arange(len(points))
    while True:
        least = label[corners].min(axis=1)
        following = label.copy()
        for corner in range(3):
            np.minimum.at(following, corners[:, corner], least)
        following = following[following]  # jumps over whole chains, so that few rounds are needed
        if np.array_equal(following, label):
            return label[corners[:, 0]]
        label = following


def winding_number(corners: np.ndarray, eye: np.ndarray) -> float:
    """Returns how often triangles (n, 3, 3) enclose a point: 1 inside of a body whose fronts are outside, 0 beyond it.

    It is the sum of signed solid angles over 4 pi (van Oosterom and Strackee), so a hole changes it by its share of all
    directions.
    """
    a, b, c = (corners[:, i] - eye for i in range(3))
    la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
    triple = np.einsum("ij,ij->i", a, np.cross(b, c))
    dots = (la * lb * lc + np.einsum("ij,ij->i", a, b) * lc + np.einsum("ij,ij->i", b, c) * la +
            np.einsum("ij,ij->i", c, a) * lb)
    return float(np.arctan2(triple, dots).sum() / (2 * np.pi))


def faces_to_turn(points: np.ndarray, triangles: np.ndarray, eyes: np.ndarray) -> np.ndarray:
    """Returns for each triangle whether its front must be its other side: true in parts around an eye that look outward.

    points  (p, 3)   triangles  (n, 3), indices of points   eyes  (m, 3), places of cameras and lamps
    A room is such a part. One with windows counts while they fill less than half of all directions of an eye.
    """
    turn = np.zeros(len(triangles), dtype=bool)
    if len(triangles) == 0 or len(eyes) == 0:
        return turn
    part = parts(triangles)
    for number in np.unique(part):
        members = part == number
        corners = points[triangles[members]]
        low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
        inside = eyes[np.all((eyes > low) & (eyes < high), axis=1)]
        turn[members] = any(winding_number(corners, eye) > 0.5 for eye in inside)
    return turn
