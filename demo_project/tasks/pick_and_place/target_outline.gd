extends Node3D
## Where an object belongs: its outline on the table in its own colour and size, the tolerance
## around it as a pale band, its stand where it has one, and a faint ghost of the thing itself.

const DemoPalette := preload("res://scene/demo_palette.gd")
const ObjectSpec := preload("res://tasks/pick_and_place/object_spec.gd")
const StandBuilder := preload("res://scene/stand_builder.gd")

const LINE_M := 0.0022
const LIFT_M := 0.0004
const CORNER_POINTS := 10
const FILL_ALPHA := 0.30
const PLACED_ALPHA := 0.65
const BAND_ALPHA := 0.24
const GHOST_ALPHA := 0.12

var _spec: ObjectSpec
var _ghost: MeshInstance3D
var _line_material: StandardMaterial3D
var _fill_material: StandardMaterial3D


## pose: of the object when placed, in the table's frame. tolerance: of its centre, metres.
func setup(spec: ObjectSpec, pose: Transform3D, tolerance: float) -> void:
	_spec = spec
	transform = Transform3D(pose.basis, pose.origin - pose.basis.y * spec.rest_height_m())
	var half := spec.footprint_m()
	var corner := half.x if spec.is_round() else 0.002
	_line_material = DemoPalette.flat(spec.colour)
	_fill_material = DemoPalette.flat(Color(spec.colour, FILL_ALPHA))
	_add_band(half, Vector2.ZERO, corner, _fill_material)
	_add_band(half + Vector2.ONE * LINE_M, half, corner, _line_material)
	_add_band(
		half + Vector2.ONE * tolerance, half + Vector2.ONE * LINE_M, corner,
		DemoPalette.flat(Color(spec.colour, BAND_ALPHA))
	)
	var stand := StandBuilder.build(spec, DemoPalette.STAND)
	if stand != null:
		add_child(stand)
	_ghost = MeshInstance3D.new()
	_ghost.mesh = spec.mesh()
	_ghost.position.y = spec.rest_height_m()
	_ghost.material_override = DemoPalette.flat(Color(spec.colour, GHOST_ALPHA))
	_ghost.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	add_child(_ghost)


## World pose of the object's centre when placed perfectly.
func goal() -> Transform3D:
	return global_transform.translated_local(Vector3.UP * _spec.rest_height_m())


func show_placed(placed: bool) -> void:
	_ghost.visible = not placed
	_fill_material.albedo_color.a = PLACED_ALPHA if placed else FILL_ALPHA


func _add_band(outer: Vector2, inner: Vector2, corner: float, material: Material) -> void:
	var outside := _outline(outer, corner + outer.x - _spec.footprint_m().x)
	var inside := _outline(inner, maxf(corner + inner.x - _spec.footprint_m().x, 0.0))
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
	(material as StandardMaterial3D).cull_mode = BaseMaterial3D.CULL_DISABLED
	var instance := MeshInstance3D.new()
	instance.mesh = mesh
	instance.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	add_child(instance)


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
