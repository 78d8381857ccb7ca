"""Irradiance at points, by Cycles' bake of diffuse light: blender --python bake.py -- FOLDER SAMPLES BOUNCES SIZE.

FOLDER has triangles.csv (nine coordinates, reflectance, exitance) and points.csv (place, normal); irradiance.csv and
seconds.txt come to it. Every point is a small triangle before its surface, which no ray sees, with a texel of its own.
"""
import math
import sys
import time

import bpy

folder, samples, bounces, size = sys.argv[sys.argv.index("--") + 1 :]
samples, bounces, size = int(samples), int(bounces), float(size)


def rows(name):
    with open(f"{folder}/{name}") as file:
        return [[float(word) for word in line.split(",")] for line in file]


def material_of(reflectance, exitance):
    """Lambert's in front, with light of its own; black behind."""
    material = bpy.data.materials.new("surface")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    sides = nodes.new("ShaderNodeMixShader")
    geometry = nodes.new("ShaderNodeNewGeometry")
    front = nodes.new("ShaderNodeAddShader")
    diffuse = nodes.new("ShaderNodeBsdfDiffuse")
    emission = nodes.new("ShaderNodeEmission")
    back = nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*reflectance, 1)
    strength = max(exitance) / math.pi
    emission.inputs["Strength"].default_value = strength
    emission.inputs["Color"].default_value = (*(m / max(max(exitance), 1e-30) for m in exitance), 1)
    back.inputs["Color"].default_value = (0, 0, 0, 1)
    links.new(diffuse.outputs[0], front.inputs[0])
    if strength > 0:
        links.new(emission.outputs[0], front.inputs[1])
    links.new(geometry.outputs["Backfacing"], sides.inputs[0])
    links.new(front.outputs[0], sides.inputs[1])
    links.new(back.outputs[0], sides.inputs[2])
    links.new(sides.outputs[0], output.inputs[0])
    return material


def mesh_object(name, corners):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], [(i, i + 1, i + 2) for i in range(0, len(corners), 3)])
    mesh.update()
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def add_scene(triangles):
    thing = mesh_object("scene", [tuple(t[i : i + 3]) for t in triangles for i in (0, 3, 6)])
    slots = {}
    for polygon, t in zip(thing.data.polygons, triangles):
        key = tuple(t[9:])
        if key not in slots:
            slots[key] = len(slots)
            thing.data.materials.append(material_of(key[:3], key[3:]))
        polygon.material_index = slots[key]


def add_points(points):
    """Triangles a ten-thousandth of the scene wide, as far before the surfaces."""
    width = math.ceil(math.sqrt(len(points)))
    step = 1e-4 * size
    corners, places = [], []
    for i, (x, y, z, nx, ny, nz) in enumerate(points):
        axis = min(range(3), key=lambda k: abs((nx, ny, nz)[k]))
        a = [0.0, 0.0, 0.0]
        a[axis] = 1.0
        dot = a[0] * nx + a[1] * ny + a[2] * nz
        u = [a[0] - dot * nx, a[1] - dot * ny, a[2] - dot * nz]
        length = math.sqrt(sum(c * c for c in u))
        u = [c / length for c in u]
        v = [ny * u[2] - nz * u[1], nz * u[0] - nx * u[2], nx * u[1] - ny * u[0]]
        for s, t in ((-0.5, -0.33), (0.5, -0.33), (0.0, 0.67)):
            corners.append(tuple(p + step * (n + s * a + t * b) for p, n, a, b in zip((x, y, z), (nx, ny, nz), u, v)))
        column, row = i % width, i // width
        for s, t in ((0.05, 0.05), (0.95, 0.05), (0.5, 0.95)):
            places.append(((column + s) / width, (row + t) / width))
    thing = mesh_object("points", corners)
    for loop, place in zip(thing.data.uv_layers.new().data, places):
        loop.uv = place
    # Not from the camera: what it does not see is not baked.
    for kind in ("diffuse", "glossy", "transmission", "volume_scatter", "shadow"):
        setattr(thing, f"visible_{kind}", False)
    image = bpy.data.images.new("light", width, width, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    material = bpy.data.materials.new("points")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    output, white = nodes.new("ShaderNodeOutputMaterial"), nodes.new("ShaderNodeBsdfDiffuse")
    white.inputs["Color"].default_value = (1, 1, 1, 1)
    material.node_tree.links.new(white.outputs[0], output.inputs[0])
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = image
    nodes.active = texture
    thing.data.materials.append(material)
    thing.select_set(True)
    bpy.context.view_layer.objects.active = thing
    return image, width


bpy.ops.object.select_all(action="SELECT")
bpy.ops.object.delete()
scene = bpy.context.scene
scene.render.engine = "CYCLES"
cycles = scene.cycles
cycles.device = "CPU"
cycles.samples, cycles.seed = samples, 0
cycles.use_adaptive_sampling = cycles.use_denoising = False
cycles.max_bounces = cycles.diffuse_bounces = bounces
cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
cycles.light_sampling_threshold = 0
scene.world = None
add_scene(rows("triangles.csv"))
points = rows("points.csv")
image, width = add_points(points)
scene.render.bake.margin = 0
begin = time.time()
bpy.ops.object.bake(type="DIFFUSE", pass_filter={"DIRECT", "INDIRECT"})
seconds = time.time() - begin
pixels = list(image.pixels)
with open(f"{folder}/irradiance.csv", "w") as file:
    file.write("r,g,b\n")
    for i in range(len(points)):
        file.write(",".join(f"{math.pi * c:.7g}" for c in pixels[4 * i : 4 * i + 3]) + "\n")
with open(f"{folder}/seconds.txt", "w") as file:
    file.write(f"{seconds:.6f}\n")
