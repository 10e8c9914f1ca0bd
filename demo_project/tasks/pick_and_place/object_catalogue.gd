@tool
extends RefCounted
## The things of this task by level. They differ in shape, width (12 to 50 mm), mass (50 to 250 g), and in level 3
## in friction and softness too: a cushion and a roll give way under the fingers, a slippery block takes three times the
## squeeze of its weight.

const TaskObject := preload("res://tasks/pick_and_place/task_object.gd")

const BLUE_BOX := preload("res://tasks/pick_and_place/objects/blue_box.tscn")
const BONE_STICK := preload("res://tasks/pick_and_place/objects/bone_stick.tscn")
const CORAL_SLAB := preload("res://tasks/pick_and_place/objects/coral_slab.tscn")
const MUSTARD_CYLINDER := preload("res://tasks/pick_and_place/objects/mustard_cylinder.tscn")
const PLUM_BRICK := preload("res://tasks/pick_and_place/objects/plum_brick.tscn")
const SAGE_BALL := preload("res://tasks/pick_and_place/objects/sage_ball.tscn")
const SLIPPERY_BLOCK := preload("res://tasks/pick_and_place/objects/slippery_block.tscn")
const SOFT_CUSHION := preload("res://tasks/pick_and_place/objects/soft_cushion.tscn")
const SOFT_ROLL := preload("res://tasks/pick_and_place/objects/soft_roll.tscn")
const TEAL_CYLINDER := preload("res://tasks/pick_and_place/objects/teal_cylinder.tscn")

const LEVELS: Array[Array] = [
	[BLUE_BOX, TEAL_CYLINDER, CORAL_SLAB, MUSTARD_CYLINDER, SAGE_BALL],
	[BLUE_BOX, TEAL_CYLINDER, CORAL_SLAB, MUSTARD_CYLINDER, PLUM_BRICK, SAGE_BALL, BONE_STICK],
	[SOFT_CUSHION, TEAL_CYLINDER, SLIPPERY_BLOCK, SOFT_ROLL, PLUM_BRICK, SAGE_BALL, BONE_STICK],
]
## By level: how far starts and targets are turned, and what counts as placed.
const YAW_RAD: PackedFloat64Array = [0.0, deg_to_rad(12.0), deg_to_rad(25.0)]
const POSITION_TOLERANCE_M: PackedFloat64Array = [0.008, 0.008, 0.005]
const ROTATION_TOLERANCE_RAD: PackedFloat64Array = [deg_to_rad(10.0), deg_to_rad(10.0), deg_to_rad(6.0)]


## New objects, not in a tree yet.
static func of_level(level: int) -> Array[TaskObject]:
	var objects: Array[TaskObject] = []
	for scene: PackedScene in LEVELS[level - 1]:
		var object: TaskObject = scene.instantiate()
		object.position_tolerance_m = POSITION_TOLERANCE_M[level - 1]
		object.rotation_tolerance_rad = ROTATION_TOLERANCE_RAD[level - 1]
		objects.append(object)
	return objects
