"""A bake from the scene in Blender to the materials that show it, in steps that the user interface can interrupt."""
from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy

from . import commands, display, layers
from .export import Exporter
from .job import Job, Step
from .model import write_distant_light, write_glb

SOLVE_SHARE, BAKE_SHARE = 0.6, 0.4  # of the progress bar


class BakeError(Exception):
    """Something that the user must change; the message says what."""


@dataclass
class Bake:
    """A running bake: its programs, what was exported, and the folder of its files."""

    job: Job
    exporter: Exporter
    folder: Path
    is_temporary: bool


def find_program(preferred: str) -> str:
    """Returns the path of `exitance`: that of the preferences, or the one on PATH."""
    program = bpy.path.abspath(preferred) if preferred else shutil.which("exitance")
    if not program or not Path(program).is_file():
        raise BakeError(f"the program exitance is not at {program!r}: set its path in the add-on's preferences" if program else
                        "the program exitance is not on PATH: set its path in the add-on's preferences")
    return program


def output_folder(chosen: str) -> tuple[Path, bool]:
    """Returns the folder for all files, and whether it is temporary: without a .blend file there is no place beside it."""
    if chosen.startswith("//") and not bpy.data.filepath:
        return Path(bpy.app.tempdir) / "exitance", True
    return Path(bpy.path.abspath(chosen)), False


def start(context: bpy.types.Context, settings: Any, program: str) -> Bake:
    """Unwraps where needed, exports, and returns the bake whose job can be polled. Raises BakeError."""
    if context.active_object is not None and context.active_object.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")  # what is being edited becomes part of the mesh
    display.hide()
    folder, is_temporary = output_folder(settings.folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise BakeError(f"the folder {folder} cannot be made: {error.strerror}") from error
    layers.unwrap_objects(context, settings.layer_name)
    exporter = Exporter(folder, settings.layer_name, settings.soft_lamps)
    exporter.run(context)
    model = exporter.model
    if not model.bodies or not exporter.shown:
        raise BakeError("no visible mesh can be baked")
    emitters = model.emitters()
    if not emitters:
        raise BakeError("nothing emits light: add a lamp, an emission material or a world colour")
    scene_files = [folder / "scene.glb"]
    write_glb(model, scene_files[0])
    if model.suns or max(model.world) > 0:
        scene_files.append(folder / "distant.rad")
        write_distant_light(model, scene_files[1])
    solution = folder / "scene.h5"
    if settings.light_groups and len(emitters) > commands.MOST_GROUPS:
        exporter.note(f"{len(emitters)} lamps are more than {commands.MOST_GROUPS} light groups: they have no sliders")
    divides = settings.light_groups and 1 < len(emitters) <= commands.MOST_GROUPS
    options = commands.SolveOptions(settings.error / 100, divides, model.sky, settings.time_limit)
    steps = [Step("solve", commands.solve_command(program, scene_files, solution, options), SOLVE_SHARE),
             Step("bake", commands.bake_command(program, solution, folder, settings.density, divides), BAKE_SHARE)]
    return Bake(Job(steps), exporter, folder, is_temporary)


def finish(bake: Bake, settings: Any) -> None:
    """Shows the baked light and keeps error and notes in the settings. Raises BakeError if a program failed."""
    if bake.job.cancelled:
        raise BakeError("cancelled")
    if bake.job.failure:
        raise BakeError(bake.job.failure)
    solve = bake.job.steps[0]
    try:
        maps = commands.read_light_maps(bake.folder)
    except (OSError, ValueError, KeyError, IndexError) as error:
        raise BakeError(f"the light maps cannot be read: {error}") from error
    emitters = bake.exporter.model.emitters()
    if settings.light_groups and len(emitters) == 1:
        maps = commands.with_one_group(maps, emitters[0])
    display.show(bake.exporter.shown, maps, bake.is_temporary)
    error_words = commands.parse_error(solve.output, solve.status or 0)
    settings.error_words = error_words.words() if error_words else "no error estimate"
    settings.is_shown = True
    shown_notes = [note for note in maps.notes if note.split(":")[0] in bake.exporter.shown]
    settings.notes = "\n".join(bake.exporter.notes + shown_notes + commands.messages(solve.errors))
