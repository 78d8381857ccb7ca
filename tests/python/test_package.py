"""The package: types, documentation, examples, installation."""

import ast
import importlib
import inspect
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

import exitance as ex
from conftest import ROOT, run_program

PACKAGE = pathlib.Path(ex.__file__).parent


def test_the_version_is_that_of_the_project():
    text = (ROOT / "CMakeLists.txt").read_text()
    assert ex.__version__ == re.search(r"project\(exitance VERSION ([0-9.]+)", text).group(1)


def test_stubs_name_exactly_the_members_of_the_module():
    stub = ast.parse((PACKAGE / "_exitance.pyi").read_text())
    module = importlib.import_module("exitance._exitance")
    stubbed = {n.name: n for n in stub.body if isinstance(n, (ast.FunctionDef, ast.ClassDef))}
    assert set(stubbed) == {n for n in dir(module) if not n.startswith("_") and n != "bands"}
    assert set(stubbed) | {"Error", "UsageError", "__version__", "bands"} == set(ex.__all__)
    for name, node in stubbed.items():
        if isinstance(node, ast.ClassDef):
            members = {n.name for n in node.body if isinstance(n, ast.FunctionDef)} - {"__init__"}
            own = {n for n in vars(getattr(module, name)) if not n.startswith("_")}
            assert {m for m in members if not m.startswith("_")} == own, name
            assert all(hasattr(getattr(module, name), m) for m in members)


def test_every_function_and_class_is_documented():
    for name in ex.__all__:
        value = getattr(ex, name)
        if inspect.isclass(value) or callable(value):
            assert len(value.__doc__ or "") > 10, name
    assert "certificate" not in ex.solve.__doc__ and "requested" in ex.solve.__doc__


@pytest.mark.skipif(shutil.which("mypy") is None, reason="mypy is not installed")
def test_types_are_checked_strictly():
    # The system's mypy knows the system's NumPy.
    examples = sorted(str(p) for p in (ROOT / "bindings/python/examples").glob("*.py"))
    assert examples
    run = subprocess.run(["/usr/bin/mypy", "--strict", "--cache-dir", "/dev/null", "--package", "exitance"],
                         capture_output=True, text=True, cwd=PACKAGE.parent)
    assert run.returncode == 0, run.stdout
    run = subprocess.run(["/usr/bin/mypy", "--strict", "--cache-dir", "/dev/null", *examples], capture_output=True,
                         text=True, env={"MYPYPATH": str(PACKAGE.parent), "PATH": "/usr/bin"})
    assert run.returncode == 0, run.stdout


def examples_in(page):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(), re.S)
    assert blocks, page
    return blocks


@pytest.mark.parametrize("page, index", [("README.md", 0), ("docs/index.md", 0), ("docs/python.md", 0),
                                         ("docs/python.md", 1), ("docs/python.md", 2), ("docs/python.md", 3)])
def test_examples_of_the_documentation_run(page, index, tmp_path):
    run_program("generate", "cornell", "-o", tmp_path / "room.obj")
    run = subprocess.run([sys.executable, "-c", examples_in(page)[index]], cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 0 and run.stdout, run.stderr


@pytest.mark.parametrize("script", sorted(p.name for p in (ROOT / "bindings/python/examples").glob("*.py")))
def test_example_scripts_run(script, tmp_path):
    run = subprocess.run([sys.executable, ROOT / "bindings/python/examples" / script, "--quick"], cwd=tmp_path,
                         capture_output=True, text=True)
    assert run.returncode == 0 and run.stdout, run.stderr
