## A rigid grip: fingers that a button, an action or a sensor closes, felt without a grasp torque.
extends "res://hand_scene.gd"

const X5R: int = 4
const X4: int = 6
const BOX := Vector3(0.1, 0.12, 0.1)


func _set_up(which: int, source: SpidarGConfig.GraspSource) -> void:
	preset = which
	scale = 4.0
	grasp_source = source
	at = Vector3.ZERO
	angle = 0.0
	await set_up(Vector3.ZERO)


func _take_away(body: Node) -> void:
	device.queue_free()
	body.queue_free()
	await physics_frames(2)


func test_a_box_is_held_by_a_button_and_its_weight_is_felt() -> void:
	for which: int in [X5R, X4]:
		await _set_up(which, SpidarGConfig.GRASP_BUTTON)
		var empty: PackedFloat64Array = await mean_felt(30)
		var body: RigidBody3D = add_free_box(BOX, 0.1)
		await physics_frames(10)
		await move_to(body.global_position, SQUEEZE_ANGLE, 60)
		await physics_frames(20)
		check_near(device.get_grasp_angle(), 0.0, 1e-9, "the simulated hand's fingers do not count")
		check_equal(hand.get_held_body(), null, "nothing is held without the button")
		device.set_simulated_buttons(1)
		await physics_frames(60)
		check_equal(hand.get_held_body(), body, "the box is held")
		check_near(device.get_grasp_angle(), deg_to_rad(50.0), 1e-6, "the fingers are closed")
		check_near(hand.get_held_width(), BOX.x, 0.004, "held at its width")
		await move_to(at + Vector3(0.0, 0.05, 0.0), 0.0, 60)
		await physics_frames(60)
		check(body.global_position.y > FLOOR_Y + 0.5 * BOX.y + 0.03, "lifted: %s" % body.global_position)
		var felt: PackedFloat64Array = await mean_felt(30)
		check_near(felt[1] - empty[1], -0.1 * GRAVITY, 0.05, "weight felt (N)")
		check_near(felt[6], 0.0, 1e-12, "no grasp torque")
		device.set_simulated_buttons(0)
		await physics_frames(60)
		check_equal(hand.get_held_body(), null, "let go")
		check_near(device.get_grasp_angle(), 0.0, 1e-6, "the fingers are open")
		await _take_away(body)


func test_an_action_closes_the_fingers_as_far_as_it_is_pressed() -> void:
	InputMap.add_action("spidar_g_grasp", 0.1)
	await _set_up(X5R, SpidarGConfig.GRASP_ACTION)
	Input.action_press("spidar_g_grasp", 0.5)
	await physics_frames(60)
	check_near(device.get_grasp_angle(), deg_to_rad(25.0), 1e-4, "half closed")
	device.set_simulated_buttons(1)
	await physics_frames(30)
	check_near(device.get_grasp_angle(), deg_to_rad(25.0), 1e-4, "the button does not count")
	Input.action_release("spidar_g_grasp")
	await physics_frames(60)
	check_near(device.get_grasp_angle(), 0.0, 1e-4, "open")
	InputMap.erase_action("spidar_g_grasp")
	var config := SpidarGConfig.new()
	config.grasp_source = SpidarGConfig.GRASP_ACTION
	check(config.get_problem().contains("grasp_action"), "an action that is missing is named: " + config.get_problem())


func test_the_simulated_hand_closes_them_by_itself() -> void:
	await _set_up(X5R, SpidarGConfig.GRASP_AUTOMATIC)
	await move_to(Vector3.ZERO, deg_to_rad(20.0), 30)
	await physics_frames(60)
	check_near(device.get_grasp_angle(), deg_to_rad(20.0), 1e-3, "as far as the hand closes")
	var truth: float = device.get_simulated_truth()["grasp_angle"]
	check_near(truth, device.get_grasp_angle(), 1e-12, "and that is the truth")


func test_closed_fingers_are_felt_at_a_wall() -> void:
	await _set_up(X5R, SpidarGConfig.GRASP_BUTTON)
	await move_to(Vector3(-0.1, 0.02, 0.0), 0.0, 60)
	var wall: PhysicsBody3D = add_box(Vector3(0.2, 0.4, 0.4), Vector3(0.2, 0.02, 0.0), 0.0)
	device.set_simulated_buttons(1)
	await physics_frames(40)
	# Outer faces of the closed fingers, 6 mm beside the middle of the grip, reach the wall at 0.076.
	await move_to(Vector3(0.07, 0.02, 0.0), 0.0, 60)
	await physics_frames(30)
	var beside: PackedFloat64Array = await mean_felt(20)
	check_near(beside[0], 0.0, 0.05, "not yet at the wall (N)")
	await move_to(Vector3(0.1, 0.02, 0.0), 0.0, 60)
	await physics_frames(30)
	var felt: PackedFloat64Array = await mean_felt(20)
	check(felt[0] < -0.3, "pushed back from the wall: %f N" % felt[0])
	check_near(felt[6], 0.0, 1e-12, "no grasp torque")
	await _take_away(wall)


func test_bad_settings_are_named() -> void:
	var config := SpidarGConfig.new()
	for bad: Array in [["grasp_source", 9], ["grasp_button", 12], ["grasp_sensor", 8]]:
		config = SpidarGConfig.new()
		config.set(bad[0], bad[1])
		check(config.get_problem().contains(bad[0]), "%s: %s" % [bad[0], config.get_problem()])
	config = SpidarGConfig.new()
	config.preset = X5R
	config.grasp_source = SpidarGConfig.GRASP_SENSOR
	config.grasp_sensor_open = 5.0
	config.grasp_sensor_closed = 5.0
	check(config.get_problem().contains("sensor_closed"), config.get_problem())
