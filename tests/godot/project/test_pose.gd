## The pose that the node reports against the grip as it truly is in the plant, elasticity and friction off.
extends "res://test_case.gd"

const POSES: int = 500
## The quantisation limit measured for 0.0251 mm counts (rms over the workspace).
const POSITION_RMS_M: float = 0.012e-3
const ANGLE_RMS_DEG: float = 0.03
## The hand gets anywhere at 1 m/s, then settles.
const CYCLES_A_POSE: int = 700


func test_pose_is_at_the_quantisation_limit_over_the_workspace() -> void:
	var device: SpidarG = ideal_device()
	add(device)
	await physics_frames(1)
	var random := RandomNumberGenerator.new()
	random.seed = 20261122
	var position_sum: float = 0.0
	var pole_sum: float = 0.0
	var grasp_sum: float = 0.0
	var worst_m: float = 0.0
	for _i: int in POSES:
		device.set_simulated_hand_target(_random_pose(random), deg_to_rad(random.randf_range(-30.0, 30.0)))
		device.advance_cycles(CYCLES_A_POSE)
		var truth: Dictionary = device.get_simulated_truth()
		var true_grip: Transform3D = truth["grip_transform"]
		var grip: Transform3D = device.get_grip_transform()
		var error_m: float = grip.origin.distance_to(true_grip.origin)
		worst_m = maxf(worst_m, error_m)
		position_sum += error_m * error_m
		# The poles' directions, each against its own truth: worse of the two.
		var true_angle: float = truth["grasp_angle"]
		var angle: float = device.get_grasp_angle()
		var pole_error: float = 0.0
		for sign: float in [1.0, -1.0]:
			var measured: Vector3 = grip.basis * _pole(angle, sign)
			var expected: Vector3 = true_grip.basis * _pole(true_angle, sign)
			pole_error = maxf(pole_error, rad_to_deg(measured.angle_to(expected)))
		pole_sum += pole_error * pole_error
		grasp_sum += rad_to_deg(angle - true_angle) ** 2
	var position_rms: float = sqrt(position_sum / POSES)
	var pole_rms: float = sqrt(pole_sum / POSES)
	print("INFO position rms %.4f mm (worst %.4f), poles rms %.4f deg, grasp angle rms %.4f deg" % [
		1e3 * position_rms, 1e3 * worst_m, pole_rms, sqrt(grasp_sum / POSES)])
	check(position_rms <= POSITION_RMS_M, "position rms %.5f mm" % (1e3 * position_rms))
	check(pole_rms <= ANGLE_RMS_DEG, "pole direction rms %.5f deg" % pole_rms)
	# Both poles feed the grasp angle, so their errors add: sqrt(2) of one pole's.
	check(sqrt(grasp_sum / POSES) <= ANGLE_RMS_DEG * sqrt(2.0), "grasp angle rms")
	check(position_rms > 1e-7, "counts are quantised, so the error cannot be zero")


func test_rest_pose_is_the_identity() -> void:
	var device: SpidarG = ideal_device()
	add(device)
	await physics_frames(1)
	device.advance_cycles(200)
	var grip: Transform3D = device.get_grip_transform()
	check(grip.origin.length() < 5e-5, "the grip rests at the frame's centre: %s" % grip.origin)
	check(grip.basis.is_equal_approx(Basis.IDENTITY) or grip.basis.get_rotation_quaternion().get_angle() < 2e-3,
		"the grip rests unturned")
	check_near(device.get_grasp_angle(), 0.0, 2e-3, "the grip rests open")
	# At rest r1 = +Y and r2 = +X (pole 0, pole 1).
	check(device.get_pole_transform(0).basis.x.distance_to(Vector3.UP) < 2e-3, "pole 1 along +Y")
	check(device.get_pole_transform(1).basis.x.distance_to(Vector3.RIGHT) < 2e-3, "pole 2 along +X")
	check(device.get_pole_end(SpidarG.CONTACT_POLE1_MINUS).distance_to(Vector3(0, -0.04, 0)) < 1e-4,
		"pole 1 ends 4 cm from the centre")


func test_closing_hand_raises_grasp_angle_and_signals() -> void:
	var device: SpidarG = ideal_device()
	add(device)
	var events: Array[String] = []
	device.grasped.connect(func() -> void: events.append("grasped"))
	device.released.connect(func() -> void: events.append("released"))
	device.over_closed.connect(func() -> void: events.append("over_closed"))
	await physics_frames(1)
	for degrees: float in [30.0, 60.0, 30.0, 0.0]:
		device.set_simulated_hand_target(Transform3D.IDENTITY, deg_to_rad(degrees))
		device.advance_cycles(800)
		check_near(rad_to_deg(device.get_grasp_angle()), degrees, 0.2, "grasp angle")
	check_equal(events, ["grasped", "over_closed", "grasped", "released"], "phases in order")
	check_near(device.get_grasp_angle_for_gap(device.get_jaw_gap()), device.get_grasp_angle(), 1e-12,
		"jaw gap and its inverse")


func _random_pose(random: RandomNumberGenerator) -> Transform3D:
	var position := Vector3(random.randf_range(-0.15, 0.15), random.randf_range(-0.15, 0.15),
		random.randf_range(-0.15, 0.15))
	var limit: float = deg_to_rad(30.0)
	var turn := Basis.from_euler(Vector3(random.randf_range(-limit, limit),
		random.randf_range(-limit, limit), random.randf_range(-limit, limit)))
	return Transform3D(turn, position)


## Direction of pole 1 (sign +1) or 2 (-1) in the grip's x-y plane: 45 deg +- psi / 2, psi = 90 deg - grasp angle.
func _pole(grasp_angle: float, sign: float) -> Vector3:
	var angle: float = PI / 4.0 + sign * (PI / 2.0 - grasp_angle) / 2.0
	return Vector3(cos(angle), sin(angle), 0.0)
