extends "res://tasks/base/linking_task.gd"
## The task: build a robot by linking head, arms, legs and torso, in any order.
## Kim, Koike and Sato's experiment 3 ("SPIDAR-G", section 7.2).

const PartGhost := preload("res://tasks/robot_linking/part_ghost.gd")
const RobotDesign := preload("res://tasks/robot_linking/robot_design.gd")
const RobotPart := preload("res://tasks/robot_linking/robot_part.gd")
const RobotPlayer := preload("res://tasks/robot_linking/robot_player.gd")

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
const LATCH_M: PackedFloat64Array = [0.003, 0.003, 0.002]
const LATCH_RAD: PackedFloat64Array = [deg_to_rad(5.0), deg_to_rad(5.0), deg_to_rad(3.0)]
## Of each part from its place in the robot.
const POSITION_TOLERANCE_M: PackedFloat64Array = [0.004, 0.004, 0.003]
const ROTATION_TOLERANCE_RAD: PackedFloat64Array = [deg_to_rad(6.0), deg_to_rad(6.0), deg_to_rad(4.0)]


func _make_player() -> TaskPlayer:
	var robot_player := RobotPlayer.new()
	robot_player.linker = linker
	return robot_player


func _lay_out() -> void:
	var index := arguments.level - 1
	var random := RandomNumberGenerator.new()
	random.seed = arguments.seed_number
	linker.clear()
	linker.latch_m = LATCH_M[index]
	linker.latch_rad = LATCH_RAD[index]
	var robot := Node3D.new()
	robot.position = Vector3(0.0, 0.0, STAND_Z_M)
	robot.rotation.y = random.randf_range(-STAND_YAW_RAD[index], STAND_YAW_RAD[index])
	_items.add_child(robot)
	var bracket := RobotDesign.build_stand(robot)
	linker.add_carrier(bracket)
	var thin_slots := _shuffled(THIN_SLOTS_M.duplicate(), random)
	var wide_slots := _shuffled(WIDE_SLOTS_M.duplicate(), random)
	var torso := RobotDesign.torso()
	if arguments.level == 1:
		torso.freeze = true # Stands already; nobody has to place it.
		_add_part(torso, robot, robot.transform * torso.place)
	else:
		_add_part(torso, robot, _start_in(wide_slots.pop_back(), torso, random, YAW_RAD[index]))
		bodies.append(torso)
	var limbs: Array[RobotPart] = RobotDesign.limbs()
	limbs.assign(_shuffled(limbs, random))
	for limb in limbs:
		var slots := wide_slots if limb.width_m > RobotDesign.ARM_M.x else thin_slots
		_add_part(limb, robot, _start_in(slots.pop_back(), limb, random, YAW_RAD[index]))
		bodies.append(limb)
	limbs[0].felt.checks_release = true
	for body in bodies:
		body.position_tolerance_m = POSITION_TOLERANCE_M[index]
		body.rotation_tolerance_rad = ROTATION_TOLERANCE_RAD[index]
		_items.add_child(PartGhost.make(body as RobotPart))


func _add_part(part: RobotPart, robot: Node3D, at: Transform3D) -> void:
	part.robot = robot
	part.start = at
	part.transform = at
	_items.add_child(part)
	linker.add_carrier(part)


func _start_in(
	slot: Vector2, part: RobotPart, random: RandomNumberGenerator, yaw_limit: float
) -> Transform3D:
	var x := slot.x + random.randf_range(-JITTER_M, JITTER_M)
	var z := slot.y + random.randf_range(-JITTER_M, JITTER_M)
	var yaw := random.randf_range(-yaw_limit, yaw_limit)
	return Transform3D(Basis(Vector3.UP, yaw), Vector3(x, part.rest_height_m(), z))


func _shuffled(things: Array, random: RandomNumberGenerator) -> Array:
	for last in range(things.size() - 1, 0, -1):
		var other := random.randi_range(0, last)
		var kept: Variant = things[last]
		things[last] = things[other]
		things[other] = kept
	return things
