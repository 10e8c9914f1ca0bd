extends "res://plays/play.gd"


func play() -> void:
	await presses(Vector3(0.09, 0.0, 0.03), Vector3(0.09, -0.08, 0.03))
	await move_to(Vector3(0.0, 0.02, 0.03))
	await lifts(scene.get_node(^"Block") as RigidBody3D)
