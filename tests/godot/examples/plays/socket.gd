extends "res://plays/play.gd"


func play() -> void:
	var plug: RigidBody3D = scene.get_node(^"Plug")
	var foot: SpidarGSocket = scene.get_node(^"Plug/Foot")
	var head: SpidarGSocket = scene.get_node(^"Plug/Head")
	await lifts(plug)
	await _brings(foot, scene.get_node(^"Stand/Top"), 0.03)
	check(foot.is_linked(), "the plug clicks on the stand")
	await move_to(mouse.position_m + Vector3(0.0, 0.012, 0.0))
	var pulled: Vector3 = await felt_n()
	print("INFO pulled at in its seat: felt %s N" % pulled)
	check(foot.is_linked() and pulled.y < -0.7, "the seat pulls: %s N" % pulled)
	await move_to(mouse.position_m + Vector3(0.0, 0.03, 0.0))
	check(not foot.is_linked() and hand.get_held_body() == plug, "pulled harder, it comes off")
	await _brings(head, scene.get_node(^"Arm/Hook"), -0.03)
	check(head.is_linked(), "the plug clicks below the arm")
	await lets_go()
	await move_to(mouse.position_m + Vector3(0.0, -0.01, 0.06))
	await move_to(mouse.position_m + Vector3(-0.05, -0.02, 0.0))
	await ticks(60)
	var off_m: float = head.global_position.distance_to(head.get_mate().global_position) if head.is_linked() else INF
	check(off_m < 0.001, "let go, the plug hangs there: %f m off" % off_m)


## In front of the mate by `before` (m, upward), and on.
func _brings(socket: SpidarGSocket, mate: SpidarGSocket, before: float) -> void:
	for height: float in [before, 0.0]:
		for _i: int in 2:
			var off: Vector3 = mate.global_position + Vector3(0.0, height, 0.0) - hand.get_wanted_pose() * socket.position
			await move_to(mouse.position_m + off)
			await ticks(SETTLE_TICKS)
