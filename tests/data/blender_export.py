# blender -b --factory-startup --python export.py -- in.obj out.glb
import bpy, sys
src, out = sys.argv[sys.argv.index('--')+1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.obj(filepath=src, axis_forward='Y', axis_up='Z', use_split_objects=True, use_split_groups=True)
for m in bpy.data.materials: m.use_backface_culling = True
cam = bpy.data.objects.new('view', bpy.data.cameras.new('view')); bpy.context.collection.objects.link(cam)
cam.location=(0.278,-0.8,0.273); cam.rotation_euler=(1.5707963,0,0)
bpy.ops.export_scene.gltf(filepath=out, export_format='GLB', export_normals=True, export_texcoords=False, export_cameras=True, export_lights=True)
