## Runs one example as a user would find it, and plays in it: -s check_example.gd -- SCENE [SIZE PICTURE]. Headless it ends
## with "N passed, N failed"; with a display it also saves what the camera sees in the end in a window of SIZE (1280x720) to
## the file PICTURE. A .webp is a picture for the gallery, 320x180.
##
## What is done in a scene is in plays/NAME.gd, which extends plays/play.gd; without such a file the hand presses on the
## middle of the table.
extends SceneTree

const Play := preload("res://plays/play.gd")
const ADDON: String = "res://addons/spidar_g/"
const EXAMPLES: String = ADDON + "examples/"
const SIZE_PX: Vector2i = Vector2i(1280, 720)
const GALLERY_PX: Vector2i = Vector2i(320, 180)
const GALLERY_QUALITY: float = 0.85
const LONGEST_SCRIPT: int = 30
const ARMING_LIMIT: int = 300

var _play: Play


func _initialize() -> void:
	_run()


func _run() -> void:
	await process_frame
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	var path: String = arguments[0]
	root.size = SIZE_PX
	if arguments.size() > 1:
		root.size = Vector2i(arguments[1].get_slice("x", 0).to_int(), arguments[1].get_slice("x", 1).to_int())
	var name: String = path.get_file().get_basename()
	var own: String = "res://plays/%s.gd" % name
	_play = (load(own) as GDScript).new() if ResourceLoader.exists(own) else Play.new()
	var scene: Node = (load(path) as PackedScene).instantiate()
	_check_files(path, scene)
	_check_nodes(scene)
	for device: SpidarG in _of_class(scene, "SpidarG"):
		device.drive_mode = SpidarG.DRIVE_STEPPED # simulated time: the same at every run
	if DisplayServer.get_name() != "headless":
		RenderingServer.render_loop_enabled = false # only the last frame is looked at
	root.add_child(scene)
	_play.take(self, scene)
	await _until_active(scene)
	_check_warnings(scene)
	_check_view(scene)
	await _play.play()
	_play.check(_play.check_count > 0, "plays/%s.gd checks something" % name)
	if arguments.size() > 2:
		await _save(arguments[2])
	scene.free()
	await process_frame
	for failure: String in _play.failures:
		print("FAIL %s: %s" % [name, failure])
	print("%d passed, %d failed" % [_play.check_count - _play.failures.size(), _play.failures.size()])
	quit(0 if _play.failures.is_empty() else 1)


## Everything that the scene uses is in the add-on, and its scripts are short.
func _check_files(path: String, scene: Node) -> void:
	var left: PackedStringArray = [path]
	var seen: PackedStringArray = []
	while not left.is_empty():
		var file: String = left[-1]
		left.remove_at(left.size() - 1)
		if seen.has(file):
			continue
		seen.append(file)
		_play.check(file.begins_with(ADDON), "%s is in the add-on" % file)
		for dependency: String in ResourceLoader.get_dependencies(file):
			left.append(dependency.get_slice("::", 2) if dependency.contains("::") else dependency)
	for node: Node in _all(scene):
		var script: Script = node.get_script()
		if script != null and script.resource_path.begins_with(EXAMPLES):
			var lines: int = script.source_code.strip_edges().count("\n") + 1
			_play.check(lines <= LONGEST_SCRIPT, "%s has %d lines" % [script.resource_path, lines])


func _check_nodes(scene: Node) -> void:
	for type: String in [
		"Camera3D", "Light3D", "WorldEnvironment", "GeometryInstance3D", "SpidarG", "SpidarGHand",
	]:
		_play.check(not _of_class(scene, type).is_empty(), "has a %s" % type)
	for type: GDScript in [SpidarGView, SpidarGMouseHand] as Array[GDScript]:
		var count: int = _all(scene).filter(func(node: Node) -> bool: return is_instance_of(node, type)).size()
		_play.check(count > 0, "has a %s" % type.get_global_name())
	for device: SpidarG in _of_class(scene, "SpidarG"):
		_play.check(device.forces_enabled, "%s has its forces enabled" % device.name)
		_play.check_equal(device.get_warnings(), PackedStringArray(), "%s has no warning" % device.name)


## What the editor would show as a yellow triangle; asked in the tree, where nodes look for each other.
func _check_warnings(scene: Node) -> void:
	for node: Node in _all(scene):
		if node.has_method(&"_get_configuration_warnings"):
			var told: PackedStringArray = node.call(&"_get_configuration_warnings")
			_play.check_equal(told, PackedStringArray(), "%s has no warning" % node.name)


func _until_active(scene: Node) -> void:
	for device: SpidarG in _of_class(scene, "SpidarG"):
		var ticks: int = 0
		while device.get_state() != SpidarG.STATE_ACTIVE and ticks < ARMING_LIMIT:
			await physics_frame
			ticks += 1
		_play.check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "%s becomes active" % device.name)


## What can be touched, and the grip, are in the picture.
func _check_view(scene: Node) -> void:
	var camera: Camera3D = root.get_camera_3d()
	if not _play.check(camera != null, "has a current camera"):
		return
	for body: Node3D in _of_class(scene, "PhysicsBody3D") + _of_class(scene, "SpidarG"):
		_play.check(camera.is_position_in_frustum(body.global_position), "%s is in the picture" % body.name)


func _save(file: String) -> void:
	RenderingServer.render_loop_enabled = true
	for _i: int in 3:
		await process_frame
	await RenderingServer.frame_post_draw
	var picture: Image = root.get_texture().get_image()
	var error: Error
	if file.get_extension() == "webp":
		picture.resize(GALLERY_PX.x, GALLERY_PX.y, Image.INTERPOLATE_LANCZOS)
		error = picture.save_webp(file, true, GALLERY_QUALITY)
	else:
		error = picture.save_png(file)
	_play.check_equal(error, OK, "the picture %s is saved" % file)


func _of_class(scene: Node, type: String) -> Array[Node]:
	return _all(scene).filter(func(node: Node) -> bool: return node.is_class(type))


func _all(scene: Node) -> Array[Node]:
	var nodes: Array[Node] = [scene]
	nodes.append_array(scene.find_children("*", "", true, false))
	return nodes
