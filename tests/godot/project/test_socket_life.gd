## SpidarGSocket: what scenes do with sockets, bodies and hands. Nothing dangles, nothing pulls on.
extends "res://socket_scene.gd"


func test_nothing_pulls_on_when_a_part_is_freed_in_its_seat() -> void:
	for way: String in ["stand", "cup", "plug", "body", "plug removed", "cup disabled", "unlink", "cup moved away"]:
		await set_up_socket()
		await pick_up(0.03)
		await hover(0.0)
		var told: Array[float] = []
		plug.unlinked.connect(func(_mate: SpidarGSocket, pull_n: float) -> void: told.append(pull_n))
		await move_to(at + Vector3(0.0, 0.008, 0.0), SQUEEZE_ANGLE, 30)
		check(plug.is_linked() and (await mean_felt(10))[1] < -0.5, "%s: the spring pulls" % way)
		match way:
			"stand":
				stand.queue_free()
			"cup":
				cup.free()
			"plug":
				plug.queue_free()
			"body":
				body.free()
			"plug removed":
				body.remove_child(plug)
			"cup disabled":
				cup.enabled = false
			"unlink":
				cup.unlink()
			"cup moved away":
				cup.reparent(device)
		await physics_frames(60)
		check_equal(told, [0.0] as Array[float], "%s: told once" % way)
		var weight: float = 0.0 if way == "body" else 0.1 * GRAVITY
		check_near((await mean_felt(20))[1], -weight, 0.05, "%s: only the weight is left, N" % way)
		if is_instance_valid(plug):
			check(not plug.is_linked(), "%s: the plug is free" % way)
		if is_instance_valid(cup):
			check(not cup.is_linked() and cup.get_mate() == null, "%s: the cup is free" % way)
		if way == "plug removed":
			plug.free()
		elif way != "body":
			check_near(body.global_position.distance_to(hand.get_wanted_pose().origin), 0.0, 0.001, "%s: follows, m" % way)
		clear()


func test_joints_take_over_when_the_hand_goes() -> void:
	for way: String in ["hand freed", "hand removed", "device freed", "hand disabled"]:
		await set_up_socket(true)
		await pick_up(0.03)
		await hover(0.0)
		check(plug.is_linked(), "%s: linked" % way)
		match way:
			"hand freed":
				hand.free()
			"hand removed":
				device.remove_child(hand)
			"device freed":
				device.free()
			"hand disabled":
				hand.release()
				hand.process_mode = Node.PROCESS_MODE_DISABLED
		await physics_frames(60)
		check(plug.is_linked(), "%s: still linked" % way)
		check_near(distance(), 0.0, 0.001, "%s: hangs in its seat, m" % way)
		if way == "hand removed":
			check_near((await mean_felt(20)).slice(0, 3)[1], 0.0, 0.05, "%s: nothing pulls, N" % way)
			device.add_child(hand)
			await let_go()
			await grasp(body)
			check_equal(hand.get_held_body(), body, "%s: grasps again" % way)
			check_equal(_helpers(hand), 1, "%s: with one helper" % way)
			await move_to(at - Vector3(0.0, 0.006, 0.0), SQUEEZE_ANGLE, 20)
			check((await mean_felt(10))[1] > 0.4, "%s: and feels the spring" % way)
		clear()


func test_nothing_pulls_in_a_paused_scene() -> void:
	await set_up_socket()
	await pick_up(0.03)
	await hover(0.0)
	await move_to(at + Vector3(0.0, 0.008, 0.0), SQUEEZE_ANGLE, 30)
	check((await mean_felt(10))[1] < -0.5, "the spring pulls")
	device.process_mode = Node.PROCESS_MODE_ALWAYS
	hand.process_mode = Node.PROCESS_MODE_PAUSABLE
	tree.paused = true
	await physics_frames(60)
	var felt: PackedFloat64Array = await mean_felt(20)
	tree.paused = false
	check_near(felt[1], 0.0, 0.05, "paused, N")
	await physics_frames(30)
	check(plug.is_linked() and (await mean_felt(10))[1] < -0.5, "on again")


func test_a_scene_that_ends_leaves_nothing() -> void:
	await set_up_socket()
	check_equal(_watchers(), 1, "the tree is watched for hands")
	await pick_up(0.03)
	await hover(0.0)
	check(plug.is_linked(), "linked")
	var scene := Node3D.new()
	add(scene)
	for node: Node in [body, device, stand]:
		node.reparent(scene)
	await physics_frames(5)
	scene.queue_free()
	await physics_frames(3)
	check_equal(_watchers(), 0, "nobody looks for hands any more")
	check_equal(tree.get_nodes_in_group(&"_spidar_g_sockets").size(), 0, "no socket is left")


func test_nothing_is_done_while_no_body_with_sockets_is_held() -> void:
	await set_up_socket()
	var plain: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1, 0.0, -0.06)
	await physics_frames(5)
	check_equal(_helpers(hand), 1, "a helper in the hand")
	check_equal(hand.carrying.get_connections().size(), 0, "empty hand: nobody listens each frame")
	await grasp(plain)
	check_equal(hand.get_held_body(), plain, "holds a body without sockets")
	check_equal(hand.carrying.get_connections().size(), 0, "body without sockets: nobody listens")
	await let_go()
	await move_to(at + Vector3(0.0, 0.06, 0.0), 0.0, 30)
	await grasp(body)
	check_equal(hand.carrying.get_connections().size(), 1, "body with a socket: one listens")
	await let_go()
	check_equal(hand.carrying.get_connections().size(), 0, "let go: nobody")


func test_bad_values_are_refused_with_a_text() -> void:
	var catcher: RefCounted = null
	if ClassDB.class_exists(&"Logger"):
		catcher = load("res://message_catcher.gd").new()
		OS.call(&"add_logger", catcher)
	var socket := SpidarGSocket.new()
	for case: Array in [["attraction_force", -1.0, "N"], ["capture_distance", 0.0, "m"], ["capture_angle", 4.0, "rad"],
			["latch_distance", -0.001, "m"], ["latch_angle", INF, "rad"], ["release_force", 0.0, "N"],
			["stiffness", -150.0, "N/m"]]:
		var good: float = socket.get(case[0])
		for bad: float in [case[1], NAN, 1e9]:
			if catcher != null:
				catcher.get("messages").clear()
			socket.set(case[0], bad)
			check_equal(socket.get(case[0]), good, "%s = %s: the old value stays" % [case[0], bad])
			var text: String = "\n".join(catcher.get("messages")) if catcher != null else "%s %s give" % [case[0], case[2]]
			check(text.contains(case[0]) and text.contains(" %s: give " % case[2]) or catcher == null, "told: " + text)
	socket.free()
	await set_up_socket()
	for case: Array in [[null, "another socket"], [plug, "another socket"], [SpidarGSocket.new(), "scene tree"]]:
		if catcher != null:
			catcher.get("messages").clear()
		check(not plug.link_to(case[0]), "not linked to %s" % [case[0]])
		if catcher != null:
			check("\n".join(catcher.get("messages")).contains(case[1]), "told: %s" % [catcher.get("messages")])
		if case[0] != null and case[0] != plug:
			(case[0] as Node).free()
	cup.key = &"other"
	check(not plug.link_to(cup), "not linked to what does not fit")
	check(not plug.is_linked() and not cup.is_linked(), "nothing changed")
	if catcher != null:
		OS.call(&"remove_logger", catcher)


func test_warnings_say_what_is_wrong_and_what_to_do() -> void:
	var socket := SpidarGSocket.new()
	check(_warnings(socket).contains("make it a direct child of a RigidBody3D"), "without a body: " + _warnings(socket))
	var carrier := RigidBody3D.new()
	carrier.add_child(socket)
	check_equal(_warnings(socket), "", "on a body, as made")
	socket.attraction_force = 3.0
	check(_warnings(socket).contains("1.35 N"), "a force that is not reached: " + _warnings(socket))
	socket.capture_distance = 0.03
	check_equal(_warnings(socket), "", "reached in a larger zone")
	socket.latch_distance = 0.04
	check(_warnings(socket).contains("latch_distance"), "a click outside of the zone: " + _warnings(socket))
	carrier.free()


func test_copies_are_not_linked() -> void:
	await set_up_socket(true)
	await pick_up(0.03)
	await hover(0.0)
	await let_go()
	check(plug.is_linked(), "linked")
	var copy: RigidBody3D = body.duplicate()
	copy.position.x += 0.2
	add(copy)
	await physics_frames(30)
	check(not (copy.get_node(^"plug") as SpidarGSocket).is_linked(), "the copy is not linked")
	check(copy.global_position.y < body.global_position.y - 0.02, "and falls")
	check(plug.is_linked(), "the first still is")


func test_collision_exceptions_end_with_the_link() -> void:
	await set_up_socket(true)
	check(plug.link_to(cup), "linked")
	check(body.get_collision_exceptions().has(stand), "linked bodies do not push each other")
	plug.unlink()
	check(body.get_collision_exceptions().is_empty(), "unlinked bodies do")
	body.add_collision_exception_with(stand)
	check(plug.link_to(cup), "linked")
	plug.unlink()
	check(body.get_collision_exceptions().has(stand), "the game's own exception stays")
	body.remove_collision_exception_with(stand)
	plug.meets_many = true
	cup.meets_many = true
	var more: SpidarGSocket = add_socket(body, Vector3(0.01, 0.021, 0.0), true)
	check(plug.link_to(cup) and more.link_to(cup), "linked twice")
	plug.unlink()
	check(body.get_collision_exceptions().has(stand), "one link is left, and with it the exception")
	more.unlink()
	check(body.get_collision_exceptions().is_empty(), "none is left")


func test_a_listener_may_free_the_body_or_let_go_in_the_middle() -> void:
	for way: String in ["body", "stand", "release", "unlink"]:
		await set_up_socket()
		await pick_up(0.03)
		var deeds: Dictionary[String, Callable] = {
			"body": body.free, "stand": stand.free, "release": hand.release, "unlink": cup.unlink
		}
		plug.linked.connect(func(_mate: SpidarGSocket) -> void: deeds[way].call())
		await hover(0.0)
		await physics_frames(30)
		match way:
			"body":
				check(not is_instance_valid(body) and not cup.is_linked(), "the cup is free")
			"stand":
				check(not plug.is_linked() and hand.get_held_body() == body, "still held")
			"release":
				check(plug.is_linked() and plug.get_mate() == cup, "linked by a joint")
			"unlink":
				check(not plug.is_linked() and hand.get_held_body() == body, "unlinked, and not linked again at once")
		clear()


func test_a_full_set_of_effects_leaves_the_pull_of_the_seat() -> void:
	await set_up_socket()
	await pick_up(0.03)
	for id: int in 6:
		device.set_viscous_effect(id, 0.1, 0.0, 0.0, 127, 60.0)
	await hover(0.0)
	check(plug.is_linked(), "linked")
	await move_to(at + Vector3(0.0, 0.008, 0.0), SQUEEZE_ANGLE, 30)
	await physics_frames(30)
	check_near((await mean_felt(20))[1], -150.0 * stretch(), 0.06, "the spring is felt, N")


func test_distances_are_those_of_the_device() -> void:
	scale = 2.0
	await set_up_socket()
	plug.attraction_force = 0.0
	await pick_up(0.03)
	await hover(0.0072)
	check(not plug.is_linked(), "not at 3.6 mm of the device")
	await hover(0.0052)
	await physics_frames(10)
	check(plug.is_linked(), "but at 2.6 mm")
	await move_to(at + Vector3(0.0, 0.008, 0.0), SQUEEZE_ANGLE, 30)
	await physics_frames(30)
	check_near((await mean_felt(20))[1], -150.0 * stretch() / 2.0, 0.06, "N per meter of the device")


func _warnings(socket: SpidarGSocket) -> String:
	return "\n".join(socket._get_configuration_warnings())


## Of the sockets: each hand watches, too, for joints.
func _watchers() -> int:
	return tree.node_added.get_connections().filter(func(connection: Dictionary) -> bool:
		return not (connection["callable"] as Callable).get_object() is SpidarGHand).size()


func _helpers(of: SpidarGHand) -> int:
	return of.get_children(true).filter(func(child: Node) -> bool: return child.is_in_group(&"_spidar_g_socket_hands")).size()
