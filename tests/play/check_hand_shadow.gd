extends "check_case.gd"
## The shadow and the line below the hand: on the first surface straight below the grip, for the mouse and for any other source,
## with the plain picture, too; what is held is no surface.

const HandShadow := preload("res://scene/hand_shadow.gd")

const TOLERANCE_M := 0.002


func _run() -> void:
	about = "shadow"
	for source: String in [DemoSettings.SIMULATED, DemoSettings.MOUSE]:
		for picture: String in ["full", "plain"]:
			await _check_source(source, picture)
	await _check_held()


func _check_source(source: String, picture: String) -> void:
	var settings := DemoSettings.new()
	settings.source = source
	settings.picture = picture
	var where := "%s, %s" % [source, picture]
	var task := open("hub", settings)
	await frames(5)
	var mouse: SpidarGMouseHand = task.get_node(^"MouseHand")
	check(not mouse.show_depth_cue, "the mouse hand shows a second depth cue")
	mouse.process_mode = Node.PROCESS_MODE_DISABLED # From here on any source: the shadow knows the grip alone.
	var items: Node3D = task.get_node(^"Items")
	var sizes := PackedFloat64Array()
	for height: float in [0.06, 0.12]:
		await move_hand(task, items.to_global(Vector3(0.0, height, 0.0)), 0.1)
		_check_below(task, items.global_position.y, "%s, %.2f m above the table" % [where, height])
		sizes.append((_part(task, 0).global_basis.x).length())
	check(sizes[1] > sizes[0], "%s: the shadow does not grow with the height: %s" % [where, sizes])
	await move_hand(task, items.to_global(Vector3(0.1, 0.12, -0.07)), 0.1)
	_check_below(task, items.global_position.y + 0.044, where + ", above a knob")
	await move_hand(task, items.to_global(Vector3(0.0, 0.12, 0.2)), 0.1)
	await frames(3)
	var beside := task.spidar.get_grip_transform().origin
	if items.to_local(beside).z > 0.175:
		check(not (task.get_node(^"HandShadow") as HandShadow).is_shown(), where + ": a shadow beside the table")
	await close(task)


func _part(task: DemoTask, index: int) -> Node3D:
	return task.get_node(^"HandShadow").get_child(index)


func _check_below(task: DemoTask, surface_y: float, where: String) -> void:
	var shadow: HandShadow = task.get_node(^"HandShadow")
	var grip := task.spidar.get_grip_transform().origin
	check(shadow.is_shown(), where + ": no shadow")
	var foot := shadow.foot()
	check(absf(foot.y - surface_y) < TOLERANCE_M, "%s: the shadow is at %.4f m, the surface at %.4f m" % [where, foot.y, surface_y])
	check(Vector2(foot.x - grip.x, foot.z - grip.z).length() < TOLERANCE_M, where + ": the shadow is not below the grip")
	var line := _part(task, 1)
	var top := line.global_position.y + line.global_basis.y.length()
	check(line.visible and absf(top - grip.y) < TOLERANCE_M, where + ": the line does not end at the grip")


## A thing in the fingers does not catch the shadow; it is held by its top edge, so that all of it is below the grip's middle.
func _check_held() -> void:
	var task := open("guided_start")
	await frames(5)
	(task.get_node(^"MouseHand") as Node).process_mode = Node.PROCESS_MODE_DISABLED
	var thing: Node3D = task.get_node(^"Items/Thing")
	var at := thing.global_position
	await move_hand(task, at + Vector3.UP * 0.08, 0.1)
	var edge := at + Vector3.UP * 0.032
	await move_hand(task, edge, 0.1)
	await move_hand(task, edge, 0.9)
	await move_hand(task, edge + Vector3.UP * 0.08, 0.9)
	check(task.spidar.get_grip_transform().origin.y > thing.global_position.y + 0.030, "the grip's middle is inside the block")
	check(task.tool_hand.get_held_body() == thing, "the block is not held")
	_check_below(task, (task.get_node(^"Items") as Node3D).global_position.y, "with a held block")
	await close(task)
