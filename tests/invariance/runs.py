"""Runs of the program on copies of a scene, and their outcomes: solutions, and light at points."""
import csv
import dataclasses
import json
import os
import re
import resource
import signal
import subprocess

import numpy as np

import files
from transformations import in_plane, is_inside, newell


@dataclasses.dataclass
class Copy:
    """A copy of a scene on disk."""
    scene: object
    transformation: object
    name: str  # name of the transformation
    folder: str
    files: list
    options: list


@dataclasses.dataclass
class Outcome:
    """Result of a run: an error message, or values with their error."""
    status: int
    message: str = ""
    values: object = None  # an array, compared by its root mean square
    reflected: float = 1  # reference value for relative differences
    error: float = None  # relative error that the program reports for the values
    noise: object = None  # standard errors of the values
    command: str = ""


class Program:
    """Runs the program, with a limit on processor time in seconds."""

    def __init__(self, path, time_limit):
        self.path, self.time_limit, self.environment = path, time_limit, None  # None: that of this process
        self.last = ""

    def limit(self):
        resource.setrlimit(resource.RLIMIT_CPU, (self.time_limit, self.time_limit + 5))

    def __call__(self, *arguments, text=None):
        command = [self.path, *map(str, arguments)]
        self.last = " ".join(f"'{w}'" if re.search(r"[^\w./=,:+-]", w) else w for w in command)
        ran = subprocess.run(command, input=text, capture_output=True, text=True, env=self.environment,
                             preexec_fn=self.limit)
        if ran.returncode == -signal.SIGXCPU:
            ran.stderr = f"error: no end within {self.time_limit} s of processor time"
        return ran


def kind_of(message):
    """Removes file names and numbers from a message."""
    message = message.strip().split("\n")[0]
    message = re.sub(r"\S*/\S*", "FILE", message)
    return re.sub(r"[-+]?\d[\d.,]*(e[-+]?\d+)?", "N", message)


class Points:
    """Points distributed uniformly over the fronts of a scene, as face indices and positions; the same on all copies."""

    def __init__(self, scene, count):
        faces = [f for f in scene.faces if not scene.materials[f.material].transmission]
        areas = np.array([np.linalg.norm(newell(f.points)) / 2 for f in faces])
        random = np.random.default_rng(1)
        # Stratified: each of `count` equal parts of the area has one point.
        at = np.searchsorted(np.cumsum(areas), (np.arange(count) + random.random(count)) / count * areas.sum())
        self.places, self.normals, self.exitance = np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3))
        for k, number in enumerate(np.minimum(at, len(faces) - 1)):
            face = faces[number]
            normal = newell(face.points)
            flat = in_plane(face.points)
            low, high = flat.min(axis=0), flat.max(axis=0)
            place = low + random.random(2) * (high - low)
            while not is_inside(place, flat):
                place = low + random.random(2) * (high - low)
            u = face.points[1] - face.points[0]
            u = u / np.linalg.norm(u)
            self.normals[k] = normal / np.linalg.norm(normal)
            self.places[k] = face.points[0] + place[0] * u + place[1] * np.cross(self.normals[k], u)
            self.exitance[k] = scene.materials[face.material].exitance

    def text(self, transformation):
        rows = zip(transformation.points(self.places), transformation.directions(self.normals))
        return "x,y,z,nx,ny,nz\n" + "".join(",".join(map(files.number, (*p, *n))) + "\n" for p, n in rows)


def columns(text, prefix):
    rows = list(csv.reader(text.splitlines()))
    chosen = [i for i, name in enumerate(rows[0]) if name.startswith(prefix)]
    return np.array([[float(row[i] or "nan") for i in chosen] for row in rows[1:]])


def refused(ran, program):
    return Outcome(ran.returncode, kind_of(ran.stderr), command=program.last)


def solve(program, copy, options, name="s.h5"):
    """Returns the path of the solution or None, the program's output about it, and the finished run."""
    path = os.path.join(copy.folder, name)
    ran = program("solve", *copy.files, *copy.options, *options, "-o", path, "--threads", 1, "--json", "-q")
    return (path, json.loads(ran.stdout), ran) if ran.returncode in (0, 4) else (None, None, ran)


def probed(program, copy, points, path, *options):
    ran = program("probe", path, "--points", "-", "--threads", 1, *options, text=points.text(copy.transformation))
    if ran.returncode != 0:
        return None, ran
    return ran.stdout, ran


def light_at(program, copy, points, path, error, command, *options):
    text, ran = probed(program, copy, points, path, *options)
    if text is None:
        return refused(ran, program)
    radiosity = columns(text, "B_")
    reflected = float(np.nanmean(radiosity - points.exitance))
    if reflected < 1e-9 * float(np.nanmean(radiosity)):
        radiosity, reflected = columns(text, "E_"), float(np.nanmean(columns(text, "E_")))
    return Outcome(0, values=radiosity, reflected=reflected, error=error, command=command)
