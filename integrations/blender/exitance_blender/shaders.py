"""Reads Blender's shader nodes as diffuse reflectance, emitted radiance and transmission."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import bpy

from .units import Colour, scaled, triple

GREY: Colour = (0.8, 0.8, 0.8)  # of Blender where an object has no material


@dataclass
class Reading:
    """What a shader does to light. Pictures multiply reflectance and emission; notes are for people."""

    reflectance: Colour = (0, 0, 0)
    emission: Colour = (0, 0, 0)
    transmission: float = 0
    picture: Any = None
    emission_picture: Any = None
    notes: list[str] = field(default_factory=list)


def source(socket: Any) -> Any:
    """Returns the output that is linked to an input, through reroutes, or None."""
    while socket is not None and socket.is_linked:
        output = socket.links[0].from_socket
        if output.node.type != "REROUTE":
            return output
        socket = output.node.inputs[0]
    return None


def number(socket: Any, reading: Reading) -> float:
    """Returns the value of an input, or notes that it is computed by nodes."""
    output = source(socket)
    if output is None:
        return float(socket.default_value)
    if output.node.type == "VALUE":
        return float(output.default_value)
    reading.notes.append(f"input '{socket.name}' is computed by nodes: its plain value {socket.default_value:.3g} is used")
    return float(socket.default_value)


def colour(socket: Any, reading: Reading, fallback: Colour) -> tuple[Colour, Any]:
    """Returns the colour of an input and the picture that multiplies it, or `fallback` where other nodes compute it."""
    output = source(socket)
    if output is None:
        return triple(socket.default_value), None
    if output.node.type == "TEX_IMAGE" and output.node.image is not None:
        return (1, 1, 1), output.node.image
    if output.node.type == "RGB":
        return triple(output.default_value), None
    reading.notes.append(f"input '{socket.name}' is computed by nodes: the colour of the viewport display is used")
    return fallback, None


def plus(a: Colour, b: Colour) -> Colour:
    """Returns the sum of two colours."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def mixed(a: Reading, b: Reading, share_a: float, share_b: float) -> Reading:
    """Returns the sum of two shaders by their shares. Of two pictures the first is kept."""
    return Reading(
        plus(scaled(a.reflectance, share_a), scaled(b.reflectance, share_b)),
        plus(scaled(a.emission, share_a), scaled(b.emission, share_b)),
        a.transmission * share_a + b.transmission * share_b, a.picture or b.picture,
        a.emission_picture or b.emission_picture, a.notes + b.notes)


def first_input(node: Any, *names: str) -> Any:
    """Returns the first input of a node that exists; versions of Blender name some of them differently."""
    return next((node.inputs[name] for name in names if name in node.inputs), None)


def read_principled(node: Any, fallback: Colour) -> Reading:
    """Reads the Principled BSDF: the base colour that is neither metal nor transmitted, and the emission."""
    reading = Reading()
    base, reading.picture = colour(node.inputs["Base Color"], reading, fallback)
    metal = number(node.inputs["Metallic"], reading)
    reading.transmission = number(first_input(node, "Transmission Weight", "Transmission"), reading)
    reading.reflectance = scaled(base, 1 - metal)
    if metal > 0:
        reading.notes.append("metals reflect no diffuse light in exitance")
    if number(node.inputs["Alpha"], reading) < 1:
        reading.notes.append("alpha below 1 counts as opaque")
    glow, reading.emission_picture = colour(first_input(node, "Emission Color", "Emission"), reading, (0, 0, 0))
    reading.emission = scaled(glow, number(node.inputs["Emission Strength"], reading))
    return reading


def read_shader(output: Any, fallback: Colour) -> Reading:
    """Reads the shader behind an output socket, or nothing (black) for None."""
    reading = Reading()
    if output is None:
        return reading
    node = output.node
    if node.type == "BSDF_PRINCIPLED":
        return read_principled(node, fallback)
    if node.type == "BSDF_DIFFUSE":
        reading.reflectance, reading.picture = colour(node.inputs["Color"], reading, fallback)
    elif node.type in ("EMISSION", "BACKGROUND"):
        glow, reading.emission_picture = colour(node.inputs["Color"], reading, fallback)
        reading.emission = scaled(glow, number(node.inputs["Strength"], reading))
    elif node.type in ("BSDF_GLASS", "BSDF_REFRACTION", "BSDF_TRANSPARENT"):
        reading.reflectance, reading.picture = colour(node.inputs["Color"], reading, fallback)
        reading.transmission = 1
    elif node.type == "MIX_SHADER":
        share = number(node.inputs[0], reading)
        first, second = (read_shader(source(node.inputs[i]), fallback) for i in (1, 2))
        both = mixed(first, second, 1 - share, share)
        both.notes += reading.notes
        return both
    elif node.type == "ADD_SHADER":
        first, second = (read_shader(source(node.inputs[i]), fallback) for i in (0, 1))
        return mixed(first, second, 1, 1)
    else:
        reading.notes.append(f"the shader '{node.name}' counts as black")
    return reading


def output_node(tree: Any) -> Any:
    """Returns the active output node of a tree of shaders, or None."""
    return tree.get_output_node("CYCLES") or tree.get_output_node("ALL")


def read_material(material: Any) -> Reading:
    """Reads a material; None is Blender's grey."""
    if material is None:
        return Reading(reflectance=GREY)
    fallback = triple(material.diffuse_color)
    if not material.use_nodes:
        return Reading(reflectance=fallback)
    node = output_node(material.node_tree)
    return read_shader(source(node.inputs["Surface"]) if node else None, fallback)


def read_lamp(lamp: bpy.types.Light) -> Reading:
    """Reads the factor that a lamp's nodes apply to its power as an emission; 1 without nodes."""
    if not lamp.use_nodes or lamp.node_tree is None:
        return Reading(emission=(1, 1, 1))
    node = output_node(lamp.node_tree)
    return read_shader(source(node.inputs["Surface"]) if node else None, (1, 1, 1))
