# Called by scripts/check_in_godot, within Godot 3: shows res://scene.glb as unmodified Godot imports it, adds properties
# that its importer ignores, and compares the picture with another one.
#   CAMERA   'EYE TARGET FOV' as `exitance render` takes it       REFERENCE, PICTURE   files
extends SceneTree

var frames = 0

# Godot's y is up.
func point(text):
	var p = text.split(",")
	return Vector3(float(p[0]), float(p[2]), -float(p[1]))

func gltf():
	var file = File.new()
	file.open("res://scene.glb", File.READ)
	file.seek(12)
	var length = file.get_32()
	file.get_32()
	return JSON.parse(file.get_buffer(length).get_string_from_utf8()).result

func meshes_below(node):
	var out = []
	if node is MeshInstance:
		out.append(node.mesh)
	for child in node.get_children():
		out += meshes_below(child)
	return out

# Godot 3.2 ignores the texture coordinate set of a texture and KHR_materials_emissive_strength.
func add_what_the_importer_leaves_out(model):
	var written = {}
	for material in gltf()["materials"]:
		written[material["name"]] = material
	for mesh in meshes_below(model):
		for i in range(mesh.get_surface_count()):
			var material = mesh.surface_get_material(i)
			var from = written[material.resource_name]
			material.emission_on_uv2 = from.get("emissiveTexture", {}).get("texCoord", 0) == 1
			material.emission_energy = from.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)

func _initialize():
	var view = OS.get_environment("CAMERA").split(" ")
	var model = load("res://scene.glb").instance()
	add_what_the_importer_leaves_out(model)
	root.add_child(model)
	var camera = Camera.new()
	camera.keep_aspect = Camera.KEEP_WIDTH
	camera.fov = float(view[2])
	camera.near = 0.01
	camera.far = 1000
	root.add_child(camera)
	camera.look_at_from_position(point(view[0]), point(view[1]), Vector3(0, 1, 0))
	camera.current = true
	var dark = Environment.new()
	dark.background_mode = Environment.BG_COLOR
	dark.background_color = Color(0, 0, 0)
	dark.ambient_light_energy = 0
	dark.tonemap_mode = Environment.TONE_MAPPER_LINEAR
	camera.environment = dark

func _idle(_delta):
	frames += 1
	if frames != 4:
		return false
	var picture = root.get_texture().get_data()
	picture.flip_y()
	picture.save_png(OS.get_environment("PICTURE"))
	var reference = Image.new()
	reference.load(OS.get_environment("REFERENCE"))
	if picture.get_size() != reference.get_size():
		print("sizes differ: ", picture.get_size(), reference.get_size())
		quit(4)
		return false
	picture.lock()
	reference.lock()
	var sum = 0.0
	var far = 0
	var count = picture.get_width() * picture.get_height()
	for y in range(picture.get_height()):
		for x in range(picture.get_width()):
			var a = picture.get_pixel(x, y)
			var b = reference.get_pixel(x, y)
			var d = (abs(a.r - b.r) + abs(a.g - b.g) + abs(a.b - b.b)) / 3
			sum += d
			far += int(d > 0.1)
	print("differs from render by %.2f%% of white on average, %.2f%% of the pixels by more than a tenth" %
			[100 * sum / count, 100.0 * far / count])
	quit(4 if sum > 0.02 * count else 0)
	return false
