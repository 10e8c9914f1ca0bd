@tool
extends "res://scene/task_body.gd"
## One part of the robot, with the pose that it has in the finished one. Its sockets are nodes of its scene: plugs on the limbs,
## cups on what carries them; linked faces do not quite touch.

## Where its middle is in the finished robot. Robot's frame: origin on the table, y up, the front at +z.
@export var place_m := Vector3.ZERO
## The fingers are all but closed on it, so that the strings give its detent less well.
@export var is_thin := false:
	set(value):
		is_thin = value
		felt.detent_tolerance = FeltRecord.DETENT_TOLERANCE_THIN if value else FeltRecord.DETENT_TOLERANCE

## The robot's frame.
var robot: Node3D
var ghost: Node3D


func _init() -> void:
	felt.checks_detent = true


func goal() -> Transform3D:
	return robot.global_transform * place()


## In the robot's frame.
func place() -> Transform3D:
	return Transform3D(Basis.IDENTITY, place_m)


## Height of the origin when it stands on the table.
func rest_height_m() -> float:
	return 0.5 * size_m().y


func show_placed(placed_: bool) -> void:
	ghost.visible = not placed_
