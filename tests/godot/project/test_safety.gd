## What a game hears of faults, and what takes the forces away: events, panic, focus, zero.
extends "res://test_case.gd"

var _events: Array[Dictionary] = []


func test_a_fault_is_told_with_name_string_and_remedy() -> void:
	var device: SpidarG = await _armed_device()
	device.inject_simulated_fault(SpidarG.FAULT_COUNT_JUMP, 4)
	device.advance_cycles(20)
	var event: Dictionary = _event_named("count_jump")
	if not check(not event.is_empty(), "count_jump among %s" % [_names()]):
		return
	check_equal(event["category"], "string", "category")
	check_equal(event["level"], SpidarG.EVENT_FAULT, "level")
	check_equal(event["string"], 4, "string")
	check(event["message"].ends_with("."), "a sentence: %s" % event["message"])
	check(event["remedy"].contains("arm()"), "a remedy: %s" % event["remedy"])
	check(event["time_s"] > 1.0, "on the servo loop's clock: %f s" % event["time_s"])


func test_a_fault_that_repeats_is_told_once_a_second() -> void:
	var device: SpidarG = await _armed_device()
	device.inject_simulated_fault(SpidarG.FAULT_REPORTS_LOST)
	device.advance_cycles(3500)
	var told: int = _names().count("reports_missed")
	check(told >= 3 and told <= 4, "told %d times in 3.5 s" % told)
	check(device.get_statistics()["reports_missed"] >= 30, "but all are counted")
	check(int(_events.back()["repeated"]) > 0, "and the event says how many were left out")


func test_panic_stop_is_off_in_the_next_cycle_and_latched() -> void:
	var device: SpidarG = await _armed_device()
	check(device.get_string_tensions()[0] > 0.0, "pulling")
	device.panic_stop()
	device.advance_cycles(1)
	check_equal(device.get_string_tensions(), PackedFloat64Array([0, 0, 0, 0, 0, 0, 0, 0]), "off")
	check_equal(device.get_state(), SpidarG.STATE_FAULT, "latched")
	check(device.get_fault_text().contains("panic_stop"), device.get_fault_text())
	device.arm()
	device.advance_cycles(100)
	check_equal(device.get_state(), SpidarG.STATE_FAULT, "arm() alone does not help")


func test_forces_go_with_the_focus_and_come_back() -> void:
	var device: SpidarG = await _armed_device()
	device.notification(Node.NOTIFICATION_APPLICATION_FOCUS_OUT)
	device.advance_cycles(50)
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "away")
	check(device.forces_enabled, "the property is the game's own")
	device.notification(Node.NOTIFICATION_APPLICATION_FOCUS_IN)
	device.advance_cycles(1100)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "back")
	device.release_on_focus_loss = false
	device.notification(Node.NOTIFICATION_APPLICATION_FOCUS_OUT)
	device.advance_cycles(50)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "a game may keep them")


func test_a_device_that_restarted_needs_a_zero_at_home() -> void:
	var device: SpidarG = await _armed_device()
	device.inject_simulated_fault(SpidarG.FAULT_COUNTS_RESET)
	device.advance_cycles(5)
	check_equal(device.get_state(), SpidarG.STATE_FAULT, "its zero is gone")
	device.clear_fault()
	device.advance_cycles(200)
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "not armed without a zero")
	check(not device.get_statistics()["zero_known"], "the statistics say so")
	check(device.zero_at_home(), "accepted")
	device.advance_cycles(700)
	check_equal(device.get_state(), SpidarG.STATE_TAUT, "waits for the motion that checks it")
	for target: Vector3 in [Vector3(0.05, 0.03, 0), Vector3(-0.05, 0, 0.04), Vector3(0, -0.04, -0.03)]:
		device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, target), 0.0)
		device.advance_cycles(500)
	check(_names().has("zero_confirmed"), "confirmed: %s" % [_names()])
	check(device.get_statistics()["zero_known"], "known again")


func test_zero_at_home_without_forces_is_refused_with_a_remedy() -> void:
	var device: SpidarG = await _armed_device()
	device.forces_enabled = false
	var messages: Array[String] = []
	device.request_rejected.connect(func(message: String) -> void: messages.append(message))
	check(not device.zero_at_home(), "refused")
	check(messages.size() == 1 and messages[0].contains("forces_enabled"), "%s" % [messages])


func _armed_device() -> SpidarG:
	var device: SpidarG = ideal_device()
	device.forces_enabled = true
	device.device_event.connect(func(event: Dictionary) -> void: _events.append(event))
	add(device)
	await physics_frames(1)
	device.advance_cycles(1600)
	check(_names().has("armed"), "armed is told: %s" % [_names()])
	return device


func _names() -> Array:
	return _events.map(func(event: Dictionary) -> String: return event["name"])


func _event_named(wanted: String) -> Dictionary:
	for event: Dictionary in _events:
		if event["name"] == wanted:
			return event
	return {}
