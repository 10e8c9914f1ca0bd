## The panic key and panic_stop(): in every state, whatever the scene tree does, and for good.
extends "res://test_case.gd"

const PANIC: String = "spidar_g/safety/panic_key"


func test_the_key_works_wherever_the_device_is_and_whoever_handles_it() -> void:
	ProjectSettings.set_setting(PANIC, KEY_F9)
	for kind: String in ["plain", "subviewport", "window", "paused", "handled", "disabled parent", "tap"]:
		var device: SpidarG = ideal_device()
		device.forces_enabled = true
		var room: Node = null
		match kind:
			"subviewport":
				room = SubViewport.new()
			"window":
				var window := Window.new()
				window.visible = false
				room = window
			_:
				room = Node3D.new()
		if kind == "handled":
			room.set_script(_handler())
		room.add_child(device)
		add(room)
		await physics_frames(80)
		check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "%s: active before" % kind)
		tree.paused = kind == "paused"
		if kind == "disabled parent":
			room.process_mode = Node.PROCESS_MODE_DISABLED
		await frames(1)
		_key(true)
		if kind == "tap":
			_key(false)
		await frames(2)
		tree.paused = false
		room.process_mode = Node.PROCESS_MODE_INHERIT
		await physics_frames(5)
		check_equal(device.get_state(), SpidarG.STATE_FAULT, "%s: stopped" % kind)
		_key(false)
		await physics_frames(150)
		check_equal(device.get_state(), SpidarG.STATE_FAULT, "%s: does not arm itself" % kind)
		room.free()
	ProjectSettings.set_setting(PANIC, 0)


func test_a_threaded_device_is_stopped_while_paused_and_stays_so() -> void:
	ProjectSettings.set_setting(PANIC, KEY_F9)
	var device := SpidarG.new()
	device.forces_enabled = true
	add(device)
	check(await until(func() -> bool: return device.get_state() == SpidarG.STATE_ACTIVE), "active")
	tree.paused = true
	await frames(1)
	_key(true)
	await frames(2)
	_key(false)
	OS.delay_msec(20)
	tree.paused = false
	check(await until(func() -> bool: return device.get_state() == SpidarG.STATE_FAULT), "stopped")
	check(device.get_fault_text().contains("panic_stop"), device.get_fault_text())
	OS.delay_msec(1200)
	await physics_frames(3)
	check_equal(device.get_state(), SpidarG.STATE_FAULT, "not armed again")
	device.free()
	ProjectSettings.set_setting(PANIC, 0)


func test_the_action_takes_further_events() -> void:
	ProjectSettings.set_setting(PANIC, KEY_F9)
	var device: SpidarG = await _active_device()
	var pedal := InputEventJoypadButton.new()
	pedal.button_index = JOY_BUTTON_X
	InputMap.action_add_event("spidar_g_panic", pedal)
	var pressed := InputEventJoypadButton.new()
	pressed.button_index = JOY_BUTTON_X
	pressed.pressed = true
	Input.parse_input_event(pressed)
	Input.flush_buffered_events()
	await physics_frames(3)
	check_equal(device.get_state(), SpidarG.STATE_FAULT, "a pedal stops too")
	var released: InputEventJoypadButton = pressed.duplicate()
	released.pressed = false
	Input.parse_input_event(released)
	Input.flush_buffered_events()
	InputMap.action_erase_event("spidar_g_panic", pedal)
	device.free()
	ProjectSettings.set_setting(PANIC, 0)


func test_a_stop_outlasts_closing_and_opening() -> void:
	var device: SpidarG = await _active_device()
	device.panic_stop()
	device.advance_cycles(1)
	check_equal(device.get_state(), SpidarG.STATE_FAULT, "stopped")
	device.enabled = false
	device.enabled = true
	await _stays_stopped(device, "opened anew")
	device.config = device.config.duplicate()
	await _stays_stopped(device, "with another config")
	device.clear_fault()
	device.advance_cycles(2000)
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "a cleared stop is not yet an arm()")
	var told: Array[String] = []
	device.request_rejected.connect(func(message: String) -> void: told.append(message))
	check(not device.zero_at_home(), "nor does it pull for a zero")
	check(told.size() == 1 and told[0].contains("arm()"), "and says what to call: %s" % [told])
	device.notification(Node.NOTIFICATION_APPLICATION_FOCUS_OUT)
	device.advance_cycles(50)
	device.notification(Node.NOTIFICATION_APPLICATION_FOCUS_IN)
	device.advance_cycles(2000)
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "nor is a look at another window")
	device.config = device.config.duplicate()
	await physics_frames(2)
	device.advance_cycles(2000)
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "nor another config")
	device.arm()
	device.advance_cycles(2000)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "clear_fault() and arm() lead back")
	device.free()


func test_a_stop_of_a_closed_device_is_kept() -> void:
	var device: SpidarG = ideal_device()
	device.enabled = false
	device.forces_enabled = true
	device.panic_stop()
	add(device)
	device.panic_stop()
	await physics_frames(2)
	check(device.get_fault_text().contains("panic_stop"), "told while closed: %s" % device.get_fault_text())
	device.enabled = true
	await _stays_stopped(device, "opened after it")
	device.clear_fault()
	device.enabled = false
	device.clear_fault()
	device.enabled = true
	device.advance_cycles(2000)
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "cleared, but after a panic even a simulated one waits")
	device.arm()
	device.advance_cycles(2000)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "for arm()")
	device.free()


func _stays_stopped(device: SpidarG, when: String) -> void:
	for _i: int in 20:
		await physics_frames(1)
		device.advance_cycles(100)
		for tension: float in device.get_string_tensions():
			check_equal(tension, 0.0, "%s: motors off" % when)
	check_equal(device.get_state(), SpidarG.STATE_FAULT, "%s: stopped" % when)


func _handler() -> GDScript:
	var script := GDScript.new()
	script.source_code = "extends Node3D\nfunc _input(_event: InputEvent) -> void:\n\tget_viewport().set_input_as_handled()\n"
	script.reload()
	return script


func _key(pressed: bool) -> void:
	var event := InputEventKey.new()
	event.physical_keycode = KEY_F9
	event.keycode = KEY_F9
	event.pressed = pressed
	Input.parse_input_event(event)
	Input.flush_buffered_events()


func _active_device() -> SpidarG:
	var device: SpidarG = ideal_device()
	device.forces_enabled = true
	add(device)
	await physics_frames(1)
	device.advance_cycles(1600)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "active")
	return device
