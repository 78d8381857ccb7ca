"""Lamps of the Blender add-on against closed forms: the exported scene is solved by the program and probed."""
import csv
import io
import math
import subprocess

import numpy as np
import pytest
from conftest import PROGRAM
from exitance_blender import commands, lamps, units
from exitance_blender.model import Model, write_distant_light, write_glb

POWER = (100.0, 50.0, 20.0)
EXACT = 1e-3  # closed forms of direct light are within 1e-3 of skies, and exact otherwise; coordinates are floats


def probe(folder, model, points):
    """Returns the irradiance (points, 3) at points (x, y, z, nx, ny, nz) of a solved model."""
    write_glb(model, folder / "scene.glb")
    scene = [folder / "scene.glb"]
    if model.suns or max(model.world) > 0:
        write_distant_light(model, folder / "distant.rad")
        scene.append(folder / "distant.rad")
    options = commands.SolveOptions(error=0.05, sky=model.sky)
    subprocess.run(commands.solve_command(PROGRAM, scene, folder / "s.h5", options), check=True, capture_output=True)
    rows = "x,y,z,nx,ny,nz\n" + "".join(",".join(map(str, p)) + "\n" for p in points)
    (folder / "p.csv").write_text(rows)
    out = subprocess.run([PROGRAM, "probe", folder / "s.h5", "--points", folder / "p.csv", "-q", "--exact"], check=True,
                         capture_output=True, text=True).stdout
    return np.array([[float(row[f"E_{c}"]) for c in "rgb"] for row in csv.DictReader(io.StringIO(out))])


def test_a_point_lamp(tmp_path, floor):
    model = Model([floor(4)])
    lamps.add_point(model, "lamp", POWER, np.array([0, 0, 2.0]), 0)
    E = probe(tmp_path, model, [(0, 0, 0, 0, 0, 1), (1, 0, 0, 0, 0, 1)])
    assert E[0] == pytest.approx(np.array(POWER) / (4 * math.pi * 4), rel=EXACT)
    assert E[1] == pytest.approx(np.array(POWER) / (4 * math.pi) * 2 / 5**1.5, rel=EXACT)


def test_a_spherical_lamp(tmp_path, floor):
    """A diffuse sphere gives the light of a point outside of it; 80 faces are within 1% of that in all directions."""
    model = Model([floor(4)])
    lamps.add_point(model, "lamp", POWER, np.array([0, 0, 1.0]), 0.2)
    for x in (0, 0.5, 1.5):
        E = probe(tmp_path, model, [(x, 0, 0, 0, 0, 1)])
        assert E[0] == pytest.approx(np.array(POWER) / (4 * math.pi) / (1 + x * x)**1.5, rel=0.01)


def test_a_spot_lamp(tmp_path, floor):
    """On the axis the light is that of the point lamp, outside of the cone there is none; the axis is oblique."""
    model = Model([floor(40)])
    axis = np.array([0.6, 0, -0.8])
    lamps.add_spot(model, "spot", POWER, np.array([0, 0, 2.0]), axis, math.radians(40), 0.2)
    E = probe(tmp_path, model, [(1.5, 0, 0, 0, 0, 1), (0, 0, 0, 0, 0, 1), (5, 0, 0, 0, 0, 1)])
    assert E[0] == pytest.approx(np.array(POWER) / (4 * math.pi) * 0.8 / 2.5**2, rel=EXACT)
    assert np.all(E[1:] == 0)


@pytest.mark.parametrize("angle", [0, math.radians(0.526), math.radians(10)])
def test_a_sun(tmp_path, floor, angle):
    """Strength is the irradiance of a plane that faces the sun, so that of the ground has the cosine of its height."""
    model = Model([floor(4)])
    lamps.add_sun(model, "sun", (5, 4, 3), np.array([0.6, 0, -0.8]), angle)
    E = probe(tmp_path, model, [(0, 0, 0, 0, 0, 1), (0, 0, 0, 0.6, 0, 0.8), (0, 0, 0, -0.6, 0, 0.8)])
    assert E[0] == pytest.approx(np.array([4, 3.2, 2.4]), rel=EXACT)
    assert E[2] == pytest.approx(np.array([5, 4, 3]), rel=EXACT)


def corner_factor(a, b):
    """View factor from a point to a parallel rectangle a by b (in units of its distance) with a corner on the normal."""
    p, q = math.hypot(1, a), math.hypot(1, b)
    return (a / p * math.atan(b / p) + b / q * math.atan(a / q)) / (2 * math.pi)


def test_an_area_lamp(tmp_path, floor):
    model = Model([floor(4)])
    to_world = np.diag([2.0, 1, 1, 1])
    to_world[:3, 3] = 0, 0, 1.5
    lamps.add_area(model, "panel", POWER, to_world, 0.6, 0.8, False)
    E = probe(tmp_path, model, [(0, 0, 0, 0, 0, 1)])
    factor = 4 * corner_factor(0.6 / 1.5, 0.4 / 1.5)
    assert E[0] == pytest.approx(np.array(POWER) * math.pi / 4 / (1.2 * 0.8) * factor, rel=EXACT)


def test_a_round_area_lamp(tmp_path, floor):
    """The view factor of a disc of radius r at a distance h is r^2 / (r^2 + h^2); that of the 32-gon is within 1e-3."""
    model = Model([floor(4)])
    to_world = np.eye(4)
    to_world[:3, 3] = 0, 0, 1
    lamps.add_area(model, "disc", POWER, to_world, 1, 1, True)
    E = probe(tmp_path, model, [(0, 0, 0, 0, 0, 1)])
    assert E[0] == pytest.approx(np.array(POWER) * math.pi / 4 / (math.pi / 4) * 0.25 / 1.25, rel=2e-3)


def test_an_emission_material(tmp_path, floor):
    """Strength is radiance: below the middle of a square that emits L, E = pi L F."""
    body = floor(2, name="ceiling", emission=(3.0, 2.0, 1.0))
    faces = body.faces[0]
    flipped = [type(faces)(faces.surface, faces.positions[::-1] + [0, 0, 1], -faces.normals, faces.texture[::-1],
                           faces.light_map[::-1])]
    E = probe(tmp_path, Model([floor(4), type(body)("ceiling", flipped)]), [(0, 0, 0, 0, 0, 1)])
    expected = units.exitance_of_radiance(1) * np.array([3, 2, 1]) * 4 * corner_factor(1, 1)
    assert E[0] == pytest.approx(expected, rel=EXACT)


def test_a_world_of_one_colour_and_a_sun(tmp_path, floor):
    """Radiance L from everywhere gives pi L on every side of an open scene, and a sun adds its own light."""
    model = Model([floor(1)], world=(0.5, 0.7, 1.1))
    lamps.add_sun(model, "sun", (5, 4, 3), np.array([0, 0, -1.0]), 0.01)
    E = probe(tmp_path, model, [(0, 0, 0, 0, 0, 1), (3, 0, 1, 1, 0, 0), (3, 0, 0, 0, 0, -1)])
    assert E[0] == pytest.approx(math.pi * np.array(model.world) + [5, 4, 3], rel=EXACT)
    assert E[2] == pytest.approx(math.pi * np.array(model.world), rel=EXACT)


def test_a_sun_beside_a_picture_is_parallel_light():
    model = Model(sky="image=a.hdr")
    lamps.add_sun(model, "sun", (5, 4, 3), np.array([0, 0, -1.0]), 0.01)
    assert not model.suns and model.lights[0].kind == "directional"


def test_maps_have_the_names_of_objects_and_the_light_of_lamps(tmp_path, floor):
    """Two objects with the same coordinates have maps of their own, by name, and one more per lamp."""
    model = Model([floor(1, 0.5, "Floor.001"), floor(1, 0.5, "Tisch ä")])
    second = model.bodies[1].faces[0]
    second.positions[:] += [0, 0, -1]
    lamps.add_point(model, "left", POWER, np.array([-0.3, 0, 1.0]), 0)
    lamps.add_area(model, "right", POWER, np.array([[1, 0, 0, 0.3], [0, 1, 0, 0], [0, 0, 1, 1], [0, 0, 0, 1.0]]), 0.1, 0.1,
                   False)
    write_glb(model, tmp_path / "scene.glb")
    options = commands.SolveOptions(error=0.05, light_groups=True)
    subprocess.run(commands.solve_command(PROGRAM, [tmp_path / "scene.glb"], tmp_path / "s.h5", options), check=True,
                   capture_output=True)
    subprocess.run(commands.bake_command(PROGRAM, tmp_path / "s.h5", tmp_path, 16, True), check=True, capture_output=True)
    maps = commands.read_light_maps(tmp_path)
    assert {"Floor.001", "Tisch ä"} <= set(maps.file_of)
    assert sorted(maps.groups) == sorted(model.emitters()) == ["left", "right"]
    assert commands.with_one_group(maps, "left").group_files["Floor.001"] == [maps.file_of["Floor.001"]]
    assert len(set(maps.file_of.values())) == len(maps.file_of)
    assert all(len(files) == 2 and all(f.exists() for f in files) for files in maps.group_files.values())
