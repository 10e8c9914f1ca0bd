## SpidarGHand: what a game adds to a held body's pull, and bodies that sit in a seat of their own.
extends "res://hand_scene.gd"


func test_an_added_load_is_felt_with_the_weight() -> void:
	await set_up(Vector3.ZERO)
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1)
	await physics_frames(10)
	await grasp(body)
	await move_to(at + Vector3(0.0, 0.07, 0.0), SQUEEZE_ANGLE, 60)
	await physics_frames(60)
	var without: PackedFloat64Array = await mean_felt(20)
	var pull := Vector3(0.5, 0.0, -0.8)
	var load := func(_delta: float) -> void: hand.add_load(pull)
	hand.carrying.connect(load)
	await physics_frames(60)
	var with: PackedFloat64Array = await mean_felt(20)
	hand.carrying.disconnect(load)
	for axis: int in 3:
		check_near(with[axis] - without[axis], pull[axis], 0.05, "force added on axis %d, N" % axis)
	await physics_frames(60)
	var after: PackedFloat64Array = await mean_felt(20)
	check_near(after[0] - without[0], 0.0, 0.05, "gone with the call, N")
	var bad := func(_delta: float) -> void: hand.add_load(Vector3(NAN, 0.0, 0.0))
	hand.carrying.connect(bad)
	await physics_frames(10)
	check(is_finite(device.get_requested_wrench()[0]), "a load that is not a number is left out")


func test_a_detained_body_stays_in_its_seat() -> void:
	await set_up(Vector3.ZERO)
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1)
	await physics_frames(10)
	await grasp(body)
	await move_to(at + Vector3(0.0, 0.07, 0.0), SQUEEZE_ANGLE, 60)
	await physics_frames(60)
	var seat: Transform3D = body.global_transform
	var stay := func(_delta: float) -> void: hand.detain(seat)
	hand.carrying.connect(stay)
	await move_to(at + Vector3(0.01, 0.0, 0.01), SQUEEZE_ANGLE, 30)
	await physics_frames(60)
	check_equal(hand.get_held_body(), body, "held")
	check_near(body.global_position.distance_to(seat.origin), 0.0, 0.0002, "out of the seat, m")
	check_near((await mean_felt(20))[1], 0.0, 0.05, "the seat carries the weight, N")
	check_near(
		hand.get_wanted_pose().origin.distance_to(seat.origin), 0.0141, 0.001, "the grip went on, m"
	)
	hand.carrying.disconnect(stay)
	await physics_frames(30)
	check_near(
		body.global_position.distance_to(hand.get_wanted_pose().origin), 0.0, 0.0005, "back in the hand, m"
	)
