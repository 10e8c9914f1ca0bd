extends RefCounted
## The things of this task by level. They differ in shape, width (12 to 50 mm), mass (50 to 250 g), and in level 3
## in friction and softness too.

const DemoPalette := preload("res://scene/demo_palette.gd")
const ObjectSpec := preload("res://tasks/pick_and_place/object_spec.gd")

## By level: how far starts and targets are turned, and what counts as placed.
const YAW_RAD: PackedFloat64Array = [0.0, deg_to_rad(12.0), deg_to_rad(25.0)]
const POSITION_TOLERANCE_M: PackedFloat64Array = [0.008, 0.008, 0.005]
const ROTATION_TOLERANCE_RAD: PackedFloat64Array = [deg_to_rad(10.0), deg_to_rad(10.0), deg_to_rad(6.0)]


static func of_level(level: int) -> Array[ObjectSpec]:
	match level:
		1:
			return [_blue_box(), _teal_cylinder(), _coral_slab(), _mustard_cylinder(), _sage_ball()]
		2:
			return [
				_blue_box(), _teal_cylinder(), _coral_slab(), _mustard_cylinder(), _plum_brick(),
				_sage_ball(), _bone_stick(),
			]
	return [
		_soft_cushion(), _teal_cylinder(), _slippery_block(), _soft_roll(), _plum_brick(), _sage_ball(),
		_bone_stick(),
	]


static func _blue_box() -> ObjectSpec:
	return ObjectSpec.make(
		"blue_box", ObjectSpec.Shape.BOX, Vector3(0.035, 0.060, 0.035), 0.120, DemoPalette.BLUE
	)


static func _teal_cylinder() -> ObjectSpec:
	return ObjectSpec.make(
		"teal_cylinder", ObjectSpec.Shape.CYLINDER, Vector3(0.050, 0.058, 0.050), 0.250, DemoPalette.TEAL
	)


static func _coral_slab() -> ObjectSpec:
	return ObjectSpec.make(
		"coral_slab", ObjectSpec.Shape.BOX, Vector3(0.020, 0.062, 0.036), 0.050, DemoPalette.CORAL
	)


static func _mustard_cylinder() -> ObjectSpec:
	return ObjectSpec.make(
		"mustard_cylinder", ObjectSpec.Shape.CYLINDER, Vector3(0.035, 0.064, 0.035), 0.050,
		DemoPalette.MUSTARD
	)


static func _plum_brick() -> ObjectSpec:
	return ObjectSpec.make(
		"plum_brick", ObjectSpec.Shape.BOX, Vector3(0.050, 0.058, 0.030), 0.250, DemoPalette.PLUM
	)


static func _sage_ball() -> ObjectSpec:
	return ObjectSpec.make(
		"sage_ball", ObjectSpec.Shape.SPHERE, Vector3.ONE * 0.050, 0.120, DemoPalette.SAGE,
		ObjectSpec.Stand.RING
	)


static func _bone_stick() -> ObjectSpec:
	return ObjectSpec.make(
		"bone_stick", ObjectSpec.Shape.BOX, Vector3(0.012, 0.012, 0.060), 0.050, DemoPalette.BONE,
		ObjectSpec.Stand.RACK
	)


## Gives way under the fingers: they close 7 degrees further than on the rest for the same squeeze.
static func _soft_cushion() -> ObjectSpec:
	var spec := ObjectSpec.make(
		"soft_cushion", ObjectSpec.Shape.BOX, Vector3(0.044, 0.056, 0.036), 0.060, DemoPalette.CORAL
	)
	spec.squeeze_nm_rad = 0.12
	spec.stiffness_n_m = 150.0
	spec.friction = 1.0
	return spec


static func _soft_roll() -> ObjectSpec:
	var spec := ObjectSpec.make(
		"soft_roll", ObjectSpec.Shape.CYLINDER, Vector3(0.040, 0.062, 0.040), 0.050,
		DemoPalette.MUSTARD
	)
	spec.squeeze_nm_rad = 0.15
	spec.stiffness_n_m = 150.0
	spec.friction = 1.0
	return spec


## Takes three times the squeeze of its weight.
static func _slippery_block() -> ObjectSpec:
	var spec := ObjectSpec.make(
		"slippery_block", ObjectSpec.Shape.BOX, Vector3(0.030, 0.060, 0.034), 0.080, DemoPalette.BLUE
	)
	spec.friction = 0.3
	return spec
