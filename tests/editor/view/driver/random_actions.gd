@tool
extends "editor_case.gd"
## What a user may do to devices in the editor, at random: run(plugin, [seed, first, count]). Each action is printed before
## it is done. "reload_project" ends this editor; the runner opens the next, which goes on. After each action no device is
## open and no thread of ours runs; at the end nothing is left of the closed scenes.

const Gizmo := preload("res://addons/spidar_g/editor/gizmo/spidar_g_gizmo.gd")

const SCENES: PackedStringArray = ["res://stage.tscn", "res://second.tscn"]
const SHARED_CONFIG: String = "user://shared_config.tres"
const PLUGIN: String = "res://addons/spidar_g/plugin.cfg"
## More devices than this in a scene: one is deleted in place of the next added.
const MOST_DEVICES: int = 12
## Name and weight.
const KINDS: Dictionary[String, float] = {
	"add": 14.0, "duplicate": 8.0, "delete": 6.0, "undo": 14.0, "redo": 10.0, "resource": 16.0, "field": 12.0,
	"drag": 10.0, "select": 8.0, "view": 4.0, "scale": 4.0, "save": 4.0, "switch_scene": 5.0, "close_scene": 5.0,
	"reload_scene": 3.0, "plugin": 3.0, "reload_project": 2.0,
}

var _random := RandomNumberGenerator.new()
var _reload: bool = false


func run(owner: EditorPlugin, arguments: PackedStringArray) -> int:
	plugin = owner
	var count: int = int(arguments[2])
	await open(SCENES[0])
	for i: int in range(int(arguments[1]), count):
		# Of the number alone: the next editor draws the same.
		_random.seed = hash([int(arguments[0]), i])
		# In a round of 200 the project is reloaded at least twice, whatever is drawn.
		var kind: String = "reload_project" if i % 75 == 74 else _draw_kind()
		print("ACTION %d %s" % [i, kind])
		await call("_" + kind)
		await frames(2)
		_nothing_runs("%d %s" % [i, kind])
		if _reload or failed > 0:
			break
	await _close_all()
	return failed


func _draw_kind() -> String:
	return KINDS.keys()[_random.rand_weighted(PackedFloat32Array(KINDS.values()))]


func _root() -> Node:
	return EditorInterface.get_edited_scene_root()


func _devices() -> Array[SpidarG]:
	var found: Array[SpidarG] = []
	for child: Node in _root().get_children():
		if child is SpidarG:
			found.append(child)
	return found


func _any_device() -> SpidarG:
	var devices: Array[SpidarG] = _devices()
	if devices.is_empty():
		_add()
		devices = _devices()
	return devices[_random.randi() % devices.size()]


func _undo() -> void:
	press(KEY_Z, true)


func _redo() -> void:
	press(KEY_Z, true, true)


func _add() -> void:
	if _devices().size() >= MOST_DEVICES:
		await _delete()
		return
	var root: Node = _root()
	var device := SpidarG.new()
	device.name = "Device"
	if _random.randf() < 0.7:
		device.config = _new_config()
	for extra: Node in [SpidarGView.new(), SpidarGHand.new()]:
		if _random.randf() < 0.3:
			device.add_child(extra)
		else:
			extra.free()
	var undo: EditorUndoRedoManager = EditorInterface.get_editor_undo_redo()
	undo.create_action("Add device", UndoRedo.MERGE_DISABLE, root)
	undo.add_do_method(root, &"add_child", device, true)
	undo.add_do_method(device, &"set_owner", root)
	undo.add_do_reference(device)
	undo.add_undo_method(root, &"remove_child", device)
	undo.commit_action()


func _duplicate() -> void:
	if _devices().size() >= MOST_DEVICES:
		await _delete()
		return
	var before: int = _devices().size()
	var original: SpidarG = _any_device()
	before = _devices().size()
	select([original])
	await frames(2)
	press(KEY_D, true)
	await frames(2)
	check(_devices().size() == before + 1, "duplicated: %d devices, %d before" % [_devices().size(), before])


func _delete() -> void:
	var gone: SpidarG = _any_device()
	var before: int = _devices().size()
	select([gone])
	await frames(2)
	press(KEY_DELETE, false, true)
	await frames(2)
	check(_devices().size() == before - 1, "deleted: %d devices, %d before" % [_devices().size(), before])


func _new_config() -> SpidarGConfig:
	match _random.randi() % 4:
		0:
			if not FileAccess.file_exists(SHARED_CONFIG):
				ResourceSaver.save(SpidarGConfig.new(), SHARED_CONFIG)
			return load(SHARED_CONFIG)
		1:
			var wrong := SpidarGConfig.new()
			wrong.frame_size = Vector3(0.48, -1.0, NAN)
			return wrong
	var config := SpidarGConfig.new()
	config.preset = _random.randi() % 4
	return config


func _resource() -> void:
	var device: SpidarG = _any_device()
	var property: StringName = &"config"
	var value: Resource = _new_config()
	match _random.randi() % 5:
		0:
			value = null
		1:
			property = &"calibration"
			value = SpidarGCalibration.new()
			if _random.randf() < 0.5:
				(value as SpidarGCalibration).string_offsets = [1.0, 2.0]  # too few: a warning
	_set_property(device, property, value)


func _field() -> void:
	var config: SpidarGConfig = _any_device().config
	if config == null:
		return
	var sizes: Array[Vector3] = [
		Vector3(0.4, 0.5, 0.6), Vector3(0.48, 0.48, 0.48), Vector3.ZERO, Vector3(0.9, 0.2, 0.3), Vector3(NAN, 1.0, 1.0)
	]
	match _random.randi() % 4:
		0:
			_set_property(config, &"frame_size", sizes[_random.randi() % sizes.size()])
		1:
			_set_property(config, &"preset", _random.randi() % 4)
		2:
			_set_property(config, &"pole_half_length", _random.randf_range(0.0, 0.3))
		3:
			_set_property(config, &"tension_max", _random.randf_range(-1.0, 20.0))


func _scale() -> void:
	_set_property(_any_device(), &"workspace_scale", _random.randf_range(0.5, 8.0))


func _set_property(object: Object, property: StringName, value: Variant) -> void:
	var undo: EditorUndoRedoManager = EditorInterface.get_editor_undo_redo()
	undo.create_action("Set %s" % property)
	undo.add_do_property(object, property, value)
	undo.add_undo_property(object, property, object.get(property))
	undo.commit_action()


func _drag() -> void:
	var device: SpidarG = _any_device()
	select([device])
	await frames(2)
	var gizmo: Gizmo = gizmo_of(device) as Gizmo
	if gizmo == null or gizmo._workspace.get_problem() != "":
		return
	var of_frame: bool = device.config != null and device.config.preset == 0
	var handle: int = _random.randi() % 4 if of_frame else Gizmo.Handle.PROBE
	var before: Variant = gizmo._get_handle_value(handle, false)
	var camera: Camera3D = EditorInterface.get_editor_viewport_3d(0).get_camera_3d()
	for _i: int in 3:
		var point := Vector2(_random.randf_range(-50.0, 900.0), _random.randf_range(-50.0, 700.0))
		gizmo._set_handle(handle, false, camera, point)
		await frames(1)
	gizmo._commit_handle(handle, false, before, _random.randf() < 0.3)


func _select() -> void:
	var chosen: Array[Node] = []
	for device: SpidarG in _devices():
		if _random.randf() < 0.4:
			chosen.append(device)
	select(chosen)
	if chosen.size() > 0:
		EditorInterface.edit_node(chosen[0])


func _view() -> void:
	var gizmo: Gizmo = gizmo_of(_any_device()) as Gizmo
	if gizmo == null:
		return
	gizmo.options.map = _random.randi() % 4
	gizmo.options.capacity = _random.randf() < 0.7
	gizmo.options.numbers = _random.randf() < 0.7
	gizmo.options.box = _random.randf() < 0.7


func _save() -> void:
	# Without the preview that a display would give.
	EditorInterface.save_scene_as(_root().scene_file_path, false)


func _switch_scene() -> void:
	await open(SCENES[_random.randi() % SCENES.size()])


func _close_scene() -> void:
	await _close()
	if _root() == null:
		await open(SCENES[_random.randi() % SCENES.size()])


func _reload_scene() -> void:
	EditorInterface.reload_scene_from_path(_root().scene_file_path)
	await frames(3)


func _plugin() -> void:
	EditorInterface.set_plugin_enabled(PLUGIN, false)
	await frames(2)
	EditorInterface.set_plugin_enabled(PLUGIN, true)


func _reload_project() -> void:
	_save()
	_reload = true


func _close() -> void:
	select([])
	await frames(2)
	# A method since Godot 4.5; before, the scene is only read anew.
	if EditorInterface.has_method(&"close_scene"):
		EditorInterface.call(&"close_scene")
	else:
		EditorInterface.reload_scene_from_path(_root().scene_file_path)
	await frames(3)


func _close_all() -> void:
	for _i: int in SCENES.size():
		if _root() != null:
			await _close()
	await frames(3)


func _nothing_runs(after: String) -> void:
	if _root() == null:
		return
	for device: SpidarG in _devices():
		check(device.get_state() == SpidarG.STATE_CLOSED, "after %s a device is open" % after)
		check(not device.is_processing_internal(), "after %s a device runs" % after)
	for task: String in DirAccess.get_directories_at("/proc/self/task"):
		var file: FileAccess = FileAccess.open("/proc/self/task/%s/comm" % task, FileAccess.READ)
		var name: String = file.get_line() if file != null else ""
		check(not name.begins_with("spidar"), "after %s thread %s runs" % [after, name])
