@tool
extends Node3D
## A target shape of matches: its corners, its edges, the pegs that carry the corners on the board, and ghosts of the
## matches. Every edge is one match long, and turned no further than a hand can follow. Pegs and ghosts follow the corners and
## edges of the scene.

const DemoPalette := preload("res://scene/demo_palette.gd")
const MatchStick := preload("res://tasks/match_linking/match_stick.gd")
const PEG := preload("res://tasks/match_linking/peg.tscn")

## Of the peg's middle below the corner that it carries.
const PEG_BELOW_M := 0.0326
const GHOST_ALPHA := 0.16
## A corner higher than this has no peg: matches meet there in the air.
const IN_THE_AIR_M := 0.001

## In this node's frame; y above the pegs' tops.
@export var corners: PackedVector3Array = []:
	set(value):
		corners = value
		_build_anew()
## Pairs of corners, the first at the smaller z.
@export var edges: Array[Vector2i] = []:
	set(value):
		edges = value
		_build_anew()

## Their cups are sockets.
var pegs: Array[StaticBody3D] = []

var _ghosts: Array[MeshInstance3D] = []


func _ready() -> void:
	_build()


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


## After a change in the editor.
func _build_anew() -> void:
	if not Engine.is_editor_hint() or not is_node_ready():
		return
	for peg in pegs:
		peg.queue_free()
	for ghost in _ghosts:
		ghost.queue_free()
	pegs.clear()
	_ghosts.clear()
	_build()


## None of it has an owner: it is not saved with the scene.
func _build() -> void:
	for corner in corners:
		if corner.y < IN_THE_AIR_M:
			var peg: StaticBody3D = PEG.instantiate()
			peg.position = corner + Vector3.DOWN * PEG_BELOW_M
			add_child(peg)
			pegs.append(peg)
	var mesh := BoxMesh.new()
	mesh.size = Vector3(MatchStick.THICK_M, MatchStick.THICK_M, MatchStick.LENGTH_M)
	for edge in edges:
		if maxi(edge.x, edge.y) < corners.size():
			_add_ghost(mesh, corners[edge.x], corners[edge.y])


func _add_ghost(mesh: BoxMesh, from: Vector3, to: Vector3) -> void:
	var ghost := MeshInstance3D.new()
	ghost.mesh = mesh
	ghost.material_override = DemoPalette.flat(Color(DemoPalette.ACCENT, GHOST_ALPHA))
	ghost.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	var z := (to - from).normalized()
	var x := Vector3.UP.cross(z).normalized()
	ghost.transform = Transform3D(Basis(x, z.cross(x), z), 0.5 * (from + to))
	add_child(ghost)
	_ghosts.append(ghost)
