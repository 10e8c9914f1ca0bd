extends RefCounted
## How far the pads, as they were last drawn, stand inside any body: measured with the pads' own shape by the physics engine.

## Of a pad: a disc with a rounded edge, whose radius is a quarter of that of the pad.
const EDGE_PART := 0.25
## Of the hull that stands for it: within 0.1 mm.
const RINGS := 7
const SECTORS := 24

## The deepest so far.
var worst_m := 0.0
# What the hand held when the pads were drawn, and where it was drawn.
var _held: RigidBody3D
var _held_at := Transform3D.IDENTITY
var _shape := ConvexPolygonShape3D.new()
var _radius_m := 0.0
var _query := PhysicsShapeQueryParameters3D.new()


## When a frame is drawn.
func note_drawn(hand: SpidarGHand) -> void:
	_held = hand.get_held_body()
	if _held != null:
		_held_at = _held.global_transform


## Once a physics tick: how deep the pads stood in what was drawn. The physics engine has moved on by a step since then, so
## the pads are measured where they would be had they gone along with the body that they hold.
func measure(hand: SpidarGHand, view: SpidarGView) -> void:
	var space := view.get_world_3d().direct_space_state
	var moved := Transform3D.IDENTITY
	if is_instance_valid(_held):
		moved = _held.global_transform * _held_at.affine_inverse()
	for side in 2:
		worst_m = maxf(worst_m, depth(space, moved * view.get_drawn_pad(side), hand.get_pad_radius()))


## How deep a pad stands in anything, scene metres. at: x outward from the middle of its inner face.
func depth(space: PhysicsDirectSpaceState3D, at: Transform3D, radius_m: float) -> float:
	_make_shape(radius_m)
	_query.shape = _shape
	_query.transform = at
	var deepest := 0.0
	var pairs := space.collide_shape(_query, 32)
	for i in range(0, pairs.size() - 1, 2):
		deepest = maxf(deepest, pairs[i].distance_to(pairs[i + 1]))
	return deepest


func _make_shape(radius_m: float) -> void:
	if radius_m == _radius_m:
		return
	_radius_m = radius_m
	var points := PackedVector3Array()
	for ring in RINGS:
		var turn := PI * (float(ring) / (RINGS - 1) - 0.5)
		var along := EDGE_PART * (1.0 + sin(turn))
		var radius := 1.0 - EDGE_PART + EDGE_PART * cos(turn)
		for sector in SECTORS:
			var around := TAU * sector / SECTORS
			points.append(radius_m * Vector3(along, radius * cos(around), radius * sin(around)))
	_shape.points = points
