"""Solving, and the light of solutions."""

import ctypes
import json
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import exitance as ex
from conftest import RADIANCE, run_program, small_room


def test_the_requested_error_is_reached(solution):
    assert solution.converged and 0 < solution.error <= 0.05 <= 1 and solution.error_bound >= solution.error
    # The lamp emits pi L from 1 m^2.
    assert solution.energy["emitted"] == pytest.approx(np.pi * RADIANCE, rel=1e-9)
    assert solution.energy["defect"] < 0.05
    assert solution.stopped_by == "" and "estimated error" in repr(solution)


def test_direct_light_is_exact(solution):
    # A square of side 1 m, 2 m above the point below its centre: four times the form factor of a corner.
    w = np.hypot(0.5, 2)
    F = 4 / np.pi * (0.5 / w) * np.arctan(0.5 / w)
    E = solution.irradiance([2, 1.5, 0], [0, 0, 1], component="direct")
    assert E == pytest.approx([np.pi * RADIANCE * F] * 3, rel=1e-9)


def test_components_add_up(solution):
    points = np.random.default_rng(2).uniform([0, 0, 0], [4, 3, 2], (20, 3))
    parts = [solution.irradiance(points, [0, 0, 1], component=c) for c in ("total", "direct", "indirect")]
    assert np.allclose(parts[0], parts[1] + parts[2], rtol=1e-9)


def test_one_point_and_many_points_have_matching_shapes(solution):
    one = solution.irradiance([1, 1, 0.75], [0, 0, 2])
    many = solution.irradiance([[1, 1, 0.75]] * 3, [[0, 0, 1]] * 3)
    assert one.shape == (ex.bands,) and many.shape == (3, ex.bands)
    assert np.array_equal(many[0], one)
    assert solution.irradiance(np.zeros((0, 3)), [0, 0, 1]).shape == (0, ex.bands)


def test_radiosity_is_known_on_surfaces_only(solution):
    B = solution.radiosity([[2, 1.5, 0], [2, 1.5, 1]], [0, 0, 1])
    E = solution.irradiance([2, 1.5, 0], [0, 0, 1])
    assert np.allclose(B[0], E * [0.5, 0.4, 0.3]) and np.isnan(B[1]).all()


def test_statistics_are_those_of_the_program(solution, tmp_path):
    solution.save(tmp_path / "room.h5")
    assert solution.stats["surfaces"] == 7
    assert json.loads(run_program("stats", tmp_path / "room.h5", "--json")) == solution.stats


def test_saved_solutions_give_the_same_bits(solution, tmp_path):
    solution.save(tmp_path / "room.h5")
    again = ex.load_solution(tmp_path / "room.h5")
    assert np.array_equal(again.irradiance([1, 1, 1], [0, 0, 1]), solution.irradiance([1, 1, 1], [0, 0, 1]))
    assert len(again.scene) == 7 and again.error == solution.error


def test_options_have_the_names_of_the_command_line(room):
    solved = ex.solve(room, error=0.1, method="hierarchical", output_light="elements", threads=1)
    assert solved.stats["method"] == "hierarchical" and solved.stats["threads"] == 1
    assert ex.solve(room, bounces=0).irradiance([2, 1.5, 0], [0, 0, 1], component="indirect").max() == 0


@pytest.mark.parametrize("options", [
    dict(error=-1), dict(error=float("nan")), dict(method="magic"), dict(mesh_sise=1), dict(mesh_size="wide"),
    dict(bounces=-5), dict(time_limit=0), dict(recipe="hanrahan91"), dict(resume=True), dict(progress=3),
])
def test_wrong_options_are_errors(room, options):
    with pytest.raises(ex.UsageError) as caught:
        ex.solve(room, **options)
    assert caught.value.message


def test_wrong_points_are_errors(solution):
    for points, normals in [([1, 1], [0, 0, 1]), ([1, 1, 1], [0, 0, 0]), ([np.nan, 1, 1], [0, 0, 1]),
                            ([[1, 1, 1]], [[0, 0, 1]] * 2)]:
        with pytest.raises(ex.UsageError):
            solution.irradiance(points, normals)
    with pytest.raises(ex.UsageError):
        solution.irradiance([1, 1, 1], [0, 0, 1], component="reflected")


def test_meshes_are_read_only_views(solution):
    mesh = solution.mesh()
    corners = mesh.vertices[mesh.triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    assert areas.sum() == pytest.approx(solution.scene.area, rel=1e-5)  # vertices are rounded to single precision
    assert mesh.face.shape == (len(mesh.triangles),) and set(mesh.face) == set(range(7))
    assert mesh.irradiance.shape == mesh.radiosity.shape == (len(mesh.vertices), ex.bands)
    assert np.shares_memory(mesh.vertices, mesh.vertices)
    with pytest.raises(ValueError):
        mesh.irradiance[0] = 0
    irradiance = mesh.irradiance
    before = irradiance.copy()
    del mesh
    assert np.array_equal(irradiance, before)  # the view keeps the memory


def test_files_for_other_programs_are_written(solution, tmp_path):
    for name in ("room.glb", "room.vtu", "room.csv"):
        solution.export(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 100
    with pytest.raises(ex.UsageError):
        solution.export(tmp_path / "room.doc")
    with pytest.raises(ex.UsageError) as caught:
        solution.save(tmp_path / "room.png")
    assert "Picture.save()" in caught.value.hint and not (tmp_path / "room.png").exists()
    with pytest.raises(ex.Error) as caught:
        solution.save(tmp_path / "no folder" / "room.h5")
    assert caught.value.code == "cannot_write"


def test_pictures_are_arrays(solution, tmp_path):
    camera = ex.Camera([0.2, 0.2, 1.5], [3, 2, 1], 70)
    picture = solution.render(camera, size=(60, 40), samples=4)
    assert picture.size == (60, 40) and picture.radiance.shape == (40, 60, ex.bands)
    assert picture.display().dtype == np.uint8 and picture.display().shape == (40, 60, 3)
    assert picture.radiance.min() >= 0 and picture.irradiance.mean() > 0
    assert picture.display(exposure=1).mean() > picture.display().mean()
    picture.save(tmp_path / "room.png")
    picture.save(tmp_path / "room.exr")
    assert solution.render(size=(20, 10)).camera.fov > 0
    for wrong in (dict(size=(0, 10)), dict(samples=0)):
        with pytest.raises(ex.UsageError):
            solution.render(camera, **wrong)
    with pytest.raises(ex.UsageError):
        ex.Camera([0, 0, 0], [1, 0, 0], projection="flat")
    for target, wrong in (
        ([0, 0, 0], {}),
        ([1, 0, np.nan], {}),
        ([1, 0, 0], dict(fov=0)),
        ([1, 0, 0], dict(fov=180)),
        ([1, 0, 0], dict(fov=np.nan)),
        ([1, 0, 0], dict(fov=361, projection="fisheye")),
        ([1, 0, 0], dict(fov=0, projection="orthographic")),
        ([1, 0, 0], dict(up=[0, 0, 0])),
    ):
        with pytest.raises(ex.UsageError) as caught:
            ex.Camera([0, 0, 0], target, **wrong)
        assert "camera" in str(caught.value)
    assert solution.render(ex.Camera([1, 1, 2], [1, 1, 0]), size=(4, 4)).irradiance.mean() > 0  # up is along the view


def test_light_maps_hold_the_irradiance_of_points(solution, tmp_path):
    maps = solution.bake(density=8)
    assert maps.density == 8 and len(maps) == 1 and len(maps.charts) == 7
    floor = next(c for c in maps.charts if c.faces == [0])
    image = maps[floor.map].irradiance
    x, y = 16, 12  # a texel in the middle of the floor
    E = solution.irradiance(floor.origin + x * floor.right + y * floor.down, [0, 0, 1])
    assert image[floor.y + y, floor.x + x] == pytest.approx(E, rel=0.01)  # the texel is a mean over 12 cm
    maps.save(tmp_path / "maps")
    assert (tmp_path / "maps" / "lightmaps.json").exists()
    with pytest.raises(IndexError):
        maps[1]
    with pytest.raises(ex.UsageError):
        solution.bake(density=-1)


def test_light_maps_in_texture_coordinates(tmp_path):
    """A floor of 2 m x 1 m under a lamp, with coordinates that fill the map: rows of texels run along the floor."""
    (tmp_path / "room.mtl").write_text("newmtl grey\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n")
    (tmp_path / "room.obj").write_text(
        "mtllib room.mtl\n"
        "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\nv 1 1 1\nv 1 0 1\n"
        "vt 0 0\nvt 1 0\nvt 1 0.5\nvt 0 0.5\nvt 0 0.6\nvt 0 0.9\nvt 0.3 0.9\nvt 0.3 0.6\n"
        "usemtl grey\nf 1/1 2/2 3/3 4/4\nusemtl lamp\nf 5/5 6/6 7/7 8/8\n"
    )
    solution = ex.solve(ex.load(tmp_path / "room.obj"), error=0.05)
    maps = solution.bake(uv="vt", size=(64, 64))
    assert len(maps) == 1 and maps[0].irradiance.shape == (64, 64, ex.bands) and maps.charts == []
    x, y = 10, 40  # columns from the left, rows from the top: u = 10.5 / 64, v = 1 - 40.5 / 64
    E = solution.irradiance([2 * (x + 0.5) / 64, 2 * (1 - (y + 0.5) / 64), 0], [0, 0, 1])
    assert maps[0].irradiance[y, x] == pytest.approx(E, rel=0.01)  # the texel is a mean over 3 cm
    assert maps[0].coverage[y, x] == pytest.approx(1)
    assert len(maps.warnings) == 1 and "mirrored" in maps.warnings[0]  # the lamp's coordinates run clockwise
    maps.save(tmp_path / "own")
    assert (tmp_path / "own" / "lightmaps.json").exists() and not (tmp_path / "own" / "scene.glb").exists()

    made = solution.bake(uv="unwrap", density=16)
    made.save(tmp_path / "unwrapped")
    assert made.density >= 16 and (tmp_path / "unwrapped" / "scene.glb").exists()
    for wrong in (dict(uv="TEXCOORD_1"), dict(size=(64, 64)), dict(uv="vt", size=(64, 0))):
        with pytest.raises(ex.UsageError):
            solution.bake(**wrong)


def test_glare_of_an_eye(solution):
    eye, towards = [0.2, 1.5, 1.2], [1, 0, 0.2]
    glare = solution.glare(eye, towards, threshold=300)
    E = solution.irradiance(eye, np.array(towards) / np.linalg.norm(towards)) @ [0.265, 0.670, 0.065] * 179
    assert glare.vertical_illuminance == pytest.approx(E, rel=0.02)  # both gather reflected light by rays
    assert 0 < glare.bounds[0] <= glare.probability <= glare.bounds[1] <= 1
    assert glare.level in ("imperceptible", "perceptible", "disturbing", "intolerable")
    assert glare.threshold == 300 and glare.sources[0].luminance == pytest.approx(179 * RADIANCE, rel=0.05)
    assert glare.sources[0].direction[0] > 0 and glare.sources[0].position >= 1
    assert solution.glare(eye, towards).sources == [] and solution.glare(eye, towards).threshold == 2000
    assert solution.glare(eye, towards, threshold="5x").threshold == pytest.approx(5 * glare.mean_luminance)
    doubled = solution.glare(eye, towards, threshold=600, efficacy=2 * 179)
    assert doubled.vertical_illuminance == pytest.approx(2 * glare.vertical_illuminance)
    for wrong in (dict(threshold=0), dict(threshold="5"), dict(threshold="x"), dict(efficacy=-1)):
        with pytest.raises(ex.UsageError):
            solution.glare(eye, towards, **wrong)
    with pytest.raises(ex.UsageError):
        solution.glare(eye, [0, 0, 0])


def test_light_probes_are_those_of_the_program(solution, tmp_path):
    points = np.array([[1.0, 1, 1], [2, 1, 1], [3, 2, 0.5]])
    probes = solution.probes(points)
    assert len(probes) == 3 and probes.radiance.shape == (3, 9, ex.bands)
    assert probes.standard_error.shape == (3, 9, ex.bands) and np.all(probes.back_share < 0.1)
    E = solution.irradiance(points, [0, 0, 1])
    assert probes.irradiance([0, 0, 2]) == pytest.approx(E, rel=0.08)  # degrees above 2 add 6%
    solution.save(tmp_path / "room.h5")
    (tmp_path / "points.csv").write_text("x,y,z\n" + "".join("%r,%r,%r\n" % tuple(p) for p in points.tolist()))
    run_program("probes", tmp_path / "room.h5", "--points", tmp_path / "points.csv", "-o", tmp_path / "probes.json")
    written = json.loads((tmp_path / "probes.json").read_text())["probes"]
    for k in range(3):
        assert probes.radiance[k] == pytest.approx(np.array(written[k]["radiance"]), rel=1e-5, abs=1e-5)
    for wrong in (dict(points=points, rays=100), dict(points=[[np.nan, 0, 0]])):
        with pytest.raises(ex.UsageError):
            solution.probes(**wrong)


def test_mixing_dims_groups():
    solved = ex.solve(small_room(groups=["walls"] * 6 + ["lamp"], light_groups=True), error=0.1)
    assert solved.light_groups == ["lamp"]
    before = solved.irradiance([2, 1.5, 0], [0, 0, 1])
    assert solved.mix({"lamp": 0.5}).irradiance([2, 1.5, 0], [0, 0, 1]) == pytest.approx(0.5 * before, rel=1e-5)
    with pytest.raises(ex.UsageError) as caught:
        solved.mix({"sun": 1})
    assert "lamp" in caught.value.hint


def test_mixing_needs_light_groups(solution):
    with pytest.raises(ex.UsageError):
        solution.mix({"lamp": 0.5})


def test_results_do_not_depend_on_threads(room):
    E = [ex.solve(room, error=0.1, threads=n).irradiance([1, 1, 0], [0, 0, 1]) for n in (1, 2)]
    assert np.array_equal(*E)


def test_other_threads_run_during_a_solve(room):
    counts = []
    stop = threading.Event()

    def count():
        counter = 0
        while not stop.is_set():
            counter += 1
            time.sleep(0.001)
        counts.append(counter)

    thread = threading.Thread(target=count)
    thread.start()
    ex.solve(room, error=0.01)
    stop.set()
    thread.join()
    assert counts[0] > 3


def test_solves_in_several_threads_take_turns(room):
    results = {}

    def solve(i):
        results[i] = ex.solve(room, error=0.1).irradiance([1, 1, 0], [0, 0, 1])

    threads = [threading.Thread(target=solve, args=(i,)) for i in range(4)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert len(results) == 4 and all(np.array_equal(results[0], r) for r in results.values())


def test_progress_reports_phases_and_can_stop(room, capfd):
    reports = []
    ex.solve(room, error=0.02, progress=lambda phase, fraction: reports.append((phase, fraction)))
    assert reports and all(isinstance(p, str) and 0 <= f <= 1 for p, f in reports)
    ex.solve(room, error=0.02, progress=True)
    assert "exitance: " in capfd.readouterr().err
    started = time.monotonic()
    try:
        stopped = ex.solve(room, error=1e-4, progress=lambda phase, fraction: False)
        assert stopped.stopped_by == "interrupt" and not stopped.converged
    except ex.Error as error:
        assert error.code == "limit"
    assert time.monotonic() - started < 30


def test_an_error_in_the_callback_is_raised(room):
    def fail(phase, fraction):
        raise KeyError("mine")

    with pytest.raises(KeyError):
        ex.solve(room, error=1e-4, progress=fail)


def test_a_time_limit_ends_a_solve(room):
    try:
        solved = ex.solve(room, error=1e-6, time_limit=1)
        assert solved.stopped_by == "time limit" and not solved.converged
    except ex.Error as error:
        assert error.code == "limit"


def test_interrupts_raise_keyboard_interrupt():
    script = ("import sys\nsys.path.insert(0, sys.argv[1])\nfrom conftest import *\n"
              "print('ready', flush=True)\n"
              "try:\n    ex.solve(small_room(), error=1e-3)\nexcept KeyboardInterrupt:\n    print('interrupted')\n")
    process = subprocess.Popen([sys.executable, "-c", script, os.path.dirname(__file__)], stdout=subprocess.PIPE,
                               text=True)
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    output, _ = process.communicate(timeout=60)
    assert output == "interrupted\n"


def test_errors_survive_pickling():
    import pickle

    error = pickle.loads(pickle.dumps(ex.UsageError("is wrong", "here", "do that", "usage")))
    assert (error.message, error.where, error.hint, error.code) == ("is wrong", "here", "do that", "usage")


class Allocated(ctypes.Structure):
    """`struct mallinfo2` of the C library: sums over all of its heaps."""

    _fields_ = [(name, ctypes.c_size_t) for name in ("arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks",
                                                     "uordblks", "fordblks", "keepcost")]


def allocated_bytes():
    """Bytes that the process has allocated and not freed."""
    mallinfo2 = ctypes.CDLL(None).mallinfo2
    mallinfo2.restype = Allocated
    heaps = mallinfo2()
    return heaps.uordblks + heaps.hblkhd


def resident_bytes():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def test_solves_leave_no_memory_behind():
    # Allocated memory grows by 1 kB per solve at most. Resident memory, which also counts memory that is mapped without the
    # allocator, varies by 2 MB. A leak of 20 kB per solve, a fiftieth of a solution, is above both in 150 solves.
    def work(count):
        for _ in range(count):
            solved = ex.solve(small_room(), error=0.3, threads=1)
            solved.irradiance([1, 1, 0], [0, 0, 1])
            solved.mesh()

    work(10)
    allocated, resident = allocated_bytes(), resident_bytes()
    work(150)
    assert allocated_bytes() - allocated < 150 * 20_000
    assert resident_bytes() - resident < 150 * 20_000
