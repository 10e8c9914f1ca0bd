@tool
extends "res://tasks/base/task_layout.gd"
## Where the robot's stand and its parts are at the start, and the ghosts of the finished robot.

const PartGhost := preload("res://tasks/robot_linking/part_ghost.gd")
const RobotPart := preload("res://tasks/robot_linking/robot_part.gd")

const STAND := preload("res://tasks/robot_linking/parts/stand.tscn")
const TORSO := preload("res://tasks/robot_linking/parts/torso.tscn")
## Everything but the torso, in no special order.
const LIMBS: Array[PackedScene] = [
	preload("res://tasks/robot_linking/parts/head.tscn"),
	preload("res://tasks/robot_linking/parts/left_arm.tscn"),
	preload("res://tasks/robot_linking/parts/right_arm.tscn"),
	preload("res://tasks/robot_linking/parts/left_leg.tscn"),
	preload("res://tasks/robot_linking/parts/right_leg.tscn"),
]
const STAND_Z_M := -0.045
## On the table, before the robot and near its middle: further out the least tension of the strings alone presses nearly
## closed jaws open with 7 N mm and more, and a squeeze up to that is not felt. Fingers that open for the torso reach
## 41 mm to each side, and come in 36 mm in front, turned by up to 30 degrees: hence the spaces.
const THIN_SLOTS_M: Array[Vector2] = [
	Vector2(-0.072, 0.030), Vector2(0.072, 0.030), Vector2(-0.072, 0.105), Vector2(0.072, 0.105)
]
const WIDE_SLOTS_M: Array[Vector2] = [Vector2(0.0, 0.030), Vector2(0.0, 0.130)]
const JITTER_M := 0.003
## By level: how far the parts are turned, and the stand.
const YAW_RAD: PackedFloat64Array = [0.0, deg_to_rad(15.0), deg_to_rad(30.0)]
const STAND_YAW_RAD: PackedFloat64Array = [0.0, 0.0, deg_to_rad(15.0)]
## Of each part from its place in the robot.
const POSITION_TOLERANCE_M: PackedFloat64Array = [0.004, 0.004, 0.003]
const ROTATION_TOLERANCE_RAD: PackedFloat64Array = [deg_to_rad(6.0), deg_to_rad(6.0), deg_to_rad(4.0)]

var _items: Node3D
var _random := RandomNumberGenerator.new()
var _yaw_limit := 0.0
var _robot: Node3D
var _thin_slots: Array[Vector2] = []
var _wide_slots: Array[Vector2] = []


func lay_out(items: Node3D, level: int, seed_number: int) -> void:
	_items = items
	_random.seed = seed_number
	_yaw_limit = YAW_RAD[level - 1]
	_add_stand(STAND_YAW_RAD[level - 1])
	_thin_slots.assign(shuffled(THIN_SLOTS_M.duplicate(), _random))
	_wide_slots.assign(shuffled(WIDE_SLOTS_M.duplicate(), _random))
	_add_torso(level == 1)
	var limbs: Array[RobotPart] = []
	for scene in LIMBS:
		limbs.append(scene.instantiate() as RobotPart)
	limbs.assign(shuffled(limbs, _random))
	for limb in limbs:
		_add_part(limb, _start_in((_thin_slots if limb.is_thin else _wide_slots).pop_back(), limb))
		bodies.append(limb)
	limbs[0].felt.checks_release = true
	for body in bodies:
		body.position_tolerance_m = POSITION_TOLERANCE_M[level - 1]
		body.rotation_tolerance_rad = ROTATION_TOLERANCE_RAD[level - 1]
		_items.add_child(PartGhost.make(body as RobotPart))


func _add_stand(yaw_limit: float) -> void:
	_robot = STAND.instantiate()
	_robot.position = Vector3(0.0, 0.0, STAND_Z_M)
	_robot.rotation.y = _random.randf_range(-yaw_limit, yaw_limit)
	_items.add_child(_robot)
	carriers.append(_robot.get_node(^"Bracket") as CollisionObject3D)


func _add_torso(stands_already: bool) -> void:
	var torso: RobotPart = TORSO.instantiate()
	if stands_already:
		torso.freeze = true # Nobody has to place it.
		_add_part(torso, _robot.transform * torso.place())
	else:
		_add_part(torso, _start_in(_wide_slots.pop_back(), torso))
		bodies.append(torso)


func _add_part(part: RobotPart, at: Transform3D) -> void:
	part.robot = _robot
	part.start = at
	part.transform = at
	_items.add_child(part)
	carriers.append(part)


func _start_in(slot: Vector2, part: RobotPart) -> Transform3D:
	var x := slot.x + _random.randf_range(-JITTER_M, JITTER_M)
	var z := slot.y + _random.randf_range(-JITTER_M, JITTER_M)
	var yaw := _random.randf_range(-_yaw_limit, _yaw_limit)
	return Transform3D(Basis(Vector3.UP, yaw), Vector3(x, part.rest_height_m(), z))
