"""View factors and daylight."""

import numpy as np
import pytest
import scipy.sparse
import scipy.sparse.linalg

import exitance as ex
from conftest import FACES, VERTICES


def test_view_factors_are_a_sparse_matrix(room):
    F = ex.view_factors(room, error=1e-2)
    assert isinstance(F, scipy.sparse.csr_array) and F.shape == (7, 7)
    sums = F.sum(axis=1)
    assert (sums[:6] > 0.9).all() and (sums < 1.02).all()  # the back of the lamp takes less than a tenth
    A = room.areas
    assert np.allclose((F.toarray().T * A).T, (F.toarray().T * A), rtol=1e-9, atol=1e-12)
    with pytest.raises(ex.UsageError):
        ex.view_factors(room, error=0)


def test_view_factors_of_a_cube_are_those_of_the_textbooks():
    cube = ex.Scene(VERTICES[:8] / [4, 3, 2.5], FACES[:6], exitance=1.0)
    F = ex.view_factors(cube, error=1e-3).toarray()
    # Opposite squares of a cube: 0.1998 [Howell, C-11].
    assert F[0, 1] == pytest.approx(0.19982, abs=1e-3) and F[0, 0] == 0
    assert F.sum(axis=1) == pytest.approx(np.ones(6), abs=2e-3)


def test_view_factors_have_the_columns_of_the_file(room):
    F = ex.view_factors(room, error=1e-2, threads=1)
    assert F.areas == pytest.approx(room.areas) and F.finished.all()
    assert np.allclose(F.sum(axis=1) + F.sky + F.back, 1, atol=1e-9)  # rows are closed
    assert F.back[:6].max() > 0 and F.sky.max() < 1e-3  # the lamp's back in a closed room
    assert 0 < F.row_errors.max() <= 1e-2 and F.emittances[0] == pytest.approx(0.6)
    assert np.array_equal(F.toarray(), ex.view_factors(room, error=1e-2, threads=2).toarray())


def test_view_factors_to_a_tolerance_have_no_noise(room):
    F = ex.view_factors(room, tolerance=1e-4)
    other = ex.view_factors(room, tolerance=1e-4, seed=2)
    assert np.array_equal(F.toarray(), other.toarray()) and F.sky is None and F.row_errors is None
    assert np.abs(ex.view_factors(room, error=1e-3).toarray() - F.toarray()).max() < 3e-3
    for wrong in dict(error=1e-3, tolerance=1e-3), dict(tolerance=1), dict(time_limit=0), dict(threads=-1):
        with pytest.raises(ex.UsageError):
            ex.view_factors(room, **wrong)


def test_a_stop_keeps_finished_rows_or_says_that_it_cannot():
    rng = np.random.default_rng(1)
    corners = rng.uniform(size=(400, 1, 3)) + 0.05 * rng.normal(size=(400, 3, 3))
    scene = ex.Scene(corners.reshape(-1, 3), np.arange(1200).reshape(-1, 3))
    progress = lambda phase, fraction: fraction == 0  # stops at the first report of finished rows
    with pytest.warns(RuntimeWarning, match="of 400 rows"):
        F = ex.view_factors(scene, error=2e-4, progress=progress)
    assert 0 < F.finished.sum() < 400
    assert F.sum(axis=1)[~F.finished].max() == 0 < F.sum(axis=1)[F.finished].max()
    with pytest.raises(ex.Error, match="first row") as caught:
        ex.view_factors(scene, error=1e-5, time_limit=1e-3)
    assert caught.value.code == "limit"
    with pytest.raises(ex.Error, match="all rows"):
        ex.transport_operator(scene, error=1e-4, time_limit=0.05)


def test_scenes_with_clear_glass_are_refused(tmp_path):
    (tmp_path / "s.mtl").write_text("newmtl grey\nKd 0.5 0.5 0.5\nnewmtl glass\nKd 0 0 0\nd 0.2\n")
    (tmp_path / "s.obj").write_text("mtllib s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\n"
                                    "usemtl grey\nf 1 2 3\nusemtl glass\nf 4 5 6\n")
    scene = ex.load(tmp_path / "s.obj")
    for of in ex.view_factors, ex.transport_operator:
        with pytest.raises(ex.UsageError, match="glass"):
            of(scene, error=1e-2)


def test_the_transport_operator_is_a_linear_operator(room, tmp_path):
    F = ex.transport_operator(room, error=1e-2)
    assert isinstance(F, scipy.sparse.linalg.LinearOperator) and F.shape == (7, 7)
    exact = ex.view_factors(room, error=1e-3)
    x, y = np.arange(7.0) / 6, np.linspace(1, -1, 7)
    # The error of both, for |x| <= 1.
    assert np.abs(F @ x - exact @ x).max() < 1e-2 + 3.5e-3
    assert y @ (F @ x) == pytest.approx(F.rmatvec(y) @ x, rel=1e-12)
    assert np.allclose(F @ np.stack([x, y], axis=1), np.stack([F @ x, F @ y], axis=1))
    transport = F.transport
    assert repr(transport).startswith("<exitance.TransportOperator: 7 faces, ")
    assert transport.areas == pytest.approx(room.areas)
    assert np.allclose(F @ np.ones(7) + transport.sky + transport.back, 1, atol=1e-2)
    assert transport.closure_defect <= 1e-2 and transport.row_errors.max() <= 1e-2
    transport.save(tmp_path / "F.h5")
    assert (ex.load_transport_operator(tmp_path / "F.h5") @ x == F @ x).all()
    with pytest.raises(ex.UsageError):
        F.transport.matvec(np.ones(6))
    with pytest.raises(ex.Error):
        ex.load_transport_operator(tmp_path / "missing.h5")


def test_solvers_of_scipy_take_the_transport_operator(room):
    F = ex.transport_operator(room, error=1e-2)
    rho, emitted = 0.5, np.eye(7)[6]
    system = scipy.sparse.linalg.LinearOperator((7, 7), matvec=lambda b: b - rho * (F @ b))
    B, status = scipy.sparse.linalg.gmres(system, emitted, tol=1e-10, atol=0)
    assert status == 0 and np.allclose(B - rho * (F @ B), emitted, atol=1e-8)


def write_weather(path, hours=24):
    """Weather of 21 June at 47 N: the sky gives 200 W/m^2 by day, without sun."""
    header = ["LOCATION,Town,-,-,-,-,47.4,8.5,1,400"] + ["DESIGN CONDITIONS,0"] * 6 + ["DATA PERIODS,1,1,Data,Sunday"]
    rows = []
    for hour in range(1, hours + 1):
        fields = ["2021", "6", "21", str(hour), "60", "-"] + ["0"] * 29
        fields[15] = "200" if 6 <= hour <= 18 else "0"  # diffuse horizontal irradiance
        fields[13] = fields[15]
        rows.append(",".join(fields))
    path.write_text("\n".join(header + rows) + "\n")


def write_glazed_room(folder):
    """A room of 4 x 3 x 2.5 m whose south wall is glass."""
    corners = [(x, y, z) for z in (0, 2.5) for y in (0, 3) for x in (0, 4)]
    faces = ["1 3 4 2", "5 6 8 7", "3 7 8 4", "1 5 7 3", "2 4 8 6"]  # floor, ceiling, north, west and east
    lines = ["mtllib room.mtl"] + [f"v {x} {y} {z}" for x, y, z in corners] + ["usemtl wall"]
    lines += [f"f {face}" for face in faces] + ["usemtl glass", "f 1 2 6 5"]
    (folder / "room.obj").write_text("\n".join(lines) + "\n")
    (folder / "room.mtl").write_text("newmtl wall\nKd 0.5 0.5 0.5\nnewmtl glass\nKd 0 0 0\nd 0\nTf 0.8 0.8 0.8\n")
    return folder / "room.obj"


def test_daylight_follows_the_states_of_panes(tmp_path):
    write_weather(tmp_path / "town.epw")
    scene = ex.load(write_glazed_room(tmp_path))
    group = '[[group]]\nname = "south"\nrule = "constant"\nstays = "dim"\n'
    group += '[[group.state]]\nname = "open"\n[[group.state]]\nname = "dim"\nfactor = 0.25\n'
    (tmp_path / "states.toml").write_text(group + '[[variant]]\nname = "dark"\nfactors = [0.5]\n')
    places = [[2, 1, 0.8], [2, 2, 0.8]]
    whole = ex.daylight(scene, tmp_path / "town.epw", places)
    dimmed = ex.daylight(scene, tmp_path / "town.epw", places, states=tmp_path / "states.toml")
    lit = whole.illuminance > 0
    # All light comes through the panes: a quarter of it, to the rounding of single precision.
    assert np.allclose(dimmed.illuminance[lit], 0.25 * whole.illuminance[lit], rtol=1e-4)
    (south,) = dimmed.pane_groups
    assert south.name == "south" and south.states == ["open", "dim"]
    assert south.chosen.shape == (24,) and (south.chosen == 1).all()
    (dark,) = dimmed.glass_variants
    occupied = (whole.hours[:, 2] > 8) & (whole.hours[:, 2] <= 18)
    assert dark.name == "dark"
    assert dark.mean_illuminance == pytest.approx(0.125 * whole.illuminance[occupied].mean(), rel=1e-3)
    assert whole.pane_groups == [] and whole.glass_variants == []
    with pytest.raises(ex.UsageError):  # a scene of arrays has no panes with names
        flat = ex.Scene([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]], reflectance=0.2)
        ex.daylight(flat, tmp_path / "town.epw", places, states=tmp_path / "states.toml")
    (tmp_path / "states.toml").write_text(group.replace("dim", "shut", 1))
    with pytest.raises(ex.Error, match="shut"):
        ex.daylight(scene, tmp_path / "town.epw", places, states=tmp_path / "states.toml")


def test_daylight_on_open_ground_is_that_of_the_sky(tmp_path):
    write_weather(tmp_path / "town.epw")
    ground = ex.Scene([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]], reflectance=0.2)
    year = ex.daylight(ground, tmp_path / "town.epw", [[0.5, 0.5, 0]])
    assert year.illuminance.shape == (24, 1) and year.sun.max() == 0
    noon = year.hours[:, 2].tolist().index(13)
    assert year.illuminance[noon, 0] == pytest.approx(200 * 120, rel=0.01)  # 120 lm/W of the sky
    assert year.daylight_factor[0] == pytest.approx(100, rel=0.02)
    assert year.useful.shape == (1, 4) and year.autonomy.shape == (1,)
    low, high = year.daylight_factor_bounds[0]
    assert low <= year.daylight_factor[0] <= high
    assert 0 <= year.error_lux_hours <= 0.02
    assert year.warnings  # the file is not a whole year
    with pytest.raises(ex.UsageError):
        ex.daylight(ground, tmp_path / "town.epw", np.zeros((0, 3)))
    with pytest.raises(ex.Error):
        ex.daylight(ground, tmp_path / "missing.epw", [[0.5, 0.5, 0]])
