## The diagnosis panel plots what the hand below its device touches, and asks nothing while nobody looks.
extends "res://hand_scene.gd"

const PANEL: String = "res://addons/spidar_g/nodes/spidar_g_panel.tscn"
const PAD_RADIUS: float = 0.012

var panel: SpidarGPanel


func test_contacts_of_the_hand_below_are_plotted() -> void:
	await set_up(Vector3.ZERO)
	_add_panel()
	await frames(12)
	check(_points().visible and _push().visible, "a hand is there: its contacts are shown")
	check_equal(_last(_points(), 1), 0.0, "nothing is near")
	check_equal(_last(_push(), 0), 0.0, "nothing pushes")
	await move_to(Vector3(0.0, FLOOR_Y + PAD_RADIUS - 0.01, 0.0), 0.0, 60)
	await physics_frames(20)
	await frames(1)
	var pushing: int = 0
	var most: float = 0.0
	for point: Dictionary in hand.get_touch_points():
		var push: float = (point["force"] as Vector3).dot(point["normal"])
		pushing += int(push > 0.0)
		most = maxf(most, push)
	check(pushing >= 2 and most > 0.3, "both pads press on the floor: %d points, %.2f N" % [pushing, most])
	check_equal(_last(_points(), 0), float(pushing), "points that push")
	check_equal(_last(_points(), 1), float(hand.get_touch_points().size()), "points that are near")
	check_near(_last(_push(), 0), most, 1e-4, "the largest push")
	var given: PackedFloat64Array = device.get_achieved_wrench()
	check_near(_last(_push(), 1), Vector3(given[0], given[1], given[2]).length(), 1e-4, "the force that is felt")
	check(_last(_push(), 1) > most, "two pads push more than one of them")
	panel.free()
	device.free()


func test_a_device_without_a_hand_shows_no_contacts() -> void:
	device = ideal_device()
	add(device)
	_add_panel()
	await frames(12)
	check(not _points().visible and not _push().visible, "no hand: no plot of contacts")
	check_equal(_points().get_sample_count(), 0, "and no sample")
	hand = SpidarGHand.new()
	device.add_child(hand)
	await frames(12)
	check(_points().visible and _points().get_sample_count() > 0, "a hand that comes is found")
	hand.free()
	await frames(1)
	check(_points().get_sample_count() > 0, "the last contacts of a hand that went are there for a moment")
	await frames(12)
	check(not _points().visible, "then they go")
	hand = SpidarGHand.new()
	device.add_child(hand)
	await frames(12)
	check(_points().get_sample_count() <= 12, "another hand begins anew: %d" % _points().get_sample_count())
	panel.free()
	device.free()


func test_a_hidden_panel_asks_no_hand() -> void:
	await set_up(Vector3.ZERO)
	_add_panel()
	await frames(12)
	check(_points().get_sample_count() > 0, "shown: it asks")
	panel.visible = false
	await frames(1)
	var before: int = _points().get_sample_count()
	check(not panel.is_processing(), "hidden: it rests")
	await frames(12)
	check_equal(_points().get_sample_count(), before, "no sample is taken")
	panel.visible = true
	await frames(3)
	check(_points().get_sample_count() > before, "shown again: it asks")
	panel.device = null
	await frames(2)
	check((panel.get_node("%State") as Label).text.begins_with("No device"), "without a device it says so")
	panel.free()
	device.free()


func _add_panel() -> void:
	panel = load(PANEL).instantiate()
	panel.device = device
	add(panel)


func _points() -> Control:
	return panel.get_node("%Points")


func _push() -> Control:
	return panel.get_node("%Push")


func _last(strip: Control, curve: int) -> float:
	var values: PackedFloat32Array = strip.get_curve(curve)
	return values[values.size() - 1] if values.size() > 0 else NAN
