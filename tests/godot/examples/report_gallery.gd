## Runs the gallery for a user with a real mouse, and says ten times a second what is there: -s report_gallery.gd. It calls
## nothing that moves a hand. Each line of its output that begins with "STATE " is a JSON object; run_mouse_walk.py reads it.
## Meters and newtons, in world axes.
extends SceneTree

const GALLERY: String = "res://addons/spidar_g/examples/gallery/gallery.tscn"
const TICKS_A_REPORT: int = 6
## Forces are reported over this many physics ticks: a fifth of a second.
const WINDOW_TICKS: int = 12

var _gallery: Control
var _example: Node = null
var _tick: int = 0
var _input_count: int = 0
## By the name of a device: the forces on the hand in the last ticks.
var _felt: Dictionary[StringName, PackedVector3Array] = {}
## How often each clip player began, and what each socket is linked to, since the example was opened.
var _clip_starts: Dictionary[String, int] = {}
var _links: Dictionary[String, String] = {}


func _initialize() -> void:
	_run()


func _run() -> void:
	await process_frame
	_gallery = (load(GALLERY) as PackedScene).instantiate()
	root.add_child(_gallery)
	root.window_input.connect(func(_event: InputEvent) -> void: _input_count += 1)
	while true:
		await physics_frame
		_tick += 1
		_watch_example()
		_note_forces()
		if _tick % TICKS_A_REPORT == 0:
			print("STATE ", JSON.stringify(_state()))


func _watch_example() -> void:
	var last: Node = _gallery.get_child(-1)
	var shown: Node = last if last.scene_file_path.begins_with(GALLERY.get_base_dir().get_base_dir()) else null
	if is_same(shown, _example):
		return
	_example = shown
	_felt.clear()
	_clip_starts.clear()
	_links.clear()
	for node: Node in _all():
		if node is SpidarGClipPlayer:
			var clip: String = node.name
			_clip_starts[clip] = 0
			(node as SpidarGClipPlayer).started.connect(func(_who: SpidarG) -> void: _clip_starts[clip] += 1)
		elif node is SpidarGSocket:
			_links[node.name] = ""


func _note_forces() -> void:
	for node: Node in _all():
		if node is SpidarG:
			var wrench: PackedFloat64Array = (node as SpidarG).get_simulated_truth().get("strings_wrench", PackedFloat64Array())
			var forces: PackedVector3Array = _felt.get(node.name, PackedVector3Array())
			if wrench.size() >= 3:
				forces.append(Vector3(wrench[0], wrench[1], wrench[2]))
			_felt[node.name] = forces.slice(-WINDOW_TICKS)


func _state() -> Dictionary:
	var state: Dictionary = {
		"tick": _tick, "inputs": _input_count, "example": "", "buttons": _buttons(), "camera": _camera(), "devices": {},
		"places": {}, "turns": {}, "zones": {}, "clips": _clip_starts, "texts": {}, "controllers": {},
	}
	if not is_instance_valid(_example):
		return state
	state["example"] = _example.scene_file_path.get_file().get_basename()
	for node: Node in _all():
		if node is SpidarG:
			state["devices"][node.name] = _device(node as SpidarG)
		elif node is CollisionObject3D:
			state["places"][node.name] = _numbers((node as Node3D).global_position)
			state["turns"][node.name] = _numbers((node as Node3D).global_rotation)
			if node is SpidarGZone:
				state["zones"][node.name] = _devices().any((node as SpidarGZone).is_hand_inside)
		elif node is SpidarGGrip:
			state["places"][node.name] = _numbers((node as Node3D).global_position)
		elif node is SpidarGSocket:
			state["places"][node.name] = _numbers((node as Node3D).global_position)
			var mate: SpidarGSocket = (node as SpidarGSocket).get_mate()
			_links[node.name] = mate.name if mate != null else &""
		elif node is Label3D:
			state["texts"][node.name] = (node as Label3D).text
		elif node is XRController3D:
			state["controllers"][node.name] = _controller(node as XRController3D)
	state["links"] = _links
	return state


func _device(device: SpidarG) -> Dictionary:
	var told: Dictionary = {
		"scale": device.workspace_scale, "axes": _axes(device.global_basis.orthonormalized()),
		"grip": _numbers(device.get_grip_transform().origin), "wanted": [], "angle": device.get_grasp_angle(), "held": "",
		"touched": [], "active": device.get_state() == SpidarG.STATE_ACTIVE, "felt": [0.0, 0.0, 0.0], "least": [0.0, 0.0, 0.0],
		"swing": 0.0,
	}
	var forces: PackedVector3Array = _felt.get(device.name, PackedVector3Array())
	if not forces.is_empty():
		var least: Vector3 = forces[0]
		var most: Vector3 = forces[0]
		var sum := Vector3.ZERO
		for force: Vector3 in forces:
			least = least.min(force)
			most = most.max(force)
			sum += force
		told["felt"] = _numbers(sum / forces.size())
		told["least"] = _numbers(least)
		told["swing"] = (most - least).length()
	for child: Node in device.get_children():
		if child is SpidarGMouseHand:
			told["wanted"] = _numbers((child as SpidarGMouseHand).get_target().origin)
			told["wheel_step"] = (child as SpidarGMouseHand).wheel_step
			told["key_speed"] = (child as SpidarGMouseHand).key_speed
			told["turn"] = _numbers((child as SpidarGMouseHand).turn_rad)
		elif child is SpidarGHand:
			told["held"] = _name_of((child as SpidarGHand).get_held_body())
			for point: Dictionary in (child as SpidarGHand).get_touch_points():
				if not (point["force"] as Vector3).is_zero_approx():
					(told["touched"] as Array).append(_name_of(point["collider"]))
	return told


func _camera() -> Dictionary:
	var camera: Camera3D = root.get_camera_3d()
	if camera == null:
		return {}
	return {
		"axes": _axes(camera.global_basis), "at": _numbers(camera.global_position), "fov_deg": camera.fov,
		"size": [root.size.x, root.size.y],
	}


func _controller(controller: XRController3D) -> Dictionary:
	return {
		"active": controller.get_is_active(), "at": _numbers(controller.global_position),
		"grip": controller.get_float("grip"), "trigger": controller.get_float("trigger"),
		"grip_click": controller.is_button_pressed("grip_click"),
	}


func _buttons() -> Dictionary:
	var places: Dictionary = {}
	if (_gallery.get_node(^"Menu") as Control).visible:
		for button: Control in (_gallery.get_node(^"%Buttons") as Node).get_children():
			var middle: Vector2 = button.get_global_rect().get_center()
			places[button.name] = [middle.x, middle.y]
	return places


func _devices() -> Array[Node]:
	return _all().filter(func(node: Node) -> bool: return node is SpidarG)


func _all() -> Array[Node]:
	return _example.find_children("*", "", true, false) if is_instance_valid(_example) else ([] as Array[Node])


func _name_of(node: Variant) -> String:
	return (node as Node).name if node is Node else ""


func _axes(basis: Basis) -> Array:
	return [_numbers(basis.x), _numbers(basis.y), _numbers(basis.z)]


func _numbers(vector: Vector3) -> Array:
	return [vector.x, vector.y, vector.z]
