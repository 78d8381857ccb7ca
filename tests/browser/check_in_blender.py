"""Called by scripts/check_in_blender, within Blender: renders a model and compares the picture with another one."""
import math
import sys

import bpy
from mathutils import Vector

model, reference, camera_words, picture = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
# With default options the importer of Debian 12 calls numpy.bool, which no longer exists, and fails.
bpy.ops.import_scene.gltf(filepath=model, import_shading="FLAT")
eye, target, fov = camera_words.split()
eye, target = (Vector([float(v) for v in words.split(",")]) for words in (eye, target))

data = bpy.data.cameras.new("view")
data.sensor_fit, data.angle, data.clip_start = "HORIZONTAL", math.radians(float(fov)), 0.01
camera = bpy.data.objects.new("view", data)
camera.location, camera.rotation_euler = eye, (target - eye).to_track_quat("-Z", "Y").to_euler()
scene = bpy.context.scene
scene.collection.objects.link(camera)
scene.camera, scene.world = camera, bpy.data.worlds.new("dark")
scene.world.color = (0, 0, 0)
for material in bpy.data.materials:
    material.use_backface_culling = True  # Cycles ignores this and shows backs, which differ from those of `render`
scene.render.engine = "CYCLES"
scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising = "CPU", 16, False
scene.cycles.max_bounces = 0
scene.cycles.filter_width = 1.5
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 640, 400, 100
scene.view_settings.view_transform, scene.view_settings.look = "Standard", "None"
scene.render.image_settings.file_format, scene.render.filepath = "PNG", picture
bpy.ops.render.render(write_still=True)


def pixels(path):
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    return image.pixels[:]


a, b = pixels(picture), pixels(reference)
assert len(a) == len(b), (len(a), len(b))
sums = [(abs(a[i] - b[i]) + abs(a[i + 1] - b[i + 1]) + abs(a[i + 2] - b[i + 2])) / 3 for i in range(0, len(a), 4)]
mean, far = sum(sums) / len(sums), sum(s > 0.1 for s in sums) / len(sums)
print("differs from render by %.2f%% of white on average, %.2f%% of the pixels by more than a tenth" % (100 * mean, 100 * far))
sys.exit(4 if mean > 0.02 else 0)
