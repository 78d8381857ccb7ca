"""Bakes light maps by the program exitance. The guide is docs/blender.md."""
import bpy

from . import interface

bl_info = {
    "name": "exitance",
    "description": "Light maps with a known error, by the program exitance",
    "author": "the authors of exitance",
    "version": (0, 3, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > exitance",
    "category": "Render",
}


def register() -> None:
    """Adds the panel, its operators and the settings of scenes."""
    for kind in interface.CLASSES:
        bpy.utils.register_class(kind)
    bpy.types.Scene.exitance = bpy.props.PointerProperty(type=interface.ExitanceSettings)


def unregister() -> None:
    """Removes them."""
    del bpy.types.Scene.exitance
    for kind in reversed(interface.CLASSES):
        bpy.utils.unregister_class(kind)
