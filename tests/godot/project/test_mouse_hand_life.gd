## SpidarGMouseHand: when it acts, what it leaves behind, what it does with bad values, and what shows the depth.
extends "res://mouse_hand_scene.gd"

const Turning := preload("res://addons/spidar_g/nodes/mouse_hand/turning.gd")


func test_it_adds_the_actions_that_the_project_lacks_and_no_others() -> void:
	_forget_actions()
	InputMap.add_action(&"spidar_g_grasp")
	var g := InputEventKey.new()
	g.physical_keycode = KEY_G
	InputMap.action_add_event(&"spidar_g_grasp", g)
	await set_up_mouse(func(node: SpidarGMouseHand) -> void:
		node.move_up_action = &"my_up"
		node.turn_action = &"")
	check_equal(InputMap.action_get_events(&"spidar_g_grasp").size(), 1, "the project's action stays as it is")
	button(MOUSE_BUTTON_LEFT, true)
	await settle()
	check(grip_closed() < deg_to_rad(6.0), "the left button is not bound")
	key(KEY_G, true)
	await settle()
	check(grip_closed() > deg_to_rad(45.0), "the project's key is")
	key(KEY_G, false)
	check(InputMap.has_action(&"my_up") and not InputMap.has_action(&"spidar_g_move_up"), "a name of the scene's own")
	await hold_key(KEY_E, 30)
	check(mouse.position_m.y > 0.05, "and its key: %s" % mouse.position_m)
	check(not InputMap.has_action(&"spidar_g_turn"), "an empty name is no action")
	button(MOUSE_BUTTON_RIGHT, true)
	move_cursor(Vector2.ZERO, Vector2(40.0, 0.0))
	await physics_frames(2)
	check_equal(mouse.turn_rad, Vector3.ZERO, "nothing turns then")
	_forget_actions()


func test_the_user_interface_takes_the_mouse_first() -> void:
	await set_up_mouse()
	var cover := Control.new()
	cover.size = tree.root.get_visible_rect().size
	add(cover)
	await frames(2)
	var at_px: Vector2 = camera.unproject_position(Vector3(0.05, 0.0, 0.0))
	move_cursor(at_px)
	button(MOUSE_BUTTON_LEFT, true, at_px)
	await settle()
	check_grip_at(Vector3.ZERO, "a control under the cursor takes the motion")
	check(grip_closed() < deg_to_rad(6.0), "and the button")
	button(MOUSE_BUTTON_LEFT, false, at_px)
	cover.free()
	var field := LineEdit.new()
	add(field)
	field.grab_focus()
	await hold_key(KEY_D, 20)
	check_equal(mouse.position_m, Vector3.ZERO, "keys that are written move nothing")
	field.free()
	await hold_key(KEY_D, 20)
	check(mouse.position_m.x > 0.02, "without the field they do")


func test_disabled_it_does_nothing_and_then_goes_on_from_the_grip() -> void:
	await set_up_mouse()
	button(MOUSE_BUTTON_RIGHT, true)
	mouse.enabled = false
	check(not mouse.is_acting() and not mouse.is_physics_processing(), "does not run")
	check(not mouse.is_processing_unhandled_input(), "hears nothing")
	check(not mouse._turning.by_mouse, "lets the cursor go")
	await frames(2)
	check(cue() == null, "draws nothing")
	point_at(Vector3(0.05, 0.0, 0.0))
	await settle()
	check_grip_at(Vector3.ZERO, "the cursor moves nothing")
	await move_to(Vector3(0.0, 0.03, 0.02), 0.0, 30)
	await settle()
	mouse.enabled = true
	await settle()
	check_grip_at(Vector3(0.0, 0.03, 0.02), "it goes on from where a script brought the grip")


func test_it_acts_only_on_a_simulated_device() -> void:
	await set_up_mouse()
	check(mouse.is_acting(), "at first")
	device.enabled = false
	await frames(3)
	check(not mouse.is_acting(), "not on a closed device")
	device.enabled = true
	await frames(3)
	check(mouse.is_acting(), "on a device that opens again")
	var path: String = "user://mouse_hand.rec"
	device.start_recording(path)
	await physics_frames(20)
	device.stop_recording()
	device.start_replay(path)
	await frames(3)
	check(not device.is_simulated() and not mouse.is_acting(), "not while a recording has the grip")
	device.stop_replay()
	await frames(3)
	check(mouse.is_acting(), "afterwards again")
	DirAccess.remove_absolute(path)


func test_it_takes_a_device_elsewhere_and_warns_without_one() -> void:
	await set_up(Vector3.ZERO)
	add_camera(Vector3(0.0, 0.0, 0.6), Vector3.ZERO)
	mouse = SpidarGMouseHand.new()
	add(mouse)
	await frames(2)
	check(not mouse.is_acting(), "without a device it rests")
	var warnings: PackedStringArray = mouse._get_configuration_warnings()
	check(warnings.size() == 1 and warnings[0].contains("make it a child"), "and says what to do: %s" % warnings)
	mouse.spidar = device
	check(mouse.is_acting() and mouse._get_configuration_warnings().is_empty(), "with one it acts")
	point_at(Vector3(0.05, 0.02, 0.0))
	await settle()
	check_grip_at(Vector3(0.05, 0.02, 0.0), "on a device that is not its parent")
	device.free()
	await physics_frames(3)
	check(not mouse.is_acting(), "it rests when the device is gone")


func test_no_camera_moves_nothing() -> void:
	await set_up_mouse()
	camera.free()
	move_cursor(Vector2(100.0, 100.0))
	notch(MOUSE_BUTTON_WHEEL_UP, 3)
	await settle()
	check_grip_at(Vector3.ZERO, "without a camera")


func test_the_cursor_is_let_go_when_the_node_rests() -> void:
	for way: String in ["leaves the tree", "paused", "disabled", "focus"]:
		await set_up_mouse()
		button(MOUSE_BUTTON_RIGHT, true)
		# A headless Godot captures no cursor; tests/play/run_mouse_tests.py has one that does.
		var turning: Turning = mouse._turning
		check(turning.by_mouse, "%s: the mouse turns the grip" % way)
		match way:
			"leaves the tree":
				device.remove_child(mouse)
				mouse.free()
			"paused":
				tree.paused = true
			"disabled":
				mouse.process_mode = Node.PROCESS_MODE_DISABLED
			"focus":
				tree.root.propagate_notification(Node.NOTIFICATION_WM_WINDOW_FOCUS_OUT)
		await frames(1)
		tree.paused = false
		check(not turning.by_mouse, "%s: no more" % way)
		device.free()
		await frames(1)


func test_bad_values_are_refused_and_change_nothing() -> void:
	await set_up_mouse()
	var ranges: Dictionary[StringName, Array] = {
		&"reach": [NAN, -1.0, 0.0, 10.0], &"turn_limit": [NAN, -0.1, 3.0], &"squeeze": [NAN, 0.0, INF],
		&"key_speed": [NAN, -1.0, 5.0], &"key_turn_speed": [NAN, -1.0, 10.0], &"wheel_step": [NAN, -0.1, 1.0],
		&"drag_turn": [NAN, -0.1, 1.0], &"close_speed": [NAN, 0.0, 100.0], &"grasp_angle_rad": [NAN, 4.0],
		&"start": [Vector3(NAN, 0.0, 0.0)], &"position_m": [Vector3(0.0, INF, 0.0)], &"turn_rad": [Vector3(0.0, 0.0, NAN)],
	}
	for field: StringName in ranges:
		var before: Variant = mouse.get(field)
		for value: Variant in ranges[field]:
			mouse.set(field, value)
			check_equal(mouse.get(field), before, "%s = %s is refused" % [field, value])
	mouse.follow(Transform3D(Basis.IDENTITY, Vector3(NAN, 0.0, 0.0)), 0.0, false)
	mouse.follow(Transform3D.IDENTITY, NAN, false)
	mouse.recenter(Vector3(NAN, 0.0, 0.0))
	await settle()
	check_grip_at(Vector3.ZERO, "after all that")


func test_the_depth_cue_stands_on_the_first_surface_below() -> void:
	await set_up_mouse()
	point_at(Vector3(0.05, 0.02, 0.0))
	await settle()
	var line: Transform3D = cue().global_transform
	check(cue().visible, "shown")
	check_near(line.origin.distance_to(Vector3(grip().origin.x, FLOOR_Y, grip().origin.z)), 0.0, 0.001, "ring on the floor")
	check_near((line * Vector3.UP).distance_to(grip().origin), 0.0, 0.001, "line up to the grip")
	check_near(line.basis.x.length(), DepthCue.RING_RADIUS_M, 1e-5, "radius of the ring")
	check_equal(cue().cast_shadow, GeometryInstance3D.SHADOW_CASTING_SETTING_OFF, "no shadow")
	add_box(Vector3(0.05, 0.02, 0.05), Vector3(0.05, FLOOR_Y + 0.03, 0.0), 0.0)
	await physics_frames(3)
	check_near(cue().global_position.y, FLOOR_Y + 0.04, 0.001, "on a box above the floor")
	mouse.depth_cue_mask = 2
	await physics_frames(2)
	check(not cue().visible, "nothing below on that layer: nothing is drawn")
	mouse.show_depth_cue = false
	await frames(2)
	check(cue() == null, "switched off it is gone")


func test_the_depth_cue_passes_through_the_held_body_and_is_not_felt() -> void:
	await set_up_mouse()
	var body: RigidBody3D = add_free_box(Vector3(0.04, 0.05, 0.04), 0.1)
	await physics_frames(10)
	point_at(body.global_position)
	await settle()
	button(MOUSE_BUTTON_LEFT, true)
	await settle()
	point_at(body.global_position + Vector3(0.0, 0.06, 0.0))
	await settle()
	check_equal(hand.get_held_body(), body, "held")
	check_near(cue().global_position.y, FLOOR_Y, 0.002, "the ring is on the floor, not on the held body")
	for shape: Dictionary in hand.get_shapes_in_reach():
		check(shape["collider"] is PhysicsBody3D, "only bodies are felt")
	button(MOUSE_BUTTON_LEFT, false)


func _forget_actions() -> void:
	for action: StringName in InputMap.get_actions():
		if action.begins_with("spidar_g_") and action != &"spidar_g_panic" or action == &"my_up":
			InputMap.erase_action(action)
