## SpidarGHand: how a held body follows, how it is lost, and that all of it scales and turns with the device.
extends "res://hand_scene.gd"


func test_a_held_body_follows_the_grip_without_slipping() -> void:
	await set_up(Vector3.ZERO)
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1)
	await physics_frames(10)
	await grasp(body)
	# Off the floor, which would hold the body back, and past the centring.
	await move_to(at + Vector3(0.0, 0.04, 0.0), SQUEEZE_ANGLE, 30)
	await physics_frames(30)
	var before: Transform3D = _in_grip(body)
	await move_to(Vector3(0.05, 0.03, -0.04), SQUEEZE_ANGLE, 40)
	var tilt := Basis(Vector3(1.0, 2.0, -1.0).normalized(), 0.4)
	device.set_simulated_hand_target(Transform3D(tilt, at), SQUEEZE_ANGLE)
	await physics_frames(60)
	var after: Transform3D = _in_grip(body)
	check(device.get_grip_transform().basis.is_equal_approx(Basis.IDENTITY) == false, "the grip turned")
	check_near(after.origin.distance_to(before.origin), 0.0, 0.0005, "slip, m")
	var turn: float = (after.basis * before.basis.inverse()).get_rotation_quaternion().get_angle()
	check_near(turn, 0.0, 0.01, "turn in the pads, rad")


func test_a_body_off_centre_pulls_with_its_lever() -> void:
	await set_up(Vector3.ZERO)
	# Long along z and held 40 mm from its middle.
	var body: RigidBody3D = add_free_box(Vector3(0.02, 0.03, 0.14), 0.06, 0.0, 0.04)
	await physics_frames(10)
	await move_to(Vector3(0.0, body.global_position.y, 0.0), 0.0, 60)
	await move_to(at, SQUEEZE_ANGLE, 40)
	await physics_frames(40)
	check_equal(hand.get_held_body(), body, "held near its end")
	await move_to(at + Vector3(0.0, 0.07, 0.0), SQUEEZE_ANGLE, 60)
	await physics_frames(60)
	var felt: PackedFloat64Array = await mean_felt(20)
	var arm: Vector3 = body.global_position - device.get_grip_transform().origin
	var expected: Vector3 = arm.cross(Vector3(0.0, -0.06 * GRAVITY, 0.0))
	print("INFO moment felt %.4f N m, weight times arm %.4f N m" % [felt[3], expected.x])
	check(expected.x > 0.015, "the arm is long enough to tell: %f" % expected.x)
	check_near(felt[3], expected.x, 0.15 * expected.x, "moment about x")


func test_inertia_opposes_the_start_and_the_stop_of_a_motion() -> void:
	for with_inertia: bool in [true, false]:
		at = Vector3.ZERO
		angle = 0.0
		await set_up(Vector3.ZERO)
		hand.render_inertia = with_inertia
		var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.2)
		await physics_frames(10)
		await grasp(body)
		await move_to(at + Vector3(0.0, 0.06, 0.0), SQUEEZE_ANGLE, 40)
		await physics_frames(40)
		var start: float = 0.0
		var stop: float = 0.0
		for i: int in 60:
			# Half a second there, at constant acceleration and deceleration.
			var part: float = minf(i / 30.0, 1.0)
			var x: float = 2.0 * part * part if part < 0.5 else 1.0 - 2.0 * (1.0 - part) * (1.0 - part)
			var target := Transform3D(Basis.IDENTITY, at + Vector3(0.1 * x, 0.0, 0.0))
			device.set_simulated_hand_target(target, SQUEEZE_ANGLE)
			await physics_frames(1)
			start = minf(start, device.get_requested_wrench()[0])
			stop = maxf(stop, device.get_requested_wrench()[0])
		print("INFO inertia %s: %.3f N at the start, %.3f N at the stop" % [with_inertia, start, stop])
		if with_inertia:
			# 0.1 m in 0.5 s is 1.6 m/s^2: 0.08 N for the 0.05 kg that is rendered.
			check(start < -0.04 and start > -0.4, "pulls back at the start: %f N" % start)
			check(stop > 0.04 and stop < 0.4, "pulls on at the stop: %f N" % stop)
		else:
			check(start > -0.02 and stop < 0.02, "switched off: %f, %f N" % [start, stop])
		device.queue_free()
		body.queue_free()
		await physics_frames(2)


func test_pressing_too_hard_tears_the_body_off() -> void:
	await set_up(Vector3.ZERO)
	hand.break_force = 1.5
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1)
	await physics_frames(10)
	await grasp(body)
	check_equal(hand.get_held_body(), body, "held")
	await move_to(at - Vector3(0.0, 0.005, 0.0), SQUEEZE_ANGLE, 20)
	check_equal(hand.get_held_body(), body, "a light push is borne")
	var released: Array[int] = [0]
	hand.body_released.connect(func(_body: RigidBody3D) -> void: released[0] += 1)
	await move_to(at - Vector3(0.0, 0.03, 0.0), SQUEEZE_ANGLE, 30)
	await physics_frames(10)
	check(released[0] >= 1, "a push above break_force tears it off")


func test_a_soft_body_yields_more() -> void:
	var squeezed: PackedFloat64Array = []
	for soft: bool in [false, true]:
		at = Vector3.ZERO
		angle = 0.0
		await set_up(Vector3.ZERO)
		var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.05)
		if soft:
			body.set_meta(&"spidar_squeeze_nm_rad", 0.05)
		await physics_frames(10)
		await grasp(body)
		check_equal(hand.get_held_body(), body, "held")
		squeezed.append(device.get_grasp_angle() - hand.get_stop_angle())
		device.queue_free()
		body.queue_free()
		await physics_frames(2)
	check(squeezed[1] > 1.5 * squeezed[0], "pressed in by %f and %f rad" % [squeezed[0], squeezed[1]])


func test_a_scene_ten_times_larger_works_the_same() -> void:
	const SCALE: float = 10.0
	device = ideal_device()
	device.forces_enabled = true
	device.workspace_scale = SCALE
	hand = SpidarGHand.new()
	device.add_child(hand)
	add(device)
	add_box(Vector3(10.0, 1.0, 10.0), Vector3(0.0, SCALE * FLOOR_Y - 0.5, 0.0), 0.0)
	var body := add_box(
		Vector3(0.3, 0.4, 0.3), Vector3(0.0, SCALE * FLOOR_Y + 0.201, 0.0), 0.15
	) as RigidBody3D
	await move_to(Vector3.ZERO, 0.0, ARMING_FRAMES + 10)
	await grasp(body)
	check_equal(hand.get_held_body(), body, "held")
	check_near(hand.get_stop_angle(), device.get_grasp_angle_for_gap(0.03), 0.01, "width in device metres")
	await move_to(at + Vector3(0.0, 0.6, 0.0), SQUEEZE_ANGLE, 90)
	await physics_frames(60)
	check(body.global_position.y > SCALE * FLOOR_Y + 0.5, "lifted: %f m" % body.global_position.y)
	var felt: PackedFloat64Array = await mean_felt(20)
	check_near(felt[1], -0.15 * GRAVITY, 0.1, "the weight is not scaled")


func test_a_turned_and_moved_device_works_the_same() -> void:
	device = ideal_device()
	device.forces_enabled = true
	var turn := Basis(Vector3.UP, PI / 3.0)
	device.transform = Transform3D(turn, Vector3(2.0, 0.0, -1.0))
	hand = SpidarGHand.new()
	device.add_child(hand)
	add(device)
	add_box(Vector3(8.0, 0.1, 8.0), Vector3(0.0, FLOOR_Y - 0.05, 0.0), 0.0)
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.15, 2.0, -1.0)
	body.basis = turn
	for i: int in 220:
		var height: float = lerpf(0.0, FLOOR_Y + 0.02, clampf((i - 80) / 40.0, 0.0, 1.0))
		var closed: float = SQUEEZE_ANGLE * clampf((i - 130) / 40.0, 0.0, 1.0)
		device.set_simulated_hand_target(Transform3D(turn, Vector3(2.0, height, -1.0)), closed)
		await physics_frames(1)
	check_equal(hand.get_held_body(), body, "held")
	# Far from the world's origin the joint's anchor once swept in from there and threw the body.
	check_near(body.global_position.x, 2.0, 0.002, "caught where it stood")
	check_near(hand.get_held_width(), 0.03, 0.001, "width across the turned faces")
	device.set_simulated_hand_target(Transform3D(turn, Vector3(2.0, 0.0, -1.0)), SQUEEZE_ANGLE)
	await physics_frames(90)
	var felt: PackedFloat64Array = await mean_felt(20)
	check_near(felt[1], -0.15 * GRAVITY, 0.1, "weight along the world's down")
	check_near(felt[0], 0.0, 0.05, "nothing along x")
	check_near(felt[2], 0.0, 0.05, "nothing along z")


func _in_grip(body: RigidBody3D) -> Transform3D:
	return device.get_grip_transform().affine_inverse() * body.global_transform
