extends "res://plays/play.gd"


func play() -> void:
	for name: String in ["Box", "Ball", "Can"]:
		var body: RigidBody3D = scene.get_node(name)
		await lifts(body)
		if name != "Can": # the last one stays in the picture
			await move_to(mouse.position_m - Vector3(0.0, 0.05, 0.0))
			await lets_go()
			await move_to(mouse.position_m + Vector3(0.0, 0.07, 0.0))
