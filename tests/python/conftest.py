"""Scenes for the tests of the Python module."""

import os
import pathlib
import subprocess

import numpy as np
import pytest

import exitance as ex

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(os.environ["EXITANCE_PROGRAM"])

VERTICES = np.array(
    [[x, y, z] for z in (0, 2.5) for y in (0, 3) for x in (0, 4)]
    + [[1.5, 1, 2], [2.5, 1, 2], [2.5, 2, 2], [1.5, 2, 2]], dtype=float)
FACES = [[0, 1, 3, 2], [6, 7, 5, 4], [0, 4, 5, 1], [1, 5, 7, 3], [3, 7, 6, 2], [2, 6, 4, 0], [11, 10, 9, 8]]
WALLS = [0.5, 0.4, 0.3]
RADIANCE = 10.0  # of the lamp, W/(m^2 sr)


def small_room(**more):
    """A closed room of 4 x 3 x 2.5 m with a lamp of 1 m^2 that hangs below its ceiling."""
    return ex.Scene(VERTICES, FACES, reflectance=[WALLS] * 6 + [[0, 0, 0]],
                    exitance=[[0.0] * 3] * 6 + [[np.pi * RADIANCE] * 3], **more)


@pytest.fixture
def room():
    return small_room()


@pytest.fixture(scope="session")
def solution():
    return ex.solve(small_room(), error=0.05)


@pytest.fixture
def room_file(tmp_path):
    """The small room as an OBJ file."""
    lines = ["mtllib room.mtl"] + [f"v {x!r} {y!r} {z!r}" for x, y, z in VERTICES.tolist()] + ["usemtl grey"]
    for i, face in enumerate(FACES):
        lines += ["usemtl lamp"] if i == 6 else []
        lines.append("f " + " ".join(str(v + 1) for v in face))
    (tmp_path / "room.obj").write_text("\n".join(lines) + "\n")
    (tmp_path / "room.mtl").write_text(
        f"newmtl grey\nKd {WALLS[0]} {WALLS[1]} {WALLS[2]}\nnewmtl lamp\nKd 0 0 0\nKe {RADIANCE} {RADIANCE} {RADIANCE}\n")
    return tmp_path / "room.obj"


def run_program(*arguments, cwd=None):
    """Runs the program, which must succeed, and returns its output."""
    return subprocess.run([PROGRAM, *map(str, arguments)], check=True, cwd=cwd, capture_output=True, text=True).stdout
