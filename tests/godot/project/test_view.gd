## SpidarGView: colours, and that what it draws is where the device is.
extends "res://test_case.gd"

const View := preload("res://addons/spidar_g/nodes/spidar_g_view.gd")


func test_strings_are_coloured_by_tension() -> void:
	check_equal(View.tension_colour(0.0, 10.0), View.SLACK_COLOUR, "slack")
	check_equal(View.tension_colour(NAN, 10.0), View.SLACK_COLOUR, "no number")
	check_equal(View.tension_colour(10.0, 10.0), View.HIGH_COLOUR, "at the limit")
	check_equal(View.tension_colour(50.0, 10.0), View.HIGH_COLOUR, "above the limit")
	check_equal(View.tension_colour(10.0 * 4.0 / 9.0, 10.0), View.MIDDLE_COLOUR, "two thirds of the scale")
	var before: float = 1.0
	for i: int in range(1, 100):
		var colour: Color = View.tension_colour(0.1 * i, 10.0)
		check(colour.s > 5.0 * View.SLACK_COLOUR.s, "%.1f N never looks grey" % (0.1 * i))
		check(colour.h < before, "%.1f N is further from blue, nearer to red than less" % (0.1 * i))
		before = colour.h


func test_parts_are_where_the_device_is() -> void:
	var device: SpidarG = ideal_device()
	device.transform = Transform3D(Basis(Vector3.UP, 0.7), Vector3(1.0, 2.0, 3.0))
	device.workspace_scale = 2.0
	var hand := SpidarGHand.new()
	var view := View.new()
	device.add_child(hand)
	device.add_child(view)
	add(device)
	var target := Transform3D(
		device.basis * Basis(Vector3(1.0, 1.0, 0.0).normalized(), 0.3), Vector3(1.05, 2.04, 2.97)
	)
	for _i: int in 90:
		device.set_simulated_hand_target(target, 0.4)
		await physics_frames(1)
	await frames(2)
	var grip: Transform3D = device.get_grip_transform()
	check_near(grip.origin.distance_to(target.origin), 0.0, 0.001, "the hand got there")
	for pole: int in 2:
		var drawn: Transform3D = view._parts._poles[pole].global_transform
		var true_pole: Transform3D = device.get_pole_transform(pole)
		check_near(drawn.origin.distance_to(grip.origin), 0.0, 1e-5, "pole %d passes the centre" % pole)
		check_near(drawn.basis.x.normalized().dot(true_pole.basis.x), 1.0, 1e-5, "along pole %d" % pole)
		check_near(drawn.basis.x.length(), 2.0, 1e-4, "drawn at the workspace's scale")
	for side: int in 2:
		var pad: Vector3 = view._parts._pads[side].global_position
		var middle: Vector3 = hand.get_pad_transform(side) * Vector3(0.25 * hand.get_pad_radius(), 0.0, 0.0)
		check_near(pad.distance_to(middle), 0.0, 1e-5, "pad %d" % side)
		var outward: Vector3 = (hand.get_pad_position(side) - hand.get_pad_position(1 - side)).normalized()
		var disc: Vector3 = view._parts._pads[side].global_basis.y.normalized()
		check_near(disc.dot(outward), 1.0, 1e-4, "pad %d's axis looks outward" % side)


func test_a_hidden_view_does_not_follow_and_catches_up() -> void:
	var device: SpidarG = ideal_device()
	var view := View.new()
	device.add_child(view)
	add(device)
	for _i: int in 30:
		device.set_simulated_hand_target(Transform3D.IDENTITY, 0.0)
		await physics_frames(1)
	await frames(2)
	view.visible = false
	var where: Vector3 = view._parts._poles[0].global_position
	for _i: int in 60:
		device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, Vector3(0.05, 0.0, 0.0)), 0.0)
		await physics_frames(1)
	await frames(2)
	check_equal(view._parts._poles[0].global_position, where, "hidden: not moved")
	view.visible = true
	await frames(2)
	check_near(view._parts._poles[0].global_position.x, 0.05, 0.001, "shown: caught up")


func test_a_grip_that_is_not_shown_does_not_follow_and_catches_up() -> void:
	var device: SpidarG = ideal_device()
	var view := View.new()
	device.add_child(view)
	add(device)
	await go_to(device, Vector3.ZERO)
	view.show_grip = false
	await frames(2)
	var pole: Vector3 = view._parts._poles[0].global_position
	await go_to(device, Vector3(0.05, 0.0, 0.0))
	check_equal(view._parts._poles[0].global_position, pole, "a pole that is not shown is not placed")
	view.show_grip = true
	await frames(2)
	check_near(view._parts._poles[0].global_position.x, 0.05, 0.001, "shown: caught up")


func go_to(device: SpidarG, where: Vector3) -> void:
	for _i: int in 60:
		device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, where), 0.0)
		await physics_frames(1)
	await frames(2)


func test_a_view_without_a_device_draws_nothing() -> void:
	var lonely := View.new()
	add(lonely)
	await frames(2)
	check_equal(lonely.get_child_count(), 0, "no parts")
	check(not lonely.is_processing(), "does not run")
