@tool
extends "editor_case.gd"
## The 3-D view of a SpidarG, in the editor without a display: what it computes, its handles, and when it draws.

const Gizmo := preload("res://addons/spidar_g/editor/gizmo/spidar_g_gizmo.gd")
const Shapes := preload("res://addons/spidar_g/editor/gizmo/workspace_shapes.gd")


func run(owner: EditorPlugin, _arguments: PackedStringArray) -> int:
	plugin = owner
	var root: Node = await open("res://stage.tscn")
	var device := SpidarG.new()
	device.name = "Device"
	device.config = SpidarGConfig.new()
	root.add_child(device)
	device.owner = root
	await frames()
	var gizmo: Gizmo = gizmo_of(device) as Gizmo
	if check(gizmo != null, "the node has a gizmo"):
		await _draws_only_when_told(device, gizmo)
		await _probe_is_dragged(device, gizmo)
		await _frame_size_is_dragged_and_undone(device, gizmo)
		await _bad_config_draws_nothing(device, gizmo)
		await _other_devices(device, gizmo)
	_shapes_are_closed()
	_icons_follow_the_theme()
	select([])
	await frames()
	EditorInterface.reload_scene_from_path("res://stage.tscn")
	await frames()
	print("%d passed, %d failed" % [passed, failed])
	return failed


func _draws_only_when_told(device: SpidarG, gizmo: Gizmo) -> void:
	select([device])
	await frames()
	var drawn: int = gizmo.draw_count
	await frames(30)
	check(gizmo.draw_count == drawn, "an idle editor draws nothing: %d times in 30 frames" % (gizmo.draw_count - drawn))
	check(device.get_state() == SpidarG.STATE_CLOSED, "no device is open in the editor")
	check(not device.is_processing_internal() and not device.is_physics_processing_internal(), "nor does it run")
	device.workspace_scale = 2.0
	await frames()
	check(gizmo.draw_count > drawn, "a changed property is drawn")
	drawn = gizmo.draw_count
	device.config.pole_half_length = 0.05
	await frames()
	check(gizmo.draw_count > drawn, "a changed resource is drawn")
	device.config.pole_half_length = 0.04
	await frames()


func _probe_is_dragged(device: SpidarG, gizmo: Gizmo) -> void:
	device.transform = Transform3D(Basis(Vector3.UP, 0.6), Vector3(1.0, 0.5, -0.5))
	await frames()
	var camera: Camera3D = EditorInterface.get_editor_viewport_3d(0).get_camera_3d()
	var wanted := Vector3(0.05, 0.03, -0.02)
	# Each drag moves it in the plane that faces the camera: the point is given in that plane.
	var facing: Vector3 = (device.global_basis.inverse() * camera.global_basis.z).normalized()
	wanted -= facing * facing.dot(wanted)
	var before: Variant = gizmo._get_handle_value(Gizmo.Handle.PROBE, false)
	var on_screen: Vector2 = camera.unproject_position(device.global_transform * (2.0 * (wanted + Gizmo.PROBE_HANDLE_M)))
	gizmo._set_handle(Gizmo.Handle.PROBE, false, camera, on_screen)
	near(gizmo.probe_m.distance_to(wanted), 0.0, 2e-4, "the probe follows the mouse, %s" % gizmo.probe_m)
	var told: String = gizmo.report()
	var workspace := SpidarGWorkspace.new()
	workspace.config = device.config
	var margin: float = workspace.get_closure_margin(Transform3D(Basis.IDENTITY, gizmo.probe_m), 0.0)
	check(told.contains("closure %.2f" % margin), "says the closure there: %s" % told)
	gizmo.drag_probe(Vector3(9.0, 9.0, 9.0), Vector3(0.0, 0.0, -1.0), Vector3(0.0, 0.0, 1.0))
	near(gizmo.probe_m.x, 0.24, 1e-6, "stays within the frame")
	check(gizmo.report().contains("no closure"), "says that a corner has none: %s" % gizmo.report())
	gizmo._commit_handle(Gizmo.Handle.PROBE, false, before, true)
	check(gizmo.probe_m == Vector3.ZERO, "an abandoned drag is taken back")
	device.transform = Transform3D.IDENTITY
	await frames()


func _frame_size_is_dragged_and_undone(device: SpidarG, gizmo: Gizmo) -> void:
	var before: Vector3 = device.config.frame_size
	for axis: int in 3:
		var restore: Variant = gizmo._get_handle_value(axis, false)
		var onto: Vector3 = Vector3.ZERO
		onto[axis] = 0.31
		var across := Vector3.ONE - onto.normalized()
		gizmo.drag_size(axis, onto + across * 3.0, -across.normalized())
		near(device.config.frame_size[axis], 0.62, 1.1e-3, "size %d follows the mouse" % axis)
		gizmo._commit_handle(axis, false, restore, false)
	var after: Vector3 = device.config.frame_size
	for _i: int in 3:
		press(KEY_Z, true)
		await frames()
	check(device.config.frame_size.is_equal_approx(before), "three undone: %s" % device.config.frame_size)
	for _i: int in 3:
		press(KEY_Z, true, true)
		await frames()
	check(device.config.frame_size.is_equal_approx(after), "three done again: %s" % device.config.frame_size)
	gizmo.drag_size(0, Vector3(-1.0, 3.0, 0.0), Vector3.DOWN)
	check(device.config.frame_size.x >= Gizmo.LEAST_SIZE_M, "no frame of no size: %s" % device.config.frame_size)
	gizmo._commit_handle(0, false, before, true)
	check(device.config.frame_size == before, "an abandoned drag is taken back")


func _bad_config_draws_nothing(device: SpidarG, gizmo: Gizmo) -> void:
	device.config.frame_size = Vector3(0.0, 0.48, 0.48)
	await frames()
	check(gizmo.report().contains("frame_size.x"), "says what is wrong: %s" % gizmo.report())
	device.config.frame_size = Vector3(0.48, 0.48, 0.48)
	await frames()
	check(gizmo.report().contains("closure 1.00"), "and draws again: %s" % gizmo.report())


func _other_devices(device: SpidarG, gizmo: Gizmo) -> void:
	var kept: SpidarGConfig = device.config
	for preset: int in [1, 2, 3]:
		device.config.preset = preset
		await frames()
		check(gizmo.report().contains("closure"), "preset %d: %s" % [preset, gizmo.report()])
	device.config = null
	await frames()
	check(gizmo.report().contains("closure 1.00"), "without a config: %s" % gizmo.report())
	kept.preset = 0
	device.config = kept
	await frames()


## Known answers: an icosahedron split twice, and the edges of a box.
func _shapes_are_closed() -> void:
	var shapes := Shapes.new()
	check(shapes.directions.size() == 162, "directions: %d" % shapes.directions.size())
	check(shapes.triangles.size() == 3 * 320, "triangles: %d" % (shapes.triangles.size() / 3))
	var sum := Vector3.ZERO
	for direction: Vector3 in shapes.directions:
		near(direction.length(), 1.0, 1e-5, "a unit vector")
		sum += direction
	near(sum.length(), 0.0, 1e-3, "even in all directions")
	var ones: PackedFloat64Array = []
	ones.resize(162)
	ones.fill(1.0)
	# Euler: 162 corners, 320 faces, hence 480 edges, each once.
	check(shapes.capacity_lines(ones).size() == 2 * 480, "edges: %d" % (shapes.capacity_lines(ones).size() / 2))
	var edges: PackedVector3Array = Shapes.box_lines(Vector3.ZERO, Vector3(1.0, 2.0, 3.0))
	var length: float = 0.0
	for i: int in range(0, edges.size(), 2):
		length += edges[i].distance_to(edges[i + 1])
	near(length, 24.0, 1e-5, "four edges of 1, 2 and 3")


## As imported, they take the colours of the editor's theme, light or dark, and its scale.
func _icons_follow_the_theme() -> void:
	var count: int = 0
	for file: String in DirAccess.get_files_at("res://addons/spidar_g/icons"):
		if file.ends_with(".svg.import"):
			var import := ConfigFile.new()
			check(import.load("res://addons/spidar_g/icons/" + file) == OK, "%s can be read" % file)
			for setting: String in ["scale_with_editor_scale", "convert_colors_with_editor_theme"]:
				check(import.get_value("params", "editor/" + setting, false), "%s: %s" % [file, setting])
			count += 1
	check(count >= 5, "icons: %d" % count)
