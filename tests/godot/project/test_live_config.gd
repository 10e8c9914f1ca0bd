## What of a config changes while the device is open: limits and caps without a jolt; the rest opens it anew.
extends "res://hand_scene.gd"


func test_limits_change_without_a_jolt_and_keep_what_is_held() -> void:
	await set_up(Vector3(0.0, FLOOR_Y + 0.03, 0.0))
	var told: PackedStringArray = []
	device.device_lost.connect(func(_reason: String) -> void: told.append("lost"))
	device.disarmed.connect(func() -> void: told.append("disarmed"))
	var body: RigidBody3D = add_free_box(Vector3(0.04, 0.06, 0.04), 0.1)
	await grasp(body)
	await move_to(Vector3(0.0, 0.05, 0.0), SQUEEZE_ANGLE, 60)
	check(hand.get_held_body() == body, "held")
	var ticks: int = device.get_statistics()["ticks"]
	device.config.max_force = 5.0
	device.config.max_stiffness = 600.0
	device.config.jaw_open = 0.081
	await physics_frames(60)
	check(hand.get_held_body() == body, "still held")
	check_equal(told, PackedStringArray(), "never closed nor disarmed")
	check(device.get_statistics()["ticks"] > ticks, "the same loop goes on")
	check_equal(device.get_stiffness_limits().x, 600.0, "the new cap")
	device.config.rate_hz = 500
	await physics_frames(3)
	check_equal(told, PackedStringArray(["disarmed", "lost"]), "the rate needs the device opened anew")


func test_a_lower_limit_comes_in_small_steps() -> void:
	var lone: SpidarG = ideal_device()
	lone.forces_enabled = true
	add(lone)
	await physics_frames(1)
	lone.advance_cycles(1600)
	var before: float = 6.0
	for frame: int in 60:
		lone.request_wrench(Vector3(0, 6, 0), Vector3.ZERO, 0.0)
		if frame == 10:
			lone.config.max_force = 2.0
		await physics_frames(1)
		var now: float = lone.get_achieved_wrench()[1]
		if frame > 8:
			check(absf(now - before) < 0.5, "frame %d: %f after %f N" % [frame, now, before])
			before = now
	check_near(before, 2.0, 0.02, "the new limit holds")
	for frame: int in 60:
		if frame == 0:
			lone.config.max_force = 8.0
		lone.request_wrench(Vector3(0, 6, 0), Vector3.ZERO, 0.0)
		await physics_frames(1)
	check_near(lone.get_achieved_wrench()[1], 6.0, 0.05, "and back")
	check_equal(lone.get_state(), SpidarG.STATE_ACTIVE, "active all the time")
	lone.free()


func test_what_makes_no_sense_changes_nothing() -> void:
	var lone: SpidarG = ideal_device()
	lone.forces_enabled = true
	var messages: PackedStringArray = []
	lone.request_rejected.connect(func(message: String) -> void: messages.append(message))
	add(lone)
	await physics_frames(1)
	lone.advance_cycles(1600)
	for case: Array in [["max_force", NAN], ["max_force", -1.0], ["max_stiffness", INF], ["tension_max", NAN], ["rate_hz", 7]]:
		var good: Variant = lone.config.get(case[0])
		messages.clear()
		lone.config.set(case[0], case[1])
		await physics_frames(3)
		check_equal(lone.get_state(), SpidarG.STATE_ACTIVE, "%s = %s: goes on" % case)
		check(messages.size() == 1, "%s = %s: told once: %s" % [case[0], case[1], messages])
		lone.config.set(case[0], good)
		await physics_frames(80)
		check_equal(lone.get_state(), SpidarG.STATE_ACTIVE, "mended")
	lone.request_wrench(Vector3(0, 6, 0), Vector3.ZERO, 0.0)
	await physics_frames(2)
	check_near(lone.get_requested_wrench()[1], 6.0, 1e-6, "with the limits of before")
	lone.free()


func test_the_help_of_a_setting_says_when_it_opens_the_device_anew() -> void:
	var help: Dictionary[String, bool] = {}
	var path: String = ProjectSettings.globalize_path("res://") + "../../../gdextension/doc_classes/SpidarGConfig.xml"
	var members: PackedStringArray = FileAccess.get_file_as_string(path).split("<member name=\"")
	for member: String in members.slice(1):
		help[member.get_slice("\"", 0)] = member.get_slice("</member>", 0).contains("A change reopens the device")
	var lone: SpidarG = ideal_device()
	lone.config.device_name = "live config"
	add(lone)
	await physics_frames(2)
	var lost: Array[int] = [0]
	lone.device_lost.connect(func(_reason: String) -> void: lost[0] += 1)
	for setting: String in help:
		lost[0] = 0
		lone.config.set(setting, _another(setting, lone.config.get(setting)))
		check_equal(lone.config.get_problem(), "", "%s: still usable" % setting)
		await physics_frames(3)
		check_equal(lost[0] > 0, help[setting], "%s: opened anew, as its help says" % setting)
	check(help.size() > 40, "%d settings" % help.size())


func _another(setting: String, value: Variant) -> Variant:
	match typeof(value):
		TYPE_BOOL:
			return not value
		TYPE_INT:
			return 900 if setting == "rate_hz" else (value + 1 if setting != "simulated_hand_firmness" else 0)
		TYPE_FLOAT:
			return 1.01 * value + 1e-6
		TYPE_STRING:
			return value + "x"
		TYPE_PACKED_FLOAT64_ARRAY:
			return PackedFloat64Array([1e-3, 0, 0, 0, 0, 0, 0, 0]) if setting != "simulated_tension_gains" else PackedFloat64Array([1, 1, 1, 1, 1, 1, 1, 0.99])
		TYPE_PACKED_INT32_ARRAY: # serial_motors: board, motor, two signs
			var motors := PackedInt32Array()
			for string in 8:
				motors.append_array([0, string, 1, 1])
			return motors
	return 1.01 * value
