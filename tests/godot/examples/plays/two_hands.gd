extends "res://plays/play.gd"


func play() -> void:
	var bar: RigidBody3D = scene.get_node(^"Bar")
	var right: SpidarGHand = scene.get_node(^"Right/SpidarGHand")
	await ticks(240) # the right hand has taken its end
	check(right.get_held_body() == bar, "the right hand holds the bar")
	var end: Vector3 = in_device(bar.to_global(Vector3(-0.06, 0.0, 0.0)))
	await move_to(end + Vector3(0.0, 0.06, 0.0))
	end = in_device(bar.to_global(Vector3(-0.06, 0.0, 0.0)))
	await move_to(end)
	press(mouse.grasp_action, true)
	await ticks(100)
	check(hand.get_held_body() == bar, "the left hand holds it, too; %s" % refused)
	var least: float = INF
	var most: float = -INF
	for _i: int in 60:
		var felt: float = (await felt_n(5)).y
		least = minf(least, felt)
		most = maxf(most, felt)
	print("INFO the sway of the right hand is felt as %.2f to %.2f N" % [least, most])
	check(most - least > 0.2, "the left hand feels the right one: %.2f to %.2f N" % [least, most])
	check(right.get_held_body() == bar and hand.get_held_body() == bar, "both still hold it")
