## Every fault of the simulated device, from GDScript: accepted, answered, and over again.
extends "res://test_case.gd"

## What each must do to an active device within half a second.
const LATCHES: Array[int] = [
	SpidarG.FAULT_COUNT_JUMP, SpidarG.FAULT_READ_TIMEOUT, SpidarG.FAULT_COUNTS_RESET,
]
const ALL: int = 18


func test_every_fault_can_be_injected_and_cleared() -> void:
	for fault: int in ALL:
		var device := ideal_device()
		device.forces_enabled = true
		add(device)
		await physics_frames(70)
		check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "active before fault %d" % fault)
		check(device.inject_simulated_fault(fault, 2, 0.05, 0.3), "fault %d is accepted" % fault)
		for frame: int in 30:
			device.set_simulated_hand_target(
				Transform3D(Basis(), Vector3(0.03 * sin(0.3 * frame), 0.03 * cos(0.3 * frame), 0.0)), 0.2)
			await physics_frames(1)
			for tension_n: float in device.get_string_tensions():
				if not (tension_n >= 0.0 and tension_n <= device.config.tension_max):
					check(false, "fault %d: a tension of %f N" % [fault, tension_n])
			if fault == SpidarG.FAULT_UNPLUGGED and frame == 10:
				check_equal(device.get_state(), SpidarG.STATE_CLOSED, "unplugged: closed")
		if fault in LATCHES:
			check_equal(device.get_state(), SpidarG.STATE_FAULT, "fault %d latches" % fault)
			check(not device.get_fault_text().is_empty(), "with its reason")
		device.clear_simulated_faults()
		device.free()


func test_bad_faults_are_refused() -> void:
	var rejected: Array[String] = []
	var device := ideal_device()
	device.request_rejected.connect(func(message: String) -> void: rejected.append(message))
	check(not device.inject_simulated_fault(SpidarG.FAULT_UNPLUGGED), "no device yet")
	add(device)
	await physics_frames(1)
	check(not device.inject_simulated_fault(ALL), "no such fault")
	check(not device.inject_simulated_fault(-1), "no such fault either")
	check(not device.inject_simulated_fault(SpidarG.FAULT_STUCK_ENCODER, 8), "no such string")
	check(not device.inject_simulated_fault(SpidarG.FAULT_STUCK_ENCODER, 0, -1.0), "a start in the past")
	check(not device.inject_simulated_fault(SpidarG.FAULT_STUCK_ENCODER, 0, 0.0, NAN), "no duration")
	check_equal(rejected.size(), 6, "each is told")
	for i: int in 8:
		check(device.inject_simulated_fault(SpidarG.FAULT_STUCK_ENCODER, i, 100.0), "fault %d waits" % i)
	check(not device.inject_simulated_fault(SpidarG.FAULT_STUCK_ENCODER, 0, 100.0), "the ninth has no place")
	check(rejected[6].contains("8 faults"), "and says so: %s" % rejected[6])
	device.clear_simulated_faults()
	await physics_frames(1)
	check(device.inject_simulated_fault(SpidarG.FAULT_STUCK_ENCODER, 0, 100.0), "cleared: there is room")
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "the device is as it was")
	device.free()
