"""Illuminance of the desks of an office that is made of NumPy arrays. Draws office.png if matplotlib is installed.

usage: office.py [--quick]
"""

import importlib
import sys

import numpy as np

import exitance as ex

WIDTH, DEPTH, HEIGHT = 6.0, 4.0, 2.8  # metres


def rectangle(corner: list[float], u: list[float], v: list[float]) -> list[list[float]]:
    """Corners of a rectangle that faces along u x v."""
    c, a, b = np.array(corner), np.array(u), np.array(v)
    return [list(p) for p in (c, c + a, c + a + b, c + b)]


def make_office() -> ex.Scene:
    """A closed room with four luminaires of 0.6 x 0.6 m below its ceiling and a table."""
    floor, ceiling, wall, table, lamp = range(5)
    parts = [
        (rectangle([0, 0, 0], [WIDTH, 0, 0], [0, DEPTH, 0]), floor),
        (rectangle([0, 0, HEIGHT], [0, DEPTH, 0], [WIDTH, 0, 0]), ceiling),
        (rectangle([0, 0, 0], [0, 0, HEIGHT], [WIDTH, 0, 0]), wall),
        (rectangle([WIDTH, 0, 0], [0, 0, HEIGHT], [0, DEPTH, 0]), wall),
        (rectangle([WIDTH, DEPTH, 0], [0, 0, HEIGHT], [-WIDTH, 0, 0]), wall),
        (rectangle([0, DEPTH, 0], [0, 0, HEIGHT], [0, -DEPTH, 0]), wall),
        (rectangle([2, 1.2, 0.74], [1.6, 0, 0], [0, 0.8, 0]), table),
        (rectangle([2, 1.2, 0.72], [0, 0.8, 0], [1.6, 0, 0]), table),
    ]
    for x in (1.2, 4.2):
        for y in (0.7, 2.7):
            parts.append((rectangle([x, y, HEIGHT - 0.05], [0, 0.6, 0], [0.6, 0, 0]), lamp))
    vertices = [p for corners, _ in parts for p in corners]
    faces = np.arange(len(vertices)).reshape(-1, 4)
    # Lamps of 3,600 lm each.
    return ex.Scene(vertices, faces, material=[m for _, m in parts],
                    reflectance=[[0.2], [0.8], [0.5], [0.4], [0.0]], exitance=[[0.0]] * 4 + [[3600 / 0.36]],
                    names=["floor", "ceiling", "wall", "table", "lamp"], photometric=True)


def main() -> None:
    quick = "--quick" in sys.argv
    solution = ex.solve(make_office(), error=0.1 if quick else 0.02)
    x, y = np.meshgrid(np.linspace(0.5, WIDTH - 0.5, 21), np.linspace(0.5, DEPTH - 0.5, 13))
    points = np.stack([x, y, np.full_like(x, 0.75)], axis=-1)
    E = solution.irradiance(points.reshape(-1, 3), [0, 0, 1]).mean(axis=1).reshape(x.shape)
    print(solution)
    print(f"illuminance at 0.75 m: mean {E.mean():.0f} lx, least {E.min():.0f} lx, uniformity {E.min() / E.mean():.2f}")
    try:
        plt = importlib.import_module("matplotlib.pyplot")
    except ImportError:
        return
    contours = plt.contourf(x, y, E, 12)
    plt.colorbar(contours, label="lx")
    plt.gca().set_aspect("equal")
    plt.savefig("office.png")


if __name__ == "__main__":
    main()
