extends RefCounted
## How far the pads, as they were last drawn, stand inside any body: measured with the pads' own shape by the physics engine.

## Of a pad, device metres: a disc with a rounded edge.
const RADIUS_M := 0.012
const EDGE_M := 0.003
## Of the hull that stands for it: within 0.1 mm.
const RINGS := 7
const SECTORS := 24

## The deepest so far.
var worst_m := 0.0
var _shape := ConvexPolygonShape3D.new()
var _scale := 0.0
var _query := PhysicsShapeQueryParameters3D.new()


## Once a physics tick, before anything moves: what was drawn last stands beside the bodies as they were drawn.
func measure(spidar: SpidarG, view: SpidarGView) -> void:
	var space := view.get_world_3d().direct_space_state
	for side in 2:
		worst_m = maxf(worst_m, depth(space, view.get_drawn_pad(side), spidar.workspace_scale))


## How deep a pad stands in anything, scene metres. at: x outward from the middle of its inner face.
func depth(space: PhysicsDirectSpaceState3D, at: Transform3D, workspace_scale: float) -> float:
	_make_shape(workspace_scale)
	_query.shape = _shape
	_query.transform = at
	var deepest := 0.0
	var pairs := space.collide_shape(_query, 32)
	for i in range(0, pairs.size() - 1, 2):
		deepest = maxf(deepest, pairs[i].distance_to(pairs[i + 1]))
	return deepest


func _make_shape(workspace_scale: float) -> void:
	if workspace_scale == _scale:
		return
	_scale = workspace_scale
	var points := PackedVector3Array()
	for ring in RINGS:
		var turn := PI * (float(ring) / (RINGS - 1) - 0.5)
		var along := EDGE_M * (1.0 + sin(turn))
		var radius := RADIUS_M - EDGE_M + EDGE_M * cos(turn)
		for sector in SECTORS:
			var around := TAU * sector / SECTORS
			points.append(workspace_scale * Vector3(along, radius * cos(around), radius * sin(around)))
	_shape.points = points
