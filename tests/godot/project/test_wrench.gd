## A requested wrench is what the plant's hand feels, in all seven DOF and with the right sign.
extends "res://test_case.gd"

const FORCE_N: float = 2.0
const MOMENT_NM: float = 0.05
const GRASP_TORQUE_NM: float = 0.025
## Beyond the bias that the node itself reports.
const RELATIVE_ERROR: float = 0.01
const NAMES: Array[String] = ["fx", "fy", "fz", "mx", "my", "mz", "grasp"]


func test_each_dof_is_felt_within_one_percent() -> void:
	var device: SpidarG = await _armed_device()
	for dof: int in 7:
		for sign: float in [1.0, -1.0]:
			var asked: PackedFloat64Array = _unit(dof, sign)
			_hold(device, asked, 1500)
			var truth: Dictionary = device.get_simulated_truth()
			var felt: PackedFloat64Array = truth["strings_wrench"]
			var bias: PackedFloat64Array = device.get_wrench_bias()
			var amount: float = absf(asked[dof])
			var error: float = felt[dof] - asked[dof] - bias[dof]
			print("INFO %s %+.3f: felt %+.5f, bias %+.5f, error %.3f %%" % [
				NAMES[dof], asked[dof], felt[dof], bias[dof], 100.0 * error / amount])
			check(absf(error) <= RELATIVE_ERROR * amount, "%s: asked %.4f, felt %.5f, bias %.5f" % [
				NAMES[dof], asked[dof], felt[dof], bias[dof]])
			# Nothing else is felt that was not asked for: compare in newtons at the pole ends (1/d = 25 1/m).
			for other: int in 7:
				if other != dof:
					var scale: float = 1.0 if other < 3 else 25.0
					var limit: float = RELATIVE_ERROR * amount * (1.0 if dof < 3 else 25.0)
					check(absf(felt[other] - bias[other]) * scale <= limit, "%s leaks into %s: %.6f" % [
						NAMES[dof], NAMES[other], felt[other]])


func test_power_is_wrench_times_twist_in_every_dof() -> void:
	var device: SpidarG = await _armed_device()
	# The hand is moved along each DOF against a held wrench: the work of the strings must be
	# wrench x displacement, with the displacement as the node reports it.
	var steps: Array[float] = [0.02, 0.02, 0.02, 0.2, 0.2, 0.2, 0.2]
	for dof: int in 7:
		var asked: PackedFloat64Array = _unit(dof, 1.0)
		_hold(device, asked, 1500)
		var start: PackedFloat64Array = _pose(device)
		var energy: float = device.get_simulated_truth()["energy_to_hand_j"]
		device.set_simulated_hand_target(_target(dof, steps[dof]), steps[6] if dof == 6 else 0.0)
		_hold(device, asked, 1500)
		var moved: float = _pose(device)[dof] - start[dof]
		var work: float = float(device.get_simulated_truth()["energy_to_hand_j"]) - energy
		print("INFO %s: work %.6f J, wrench x displacement %.6f J" % [NAMES[dof], work, asked[dof] * moved])
		check(moved > 0.5 * steps[dof], "%s: the hand moved %.4f" % [NAMES[dof], moved])
		check_near(work / (asked[dof] * moved), 1.0, 0.03, "%s: work against wrench x displacement" % NAMES[dof])
		device.set_simulated_hand_target(Transform3D.IDENTITY, 0.0)
		device.advance_cycles(1500)


func test_wrench_expires_when_it_is_not_renewed() -> void:
	var device: SpidarG = await _armed_device()
	_hold(device, _unit(1, 1.0), 500)
	check(device.get_requested_wrench()[1] > 1.9, "held while renewed")
	device.advance_cycles(400)
	check_near(device.get_requested_wrench()[1], 0.0, 1e-9, "gone 0.4 s after the last request")
	check(int(device.get_statistics()["expired_requests"]) > 0, "counted")


func test_no_tension_while_forces_are_off() -> void:
	var device: SpidarG = ideal_device()
	add(device)
	await physics_frames(1)
	device.request_wrench(Vector3(0, 2, 0), Vector3.ZERO, 0.0, 0.5)
	device.advance_cycles(300)
	for tension: float in device.get_string_tensions():
		check_equal(tension, 0.0, "tension with forces off")
	device.forces_enabled = true
	device.advance_cycles(100)
	check_equal(device.get_state(), SpidarG.STATE_ARMING, "the simulated device arms itself")
	device.advance_cycles(1500)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "armed after arming_time")
	device.disarm()
	device.advance_cycles(500)
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "disarmed")
	for tension: float in device.get_string_tensions():
		check_equal(tension, 0.0, "tension after disarm")


func test_huge_request_keeps_its_direction_and_tensions_their_limits() -> void:
	var device: SpidarG = await _armed_device()
	for _i: int in 20:
		device.request_wrench(Vector3(300, 400, 0), Vector3.ZERO, 0.0, 0.2)
		device.advance_cycles(50)
		for tension: float in device.get_string_tensions():
			check(tension >= 0.0 and tension <= 10.0, "tension within 0 to 10 N: %f" % tension)
	var asked: PackedFloat64Array = device.get_requested_wrench()
	check_near(asked[0] / asked[1], 0.75, 1e-6, "direction kept")
	check_near(sqrt(asked[0] ** 2 + asked[1] ** 2), 8.0, 1e-6, "clamped to max_force")


func _armed_device() -> SpidarG:
	var device: SpidarG = ideal_device()
	device.forces_enabled = true
	add(device)
	await physics_frames(1)
	device.advance_cycles(1600)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "armed")
	return device


func _hold(device: SpidarG, wrench: PackedFloat64Array, cycles: int) -> void:
	for _i: int in cycles / 50:
		device.request_wrench(Vector3(wrench[0], wrench[1], wrench[2]),
			Vector3(wrench[3], wrench[4], wrench[5]), wrench[6], 0.1)
		device.advance_cycles(50)


func _unit(dof: int, sign: float) -> PackedFloat64Array:
	var wrench := PackedFloat64Array([0, 0, 0, 0, 0, 0, 0])
	wrench[dof] = sign * (FORCE_N if dof < 3 else MOMENT_NM if dof < 6 else GRASP_TORQUE_NM)
	return wrench


func _target(dof: int, amount: float) -> Transform3D:
	var vector := Vector3.ZERO
	vector[dof % 3] = amount
	if dof < 3:
		return Transform3D(Basis.IDENTITY, vector)
	if dof < 6:
		return Transform3D(Basis(vector.normalized(), amount), Vector3.ZERO)
	return Transform3D.IDENTITY


func _pose(device: SpidarG) -> PackedFloat64Array:
	var grip: Transform3D = device.get_grip_transform()
	var turn: Quaternion = grip.basis.get_rotation_quaternion()
	var vector: Vector3 = turn.get_axis() * turn.get_angle() if turn.get_angle() > 1e-9 else Vector3.ZERO
	return PackedFloat64Array([grip.origin.x, grip.origin.y, grip.origin.z, vector.x, vector.y, vector.z,
		device.get_grasp_angle()])
