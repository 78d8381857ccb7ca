"""A scene as it is handed to exitance: plain data without Blender, and its glTF file."""
from __future__ import annotations

import json
import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .units import Colour

FLOAT, ARRAY_BUFFER = 5126, 34962  # constants of glTF 2.0
SKY_GROUP = "sky"                   # exitance's light group of world and suns


@dataclass(frozen=True)
class Surface:
    """Material of faces.

    reflectance    diffuse, per channel, in [0, 1]
    emission       radiance, W/(m^2 sr), per channel
    transmission   share of the light that a clear pane lets through; 0: opaque
    picture        file of a picture that multiplies the reflectance, relative to the glTF file; read with the first UV set
    emission_picture  file of a picture that multiplies the emission
    """

    name: str
    reflectance: Colour = (0.5, 0.5, 0.5)
    emission: Colour = (0, 0, 0)
    transmission: float = 0
    double_sided: bool = False
    picture: str = ""
    emission_picture: str = ""


@dataclass(frozen=True)
class Faces:
    """Triangles of one material: three corners each, one after the other, counter-clockwise seen from the front.

    positions  (corners, 3), metres, Z up         normals  (corners, 3), unit vectors
    texture, light_map  (corners, 2), coordinates of pictures and of the light map, (0, 0) at the lower left
    """

    surface: Surface
    positions: np.ndarray
    normals: np.ndarray
    texture: np.ndarray
    light_map: np.ndarray


@dataclass(frozen=True)
class Body:
    """An object, which is also a light group if its faces emit."""

    name: str
    faces: list[Faces]


@dataclass(frozen=True)
class Light:
    """A light without extent.

    kind       "point", "spot" (intensity in W/sr) or "directional" (irradiance in W/m^2)
    direction  towards which it shines, a unit vector; not used by points
    cones      half angles of a spot, inner and outer, radians
    """

    name: str
    kind: str
    intensity: Colour
    position: tuple[float, float, float] = (0, 0, 0)
    direction: tuple[float, float, float] = (0, 0, -1)
    cones: tuple[float, float] = (0, 0.5)


@dataclass(frozen=True)
class Sun:
    """A disc in the sky: radiance in W/(m^2 sr), the unit vector towards it, its diameter in radians."""

    name: str
    radiance: Colour
    towards: tuple[float, float, float]
    angle: float


@dataclass
class Model:
    """All that is handed over.

    world  radiance from all directions, W/(m^2 sr)
    sky    argument of `solve --sky`, or empty; it replaces `world` and `suns`
    """

    bodies: list[Body] = field(default_factory=list)
    lights: list[Light] = field(default_factory=list)
    suns: list[Sun] = field(default_factory=list)
    world: Colour = (0, 0, 0)
    sky: str = ""

    def emitters(self) -> list[str]:
        """Returns the light groups that exitance makes: emitting bodies, lights without extent, and all distant light."""
        names = [b.name for b in self.bodies if any(max(f.surface.emission) > 0 for f in b.faces)]
        names += [light.name for light in self.lights]
        return names + [SKY_GROUP] if self.suns or self.sky or max(self.world) > 0 else names


def _turned(vectors: np.ndarray) -> np.ndarray:
    """Returns vectors with Z up as glTF has them, with Y up: (x, z, -y)."""
    return np.stack([vectors[:, 0], vectors[:, 2], -vectors[:, 1]], axis=1)


def _downward(coordinates: np.ndarray) -> np.ndarray:
    """Returns texture coordinates as glTF has them, from the upper left corner."""
    return np.stack([coordinates[:, 0], 1 - coordinates[:, 1]], axis=1)


class _Buffer:
    """Collects the numbers of a glTF file and describes them."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def add(self, array: np.ndarray) -> int:
        """Appends rows of numbers; returns the index of their accessor."""
        rows = np.ascontiguousarray(array, dtype="<f4")
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": rows.nbytes, "target": ARRAY_BUFFER})
        self.data += rows.tobytes()
        self.accessors.append({
            "bufferView": len(self.views) - 1, "componentType": FLOAT, "count": len(rows), "type": f"VEC{rows.shape[1]}",
            "min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()})
        return len(self.accessors) - 1


class _Pictures:
    """Pictures of a glTF file, each listed once."""

    def __init__(self) -> None:
        self.files: list[str] = []

    def texture(self, file: str) -> dict[str, int]:
        """Returns the reference to a picture that is read with the first set of coordinates."""
        if file not in self.files:
            self.files.append(file)
        return {"index": self.files.index(file), "texCoord": 0}


def _material(surface: Surface, pictures: _Pictures) -> dict[str, Any]:
    """Returns a material of glTF."""
    extensions: dict[str, Any] = {}
    shading: dict[str, Any] = {"baseColorFactor": [*surface.reflectance, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}
    material: dict[str, Any] = {"name": surface.name, "pbrMetallicRoughness": shading, "doubleSided": surface.double_sided}
    if surface.picture:
        shading["baseColorTexture"] = pictures.texture(surface.picture)
    strength = max(surface.emission)
    if strength > 0:
        material["emissiveFactor"] = [channel / strength for channel in surface.emission]
        extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        if surface.emission_picture:
            material["emissiveTexture"] = pictures.texture(surface.emission_picture)
    if surface.transmission > 0:
        extensions["KHR_materials_transmission"] = {"transmissionFactor": surface.transmission}
    if extensions:
        material["extensions"] = extensions
    return material


def _rotation_to(direction: tuple[float, float, float]) -> list[float]:
    """Returns the quaternion (x, y, z, w) that turns -z, along which lights of glTF shine, to a unit vector of glTF's axes."""
    x, y, z = direction
    if z > 1 - 1e-12:
        return [0.0, 1.0, 0.0, 0.0]
    quaternion = np.array([y, -x, 0.0, 1 - z])  # (-z) x d, and 1 + (-z) . d
    return (quaternion / np.linalg.norm(quaternion)).tolist()


def _light_node(light: Light, index: int) -> dict[str, Any]:
    """Returns the node that places a light."""
    position = _turned(np.array([light.position]))[0].tolist()
    x, y, z = light.direction
    return {"name": light.name, "translation": position, "rotation": _rotation_to((x, z, -y)),
            "extensions": {"KHR_lights_punctual": {"light": index}}}


def _light(light: Light) -> dict[str, Any]:
    """Returns a light of glTF, whose colour has a largest channel of 1."""
    peak = max(light.intensity)
    colour = [channel / peak for channel in light.intensity]
    described: dict[str, Any] = {"name": light.name, "type": light.kind, "color": colour, "intensity": peak}
    if light.kind == "spot":
        described["spot"] = {"innerConeAngle": light.cones[0], "outerConeAngle": light.cones[1]}
    return described


def write_glb(model: Model, file: Path) -> None:
    """Writes bodies and lights as a binary glTF 2.0 file. The second set of coordinates of every mesh is the light map's."""
    buffer, pictures = _Buffer(), _Pictures()
    surfaces: dict[Surface, int] = {}
    nodes: list[dict[str, Any]] = []
    meshes: list[dict[str, Any]] = []
    for body in model.bodies:
        primitives = []
        for faces in body.faces:
            attributes = {"POSITION": buffer.add(_turned(faces.positions)), "NORMAL": buffer.add(_turned(faces.normals)),
                          "TEXCOORD_0": buffer.add(_downward(faces.texture)),
                          "TEXCOORD_1": buffer.add(_downward(faces.light_map))}
            material = surfaces.setdefault(faces.surface, len(surfaces))
            primitives.append({"attributes": attributes, "material": material, "mode": 4})
        nodes.append({"name": body.name, "mesh": len(meshes)})
        meshes.append({"name": body.name, "primitives": primitives})
    nodes += [_light_node(light, i) for i, light in enumerate(model.lights)]
    document: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "exitance add-on for Blender"}, "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "meshes": meshes,
        "materials": [_material(surface, pictures) for surface in surfaces],
        "accessors": buffer.accessors, "bufferViews": buffer.views, "buffers": [{"byteLength": len(buffer.data)}]}
    if model.lights:
        document["extensions"] = {"KHR_lights_punctual": {"lights": [_light(light) for light in model.lights]}}
    if pictures.files:
        document["images"] = [{"uri": name} for name in pictures.files]
        document["textures"] = [{"source": i} for i in range(len(pictures.files))]
    used = ["KHR_lights_punctual"] if model.lights else []
    used += sorted({name for material in document["materials"] for name in material.get("extensions", {})})
    if used:
        document["extensionsUsed"] = used
    _write_chunks(file, document, bytes(buffer.data))


def _write_chunks(file: Path, document: dict[str, Any], data: bytes) -> None:
    """Writes the two parts of a .glb file, padded to multiples of four bytes."""
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    total = 12 + 8 + len(text) + 8 + len(data)
    with open(file, "wb") as out:
        out.write(struct.pack("<4sII", b"glTF", 2, total))
        out.write(struct.pack("<I4s", len(text), b"JSON") + text)
        out.write(struct.pack("<I4s", len(data), b"BIN\0") + data)


def write_distant_light(model: Model, file: Path) -> None:
    """Writes suns and a world of one colour as Radiance's `source`, which exitance reads as a second file of the scene."""
    with open(file, "w", encoding="ascii") as out:
        for i, sun in enumerate(model.suns):
            red, green, blue = sun.radiance
            x, y, z = sun.towards
            out.write(f"void light sun_{i}_light\n0\n0\n3 {red!r} {green!r} {blue!r}\n")
            out.write(f"sun_{i}_light source sun_{i}\n0\n0\n4 {x!r} {y!r} {z!r} {np.degrees(sun.angle):.9g}\n")
        if max(model.world) > 0:
            red, green, blue = model.world
            out.write(f"void glow world_light\n0\n0\n4 {red!r} {green!r} {blue!r} 0\n")
            out.write("world_light source world\n0\n0\n4 0 0 1 360\n")
