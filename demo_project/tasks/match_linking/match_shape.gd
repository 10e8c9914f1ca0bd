extends Node3D
## A target shape of matches: its corners, its edges, the pegs that carry the corners on the board, and ghosts of the
## matches. Every edge is one match long, and turned no further than a hand can follow.

const DemoPalette := preload("res://scene/demo_palette.gd")
const LinkSocket := preload("res://scene/link_socket.gd")
const MatchShape := preload("res://tasks/match_linking/match_shape.gd")
const MatchStick := preload("res://tasks/match_linking/match_stick.gd")

const PEG_M := 0.060
const PEG_RADIUS_M := 0.003
const GHOST_ALPHA := 0.16

## In this node's frame; y above the pegs' tops.
var corners: PackedVector3Array = []
## Pairs of corners, the first at the smaller z.
var edges: Array[Vector2i] = []
## Cups of the pegs, for the linker.
var pegs: Array[StaticBody3D] = []

var _ghosts: Array[MeshInstance3D] = []


## The shape of a level: 1 a diamond, 2 a fish (a diamond with an open tail), 3 a tent whose four poles meet in the air.
static func of_level(level: int) -> MatchShape:
	var shape := MatchShape.new()
	match level:
		1:
			shape._add_diamond(Vector3.ZERO, deg_to_rad(30.0))
		2:
			shape._add_diamond(Vector3(0.0, 0.0, -0.020), deg_to_rad(35.0))
			shape._add_tail(2, deg_to_rad(25.0))
		_:
			shape._add_tent(deg_to_rad(24.0), deg_to_rad(22.0))
	shape._build()
	return shape


## World pose of a match on this edge: z from its first corner to its second, y up.
func edge_pose(edge: int) -> Transform3D:
	var from := to_global(corners[edges[edge].x])
	var to := to_global(corners[edges[edge].y])
	var z := (to - from).normalized()
	var x := Vector3.UP.cross(z).normalized()
	return Transform3D(Basis(x, z.cross(x), z), 0.5 * (from + to))


## The further of both ends from the corners of this edge, the match either way round.
func end_error_m(stick: MatchStick, edge: int) -> float:
	var from := to_global(corners[edges[edge].x])
	var to := to_global(corners[edges[edge].y])
	var zero := stick.end_position(0)
	var one := stick.end_position(1)
	return minf(
		maxf(zero.distance_to(from), one.distance_to(to)),
		maxf(zero.distance_to(to), one.distance_to(from))
	)


func show_taken(edge: int, taken: bool) -> void:
	_ghosts[edge].visible = not taken


func _add_diamond(middle: Vector3, half_angle: float) -> void:
	var across := Vector3(sin(half_angle), 0.0, 0.0) * MatchStick.LENGTH_M
	var along := Vector3(0.0, 0.0, cos(half_angle)) * MatchStick.LENGTH_M
	var first := corners.size()
	corners.append_array([middle - along, middle - across, middle + along, middle + across])
	for edge: Vector2i in [Vector2i(0, 1), Vector2i(0, 3), Vector2i(1, 2), Vector2i(3, 2)]:
		edges.append(edge + Vector2i(first, first))


## Two matches that open from `corner` towards +z.
func _add_tail(corner: int, half_angle: float) -> void:
	for side: float in [-1.0, 1.0]:
		var way := Vector3(side * sin(half_angle), 0.0, cos(half_angle)) * MatchStick.LENGTH_M
		edges.append(Vector2i(corner, corners.size()))
		corners.append(corners[corner] + way)


## Four poles from a rectangle to one point above its middle.
func _add_tent(rise: float, half_angle: float) -> void:
	var top := Vector3(0.0, sin(rise), 0.0) * MatchStick.LENGTH_M
	corners.append(top)
	for depth: float in [-1.0, 1.0]:
		for side: float in [-1.0, 1.0]:
			var foot := Vector3(side * sin(half_angle), 0.0, depth * cos(half_angle))
			var corner := corners.size()
			corners.append(foot * cos(rise) * MatchStick.LENGTH_M)
			edges.append(Vector2i(corner, 0) if depth < 0.0 else Vector2i(0, corner))


func _build() -> void:
	position.y = PEG_M + MatchStick.BALL_M
	for corner in corners:
		if corner.y < 0.001:
			_add_peg(corner)
	var mesh := BoxMesh.new()
	mesh.size = Vector3(MatchStick.THICK_M, MatchStick.THICK_M, MatchStick.LENGTH_M)
	for edge in edges.size():
		var ghost := MeshInstance3D.new()
		ghost.mesh = mesh
		ghost.material_override = DemoPalette.flat(Color(DemoPalette.ACCENT, GHOST_ALPHA))
		ghost.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
		var from := corners[edges[edge].x]
		var z := (corners[edges[edge].y] - from).normalized()
		var x := Vector3.UP.cross(z).normalized()
		ghost.transform = Transform3D(
			Basis(x, z.cross(x), z), 0.5 * (from + corners[edges[edge].y])
		)
		add_child(ghost)
		_ghosts.append(ghost)


func _add_peg(corner: Vector3) -> void:
	var peg := StaticBody3D.new()
	var shape := CylinderShape3D.new()
	shape.radius = PEG_RADIUS_M
	shape.height = PEG_M
	var collision := CollisionShape3D.new()
	collision.shape = shape
	peg.add_child(collision)
	var mesh := CylinderMesh.new()
	mesh.top_radius = PEG_RADIUS_M
	mesh.bottom_radius = 2.0 * PEG_RADIUS_M
	mesh.height = PEG_M
	mesh.rings = 0
	mesh.material = DemoPalette.matte(DemoPalette.STAND)
	var instance := MeshInstance3D.new()
	instance.mesh = mesh
	peg.add_child(instance)
	peg.position = corner + Vector3.DOWN * (MatchStick.BALL_M + 0.5 * PEG_M)
	var cup := LinkSocket.make(&"end", false, Transform3D(Basis(), corner - peg.position))
	cup.meets_many = true
	cup.turns_freely = true
	peg.add_child(cup)
	add_child(peg)
	pegs.append(peg)
