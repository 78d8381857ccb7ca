"""Settings, buttons and the panel of the add-on."""
from __future__ import annotations

import textwrap
from typing import Any

import bpy
from bpy.props import BoolProperty, FloatProperty, StringProperty

from . import baking, display
from .model import SKY_GROUP

POLL_SECONDS = 0.2
LINE_WIDTH = 44   # characters of a line of notes in the panel
SHOWN_NOTES = 12  # notes in the panel; all are in the scene's property

running: baking.Bake | None = None


class ExitancePreferences(bpy.types.AddonPreferences):
    """Where the program is."""

    bl_idname = __package__
    program: StringProperty(name="Program", subtype="FILE_PATH",  # type: ignore[valid-type]
                            description="The program exitance; empty: the one on PATH")

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.prop(self, "program")


class ExitanceSettings(bpy.types.PropertyGroup):
    """Settings of a scene, and what its last bake reported."""

    error: FloatProperty(name="Error (%)", default=2, min=0.1, max=50,  # type: ignore[valid-type]
                         description="Requested relative RMS error of the light")
    density: FloatProperty(name="Texels per metre", default=32, min=0.1, max=4096,  # type: ignore[valid-type]
                           description="Mean density of the light maps; the side of a map is a power of two")
    light_groups: BoolProperty(name="Light groups", default=True,  # type: ignore[valid-type]
                               description="Bake a map for each lamp, so that sliders dim it without a new solve")
    soft_lamps: BoolProperty(name="Size of point lamps", default=True,  # type: ignore[valid-type]
                             description="Point lamps become spheres of 80 faces with soft shadows; off: points")
    layer_name: StringProperty(name="UV layer", default="Lightmap",  # type: ignore[valid-type]
                               description="UV layer of the light maps. Without it, the second layer is used; "
                               "without that, it is made by Smart UV Project")
    folder: StringProperty(name="Folder", default="//exitance", subtype="DIR_PATH",  # type: ignore[valid-type]
                           description="Folder of the exported scene, the solution and the maps")
    time_limit: FloatProperty(name="Time limit (s)", default=0, min=0,  # type: ignore[valid-type]
                              description="Seconds after which the solve ends with the light so far; 0: none")
    error_words: StringProperty()  # type: ignore[valid-type]
    notes: StringProperty()  # type: ignore[valid-type]
    progress: FloatProperty(name="Progress", subtype="PERCENTAGE", min=0, max=100)  # type: ignore[valid-type]
    progress_words: StringProperty()  # type: ignore[valid-type]
    is_shown: BoolProperty()  # type: ignore[valid-type]


def preferred_program(context: bpy.types.Context) -> str:
    """Returns the program's path in the preferences; empty if there is none."""
    addon = context.preferences.addons.get(__package__)
    return addon.preferences.program if addon and addon.preferences else ""


class ExitanceBake(bpy.types.Operator):
    """Solve the visible scene and show its light in the materials; Escape or Cancel stops"""

    bl_idname, bl_label, bl_options = "exitance.bake", "Bake light", {"REGISTER", "UNDO"}
    _timer: Any = None

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return running is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Bakes and waits, as scripts need it."""
        if not self._start(context):
            return {"CANCELLED"}
        assert running is not None
        running.job.wait()
        return self._finish(context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Bakes in the background."""
        if not self._start(context):
            return {"CANCELLED"}
        self._timer = context.window_manager.event_timer_add(POLL_SECONDS, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Follows the programs; the user can go on working."""
        assert running is not None
        if event.type == "ESC" and event.value == "PRESS":
            running.job.cancel()
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if running.job.poll():
            settings = context.scene.exitance
            settings.progress = 100 * running.job.fraction()
            settings.progress_words = running.job.words()
            for area in context.screen.areas if context.screen else []:
                area.tag_redraw()
            return {"PASS_THROUGH"}
        return self._finish(context)

    def cancel(self, context: bpy.types.Context) -> None:
        """Stops the programs when Blender ends the operator, as when another file is opened."""
        global running
        if running is not None:
            running.job.cancel()
            running = None

    def _start(self, context: bpy.types.Context) -> bool:
        global running
        settings = context.scene.exitance
        settings.is_shown, settings.error_words, settings.notes, settings.progress = False, "", "", 0
        try:
            running = baking.start(context, settings, baking.find_program(preferred_program(context)))
        except baking.BakeError as error:
            self.report({"ERROR"}, str(error))
            return False
        return True

    def _finish(self, context: bpy.types.Context) -> set[str]:
        global running
        bake, running = running, None
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
        assert bake is not None
        settings = context.scene.exitance
        try:
            baking.finish(bake, settings)
        except baking.BakeError as error:
            settings.notes = str(error)
            self.report({"WARNING" if bake.job.cancelled else "ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, settings.error_words)
        return {"FINISHED"}


class ExitanceCancel(bpy.types.Operator):
    """Stop the running solve; the second time at once"""

    bl_idname, bl_label = "exitance.cancel", "Cancel"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return running is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        assert running is not None
        running.job.cancel()
        return {"FINISHED"}


class ExitanceHide(bpy.types.Operator):
    """Give all objects their own materials back"""

    bl_idname, bl_label, bl_options = "exitance.hide", "Show own materials", {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        display.hide()
        context.scene.exitance.is_shown = False
        return {"FINISHED"}


class ExitancePanel(bpy.types.Panel):
    """Panel in the sidebar of the 3D view"""

    bl_label, bl_idname = "exitance", "VIEW3D_PT_exitance"
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "exitance"

    def draw(self, context: bpy.types.Context) -> None:
        settings, layout = context.scene.exitance, self.layout
        if running is not None:
            column = layout.column()
            column.enabled = False
            column.prop(settings, "progress", slider=True)
            layout.label(text=settings.progress_words)
            layout.operator("exitance.cancel", icon="CANCEL")
            return
        for name in ("error", "density", "light_groups", "soft_lamps", "layer_name", "folder", "time_limit"):
            layout.prop(settings, name)
        layout.operator("exitance.bake", icon="LIGHT_SUN")
        if settings.is_shown:
            self._draw_result(settings)
        for text in settings.notes.splitlines()[:SHOWN_NOTES]:
            for i, line in enumerate(textwrap.wrap(text, LINE_WIDTH)):
                layout.label(text=line, icon="INFO" if i == 0 else "BLANK1")

    def _draw_result(self, settings: Any) -> None:
        """Draws the error and the sliders of the light groups."""
        layout = self.layout
        layout.label(text=settings.error_words)
        sliders = display.slider_tree()
        for node in sliders.nodes if sliders else []:
            if node.type == "VALUE":
                text = "World and suns" if node.label == SKY_GROUP else node.label
                layout.prop(node.outputs[0], "default_value", text=text)
        layout.operator("exitance.hide")


CLASSES = (ExitancePreferences, ExitanceSettings, ExitanceBake, ExitanceCancel, ExitanceHide, ExitancePanel)
