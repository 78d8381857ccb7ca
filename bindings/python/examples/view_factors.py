"""View factors of an enclosure, and the radiative heat between its gray surfaces.

usage: view_factors.py [--quick]
"""

import sys

import numpy as np

import exitance as ex

STEFAN_BOLTZMANN = 5.670374419e-8  # W/(m^2 K^4)


def main() -> None:
    quick = "--quick" in sys.argv
    vertices = [[x, y, z] for z in (0, 2.5) for y in (0, 3) for x in (0, 4)]
    faces = [[0, 1, 3, 2], [6, 7, 5, 4], [0, 4, 5, 1], [1, 5, 7, 3], [3, 7, 6, 2], [2, 6, 4, 0]]
    scene = ex.Scene(vertices, faces)
    F = ex.view_factors(scene, error=1e-2 if quick else 1e-4)
    temperature = np.array([305.0, 293, 293, 285, 293, 293])  # a warm floor and a cold wall, K
    emittance = np.full(6, 0.9)

    # Radiosities of gray surfaces: J = e sigma T^4 + (1 - e) F J.
    emitted = emittance * STEFAN_BOLTZMANN * temperature**4
    J = np.linalg.solve(np.eye(6) - (1 - emittance)[:, None] * F.toarray(), emitted)
    heat = scene.areas * (J - F @ J)
    for name, q in zip(("floor", "ceiling", "south", "east", "north", "west"), heat):
        print(f"{name:8} {q:8.1f} W")
    print(f"sum of rows {F.sum(axis=1).mean():.4f}, balance {heat.sum():.2f} W")


if __name__ == "__main__":
    main()
