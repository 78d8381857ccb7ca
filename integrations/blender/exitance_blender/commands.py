"""Command lines of the program `exitance`, what it prints, and the files that it writes. Needs no Blender."""
from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path

REACHED, LIMITED = 0, 4  # exit statuses with a result
MOST_GROUPS = 64         # light groups that exitance takes


@dataclass(frozen=True)
class SolveOptions:
    """Choices for `solve`: the requested relative error, light groups, the argument of --sky, and seconds (0: no limit)."""

    error: float = 0.02
    light_groups: bool = False
    sky: str = ""
    time_limit: float = 0


def solve_command(program: str, scene: list[Path], solution: Path, options: SolveOptions) -> list[str]:
    """Returns the command that solves the exported scene; its light is in watts."""
    command = [program, "solve", *map(str, scene), "-o", str(solution), "--error", f"{options.error:g}",
               "--quantity", "radiometric", "--progress", "json", "--json"]
    if options.light_groups:
        command.append("--light-groups")
    if options.sky:
        command += ["--sky", options.sky]
    if options.time_limit > 0:
        command += ["--time-limit", f"{options.time_limit:g}"]
    return command


def bake_command(program: str, solution: Path, folder: Path, density: float, light_groups: bool) -> list[str]:
    """Returns the command that bakes into the second UV set with `density` texels per metre."""
    command = [program, "bake", str(solution), "-o", str(folder), "--uv", "TEXCOORD_1", "--density", f"{density:g}",
               "--progress", "json"]
    return command + ["--light-groups"] if light_groups else command


@dataclass(frozen=True)
class Progress:
    """A line of `--progress json`: what is done, and the finished share of it in [0, 1]."""

    phase: str
    fraction: float


def parse_progress(line: str) -> Progress | None:
    """Returns the progress in a line of the error stream, or None if the line is a message."""
    if not line.startswith("{"):
        return None
    try:
        facts = json.loads(line)
        return Progress(str(facts["phase"]), min(1.0, max(0.0, float(facts["fraction"]))))
    except (ValueError, KeyError, TypeError):
        return None


@dataclass(frozen=True)
class SolvedError:
    """Relative RMS error of the light, as `solve` reports it, and whether the request was reached."""

    estimate: float
    bound: float | None
    reached: bool

    def words(self) -> str:
        """Returns a line for people."""
        bound = f", at most {100 * self.bound:.2g}%" if self.bound is not None else ""
        return f"error {100 * self.estimate:.2g}%{bound}" + ("" if self.reached else ", more than requested")


def parse_error(report: str, status: int) -> SolvedError | None:
    """Returns the error in the JSON that `solve --json` prints, or None if there is none."""
    try:
        facts = json.loads(report)
        estimate = facts["relative_error_estimate"]
    except (ValueError, KeyError, TypeError):
        return None
    if not isinstance(estimate, (int, float)):
        return None
    bound = facts.get("relative_error_bound")
    return SolvedError(float(estimate), float(bound) if isinstance(bound, (int, float)) else None, status == REACHED)


@dataclass(frozen=True)
class LightMaps:
    """Maps of a bake.

    file_of   by object: the map of all light
    groups    names of the light groups, in the program's order; empty without light groups
    group_files  by object: one map per group
    notes     faults of texture coordinates, for people
    """

    file_of: dict[str, Path]
    groups: list[str]
    group_files: dict[str, list[Path]]
    notes: list[str]


def read_light_maps(folder: Path) -> LightMaps:
    """Reads `lightmaps.json`. Raises ValueError if it has no objects, as without --uv."""
    manifest = json.loads((folder / "lightmaps.json").read_text(encoding="utf-8"))
    if "objects" not in manifest:
        raise ValueError(f"{folder / 'lightmaps.json'} lists no objects: it was not baked into texture coordinates")
    groups = manifest.get("groups", [])
    file_of, group_files, notes = {}, {}, []
    for entry in manifest["objects"]:
        name, number = entry["name"], entry["map"]
        file_of[name] = folder / manifest["maps"][number]["file"]
        group_files[name] = [folder / group["files"][number] for group in groups]
        for key, words in (("overlapping", "overlap"), ("outside", "are outside of the map"), ("collapsed", "have no area")):
            if entry.get(key):
                notes.append(f"{name}: {entry[key]} triangles {words} in its light map coordinates")
    return LightMaps(file_of, [group["name"] for group in groups], group_files, notes)


def with_one_group(maps: LightMaps, name: str) -> LightMaps:
    """Returns maps whose only light group has all light. A scene with one lamp thus needs no second bake."""
    return replace(maps, groups=[name], group_files={thing: [file] for thing, file in maps.file_of.items()})


def messages(error_stream: str) -> list[str]:
    """Returns the lines of an error stream that are not progress."""
    return [line for line in error_stream.splitlines() if line.strip() and parse_progress(line) is None]
