## SpidarGHand: conveyors and turning tables, bodies with constant velocities, drag the hand by friction and move no shape.
extends "res://hand_shapes_scene.gd"

const FRICTION: float = 0.4
const BELT := Vector3(0.1, 0.0, 0.0)
const SIZE := Vector3(0.4, 0.1, 0.4)
const DEPTH_M: float = 0.012


func test_a_conveyor_drags_with_mu_n_along_its_way() -> void:
	for kind: String in ["box", "trimesh", "height map", "boundary", "animated", "scaled"]:
		await _set_up(kind == "scaled")
		var body: StaticBody3D = _body(kind)
		add(body)
		var still: PackedFloat64Array = await _rest(Vector3.ZERO)
		check(still[1] > 1.5, "%s: the hand rests on it: %.2f N" % [kind, still[1]])
		check_near(still[0], 0.0, 0.02, "%s: nothing drags on what stands still" % kind)
		var shown: Vector3 = hand.get_proxy_transform().origin
		body.constant_linear_velocity = BELT * device.workspace_scale
		await _check_drag("%s" % kind, Vector3.RIGHT)
		body.constant_linear_velocity = Vector3(-0.06, 0.0, 0.08) * device.workspace_scale
		await _check_drag("%s, another way" % kind, Vector3(-0.6, 0.0, 0.8))
		# What would run into the hand or away from it is no motion along the surface.
		body.constant_linear_velocity = Vector3(0.1, 0.1, 0.0) * device.workspace_scale
		await _check_drag("%s, upwards too" % kind, Vector3.RIGHT)
		check_near(hand.get_proxy_transform().origin.y, shown.y, 1e-4 * device.workspace_scale, "%s: shown on it" % kind)
		body.constant_linear_velocity = Vector3.ZERO
		await physics_frames(10)
		await _lift()
		var again: PackedFloat64Array = await _rest(Vector3.ZERO)
		check_near(again[0], 0.0, 0.02, "%s: stopped" % kind)
		device.free()
		body.free()
		await physics_frames(2)
	check_equal(shakes, 0, "nothing shakes")
	check_shown_outside()


## Jolt turns it about the middle of its shapes, GodotPhysics about the body's origin: a loose box tells which way.
func test_a_turning_table_drags_across_the_way_to_its_axis() -> void:
	for aside: Vector3 in [Vector3.ZERO, Vector3(0.1, 0.0, 0.0)]:
		await _set_up()
		var body: StaticBody3D = Solids.static_body(
			Solids.box(SIZE), Transform3D(Basis.IDENTITY, aside - Vector3(0.0, 0.5 * SIZE.y, 0.0)))
		body.position.y = FLOOR_Y
		body.constant_angular_velocity = Vector3(0.0, 2.0, 0.0)
		add(body)
		var loose: RigidBody3D = add_box(Vector3.ONE * 0.02, Vector3(0.0, FLOOR_Y + 0.0101, 0.08), 0.1)
		loose.can_sleep = false
		await physics_frames(3)
		var due: Vector3 = Vector3(loose.linear_velocity.x, 0.0, loose.linear_velocity.z).normalized()
		loose.free()
		# Both pads alike about z = 80 mm: the closed grip is a point beside the axis.
		await go(Vector3(0.0, FLOOR_Y + PAD_RADIUS + 0.01, 0.08), 40, Basis.IDENTITY, 0.75)
		await _rest(Vector3(0.0, 0.0, 0.08))
		var felt: Vector3 = force_of(await mean_felt(20))
		var along := Vector3(felt.x, 0.0, felt.z)
		print("INFO turning table, shapes %s aside: %s N, due along %s" % [aside, felt, due])
		check(due.length() > 0.9, "the engine's box is dragged: %s" % due)
		check_near(along.length(), FRICTION * felt.y, 0.05 * FRICTION * felt.y, "mu N from a turning table")
		check(along.angle_to(due) < 0.1, "as the engine drags a box there: %s, %s" % [along, due])
		note_depth()
		device.free()
		body.free()
		await physics_frames(2)
	check_equal(shakes, 0, "nothing shakes")
	check_shown_outside()


func test_a_conveyor_that_is_carried_along_drags_by_its_belt_alone() -> void:
	await _set_up()
	var body: StaticBody3D = _body("animated")
	add(body)
	await _rest(Vector3.ZERO)
	# The belt runs back as fast as the body goes: its surface stands still in the room.
	body.constant_linear_velocity = -BELT
	for _i: int in 60:
		body.position += BELT / 60.0
		await physics_frames(1)
	var felt: Vector3 = Vector3.ZERO
	for _i: int in 20:
		body.position += BELT / 60.0
		felt += force_of(await mean_felt(1)) / 20.0
	print("INFO belt against its own motion: %s N" % felt)
	check(felt.y > 1.5, "it rests on it: %s" % felt)
	check(absf(felt.x) < 0.9 * FRICTION * felt.y, "and is not dragged to the end of the cone: %s" % felt)
	var before: Vector3 = felt
	body.constant_linear_velocity = Vector3.ZERO
	felt = Vector3.ZERO
	for i: int in 60:
		body.position += BELT / 60.0
		var now: Vector3 = force_of(await mean_felt(1))
		felt += now / 20.0 if i >= 40 else Vector3.ZERO
	check_near(felt.x, FRICTION * felt.y, 0.05 * FRICTION * felt.y, "without its belt the body drags, after %s" % before)
	check_shown_outside()


## A server that does not tell the state of what stands still, as Jolt's, drags by no body without a node.
func test_a_static_body_without_a_node_drags_where_the_server_tells() -> void:
	await _set_up()
	var node: Node3D = Solids.plate("server")
	node.position.y = FLOOR_Y
	add(node)
	var body: RID = node.get("body")
	PhysicsServer3D.body_set_state(body, PhysicsServer3D.BODY_STATE_LINEAR_VELOCITY, BELT)
	await physics_frames(2)
	var told: Vector3 = PhysicsServer3D.body_get_state(body, PhysicsServer3D.BODY_STATE_LINEAR_VELOCITY)
	await _rest(Vector3.ZERO)
	await physics_frames(60)
	var felt: Vector3 = force_of(await mean_felt(20))
	print("INFO server body: %s m/s are told, %s N" % [told, felt])
	var due: float = FRICTION * felt.y if told.is_equal_approx(BELT) else 0.0
	check_near(felt.x, due, 0.05 * FRICTION * felt.y, "dragged as the server says")
	check(told.is_equal_approx(BELT) or told.is_zero_approx(), "all or nothing is told: %s" % told)


func test_time_that_stands_still_stops_the_belt() -> void:
	await _set_up()
	var body: StaticBody3D = _body("box")
	add(body)
	PhysicsServer3D.space_set_active(hand.get_world_3d().space, false)
	body.constant_linear_velocity = BELT
	await _rest(Vector3.ZERO)
	await physics_frames(60)
	var felt: Vector3 = force_of(await mean_felt(20))
	PhysicsServer3D.space_set_active(hand.get_world_3d().space, true)
	check(felt.y > 1.5, "it rests: %s" % felt)
	check_near(felt.x, 0.0, 0.02, "the belt stands while physics does")


func _set_up(scaled: bool = false) -> void:
	at = Vector3.ZERO
	angle = 0.0
	await set_up_empty(FRICTION)
	if scaled:
		device.workspace_scale = 2.0
		await physics_frames(2)


func _body(kind: String) -> StaticBody3D:
	var down := Transform3D(Basis.IDENTITY, Vector3(0.0, -0.5 * SIZE.y, 0.0))
	var body: StaticBody3D
	match kind:
		"trimesh":
			body = Solids.plate("trimesh 25")
		"height map":
			body = Solids.height_map(0.02)
		"boundary":
			body = Solids.plate("boundary")
		"animated":
			body = AnimatableBody3D.new()
			(body as AnimatableBody3D).sync_to_physics = false
			Solids.add_shape(body, Solids.box(SIZE), down)
		_:
			down.origin *= device.workspace_scale
			body = Solids.static_body(Solids.box(SIZE * device.workspace_scale), down)
	body.position.y = FLOOR_Y * device.workspace_scale
	return body


## Presses DEPTH_M deep there (device metres): what is felt.
func _rest(above: Vector3) -> PackedFloat64Array:
	var scale: float = device.workspace_scale
	await go(scale * Vector3(above.x, FLOOR_Y + PAD_RADIUS + 0.01, above.z), 20, Basis.IDENTITY, angle)
	await until_felt()
	await go(scale * Vector3(above.x, FLOOR_Y + PAD_RADIUS - DEPTH_M, above.z), 40, Basis.IDENTITY, angle)
	await physics_frames(30)
	return await mean_felt(20)


func _lift() -> void:
	await go(at + Vector3(0.0, 0.03, 0.0) * device.workspace_scale, 30)


func _check_drag(name: String, along: Vector3) -> void:
	await physics_frames(60)
	note_depth()
	var felt: Vector3 = force_of(await mean_felt(20))
	var due: Vector3 = FRICTION * felt.y * along
	print("INFO %s: %s N, %s due" % [name, felt, due])
	check(felt.y > 1.5, "%s: it rests: %s" % [name, felt])
	check(Vector3(felt.x, 0.0, felt.z).distance_to(due) < 0.05 * due.length(), "%s: %s N, %s due" % [name, felt, due])
