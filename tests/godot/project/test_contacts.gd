## Contact planes and the grasp stop, felt by the plant's hand.
extends "res://test_case.gd"

const STIFFNESS: float = 350.0
const DAMPING: float = 2.0
## Normal hand of the plant (N/m).
const HAND_STIFFNESS: float = 300.0


func test_a_plane_stops_the_hand() -> void:
	var device: SpidarG = await _armed_device()
	var surface: float = -0.02
	var target: float = -0.05
	device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, Vector3(0, target, 0)), 0.0)
	_press(device, _plane(Vector3.UP, surface, SpidarG.CONTACT_CENTER, 7), 2000)
	# Two springs in balance: the plane's and the hand's.
	var depth: float = HAND_STIFFNESS * (surface - target) / (STIFFNESS + HAND_STIFFNESS)
	var height: float = device.get_grip_transform().origin.y
	print("INFO pressed in by %.3f mm, two springs say %.3f mm" % [1e3 * (surface - height), 1e3 * depth])
	check_near(height, surface - depth, 0.05 * depth, "the hand rests in the plane at the balance")
	check(device.get_touching_contacts().has(7), "the plane reports its touch")
	var impulse: Vector3 = device.get_contact_impulses()[7]
	check(impulse.y > 0.0 and absf(impulse.x) < 1e-3 * impulse.y, "the impulse pushes out: %s" % impulse)
	var felt: PackedFloat64Array = device.get_simulated_truth()["strings_wrench"]
	check_near(felt[1], STIFFNESS * depth, 0.05 * STIFFNESS * depth, "force felt")


func test_a_plane_never_pulls() -> void:
	var device: SpidarG = await _armed_device()
	device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, Vector3(0, 0.03, 0)), 0.0)
	var lowest: float = 0.0
	for _i: int in 40:
		device.set_contacts(_plane(Vector3.UP, 0.0, SpidarG.CONTACT_CENTER, 1))
		device.advance_cycles(25)
		lowest = minf(lowest, device.get_requested_wrench()[1])
	check(lowest >= 0.0, "leaving a plane asks for no force towards it: %f" % lowest)
	check_equal(device.get_touching_contacts().size(), 0, "nothing touches")


func test_contacts_fade_when_the_game_stops_sending() -> void:
	var device: SpidarG = await _armed_device()
	device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, Vector3(0, -0.03, 0)), 0.0)
	_press(device, _plane(Vector3.UP, 0.0, SpidarG.CONTACT_CENTER, 1), 1000)
	check(device.get_requested_wrench()[1] > 1.0, "pushes while renewed")
	device.advance_cycles(90)
	check(device.get_requested_wrench()[1] > 1.0, "still in full at 90 ms")
	device.advance_cycles(260)
	check_near(device.get_requested_wrench()[1], 0.0, 1e-9, "gone after 300 ms")


func test_grasp_stop_holds_the_jaws_at_the_width() -> void:
	var device: SpidarG = await _armed_device()
	var width: float = 0.035
	var angle: float = device.get_grasp_angle_for_gap(width)
	device.set_simulated_hand_target(Transform3D.IDENTITY, deg_to_rad(60.0))
	_press(device, _grasp_stop(angle, 3), 2000)
	check(device.get_grasp_angle() < deg_to_rad(55.0), "the stop holds against the hand")
	check(device.get_grasp_angle() > angle - 0.01, "the hand closes up to the stop")
	var felt: PackedFloat64Array = device.get_simulated_truth()["strings_wrench"]
	check(felt[6] < -0.01, "the hand feels an opening torque: %f" % felt[6])
	var angle_with_stop: float = device.get_grasp_angle()
	device.clear_contacts()
	device.advance_cycles(1500)
	check(device.get_grasp_angle() > angle_with_stop + 0.05, "without the stop the hand closes on")


func test_planes_are_given_in_world_coordinates() -> void:
	var device: SpidarG = ideal_device()
	device.forces_enabled = true
	var turn := Basis(Vector3(0, 0, 1), PI / 2.0)
	device.transform = Transform3D(turn, Vector3(1, 2, 3))
	device.workspace_scale = 2.0
	add(device)
	await physics_frames(1)
	device.set_simulated_hand_target(Transform3D(turn, Vector3(1, 2, 3)), 0.0)
	device.advance_cycles(1600)
	check(device.get_grip_transform().origin.distance_to(Vector3(1, 2, 3)) < 1e-3, "rests at the node")
	# 4 cm below a floor through the node: 2 cm of the device.
	device.set_simulated_hand_target(Transform3D(turn, Vector3(1, 1.96, 3)), 0.0)
	_press(device, _plane(Vector3.UP, 2.0, SpidarG.CONTACT_CENTER, 1), 2000)
	var depth: float = HAND_STIFFNESS * 0.02 / (STIFFNESS + HAND_STIFFNESS)
	var grip: Vector3 = device.get_grip_transform().origin
	check_near(grip.y, 2.0 - 2.0 * depth, 0.1 * depth, "depth in the scene is twice that of the device")
	check_near(grip.x, 1.0, 1e-3, "no push along world x")
	var felt: PackedFloat64Array = device.get_simulated_truth()["strings_wrench"]
	check_near(felt[1], STIFFNESS * depth, 0.05 * STIFFNESS * depth, "force along world y, not scaled")


func _armed_device() -> SpidarG:
	var device: SpidarG = ideal_device()
	device.forces_enabled = true
	add(device)
	await physics_frames(1)
	device.advance_cycles(1600)
	return device


func _press(device: SpidarG, contacts: PackedFloat64Array, cycles: int) -> void:
	for _i: int in cycles / 20:
		device.set_contacts(contacts)
		device.advance_cycles(20)


func _plane(normal: Vector3, offset: float, target: int, id: int) -> PackedFloat64Array:
	return PackedFloat64Array([normal.x, normal.y, normal.z, offset, 0, 0, 0, STIFFNESS, DAMPING, 0.0,
		target, id])


func _grasp_stop(angle: float, id: int) -> PackedFloat64Array:
	return PackedFloat64Array([-1, 0, 0, -angle, 0, 0, 0, 0.25, 0.001, 0.0, SpidarG.CONTACT_GRASP_STOP, id])


func test_impulse_over_device_time_is_the_mean_force() -> void:
	for time_scale: float in [1.0, 0.1, 0.0]:
		var lone: SpidarG = ideal_device()
		lone.forces_enabled = true
		add(lone)
		await physics_frames(1)
		lone.advance_cycles(1600)
		Engine.time_scale = time_scale
		# 10 mm into the hand.
		var plane := PackedFloat64Array([0, 1, 0, 0.01, 0, 0, 0, 200, 0, 0, SpidarG.CONTACT_CENTER, 7])
		var impulse: float = 0.0
		var began_s: float = 0.0
		for i: int in 60:
			lone.set_simulated_hand_target(Transform3D.IDENTITY, 0.0)
			lone.set_contacts(plane)
			await physics_frames(1)
			if i == 40:
				impulse = lone.get_contact_impulses()[7].y
				began_s = lone.get_device_time()
		var force: float = (lone.get_contact_impulses()[7].y - impulse) / (lone.get_device_time() - began_s)
		check_near(force / lone.get_requested_wrench()[1], 1.0, 0.01, "time scale %s" % time_scale)
		lone.free()
