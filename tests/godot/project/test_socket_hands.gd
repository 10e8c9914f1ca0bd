## SpidarGSocket: two hands in one scene, chains that something comes to carry, balls, and stands that move.
extends "res://socket_scene.gd"

## Of two tall bodies that stand on each other, each in a hand of its own.
const TALL_M: float = 0.1
const APART_M: float = 0.04

var devices: Array[SpidarG] = []
var hands: Array[SpidarGHand] = []
var bodies: Array[RigidBody3D] = []
var sockets: Array[SpidarGSocket] = []


func test_two_hands_with_sockets_of_their_own_do_not_mix() -> void:
	await set_up_socket()
	await pick_up(0.03)
	await hover(0.0)
	check(plug.is_linked(), "linked in the first hand")
	# A second one a meter away, with the same keys.
	var first: Array = [device, hand, body, plug, cup, at, angle]
	body = add_box(Vector3(0.03, 0.04, 0.03), Vector3(1.0, -0.03, 0.0), 0.1)
	body.gravity_scale = 0.0
	plug = add_socket(body, Vector3(0.0, -0.021, 0.0), true)
	device = ideal_device()
	device.position = Vector3(1.0, 0.0, 0.0)
	device.forces_enabled = true
	hand = SpidarGHand.new()
	device.add_child(hand)
	add(device)
	at = Vector3(1.0, 0.03, 0.0)
	angle = 0.0
	await move_to(at, 0.0, ARMING_FRAMES)
	await grasp(body)
	check_equal(hand.get_held_body(), body, "the second hand holds its own body")
	var before: PackedFloat64Array = await mean_felt(20)
	var one: SpidarG = first[0]
	for part: int in 30:
		one.set_simulated_hand_target(Transform3D(Basis(), first[5] + Vector3(0.0, 0.008 * part / 29.0, 0.0)), first[6])
		await physics_frames(1)
	await physics_frames(30)
	check(first[3].is_linked() and first[3].get_mate() == first[4], "the first is still linked")
	check((one.get_simulated_truth()["strings_wrench"] as PackedFloat64Array)[1] < -0.5, "the first feels its spring")
	var after: PackedFloat64Array = await mean_felt(20)
	for dof: int in 3:
		check_near(after[dof], before[dof], 0.02, "the second feels nothing of it, axis %d, N" % dof)
	check(not plug.is_linked(), "nor is it linked")
	check(hand.get_held_body() == body and first[1].get_held_body() == first[2], "both hold their own")


func test_what_two_hands_bring_together_is_felt_by_both() -> void:
	await _set_up_two()
	check(hands[0].get_held_body() == bodies[0] and hands[1].get_held_body() == bodies[1], "each holds its own")
	var before: Array[float] = await _felt_by_both()
	await _bring(0.0084)
	check(not sockets[1].is_linked(), "not linked yet")
	var drawn: Array[float] = await _felt_by_both()
	check(drawn[1] - before[1] < -0.3, "the upper hand is drawn down: %f N" % (drawn[1] - before[1]))
	check_near(drawn[0] - before[0], before[1] - drawn[1], 0.06, "the lower one is drawn up as much, N")
	await _bring(0.0)
	check(sockets[1].is_linked() and sockets[1].get_mate() == sockets[0], "linked")
	await _bring(0.006)
	var pulled: Array[float] = await _felt_by_both()
	check(pulled[1] - before[1] < -0.3, "the upper hand feels the spring: %f N" % (pulled[1] - before[1]))
	check_near(pulled[0] - before[0], before[1] - pulled[1], 0.06, "the lower one as much the other way, N")
	await _bring(0.04)
	check(not sockets[1].is_linked(), "pulled apart again")
	var apart: Array[float] = await _felt_by_both()
	for lower: int in 2:
		check_near(apart[lower], before[lower], 0.06, "hand %d feels what it did before, N" % lower)


func test_of_two_hands_that_hold_a_chain_one_may_let_go() -> void:
	for leaves: int in 2:
		await _set_up_two()
		await _bring(0.0)
		check(sockets[1].is_linked(), "linked")
		for one: RigidBody3D in bodies:
			one.gravity_scale = 1.0
		for part: int in 30:
			_aim(leaves, SQUEEZE_ANGLE * (1.0 - part / 29.0))
			await physics_frames(1)
		await physics_frames(60)
		check(hands[leaves].get_held_body() == null, "hand %d has let go" % leaves)
		check_equal(hands[1 - leaves].get_held_body(), bodies[1 - leaves], "the other holds")
		check(sockets[1].is_linked(), "still linked")
		check_near(sockets[0].global_position.distance_to(sockets[1].global_position), 0.0, 0.001, "as linked, m")
		var both: float = 0.1 * GRAVITY
		check_near((await _felt_by_both())[1 - leaves], -both, 0.05, "the other feels both weights, N")
		clear()


func test_a_loose_mate_that_is_frozen_becomes_a_seat_and_back() -> void:
	await set_up_socket()
	var loose: RigidBody3D = add_free_box(Vector3(0.02, 0.02, 0.02), 0.08)
	loose.freeze = true
	loose.position = body.position + Vector3(0.0, 0.045, 0.0)
	var lower: SpidarGSocket = add_socket(body, Vector3(0.0, 0.03, 0.0), false, &"chain")
	var upper: SpidarGSocket = add_socket(loose, Vector3(0.0, -0.015, 0.0), true, &"chain")
	check(upper.link_to(lower), "linked")
	loose.freeze = false
	plug.enabled = false
	await pick_up(0.0)
	await move_to(Vector3.ZERO, SQUEEZE_ANGLE, 40)
	await physics_frames(60)
	check_near((await mean_felt(20))[1], -0.18 * GRAVITY, 0.05 * 0.18 * GRAVITY, "both weights, N")
	loose.freeze = true
	await physics_frames(30)
	await move_to(at - Vector3(0.0, 0.018, 0.0), SQUEEZE_ANGLE, 60)
	await physics_frames(30)
	var pulled: Vector3 = lower.global_position - hand.get_wanted_pose() * lower.position
	check(upper.is_linked() and pulled.y > 0.003, "the grip moves on alone, %f m" % pulled.y)
	check_near((await mean_felt(20))[1], 150.0 * pulled.y, 0.06, "at the spring of the seat, N")
	loose.freeze = false
	await move_to(Vector3.ZERO, SQUEEZE_ANGLE, 30)
	await physics_frames(60)
	check(upper.is_linked(), "linked all the time")
	check_near((await mean_felt(20))[1], -0.18 * GRAVITY, 0.05 * 0.18 * GRAVITY, "both weights again, N")


func test_a_ball_turns_with_the_hand_and_its_mate_meets_many() -> void:
	await set_up_socket()
	for socket: SpidarGSocket in [plug, cup]:
		socket.meets_many = true
		socket.turns_freely = true
	var other: StaticBody3D = add_box(Vector3(0.004, 0.004, 0.004), cup.global_position + Vector3(0.02, 0.0, 0.0), 0.0)
	var second: SpidarGSocket = add_socket(other, Vector3(-0.02, 0.0, 0.0), true)
	second.meets_many = true
	check(second.link_to(cup), "one mate is there already")
	plug.rotation.z = 0.5
	await pick_up(0.03)
	await hover(0.0)
	check(plug.is_linked(), "linked, whatever the turn")
	check_equal(plug.get_mates().size(), 1, "to one of those that meet there")
	check_equal(cup.get_mates().size() + second.get_mates().size(), 3, "with the other link as it was")
	var turned := Basis(Vector3.UP, 0.3)
	for part: int in 30:
		device.set_simulated_hand_target(Transform3D(Basis(Vector3.UP, 0.3 * part / 29.0), at), SQUEEZE_ANGLE)
		await physics_frames(1)
	await physics_frames(30)
	var turn: float = body.basis.get_rotation_quaternion().angle_to(turned.get_rotation_quaternion())
	check_near(turn, 0.0, 0.05, "the body turns with the hand, rad")
	check_near(distance(), 0.0, 0.0003, "about its ball, m")


func test_a_seat_on_a_moving_stand_carries_the_body_along() -> void:
	await set_up_socket()
	var lift := AnimatableBody3D.new()
	lift.sync_to_physics = false
	lift.position = cup.global_position
	add(lift)
	cup.reparent(lift)
	await pick_up(0.03)
	await hover(0.0)
	check(plug.is_linked(), "linked")
	for _i: int in 60:
		lift.position.x += 0.0001
		await physics_frames(1)
	await physics_frames(20)
	check(plug.is_linked() and distance() < 0.0005, "6 mm further, still in the seat: %f m off" % distance())
	check_near((await mean_felt(20))[0], 150.0 * (cup.global_position - hand.get_wanted_pose() * plug.position).x, 0.06,
		"the hand is drawn along, N")


func _set_up_two() -> void:
	at = Vector3.ZERO
	devices.clear()
	hands.clear()
	bodies.clear()
	sockets.clear()
	for upper: int in 2:
		var lone: SpidarG = ideal_device()
		lone.forces_enabled = true
		lone.position = Vector3(0.0, (TALL_M + APART_M) * upper, 0.0)
		var holder := SpidarGHand.new()
		holder.render_inertia = false
		lone.add_child(holder)
		add(lone)
		var tall: RigidBody3D = add_box(Vector3(0.03, TALL_M, 0.03), lone.position, 0.05) as RigidBody3D
		tall.gravity_scale = 0.0
		sockets.append(add_socket(tall, Vector3(0.0, (0.5 * TALL_M + 0.001) * (1.0 - 2.0 * upper), 0.0), upper == 1))
		sockets[upper].attraction_force = 0.4
		devices.append(lone)
		hands.append(holder)
		bodies.append(tall)
	for frame: int in ARMING_FRAMES:
		_aim(0, 0.0)
		_aim(1, 0.0)
		await physics_frames(1)
	for who: int in 2:  # The lower one first: it carries.
		for frame: int in 70:
			_aim(who, SQUEEZE_ANGLE * minf(frame / 40.0, 1.0))
			await physics_frames(1)


func _aim(who: int, to_angle: float) -> void:
	var lowered := Vector3(0.0, at.y if who == 1 else 0.0, 0.0)
	devices[who].set_simulated_hand_target(devices[who].transform.translated(lowered), to_angle)


## Lowers the upper hand until its plug, as it holds it, is `height` over the lower one's.
func _bring(height: float) -> void:
	for _i: int in 4:
		var plug_at: Vector3 = hands[1].get_wanted_pose() * sockets[1].position
		var cup_at: Vector3 = hands[0].get_wanted_pose() * sockets[0].position
		var off: float = cup_at.y + height - plug_at.y
		for part: int in 20:
			at.y += off / 20.0
			_aim(1, SQUEEZE_ANGLE)
			await physics_frames(1)
		await physics_frames(20)


## Mean vertical force on the lower hand and on the upper.
func _felt_by_both() -> Array[float]:
	var sum: Array[float] = [0.0, 0.0]
	for _i: int in 20:
		await physics_frames(1)
		for who: int in 2:
			sum[who] += (devices[who].get_simulated_truth()["strings_wrench"] as PackedFloat64Array)[1] / 20.0
	return sum


func test_a_long_body_is_drawn_and_rests_in_its_seat_without_a_tremble() -> void:
	for arm: float in [0.03, 0.1]:
		for freely: bool in [false, true]:
			await set_up_socket()
			plug.position.y = -arm
			plug.turns_freely = freely
			stand.position.y -= arm - 0.021
			plug.latch_distance = 0.0001
			await grasp(body)
			stand.position.y += 0.03
			await move_to(at + Vector3(0.0, 0.05, 0.0), SQUEEZE_ANGLE, 40)
			await hover(0.006)
			check(await tremble(60) < 0.0002, "arm %.2f m: drawn, the grip is still" % arm)
			plug.latch_distance = 0.003
			await hover(0.0)
			check(plug.is_linked(), "arm %.2f m: linked" % arm)
			await move_to(at + Vector3(0.004, 0.003, 0.0), SQUEEZE_ANGLE, 30)
			await physics_frames(60)
			check(await tremble(60) < 0.0002, "arm %.2f m: in its seat, the grip is still" % arm)
			var felt: PackedFloat64Array = await mean_felt(20)
			var place: Vector3 = hand.get_wanted_pose() * plug.position
			var force: Vector3 = 150.0 * (cup.global_position - place)
			var moment: Vector3 = (place - device.get_grip_transform().origin).cross(force)
			check_near(felt[0], force.x, 0.08, "arm %.2f m: force along x, N" % arm)
			if freely:
				check_near(felt[5], moment.z, 0.2 * absf(moment.z) + 0.002, "arm %.2f m: moment about z, N m" % arm)
			clear()
