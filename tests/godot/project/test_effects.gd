## Coupling and effects, felt by the plant's hand, and what they refuse.
extends "res://test_case.gd"

const HAND_STIFFNESS: float = 300.0
const ONCE: Array[float] = [350.0, 350.0, 350.0, 0.5, 0.5, 0.5, 0.125]
var _messages: Array[String] = []


func test_coupling_pulls_the_hand_to_the_target() -> void:
	var device: SpidarG = await _armed_device()
	var target := Transform3D(Basis.IDENTITY, Vector3(0.01, 0.0, 0.0))
	for _i: int in 100:
		check(device.set_coupling(target, 0.0), "taken")
		device.advance_cycles(16)
	# Two springs in balance: the coupling's and the hand's.
	var moved: float = 0.01 * 350.0 / (350.0 + HAND_STIFFNESS)
	check_near(device.get_grip_transform().origin.x, moved, 0.05 * moved, "the balance of two springs")
	# 300 ms until it is forgotten; then the passivity controller brakes the hand that springs back.
	device.advance_cycles(1500)
	check_near(device.get_requested_wrench()[0], 0.0, 1e-4, "forgotten, it is gone")


func test_coupling_takes_world_coordinates_and_a_mask() -> void:
	var device: SpidarG = ideal_device()
	device.forces_enabled = true
	var turn := Basis(Vector3(0, 0, 1), PI / 2.0)
	device.transform = Transform3D(turn, Vector3(1, 2, 3))
	device.workspace_scale = 2.0
	add(device)
	await physics_frames(1)
	device.set_simulated_hand_target(Transform3D(turn, Vector3(1, 2, 3)), 0.0)
	device.advance_cycles(1600)
	for _i: int in 100:
		# World y is the node's x.
		device.set_coupling(Transform3D(turn, Vector3(1.02, 2.02, 3)), 0.0, Vector3.ZERO, Vector3.ZERO, 0.0,
			SpidarG.DOF_X)
		device.advance_cycles(16)
	var moved: float = 2.0 * 0.01 * 350.0 / (350.0 + HAND_STIFFNESS)
	var grip: Vector3 = device.get_grip_transform().origin
	check_near(grip.y - 2.0, moved, 0.05 * moved, "follows in the masked DOF")
	check_near(grip.x - 1.0, 0.0, 1e-3, "and not in the others")


func test_effects_act_as_they_say() -> void:
	var device: SpidarG = await _armed_device()
	check(device.set_force_effect(1, Vector3(0, -1, 0), Vector3.ZERO, 0.0, 5.0), "force taken")
	device.advance_cycles(1000)
	check_near(device.get_requested_wrench()[1], -1.0, 1e-6, "a constant force")
	check(device.set_spring_effect(2, Transform3D(Basis.IDENTITY, Vector3(0, 0, 0.02)), 0.0, 100.0, 0.0, 0.0), "spring")
	device.advance_cycles(900)
	var pull: float = device.get_requested_wrench()[2]
	var away: float = 0.02 - device.get_grip_transform().origin.z
	check_near(pull, 100.0 * away, 0.02 * pull, "a spring")
	device.clear_effect(2)
	device.advance_cycles(100)
	check_near(device.get_requested_wrench()[2], 0.0, 1e-9, "cleared")
	check_near(device.get_requested_wrench()[1], -1.0, 1e-6, "the other one stays")
	check(device.set_vibration_effect(3, Vector3(0.5, 0, 0), Vector3.ZERO, 0.0, 40.0), "vibration")
	var least: float = 0.0
	var most: float = 0.0
	for _i: int in 100:
		device.advance_cycles(1)
		least = minf(least, device.get_requested_wrench()[0])
		most = maxf(most, device.get_requested_wrench()[0])
	check(most > 0.4 and most < 0.51 and least < -0.4 and least > -0.51, "swings: %f to %f" % [least, most])
	check(device.set_detent_effect(4, Transform3D.IDENTITY, 0.0, 0.01, 0.3, SpidarG.DOF_Z), "detents")
	check(device.set_viscous_effect(5, 3.0, 0.0, 0.0), "viscous")
	device.clear_effects()
	device.advance_cycles(100)
	check_near(device.get_requested_wrench()[1], 0.0, 1e-9, "all cleared")


func test_what_is_too_stiff_is_brought_down_and_told() -> void:
	var device: SpidarG = await _armed_device()
	check_equal(device.get_clamp_text(), "", "nothing yet")
	var most: Vector3 = device.get_stiffness_limits()
	check(most.x >= 900.0 and most.y >= 2.0 and most.z >= 0.5, "limits %s" % most)
	device.set_contacts(PackedFloat64Array([0, 1, 0, -0.02, 0, 0, 0, 9000, 2, 0, SpidarG.CONTACT_CENTER, 1]))
	device.advance_cycles(10)
	var text: String = device.get_clamp_text()
	for word: String in ["contact", "9000", "N/m", "latency", "lower"]:
		check(text.contains(word), "'%s' in '%s'" % [word, text])


func test_a_turn_stop_holds_the_turn() -> void:
	var device: SpidarG = await _armed_device()
	device.set_simulated_hand_target(Transform3D(Basis(Vector3.UP, 0.4), Vector3.ZERO), 0.0)
	for _i: int in 100:
		# Turns about y up to 0.2 rad are free.
		device.set_contacts(PackedFloat64Array([0, -1, 0, -0.2, 0, 0, 0, 1.0, 0.003, 0, SpidarG.CONTACT_TURN_STOP, 1]))
		device.advance_cycles(16)
	var turn: float = device.get_grip_transform().basis.get_euler().y
	check_near(turn, 0.2 + 0.2 * 0.48 / (1.0 + 0.48), 0.01, "the balance of stop and hand")


func test_bad_effects_are_refused_by_name() -> void:
	var device: SpidarG = await _armed_device()
	_expect(device.set_coupling(Transform3D.IDENTITY, NAN), "set_coupling", "finite")
	_expect(device.set_coupling(Transform3D.IDENTITY, 0.0, Vector3.ZERO, Vector3.ZERO, 0.0, 200), "set_coupling", "dof_mask")
	_expect(device.set_coupling_gains(PackedFloat64Array([1.0]), PackedFloat64Array(ONCE)), "stiffness", "7")
	var bad := PackedFloat64Array(ONCE)
	bad[4] = -1.0
	_expect(device.set_coupling_gains(PackedFloat64Array(ONCE), bad), "damping[4]", "0 or more")
	_expect(device.set_vibration_effect(1, Vector3.ONE, Vector3.ZERO, 0.0, 1000.0), "frequency_hz", "Hz")
	_expect(device.set_viscous_effect(1, -1.0, 0.0, 0.0), "set_viscous_effect", "strength")
	_expect(device.set_viscous_effect(1, 1.0, 0.0, 0.0, SpidarG.DOF_ALL, 100.0), "duration_s", "60")
	_expect(device.set_detent_effect(1, Transform3D.IDENTITY, 0.0, 0.0, 1.0, SpidarG.DOF_X), "spacing", "rad")
	_expect(device.set_force_effect(1, Vector3(NAN, 0, 0), Vector3.ZERO, 0.0), "set_force_effect", "finite")
	for id: int in 6:
		check(device.set_viscous_effect(id, 1.0, 0.0, 0.0), "six fit")
	_expect(device.set_viscous_effect(6, 1.0, 0.0, 0.0), "set_viscous_effect", "clear_effect")


func _expect(taken: bool, where: String, what: String) -> void:
	check(not taken, "refused: %s" % where)
	var text: String = _messages[-1] if not _messages.is_empty() else ""
	check(text.contains(where) and text.contains(what), "'%s' names %s and %s" % [text, where, what])
	_messages.clear()


func _armed_device() -> SpidarG:
	var device: SpidarG = ideal_device()
	device.forces_enabled = true
	device.request_rejected.connect(func(message: String) -> void: _messages.append(message))
	add(device)
	await physics_frames(1)
	device.advance_cycles(1600)
	return device
