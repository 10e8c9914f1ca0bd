## Pads are shown on the surface of what they meet, never inside, however they meet it.
extends "res://hand_scene.gd"

const PadDepth := preload("res://pad_depth.gd")
const View := preload("res://addons/spidar_g/nodes/spidar_g_view.gd")

## What the hull that is measured with and the engine's own collision tolerance leave, m.
const CLEAR_M: float = 0.0001
const TURN: float = deg_to_rad(4.0)

var _pad: PadDepth = PadDepth.new()


## The deepest of both pads, as shown or as the device alone would place them.
func depth(shown: bool) -> float:
	var deepest: float = 0.0
	var space: PhysicsDirectSpaceState3D = hand.get_world_3d().direct_space_state
	for side: int in 2:
		var as_is: Transform3D = PadDepth.place(side, device.get_grip_transform(), maxf(device.get_jaw_gap(), 0.0))
		deepest = maxf(deepest, _pad.depth(space, hand.get_pad_transform(side) if shown else as_is))
	return deepest


func test_a_pad_pressed_askew_on_a_face_is_shown_on_it() -> void:
	await set_up(Vector3.ZERO)
	add_box(Vector3(0.1, 0.4, 0.4), Vector3(0.15, 0.0, 0.0), 0.0)
	# A pad's flat back meets the wall at 100 mm, turned by 4 degrees.
	for i: int in 120:
		at = Vector3(0.06 * minf((i + 1) / 60.0, 1.0), 0.0, 0.0)
		device.set_simulated_hand_target(Transform3D(Basis(Vector3.UP, TURN), at), 0.0)
		await physics_frames(1)
		check(depth(true) <= CLEAR_M, "shown %.3f mm inside" % [1e3 * depth(true)])
	check(depth(false) > 0.001, "the grip itself is %.3f mm inside" % [1e3 * depth(false)])


func test_in_a_corner_a_pad_is_shown_out_of_both_faces() -> void:
	await set_up(Vector3.ZERO)
	add_box(Vector3(0.1, 0.4, 0.4), Vector3(0.15, 0.0, 0.0), 0.0)
	await move_to(Vector3(0.058, FLOOR_Y + 0.008, 0.0), 0.0, 60)
	await physics_frames(40)
	check(depth(false) > 0.001, "the grip itself is %.3f mm inside" % [1e3 * depth(false)])
	check(depth(true) <= CLEAR_M, "shown %.3f mm inside" % [1e3 * depth(true)])
	check_near(hand.get_proxy_transform().origin.y, FLOOR_Y + PadDepth.RADIUS_M, CLEAR_M, "on the floor")


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
			deepest = maxf(deepest, _pad.depth(space, view.get_drawn_pad(side)))
		true_deepest = maxf(true_deepest, depth(false))
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
