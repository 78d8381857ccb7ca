"""Blender's world as light of the sky."""
from __future__ import annotations

import math
import os
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from .model import Model
from .shaders import output_node, read_shader, source
from .units import triple

PANORAMA_HEIGHT, PANORAMA_SAMPLES = 512, 16  # of worlds that other nodes than a picture make


def add_world(model: Model, world: Any, folder: Path, notes: list[str]) -> None:
    """Adds the world's light: one colour, an equirectangular picture, or whatever its nodes show, rendered by Cycles."""
    if world is None:
        return
    if not world.use_nodes:
        model.world = triple(world.color)
        return
    node = output_node(world.node_tree)
    shader = source(node.inputs["Surface"]) if node else None
    if shader is None:
        return
    background = shader.node
    if background.type == "BACKGROUND" and not background.inputs["Strength"].is_linked:
        reading = read_shader(shader, (0, 0, 0))
        if not reading.notes and reading.emission_picture is None:
            model.world = triple([max(0.0, c) for c in reading.emission])
            return
        model.sky = picture_sky(background)
        if model.sky:
            return
    if background.type == "BACKGROUND" and source(background.inputs["Strength"]) is None and \
            background.inputs["Strength"].default_value <= 0:
        return
    file = folder / "world.exr"
    render_panorama(world, file)
    model.sky = f"image={file}"
    notes.append(f"world: rendered to a picture of {2 * PANORAMA_HEIGHT} x {PANORAMA_HEIGHT} pixels for exitance")


def picture_sky(background: Any) -> str:
    """Returns the argument of --sky for an environment picture that is turned about the vertical at most, else nothing."""
    output = source(background.inputs["Color"])
    if output is None or output.node.type != "TEX_ENVIRONMENT" or output.node.image is None:
        return ""
    node, strength = output.node, background.inputs["Strength"].default_value
    file = bpy.path.abspath(node.image.filepath)
    if node.projection != "EQUIRECTANGULAR" or Path(file).suffix.lower() not in (".hdr", ".exr") or "," in file:
        return ""
    if node.image.packed_file or not os.path.isfile(file) or strength <= 0:
        return ""
    angle = vertical_angle(source(node.inputs["Vector"]))
    if angle is None:
        return ""
    return f"image={file},rotation={-math.degrees(angle):.9g},scale={strength:.9g}"


def vertical_angle(output: Any) -> float | None:
    """Returns the Z rotation of a mapping of generated coordinates, radians, or None for other coordinates."""
    if output is None or (output.node.type == "TEX_COORD" and output.name == "Generated"):
        return 0.0
    node = output.node
    if node.type != "MAPPING" or node.vector_type not in ("POINT", "TEXTURE"):
        return None
    before = source(node.inputs["Vector"])
    if before is None or before.node.type != "TEX_COORD" or before.name != "Generated":
        return None
    if any(node.inputs[name].is_linked for name in ("Location", "Rotation", "Scale")):
        return None
    rotation = node.inputs["Rotation"].default_value
    plain = tuple(node.inputs["Location"].default_value) == (0, 0, 0) and rotation[0] == rotation[1] == 0
    if not plain or tuple(node.inputs["Scale"].default_value) != (1, 1, 1):
        return None
    return rotation[2] if node.vector_type == "POINT" else -rotation[2]


def remove_negative_light(file: Path) -> None:
    """Replaces values below 0, which nodes can make and exitance refuses, by 0."""
    image = bpy.data.images.load(str(file), check_existing=False)
    values = np.empty(image.size[0] * image.size[1] * image.channels, dtype=np.float32)
    image.pixels.foreach_get(values)
    if values.min() < 0:
        image.pixels.foreach_set(np.maximum(values, 0))
        image.save()
    bpy.data.images.remove(image)


def render_panorama(world: Any, file: Path) -> None:
    """Renders a world alone by Cycles into an equirectangular picture whose middle looks along +x."""
    scene = bpy.data.scenes.new("exitance world")
    data = bpy.data.cameras.new("exitance world")
    camera = bpy.data.objects.new("exitance world", data)
    try:
        scene.world, scene.camera = world, camera
        scene.collection.objects.link(camera)
        camera.rotation_euler = (math.pi / 2, 0, -math.pi / 2)
        scene.render.engine = "CYCLES"
        data.type = "PANO"
        settings = data if hasattr(data, "panorama_type") else data.cycles  # Cycles' own before Blender 4
        settings.panorama_type = "EQUIRECTANGULAR"
        scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising = "CPU", PANORAMA_SAMPLES, False
        scene.cycles.use_adaptive_sampling = False
        scene.render.resolution_x, scene.render.resolution_y = 2 * PANORAMA_HEIGHT, PANORAMA_HEIGHT
        scene.render.resolution_percentage = 100
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        scene.render.filepath = str(file)
        bpy.ops.render.render(write_still=True, scene=scene.name)
        remove_negative_light(file)
    finally:
        bpy.data.objects.remove(camera)
        bpy.data.cameras.remove(data)
        bpy.data.scenes.remove(scene)
