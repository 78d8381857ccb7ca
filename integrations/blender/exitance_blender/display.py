"""Materials that show baked light: emission of reflectance times irradiance / pi, with a slider for each light group."""
from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import bpy

from .commands import LightMaps
from .export import HIGHEST_REFLECTANCE
from .shaders import GREY, first_input, source
from .units import Colour, triple

SLIDERS = "exitance light groups"  # node group whose values dim the groups in all materials
ORIGINAL, LINK = "exitance_original", "exitance_link"  # custom properties of a material that shows baked light
LIT = "exitance_lit"               # marks these materials


def add_output(tree: Any, name: str, kind: str) -> None:
    """Adds an output to a node group; Blender 4 does this by another call."""
    if hasattr(tree, "interface"):
        tree.interface.new_socket(name, in_out="OUTPUT", socket_type=kind)
    else:
        tree.outputs.new(kind, name)


def slider_tree() -> Any:
    """Returns the node group of the sliders, or None before a bake with light groups."""
    return bpy.data.node_groups.get(SLIDERS)


def make_sliders(groups: list[str]) -> Any:
    """Makes the node group of the sliders anew; groups that were there keep their values. Returns None without groups."""
    old = slider_tree()
    values = {node.label: node.outputs[0].default_value for node in old.nodes if node.type == "VALUE"} if old else {}
    if old:
        bpy.data.node_groups.remove(old)
    if not groups:
        return None
    tree = bpy.data.node_groups.new(SLIDERS, "ShaderNodeTree")
    for i, name in enumerate(groups):
        add_output(tree, name, "NodeSocketFloat")
        value = tree.nodes.new("ShaderNodeValue")
        value.label, value.location = name, (0, -100 * i)
        value.outputs[0].default_value = values.get(name, 1.0)
    out = tree.nodes.new("NodeGroupOutput")
    out.location = (300, 0)
    for i, value in enumerate(node for node in list(tree.nodes) if node.type == "VALUE"):
        tree.links.new(value.outputs[0], out.inputs[i])
    return tree


def load_map(file: Path, pack: bool) -> Any:
    """Loads a light map as numbers, without a change of colours; packs it into the .blend file if asked to."""
    image = bpy.data.images.load(str(file), check_existing=True)
    if image.packed_file:
        image.unpack(method="REMOVE")
    image.reload()
    image.colorspace_settings.name = "Non-Color"
    if pack:
        image.pack()
    return image


def vector_node(tree: Any, operation: str, *inputs: Any, scale: Any = None) -> Any:
    """Adds a vector operation on sockets or values; returns its output."""
    node = tree.nodes.new("ShaderNodeVectorMath")
    node.operation = operation
    pairs = list(zip(node.inputs, inputs)) + ([(node.inputs["Scale"], scale)] if scale is not None else [])
    for socket, value in pairs:
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, socket)
        else:
            socket.default_value = value
    return node.outputs[0]


def make_light_tree(name: str, layer: str, images: list[Any], sliders: Any) -> Any:
    """Makes the node group of an object's irradiance, W/m^2: the sum of its maps, each times its slider."""
    title = f"exitance light of {name}"
    old = bpy.data.node_groups.get(title)
    if old:
        bpy.data.node_groups.remove(old)
    tree = bpy.data.node_groups.new(title, "ShaderNodeTree")
    add_output(tree, "Irradiance", "NodeSocketColor")
    coordinates = tree.nodes.new("ShaderNodeUVMap")
    coordinates.uv_map = layer
    dim = tree.nodes.new("ShaderNodeGroup") if sliders else None
    if dim:
        dim.node_tree = sliders
    total = None
    for i, image in enumerate(images):
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image, texture.interpolation, texture.extension = image, "Linear", "EXTEND"
        texture.location = (200, -300 * i)
        tree.links.new(coordinates.outputs[0], texture.inputs["Vector"])
        light = vector_node(tree, "SCALE", texture.outputs["Color"], scale=dim.outputs[i] if dim else 1.0)
        total = light if total is None else vector_node(tree, "ADD", total, light)
    out = tree.nodes.new("NodeGroupOutput")
    tree.links.new(total, out.inputs[0])
    return tree


def plain_material(colour: Colour, name: str) -> Any:
    """Makes a diffuse material of one colour."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    principled = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    principled.inputs["Base Color"].default_value = (*colour, 1)
    return material


def socket_or_value(socket: Any) -> Any:
    """Returns what feeds an input: the linked output, or its value; colours have three channels."""
    linked = source(socket)
    if linked is not None:
        return linked
    value = socket.default_value
    return value if isinstance(value, float) else triple(value)


class _Lighter:
    """Replaces the shaders of one material by the baked light."""

    def __init__(self, tree: Any, light: Any, sliders: Any, group: int | None) -> None:
        self.tree = tree
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = light
        self.irradiance = node.outputs[0]
        self.factor = None  # output that dims the object's own emission
        if group is not None:
            dim = tree.nodes.new("ShaderNodeGroup")
            dim.node_tree = sliders
            self.factor = dim.outputs[group]

    def light_all(self) -> None:
        """Replaces diffuse and principled shaders; dims emission shaders."""
        for node in list(self.tree.nodes):
            if node.type == "BSDF_PRINCIPLED":
                self._replace(node, self._principled(node))
            elif node.type == "BSDF_DIFFUSE":
                self._replace(node, self._reflected(socket_or_value(node.inputs["Color"])))
            elif node.type == "EMISSION" and self.factor is not None:
                self._dim(node)

    def _reflected(self, reflectance: Any) -> Any:
        """Returns the reflected radiance: reflectance irradiance / pi."""
        most = vector_node(self.tree, "MINIMUM", reflectance, (HIGHEST_REFLECTANCE,) * 3)
        product = vector_node(self.tree, "MULTIPLY", most, self.irradiance)
        return vector_node(self.tree, "SCALE", product, scale=1 / math.pi)

    def _principled(self, node: Any) -> Any:
        """Returns the radiance of a Principled BSDF: its diffuse part that is no metal, and its emission."""
        light = self._reflected(socket_or_value(node.inputs["Base Color"]))
        if source(node.inputs["Metallic"]) is None and node.inputs["Metallic"].default_value > 0:
            light = vector_node(self.tree, "SCALE", light, scale=1 - node.inputs["Metallic"].default_value)
        glow = vector_node(self.tree, "SCALE", socket_or_value(first_input(node, "Emission Color", "Emission")),
                           scale=socket_or_value(node.inputs["Emission Strength"]))
        if self.factor is not None:
            glow = vector_node(self.tree, "SCALE", glow, scale=self.factor)
        return vector_node(self.tree, "ADD", light, glow)

    def _replace(self, node: Any, radiance: Any) -> None:
        """Puts an emission shader in the place of a node."""
        emission = self.tree.nodes.new("ShaderNodeEmission")
        emission.location = node.location
        self.tree.links.new(radiance, emission.inputs["Color"])
        for link in list(node.outputs[0].links):
            self.tree.links.new(emission.outputs[0], link.to_socket)
        self.tree.nodes.remove(node)

    def _dim(self, node: Any) -> None:
        """Multiplies the strength of an emission shader by the slider of its object."""
        times = self.tree.nodes.new("ShaderNodeMath")
        times.operation = "MULTIPLY"
        strength = source(node.inputs["Strength"])
        if strength is not None:
            self.tree.links.new(strength, times.inputs[0])
        else:
            times.inputs[0].default_value = node.inputs["Strength"].default_value
        self.tree.links.new(self.factor, times.inputs[1])
        self.tree.links.new(times.outputs[0], node.inputs["Strength"])


def light_material(original: Any, name: str, light: Any, sliders: Any, group: int | None) -> Any:
    """Returns a copy of a material that shows the baked light of the object `name`."""
    if original is None or not original.use_nodes:
        material = plain_material(triple(original.diffuse_color) if original else GREY, "grey")
    else:
        material = original.copy()
    material.name = f"{original.name if original else 'grey'} lit in {name}"
    material[LIT], material[ORIGINAL] = True, original
    _Lighter(material.node_tree, light, sliders, group).light_all()
    return material


def show(shown: dict[str, str], maps: LightMaps, pack: bool) -> None:
    """Gives all objects of `shown` (names and UV layers) materials with their maps."""
    hide()
    sliders = make_sliders(maps.groups)
    for name, layer in shown.items():
        thing = bpy.data.objects.get(name)
        if thing is None or name not in maps.file_of:
            continue
        files = maps.group_files[name] if maps.groups else [maps.file_of[name]]
        light = make_light_tree(name, layer, [load_map(file, pack) for file in files], sliders)
        if not thing.material_slots:
            thing.data.materials.append(None)
        for slot in thing.material_slots:
            link, original = slot.link, slot.material
            group = maps.groups.index(name) if name in maps.groups else None
            material = light_material(original, name, light, sliders, group)
            material[LINK] = link
            slot.link = "OBJECT"
            slot.material = material


def hide() -> None:
    """Gives all objects their own materials back and removes the lit ones."""
    for thing in bpy.data.objects:
        for slot in thing.material_slots:
            lit = slot.material
            if lit is None or not lit.get(LIT):
                continue
            original, link = lit.get(ORIGINAL), lit.get(LINK, "DATA")
            slot.material = original if link == "OBJECT" else None
            slot.link = link
    for material in [m for m in bpy.data.materials if m.get(LIT) and m.users == 0]:
        bpy.data.materials.remove(material)
