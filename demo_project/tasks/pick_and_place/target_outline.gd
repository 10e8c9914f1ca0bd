@tool
extends Node3D
## Where an object belongs: its outline on the table in its own colour and size, the tolerance
## around it as a pale band, its stand where it has one, and a faint ghost of the thing itself.

const DemoPalette := preload("res://scene/demo_palette.gd")
const TargetOutline := preload("res://tasks/pick_and_place/target_outline.gd")
const TaskObject := preload("res://tasks/pick_and_place/task_object.gd")

const LINE_M := 0.0022
const LIFT_M := 0.0004
const CORNER_POINTS := 10
const FILL_ALPHA := 0.30
const PLACED_ALPHA := 0.65
const BAND_ALPHA := 0.24
const GHOST_ALPHA := 0.12

## For the editor alone: the thing whose outline is shown when this scene is opened by itself.
@export var example: PackedScene

var _half_m := Vector2.ZERO
var _rest_height_m := 0.0
var _fill_material: StandardMaterial3D

@onready var _ghost: MeshInstance3D = $Ghost


func _ready() -> void:
	if Engine.is_editor_hint() and get_tree().edited_scene_root == self and example != null:
		var object: TaskObject = example.instantiate()
		var shown: TargetOutline = (load(scene_file_path) as PackedScene).instantiate()
		shown.setup(object, Transform3D(Basis.IDENTITY, Vector3.UP * object.rest_height_m()))
		add_child(shown) # Without an owner it is not saved.
		object.free()


## pose: of the object when placed, in the table's frame.
func setup(object: TaskObject, pose: Transform3D) -> void:
	_rest_height_m = object.rest_height_m()
	_half_m = object.footprint_m()
	transform = Transform3D(pose.basis, pose.origin - pose.basis.y * _rest_height_m)
	var colour := object.colour()
	var corner := _half_m.x if object.is_round() else 0.002
	_fill_material = DemoPalette.flat(Color(colour, FILL_ALPHA))
	var around := _half_m + Vector2.ONE * object.position_tolerance_m
	var line := _half_m + Vector2.ONE * LINE_M
	_draw_band($Fill, _half_m, Vector2.ZERO, corner, _fill_material)
	_draw_band($Line, line, _half_m, corner, DemoPalette.flat(colour))
	_draw_band($Band, around, line, corner, DemoPalette.flat(Color(colour, BAND_ALPHA)))
	var stand := object.make_stand()
	if stand != null:
		add_child(stand)
	var ghost: MeshInstance3D = $Ghost
	ghost.mesh = object.mesh()
	ghost.position.y = _rest_height_m
	ghost.material_override = DemoPalette.flat(Color(colour, GHOST_ALPHA))


## World pose of the object's centre when placed perfectly.
func goal() -> Transform3D:
	return global_transform.translated_local(Vector3.UP * _rest_height_m)


func show_placed(placed: bool) -> void:
	_ghost.visible = not placed
	_fill_material.albedo_color.a = PLACED_ALPHA if placed else FILL_ALPHA


func _draw_band(
	band: MeshInstance3D, outer: Vector2, inner: Vector2, corner: float, material: StandardMaterial3D
) -> void:
	var outside := _outline(outer, corner + outer.x - _half_m.x)
	var inside := _outline(inner, maxf(corner + inner.x - _half_m.x, 0.0))
	var strip := PackedVector3Array()
	for index in outside.size() + 1:
		var at := index % outside.size()
		strip.append(Vector3(outside[at].x, LIFT_M, outside[at].y))
		strip.append(Vector3(inside[at].x, LIFT_M, inside[at].y))
	var arrays: Array = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = strip
	var mesh := ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLE_STRIP, arrays)
	mesh.surface_set_material(0, material)
	material.cull_mode = BaseMaterial3D.CULL_DISABLED
	band.mesh = mesh


## Rectangle of these half sides with rounded corners, counter-clockwise.
func _outline(half: Vector2, corner: float) -> PackedVector2Array:
	var radius := minf(corner, minf(half.x, half.y))
	var points := PackedVector2Array()
	for quarter in 4:
		var sign_x := 1.0 if quarter in [0, 3] else -1.0
		var sign_y := 1.0 if quarter < 2 else -1.0
		var centre := Vector2(sign_x * (half.x - radius), sign_y * (half.y - radius))
		for step in CORNER_POINTS:
			var angle := PI * 0.5 * (quarter + float(step) / (CORNER_POINTS - 1))
			points.append(centre + Vector2(cos(angle), sin(angle)) * radius)
	return points
