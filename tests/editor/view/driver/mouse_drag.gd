@tool
extends "editor_case.gd"
## The handles of the 3-D view under a real mouse: run(plugin, [optional: FILE of the whole editor, FILE of the view]). Prints
## "MOVE x y" and "DRAG x y to_x to_y", in pixels of the screen, and "KEY name"; whoever started it does that.

const Gizmo := preload("res://addons/spidar_g/editor/gizmo/spidar_g_gizmo.gd")
const ViewOptions := preload("res://addons/spidar_g/editor/gizmo/view_options.gd")

## The editor's camera stands four metres away.
const SCALE: float = 5.0
const LIMIT_MS: int = 60000
const PROBE_PIXELS := Vector2(55.0, -35.0)
const SIZE_PIXELS: float = 30.0


func run(owner: EditorPlugin, arguments: PackedStringArray) -> int:
	plugin = owner
	OS.low_processor_usage_mode = false
	EditorInterface.set_main_screen_editor("3D")
	var root: Node = await open("res://stage.tscn")
	var device := SpidarG.new()
	device.name = "SpidarG"
	device.config = SpidarGConfig.new()
	device.workspace_scale = SCALE
	root.add_child(device)
	device.owner = root
	await frames()
	select([device])
	EditorInterface.edit_node(device)
	await frames(20)
	var gizmo: Gizmo = gizmo_of(device) as Gizmo
	_default_options(gizmo.options)
	await _drag_the_size_and_undo(device)
	await _drag_the_probe(device, gizmo)
	if arguments.size() == 2:
		await _take_pictures(arguments)
	device.free()
	print("%d passed, %d failed" % [passed, failed])
	return failed


func _drag_the_probe(device: SpidarG, gizmo: Gizmo) -> void:
	var from: Vector2 = _on_screen(device.global_transform * (SCALE * Gizmo.PROBE_HANDLE_M))
	await _drag(from, from + PROBE_PIXELS)
	var wanted: Vector2 = from + PROBE_PIXELS
	var follows: Callable = func() -> bool:
		var handle: Vector3 = SCALE * (gizmo.probe_m + Gizmo.PROBE_HANDLE_M)
		return _on_screen(device.global_transform * handle).distance_to(wanted) < 4.0
	check(await _until(follows), "the probe is under the mouse: %s" % gizmo.probe_m)
	check(device.position == Vector3.ZERO, "the node stays where it is: %s" % device.position)


func _drag_the_size_and_undo(device: SpidarG) -> void:
	var before: Vector3 = device.config.frame_size
	var face := Vector3(0.0, 0.5 * SCALE * before.y, 0.0)
	var from: Vector2 = _on_screen(face)
	var outward: Vector2 = (_on_screen(1.1 * face) - from).normalized() * SIZE_PIXELS
	await _drag(from, from + outward)
	var larger: Callable = func() -> bool: return device.config.frame_size.y > before.y + 0.01
	check(await _until(larger), "the frame is taller: %s" % device.config.frame_size)
	check(device.config.frame_size.x == before.x and device.config.frame_size.z == before.z, "and only that")
	await frames(20)
	print("KEY ctrl+z")
	var undone: Callable = func() -> bool: return device.config.frame_size == before
	check(await _until(undone), "undone: %s" % device.config.frame_size)


## A handle is taken only where the editor has seen the mouse come.
func _drag(from: Vector2, to: Vector2) -> void:
	print("MOVE %d %d" % [from.x, from.y])
	var arrived: Callable = func() -> bool:
		return Vector2(DisplayServer.mouse_get_position()).distance_to(from) < 3.0
	check(await _until(arrived), "the mouse comes to %s" % from)
	await frames(10)
	print("DRAG %d %d %d %d" % [from.x, from.y, to.x, to.y])


## The tool that only selects shows no arrows over the device.
func _take_pictures(files: PackedStringArray) -> void:
	var key := InputEventKey.new()
	key.keycode = KEY_V
	key.pressed = true
	for button: Node in EditorInterface.get_editor_main_screen().find_children("*", "Button", true, false):
		var shortcut: Shortcut = (button as Button).shortcut
		if shortcut != null and shortcut.matches_event(key) and (button as Button).is_visible_in_tree():
			(button as Button).pressed.emit()
	await frames(20)
	var window: Viewport = EditorInterface.get_base_control().get_viewport()
	check(window.get_texture().get_image().save_png(files[0]) == OK, "saves %s" % files[0])
	var view: Image = EditorInterface.get_editor_viewport_3d(0).get_texture().get_image()
	check(view.save_png(files[1]) == OK, "saves %s" % files[1])


func _default_options(options: ViewOptions) -> void:
	options.map = ViewOptions.Map.XY
	options.capacity = true
	options.numbers = true
	options.box = true


func _on_screen(point: Vector3) -> Vector2:
	var viewport: SubViewport = EditorInterface.get_editor_viewport_3d(0)
	var container: Control = viewport.get_parent()
	return container.get_screen_position() + viewport.get_camera_3d().unproject_position(point)


func _until(condition: Callable) -> bool:
	var deadline: int = Time.get_ticks_msec() + LIMIT_MS
	while not condition.call() and Time.get_ticks_msec() < deadline:
		await frames(1)
	return condition.call()
