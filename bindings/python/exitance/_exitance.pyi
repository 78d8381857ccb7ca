"""Types of the compiled part. The docstrings are in the module itself: help(exitance.solve)."""

from os import PathLike
from typing import Any, Callable, Mapping, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Path = Union[str, PathLike[str]]
_Progress = Union[None, bool, Callable[[str, float], Any]]
_Doubles = NDArray[np.float64]
_Floats = NDArray[np.float32]

__version__: str
bands: int

class Material:
    @property
    def name(self) -> str: ...
    @property
    def reflectance(self) -> _Doubles: ...
    @property
    def exitance(self) -> _Doubles: ...

class Finding:
    @property
    def kind(self) -> str: ...
    @property
    def where(self) -> str: ...
    @property
    def message(self) -> str: ...
    @property
    def hint(self) -> str: ...

class Face:
    @property
    def outline(self) -> _Doubles: ...
    @property
    def normal(self) -> _Doubles: ...
    @property
    def area(self) -> float: ...
    @property
    def material(self) -> int: ...
    @property
    def group(self) -> int: ...

class Scene:
    """A checked, immutable scene: polygons with materials, lights, skies. Lengths are in metres."""

    def __init__(
        self,
        vertices: ArrayLike,
        faces: Union[NDArray[Any], Sequence[Sequence[int]]],
        *,
        reflectance: ArrayLike = 0.5,
        exitance: ArrayLike = 0.0,
        material: Union[None, ArrayLike] = None,
        names: Sequence[str] = (),
        groups: Sequence[str] = (),
        photometric: bool = False,
        sky: Union[None, str] = None,
        epw: Union[None, _Path] = None,
        light_groups: bool = False,
    ) -> None: ...
    def __len__(self) -> int: ...
    def face(self, index: int) -> Face: ...
    @property
    def materials(self) -> list[Material]: ...
    @property
    def groups(self) -> list[str]: ...
    @property
    def area(self) -> float: ...
    @property
    def areas(self) -> _Doubles: ...
    @property
    def bounds(self) -> _Doubles: ...
    @property
    def has_light(self) -> bool: ...
    @property
    def has_light_groups(self) -> bool: ...
    @property
    def is_photometric(self) -> bool: ...
    @property
    def findings(self) -> list[Finding]: ...

class Mesh:
    """The light on triangles: read-only views of memory."""

    @property
    def vertices(self) -> _Doubles: ...
    @property
    def triangles(self) -> NDArray[np.uint32]: ...
    @property
    def irradiance(self) -> _Floats: ...
    @property
    def radiosity(self) -> _Floats: ...
    @property
    def face(self) -> NDArray[np.int32]: ...

class Camera:
    """A camera; `fov` is in degrees."""

    def __init__(
        self,
        eye: ArrayLike,
        target: ArrayLike,
        fov: float = 60.0,
        up: ArrayLike = (0, 0, 1),
        projection: str = "perspective",
    ) -> None: ...
    @property
    def eye(self) -> _Doubles: ...
    @property
    def target(self) -> _Doubles: ...
    @property
    def fov(self) -> float: ...
    @property
    def up(self) -> _Doubles: ...
    @property
    def projection(self) -> str: ...

class Picture:
    """A picture of a solution."""

    @property
    def size(self) -> tuple[int, int]: ...
    @property
    def camera(self) -> Camera: ...
    @property
    def radiance(self) -> _Floats: ...
    @property
    def irradiance(self) -> _Floats: ...
    def display(self, exposure: float = 0.0) -> NDArray[np.uint8]: ...
    def save(self, path: _Path, exposure: float = 0.0) -> None: ...

class LightMap:
    @property
    def irradiance(self) -> _Floats: ...
    @property
    def coverage(self) -> _Floats: ...

class Chart:
    @property
    def map(self) -> int: ...
    @property
    def x(self) -> int: ...
    @property
    def y(self) -> int: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def origin(self) -> _Doubles: ...
    @property
    def right(self) -> _Doubles: ...
    @property
    def down(self) -> _Doubles: ...
    @property
    def faces(self) -> list[int]: ...

class LightMaps:
    """Irradiance as images that cover all surfaces."""

    @property
    def density(self) -> float: ...
    def __len__(self) -> int: ...
    def __getitem__(self, index: int) -> LightMap: ...
    @property
    def charts(self) -> list[Chart]: ...
    @property
    def warnings(self) -> list[str]: ...
    def save(self, folder: _Path) -> None: ...

class GlareSource:
    """A source of glare."""

    @property
    def name(self) -> str: ...
    @property
    def direction(self) -> _Doubles: ...
    @property
    def luminance(self) -> float: ...
    @property
    def solid_angle(self) -> float: ...
    @property
    def position(self) -> float: ...

class Glare:
    """Daylight glare at an eye at one moment."""

    @property
    def probability(self) -> float: ...
    @property
    def bounds(self) -> Union[None, list[float]]: ...
    @property
    def level(self) -> str: ...
    @property
    def vertical_illuminance(self) -> float: ...
    @property
    def mean_luminance(self) -> float: ...
    @property
    def threshold(self) -> float: ...
    @property
    def sources(self) -> list[GlareSource]: ...

class LightProbes:
    """Light that arrives at points from all directions, as spherical harmonics."""

    def __len__(self) -> int: ...
    @property
    def radiance(self) -> _Doubles: ...
    @property
    def standard_error(self) -> _Doubles: ...
    @property
    def back_share(self) -> _Doubles: ...
    def irradiance(self, normal: ArrayLike) -> _Doubles:
        """Irradiance on planes of one normal at all points, (n, bands) W/m^2."""

class Solution:
    """The light of a scene, evaluated anywhere. Direct light is exact, shadows included."""

    def irradiance(self, points: ArrayLike, normals: ArrayLike, *, component: str = "total") -> _Doubles:
        """Irradiance at points, (n, bands) W/m^2."""
    def radiosity(self, points: ArrayLike, normals: ArrayLike) -> _Doubles:
        """Emitted and reflected light at points of surfaces, (n, bands) W/m^2; NaN in the air."""
    @property
    def error(self) -> Union[None, float]: ...
    @property
    def error_bound(self) -> Union[None, float]: ...
    @property
    def converged(self) -> bool: ...
    @property
    def stopped_by(self) -> str: ...
    @property
    def energy(self) -> dict[str, float]: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def stats(self) -> dict[str, Any]: ...
    @property
    def scene(self) -> Scene: ...
    def mesh(self) -> Mesh: ...
    def export(self, path: _Path) -> None: ...
    def save(self, path: _Path) -> None: ...
    @property
    def light_groups(self) -> list[str]: ...
    def mix(self, dim: Mapping[str, float] = ..., reflectance: Mapping[str, ArrayLike] = ...) -> "Solution": ...
    def render(
        self,
        camera: Union[None, Camera] = None,
        size: tuple[int, int] = (640, 400),
        samples: int = 16,
        progress: _Progress = None,
    ) -> Picture: ...
    def bake(
        self,
        density: float = 0.0,
        padding: int = 4,
        uv: str = "",
        size: Union[None, tuple[int, int]] = None,
        faceted: bool = False,
        progress: _Progress = None,
    ) -> LightMaps: ...
    def glare(
        self,
        eye: ArrayLike,
        direction: ArrayLike,
        *,
        threshold: Union[float, str] = 2000.0,
        efficacy: float = 179.0,
        progress: _Progress = None,
    ) -> Glare:
        """Daylight glare probability at an eye."""
    def probes(self, points: ArrayLike, *, rays: int = 1024, progress: _Progress = None) -> LightProbes:
        """Light that arrives at points from all directions, as spherical harmonics."""

class PaneGroup:
    """A group of panes whose state changes from hour to hour."""

    @property
    def name(self) -> str: ...
    @property
    def states(self) -> list[str]: ...
    @property
    def chosen(self) -> NDArray[np.uint8]: ...

class GlassVariant:
    """Results of all sensors with other glass, which a file of states lists."""

    @property
    def name(self) -> str: ...
    @property
    def spatial_autonomy(self) -> float: ...
    @property
    def spatial_autonomy_bounds(self) -> list[float]: ...
    @property
    def continuous_autonomy(self) -> float: ...
    @property
    def mean_illuminance(self) -> float: ...
    @property
    def sunlight_exposure(self) -> float: ...

class Daylight:
    """Illuminances of sensors in every hour of a weather file, and their annual figures."""

    @property
    def hours(self) -> NDArray[np.int32]: ...
    @property
    def illuminance(self) -> _Floats: ...
    @property
    def sun(self) -> _Floats: ...
    @property
    def daylight_factor(self) -> _Doubles: ...
    @property
    def autonomy(self) -> _Doubles: ...
    @property
    def useful(self) -> _Doubles: ...
    @property
    def sunny_hours(self) -> _Doubles: ...
    @property
    def spatial_autonomy(self) -> float: ...
    @property
    def sunlight_exposure(self) -> float: ...
    @property
    def daylight_factor_bounds(self) -> _Doubles: ...
    @property
    def autonomy_bounds(self) -> _Doubles: ...
    @property
    def error_daylight_factor(self) -> float: ...
    @property
    def error_lux_hours(self) -> float: ...
    @property
    def pane_groups(self) -> list[PaneGroup]: ...
    @property
    def glass_variants(self) -> list[GlassVariant]: ...
    @property
    def warnings(self) -> list[str]: ...

def load(
    *files: _Path,
    strict: bool = False,
    length_unit: Union[None, float] = None,
    up: str = "",
    turn_bodies: bool = False,
    luminaires: Union[None, _Path] = None,
    sky: Union[None, str] = None,
    epw: Union[None, _Path] = None,
    photometric: Union[None, bool] = None,
    light_groups: bool = False,
    texture_parts: Union[None, int] = None,
    lod: Union[None, str] = None,
) -> Scene:
    """Reads the files of one scene, checks and repairs it."""
def load_solution(path: _Path) -> Solution:
    """Reads a solution file."""
def set_threads(count: int) -> None:
    """Sets the number of threads for all later calls; 0 means all cores."""
def solve(
    scene: Scene,
    error: Union[None, float] = None,
    *,
    method: str = "auto",
    bounces: Union[None, int] = None,
    time_limit: Union[None, float] = None,
    memory_limit: Union[None, int] = None,
    threads: Union[None, int] = None,
    progress: _Progress = None,
    **more: Union[None, bool, int, float, str],
) -> Solution:
    """Computes the light of a scene until its estimated error is below the requested one."""
def view_factors(
    scene: Scene,
    error: Union[None, float] = None,
    *,
    smallest: float = 0.0,
    seed: int = 1,
    tolerance: Union[None, float] = None,
    time_limit: Union[None, float] = None,
    threads: Union[None, int] = None,
    progress: _Progress = None,
) -> Any:
    """View factors between the faces of a scene, as a scipy.sparse.csr_array with attributes."""
class TransportOperator:
    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def dtype(self) -> np.dtype[np.float64]: ...
    def matvec(self, x: ArrayLike) -> _Doubles: ...
    def rmatvec(self, x: ArrayLike) -> _Doubles: ...
    @property
    def areas(self) -> _Doubles: ...
    @property
    def emittances(self) -> _Doubles: ...
    @property
    def sky(self) -> _Doubles: ...
    @property
    def back(self) -> _Doubles: ...
    @property
    def row_errors(self) -> _Doubles: ...
    @property
    def closure_defect(self) -> float: ...
    def save(self, path: _Path) -> None: ...

def transport_operator(
    scene: Scene,
    error: float = 1e-2,
    *,
    seed: int = 1,
    time_limit: Union[None, float] = None,
    threads: Union[None, int] = None,
    progress: _Progress = None,
) -> Any:
    """Transport between the faces of a scene, as a scipy.sparse.linalg.LinearOperator."""
def load_transport_operator(path: _Path) -> Any:
    """Reads an operator, as a scipy.sparse.linalg.LinearOperator."""
def daylight(
    scene: Scene,
    epw: _Path,
    sensors: ArrayLike,
    normals: ArrayLike = (0, 0, 1),
    error: float = 0.02,
    *,
    division: int = 1,
    north: float = 0.0,
    ground: float = 0.2,
    states: Union[None, _Path] = None,
    progress: _Progress = None,
) -> Daylight:
    """Computes the daylight of a year at sensors."""
