#!/usr/bin/env python3
"""Installs the package by pip, without network, into a virtual environment with the system's packages, and solves a scene.

usage: install_test.py SOURCE BUILD
"""

import os
import pathlib
import shutil
import subprocess
import sys


def main():
    source, build = (pathlib.Path(p).resolve() for p in sys.argv[1:])
    environment = build / "python-environment"
    shutil.rmtree(environment, ignore_errors=True)
    subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", environment], check=True)
    python = environment / "bin/python"
    subprocess.run([python, "-m", "pip", "install", "--quiet", "--no-index", "--no-build-isolation", "--no-deps", source],
                   check=True, env={**os.environ, "EXITANCE_BUILD_FOLDER": str(build)})
    script = ("import exitance as ex\n"
              "scene = ex.Scene([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]], sky='uniform,dhi=1')\n"
              "E = ex.solve(scene, error=0.1).irradiance([0.5, 0.5, 0], [0, 0, 1])\n"
              "assert abs(E.mean() - 1) < 0.01, E\n"
              "print(ex.__file__, ex.__version__)\n")
    home = environment / "empty"
    home.mkdir()
    output = subprocess.run([python, "-c", script], check=True, cwd=home, capture_output=True, text=True).stdout
    assert output.startswith(str(environment)), output
    print(output, end="")


if __name__ == "__main__":
    main()
