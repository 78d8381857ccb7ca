"""The notebooks of docs/notebooks run, have correct results, and store pictures for the documentation."""

import importlib.machinery
import importlib.util
import json
import pathlib
import time

import numpy as np
import pytest

pytest.importorskip("matplotlib")
ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs/notebooks"


def script(name):
    """A script of scripts/ as a module."""
    loader = importlib.machinery.SourceFileLoader(name.removesuffix(".py"), str(ROOT / "scripts" / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


def results(name):
    """The names that a notebook defines. It takes at most 20 s on two cores."""
    start = time.process_time()
    notebook, namespace = script("run_notebooks").run(FOLDER / f"{name}.ipynb")
    assert time.process_time() - start < 40
    stored = json.loads((FOLDER / f"{name}.ipynb").read_text())
    for ran, kept in zip(notebook["cells"], stored["cells"]):  # scripts/run_notebooks --store writes them
        kinds = [[output["output_type"] for output in cell.get("outputs", [])] for cell in (ran, kept)]
        assert kinds[0] == kinds[1], kept["source"]
    return namespace


def test_the_office_is_symmetric_and_as_bright_as_its_flux_allows():
    found = results("office")
    E = found["E"]
    assert np.allclose(E, E[::-1], rtol=0.05) and np.allclose(E, E[:, ::-1], rtol=0.05)
    assert 0.3 * 14400 / 24 < E.mean() < 1.5 * 14400 / 24  # 14,400 lm on a floor of 24 m^2, once or more often
    assert (found["direct"] < E).all() and found["solution"].error < 0.02


def test_daylight_falls_with_the_distance_from_the_window():
    found = results("daylight")
    year = found["year"]
    factor = np.asarray(year.daylight_factor)
    assert (np.diff(factor) < 0.05).all() and 10 < factor[0] < 60 and 0.5 < factor[-1] < 5  # percent
    assert year.autonomy[0] > year.autonomy[-1] and max(year.autonomy) <= 1
    assert found["table"].reshape(365, 24)[:, [0, 1, 23]].max() == 0  # night


def test_view_factors_agree_with_the_closed_form_and_heat_is_balanced():
    found = results("view_factors")
    assert found["F"][0, 1] == pytest.approx(found["closed_form"], abs=1e-6)
    heat = found["heat"]
    assert abs(heat.sum()) < 1e-3 * np.abs(heat).sum() and heat[0] > 0 > heat[3]
    assert np.allclose(found["G"], found["F"] @ found["J"], rtol=2e-3)


def test_methods_agree_within_the_requested_error():
    found = results("methods")
    assert len(found["runs"]) == 5
    for method, rows in found["runs"].items():
        for (_, error, _), requested in zip(rows, (0.2, 0.1, 0.05)):
            assert error < requested, method


def test_pages_show_text_and_pictures(tmp_path):
    page = script("notebook_pages.py").page(FOLDER / "office.ipynb", tmp_path)
    assert page.startswith("# Illuminance of an office\n") and "```python\n" in page and "uniformity" in page
    assert len(list(tmp_path.glob("office_*.png"))) == page.count("![") == 2
