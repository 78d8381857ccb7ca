"""Scenes from arrays and from files."""

import json

import numpy as np
import pytest

import exitance as ex
from conftest import FACES, VERTICES, WALLS, run_program, small_room


def test_a_scene_from_arrays_has_its_faces(room):
    assert len(room) == 7
    assert room.area == pytest.approx(2 * 12 + 2 * 10 + 2 * 7.5 + 1, rel=1e-12)
    assert np.allclose(room.areas.sum(), room.area)
    assert np.array_equal(room.bounds, [[0, 0, 0], [4, 3, 2.5]])
    assert np.array_equal(room.face(0).normal, [0, 0, 1])
    assert np.array_equal(room.face(-1).outline, VERTICES[FACES[6]])
    assert [m.reflectance.tolist() for m in room.materials] == [WALLS, [0, 0, 0]]
    assert room.has_light and not room.is_photometric
    assert "7 faces" in repr(room)


def test_a_scene_from_arrays_gives_the_same_bits_as_a_file(room, room_file):
    from_file = ex.solve(ex.load(room_file), error=0.05)
    from_arrays = ex.solve(room, error=0.05)
    points = np.random.default_rng(1).uniform([0, 0, 0], [4, 3, 2], (50, 3))
    assert np.array_equal(from_file.irradiance(points, [0, 0, 1]), from_arrays.irradiance(points, [0, 0, 1]))
    a, b = from_file.mesh(), from_arrays.mesh()
    assert np.array_equal(a.vertices, b.vertices) and np.array_equal(a.radiosity, b.radiosity)


def test_the_program_gives_the_same_bits(room_file, tmp_path):
    points = np.array([[1, 1, 0.75, 0, 0, 1], [3, 2, 1.2, 0, 1, 0]])
    np.savetxt(tmp_path / "points.csv", points, delimiter=",", header="x,y,z,nx,ny,nz", comments="")
    run_program("solve", room_file, "-o", tmp_path / "room.h5", "--error", "0.05")
    run_program("probe", tmp_path / "room.h5", "--points", tmp_path / "points.csv", "-o", tmp_path / "light.csv")
    table = np.genfromtxt(tmp_path / "light.csv", delimiter=",", names=True)
    E = ex.solve(ex.load(room_file), error=0.05).irradiance(points[:, :3], points[:, 3:])
    written = np.stack([table[name] for name in table.dtype.names if name.startswith("E")], axis=-1)
    assert written.shape == E.shape
    assert np.allclose(written, E, rtol=1e-9, atol=0)  # the file has ten digits
    assert np.array_equal(ex.load_solution(tmp_path / "room.h5").irradiance(points[:, :3], points[:, 3:]), E)


def test_reflectances_extend_as_in_numpy():
    one = ex.Scene(VERTICES, FACES, reflectance=0.5)
    per_band = ex.Scene(VERTICES, FACES, reflectance=WALLS)
    per_face = ex.Scene(VERTICES, FACES, reflectance=[[0.1 * i] for i in range(7)])
    assert one.materials[0].reflectance.tolist() == [0.5] * 3
    assert per_band.materials[0].reflectance.tolist() == WALLS
    assert len(per_face.materials) == 7


def test_materials_can_be_shared_by_index():
    scene = ex.Scene(VERTICES, FACES, material=[0] * 6 + [1], reflectance=[[0.5], [0.0]], exitance=[[0.0], [1.0]],
                     names=["grey", "lamp"])
    assert [m.name for m in scene.materials] == ["grey", "lamp"]
    assert scene.face(6).material == 1


def test_triangles_and_quadrilaterals_mix():
    scene = ex.Scene([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1]], [[0, 1, 2, 3], [0, 4, 5]],
                     exitance=1.0)
    assert scene.areas == pytest.approx([1, 0.5])


@pytest.mark.parametrize("arguments, where", [
    (dict(vertices=VERTICES, faces=[[0, 1, 99]]), "corner 2"),
    (dict(vertices=VERTICES, faces=[[0, 1]]), "face 0"),
    (dict(vertices=VERTICES, faces=[[0, 1, 2.5]]), "faces"),
    (dict(vertices=VERTICES, faces=[[0, -1, 1]]), "faces"),
    (dict(vertices=VERTICES, faces=[[0, 1, -1]]), "face 0"),
    (dict(vertices=[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, np.nan, 0]], faces=[[0, 1, 2], [0, 2, 3]]), "face 1"),
    (dict(vertices=VERTICES[:, :2], faces=FACES), "vertices"),
    (dict(vertices=VERTICES, faces=FACES, reflectance=[0.5, 0.5]), "reflectance"),
    (dict(vertices=VERTICES, faces=FACES, reflectance="white"), "reflectance"),
    (dict(vertices=VERTICES, faces=FACES, groups=["one"]), "group"),
    (dict(vertices=VERTICES, faces=FACES, names=["one"]), "names"),
    (dict(vertices=VERTICES, faces=FACES, sky="purple"), "--sky"),
])
def test_arrays_that_do_not_fit_are_errors(arguments, where):
    with pytest.raises(ex.UsageError) as caught:
        ex.Scene(**arguments)
    assert caught.value.where == where and caught.value.code == "usage"
    assert isinstance(caught.value, ValueError)


def test_faces_of_fewer_corners_are_padded_as_in_trimesh():
    vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]]
    scene = ex.Scene(vertices, np.array([[0, 1, 2, 3], [1, 4, 2, -1]]), exitance=1.0)
    assert scene.areas == pytest.approx([1, 0.5])


def test_a_level_of_detail_of_cityjson_is_read(tmp_path, room_file):
    (tmp_path / "c.city.json").write_text(json.dumps({
        "type": "CityJSON", "version": "2.0",
        "transform": {"scale": [1, 1, 1], "translate": [0, 0, 0]},
        "vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
        "CityObjects": {"b": {"type": "Building", "geometry": [
            {"type": "MultiSurface", "lod": "1.2", "boundaries": [[[0, 1, 2, 3]]]},
            {"type": "MultiSurface", "lod": "2.0", "boundaries": [[[0, 1, 2]], [[0, 2, 3]]]}]}}}))
    assert len(ex.load(tmp_path / "c.city.json", lod="1.2")) == 1
    assert len(ex.load(tmp_path / "c.city.json", lod="2")) == len(ex.load(tmp_path / "c.city.json")) == 2
    with pytest.raises(ex.UsageError, match="CityJSON"):
        ex.load(room_file, lod="2")


def test_scenes_that_cannot_be_repaired_are_errors():
    with pytest.raises(ex.Error) as caught:
        ex.Scene(VERTICES, FACES, reflectance=1.5)
    assert caught.value.code == "bad_input"


def test_missing_files_are_errors(tmp_path):
    with pytest.raises(ex.Error) as caught:
        ex.load(tmp_path / "missing.obj")
    assert caught.value.code == "cannot_read" and caught.value.where.endswith("missing.obj")
    assert "missing.obj" in str(caught.value)
    with pytest.raises(ex.UsageError):
        ex.load()


def test_findings_name_the_repair(room_file):
    room_file.write_text(room_file.read_text() + "f 1 2 2\n")
    findings = ex.load(room_file).findings
    assert findings and all(f.message and f.kind in ("warning", "repair") for f in findings)
    with pytest.raises(ex.Error):
        ex.load(room_file, strict=True)


def test_a_sky_lights_an_open_scene():
    # Under an unobstructed uniform sky of radiance L, the ground has E = pi L.
    ground = ex.Scene([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]], sky="uniform,dhi=100")
    E = ex.solve(ground, error=0.05).irradiance([0.5, 0.5, 0], [0, 0, 1])
    assert E == pytest.approx([100] * 3, rel=0.01)


def test_small_room_is_one_of_the_scenes():
    assert len(small_room(groups=["walls"] * 6 + ["lamp"]).groups) == 2
