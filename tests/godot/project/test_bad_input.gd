## Bad input: a message that names field, value, unit and remedy; the pose holds, tensions stay within limits.
extends "res://test_case.gd"

var _messages: Array[String] = []


func test_wrench_that_is_not_finite_is_refused_whole() -> void:
	var device: SpidarG = await _armed_device()
	device.request_wrench(Vector3(0, 1, 0), Vector3.ZERO, 0.0, 0.5)
	for bad: float in [NAN, INF, -INF]:
		for slot: int in 7:
			var force := Vector3(bad if slot == 0 else 0.0, bad if slot == 1 else 0.0, bad if slot == 2 else 0.0)
			var moment := Vector3(bad if slot == 3 else 0.0, bad if slot == 4 else 0.0, bad if slot == 5 else 0.0)
			_messages.clear()
			check(not device.request_wrench(force, moment, bad if slot == 6 else 0.0, 0.05), "refused")
			_check_message("request_wrench", ["N m", "finite"])
	check(not device.request_wrench(Vector3.UP, Vector3.ZERO, 0.0, NAN), "duration refused")
	device.advance_cycles(50)
	check_near(device.get_requested_wrench()[1], 1.0, 1e-9, "the last good request stands")
	_check_tensions(device)


func test_contacts_that_make_no_sense_are_refused_by_name() -> void:
	var device: SpidarG = await _armed_device()
	var good := PackedFloat64Array([0, 1, 0, -0.1, 0, 0, 0, 350, 2, 0, 0, 1])
	check(device.set_contacts(good), "a good plane is taken")
	for case: Array in [[0, NAN, "normal.x"], [3, INF, "offset"], [7, -1.0, "stiffness"], [8, NAN, "damping"],
			[9, -0.5, "friction"], [10, 9.0, "target"], [10, 0.5, "target"], [11, 0.5, "id"], [11, 1e12, "id"],
			[1, 0.0, "normal"]]:
		var bad: PackedFloat64Array = good.duplicate()
		bad[case[0]] = case[1]
		_messages.clear()
		check(not device.set_contacts(bad), "%s refused" % case[2])
		_check_message("set_contacts", [case[2]])
	_messages.clear()
	check(not device.set_contacts(PackedFloat64Array([1, 2, 3])), "wrong stride refused")
	_check_message("set_contacts", ["CONTACT_STRIDE"])
	var nine := PackedFloat64Array()
	for _i: int in 9:
		nine.append_array(good)
	check(not device.set_contacts(nine), "nine planes refused")
	device.advance_cycles(100)
	_check_tensions(device)


func test_impossible_geometry_keeps_the_device_closed_and_says_why() -> void:
	for case: Array in [["frame_size", Vector3(0, 0.48, 0.48), "frame_size.x", "m"],
			["frame_size", Vector3(0.48, NAN, 0.48), "frame_size.y", "m"],
			["pole_half_length", -0.04, "pole_half_length", "m"],
			["pole_half_length", NAN, "pole_half_length", "m"],
			["rate_hz", 5, "rate_hz", "Hz"], ["tension_max", NAN, "tension", "N"],
			["tension_min", 20.0, "tension", "N"], ["arming_time", NAN, "arming_time", "s"]]:
		var config := SpidarGConfig.new()
		config.set(case[0], case[1])
		check(config.get_problem().contains(case[2]) and config.get_problem().contains(case[3]),
			"%s: %s" % [case[0], config.get_problem()])
		var device := SpidarG.new()
		device.config = config
		_messages.clear()
		device.fault_raised.connect(func(_status: int, message: String) -> void: _messages.append(message))
		add(device)
		await physics_frames(2)
		check_equal(device.get_state(), SpidarG.STATE_CLOSED, "%s: stays closed" % case[0])
		_check_message("closed", [case[2]])
		check(device.get_fault_text().contains(case[2]), "status at run time names the field")
		# Mending the field opens the device.
		config.set(case[0], SpidarGConfig.new().get(case[0]))
		check(await until(is_open.bind(device)), "%s: opens once mended" % case[0])
		device.free()


func test_bad_calibration_is_refused_by_name() -> void:
	for case: Array in [["string_offsets", PackedFloat64Array([1, 2, 3]), "string_offsets"],
			["string_scales", PackedFloat64Array([0, 0, 0, 0, 0, 0, 0, 0]), "scale"],
			["string_scales", PackedFloat64Array([NAN, 1, 1, 1, 1, 1, 1, 1]), "scale"],
			["effective_radii", PackedFloat64Array([-1, 1, 1, 1, 1, 1, 1, 1]), "radius"],
			["winding_curvatures", PackedFloat64Array([0, 0, 0, 9, 0, 0, 0, 0]), "winding"],
			["string_stiffnesses", PackedFloat64Array([-3000, 1, 1, 1, 1, 1, 1, 1]), "stiffness"],
			["hidden_lengths", PackedFloat64Array([0.1, 0.1]), "hidden_lengths"],
			["calibration_tensions", PackedFloat64Array([INF, 0, 0, 0, 0, 0, 0, 0]), "tension"],
			["zero_counts", PackedInt32Array([1]), "zero_counts"]]:
		var calibration := SpidarGCalibration.new()
		calibration.set(case[0], case[1])
		check(calibration.get_problem().contains(case[2]), "%s: %s" % [case[0], calibration.get_problem()])
		var device: SpidarG = ideal_device()
		device.calibration = calibration
		add(device)
		await physics_frames(2)
		check_equal(device.get_state(), SpidarG.STATE_CLOSED, "%s: stays closed" % case[0])
		device.free()
	check_equal(SpidarGCalibration.new().get_problem(), "", "an empty calibration is the ideal device")


func test_second_node_on_one_device_is_refused() -> void:
	var config := SpidarGConfig.new()
	config.device_name = "bench 1"
	var first := SpidarG.new()
	first.name = "First"
	first.config = config
	add(first)
	var second := SpidarG.new()
	second.config = config
	_messages.clear()
	second.fault_raised.connect(func(_status: int, message: String) -> void: _messages.append(message))
	add(second)
	check(await until(is_open.bind(first)), "the first has it")
	check_equal(second.get_state(), SpidarG.STATE_CLOSED, "the second is refused")
	_check_message("device_name", ["bench 1", "First"])
	first.free()
	second.enabled = false
	second.enabled = true
	check(await until(is_open.bind(second)), "free again once the first is gone")


func test_counts_that_jump_latch_a_fault_and_the_pose_holds() -> void:
	var device: SpidarG = await _armed_device()
	var before: Transform3D = device.get_grip_transform()
	_messages.clear()
	device.fault_raised.connect(func(_status: int, message: String) -> void: _messages.append(message))
	device.inject_simulated_fault(SpidarG.FAULT_COUNT_JUMP, 2)
	device.advance_cycles(20)
	check_equal(device.get_state(), SpidarG.STATE_FAULT, "latched")
	_check_message("String 3", [])
	check(device.get_grip_transform().origin.distance_to(before.origin) < 1e-3, "the pose holds")
	for tension: float in device.get_string_tensions():
		check_equal(tension, 0.0, "motors off")
	device.clear_simulated_faults()
	device.advance_cycles(20)
	check_equal(device.get_state(), SpidarG.STATE_FAULT, "still latched")
	device.clear_fault()
	device.advance_cycles(20)
	check(device.get_state() != SpidarG.STATE_FAULT, "cleared by hand only")
	device.arm()
	device.advance_cycles(1600)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "armed again")


func test_unplugged_device_is_reported_lost() -> void:
	var device: SpidarG = await _armed_device()
	_messages.clear()
	device.device_lost.connect(func(reason: String) -> void: _messages.append(reason))
	device.inject_simulated_fault(SpidarG.FAULT_UNPLUGGED)
	device.advance_cycles(40)
	check(_messages.size() == 1 and _messages[0].length() > 0, "one device_lost with a reason: %s" % [_messages])
	check_equal(device.get_state(), SpidarG.STATE_CLOSED, "closed")


func test_hand_targets_that_are_not_finite_are_refused() -> void:
	var device: SpidarG = await _armed_device()
	_messages.clear()
	check(not device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, Vector3(NAN, 0, 0)), 0.0), "refused")
	check(not device.set_simulated_hand_target(Transform3D.IDENTITY, INF), "refused")
	_check_message("set_simulated_hand_target", ["finite"])
	device.workspace_scale = 0.0
	check_equal(device.workspace_scale, 1.0, "workspace_scale 0 is refused")
	device.advance_cycles(200)
	check(device.get_grip_transform().origin.is_finite(), "the pose stays good")


func _armed_device() -> SpidarG:
	var device: SpidarG = ideal_device()
	device.forces_enabled = true
	device.request_rejected.connect(func(message: String) -> void: _messages.append(message))
	add(device)
	await physics_frames(1)
	device.advance_cycles(1600)
	return device


func _check_message(start: String, parts: Array) -> void:
	if not check(_messages.size() > 0, "a message about %s" % start):
		return
	for part: Variant in [start] + parts:
		check(_messages[-1].contains(str(part)), "message names \"%s\": %s" % [part, _messages[-1]])


func _check_tensions(device: SpidarG) -> void:
	for tension: float in device.get_string_tensions():
		check(tension >= 0.0 and tension <= 10.0, "tension within limits: %f" % tension)
