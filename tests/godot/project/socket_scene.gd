## Base of the socket tests: a body with a plug below it, and a stand with a cup beside it.
extends "res://hand_scene.gd"

const STAND := Vector3(0.0, 0.0, 0.06)

var body: RigidBody3D
var stand: StaticBody3D
var plug: SpidarGSocket
var cup: SpidarGSocket


## upside_down: the body hangs from below the stand.
func set_up_socket(upside_down: bool = false) -> void:
	at = Vector3.ZERO
	angle = 0.0
	body = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1)
	plug = add_socket(body, Vector3(0.0, 0.021 if upside_down else -0.021, 0.0), true)
	stand = add_box(Vector3(0.01, 0.06, 0.01), STAND + Vector3(0.0, 0.10 if upside_down else -0.05, 0.0), 0.0)
	cup = add_socket(stand, Vector3(0.0, -0.03 if upside_down else 0.03, 0.0), false)
	await set_up(Vector3.ZERO)


func add_socket(to: PhysicsBody3D, place: Vector3, is_plug: bool, key: StringName = &"") -> SpidarGSocket:
	var socket := SpidarGSocket.new()
	socket.name = key + (" plug" if is_plug else "") if key != &"" else ("plug" if is_plug else "cup")
	socket.key = key
	socket.is_plug = is_plug
	socket.position = place
	to.add_child(socket)
	return socket


## Grasps the body and brings it in front of the stand, `before` away.
func pick_up(before: float) -> void:
	await grasp(body)
	check_equal(hand.get_held_body(), body, "grasped")
	await move_to(at + Vector3(0.0, 0.03, 0.0), SQUEEZE_ANGLE, 40)
	if before > 0.0:
		await hover(-before if plug.position.y > 0.0 else before)


## Brings the plug, as the hand holds it, to `height` over its cup.
func hover(height: float) -> void:
	await hover_over(cup, height)


func hover_over(mate: SpidarGSocket, height: float) -> void:
	for _i: int in 3:
		if not is_instance_valid(plug) or not is_instance_valid(mate):
			return
		var off: Vector3 = mate.global_position + Vector3(0.0, height, 0.0) - hand.get_wanted_pose() * plug.position
		await move_to(at + off, SQUEEZE_ANGLE, 30)
		await physics_frames(20)


## The plug, as it is, from its cup.
func distance() -> float:
	return plug.global_position.distance_to(cup.global_position)


## How far up the hand has pulled the plug from its cup.
func stretch() -> float:
	return (hand.get_wanted_pose() * plug.position - cup.global_position).y


func let_go() -> void:
	await move_to(at, 0.0, 30)
	await physics_frames(20)


func clear() -> void:
	for node: Node in tree.root.get_children():
		if node is PhysicsBody3D or node is SpidarG:
			node.free()
