extends "res://plays/play.gd"


func play() -> void:
	var torch: Node3D = scene.get_node(^"SpidarG/SpidarGGrip")
	await presses(Vector3(0.0, 0.0, 0.0), Vector3(0.0, -0.13, 0.0))
	var sunk: float = torch.global_position.y - device.get_grip_transform().origin.y
	check(sunk > 0.002, "the torch stays above the floor with the pads: by %f m" % sunk)
	await move_to(Vector3(0.03, 0.04, 0.02))
	await ticks(1)
	var apart: float = torch.global_position.distance_to(device.get_grip_transform().origin)
	check(apart < 1e-4, "in the air it is where the grip is: %f m apart" % apart)
