"""Called by scripts/check_blender_addon, within Blender: bakes three scenes by the installed add-on and checks numbers.

For each scene: the picture of the baked light by Cycles without reflections against `exitance render` and against Cycles'
own path tracing of the original materials, and the light map at places against `exitance probe`.
"""
import csv
import io
import math
import os
import pathlib
import subprocess
import sys
import time

import bpy
import numpy as np
from mathutils import Vector

ZIP, PROGRAM, WORK = sys.argv[sys.argv.index("--") + 1:][:3]
ONLY = sys.argv[sys.argv.index("--") + 4:]
WORK = pathlib.Path(WORK)
SIZE = (320, 200)
failures = []


def check(claim, value, limit):
    """Prints a number and its limit, and keeps whether it is exceeded."""
    good = value <= limit
    print(f"  {'ok  ' if good else 'FAIL'} {claim}: {value:.4g} (limit {limit:g})")
    if not good:
        failures.append(claim)


def material(name, colour):
    """Makes a Lambertian material; that of the Principled BSDF is not Lambertian before Blender 4."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    shader = tree.nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (*colour, 1)
    tree.links.new(shader.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    return made


def principled(name, colour, glow=(0, 0, 0), strength=0):
    """Makes a material without highlights."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    inputs = made.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = (*colour, 1)
    inputs["Specular IOR Level" if "Specular IOR Level" in inputs else "Specular"].default_value = 0
    inputs["Emission Color" if "Emission Color" in inputs else "Emission"].default_value = (*glow, 1)
    inputs["Emission Strength"].default_value = strength
    return made


def add_mesh(name, points, faces, *materials, slots=()):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], faces)
    for each in materials:
        mesh.materials.append(each)
    for face, slot in zip(mesh.polygons, slots):
        face.material_index = slot
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def box(name, low, high, *materials, slots=(), leave_out=()):
    """Makes a box whose fronts are outside: faces bottom, top, south, east, north, west."""
    points = [(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
    return add_mesh(name, points, [f for i, f in enumerate(faces) if i not in leave_out], *materials, slots=slots)


def add_lamp(name, kind, energy, place, target=None, **values):
    data = bpy.data.lights.new(name, kind)
    data.energy = energy
    for key, value in values.items():
        setattr(data, key, value)
    thing = bpy.data.objects.new(name, data)
    thing.location = place
    if target is not None:
        thing.rotation_euler = (Vector(target) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(thing)
    return thing


def add_camera(eye, target, degrees):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.angle, data.clip_start = "HORIZONTAL", math.radians(degrees), 0.01
    thing = bpy.data.objects.new("camera", data)
    thing.location, thing.rotation_euler = eye, (Vector(target) - Vector(eye)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.scene.camera = thing
    return " ".join(",".join(map(str, p)) for p in (eye, target)) + f" {degrees}"


def set_world(colour, strength):
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (*colour, 1), strength
    bpy.context.scene.world = world


def closed_box():
    """A box that is a room, with fronts outside as Blender makes cubes, a block in it, and every kind of lamp."""
    white, red, green = material("white", (0.7,) * 3), material("red", (0.6, 0.1, 0.1)), material("green", (0.1, 0.5, 0.1))
    box("Room", (-1, -1, 0), (1, 1, 2), white, red, green, slots=(0, 0, 0, 1, 0, 2))
    block = box("Block", (-0.3, -0.3, 0), (0.3, 0.3, 0.6), principled("paint", (0.7,) * 3))
    block.location, block.rotation_euler, block.scale = (0.3, 0.2, 0.001), (0, 0, 0.4), (-1, 1.2, 1)
    panel = add_lamp("Panel", "AREA", 12, (-0.3, 0, 1.95), shape="RECTANGLE", size=0.5, size_y=0.3)
    panel.scale = (1.5, 1, 1)
    add_lamp("Bulb", "POINT", 4, (0.6, -0.5, 1.5), shadow_soft_size=0.06, color=(1, 0.7, 0.4))
    add_lamp("Disc", "AREA", 3, (-0.9, 0.4, 1), (0, 0.4, 0), shape="DISK", size=0.3)
    add_lamp("Spot", "SPOT", 15, (-0.5, -0.6, 1.9), (-0.3, -0.3, 0), spot_size=1.0, spot_blend=0.0, shadow_soft_size=0)
    camera = add_camera((0, -0.97, 1), (0, 1, 0.8), 80)
    return camera, "Room", [(-0.7, -0.7, 0, 0, 0, 1), (0.8, -0.6, 0, 0, 0, 1), (-1, 0.5, 1.6, 1, 0, 0)]


def room_with_windows():
    """A room with two windows, a sun, a world, and a table with a modifier; walls have thickness."""
    wall, wood = material("wall", (0.75, 0.72, 0.68)), material("wood", (0.45, 0.3, 0.15))
    box("Floor", (0, 0, -0.2), (5, 4, 0), wood)
    box("Ceiling", (0, 0, 2.6), (5, 4, 2.8), wall)
    for name, low, high in (("North", (0, 4, -0.2), (5, 4.2, 2.8)), ("West", (-0.2, -0.2, -0.2), (0, 4.2, 2.8)),
                            ("East", (5, -0.2, -0.2), (5.2, 4.2, 2.8)), ("Sill", (0, -0.2, -0.2), (5, 0, 0.9)),
                            ("Lintel", (0, -0.2, 2.2), (5, 0, 2.8)), ("Pier1", (0, -0.2, 0.9), (0.6, 0, 2.2)),
                            ("Pier2", (2.2, -0.2, 0.9), (2.8, 0, 2.2)), ("Pier3", (4.4, -0.2, 0.9), (5, 0, 2.2))):
        box(name, low, high, wall)
    table = box("Table", (1.8, 1.6, 0.7), (3.2, 2.4, 0.75), wood)
    legs = box("Leg", (1.85, 1.65, 0), (1.91, 1.71, 0.7), wood)
    array = legs.modifiers.new("array", "ARRAY")
    array.use_relative_offset, array.use_constant_offset, array.constant_offset_displace = False, True, (1.2, 0, 0)
    table.modifiers.new("solid", "TRIANGULATE")
    add_lamp("Sun", "SUN", 6, (0, -3, 5), (1.6, 2, 0), angle=math.radians(0.526), color=(1, 0.95, 0.85))
    set_world((0.5, 0.7, 1.0), 1.2)
    camera = add_camera((4.8, 3.9, 1.6), (1.6, 0.8, 0.8), 75)
    return camera, "Floor", [(2.5, 3.5, 0, 0, 0, 1), (1.2, 2.9, 0, 0, 0, 1), (4.2, 3, 0, 0, 0, 1)]


def curved_meshes():
    """A smooth sphere and a torus above a ground, with UV layers of their own, a picture, and an emission material."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=0.5, location=(0, 0, 0.7))
    sphere = bpy.context.object
    sphere.name = "Kugel ä"
    bpy.ops.object.shade_smooth()
    sphere.data.materials.append(material("blue", (0.2, 0.3, 0.7)))
    sphere.data.uv_layers.new(name="Bakes", do_init=True)
    image = bpy.data.images.new("tiles", 64, 64)
    values = np.ones((64, 64, 4), np.float32)
    values[:, :, :3] = np.where(((np.arange(64) // 32)[:, None] + np.arange(64) // 32)[:, :, None] % 2, 0.9, 0.4)
    image.pixels.foreach_set(values.ravel())
    tiles = material("tiles", (1, 1, 1))
    texture = tiles.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image, texture.interpolation = image, "Closest"
    tiles.node_tree.links.new(texture.outputs[0], tiles.node_tree.nodes["Diffuse BSDF"].inputs["Color"])
    # Eight by eight faces, so that each is of one colour of the picture.
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=8, y_subdivisions=8, size=3, location=(0, 0, 0))
    bpy.context.object.name = "Ground"
    bpy.context.object.data.materials.append(tiles)
    glow = principled("glow", (0, 0, 0), (1, 0.8, 0.5), 6)
    lamp = add_mesh("Strip", [(-1, -0.3, 2), (1, -0.3, 2), (1, 0.3, 2), (-1, 0.3, 2)], [(3, 2, 1, 0)], glow)
    lamp.data.materials[0].use_backface_culling = True
    set_world((0.2, 0.2, 0.2), 1.0)
    camera = add_camera((0, -2.6, 1.3), (0, 0, 0.5), 60)
    return camera, "Ground", [(1.2, -1.2, 0, 0, 0, 1), (-0.9, 0.3, 0, 0, 0, 1)]


def add_unusual_objects():
    """Adds linked copies of a mesh without a material, a mirrored one, a text, and an instance of a collection."""
    first = box("Cube", (-0.2, -0.2, 0), (0.2, 0.2, 0.4))
    first.location = (-0.6, 0, 0.001)
    second = bpy.data.objects.new("Cube.001", first.data)
    second.location, second.scale = (0.6, 0.3, 0.001), (1, -1, 1.5)
    bpy.context.scene.collection.objects.link(second)
    curve = bpy.data.curves.new("Text", "FONT")
    curve.body, curve.size, curve.extrude = "A", 0.5, 0.05
    text = bpy.data.objects.new("Text", curve)
    text.location, text.rotation_euler = (0, 0.6, 0.02), (math.pi / 2, 0, 0)
    bpy.context.scene.collection.objects.link(text)
    collection = bpy.data.collections.new("Parts")
    part = box("Part", (-0.1, -0.1, 0.5), (0.1, 0.1, 0.6), material("part", (0.8, 0.2, 0.2)))
    bpy.context.scene.collection.objects.unlink(part)
    collection.objects.link(part)
    instance = bpy.data.objects.new("Instance", None)
    instance.instance_type, instance.instance_collection = "COLLECTION", collection
    bpy.context.scene.collection.objects.link(instance)
    add_mesh("Ground", [(-1.5, -1.5, 0), (1.5, -1.5, 0), (1.5, 1.5, 0), (-1.5, 1.5, 0)], [(0, 1, 2, 3)],
             material("ground", (0.6, 0.6, 0.5)))
    return add_camera((0.5, -2.6, 1.3), (0, 0, 0.2), 55), "Ground", [(1.2, -1.2, 0, 0, 0, 1), (-0.9, 0.9, 0, 0, 0, 1)]


def picture_sky():
    """Unusual objects below a sky from a picture that is turned, brighter on one side."""
    image = bpy.data.images.new("sky", 64, 32, float_buffer=True)
    values = np.full((32, 64, 4), 0.2, np.float32)
    values[16:, 8:24] = 3, 2, 1, 1  # above the horizon, around +y before it is turned
    image.pixels.foreach_set(values.ravel())
    image.filepath_raw, image.file_format = str(WORK / "sky.exr"), "OPEN_EXR"
    image.save()
    set_world((1, 1, 1), 0.7)
    tree = bpy.context.scene.world.node_tree
    texture, mapping, place = (tree.nodes.new(f"ShaderNode{n}") for n in ("TexEnvironment", "Mapping", "TexCoord"))
    texture.image = bpy.data.images.load(str(WORK / "sky.exr"))
    mapping.inputs["Rotation"].default_value[2] = 0.7
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    tree.links.new(texture.outputs[0], tree.nodes["Background"].inputs["Color"])
    return add_unusual_objects()


def rendered_sky():
    """The same objects below a world that nodes compute: as bright as the direction's x."""
    set_world((1, 1, 1), 1)
    tree = bpy.context.scene.world.node_tree
    place, split = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(place.outputs["Generated"], split.inputs[0])
    positive = tree.nodes.new("ShaderNodeMath")  # Cycles would take negative light away
    positive.operation = "MAXIMUM"
    positive.inputs[1].default_value = 0
    tree.links.new(split.outputs["X"], positive.inputs[0])
    tree.links.new(positive.outputs[0], tree.nodes["Background"].inputs["Color"])
    return add_unusual_objects()


def render(file, bounces, samples):
    """Renders by Cycles on the processor without denoising; returns encoded pixels (height, width, 3), lowest row first."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising = "CPU", samples, False
    scene.cycles.use_adaptive_sampling, scene.cycles.filter_width = False, 1.5
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = bounces
    scene.cycles.sample_clamp_indirect = scene.cycles.sample_clamp_direct = 0
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = *SIZE, 100
    scene.view_settings.view_transform, scene.view_settings.look = "Standard", "None"
    scene.render.image_settings.file_format, scene.render.filepath = "PNG", str(file)
    bpy.ops.render.render(write_still=True)
    return pixels(file)


def pixels(file):
    image = bpy.data.images.load(str(file))
    image.colorspace_settings.name = "Non-Color"
    values = np.empty(SIZE[0] * SIZE[1] * 4, np.float32)
    image.pixels.foreach_get(values)
    bpy.data.images.remove(image)
    return values.reshape(SIZE[1], SIZE[0], 4)[:, :, :3]


def map_at(name, layer, place):
    """Returns the light map of an object at a place (x, y, z) on it, by bilinear lookup, summed over groups and sliders."""
    thing = bpy.data.objects[name]
    mesh, to_world = thing.data, thing.matrix_world
    mesh.calc_loop_triangles()
    best = None
    for triangle in mesh.loop_triangles:
        a, b, c = (np.array(to_world @ mesh.vertices[v].co) for v in triangle.vertices)
        system = np.stack([b - a, c - a], axis=1)
        (s, t), *_ = np.linalg.lstsq(system, np.array(place) - a, rcond=None)
        miss = np.linalg.norm(system @ [s, t] + a - place) + max(0, -s, -t, s + t - 1)
        if best is None or miss < best[0]:
            uv = [np.array(mesh.uv_layers[layer].data[i].uv) for i in triangle.loops]
            best = miss, uv[0] + s * (uv[1] - uv[0]) + t * (uv[2] - uv[0])
    total = 0
    for node in bpy.data.node_groups[f"exitance light of {name}"].nodes:
        if node.type == "TEX_IMAGE":
            width, height = node.image.size
            values = np.array(node.image.pixels[:]).reshape(height, width, 4)
            x, y = best[1][0] * width - 0.5, best[1][1] * height - 0.5
            i, j = int(x), int(y)
            for p, q in ((0, 0), (0, 1), (1, 0), (1, 1)):
                total = total + values[j + q, i + p, :3] * abs(1 - p - (x - i)) * abs(1 - q - (y - j))
    return np.asarray(total)


def probe(folder, points):
    rows = "x,y,z,nx,ny,nz\n" + "".join(",".join(map(str, p)) + "\n" for p in points)
    out = subprocess.run([PROGRAM, "probe", folder / "scene.h5", "--points", "-", "-q"], input=rows, check=True,
                         capture_output=True, text=True).stdout
    return np.array([[float(row[f"E_{c}"]) for c in "rgb"] for row in csv.DictReader(io.StringIO(out))])


def draw(solution, file, camera):
    """Renders a solution by the program as Blender shows it; the radiance of a face is its radiosity over pi."""
    subprocess.run([PROGRAM, "render", solution, "-o", file, "--size", "%dx%d" % SIZE, "--exposure", f"{1 / math.pi}x",
                    "--tone-map", "linear", "--camera", camera, "-q"], check=True)
    return pixels(file)


def check_sliders(folder, camera, baked, inside):
    """Moves all sliders and compares with `mix`; keeps a picture of before and after."""
    factors = {node.label: 0.1 if i % 2 == 0 else 2.0 for i, node in enumerate(sliders())}
    for node in sliders():
        node.outputs[0].default_value = factors[node.label]
    moved = render(folder / "moved.png", 0, 32)
    words = [f"{name}={factor}" for name, factor in factors.items()]
    subprocess.run([PROGRAM, "mix", folder / "scene.h5", *words, "-o", folder / "mixed.h5", "-q"], check=True)
    mixed = draw(folder / "mixed.h5", folder / "mixed.png", camera)
    check("moved sliders against mix, mean difference in white", float(np.abs(moved - mixed)[inside].mean()), 0.02)
    check("moved sliders left the picture as it was", 0.02 / float(np.abs(moved - baked).mean()), 1)
    from exitance_blender import pictures
    pictures.write_png(folder / "pair.png", np.concatenate([baked, moved], axis=1)[::-1])


def sliders():
    """Returns the value nodes of the light groups."""
    tree = bpy.data.node_groups.get("exitance light groups")
    return [node for node in tree.nodes if node.type == "VALUE"] if tree else []


def shared_materials():
    """Returns how many materials with baked light are used by more than one slot."""
    lit = [slot.material.name for thing in bpy.data.objects for slot in thing.material_slots if slot.material]
    return len(lit) - len(set(lit))


def check_errors():
    """Checks the messages where nothing can be baked, and that a cancelled bake ends."""
    print("errors")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="exitance_blender")
    preferences = bpy.context.preferences.addons["exitance_blender"].preferences
    for program, build, words in ((str(WORK / "absent"), None, "preferences"), (PROGRAM, None, "no visible mesh"),
                                  (PROGRAM, add_unusual_objects, "nothing emits light"), ("/bin/false", set_grey_world, "status 1")):
        preferences.program = program
        if build:
            build()
        try:
            bpy.ops.exitance.bake()
            message = "none"
        except RuntimeError as error:
            message = str(error)
        check(f"message with '{words}' is missing", int(words not in message), 0)
        check("materials of a failed bake", sum("exitance_lit" in m for m in bpy.data.materials), 0)


def check_unsaved_file():
    """Bakes the scene that Blender starts with in edit mode and without a file; saves and opens it after that."""
    print("unsaved_file")
    bpy.ops.wm.read_factory_settings()
    bpy.ops.preferences.addon_enable(module="exitance_blender")
    bpy.context.preferences.addons["exitance_blender"].preferences.program = PROGRAM
    bpy.context.view_layer.objects.active = bpy.data.objects["Cube"]
    bpy.ops.object.mode_set(mode="EDIT")
    settings = bpy.context.scene.exitance
    settings.error, settings.density = 20, 4
    for _ in range(2):  # the second bake finds the first one's materials, layers and images
        bpy.ops.exitance.bake()
    check("maps that are not packed", sum(not i.packed_file for i in bpy.data.images if i.name.startswith("lightmap")), 0)
    bpy.ops.wm.save_as_mainfile(filepath=str(WORK / "start.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(WORK / "start.blend"))
    maps = [i for i in bpy.data.images if i.name.startswith("lightmap")]
    check("maps that are dark after the file was opened", sum(max(i.pixels[:]) <= 0 for i in maps), 0)
    check("maps of the cube and its two lights that are missing", 2 - len(maps), 0)
    bpy.ops.exitance.hide()
    check("materials that stay lit", sum("exitance_lit" in m for m in bpy.data.materials), 0)
    check("own material that is missing", int(bpy.data.objects["Cube"].active_material.name != "Material"), 0)


def set_grey_world():
    set_world((1, 1, 1), 1)


def run(build):
    """Builds, bakes and checks a scene."""
    print(build.__name__)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="exitance_blender")
    bpy.context.preferences.addons["exitance_blender"].preferences.program = PROGRAM
    camera, name, points = build()
    folder = WORK / build.__name__
    folder.mkdir(exist_ok=True)
    settings = bpy.context.scene.exitance
    settings.folder, settings.error, settings.density = str(folder), 1 if build in CLOSED_FORMS else 3, 32
    before = {thing.name: [slot.material for slot in thing.material_slots] for thing in bpy.data.objects}
    traced = render(folder / "traced.png", 12, int(os.environ.get("SAMPLES", "512")))
    start = time.time()
    assert bpy.ops.exitance.bake() == {"FINISHED"}, settings.notes
    check("objects that share a material", shared_materials(), 0)
    print(f"  {settings.error_words}; {time.time() - start:.1f} s; " + settings.notes.replace("\n", "; "))
    baked = render(folder / "baked.png", 0, 32)
    drawn = draw(folder / "scene.h5", folder / "render.png", camera)
    inside = np.ones(SIZE[::-1], bool)
    if bpy.context.scene.world:  # `render` shows the sky black
        inside = np.any(drawn > 0, axis=2)
    check("baked picture against render, mean difference in white", float(np.abs(baked - drawn)[inside].mean()), 0.02)
    check("baked picture against path tracing, mean difference in white", float(np.abs(baked - traced)[inside].mean()), 0.02)
    check("its bias", abs(float((baked - traced)[inside].mean())), 0.005)
    expected = probe(folder, points)
    layer = "Lightmap"
    for point, light in zip(points, expected):
        found = map_at(name, layer, point[:3])
        check(f"map at {point[:3]} against probe, relative", float(np.abs(found / light - 1).max()), 0.03)
    if len(sliders()) > 1:
        check_sliders(folder, camera, baked, inside)
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "scene.blend"), copy=True)
    bpy.ops.exitance.hide()
    after = {thing.name: [slot.material for slot in thing.material_slots] for thing in bpy.data.objects}
    check("objects whose own materials did not come back", sum(before[n] != after[n] for n in before if before[n]), 0)


def irradiance_by_cycles(kind, energy, place, scale=(1, 1, 1), **values):
    """Returns the irradiance of a small face at the origin by a lamp above it that looks down, as Cycles has it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    add_mesh("face", [(-0.01, -0.01, 0), (0.01, -0.01, 0), (0.01, 0.01, 0), (-0.01, 0.01, 0)], [(0, 1, 2, 3)],
             material("white", (1, 1, 1)))
    add_lamp("lamp", kind, energy, place, **values).scale = scale
    add_camera((0, 0, 0.05), (0, 0, 0), 10)
    scene = bpy.context.scene
    scene.camera.data.clip_start = 0.001
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 1024, False
    scene.cycles.use_adaptive_sampling = False
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = str(WORK / "lamp.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    mean = np.array(image.pixels[:]).reshape(-1, 4)[:, :3].mean()
    bpy.data.images.remove(image)
    return math.pi * mean


def corner_factor(a, b):
    """View factor from a point to a parallel rectangle a by b (in units of its distance) with a corner on the normal."""
    p, q = math.hypot(1, a), math.hypot(1, b)
    return (a / p * math.atan(b / p) + b / q * math.atan(a / q)) / (2 * math.pi)


def check_units():
    """Compares the units in which the add-on takes lamps with what Cycles makes of them."""
    print("units")
    from exitance_blender import units
    rectangle = math.pi * units.area_lamp_radiance(100, 0.96) * 4 * corner_factor(0.6 / 1.5, 0.4 / 1.5)
    disc = math.pi * units.area_lamp_radiance(100, math.pi / 4) * 0.25 / 1.25
    for name, found, expected in (
            ("point", irradiance_by_cycles("POINT", 100, (0, 0, 2), shadow_soft_size=0), units.point_intensity(100) / 4),
            ("spot", irradiance_by_cycles("SPOT", 100, (0, 0, 2), shadow_soft_size=0), units.point_intensity(100) / 4),
            ("distant sphere", irradiance_by_cycles("POINT", 100, (0, 0, 4), (3, 3, 3), shadow_soft_size=0.1),
             units.point_intensity(100) / 16),
            ("sun", irradiance_by_cycles("SUN", 5, (0, 0, 2), angle=0.01), 5),
            ("area", irradiance_by_cycles("AREA", 100, (0, 0, 1.5), (2, 1, 1), shape="RECTANGLE", size=0.6, size_y=0.8), rectangle),
            ("disc", irradiance_by_cycles("AREA", 100, (0, 0, 1), shape="DISK", size=1), disc)):
        check(f"{name} lamp in Cycles against its unit, relative", abs(found / expected - 1), 0.002)


os.environ.setdefault("PYTHONDONTWRITEBYTECODE", "1")
bpy.ops.preferences.addon_install(filepath=ZIP, overwrite=True)
if not ONLY:
    bpy.ops.preferences.addon_enable(module="exitance_blender")
    check_units()
    check_errors()
    check_unsaved_file()
CLOSED_FORMS = (closed_box, room_with_windows, curved_meshes)
for build in CLOSED_FORMS + (picture_sky, rendered_sky):
    if not ONLY or build.__name__ in ONLY:
        run(build)
print("failed: " + "; ".join(failures) if failures else "all checks passed")
sys.exit(4 if failures else 0)
