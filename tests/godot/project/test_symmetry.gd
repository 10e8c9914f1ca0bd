## What begins also ends: signals come in pairs, whatever ends the device; buttons do not stay pressed; a panel, a view
## or a recording of one device does nothing to another.
extends "res://test_case.gd"

var _told: PackedStringArray = []


func test_every_way_to_close_tells_the_end_of_all_that_began() -> void:
	var ways: Dictionary[String, Callable] = {
		"disabled": func(device: SpidarG) -> void: device.enabled = false,
		"taken out of the tree": func(device: SpidarG) -> void: device.get_parent().remove_child(device),
		"opened anew": func(device: SpidarG) -> void: device.drive_mode = SpidarG.DRIVE_THREADED,
		"unplugged": func(device: SpidarG) -> void: device.inject_simulated_fault(SpidarG.FAULT_UNPLUGGED),
	}
	for way: String in ways:
		var device: SpidarG = await _grasping_device()
		_told.clear()
		ways[way].call(device)
		if way == "unplugged":
			device.advance_cycles(100)
		await physics_frames(2)
		check_equal(_told.count("disarmed"), 1, "%s: disarmed once: %s" % [way, _told])
		check_equal(_told.count("released"), 1, "%s: released once: %s" % [way, _told])
		check_equal(_told.count("device_lost"), 1, "%s: lost once: %s" % [way, _told])
		check_equal(_told.count("button 2 up"), 1, "%s: button let go once: %s" % [way, _told])
		check(not Input.is_joy_button_pressed(16, 2 as JoyButton), "%s: nothing stays pressed" % way)
		_told.clear()
		device.free()
		check_equal(_told.size() if way != "opened anew" else 0, 0, "%s: nothing more at the end: %s" % [way, _told])


func test_a_button_that_is_held_across_scenes_is_pressed_once() -> void:
	var first: SpidarG = await _grasping_device()
	check(Input.is_joy_button_pressed(16, 2 as JoyButton), "pressed")
	first.free()
	Input.flush_buffered_events()
	check(not Input.is_joy_button_pressed(16, 2 as JoyButton), "let go with the scene")
	_told.clear()
	var second: SpidarG = _listened(ideal_device())
	add(second)
	second.set_simulated_buttons(4)
	await physics_frames(3)
	check_equal(_told.count("button 2 down"), 0, "held since before: no press: %s" % [_told])
	second.set_simulated_buttons(5)
	await physics_frames(2)
	check_equal(_told.count("button 0 down"), 1, "another one counts")
	second.set_simulated_buttons(0)
	await physics_frames(2)
	second.set_simulated_buttons(4)
	await physics_frames(2)
	check_equal(_told.count("button 2 down"), 1, "its next press counts")
	second.free()


func test_a_device_that_does_not_open_tells_it_after_ready() -> void:
	var script := GDScript.new()
	script.source_code = "extends Node3D
var told := []
func _ready() -> void:
	var device: SpidarG = get_child(0)
	device.fault_raised.connect(func(_status: int, message: String) -> void: told.append(message))
	device.device_chosen.connect(func(simulated: bool, device_text: String, reason: String) -> void: told.append([simulated, device_text, reason]))
"
	script.reload()
	var scene := Node3D.new()
	scene.set_script(script)
	var device: SpidarG = ideal_device()
	device.config.rate_hz = 5
	scene.add_child(device)
	add(scene)
	await frames(2)
	var told: Array = scene.get("told")
	check(told.size() == 1 and str(told[0]).contains("rate_hz"), "heard in _ready: %s" % [told])
	device.config.rate_hz = 1000
	await physics_frames(3)
	told = scene.get("told")
	check(told.size() == 2 and told[1] is Array and told[1][0] == true, "which device is told: %s" % [told])
	check(str(told[1][1]).contains("Simulated") and str(told[1][2]).contains("Stepped"), "and why: %s" % [told[1]])
	check(device.get_state_text().begins_with("Simulated device"), device.get_state_text())
	check(device.is_simulated() and device.device_text.contains("Simulated"), "asked, it says the same")
	scene.free()


func test_listeners_may_change_their_mind() -> void:
	var device: SpidarG = await _grasping_device()
	device.device_lost.connect(func(_reason: String) -> void: device.enabled = false)
	device.drive_mode = SpidarG.DRIVE_THREADED
	await physics_frames(3)
	check_equal(device.get_state(), SpidarG.STATE_CLOSED, "the listener disabled it while it was opened anew")
	device.free()


func test_two_recordings_never_share_a_file() -> void:
	var first: SpidarG = ideal_device()
	var second: SpidarG = ideal_device()
	first.name = "Erstes Gerät"
	var refusals: PackedStringArray = []
	second.request_rejected.connect(func(message: String) -> void: refusals.append(message))
	add(first)
	add(second)
	await physics_frames(2)
	check(first.start_recording("user://shared.rec"), "the first records")
	check(not second.start_recording("user://folder/../shared.rec"), "the second is refused, by whatever way")
	check(refusals.size() == 1 and refusals[0].contains("Erstes Gerät"), "and told who records: %s" % [refusals])
	check(not first.start_recording("user://other.rec"), "one recording a device")
	await physics_frames(5)
	first.stop_recording()
	check(second.start_recording("user://shared.rec"), "free again")
	second.free()
	check(first.start_recording("user://shared.rec"), "free when its device is gone")
	first.free()
	DirAccess.remove_absolute("user://shared.rec")


func _grasping_device() -> SpidarG:
	var device: SpidarG = _listened(ideal_device())
	device.forces_enabled = true
	add(device)
	await physics_frames(2)
	device.set_simulated_hand_target(Transform3D.IDENTITY, deg_to_rad(35.0))
	device.set_simulated_buttons(4)
	device.advance_cycles(1600)
	await physics_frames(1)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "active")
	check_equal(device.get_grasp_phase(), SpidarG.GRASP_GRASPED, "grasping")
	return device


func _listened(device: SpidarG) -> SpidarG:
	for signal_name: String in ["armed", "disarmed", "grasped", "released", "device_connected"]:
		device.connect(signal_name, func() -> void: _told.append(signal_name))
	device.device_lost.connect(func(_reason: String) -> void: _told.append("device_lost"))
	device.button_changed.connect(
		func(button: int, pressed: bool) -> void: _told.append("button %d %s" % [button, "down" if pressed else "up"])
	)
	return device
