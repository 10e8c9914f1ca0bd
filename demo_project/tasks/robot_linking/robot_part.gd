extends "res://scene/task_body.gd"
## One part of the robot, with the pose that it has in the finished one.

## Robot's frame in the world: origin on the table under its middle, front +z.
var robot: Node3D
## In the robot's frame.
var place := Transform3D.IDENTITY
var ghost: Node3D


func goal() -> Transform3D:
	return robot.global_transform * place


## Height of the origin when it stands on the table.
func rest_height_m() -> float:
	for child in get_children():
		var collision := child as CollisionShape3D
		if collision != null and collision.shape is BoxShape3D:
			return 0.5 * (collision.shape as BoxShape3D).size.y
	return 0.0


func show_placed(placed_: bool) -> void:
	ghost.visible = not placed_
