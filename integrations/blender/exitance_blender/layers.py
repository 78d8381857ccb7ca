"""UV layers of meshes: which one is for the light map, and how one is made."""
from __future__ import annotations

import math
from typing import Any

import bpy
import numpy as np

SHARPEST_ANGLE = math.radians(66)  # between faces of one chart; Blender's own default
CHART_MARGIN = 0.02                # of the map between charts: 5 texels of 256


def light_map_layer(mesh: Any, name: str) -> str:
    """Returns the UV layer for the light map: the one of `name`, else the second one; empty if the mesh has neither."""
    if name in mesh.uv_layers:
        return name
    return mesh.uv_layers[1].name if len(mesh.uv_layers) > 1 else ""


def texture_layer(mesh: Any, light_map: str) -> str:
    """Returns the UV layer that pictures use: the one active for rendering. Empty if there is none."""
    return next((layer.name for layer in mesh.uv_layers if layer.active_render), light_map)


def coordinates(mesh: Any, layer: str, loops: np.ndarray) -> np.ndarray:
    """Returns the coordinates (n, 2) of a layer at loops, zeros without a layer."""
    values = np.zeros(2 * len(mesh.loops), dtype=np.float32)
    if layer:
        mesh.uv_layers[layer].data.foreach_get("uv", values)
    return values.reshape(-1, 2)[loops]


def separate_cells(count: int) -> np.ndarray:
    """Returns coordinates (3 count, 2) with a cell of the map for each triangle, for faces whose map is not shown."""
    grid = max(1, math.ceil(math.sqrt(count)))
    cells = np.arange(count)
    corner = np.array([[0.2, 0.2], [0.8, 0.2], [0.2, 0.8]])
    origin = np.stack([cells % grid, cells // grid], axis=1)
    return ((origin[:, None] + corner[None]) / grid).reshape(-1, 2)


def unwrap_objects(context: bpy.types.Context, name: str) -> list[str]:
    """Gives a layer of charts to every visible mesh object without one for light maps; returns the objects' names.

    Blender's Smart UV Project makes the charts. The mode must be object mode.
    Selection and active layers are as before afterwards.
    """
    bare = [thing for thing in context.visible_objects if thing.type == "MESH" and not thing.hide_render and
            len(thing.data.polygons) > 0 and thing.data.library is None and not light_map_layer(thing.data, name)]
    if not bare:
        return []
    active, selected = context.view_layer.objects.active, list(context.selected_objects)
    made, meshes = [], set()
    for thing in bare:
        if thing.data in meshes:
            continue
        meshes.add(thing.data)
        _unwrap(context, thing, name)
        made.append(thing.name)
    for thing in context.view_layer.objects:
        thing.select_set(thing in selected)
    context.view_layer.objects.active = active
    return made


def _unwrap(context: bpy.types.Context, thing: Any, name: str) -> None:
    """Makes the layer `name` of one object."""
    uv_layers = thing.data.uv_layers
    former = uv_layers.active.name if uv_layers.active else None
    uv_layers.active = uv_layers.new(name=name, do_init=False)
    for other in context.view_layer.objects:
        other.select_set(False)
    context.view_layer.objects.active = thing
    thing.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.reveal(select=False)
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project(angle_limit=SHARPEST_ANGLE, island_margin=CHART_MARGIN)
    bpy.ops.object.mode_set(mode="OBJECT")
    if former:
        thing.data.uv_layers.active = thing.data.uv_layers[former]
