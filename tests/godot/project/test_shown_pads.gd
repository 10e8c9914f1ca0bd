## Pads are shown on the surface of what they meet, never inside, however they meet it.
extends "res://hand_scene.gd"

const PadShape := preload("res://addons/spidar_g/nodes/pad_shape.gd")
const ShownPads := preload("res://addons/spidar_g/nodes/shown_pads.gd")
const View := preload("res://addons/spidar_g/nodes/spidar_g_view.gd")

## What the engine's own collision tolerance leaves, m.
const CLEAR_M: float = 0.0001
const TURN: float = deg_to_rad(4.0)

var _pad: PadShape = PadShape.new()
var _pads: ShownPads = ShownPads.new()


## The deepest that the shape of a pad stands inside anything.
func depth(space: PhysicsDirectSpaceState3D, pad_at: Transform3D) -> float:
	var deepest: float = 0.0
	for plane in _pads.overlaps(space, _pad.shape_for(1.0), pad_at):
		deepest = maxf(deepest, -plane.separation_m)
	return deepest


func test_a_pad_askew_on_a_face_is_moved_out_by_its_rim() -> void:
	var box: PhysicsBody3D = add_box(Vector3(0.04, 0.06, 0.06), Vector3.ZERO, 0.0)
	await physics_frames(2)
	var space: PhysicsDirectSpaceState3D = box.get_world_3d().direct_space_state
	# The middle of the pad's flat face lies on the box's face, turned by 4 degrees.
	var on_face := Transform3D(Basis(Vector3.UP, TURN), Vector3(0.02, 0.0, 0.0))
	var rim: float = PadShape.RADIUS_M * sin(TURN)
	check_near(depth(space, on_face), rim, CLEAR_M, "the rim's depth")
	var shown: Transform3D = _pads.place(space, _pad.shape_for(1.0), on_face, PadShape.RADIUS_M)
	check(depth(space, shown) <= CLEAR_M, "shown %.3f mm inside" % [1e3 * depth(space, shown)])
	check_near(shown.origin.x - on_face.origin.x, rim, 2.0 * CLEAR_M, "moved by as much as it was in")
	check_equal(shown.basis, on_face.basis, "and not turned")
	var beside: Transform3D = on_face.translated(Vector3(0.002, 0.0, 0.0))
	check_equal(_pads.place(space, _pad.shape_for(1.0), beside, PadShape.RADIUS_M), beside, "free: as it is")
	var passes_through := Transform3D(Basis.IDENTITY, Vector3.ZERO)
	check_equal(
		_pads.place(space, _pad.shape_for(1.0), passes_through, PadShape.RADIUS_M), passes_through,
		"no way out is near: as it is"
	)


func test_in_a_corner_a_pad_is_shown_out_of_both_faces() -> void:
	var floor_box: PhysicsBody3D = add_box(Vector3(0.2, 0.1, 0.2), Vector3(0.0, -0.05, 0.0), 0.0)
	add_box(Vector3(0.1, 0.2, 0.2), Vector3(-0.05, 0.1, 0.0), 0.0)
	await physics_frames(2)
	var space: PhysicsDirectSpaceState3D = floor_box.get_world_3d().direct_space_state
	var in_both := Transform3D(Basis.IDENTITY, Vector3(-0.003, PadShape.RADIUS_M - 0.004, 0.0))
	check_near(depth(space, in_both), 0.004, 2.0 * CLEAR_M, "depth before")
	var shown: Transform3D = _pads.place(space, _pad.shape_for(1.0), in_both, PadShape.RADIUS_M)
	check(depth(space, shown) <= CLEAR_M, "shown %.3f mm inside" % [1e3 * depth(space, shown)])


func test_drawn_pads_stay_out_of_a_box_that_they_close_on_askew() -> void:
	await set_up(Vector3.ZERO)
	var view := View.new()
	device.add_child(view)
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1)
	body.rotation.y = 2.0 * TURN
	await physics_frames(10)
	await move_to(body.global_position, 0.0, 60)
	var deepest: float = 0.0
	var true_deepest: float = 0.0
	for _i: int in 40:
		await move_to(at, angle + SQUEEZE_ANGLE / 40.0, 1)
		var space: PhysicsDirectSpaceState3D = hand.get_world_3d().direct_space_state
		for side: int in 2:
			deepest = maxf(deepest, depth(space, view.get_drawn_pad(side)))
			var grip: Transform3D = device.get_grip_transform()
			var as_is: Transform3D = _pad.transform_of(side, grip, hand._shown_gap_m())
			true_deepest = maxf(true_deepest, depth(space, as_is))
	check_equal(hand.get_held_body(), body, "held")
	check(true_deepest > 0.0003, "the grip itself overlaps it: %.3f mm" % [1e3 * true_deepest])
	check(deepest <= CLEAR_M, "drawn %.3f mm inside" % [1e3 * deepest])


func test_a_hidden_view_looks_for_no_pads() -> void:
	await set_up(Vector3.ZERO)
	var view := View.new()
	device.add_child(view)
	await frames(3)
	view.visible = false
	var drawn: Transform3D = view.get_drawn_pad(0)
	await move_to(Vector3(0.03, 0.0, 0.0), 0.0, 30)
	await frames(2)
	check_equal(view.get_drawn_pad(0), drawn, "hidden: not looked for")
	view.visible = true
	await frames(2)
	check(view.get_drawn_pad(0) != drawn, "shown: found again")
