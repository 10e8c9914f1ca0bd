## SpidarGHand: width, grasp, weight, release.
extends "res://hand_scene.gd"


func test_weight_is_felt_on_lift_and_gone_after_release() -> void:
	for mass: float in [0.05, 0.25]:
		at = Vector3.ZERO
		angle = 0.0
		await set_up(Vector3.ZERO)
		var empty: PackedFloat64Array = await mean_felt(30)
		var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), mass)
		await physics_frames(10)
		var told: Array[Vector3] = []
		hand.hold_changed.connect(
			func(weight: float, width: float, squeeze: float) -> void: told.append(Vector3(weight, width, squeeze)))
		await grasp(body)
		check_equal(hand.get_held_body(), body, "the box is held")
		check(told.size() > 0, "what is held is told")
		check_near(told.back().y, 0.03, 0.001, "its width")
		check_near(told.back().z, hand.get_squeeze_torque(), 0.003, "the squeeze on it")
		await move_to(at + Vector3(0.0, 0.06, 0.0), SQUEEZE_ANGLE, 60)
		await physics_frames(60)
		var lifted: float = body.global_position.y - (FLOOR_Y + 0.02)
		check(lifted > 0.03, "the box is off the floor: %f m" % lifted)
		var felt: PackedFloat64Array = await mean_felt(30)
		print("INFO mass %.2f kg: felt %.3f N, weight %.3f N" % [mass, felt[1] - empty[1], -mass * GRAVITY])
		check_near(felt[1] - empty[1], -mass * GRAVITY, 0.05 * mass * GRAVITY, "weight felt")
		check_near(hand.get_held_weight(), mass * GRAVITY, 0.001, "weight told")
		check_near(felt[0] - empty[0], 0.0, 0.03, "nothing sideways")
		await move_to(at, 0.0, 30)
		await physics_frames(40)
		check_equal(hand.get_held_body(), null, "opening lets go")
		check_equal(told.back(), Vector3.ZERO, "and that is told")
		check_equal(hand.get_held_weight(), 0.0, "nothing weighs")
		check_near(body.global_position.y, FLOOR_Y + 0.02, 0.002, "the box is back on the floor")
		var after: PackedFloat64Array = await mean_felt(30)
		check_near(after[1], empty[1], 0.02, "no weight after release")
		device.queue_free()
		body.queue_free()
		await physics_frames(2)


func test_the_stop_is_at_the_width_and_is_felt() -> void:
	await set_up(Vector3.ZERO)
	for width: float in [0.02, 0.05]:
		var body: RigidBody3D = add_free_box(Vector3(width, 0.04, 0.03), 0.1)
		await physics_frames(10)
		await grasp(body)
		var expected: float = device.get_grasp_angle_for_gap(width)
		check_near(hand.get_stop_angle(), expected, 0.01, "stop at the width's angle")
		check_near(hand.get_held_width(), width, 0.001, "held width")
		var felt: PackedFloat64Array = await mean_felt(20)
		check(felt[6] < -0.02, "the fingers are pushed open: %f N m" % felt[6])
		# The same width from what is felt alone: the stop is a spring from its angle on, at 60 % of what is allowed.
		var yielded: float = felt[6] / (0.6 * device.get_stiffness_limits().z)
		var felt_gap: float = 0.08 * (1.0 - (device.get_grasp_angle() + yielded) / deg_to_rad(50.0))
		print("INFO width %.3f m, from angle and torque %.4f m, torque %.3f N m" % [width, felt_gap, felt[6]])
		check_near(felt_gap, width, 0.003, "width from angle and torque")
		await move_to(at, 0.0, 20)
		await move_to(Vector3.ZERO, 0.0, 40)
		body.queue_free()
		await physics_frames(2)


func test_a_slippery_body_is_refused_with_the_reason() -> void:
	await set_up(Vector3.ZERO)
	var reasons: PackedStringArray = []
	hand.grasp_refused.connect(func(_body: RigidBody3D, reason: String) -> void: reasons.append(reason))
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.25)
	body.physics_material_override = PhysicsMaterial.new()
	body.physics_material_override.friction = 0.05
	await physics_frames(10)
	await grasp(body)
	check_equal(hand.get_held_body(), null, "not held")
	check_equal(reasons.size(), 1, "told once an attempt")
	check(reasons.size() > 0 and reasons[0].contains("friction 0.05"), "says why: %s" % reasons)
	await move_to(at + Vector3(0.0, 0.06, 0.0), SQUEEZE_ANGLE, 60)
	check_near(body.global_position.y, FLOOR_Y + 0.02, 0.003, "left on the floor")


func test_a_frozen_body_is_refused() -> void:
	await set_up(Vector3.ZERO)
	var reasons: PackedStringArray = []
	hand.grasp_refused.connect(func(_body: RigidBody3D, reason: String) -> void: reasons.append(reason))
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1)
	body.freeze = true
	await grasp(body)
	check_equal(hand.get_held_body(), null, "not held")
	check(reasons.size() == 1 and reasons[0].contains("frozen"), "says why: %s" % reasons)


func test_without_forces_a_body_can_still_be_grasped_but_is_not_felt() -> void:
	await set_up(Vector3.ZERO, false)
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1)
	await physics_frames(10)
	await grasp(body)
	check_equal(hand.get_held_body(), body, "held by closing alone")
	await move_to(at + Vector3(0.0, 0.05, 0.0), SQUEEZE_ANGLE, 60)
	check(body.global_position.y > FLOOR_Y + 0.05, "lifted")
	var felt: PackedFloat64Array = await mean_felt(10)
	check_near(felt[1], 0.0, 0.05, "no weight is felt")
	check_near(felt[6], 0.0, 0.005, "no width is felt")


## With no force to centre the grip, a mouse or a hand is a few millimetres beside what it closes on.
func test_without_forces_a_thin_body_is_grasped_off_centre() -> void:
	await set_up(Vector3.ZERO, false)
	var body: RigidBody3D = add_free_box(Vector3(0.003, 0.04, 0.05), 0.01, 0.004)
	await physics_frames(10)
	var beside: Vector3 = body.global_position - Vector3(0.004, 0.0, 0.0)
	await move_to(beside, 0.0, 60)
	await move_to(beside, SQUEEZE_ANGLE, 80)
	check_equal(hand.get_held_body(), body, "held, although beside the middle of the pads")
	await move_to(at + Vector3(0.0, 0.05, 0.0), SQUEEZE_ANGLE, 60)
	check(body.global_position.y > FLOOR_Y + 0.05, "lifted")
	check_near(body.global_position.x, device.get_grip_transform().origin.x, 0.001, "drawn between the pads")


## A match lies anywhere on the pads: no gap between the rays that look for it is wider than it is thick.
## A body of 8 g gives way to one finger. Fingers that close a little beside its middle must feel its width all the same.
func test_a_light_thin_body_is_felt_at_its_width_off_centre() -> void:
	await set_up(Vector3.ZERO)
	for off: float in [0.0, 0.0001, -0.00013, 0.00015]:
		var body: RigidBody3D = add_free_box(Vector3(0.003, 0.04, 0.03), 0.008)
		await physics_frames(10)
		await move_to(body.global_position + Vector3(off, 0.0, 0.0), 0.0, 60)
		await move_to(at, device.get_grasp_angle_for_gap(0.006), 40)
		await physics_frames(20)
		var begins: float = NAN
		for _i: int in 200:
			await move_to(at, angle + deg_to_rad(0.1), 1)
			if device.get_requested_wrench()[6] < -0.001:
				begins = device.get_grasp_angle()
				break
		var late_mm: float = 80.0 * (begins - device.get_grasp_angle_for_gap(0.003)) / deg_to_rad(50.0)
		print("INFO %.2f mm off centre: felt %.3f mm narrower than it is" % [1e3 * off, late_mm])
		check_near(late_mm, 0.0, 0.6, "width felt with %.2f mm off centre" % [1e3 * off])
		await move_to(at, 0.0, 30)
		await move_to(Vector3.ZERO, 0.0, 40)
		body.queue_free()
		await physics_frames(2)


func test_a_thin_stick_is_found_wherever_it_lies_on_the_pads() -> void:
	await set_up(Vector3.ZERO, false)
	for above_mm: int in range(-4, 5):
		var stick: RigidBody3D = add_free_box(Vector3(0.003, 0.003, 0.05), 0.01)
		stick.freeze = true
		stick.position.y = 0.0
		var there := Vector3(0.0, 0.001 * above_mm, 0.0)
		await move_to(there, 0.0, 20)
		await move_to(there, SQUEEZE_ANGLE, 60)
		check_near(
			hand.get_stop_angle(), device.get_grasp_angle_for_gap(0.003), 0.01,
			"the pads stop at it, %d mm above it" % above_mm
		)
		stick.free()


func test_a_held_body_that_is_freed_is_released() -> void:
	await set_up(Vector3.ZERO)
	var released: Array[int] = [0]
	hand.body_released.connect(func(_body: RigidBody3D) -> void: released[0] += 1)
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1)
	await physics_frames(10)
	await grasp(body)
	check_equal(hand.get_held_body(), body, "held")
	body.free()
	check_equal(hand.get_held_body(), null, "nothing is held")
	check_equal(released[0], 1, "released once")
	await physics_frames(40)
	var felt: PackedFloat64Array = await mean_felt(10)
	check_near(felt[1], 0.0, 0.05, "no weight left")


func test_the_hand_can_be_freed_while_it_holds() -> void:
	await set_up(Vector3.ZERO)
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1)
	await physics_frames(10)
	await grasp(body)
	check_equal(hand.get_held_body(), body, "held")
	await move_to(at + Vector3(0.0, 0.05, 0.0), SQUEEZE_ANGLE, 60)
	hand.free()
	await physics_frames(60)
	check_near(body.global_position.y, FLOOR_Y + 0.02, 0.003, "the body falls to the floor")
	check(body.can_sleep, "it may sleep again")
	var felt: PackedFloat64Array = await mean_felt(10)
	check_near(felt[1], 0.0, 0.05, "no force left behind")


func test_placing_a_held_body_takes_its_weight_off_the_hand() -> void:
	await set_up(Vector3.ZERO)
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.2)
	await physics_frames(10)
	await grasp(body)
	await move_to(at + Vector3(0.0, 0.05, 0.0), SQUEEZE_ANGLE, 60)
	# Lower the hand to 10 mm below where the box touches: the floor carries it and pushes back.
	await move_to(at - Vector3(0.0, 0.06, 0.0), SQUEEZE_ANGLE, 80)
	await physics_frames(40)
	var felt: PackedFloat64Array = await mean_felt(20)
	check(felt[1] > 0.3, "the floor is felt through the box: %f N" % felt[1])
	check_near(body.global_position.y, FLOOR_Y + 0.02, 0.002, "the box rests on the floor, not in it")
	check_equal(hand.get_held_body(), body, "still held")
