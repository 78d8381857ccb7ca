"""Light in rooms of diffuse surfaces, with an estimate of its error.

    import exitance as ex
    scene = ex.load("room.obj")
    solution = ex.solve(scene, error=0.02)
    E = solution.irradiance([[1, 1, 0.75]], [0, 0, 1])   # (1, bands), W/m^2

Lengths are in metres, Z points up, and light is in W/m^2 per spectral band, or in lux if the scene is photometric.
"""

from ._errors import Error, UsageError
from ._exitance import (
    Camera,
    Chart,
    Daylight,
    Face,
    Finding,
    Glare,
    GlareSource,
    GlassVariant,
    LightMap,
    LightMaps,
    LightProbes,
    Material,
    Mesh,
    PaneGroup,
    Picture,
    Scene,
    Solution,
    TransportOperator,
    __version__,
    bands,
    daylight,
    load,
    load_solution,
    load_transport_operator,
    set_threads,
    solve,
    transport_operator,
    view_factors,
)

__all__ = [
    "Camera",
    "Chart",
    "Daylight",
    "Error",
    "Face",
    "Finding",
    "Glare",
    "GlareSource",
    "GlassVariant",
    "LightMap",
    "LightMaps",
    "LightProbes",
    "Material",
    "Mesh",
    "PaneGroup",
    "Picture",
    "Scene",
    "Solution",
    "TransportOperator",
    "UsageError",
    "__version__",
    "bands",
    "daylight",
    "load",
    "load_solution",
    "load_transport_operator",
    "set_threads",
    "solve",
    "transport_operator",
    "view_factors",
]
