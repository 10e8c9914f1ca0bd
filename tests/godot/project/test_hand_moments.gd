## SpidarGHand: what is pressed beside the grip's center turns the hand, as far as its lever is long.
extends "res://hand_shapes_scene.gd"

const SAME: float = 0.05
const TURN: float = deg_to_rad(25.0)
const BAR := Vector3(0.02, 0.02, 0.2)
## A square peg, and the clearance of its hole.
const PEG := Vector3(0.03, 0.08, 0.03)
const CLEARANCE_M: float = 0.001
const HOLE_DEPTH_M: float = 0.04


func test_a_held_bar_pressed_on_an_edge_turns_the_hand() -> void:
	for lever: float in [0.05, 0.075, -0.05, -0.075]:
		at = Vector3.ZERO
		angle = 0.0
		await set_up_empty()
		var bar: RigidBody3D = await _grasp(BAR, Vector3(0.0, -0.04, 0.0))
		var empty: PackedFloat64Array = await mean_felt(20)
		# Its near edge is `lever` out; its top 20 mm under the bar.
		var edge_y: float = bar.global_position.y - 0.5 * BAR.y - 0.02
		var side: float = signf(lever)
		add_box(Vector3(0.1, 0.04, 0.1), Vector3(0.0, edge_y - 0.02, lever + 0.05 * side), 0.0)
		await go(at - Vector3(0.0, 0.027, 0.0), 60, Basis.IDENTITY, SQUEEZE_ANGLE)
		await physics_frames(40)
		note_depth()
		check_equal(hand.get_held_body(), bar, "still held")
		var felt: PackedFloat64Array = await mean_felt(20)
		var force: Vector3 = force_of(felt) - force_of(empty)
		var moment: Vector3 = moment_of(felt) - moment_of(empty)
		var arm: Vector3 = Vector3(0.0, edge_y, lever) - device.get_grip_transform().origin
		var expected: float = arm.cross(force).x
		print("INFO edge at %.0f mm: %.3f N, %.4f N m, force times lever %.4f N m" % [1e3 * lever, force.y, moment.x, expected])
		check(force.y > 0.3, "the block is felt: %s N" % force)
		check(-side * expected > 0.015, "the lever is long enough to tell: %f N m" % expected)
		check_near(moment.x, expected, SAME * absf(expected), "moment of an edge at %f m" % lever)
		check_near(moment.z, 0.0, SAME * absf(expected), "none about the bar")
		_clear()
		await physics_frames(2)
	check_shown_outside()


## Open pads, 2 mm from a surface: the turn brings one of them into it.
func test_an_open_grip_is_not_turned_into_a_surface() -> void:
	var walls: Dictionary[Vector3, Vector3] = {Vector3.BACK: Vector3.UP, Vector3.FORWARD: Vector3.UP, Vector3.DOWN: Vector3.BACK}
	for toward: Vector3 in walls:
		var axis: Vector3 = walls[toward]
		at = Vector3.ZERO
		await set_up_empty()
		var wall: StaticBody3D = Solids.static_body(Solids.box(Vector3.ONE * 0.2))
		wall.position = toward * (PAD_RADIUS + 0.002 + 0.1)
		add(wall)
		for sign: float in [1.0, -1.0]:
			await go(Vector3.ZERO, 20)
			await go(Vector3.ZERO, 60, Basis(axis, sign * TURN))
			await physics_frames(40)
			note_depth()
			var felt: PackedFloat64Array = await mean_felt(20)
			var moment: float = moment_of(felt).dot(axis)
			# From the grip's center to the point of the scene that pushes.
			var arm := Vector3.ZERO
			var from_pad: float = INF
			for point: Dictionary in hand.get_touch_points():
				if (point["force"] as Vector3).length() > 0.01:
					arm = point["position"] - device.get_grip_transform().origin
					from_pad = hand.get_pad_position(0 if point["tool"] == "pad0" else 1).distance_to(point["position"])
			var expected: float = arm.cross(force_of(felt)).dot(axis)
			print("INFO turned about %s by %.0f degrees: %s N, %.4f N m, force times lever %.4f" % [axis, rad_to_deg(sign * TURN), force_of(felt), moment, expected])
			check(-sign * moment > 0.02, "the turn is resisted: %f N m" % moment)
			check_near(moment, expected, SAME * absf(expected), "moment of a pad in a wall")
			check(from_pad < PAD_RADIUS + 0.001, "at a pad: %f m from its middle" % from_pad)
			check(arm.cross(toward).length() > 0.02, "with a lever: %s" % arm)
		device.free()
		wall.free()
		await physics_frames(2)
	check_shown_outside()


func test_a_peg_in_a_hole_is_guided() -> void:
	await set_up_empty()
	var peg: RigidBody3D = await _grasp(PEG, Vector3(0.0, 0.02, 0.0))
	var top_y: float = -0.05
	_add_hole(top_y)
	var held_at: float = peg.global_position.y - device.get_grip_transform().origin.y
	var empty: PackedFloat64Array = await mean_felt(20)
	var inserted: float = 0.03
	var rest_y: float = top_y - inserted + 0.5 * PEG.y - held_at
	await go(Vector3(0.0, rest_y, 0.0), 90, Basis.IDENTITY, SQUEEZE_ANGLE)
	await physics_frames(30)
	check_near(peg.global_position.y - 0.5 * PEG.y, top_y - inserted, 0.003, "the peg slides in")
	var in_hole: PackedFloat64Array = await mean_felt(10)
	check_near(force_of(in_hole).y, force_of(empty).y, 0.1, "nothing stops it")
	for way: Vector3 in [Vector3.RIGHT, Vector3.LEFT, Vector3.BACK, Vector3.FORWARD]:
		await go(Vector3(0.0, rest_y, 0.0) + 0.008 * way, 40, Basis.IDENTITY, SQUEEZE_ANGLE)
		await physics_frames(30)
		var force: Vector3 = force_of(await mean_felt(10)) - force_of(empty)
		check(force.dot(way) < -0.3, "the hole's side pushes back, %s: %s N" % [way, force])
		check(absf(peg.global_position.dot(way)) < 0.004, "the peg stays in its hole: %s" % peg.global_position)
		await go(Vector3(0.0, rest_y, 0.0), 20, Basis.IDENTITY, SQUEEZE_ANGLE)
	# b cos t + d sin t = the width of the hole, for a peg of b that is d deep in it.
	var free: float = CLEARANCE_M / inserted
	for axis: Vector3 in [Vector3.RIGHT, Vector3.BACK]:
		for sign: float in [1.0, -1.0]:
			await go(Vector3(0.0, rest_y, 0.0), 40, Basis(axis, sign * deg_to_rad(12.0)), SQUEEZE_ANGLE)
			await physics_frames(30)
			var moment: Vector3 = moment_of(await mean_felt(10)) - moment_of(empty)
			var turned: float = peg.global_basis.get_rotation_quaternion().get_angle()
			print("INFO peg turned by 12 degrees about %s: %s N m, shown %.2f degrees" % [sign * axis, moment, rad_to_deg(turned)])
			check(moment.dot(axis) * sign < -0.02, "the hole turns it back: %s N m about %s" % [moment, axis])
			check(turned < 1.5 * free, "shown turned by %f rad, %f are free" % [turned, free])
			await go(Vector3(0.0, rest_y, 0.0), 30, Basis.IDENTITY, SQUEEZE_ANGLE)
	await go(Vector3(0.0, 0.03, 0.0), 60, Basis.IDENTITY, SQUEEZE_ANGLE)
	check(peg.global_position.y - 0.5 * PEG.y > top_y, "it comes out again")
	check_equal(hand.get_held_body(), peg, "still held")
	check_equal(shakes, 0, "nothing shakes")
	check_shown_outside()


## A free body in the jaws, `beside` the middle of what is grasped, held in the air.
func _grasp(size: Vector3, beside: Vector3) -> RigidBody3D:
	var body: RigidBody3D = add_box(size, Vector3(0.0, 0.0, 0.0), 0.05)
	body.gravity_scale = 0.0
	body.position.y = -0.5 * size.y + 0.01 if size.y > 0.04 else 0.0
	await go(Vector3.ZERO, 40, Basis.IDENTITY, SQUEEZE_ANGLE)
	await physics_frames(40)
	check_equal(hand.get_held_body(), body, "held")
	await go(Vector3(0.0, absf(beside.y), 0.0), 30, Basis.IDENTITY, SQUEEZE_ANGLE)
	await physics_frames(30)
	return body


func _add_hole(top_y: float) -> void:
	var wide: float = PEG.x + CLEARANCE_M
	for way: Vector3 in [Vector3.RIGHT, Vector3.LEFT, Vector3.BACK, Vector3.FORWARD]:
		var size: Vector3 = Vector3(0.12, HOLE_DEPTH_M, 0.04) if absf(way.z) > 0.5 else Vector3(0.04, HOLE_DEPTH_M, wide)
		var out: float = 0.5 * wide + 0.02
		add_box(size, Vector3(0.0, top_y - 0.5 * HOLE_DEPTH_M, 0.0) + out * way, 0.0)


func _clear() -> void:
	for node: Node in tree.root.get_children():
		if node is Node3D:
			node.queue_free()
