## SpidarGMouseHand: what mouse, wheel and keys do to the simulated grip.
extends "res://mouse_hand_scene.gd"


func test_the_grip_follows_the_cursor_in_the_view_plane() -> void:
	await set_up_mouse()
	for wanted: Vector3 in [Vector3(0.05, 0.03, 0.0), Vector3(-0.06, -0.02, 0.0)]:
		point_at(wanted)
		await settle()
		check_grip_at(wanted, "under the cursor, at the same depth")
	point_at(Vector3(0.0, -0.08, 0.0))
	await settle()
	check(device.get_simulated_truth()["strings_wrench"][1] > 0.3, "pressed on the floor the hand feels it")


func test_a_turned_and_scaled_device_has_its_grip_under_the_cursor_too() -> void:
	scale = 5.0
	await set_up(Vector3.ZERO)
	device.transform = Transform3D(Basis(Vector3(1.0, 1.0, 0.0).normalized(), 0.6), Vector3(2.0, 3.0, 0.5))
	add_camera(device.position + Vector3(0.5, 1.0, 3.0), device.position)
	mouse = SpidarGMouseHand.new()
	device.add_child(mouse)
	await settle()
	var wanted: Vector3 = device.position + 0.25 * camera.global_basis.x + 0.15 * camera.global_basis.y
	point_at(wanted)
	await settle()
	check_near(grip().origin.distance_to(wanted), 0.0, scale * NEAR_M, "under the cursor")


func test_the_wheel_moves_in_depth_along_the_ground() -> void:
	await set_up_mouse()
	add_camera(Vector3(0.0, 0.3, 0.5), Vector3.ZERO)
	notch(MOUSE_BUTTON_WHEEL_UP, 5)
	await settle()
	check_grip_at(Vector3(0.0, 0.0, -0.03), "5 notches away of 6 mm, at the same height")
	notch(MOUSE_BUTTON_WHEEL_DOWN, 8)
	await settle()
	check_grip_at(Vector3(0.0, 0.0, 0.018), "8 notches near")


func test_from_straight_above_the_wheel_moves_along_the_view() -> void:
	await set_up_mouse()
	add_camera(Vector3(0.0, 0.6, 0.0), Vector3.ZERO, Vector3.FORWARD)
	notch(MOUSE_BUTTON_WHEEL_UP, 5)
	await settle()
	check_grip_at(Vector3(0.0, -0.03, 0.0), "down")


func test_dragging_with_the_right_button_turns_and_does_not_move() -> void:
	await set_up_mouse()
	button(MOUSE_BUTTON_RIGHT, true)
	move_cursor(Vector2(300.0, 200.0), Vector2(40.0, 0.0))
	await settle()
	check_near(grip().basis.get_euler().y, 0.2, 0.02, "yaw, rad, of 40 px")
	check_grip_at(Vector3.ZERO, "it does not move")
	move_cursor(Vector2(300.0, 200.0), Vector2(0.0, 4000.0))
	await settle()
	check_near(mouse.turn_rad.x, mouse.turn_limit, 1e-5, "the hand's pitch is at its limit")
	check_near(grip().basis.get_euler().x, mouse.turn_limit, 0.05, "and so is the grip's, but for the strings' pull")
	button(MOUSE_BUTTON_RIGHT, false)
	point_at(Vector3(0.03, 0.0, 0.0))
	await settle()
	check_near(grip().origin.x, 0.03, NEAR_M, "afterwards the cursor moves it again")


func test_the_left_button_closes_while_it_is_held() -> void:
	await set_up_mouse()
	button(MOUSE_BUTTON_LEFT, true)
	await settle()
	check(grip_closed() > deg_to_rad(45.0), "closed: %.1f degrees" % rad_to_deg(grip_closed()))
	button(MOUSE_BUTTON_LEFT, false)
	await settle()
	check_near(grip_closed(), SpidarGMouseHand.OPEN_ANGLE_RAD, deg_to_rad(2.0), "open again")


func test_closing_stops_when_the_fingers_are_pushed_back() -> void:
	await set_up_mouse(func(node: SpidarGMouseHand) -> void: node.squeeze = 0.025)
	var body: RigidBody3D = add_free_box(Vector3(0.04, 0.05, 0.04), 0.1)
	await physics_frames(10)
	point_at(body.global_position)
	await settle()
	button(MOUSE_BUTTON_LEFT, true)
	await settle()
	check_equal(hand.get_held_body(), body, "held")
	var squeeze: float = -device.get_achieved_wrench()[6]
	check_near(squeeze, mouse.squeeze, 0.004, "squeezed as hard as squeeze, N m")
	var end: float = device.get_effective_config().jaw_closed_angle
	check(mouse.grasp_angle_rad < end - 0.1, "and not closed to the end: %f rad of %f" % [mouse.grasp_angle_rad, end])
	var height: float = body.global_position.y
	point_at(body.global_position + Vector3(0.0, 0.06, 0.0))
	await settle()
	print("INFO squeezed with %.3f N m, lifted by %.1f mm" % [squeeze, 1e3 * (body.global_position.y - height)])
	check(body.global_position.y > height + 0.05, "and lifted: %f m" % (body.global_position.y - height))
	button(MOUSE_BUTTON_LEFT, false)
	await settle()
	check(hand.get_held_body() == null, "let go")


func test_a_narrow_body_is_pressed_hard_too() -> void:
	for width: float in [0.01, 0.02, 0.06]:
		await set_up_mouse()
		var body: RigidBody3D = add_free_box(Vector3(width, 0.05, 0.03), 0.1)
		await physics_frames(10)
		point_at(body.global_position)
		await settle()
		button(MOUSE_BUTTON_LEFT, true)
		await physics_frames(120)
		var squeeze: float = -device.get_achieved_wrench()[6]
		print("INFO %.0f mm wide: squeezed with %.3f N m" % [1e3 * width, squeeze])
		check_equal(hand.get_held_body(), body, "%.0f mm wide: held" % (1e3 * width))
		check(squeeze > 0.045 and squeeze < mouse.squeeze + 0.01, "%.0f mm: %.3f N m" % [1e3 * width, squeeze])
		button(MOUSE_BUTTON_LEFT, false)
		device.free()
		body.free()
		await frames(2)


func test_empty_fingers_close_to_the_end_of_the_jaws_and_no_farther() -> void:
	await set_up_mouse()
	button(MOUSE_BUTTON_LEFT, true)
	await physics_frames(150)
	check(device.get_grasp_phase() == SpidarG.GRASP_GRASPED, "closed, not closed too far")
	check_near(grip_closed(), device.get_effective_config().jaw_closed_angle, deg_to_rad(2.0), "at the end of the jaws' way")
	button(MOUSE_BUTTON_LEFT, false)


func test_keys_move_and_turn_at_their_speeds() -> void:
	await set_up_mouse()
	var ways: Dictionary[Key, Vector3] = {
		KEY_A: Vector3.LEFT, KEY_D: Vector3.RIGHT, KEY_Q: Vector3.DOWN, KEY_E: Vector3.UP,
		KEY_W: Vector3.FORWARD, KEY_S: Vector3.BACK,
	}
	for code: Key in ways:
		mouse.recenter()
		await hold_key(code, 30)
		var way: Vector3 = mouse.position_m
		check_near(way.dot(ways[code]), 0.06, 0.01, "%s for half a second, m" % OS.get_keycode_string(code))
		check_near(way.cross(ways[code]).length(), 0.0, 1e-6, "%s: nothing sideways" % OS.get_keycode_string(code))
	await settle()
	check_near(grip().origin.z, 0.06, 0.01, "the grip follows the last of them")
	var turns: Dictionary[Key, Vector3] = {
		KEY_LEFT: Vector3.UP, KEY_RIGHT: Vector3.DOWN, KEY_DOWN: Vector3.RIGHT, KEY_UP: Vector3.LEFT,
		KEY_PAGEUP: Vector3.BACK, KEY_PAGEDOWN: Vector3.FORWARD,
	}
	for code: Key in turns:
		mouse.recenter()
		await hold_key(code, 30)
		var turn: float = mouse.turn_rad.dot(turns[code])
		check_near(turn, 0.45, 0.05, "%s for half a second, rad" % OS.get_keycode_string(code))


func test_the_clutch_holds_the_grip_and_keeps_its_distance_to_the_cursor() -> void:
	await set_up_mouse()
	point_at(Vector3(0.04, 0.0, 0.0))
	await settle()
	key(KEY_SHIFT, true)
	check(mouse.is_clutched(), "Shift is the clutch")
	point_at(Vector3(-0.04, 0.02, 0.0))
	notch(MOUSE_BUTTON_WHEEL_UP, 3)
	await settle()
	check_grip_at(Vector3(0.04, 0.0, 0.0), "the cursor moves and the grip stays")
	key(KEY_SHIFT, false)
	point_at(Vector3(-0.04, 0.02, 0.0))
	await settle()
	check_grip_at(Vector3(0.04, 0.0, 0.0), "it does not jump to the cursor afterwards")
	point_at(Vector3(-0.06, 0.02, 0.0))
	await settle()
	check_grip_at(Vector3(0.02, 0.0, 0.0), "it goes on from where it stands")
	mouse.clutched = true
	point_at(Vector3(0.1, 0.02, 0.0))
	await settle()
	check_grip_at(Vector3(0.02, 0.0, 0.0), "a script can press the clutch too")
	mouse.clutched = false
	mouse.recenter()
	point_at(Vector3(0.03, 0.01, 0.0))
	await settle()
	check_grip_at(Vector3(0.03, 0.01, 0.0), "recenter() brings it under the cursor again")


func test_the_grip_is_kept_within_reach() -> void:
	await set_up_mouse()
	mouse.reach = 0.05
	point_at(Vector3(0.3, 0.0, 0.0))
	await settle()
	check_grip_at(Vector3(0.05, 0.0, 0.0), "at the limit")


func test_follow_goes_on_from_a_pose_and_recenter_goes_to_the_start() -> void:
	await set_up_mouse(func(node: SpidarGMouseHand) -> void: node.start = Vector3(0.02, 0.03, 0.0))
	await settle()
	check_grip_at(Vector3(0.02, 0.03, 0.0), "it begins at start")
	mouse.follow(Transform3D(Basis(Vector3.UP, 0.3), Vector3(-0.03, 0.0, 0.02)), deg_to_rad(30.0), true)
	await settle()
	check_grip_at(Vector3(-0.03, 0.0, 0.02), "the pose of follow()")
	check_near(grip().basis.get_euler().y, 0.3, 0.02, "and its turn")
	check(grip_closed() > deg_to_rad(30.0), "the fingers stay closed")
	mouse.recenter()
	await settle()
	check_grip_at(Vector3(0.02, 0.03, 0.0), "recenter()")
	check_near(grip().basis.get_euler().y, 0.0, 0.02, "upright")
	check(grip_closed() < deg_to_rad(6.0), "and open")
