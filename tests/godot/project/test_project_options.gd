## The project settings under spidar_g/: there with their defaults, and obeyed.
extends "res://test_case.gd"

const CONFIG: String = "spidar_g/device/default_config"
const HARDWARE: String = "spidar_g/device/use_hardware"
const FORCE: String = "spidar_g/safety/max_force"
const PANIC: String = "spidar_g/safety/panic_key"
const DEFAULTS: Dictionary[String, Variant] = {CONFIG: "", HARDWARE: true, FORCE: 40.0, PANIC: 0}
const FILE: String = "user://default_config.tres"


func test_they_are_there_with_their_defaults() -> void:
	for path: String in DEFAULTS:
		check(ProjectSettings.has_setting(path), "%s is there" % path)
		check_equal(ProjectSettings.get_setting(path), DEFAULTS[path], path)
		var shown: Array[Dictionary] = ProjectSettings.get_property_list().filter(
			func(property: Dictionary) -> bool: return property["name"] == path
		)
		check_equal(shown.size(), 1, "%s is listed" % path)
		if shown.size() == 1:
			check_equal(shown[0]["type"], typeof(DEFAULTS[path]), "%s has its type" % path)


func test_no_device_gives_more_than_the_projects_largest_force() -> void:
	check_near(await _felt_n(), 5.0, 0.05, "as asked, without a cap")
	ProjectSettings.set_setting(FORCE, 2.0)
	check_near(await _felt_n(), 2.0, 0.05, "no more than the cap")
	for wrong: Variant in [NAN, -3.0, "much"]:
		ProjectSettings.set_setting(FORCE, wrong)
		check_near(await _felt_n(), 5.0, 0.05, "%s is no cap" % wrong)
	ProjectSettings.set_setting(FORCE, DEFAULTS[FORCE])


func test_a_node_without_a_config_has_the_projects() -> void:
	var config := SpidarGConfig.new()
	config.frame_size = Vector3(0.6, 0.6, 0.6)
	check_equal(ResourceSaver.save(config, FILE), OK, "saved")
	ProjectSettings.set_setting(CONFIG, FILE)
	check_near(_corner_x(), 0.3, 1e-6, "the project's frame")
	check_near(SpidarGWorkspace.new().get_motor_positions()[0].x, 0.3, 1e-6, "and its workspace")
	ProjectSettings.set_setting(CONFIG, "res://test_case.gd")
	check_near(_corner_x(), 0.24, 1e-6, "a resource of another kind: the paper's")
	ProjectSettings.set_setting(CONFIG, DEFAULTS[CONFIG])
	check_near(_corner_x(), 0.24, 1e-6, "none: the paper's")
	DirAccess.remove_absolute(FILE)


func test_without_hardware_the_simulated_device_needs_no_reason() -> void:
	ProjectSettings.set_setting(HARDWARE, false)
	var device := SpidarG.new()
	add(device)
	check(await until(func() -> bool: return is_open(device)), "opens")
	check(device.set_simulated_hand_target(Transform3D.IDENTITY, 0.0), "as the simulated one")
	check_equal(device.get_device_info()["fallback_reason"], "", "and looked for no other")
	device.free()
	ProjectSettings.set_setting(HARDWARE, DEFAULTS[HARDWARE])


func test_the_panic_key_stops_every_device() -> void:
	ProjectSettings.set_setting(PANIC, KEY_F12)
	var devices: Array[SpidarG] = [await _active_device(), await _active_device()]
	_press(KEY_F11)
	await physics_frames(2)
	for device: SpidarG in devices:
		check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "another key does nothing")
	_press(KEY_F12)
	await physics_frames(2)
	for device: SpidarG in devices:
		check_equal(device.get_state(), SpidarG.STATE_FAULT, "stopped")
		check_equal(device.get_string_tensions(), PackedFloat64Array([0, 0, 0, 0, 0, 0, 0, 0]), "motors off")
		device.free()
	ProjectSettings.set_setting(PANIC, DEFAULTS[PANIC])
	var free: SpidarG = await _active_device()
	_press(KEY_F12)
	await physics_frames(2)
	check_equal(free.get_state(), SpidarG.STATE_ACTIVE, "no key is set: none stops")
	free.free()


func _press(key: Key) -> void:
	for pressed: bool in [true, false]:
		var event := InputEventKey.new()
		event.physical_keycode = key
		event.keycode = key
		event.pressed = pressed
		tree.root.push_input(event)


func _active_device() -> SpidarG:
	var device: SpidarG = ideal_device()
	device.forces_enabled = true
	add(device)
	await physics_frames(90)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "active")
	return device


## Upwards, of 5 N asked for.
func _felt_n() -> float:
	var device: SpidarG = await _active_device()
	for _i: int in 20:
		device.set_simulated_hand_target(Transform3D.IDENTITY, 0.0)
		device.request_wrench(Vector3(0.0, 5.0, 0.0), Vector3.ZERO, 0.0)
		await physics_frames(1)
	var felt: float = device.get_achieved_wrench()[1]
	device.free()
	return felt


func _corner_x() -> float:
	var device := SpidarG.new()
	device.drive_mode = SpidarG.DRIVE_STEPPED
	add(device)
	var corner: float = device.get_string_start(0).x
	device.free()
	return corner
