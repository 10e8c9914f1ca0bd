extends "res://plays/play.gd"


func play() -> void:
	var by_table: Vector3 = await presses(Vector3(-0.05, -0.02, 0.0), Vector3(-0.05, -0.12, 0.0))
	check(by_table.y > 0.5, "the table pushes up")
	await move_to(Vector3(-0.07, -0.02, 0.0))
	var by_ball: Vector3 = await presses(Vector3(-0.07, -0.055, 0.0), Vector3(0.01, -0.055, 0.0))
	check(by_ball.x < -0.5, "the ball pushes to the left")
