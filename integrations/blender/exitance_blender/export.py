"""Exports what is visible in Blender as the model that exitance reads."""
from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from . import lamps, layers, pictures, shaders, sides, world
from .model import Body, Faces, Model, Surface
from .units import Colour, triple

OTHER_KINDS = {"VOLUME", "CURVES", "HAIR", "POINTCLOUD", "GPENCIL", "GREASEPENCIL"}
MESH_KINDS = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
HIGHEST_REFLECTANCE = 0.95  # that exitance takes


@dataclass
class Exporter:
    """State of an export.

    soft_lamps  whether point lamps with a radius become spheres
    shown       names of objects whose baked light can be shown, with their light map layer
    notes       what could not be taken over, for people
    """

    folder: Path
    layer_name: str
    soft_lamps: bool
    model: Model = field(default_factory=Model)
    shown: dict[str, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    _surfaces: dict[tuple[str, bool], Surface] = field(default_factory=dict)
    _files: dict[str, str] = field(default_factory=dict)
    _eyes: list[Any] = field(default_factory=list)

    def run(self, context: bpy.types.Context) -> None:
        """Fills the model from the evaluated scene: the world, then lamps, then faces."""
        depsgraph = context.evaluated_depsgraph_get()
        world.add_world(self.model, context.scene.world, self.folder, self.notes)
        instances = self._visible(depsgraph)
        self._eyes = [matrix.translation[:] for thing, matrix, _, _ in instances if thing.type in ("LIGHT", "CAMERA")]
        for original, matrix, is_instance, name in _unique_names(instances):
            thing = original.evaluated_get(depsgraph)
            to_world = np.array(matrix)
            if thing.type == "LIGHT":
                self._add_lamp(thing.data, name, to_world)
            elif thing.type in MESH_KINDS:
                self._add_mesh(depsgraph, thing, name, to_world, is_instance)
            elif thing.type in OTHER_KINDS:
                self.note(f"{name}: is left out, because it has no faces")

    def _visible(self, depsgraph: Any) -> list[Any]:
        """Returns (original object, matrix, is_instance, name) of all that is visible.

        Objects that an iteration yields are valid only in it, so originals are kept. A text or curve is yielded twice: as
        itself, and as an instance of its faces.
        """
        visible = []
        for instance in depsgraph.object_instances:
            original, parent = instance.object.original, instance.parent.original if instance.parent else None
            if not instance.show_self or original.hide_render:
                continue
            if instance.is_instance and parent == original:
                if original.type == "MESH":
                    self.note(f"{original.name}: instances by its geometry nodes are left out; add the node Realize Instances")
                continue
            name = f"{original.name} of {parent.name}" if instance.is_instance and parent else original.name
            visible.append((original, instance.matrix_world.copy(), instance.is_instance, name))
        return visible

    def note(self, text: str) -> None:
        """Keeps a note once."""
        if text not in self.notes:
            self.notes.append(text)

    def _add_lamp(self, lamp: Any, name: str, to_world: np.ndarray) -> None:
        reading = shaders.read_lamp(lamp)
        for text in reading.notes:
            self.note(f"lamp {name}: {text}")
        strength = triple([c * f * lamp.energy for c, f in zip(lamp.color, reading.emission)])
        if max(strength) <= 0:
            return
        if min(strength) < 0:
            return self.note(f"lamp {name}: negative light is left out")
        axis = -to_world[:3, 2] / np.linalg.norm(to_world[:3, 2])
        position = to_world[:3, 3]
        if lamp.type == "POINT":
            lamps.add_point(self.model, name, strength, position, lamp.shadow_soft_size if self.soft_lamps else 0)
        elif lamp.type == "SUN":
            if self.model.sky and lamp.angle > lamps.SMALLEST_DISC:
                self.note(f"lamp {name}: the sun is parallel light, because the world is a picture")
            lamps.add_sun(self.model, name, strength, axis, lamp.angle)
        elif lamp.type == "SPOT":
            if lamp.shadow_soft_size > 0:
                self.note(f"lamp {name}: a spot is a point, so its shadows are hard")
            lamps.add_spot(self.model, name, strength, position, axis, lamp.spot_size, lamp.spot_blend)
        else:
            self._add_area_lamp(lamp, name, strength, to_world)

    def _add_area_lamp(self, lamp: Any, name: str, strength: Colour, to_world: np.ndarray) -> None:
        if getattr(lamp, "spread", math.pi) < math.pi * 0.999:
            self.note(f"lamp {name}: its spread is left out, so it shines to all sides with the same power")
        is_long = lamp.shape in ("RECTANGLE", "ELLIPSE")
        is_round = lamp.shape in ("DISK", "ELLIPSE")
        lamps.add_area(self.model, name, strength, to_world, lamp.size, lamp.size_y if is_long else lamp.size, is_round)

    def _add_mesh(self, depsgraph: Any, thing: Any, name: str, to_world: np.ndarray, is_instance: bool) -> None:
        mesh = thing.to_mesh(preserve_all_data_layers=True, depsgraph=depsgraph)
        if mesh is None or len(mesh.polygons) == 0:
            thing.to_mesh_clear()
            return
        corners = _Corners(mesh, to_world)
        layer = "" if thing.type != "MESH" else layers.light_map_layer(mesh, self.layer_name)
        if is_instance or not layer:
            self.note(f"{name}: is lit, but its light is not shown, because it is " +
                      ("an instance" if is_instance else "no mesh with a UV map"))
        else:
            self.shown[name] = layer
        corners.turn(sides.faces_to_turn(corners.points, corners.triangles, np.array(self._eyes).reshape(-1, 3)))
        texture = layers.coordinates(mesh, layers.texture_layer(mesh, layer), corners.loops)
        light_map = layers.coordinates(mesh, layer, corners.loops) if layer else layers.separate_cells(len(corners.triangles))
        faces = []
        for slot in np.unique(corners.slots):
            material = thing.material_slots[slot].material if slot < len(thing.material_slots) else None
            chosen = np.repeat(corners.slots == slot, 3)
            surface = self._surface(material, corners.is_open)
            faces.append(Faces(surface, corners.positions()[chosen], corners.normals[chosen], texture[chosen],
                               light_map[chosen]))
        self.model.bodies.append(Body(name, faces))
        thing.to_mesh_clear()

    def _surface(self, material: Any, is_open: bool) -> Surface:
        """Returns the surface of a material. Faces of open meshes reflect on both sides, unless their backs are culled."""
        name = material.name if material else "grey"
        both = is_open and not (material and material.use_backface_culling)
        if (name, both) in self._surfaces:
            return self._surfaces[name, both]
        reading = shaders.read_material(material)
        for text in reading.notes:
            self.note(f"material {name}: {text}")
        is_clear = reading.transmission >= 0.5
        reflectance = triple([min(max(c, 0), 1 if is_clear else HIGHEST_REFLECTANCE) for c in reading.reflectance])
        surface = Surface(name, reflectance, triple([max(c, 0) for c in reading.emission]),
                          reading.transmission if is_clear else 0, both, self._picture(reading.picture),
                          self._picture(reading.emission_picture))
        self._surfaces[name, both] = surface
        return surface

    def _picture(self, image: Any) -> str:
        """Writes a picture once; returns its file's name, or nothing without a picture."""
        if image is None or image.size[0] == 0:
            return ""
        if image.name not in self._files:
            width, height = image.size
            values = np.empty(width * height * image.channels, dtype=np.float32)
            image.pixels.foreach_get(values)
            pixels = values.reshape(height, width, -1)[::-1]
            pixels = pixels[:, :, :3] if image.channels >= 3 else np.repeat(pixels[:, :, :1], 3, axis=2)
            if image.is_float or image.colorspace_settings.name != "sRGB":
                pixels = pictures.srgb(pixels)
            self._files[image.name] = f"picture_{len(self._files)}.png"
            pictures.write_png(self.folder / self._files[image.name], pictures.reduced(pixels))
        return self._files[image.name]


class _Corners:
    """Triangles of an evaluated mesh in the scene's axes; a mirroring transform keeps the fronts."""

    def __init__(self, mesh: Any, to_world: np.ndarray) -> None:
        if hasattr(mesh, "calc_normals_split"):
            mesh.calc_normals_split()  # Blender 4.1 computes them when they are read
        mesh.calc_loop_triangles()
        count = len(mesh.loop_triangles)
        vertices = np.empty(3 * len(mesh.vertices), dtype=np.float32)
        mesh.vertices.foreach_get("co", vertices)
        self.points = vertices.reshape(-1, 3).astype(float) @ to_world[:3, :3].T + to_world[:3, 3]
        self.triangles = _integers(mesh.loop_triangles, "vertices", 3 * count).reshape(-1, 3)
        self.loops = _integers(mesh.loop_triangles, "loops", 3 * count)
        self.slots = _integers(mesh.loop_triangles, "material_index", count)
        normals = np.empty(3 * len(mesh.loops), dtype=np.float32)
        if hasattr(mesh, "corner_normals"):
            mesh.corner_normals.foreach_get("vector", normals)
        else:
            mesh.loops.foreach_get("normal", normals)
        turned = normals.reshape(-1, 3)[self.loops].astype(float) @ np.linalg.pinv(to_world[:3, :3])
        lengths = np.linalg.norm(turned, axis=1)[:, None]
        self.normals = np.divide(turned, lengths, out=np.tile([0.0, 0.0, 1.0], (len(turned), 1)), where=lengths > 0)
        uses = np.bincount(_integers(mesh.loops, "edge_index", len(mesh.loops)), minlength=1)
        self.is_open = bool(np.any(uses[uses > 0] != 2))
        if np.linalg.det(to_world[:3, :3]) < 0:
            self._swap(np.ones(count, dtype=bool))

    def positions(self) -> np.ndarray:
        """Returns the places of all corners."""
        return self.points[self.triangles.ravel()]

    def turn(self, chosen: np.ndarray) -> None:
        """Makes the other side of some triangles their front."""
        self._swap(chosen)
        self.normals[np.repeat(chosen, 3)] *= -1

    def _swap(self, chosen: np.ndarray) -> None:
        """Reverses the order of the corners of some triangles."""
        order = np.arange(3 * len(chosen)).reshape(-1, 3)
        order[chosen] = order[chosen][:, [0, 2, 1]]
        flat = order.ravel()
        self.triangles = self.triangles.ravel()[flat].reshape(-1, 3)
        self.loops, self.normals = self.loops[flat], self.normals[flat]


def _integers(collection: Any, name: str, count: int) -> np.ndarray:
    """Returns an attribute of all items as integers."""
    values = np.empty(count, dtype=np.int32)
    collection.foreach_get(name, values)
    return values


def _unique_names(instances: list[Any]) -> list[Any]:
    """Returns (object, matrix, is_instance, name) with numbers where instances share a name."""
    seen: dict[str, int] = {}
    out = []
    for thing, matrix, is_instance, name in instances:
        seen[name] = seen.get(name, 0) + 1
        out.append((thing, matrix, is_instance, name if seen[name] == 1 else f"{name} #{seen[name]}"))
    return out
