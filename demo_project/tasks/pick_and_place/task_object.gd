extends "res://scene/task_body.gd"
## A thing of pick and place: one of the catalogue, with the outline where it belongs.

const ObjectSpec := preload("res://tasks/pick_and_place/object_spec.gd")
const TargetOutline := preload("res://tasks/pick_and_place/target_outline.gd")

var spec: ObjectSpec
var target: TargetOutline


func setup(spec_: ObjectSpec, start_: Transform3D, target_: TargetOutline) -> void:
	spec = spec_
	target = target_
	start = start_
	label = spec.label
	kind = (ObjectSpec.Shape.find_key(spec.shape) as String).to_lower()
	name = label.to_pascal_case()
	mass = spec.mass_kg
	width_m = spec.size_m.x
	grasp_offset_m = Vector3.UP * spec.grasp_above_centre_m
	is_round = spec.is_round()
	physics_material_override.friction = spec.friction
	if spec.squeeze_nm_rad > 0.0:
		set_meta(&"spidar_squeeze_nm_rad", spec.squeeze_nm_rad)
	if spec.stiffness_n_m > 0.0:
		set_meta(&"spidar_stiffness_n_m", spec.stiffness_n_m)
	add_piece(spec.collision_shape(), spec.mesh(), Transform3D.IDENTITY, spec.colour)
	transform = start


func goal() -> Transform3D:
	return target.goal()


func show_placed(placed_: bool) -> void:
	target.show_placed(placed_)


func rotation_error_rad() -> float:
	return turn_as_shown(spec, global_basis, goal().basis)


## Angle between two orientations as far as the shape can show it.
static func turn_as_shown(shown: ObjectSpec, actual: Basis, wanted: Basis) -> float:
	match shown.shape:
		ObjectSpec.Shape.SPHERE:
			return 0.0
		ObjectSpec.Shape.CYLINDER:
			var tilt := actual.y.normalized().angle_to(wanted.y.normalized())
			return minf(tilt, PI - tilt)
	# A box looks the same after half a turn about its height; a square one after a quarter.
	var turn := PI * 0.5 if is_equal_approx(shown.size_m.x, shown.size_m.z) else PI
	var best := TAU
	for step in roundi(TAU / turn):
		best = minf(best, turn_between(actual.orthonormalized() * Basis(Vector3.UP, turn * step), wanted))
	return best
