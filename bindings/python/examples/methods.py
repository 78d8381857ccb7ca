"""Compares methods by the light that they find at random points of a room, against a much more accurate solve.

usage: methods.py [--quick]
"""

import sys

import numpy as np

import exitance as ex


def make_room() -> ex.Scene:
    """A closed cube of 1 m whose ceiling emits."""
    vertices = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    faces = [[0, 1, 3, 2], [6, 7, 5, 4], [0, 4, 5, 1], [1, 5, 7, 3], [3, 7, 6, 2], [2, 6, 4, 0]]
    return ex.Scene(vertices, faces, reflectance=0.5, exitance=[[0.0], [1.0], [0.0], [0.0], [0.0], [0.0]])


def main() -> None:
    quick = "--quick" in sys.argv
    scene = make_room()
    points = np.random.default_rng(1).uniform([0, 0, 0], [1, 1, 0], (100, 3))
    reference = ex.solve(scene, error=0.02 if quick else 0.002).irradiance(points, [0, 0, 1])
    for method in ("matrix", "hierarchical", "wavelet", "progressive", "monte-carlo"):
        solution = ex.solve(scene, error=0.1 if quick else 0.02, method=method)
        E = solution.irradiance(points, [0, 0, 1])
        error = np.sqrt(((E - reference) ** 2).mean()) / reference.mean()
        seconds = solution.stats["seconds"]["total"]
        print(f"{method:14} error {error:.4f}, estimate {solution.error:.4f}, {seconds:.2f} s")


if __name__ == "__main__":
    main()
