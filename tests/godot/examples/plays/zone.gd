extends "res://plays/play.gd"


func play() -> void:
	await move_to(Vector3(0.0, 0.08, 0.0))
	var before: Vector3 = await felt_n()
	await move_to(Vector3(0.03, -0.04, 0.01))
	await move_to(Vector3(0.056, -0.04, 0.01))
	var by_rail: Vector3 = await felt_n() - before
	check(by_rail.x < -0.3 and absf(by_rail.y) < 0.15, "the rail pulls to itself, not along itself: %s N" % by_rail)
	await move_to(Vector3(0.0, 0.08, 0.0))
	await move_to(Vector3(-0.046, -0.03, 0.0))
	var wind: SpidarGZone = scene.get_node(^"Wind")
	wind.enabled = false
	await ticks(30)
	var calm: Vector3 = await felt_n()
	wind.enabled = true
	await ticks(30)
	var by_wind: Vector3 = await felt_n() - calm
	# This device has friction in its strings.
	check(absf(by_wind.y - 1.5) < 0.3, "the wind blows upwards: %s N" % by_wind)
	check(wind.is_hand_inside(device), "the hand is in the wind")
