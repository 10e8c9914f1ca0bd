## Base of the tests of shapes: no floor of their own, events noted, friction off.
extends "res://hand_scene.gd"

const PadDepth := preload("res://pad_depth.gd")
const Solids := preload("res://solids.gd")

const PAD_RADIUS: float = 0.012
## Of the open jaws: from the grip's center to a pad's outer face.
const REACH_M: float = 0.046
## What is shown is never deeper in anything.
const MOST_DEPTH_M: float = 0.0005

var shakes: int = 0
var too_deep: int = 0
var turn := Basis.IDENTITY
var _inner: SphereShape3D = PadDepth.ball(-MOST_DEPTH_M)


## As set_up(), without a floor.
func set_up_empty(friction: float = 0.0) -> void:
	device = ideal_device()
	device.config.simulated_hand_firmness = firmness
	device.forces_enabled = true
	device.device_event.connect(func(event: Dictionary) -> void: shakes += int(event["name"] == "shaking"))
	hand = SpidarGHand.new()
	hand.contact_friction = friction
	device.add_child(hand)
	add(device)
	await move_to(Vector3.ZERO, 0.0, 10)
	await physics_frames(ARMING_FRAMES)


## Moves the simulated hand in a straight line with a turn, and notes whether the pads are shown inside of anything.
func go(to: Vector3, frame_count: int, to_turn: Basis = Basis.IDENTITY, to_angle: float = 0.0) -> void:
	var from: Vector3 = at
	var from_turn: Basis = turn
	var from_angle: float = angle
	for i: int in frame_count:
		var part: float = float(i + 1) / frame_count
		at = from.lerp(to, part)
		turn = from_turn.slerp(to_turn, part)
		angle = lerpf(from_angle, to_angle, part)
		device.set_simulated_hand_target(Transform3D(turn, at), angle)
		await physics_frames(1)
		if i % 4 == 0:
			note_depth()


func note_depth() -> void:
	var space: PhysicsDirectSpaceState3D = hand.get_world_3d().direct_space_state
	for side: int in 2:
		too_deep += PadDepth.met(space, hand.get_pad_transform(side), _inner, 0.003).size()


## Whenever it was looked at, no pad was shown deeper than MOST_DEPTH_M in anything.
func check_shown_outside() -> void:
	check_equal(too_deep, 0, "pads shown deeper than %.1f mm in a body" % [1e3 * MOST_DEPTH_M])


## Large meshes are made ready beside the game, which headless frames run ahead of.
func until_felt() -> void:
	await physics_frames(2)
	var ready: bool = await until(
		func() -> bool:
			var now: Dictionary = hand.get_touch_statistics()
			return now["shapes_cooking"] == 0 and now["shapes"] > 0
	)
	check(ready, "shapes are ready: %s" % hand.get_touch_statistics())


## Force of what is felt: of mean_felt().
static func force_of(felt: PackedFloat64Array) -> Vector3:
	return Vector3(felt[0], felt[1], felt[2])


static func moment_of(felt: PackedFloat64Array) -> Vector3:
	return Vector3(felt[3], felt[4], felt[5])
