"""Trials of methods and verbs: each runs on a copy of a scene and defines how results of two copies are compared."""
import json
import math
import os
import struct
import sys

import numpy as np

import files
from runs import Outcome, columns, kind_of, light_at, probed, refused, solve

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "readers"))
from exr import read_exr  # noqa: E402

ESTIMATE_FACTOR = 1.25  # an estimate is correct if error <= ESTIMATE_FACTOR * estimate and estimate <= 2 * error
ROUNDING = 1e-3  # relative difference that is always allowed for errors and estimates


class Method:
    """`solve` with one method; compares the light at points."""

    def __init__(self, name, options, cuts=True):
        self.name, self.options, self.cuts = name, options, cuts
        self.needs_light = True

    def run(self, program, copy, points, context, seed=1):
        options = [o.format(h=copy.scene.mesh_size, a=copy.scene.mesh_size**2 / 8, error=context.error) for o in self.options]
        path, facts, ran = solve(program, copy, options + ["--seed", seed])
        if path is None:
            return refused(ran, program)
        command = program.last
        return light_at(program, copy, points, path, facts["relative_error_estimate"], command)


class Interpolant:
    """`probe --interpolant`: the light of the exported mesh."""
    name, cuts, needs_light = "probe --interpolant", True, True

    def run(self, program, copy, points, context):
        path, facts, ran = context.solution(program, copy)
        if path is None:
            return refused(ran, program)
        return light_at(program, copy, points, path, facts["relative_error_estimate_interpolant"], program.last, "--interpolant")


class Reference:
    """`probe --reference`: unbiased paths, with their standard errors."""
    name, cuts, needs_light = "probe --reference", True, True

    def run(self, program, copy, points, context):
        path, _, ran = context.solution(program, copy)
        if path is None:
            return refused(ran, program)
        text, ran = probed(program, copy, points, path, "--reference", context.paths)
        if text is None:
            return refused(ran, program)
        light = columns(text, "E_")
        return Outcome(0, values=light, noise=columns(text, "se_"), reflected=float(light.mean()), command=program.last)


class Picture:
    """`render` from a camera of the scene; compares means over 4 x 4 pixels, so that ties at outlines do not matter."""
    name, cuts, needs_light = "render", True, True

    def run(self, program, copy, points, context):
        path, facts, ran = context.solution(program, copy)
        if path is None:
            return refused(ran, program)
        picture = os.path.join(copy.folder, "picture.exr")
        ran = program("render", path, "-o", picture, "--camera", "view", "--size", "80x64", "--threads", 1, "-q")
        if ran.returncode != 0:
            return refused(ran, program)
        channels = read_exr(picture)[1]
        image = np.stack([channels[c] for c in "RGB"], axis=2).astype(float)
        blocks = image.reshape(16, 4, 20, 4, 3).mean(axis=(1, 3))
        return Outcome(0, values=blocks, reflected=float(blocks.mean()), error=facts["relative_error_estimate"], command=program.last)


class LightMaps:
    """`bake`: the maps at points on the surfaces, interpolated linearly between texels."""
    name, cuts, needs_light = "bake", True, True

    def run(self, program, copy, points, context):
        path, facts, ran = context.solution(program, copy)
        if path is None:
            return refused(ran, program)
        folder = os.path.join(copy.folder, "maps")
        density = 128 / context.size(copy)
        ran = program("bake", path, "-o", folder, "--density", density, "--threads", 1, "-q")
        if ran.returncode != 0:
            return refused(ran, program)
        command = program.last
        baked = self.texels(folder, copy.transformation.points(points.places), copy.transformation.directions(points.normals),
                            1e-6 * context.size(copy))
        exact = columns(probed(program, copy, points, path)[0], "E_")
        # A texel is a mean value; its difference from the light at a point is the resolution error of the maps.
        baked[exact.sum(axis=1) == 0] = np.nan  # maps continue below objects on a face
        kept = np.isfinite(baked)
        resolution = math.sqrt(np.mean((baked - exact)[kept]**2)) / exact[kept].mean()
        return Outcome(0, values=baked, reflected=float(exact.mean()),
                       error=math.hypot(resolution, facts["relative_error_estimate"] or math.nan), command=command)

    @staticmethod
    def texels(folder, places, normals, near):
        with open(os.path.join(folder, "lightmaps.json")) as text:
            manifest = json.load(text)
        maps = [read_exr(os.path.join(folder, m["file"]))[1] for m in manifest["maps"]]
        out = np.full((len(places), 3), np.nan)
        for chart in manifest["charts"]:
            origin, du, dv, normal = (np.array(chart[k]) for k in ("origin", "du", "dv", "normal"))
            off = places - origin
            x, y = off @ du / (du @ du), off @ dv / (dv @ dv)
            on = (np.abs(off @ normal) < near) & (normals @ normal > 0.999)
            on &= (x >= 0) & (x <= chart["width"] - 1) & (y >= 0) & (y <= chart["height"] - 1)
            channels = maps[chart["map"]]
            for k in np.flatnonzero(on):
                i, j = min(int(x[k]), chart["width"] - 2), min(int(y[k]), chart["height"] - 2)
                at = slice(chart["y"] + j, chart["y"] + j + 2), slice(chart["x"] + i, chart["x"] + i + 2)
                around = np.stack([channels[b][at] for b in "RGB"], axis=2).astype(float)
                # Where texels differ much, at edges of shadows, the error of the maps depends on the texel size.
                if channels["coverage"][at].min() == 1 and (np.ptp(around, axis=(0, 1)) <= 0.1 * around.mean(axis=(0, 1))).all():
                    weights = np.outer([1 - (y[k] - j), y[k] - j], [1 - (x[k] - i), x[k] - i])
                    out[k] = (weights[:, :, None] * around).sum(axis=(0, 1))
        return out


def parents(copy, values, areas):
    """Means over the faces of the original scene, from one row per face; faces of luminaires are last and ignored."""
    kept = [f.parent for f in copy.scene.faces if not copy.scene.materials[f.material].transmission]
    count = max(kept) + 1
    values, areas = values[:len(kept)], areas[:len(kept)]
    sums, weights = np.zeros((count, values.shape[1])), np.zeros(count)
    np.add.at(sums, kept, values * areas[:, None])
    np.add.at(weights, kept, areas)
    return sums / np.maximum(weights, 1e-300)[:, None], weights


class Table:
    """`export` of a table: mean radiosity of each face of the original scene."""
    name, cuts, needs_light = "export .csv", True, True

    def run(self, program, copy, points, context):
        path, facts, ran = context.solution(program, copy)
        if path is None:
            return refused(ran, program)
        table = os.path.join(copy.folder, "faces.csv")
        ran = program("export", path, "-o", table)
        if ran.returncode != 0:
            return refused(ran, program)
        with open(table) as text:
            content = text.read()
        areas = columns(content, "area")[:, 0]
        light, weights = parents(copy, columns(content, "B_"), areas)
        root = np.sqrt(weights / weights.sum())[:, None]
        reflected = float((light * root**2).sum() / 3)
        return Outcome(0, values=light * root * math.sqrt(len(light)), reflected=reflected,
                       error=facts["relative_error_estimate_interpolant"], command=program.last)


class LitMesh:
    """`export` of a model: light of each group, from the corners of its triangles."""
    name, cuts, needs_light = "export .glb", True, True

    def run(self, program, copy, points, context):
        path, facts, ran = context.solution(program, copy)
        if path is None:
            return refused(ran, program)
        model = os.path.join(copy.folder, "lit.glb")
        ran = program("export", path, "-o", model)
        if ran.returncode != 0:
            return refused(ran, program)
        light, areas = self.by_group(model)
        groups = sorted({f.group for f in copy.scene.faces if not copy.scene.materials[f.material].transmission})
        weights = np.array([areas.get(g, 0.0) for g in groups])
        values = np.array([light.get(g, np.zeros(3)) for g in groups]) / weights.sum()
        return Outcome(0, values=values * math.sqrt(values.size), reflected=float(values.sum() / 3) * math.sqrt(3),
                       error=facts["relative_error_estimate_interpolant"], command=program.last)

    @staticmethod
    def by_group(path):
        with open(path, "rb") as data:
            data = data.read()
        length = struct.unpack_from("<I", data, 12)[0]
        content, binary = json.loads(data[20:20 + length]), data[28 + length:]

        def accessor(number):
            a = content["accessors"][number]
            view = content["bufferViews"][a["bufferView"]]
            kind = {5126: np.float32, 5125: np.uint32, 5123: np.uint16}[a["componentType"]]
            width = {"SCALAR": 1, "VEC3": 3}[a["type"]]
            start = view.get("byteOffset", 0) + a.get("byteOffset", 0)
            stride = view.get("byteStride", width * np.dtype(kind).itemsize)
            flat = np.ndarray((a["count"], width), kind, binary, start, (stride, np.dtype(kind).itemsize))
            return flat.astype(float) if kind == np.float32 else flat.astype(int)

        light, areas = {}, {}
        for node in content["nodes"]:
            if "mesh" not in node:
                continue
            for primitive in content["meshes"][node["mesh"]]["primitives"]:
                corners = accessor(primitive["attributes"]["POSITION"]) + node.get("translation", [0, 0, 0])
                radiosity = accessor(primitive["attributes"]["_RADIOSITY"])
                triangles = accessor(primitive["indices"]).reshape(-1, 3)
                a, b, c = (corners[triangles[:, k]] for k in range(3))
                area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
                name = content["meshes"][node["mesh"]].get("name", node.get("name"))
                light[name] = light.get(name, 0) + (area[:, None] * radiosity[triangles].mean(axis=1)).sum(axis=0)
                areas[name] = areas.get(name, 0) + area.sum()
        return light, areas


class Grid:
    """`report --grid`: irradiance on a measuring plane, at points that no object covers."""
    name, cuts, needs_light = "report --grid", True, True

    def run(self, program, copy, points, context):
        path, facts, ran = context.solution(program, copy)
        if path is None:
            return refused(ran, program)
        page = os.path.join(copy.folder, "report.html")
        spacing = np.linalg.norm(copy.scene.plane[1]) / 8
        plane = " ".join(",".join(map(files.number, row)) for row in copy.scene.plane) + " " + files.number(spacing)
        ran = program("report", path, "-o", page, "--grid", plane, "--size", "32x20", "--camera", "view", "--threads", 1, "-q")
        if ran.returncode != 0:
            return refused(ran, program)
        with open(page[:-4] + "json") as text:
            grid = json.load(text)["grids"][0]
        values = np.array(grid["values"], float).ravel()
        return Outcome(0, values=values, reflected=float(np.nanmean(values)), error=facts["relative_error_estimate"], command=program.last)


class Mixed:
    """`mix`: one light group dimmed to a half, a material repainted."""
    name, cuts, needs_light = "mix", True, True

    def run(self, program, copy, points, context):
        path, facts, ran = context.solution(program, copy)
        if path is None:
            return refused(ran, program)
        if not copy.scene.lamp_group:
            return None
        mixed = os.path.join(copy.folder, "mixed.h5")
        ran = program("mix", path, copy.scene.lamp_group + "=0.5", "--reflectance", "white=0.4,0.5,0.6", "-o", mixed, "--json",
                      "--threads", 1, "-q")
        if ran.returncode not in (0, 4):
            return refused(ran, program)
        told = json.loads(ran.stdout).get("relative_error_estimate") if ran.stdout else None
        command = program.last
        out = light_at(program, copy, points, mixed, told if told is not None else facts["relative_error_estimate"], command)
        if out.values is not None:  # ignore the lamp's faces, whose own light is halved
            lamps = points.exitance.sum(axis=1) > 0
            out.values[lamps] = 0
            out.reflected = float(out.values.mean())
        return out


class Daylight:
    """`daylight`: two days of weather. Reflected light is gathered with 2048 rays: an error of at most 2.2% of it at a sensor.
    Patches of the sky do not turn with the scene; with 577 of them their error in so few hours is below the 2% requested."""
    name, cuts, needs_light = "daylight", True, True

    def run(self, program, copy, points, context):
        if not copy.scene.sky:
            return None
        path, _, ran = context.solution(program, copy)
        if path is None:
            return refused(ran, program)
        epw, folder = files.write_weather(copy.folder), os.path.join(copy.folder, "year")
        sensors = os.path.join(copy.folder, "sensors.csv")
        corner, u, v = copy.scene.plane
        up = np.cross(u, v) / np.linalg.norm(np.cross(u, v))
        with open(sensors, "w") as out:
            out.write("x,y,z,nx,ny,nz\n")
            for a in range(4):
                for b in range(3):
                    out.write(",".join(map(files.number, (*(corner + (a + 0.5) / 4 * u + (b + 0.5) / 3 * v), *up))) + "\n")
        ran = program("daylight", path, "--epw", epw, "--points", sensors, "-o", folder, f"--north={files.number(copy.scene.north)}",
                      "--hours", "csv", "--sky-patches", 577, "--threads", 1, "-q")
        if ran.returncode != 0:
            return refused(ran, program)
        with open(os.path.join(folder, "illuminance.csv")) as text:
            values = columns(text.read(), "E_")
        return Outcome(0, values=values, reflected=float(values.mean()), error=2048**-0.5, command=program.last)


class ViewFactors:
    """`viewfactors`: entries between the faces of the original scene, each with a relative tolerance."""
    name, cuts, needs_light = "viewfactors", True, False
    tolerance = 1e-3

    def run(self, program, copy, points, context):
        table = os.path.join(copy.folder, "factors.csv")
        ran = program("viewfactors", copy.files[0], "-o", table, "--tolerance", self.tolerance, "--threads", 1, "-q")
        if ran.returncode != 0:
            return refused(ran, program)
        with open(table) as text:
            content = text.read()
        areas, factors = columns(content, "area")[:, 0], columns(content, "F_")
        kept = [f.parent for f in copy.scene.faces if not copy.scene.materials[f.material].transmission]
        if len(kept) != len(areas):
            return Outcome(0, f"{len(areas)} rows for {len(kept)} faces", command=program.last)
        count = max(kept) + 1
        power, of = np.zeros((count, count)), np.zeros(count)
        np.add.at(power, (np.array(kept)[:, None], np.array(kept)[None, :]), areas[:, None] * factors)
        np.add.at(of, kept, areas)
        entries = power / np.maximum(of, 1e-300)[:, None]
        # Smaller entries have no relative tolerance.
        scale = np.maximum(entries, 1e-6 * self.tolerance**-0.5)
        return Outcome(0, values=np.log(scale), reflected=1, error=self.tolerance, command=program.last)


class Findings:
    """`check`: the findings of each kind are the same."""
    name, cuts, needs_light = "check", False, False

    def run(self, program, copy, points, context):
        ran = program("check", *copy.files, "--json")
        if ran.returncode not in (0, 3):
            return refused(ran, program)
        told = json.loads(ran.stdout)
        kinds = [sorted(kind_of(f["message"]) for f in told[k]) for k in ("errors", "warnings", "repairs")]
        return Outcome(0, message=json.dumps([ran.returncode, told["surfaces"], *kinds]), command=program.last)


ASKED = ["--error", "{error}"]
PUBLISHED = ["--direct", "carried", "--mesh", "uniform", "--output-light", "elements", "--mesh-size", "{h}"]


def published(name, *options):
    return Method(name + ", published", [*options, *PUBLISHED], cuts=False)


METHODS = [
    Method("auto", ASKED),
    Method("matrix", ["--method", "matrix", *ASKED]),
    Method("matrix linear", ["--method", "matrix", "--basis", "linear", *ASKED]),
    Method("matrix galerkin2", ["--method", "matrix", "--basis", "galerkin2", *ASKED]),
    Method("progressive", ["--method", "progressive", *ASKED]),
    Method("substructuring", ["--method", "substructuring", *ASKED], cuts=False),
    Method("hierarchical", ["--method", "hierarchical", *ASKED]),
    Method("hierarchical judged", ["--method", "hierarchical", "--clusters", "on", *ASKED]),
    Method("wavelet", ["--method", "wavelet", *ASKED]),
    Method("discontinuity", ["--method", "discontinuity", *ASKED]),
    Method("growing-cells", ["--method", "growing-cells", *ASKED], cuts=False),
    Method("monte-carlo", ["--method", "monte-carlo", *ASKED]),
    published("matrix", "--method", "matrix"),
    published("matrix hemicube", "--method", "matrix", "--form-factors", "hemicube"),
    published("progressive", "--method", "progressive"),
    published("progressive vertex", "--method", "progressive", "--form-factors", "vertex"),
    published("substructuring", "--method", "substructuring"),
    published("hierarchical", "--method", "hierarchical", "--oracle", "ff", "--threshold", "0.05", "--min-area", "{a}"),
    published("wavelet", "--method", "wavelet", "--oracle", "ff", "--threshold", "0.1", "--min-area", "{a}"),
    published("wavelet exact", "--method", "wavelet", "--visibility", "exact", "--oracle", "ff", "--threshold", "0.1", "--min-area", "{a}"),
    published("monte-carlo", "--method", "monte-carlo"),
    Method("task engine", ["--method", "hierarchical", "--task-engine", "--oracle", "ff", "--threshold", "0.05", "--min-area", "{a}"],
           cuts=False),
    Method("growing-cells classic", ["--method", "growing-cells", "--gcs", "classic", "--max-units", "64"], cuts=False),
    Method("discontinuity pass a", ["--method", "discontinuity", "--local-pass", "a", *ASKED]),
    Method("discontinuity pass d", ["--method", "discontinuity", "--local-pass", "d", *ASKED]),
]
VERBS = [Findings(), Interpolant(), Reference(), Picture(), LightMaps(), Table(), LitMesh(), Grid(), Mixed(), Daylight(), ViewFactors()]
ALL = METHODS + VERBS
