"""View factors and daylight."""

import numpy as np
import pytest
import scipy.sparse

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
