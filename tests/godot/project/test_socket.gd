## SpidarGSocket: attraction, click, hold and release, felt by the simulated hand in newtons.
extends "res://socket_scene.gd"


func test_attraction_is_felt_as_set_within_the_capture_zone() -> void:
	for force: float in [0.4, 1.0]:
		await set_up_socket()
		plug.attraction_force = force
		await pick_up(0.03)
		plug.enabled = false
		await hover(0.0084)
		var without: PackedFloat64Array = await mean_felt(30)
		plug.enabled = true
		await hover(0.0084)  # The pull has moved the hand.
		var with: PackedFloat64Array = await mean_felt(30)
		check(not plug.is_linked(), "not linked from a distance of %.4f m" % distance())
		check_near(without[1] - with[1], force, 0.05 * force, "pull at %.4f m, N" % distance())
		clear()


func test_attraction_is_nothing_beyond_the_capture_distance_or_when_turned_or_of_another_key() -> void:
	await set_up_socket()
	await pick_up(0.03)
	for way: String in ["beyond", "turned", "key", "both plugs", "disabled mate"]:
		plug.enabled = false
		await hover(0.016 if way == "beyond" else 0.0084)
		var without: PackedFloat64Array = await mean_felt(20)
		plug.enabled = true
		match way:
			"turned":
				plug.rotation.y = deg_to_rad(20.0)
			"key":
				plug.key = &"other"
			"both plugs":
				cup.is_plug = true
			"disabled mate":
				cup.enabled = false
		await physics_frames(30)
		check_near((await mean_felt(20))[1], without[1], 0.02, "%s: no pull, N" % way)
		plug.rotation = Vector3.ZERO
		plug.key = &""
		cup.is_plug = false
		cup.enabled = true


func test_it_clicks_within_the_latch_distance_and_sits_exactly_in_its_seat() -> void:
	await set_up_socket()
	plug.attraction_force = 0.0
	await pick_up(0.03)
	await hover(0.006)
	check(not plug.is_linked(), "not yet at %.4f m" % distance())
	var told: Array[String] = []
	plug.linked.connect(func(mate: SpidarGSocket) -> void: told.append("plug %s" % (mate == cup)))
	cup.linked.connect(func(mate: SpidarGSocket) -> void: told.append("cup %s" % (mate == plug)))
	await hover(0.0025)
	await physics_frames(20)
	check(plug.is_linked() and plug.get_mate() == cup and cup.get_mate() == plug, "both linked")
	check_equal(told, ["plug true", "cup true"] as Array[String], "both told, once")
	check_near(distance(), 0.0, 0.0002, "off the seat, m")
	check_equal(hand.get_held_body(), body, "still in the hand")
	check_near((await mean_felt(20))[1], -150.0 * stretch(), 0.05, "the seat carries the weight; the rest is the spring, N")


func test_it_comes_off_at_the_release_force() -> void:
	for case: Array in [[2.25, 150.0], [3.0, 300.0], [1.0, 150.0]]:
		await set_up_socket()
		plug.release_force = case[0]
		plug.stiffness = case[1]
		await pick_up(0.03)
		await hover(0.0)
		check(plug.is_linked(), "in its seat")
		var off: Array[float] = []
		plug.unlinked.connect(func(_mate: SpidarGSocket, pull_n: float) -> void: off.append(pull_n))
		var most: float = 0.0
		for _i: int in 200:
			await move_to(at + Vector3(0.0, 0.0002, 0.0), SQUEEZE_ANGLE, 1)
			if not plug.is_linked():
				break
			var felt: PackedFloat64Array = device.get_simulated_truth()["strings_wrench"]
			most = maxf(most, -felt[1])
		check_equal(off.size(), 1, "came off, told once")
		check_near(most, case[0], 0.1 * case[0], "greatest pull felt, N")
		check_near(off[0], case[0], 0.1 * case[0], "pull as told, N")
		await physics_frames(60)
		check(not plug.is_linked(), "does not click again by itself")
		clear()


func test_a_link_holds_the_body_after_the_hand_has_opened() -> void:
	for below: bool in [false, true]:
		await set_up_socket(below)
		await pick_up(0.03)
		await hover(0.0)
		check(plug.is_linked(), "in its seat")
		await let_go()
		var place: Vector3 = body.global_position
		await physics_frames(120)
		check(hand.get_held_body() == null and plug.is_linked(), "let go and linked")
		check_near(body.global_position.distance_to(place), 0.0, 0.0005, "sinks, m")
		check_near(distance(), 0.0, 0.0005, "off the seat, m")
		plug.unlink()
		check(not plug.is_linked() and not cup.is_linked(), "both unlinked")
		await physics_frames(30)
		if below:
			check(body.global_position.y < place.y - 0.01, "unlinked, it falls: y = %f" % body.global_position.y)
		clear()


func test_a_link_is_pulled_off_by_a_second_grasp() -> void:
	await set_up_socket()
	await pick_up(0.03)
	await hover(0.0)
	await let_go()
	await grasp(body)
	check_equal(hand.get_held_body(), body, "grasped again")
	check(plug.is_linked(), "still linked")
	await move_to(at + Vector3(0.0, 0.01, 0.0), SQUEEZE_ANGLE, 40)
	await physics_frames(30)
	check(plug.is_linked(), "10 mm is not enough")
	check_near((await mean_felt(20))[1], -150.0 * stretch(), 0.06, "the spring is felt, N")
	check_near(distance(), 0.0, 0.0003, "and the body stays, m")
	await move_to(at + Vector3(0.0, 0.02, 0.0), SQUEEZE_ANGLE, 60)
	await physics_frames(30)
	check(not plug.is_linked(), "pulled off")
	check_near((await mean_felt(20))[1], -0.1 * GRAVITY, 0.05, "its own weight, N")


func test_what_hangs_on_the_held_body_is_felt_with_its_weight() -> void:
	await set_up_socket()
	var chain: Array[RigidBody3D] = [body]
	for number: int in 2:
		var next: RigidBody3D = add_free_box(Vector3(0.02, 0.02, 0.02), 0.06 + 0.03 * number)
		next.position = Vector3(0.0, body.position.y + 0.045 + 0.021 * number, 0.0)
		next.freeze = true
		chain.append(next)
		add_socket(chain[number], Vector3(0.0, 0.02 if number == 0 else 0.01, 0.0), false, &"chain")
		var upper: SpidarGSocket = add_socket(next, Vector3(0.0, -0.011, 0.0), true, &"chain")
		check(upper.link_to(chain[number].get_node(^"chain")), "linked by the game")
	for next: RigidBody3D in chain.slice(1):
		next.freeze = false
	await physics_frames(5)
	await pick_up(0.0)
	await move_to(Vector3.ZERO, SQUEEZE_ANGLE, 60)
	await physics_frames(60)
	var weight: float = (0.1 + 0.06 + 0.09) * GRAVITY
	check_near((await mean_felt(30))[1], -weight, 0.05 * weight, "weight of three bodies, N")
	(chain[2].get_node(^"chain plug") as SpidarGSocket).unlink()
	await physics_frames(60)
	weight = (0.1 + 0.06) * GRAVITY
	check_near((await mean_felt(30))[1], -weight, 0.05 * weight, "weight without the last, N")
	hand.render_weight = false
	await physics_frames(60)
	check_near((await mean_felt(30))[1], 0.0, 0.05, "no weight where none is rendered, N")


func test_a_loose_mate_is_drawn_and_then_carried() -> void:
	await set_up_socket()
	await pick_up(0.03)
	var loose: RigidBody3D = add_free_box(Vector3(0.05, 0.02, 0.05), 0.12, 0.0, -0.08)
	var seat: SpidarGSocket = add_socket(loose, Vector3(0.0, 0.012, 0.0), false, &"loose")
	plug.key = &"loose"
	await physics_frames(30)
	await move_to(seat.global_position - plug.position + Vector3(0.0, 0.03, 0.0), SQUEEZE_ANGLE, 60)
	await hover_over(seat, 0.0015)
	await physics_frames(10)
	check(plug.is_linked() and plug.get_mate() == seat, "linked to the loose body")
	await move_to(at + Vector3(0.0, 0.04, 0.0), SQUEEZE_ANGLE, 60)
	await physics_frames(60)
	check(loose.global_position.y > FLOOR_Y + 0.03, "lifted: y = %f" % loose.global_position.y)
	check_near((await mean_felt(30))[1], -0.22 * GRAVITY, 0.05 * 0.22 * GRAVITY, "weight of both, N")
	await let_go()
	await physics_frames(60)
	check(plug.is_linked(), "still linked when both have fallen")
