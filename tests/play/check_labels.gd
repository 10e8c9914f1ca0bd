extends "check_case.gd"
## The names of the hub's knobs are seen wherever the grip is: on the screen, clear of the grip, of the menu and of each other.

const Hub := preload("res://hub/hub.gd")
const SceneLabels := preload("res://ui/scene_labels.gd")

## Grip positions above the table's middle, m, beside one on each knob.
const GRID_M: Array[Vector3] = [
	Vector3(-0.1, 0.12, -0.07), Vector3(0.0, 0.12, -0.07), Vector3(0.1, 0.12, -0.07), Vector3(-0.06, 0.1, 0.075),
	Vector3(0.06, 0.1, 0.075), Vector3(0.0, 0.06, 0.0), Vector3(-0.12, 0.05, 0.03), Vector3(0.12, 0.05, 0.03),
	Vector3(0.0, 0.16, 0.05), Vector3(0.05, 0.07, -0.07), Vector3(-0.05, 0.07, -0.07),
]
## Around the middle of a pad, in viewport pixels.
const PAD_PX := 10.0


func _run() -> void:
	about = "labels"
	for size in SIZES:
		root.size = size
		for percent: int in [100, 150, 200]:
			await _check_hub(percent)
	await _check_restart()


func _check_hub(percent: int) -> void:
	var settings := DemoSettings.new()
	settings.text_percent = percent
	var hub: Hub = open("hub", settings) as Hub
	await frames(5)
	(hub.get_node(^"MouseHand") as Node).process_mode = Node.PROCESS_MODE_DISABLED
	var items: Node3D = hub.get_node(^"Items")
	var places := GRID_M.duplicate()
	for knob in items.get_children():
		places.append((knob as Node3D).position + Vector3.UP * 0.03)
	for place in places:
		await move_hand(hub, items.to_global(Vector3(place.x, 0.14, place.z)), 0.1, 0.4)
		await move_hand(hub, items.to_global(place), 0.1, 0.4)
		await frames(2)
		_check_place(hub, "%d %%, %s, grip at %s" % [percent, root.size, place])
	await close(hub)


func _check_place(hub: Hub, where: String) -> void:
	var labels: SceneLabels = hub.get_node(^"SceneLabels")
	var camera := root.get_camera_3d()
	var grip := Rect2(camera.unproject_position(hub.spidar.get_grip_transform().origin), Vector2.ZERO)
	for end: int in 4:
		var target := (SpidarG.CONTACT_POLE1_PLUS + end) as SpidarG.ContactTarget
		grip = grip.expand(camera.unproject_position(hub.spidar.get_pole_end(target)))
	var rects: Array[Rect2] = [grip, (hub.get_node(^"Menu/Panel") as Control).get_global_rect()]
	for side in 2:
		rects.append(Rect2(camera.unproject_position(hub.tool_hand.get_pad_position(side)), Vector2.ZERO).grow(PAD_PX))
	var shown := labels.shown()
	check(shown.size() == 5, "%s: %d of 5 names" % [where, shown.size()])
	check(labels.layer > -1, "names are drawn above the scene")
	for label in shown:
		var rect := label.get_global_rect()
		check(root.get_visible_rect().encloses(rect), "%s: %s is cut off: %s" % [where, label.text, rect])
		for other in rects:
			check(not rect.intersects(other), "%s: %s is covered: %s by %s" % [where, label.text, rect, other])
		rects.append(rect)


## A scene that starts again has its names again, and none twice.
func _check_restart() -> void:
	var task := open("free_play")
	await frames(5)
	var labels: SceneLabels = task.get_node(^"SceneLabels")
	var before := labels.shown().size()
	check(before >= 12, "free play shows %d names" % before)
	task.call(&"_restart")
	await frames(5)
	check(labels.shown().size() == before, "%d names, %d after a restart" % [before, labels.shown().size()])
	await close(task)
