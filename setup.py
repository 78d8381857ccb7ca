"""`pip install .`: builds the Python module by CMake. pyproject.toml has the rest.

EXITANCE_BUILD_FOLDER names a build folder to use, so that what it has built is not built again; by default it is
build/pip.
"""

import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent
VERSION = re.search(r"project\(exitance VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)


(ROOT / "build").mkdir(exist_ok=True)


class CMakeBuild(build_ext):
    """Builds the target exitance-python and copies the module to where setuptools expects it."""

    def build_extension(self, ext):
        folder = pathlib.Path(os.environ.get("EXITANCE_BUILD_FOLDER", ROOT / "build/pip"))
        if not (folder / "CMakeCache.txt").exists():
            subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-D", "CMAKE_BUILD_TYPE=Release",
                            "-D", "EXITANCE_TESTS=OFF", "-D", "EXITANCE_VIEWER=OFF", "-D", "EXITANCE_PYTHON=ON",
                            "-D", f"Python_EXECUTABLE={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", folder, "--parallel", str(os.cpu_count()), "--target", "exitance-python"],
                       check=True)
        output = pathlib.Path(self.get_ext_fullpath(ext.name))
        self.copy_file(str(folder / "python/exitance" / output.name), str(output))


setup(
    version=VERSION,
    ext_modules=[Extension("exitance._exitance", [])],
    cmdclass={"build_ext": CMakeBuild},
    options={"build": {"build_base": "build/pip-work"}, "egg_info": {"egg_base": "build"}},
)
