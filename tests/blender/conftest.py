"""Makes the add-on's modules without Blender importable, and scenes for their tests."""
import os
import pathlib
import sys
import types

import numpy as np
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("EXITANCE_PROGRAM", str(ROOT / "build/bin/exitance"))
FOLDER = ROOT / "integrations/blender/exitance_blender"

# The package's own __init__ registers classes in Blender; here an empty package of its name holds the other modules.
package = types.ModuleType("exitance_blender")
package.__path__ = [str(FOLDER)]
sys.modules["exitance_blender"] = package


@pytest.fixture
def floor():
    """Returns a function that makes a square of a side and a reflectance, at z = 0 around the origin, that faces up."""
    from exitance_blender.model import Body, Faces, Surface

    def make(side=1.0, reflectance=0.0, name="floor", **more):
        outline = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
        up = np.tile([0.0, 0.0, 1.0], (6, 1))
        surface = Surface(name, (reflectance,) * 3, **more)
        return Body(name, [Faces(surface, (outline - [0.5, 0.5, 0]) * side, up, outline[:, :2], outline[:, :2])])

    return make
