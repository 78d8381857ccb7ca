"""Units, command lines, progress and jobs of the Blender add-on, without Blender and without the program."""
import json
import math
import sys
import zipfile

import numpy as np
import pytest
from conftest import ROOT
from exitance_blender import commands, lamps, units
from exitance_blender.job import Job, Step
from exitance_blender.model import Model


def test_a_spot_has_the_flux_of_its_falloff_in_both_programs():
    """The flux of Blender's smooth step and that of glTF's square, both integrated over 20,000 cosines, agree."""
    for size, blend in ((0.5, 0.15), (1.2, 1.0), (3.1, 0.4), (2.0, 0.0)):
        cosines = (np.arange(20000) + 0.5) / 20000
        least = math.cos(size / 2)
        t = np.clip((cosines - least) / max(blend * (1 - least), 1e-12), 0, 1)
        blender = 2 * math.pi * units.point_intensity(100) * np.mean(np.where(cosines > least, t * t * (3 - 2 * t), 0))
        inner, outer = units.spot_cones(size, blend)
        t = np.clip((cosines - math.cos(outer)) / (math.cos(inner) - math.cos(outer)), 0, 1)
        gltf = 2 * math.pi * units.point_intensity(100) * np.mean(t * t)
        assert inner < outer
        assert blender == pytest.approx(units.spot_flux(100, size, blend), rel=2e-3)  # the sum's cells at the cone's edge
        assert gltf == pytest.approx(blender, rel=2e-3)


def test_a_solar_disc_has_its_irradiance():
    angle = 0.3
    thetas = (np.arange(2000) + 0.5) / 2000 * angle / 2
    integral = 2 * math.pi * np.sum(np.cos(thetas) * np.sin(thetas)) * (angle / 2 / 2000)
    assert units.sun_radiance(5, angle) * integral == pytest.approx(5, rel=1e-6)


def test_a_diffuse_emitter_has_its_flux():
    assert units.exitance_of_radiance(units.lambertian_radiance(40, 2.5)) * 2.5 == pytest.approx(40)
    assert units.shown_radiance(0.5, units.exitance_of_radiance(3)) == pytest.approx(1.5)


def test_polygons_in_place_of_round_lamps_have_their_areas():
    model = Model()
    lamps.add_point(model, "ball", (10, 10, 10), np.array([1, 2, 3]), 0.25)
    lamps.add_area(model, "ellipse", (10, 10, 10), np.diag([2.0, 1, 1, 1]), 0.5, 0.7, True)
    for body, area in zip(model.bodies, (4 * math.pi * 0.25**2, math.pi / 4 * 1.0 * 0.7)):
        corners = body.faces[0].positions.reshape(-1, 3, 3)
        assert lamps._area(corners) == pytest.approx(area)
        flux = 10 * (math.pi / 4 if body.name == "ellipse" else 1)
        assert body.faces[0].surface.emission[0] == pytest.approx(flux / (math.pi * area))
    outward = model.bodies[0].faces[0].positions - [1, 2, 3]
    assert np.all(np.sum(outward * model.bodies[0].faces[0].normals, axis=1) > 0)
    assert np.allclose(model.bodies[1].faces[0].normals, [0, 0, -1])


def test_a_mirrored_area_lamp_still_shines_along_its_axis():
    model = Model()
    lamps.add_area(model, "lamp", (1, 1, 1), np.diag([-1.0, 1, 1, 1]), 1, 1, False)
    assert np.allclose(model.bodies[0].faces[0].normals, [0, 0, -1])


def test_command_lines_have_what_was_chosen():
    options = commands.SolveOptions(error=0.01, light_groups=True, sky="image=a.exr", time_limit=30)
    words = commands.solve_command("exitance", ["a.glb", "b.rad"], "a.h5", options)
    assert words[:5] == ["exitance", "solve", "a.glb", "b.rad", "-o"]
    for pair in (["--error", "0.01"], ["--sky", "image=a.exr"], ["--time-limit", "30"]):
        assert pair[1] == words[words.index(pair[0]) + 1]
    assert "--light-groups" in words
    plain = commands.solve_command("exitance", ["a.glb"], "a.h5", commands.SolveOptions())
    assert not {"--sky", "--time-limit", "--light-groups"} & set(plain)


def test_progress_is_told_from_messages():
    line = '{"phase":"gather","fraction":0.75,"detail":"","elapsed":1.07,"remaining":0.35}'
    assert commands.parse_progress(line) == commands.Progress("gather", 0.75)
    for other in ("warning: x", "{", '{"phase":"x"}', '{"phase":"x","fraction":null}', ""):
        assert commands.parse_progress(other) is None
    assert commands.messages(line + "\nwarning: x\n\n") == ["warning: x"]


def test_the_error_is_read_from_the_report():
    report = json.dumps({"relative_error_estimate": 0.0123, "relative_error_bound": 0.05})
    assert commands.parse_error(report, 0).words() == "error 1.2%, at most 5%"
    assert commands.parse_error(report, 4).words() == "error 1.2%, at most 5%, more than requested"
    assert commands.parse_error("", 0) is None
    assert commands.parse_error('{"relative_error_estimate": null}', 0) is None


def python(code):
    return [sys.executable, "-c", code]


def test_a_job_runs_its_steps_and_keeps_what_they_print():
    progress = 'import sys; print(\'{"phase":"p","fraction":0.5}\', file=sys.stderr); print("fact")'
    job = Job([Step("one", python(progress), 3), Step("two", python("import sys; sys.exit(4)"), 1)])
    job.wait()
    assert not job.failure and [s.status for s in job.steps] == [0, 4]
    assert job.steps[0].output == "fact\n" and job.steps[0].errors == ""
    assert 0.75 <= job.fraction() <= 1


def test_the_bar_never_falls_from_phase_to_phase():
    code = "import sys, json\nfor p, f in (('a', 0), ('a', 1), ('b', 0), ('b', .5), ('c', 0)):" \
        "\n print(json.dumps({'phase': p, 'fraction': f}), file=sys.stderr, flush=True); sys.stdin.read(0)"
    job = Job([Step("one", python(code), 1)])
    seen = [0.0]
    while job.poll():
        seen.append(job.fraction())
    assert seen == sorted(seen) and job.fraction() >= 1 - 0.85**2 - 1e-12


def test_a_failed_step_ends_the_job_with_its_message():
    job = Job([Step("one", python("import sys; sys.exit('error: no light')"), 1), Step("two", python(""), 1)])
    job.wait()
    assert job.failure == "error: no light" and job.steps[1].status is None
    absent = Job([Step("one", ["/no/such/program"], 1)])
    absent.wait()
    assert "/no/such/program" in absent.failure


def test_a_cancelled_job_ends_and_starts_nothing_more():
    job = Job([Step("one", python("import time; time.sleep(60)"), 1), Step("two", python(""), 1)])
    assert job.poll()
    job.cancel()
    job.wait()
    assert job.cancelled and not job.failure and job.steps[1].status is None


def test_the_zip_holds_the_package_and_has_the_same_bytes_each_time(tmp_path):
    sys.path.insert(0, str(ROOT / "integrations/blender"))
    import make_zip
    first, second = tmp_path / "a.zip", tmp_path / "b.zip"
    make_zip.make(first)
    make_zip.make(second)
    names = zipfile.ZipFile(first).namelist()
    assert "exitance_blender/__init__.py" in names and not any("pycache" in name for name in names)
    assert first.read_bytes() == second.read_bytes()


def test_a_room_with_a_window_around_an_eye_is_turned_and_a_block_in_it_is_not():
    from exitance_blender import sides
    cube = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    room, block = triangles[:-2], triangles + 8  # the room lacks its west wall
    points = np.concatenate([4 * cube, cube + [1, 1, 0]])
    both = np.concatenate([room, block])
    eye = np.array([[3.0, 3, 2]])
    assert sides.faces_to_turn(points, both, eye).tolist() == [True] * 10 + [False] * 12
    assert not sides.faces_to_turn(points, both[:, ::-1], eye)[:10].any()
    assert not sides.faces_to_turn(points, both, np.array([[9.0, 0, 0]])).any()
    assert sides.winding_number(4 * cube[triangles], eye[0]) == pytest.approx(1)


def test_pictures_are_written_as_png_that_can_be_decoded(tmp_path):
    import struct
    import zlib
    from exitance_blender import pictures
    pixels = np.linspace(0, 1, 2 * 3 * 3).reshape(2, 3, 3)
    pictures.write_png(tmp_path / "a.png", pixels)
    data = (tmp_path / "a.png").read_bytes()
    at = data.index(b"IDAT")
    size, = struct.unpack(">I", data[at - 4:at])
    rows = np.frombuffer(zlib.decompress(data[at + 4:at + 4 + size]), np.uint8).reshape(2, 10)
    assert np.array_equal(rows[:, 1:], np.round(pixels * 255).reshape(2, 9))
    assert pictures.srgb(np.array([0.0, 0.2140411, 1.0])) == pytest.approx([0, 0.5, 1], abs=1e-6)
    large = np.random.default_rng(1).random((3000, 2000, 3))
    assert pictures.reduced(large).shape == (1000, 666, 3)
    assert pictures.reduced(large)[0, 0] == pytest.approx(large[:3, :3].mean(axis=(0, 1)))
