## SpidarGHand: the shapes near the tool are felt as they stand.
extends "res://hand_scene.gd"

const PAD_RADIUS: float = 0.012


func test_the_floor_stops_the_tool() -> void:
	await set_up(Vector3.ZERO)
	var depth: float = 0.03
	var touch: float = FLOOR_Y + PAD_RADIUS
	await move_to(Vector3(0.0, touch - depth, 0.0), 0.0, 90)
	await physics_frames(40)
	var felt: PackedFloat64Array = await mean_felt(20)
	var height: float = device.get_grip_transform().origin.y
	# The felt force is the tool's spring from the height at which the pads touch: automatic, 60 % of what is allowed.
	print("INFO pads sink %.2f mm, felt %.3f N" % [1e3 * (touch - height), felt[1]])
	check_near(felt[1], 0.6 * device.get_stiffness_limits().x * (touch - height), 0.4, "force from the floor")
	check_near(hand.get_proxy_transform().origin.y, touch, 0.0002, "the tool is shown on the floor, not in it")
	check(height > touch - 0.7 * depth, "the floor holds the hand up: %f" % height)
	check_near(felt[0], 0.0, 0.1, "nothing sideways")


func test_surfaces_are_published_before_contact_and_ids_stay() -> void:
	await set_up(Vector3.ZERO)
	check_equal(hand.get_shapes_in_reach().size(), 0, "nothing near: nothing is published")
	var above: float = FLOOR_Y + PAD_RADIUS + 0.02
	await move_to(Vector3(0.0, above, 0.0), 0.0, 60)
	await physics_frames(20)
	check_equal(hand.get_shapes_in_reach().size(), 1, "the floor is, not touching yet")
	check_equal(touched().size(), 0, "20 mm above does not touch")
	var id: int = hand.get_shapes_in_reach()[0]["id"]
	await move_to(Vector3(0.05, above - 0.03, 0.03), 0.0, 60)
	await physics_frames(10)
	check_equal(hand.get_shapes_in_reach()[0]["id"], id, "the same floor keeps its id")
	check(touched().has(id), "and touches now")


func test_a_wall_and_the_floor_are_felt_together() -> void:
	await set_up(Vector3.ZERO)
	add_box(Vector3(0.1, 0.4, 0.4), Vector3(0.15, 0.0, 0.0), 0.0)
	# Pads reach 52 mm from the centre when open; the wall's face is at 100 mm.
	await move_to(Vector3(0.06, FLOOR_Y + PAD_RADIUS - 0.01, 0.0), 0.0, 90)
	await physics_frames(40)
	var felt: PackedFloat64Array = await mean_felt(20)
	check(felt[0] < -0.5, "the wall pushes back: %f N" % felt[0])
	check(felt[1] > 0.5, "the floor pushes up: %f N" % felt[1])
	check_equal(touched().size(), 2, "both are touched")


func test_a_body_outside_the_mask_is_not_felt() -> void:
	await set_up(Vector3.ZERO)
	hand.collision_mask = 2
	await move_to(Vector3(0.0, FLOOR_Y - 0.01, 0.0), 0.0, 60)
	await physics_frames(20)
	check_equal(hand.get_shapes_in_reach().size(), 0, "nothing is published")
	var felt: PackedFloat64Array = await mean_felt(10)
	check_near(felt[1], 0.0, 0.05, "no force")


func test_the_tool_pushes_a_free_body_and_feels_it() -> void:
	await set_up(Vector3(-0.05, FLOOR_Y + 0.03, 0.0))
	# Outside the jaws: the right pad meets it, 46 mm from the centre. One finger alone gives way at 2 N: it slides easily.
	var body: RigidBody3D = add_free_box(Vector3(0.04, 0.05, 0.06), 0.2, 0.045)
	body.physics_material_override = PhysicsMaterial.new()
	body.physics_material_override.friction = 0.3
	await physics_frames(10)
	var start: float = body.global_position.x
	await move_to(Vector3(0.03, FLOOR_Y + 0.03, 0.0), 0.0, 120)
	check(body.global_position.x > start + 0.03, "pushed: %f m" % (body.global_position.x - start))
	check(body.global_position.x < start + 0.15, "not thrown: %f m" % (body.global_position.x - start))
	check(absf(body.global_position.z) < 0.02, "along the push")


func test_a_box_between_the_pads_is_centred_without_a_jump() -> void:
	await set_up(Vector3.ZERO)
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1, 0.008)
	# The pad that meets it first pushes it at half its height: on a rougher floor it would tip, not slide.
	body.physics_material_override = PhysicsMaterial.new()
	body.physics_material_override.friction = 0.5
	await physics_frames(10)
	await move_to(Vector3(0.0, body.global_position.y, 0.0), 0.0, 60)
	await move_to(at, SQUEEZE_ANGLE, 60)
	await physics_frames(40)
	check_equal(hand.get_held_body(), body, "held")
	var along: float = (device.get_grip_transform().affine_inverse() * body.global_position).x
	check_near(along, 0.0, 0.0015, "the pads close on its middle")
	check(body.linear_velocity.length() < 0.05, "it rests: %s" % body.linear_velocity)


func test_everything_scales_with_the_workspace() -> void:
	await set_up(Vector3.ZERO)
	device.workspace_scale = 2.0
	await physics_frames(2)
	check_near(hand.get_pad_radius(), 2.0 * PAD_RADIUS, 1e-9, "pad radius")
	var gap: float = hand.get_pad_position(0).distance_to(hand.get_pad_position(1))
	check_near(gap, 0.16, 0.002, "open jaws")


func test_a_hand_without_a_device_warns_and_does_nothing() -> void:
	var lonely := SpidarGHand.new()
	add(lonely)
	await physics_frames(3)
	check(lonely.get_held_body() == null, "holds nothing")
	check(not lonely.is_physics_processing(), "does not run")
	var warnings: PackedStringArray = lonely.get_warnings()
	check(warnings.size() > 0 and warnings[0].contains("SpidarG"), "says what to do: %s" % warnings)


func test_passing_an_edge_at_a_distance_touches_nothing() -> void:
	elastic = true
	await set_up(Vector3(-0.1, 0.02, 0.0))
	# Its top is 18 mm under the pads, and its edge lies across the way.
	add_box(Vector3(0.06, 0.06, 0.3), Vector3(0.02, 0.02 - 0.012 - 0.018 - 0.03, 0.0), 0.0)
	await physics_frames(2)
	var touches: int = 0
	var most: float = 0.0
	for i: int in 30:  # 0.2 m in half a second
		await move_to(Vector3(-0.1 + 0.2 * (i + 1) / 30.0, 0.02, 0.0), 0.0, 1)
		touches += touched().size()
		var asked: PackedFloat64Array = device.get_requested_wrench()
		most = maxf(most, Vector3(asked[0], asked[1], asked[2]).length())
	print("INFO passing an edge at 18 mm: %d touches, %.3f N" % [touches, most])
	check_equal(touches, 0, "nothing is touched")
	check_near(most, 0.0, 1e-6, "no force is asked for")


func test_a_body_that_is_freed_while_it_is_pressed_is_forgotten() -> void:
	await set_up(Vector3.ZERO)
	var body: RigidBody3D = add_free_box(Vector3(0.2, 0.03, 0.2), 0.5)
	await physics_frames(10)
	await move_to(Vector3(0.0, FLOOR_Y + 0.03 + PAD_RADIUS - 0.01, 0.0), 0.0, 60)
	check((await mean_felt(5))[1] > 0.5, "pressed")
	var catcher: RefCounted = null
	if ClassDB.class_exists(&"Logger"):
		catcher = load("res://message_catcher.gd").new()
		OS.call(&"add_logger", catcher)
	body.free()
	await physics_frames(40)
	check_near((await mean_felt(5))[1], 0.0, 0.3, "nothing is left of it")
	if catcher != null:
		OS.call(&"remove_logger", catcher)
		check_equal(catcher.get("messages"), PackedStringArray(), "no error of the engine")
