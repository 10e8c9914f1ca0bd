## SpidarGTracker: what an XRController3D sees of a device, without any XR interface.
extends "res://hand_scene.gd"

const Tracker := preload("res://addons/spidar_g/nodes/spidar_g_tracker.gd")
const NEAR_M: float = 1e-4

var tracker: Tracker
var origin: XROrigin3D
var controller: XRController3D
var pressed: PackedStringArray = []
var released: PackedStringArray = []
var floats: Dictionary[String, int] = {}
## Largest distance between controller and grip, as a script of a later priority sees it in its tick, m.
var seen_apart_m: float = 0.0


class Witness extends Node:
	var look: Callable

	func _init() -> void:
		process_physics_priority = 100

	func _physics_process(_delta: float) -> void:
		look.call()


func test_a_controller_follows_the_grip_at_physics_rate() -> void:
	for world_scale: float in [1.0, 2.5]:
		for workspace_scale: float in [1.0, 4.0]:
			await _set_up(workspace_scale)
			origin.transform = Transform3D(Basis(Vector3.UP, 0.7), Vector3(1, 0, -2))
			origin.world_scale = world_scale
			await physics_frames(2)
			seen_apart_m = 0.0
			await _swing(60)
			var text: String = "world scale %s, workspace scale %s" % [world_scale, workspace_scale]
			check(device.get_grip_transform().origin.distance_to(device.position) > 0.01, text + ": the hand moved")
			check(controller.get_is_active() and controller.get_has_tracking_data(), text + ": active")
			check_near(seen_apart_m, 0.0, NEAR_M, text + ": apart in a tick")
			await _leave()


func test_a_controller_follows_on_a_lift_with_the_velocity_against_its_origin() -> void:
	await _set_up()
	for _i: int in 40:
		origin.position += Vector3(0, 1, 0) / 60.0
		device.position += Vector3(0, 1, 0) / 60.0
		device.set_simulated_hand_target(device.transform, 0.0)
		await physics_frames(1)
	check_near(seen_apart_m, 0.0, NEAR_M, "apart in a tick")
	var velocity: Vector3 = controller.get_pose().linear_velocity
	check(velocity.length() < 0.03, "at rest on the lift: %s m/s" % velocity)
	await _leave()


func test_poses_have_velocities_in_the_axes_of_the_origin() -> void:
	await _set_up(2.0)
	origin.transform = Transform3D(Basis(Vector3.UP, PI / 2), Vector3(1, 0, -2))
	origin.world_scale = 4.0
	var turning := Vector3.ZERO
	for i: int in 120:
		# World x is the origin's z: 0.1 m/s of the device, 0.2 of the scene, 0.05 of the play space. A turn of 0.4 rad/s about y.
		var turn: Basis = Basis(Vector3.UP, 0.4 * i / 60.0)
		device.set_simulated_hand_target(device.transform * Transform3D(turn, Vector3(0.2 * i / 60.0 - 0.2, 0, 0)), 0.0)
		await physics_frames(1)
		# The simulated hand swings a little about its turn.
		if i >= 60:
			turning += controller.get_pose().angular_velocity / 60.0
	var pose: XRPose = controller.get_pose()
	check_near((pose.linear_velocity - Vector3(0, 0, 0.05)).length(), 0.0, 0.004, "linear: %s" % pose.linear_velocity)
	check_near((turning - Vector3(0, 0.4, 0)).length(), 0.0, 0.04, "angular: %s" % turning)
	check_equal(pose.tracking_confidence, XRPose.XR_TRACKING_CONFIDENCE_HIGH, "confidence")
	await _leave()


func test_the_tracker_has_hand_profile_and_three_poses() -> void:
	await _set_up()
	tracker.aim_offset = Transform3D(Basis(Vector3.RIGHT, -0.5), Vector3(0, 0, -0.05))
	await physics_frames(2)
	var published := XRServer.get_tracker(&"right_hand") as XRControllerTracker
	check(published != null, "published as the right hand")
	check_equal(published.hand, XRPositionalTracker.TRACKER_HAND_RIGHT, "its hand")
	check_equal(controller.get_tracker_hand(), XRPositionalTracker.TRACKER_HAND_RIGHT, "the controller's hand")
	check_equal(published.profile, Tracker.DEFAULT_PROFILE, "its profile")
	check_equal(published.type, XRServer.TRACKER_CONTROLLER, "a controller")
	for pose: StringName in [&"default", &"grip", &"aim"]:
		check(published.has_pose(pose), "has the pose %s" % pose)
	var aim: Transform3D = published.get_pose(&"grip").transform * tracker.aim_offset
	check(published.get_pose(&"aim").transform.is_equal_approx(aim), "aim is placed by its offset")
	tracker.hand = Tracker.Hand.LEFT
	await physics_frames(2)
	check(XRServer.get_tracker(&"right_hand") == null and XRServer.get_tracker(&"left_hand") != null, "the other hand")
	check(not controller.get_is_active(), "a controller of the right hand is not active then")
	tracker.custom_name = &"my_device"
	tracker.hand = Tracker.Hand.OTHER
	await physics_frames(2)
	check(XRServer.get_tracker(&"left_hand") == null and XRServer.get_tracker(&"my_device") != null, "a name of one's own")
	await _leave()
	check(XRServer.get_tracker(&"my_device") == null, "gone with its node")


func test_closing_the_grasp_is_the_input_grip_and_clicks_with_hysteresis() -> void:
	await _set_up()
	await move_to(Vector3.ZERO, 0.0, 20)
	check_near(controller.get_float("grip"), 0.0, 0.02, "open")
	check(released.is_empty() and pressed.is_empty(), "nothing is let go that was not pressed: %s" % released)
	await _grasp_slowly(0.0, deg_to_rad(50.0))
	check_near(controller.get_float("grip"), 1.0, 0.02, "closed")
	check(controller.is_button_pressed("grip_click"), "clicked")
	check_equal(pressed.count("grip_click"), 1, "pressed once")
	check(floats.get("grip", 0) > 10, "input_float_changed came: %s" % floats)
	var closed: float = deg_to_rad(50.0)
	angle = closed
	for part: float in [0.6, 0.75, 0.6, 0.75]:
		await move_to(Vector3.ZERO, part * closed, 120)
		await physics_frames(30)
	check_equal(released.count("grip_click"), 0, "not let go between the thresholds")
	await _grasp_slowly(0.75 * closed, 0.3 * closed)
	check_equal(released.count("grip_click"), 1, "let go below")
	await _leave()


func test_squeezing_is_the_input_trigger() -> void:
	await _set_up()
	device.add_child(SpidarGHand.new())
	device.forces_enabled = true
	await physics_frames(ARMING_FRAMES)
	await _grasp_slowly(0.0, deg_to_rad(40.0))
	check_near(controller.get_float("trigger"), 0.0, 0.02, "nothing between the pads, not closed")
	await _grasp_slowly(deg_to_rad(40.0), SQUEEZE_ANGLE)
	await physics_frames(30)
	var squeeze: float = (device.get_child(-1) as SpidarGHand).get_squeeze_torque()
	print("INFO squeeze of the closed pads: %.4f N m, trigger %.3f" % [squeeze, controller.get_float("trigger")])
	check(squeeze > 0.02, "squeezed: %f N m" % squeeze)
	check_near(controller.get_float("trigger"), minf(1.0, squeeze / tracker.full_squeeze), 0.01, "as a part of the full squeeze")
	tracker.full_squeeze = squeeze
	await physics_frames(5)
	check(controller.is_button_pressed("trigger_click"), "and clicks")
	await _grasp_slowly(SQUEEZE_ANGLE, 0.0)
	check(released.has("trigger_click"), "and lets go")
	await _leave()


func test_the_trigger_may_be_an_action_or_the_grasp() -> void:
	await _set_up()
	InputMap.add_action(&"test_trigger")
	device.config.grasp_action = "test_trigger"
	await physics_frames(5)
	tracker.trigger_source = Tracker.TriggerSource.ACTION
	Input.action_press(&"test_trigger", 0.8)
	await physics_frames(2)
	check_near(controller.get_float("trigger"), 0.8, 1e-6, "as far as the action is pressed")
	check(controller.is_button_pressed("trigger_click"), "clicked")
	Input.action_release(&"test_trigger")
	await physics_frames(2)
	check_near(controller.get_float("trigger"), 0.0, 1e-6, "let go")
	InputMap.erase_action(&"test_trigger")
	tracker.trigger_source = Tracker.TriggerSource.AUTOMATIC
	await _grasp_slowly(0.0, deg_to_rad(25.0))
	check_near(controller.get_float("trigger"), 0.5, 0.03, "without hand and action: the grasp")
	await _leave()


func test_the_buttons_of_the_device_are_inputs() -> void:
	await _set_up()
	for button: int in 3:
		device.set_simulated_buttons(1 << button)
		await physics_frames(3)
		check(controller.is_button_pressed(["ax_button", "by_button", "menu_button"][button]), "button %d is held" % button)
	device.set_simulated_buttons(0)
	await physics_frames(3)
	for input: String in ["ax_button", "by_button", "menu_button"]:
		check_equal(pressed.count(input), 1, "%s pressed once" % input)
		check_equal(released.count(input), 1, "%s let go once" % input)
	# Without a name.
	device.set_simulated_buttons(1 << 7)
	await physics_frames(3)
	check(not pressed.has(""), "a button without a name is no input")
	device.set_simulated_buttons(0)
	await _leave()


func test_a_device_in_fault_or_closed_is_not_active() -> void:
	await _set_up()
	device.set_simulated_buttons(1)
	await physics_frames(3)
	check(controller.is_button_pressed("ax_button"), "held before")
	device.panic_stop()
	await physics_frames(3)
	check_equal(device.get_state(), SpidarG.STATE_FAULT, "in fault")
	check(not controller.get_is_active() and not controller.get_has_tracking_data(), "not active in fault")
	check_equal(released.count("ax_button"), 1, "the button is let go")
	device.clear_fault()
	await physics_frames(3)
	check(controller.get_is_active(), "active again")
	device.enabled = false
	await physics_frames(3)
	check(not controller.get_is_active(), "not active while closed")
	check(not tracker.is_published(), "and not published")
	device.enabled = true
	await physics_frames(3)
	check(controller.get_is_active(), "active when it is open again")
	tracker.get_parent().remove_child(tracker)
	check(not controller.get_is_active() and XRServer.get_tracker(&"right_hand") == null, "gone with its node")
	device.add_child(tracker)
	await physics_frames(3)
	check(controller.get_is_active(), "and comes back with it")
	await _leave()


func test_of_two_of_one_name_the_second_does_nothing() -> void:
	await _set_up()
	var other_device: SpidarG = ideal_device()
	other_device.position.x = 1.0
	var other := Tracker.new()
	other_device.add_child(other)
	add(other_device)
	await physics_frames(3)
	check(tracker.is_published() and not other.is_published(), "the first stays")
	check(not other.is_physics_processing(), "the second costs nothing")
	check(other._get_configuration_warnings()[0].contains("right_hand"), "and warns")
	check_near(controller.global_position.distance_to(device.get_grip_transform().origin), 0.0, NEAR_M, "the first's place")
	other.hand = Tracker.Hand.LEFT
	await physics_frames(3)
	check(other.is_published(), "with another hand both are")
	other_device.free()
	# A controller of an XR interface.
	var real := XRControllerTracker.new()
	real.name = &"left_hand"
	XRServer.add_tracker(real)
	tracker.hand = Tracker.Hand.LEFT
	await physics_frames(3)
	check(not tracker.is_published() and XRServer.get_tracker(&"left_hand") == real, "a real controller stays")
	XRServer.remove_tracker(real)
	await _leave()


func test_the_place_in_the_play_space_is_calibrated_from_one_pose() -> void:
	await _set_up(2.0)
	origin.world_scale = 2.0
	origin.transform = Transform3D(Basis(Vector3.UP, 0.4), Vector3(3, 0, 0))
	device.set_simulated_hand_target(device.transform * Transform3D(Basis(Vector3.UP, 0.2), Vector3(0.06, 0.04, 0)), 0.0)
	await physics_frames(60)
	var known := Transform3D(Basis(Vector3.UP, 1.1), Vector3(0.3, 1.0, -0.4))
	check(tracker.calibrate_place(known), "taken")
	await physics_frames(2)
	var seen: Transform3D = controller.get_pose().transform
	check_near(seen.origin.distance_to(known.origin), 0.0, NEAR_M, "the controller is where it was held")
	check_near((seen.basis.x - known.basis.x).length(), 0.0, 2e-3, "and turned so")
	check_near(controller.position.distance_to(2.0 * known.origin), 0.0, NEAR_M, "the world scale multiplies its place")
	# The device put where it stands in the play space: controller and grip are one again.
	device.global_transform = tracker.get_scene_place()
	await physics_frames(3)
	seen_apart_m = 0.0
	await _swing(30)
	check_near(seen_apart_m, 0.0, NEAR_M, "apart in a tick")
	var tilted := Transform3D(Basis(Vector3(1, 0, 1).normalized(), 0.5), Vector3.ONE)
	check(tracker.calibrate_place(tilted), "tilted")
	check_near(tracker.device_transform.basis.y.y, 1.0, 1e-6, "the device stays upright")
	check(tracker.calibrate_place(tilted, false), "or tilts")
	check(tracker.device_transform.basis.y.y < 0.99, "as it is told")
	var good: Transform3D = tracker.device_transform
	check(not tracker.calibrate_place(Transform3D(Basis.IDENTITY, Vector3(NAN, 0, 0))), "not a number is refused")
	tracker.device_transform = Transform3D(Basis.from_scale(Vector3(2, 2, 2)), Vector3.ZERO)
	check_equal(tracker.device_transform, good, "a scale is refused")
	await _leave()


func test_bad_values_are_refused_and_a_missing_device_is_named() -> void:
	tracker = Tracker.new()
	add(tracker)
	await physics_frames(2)
	check(tracker._get_configuration_warnings()[0].contains("spidar_path"), "the remedy")
	check(not tracker.is_physics_processing() and not tracker.is_processing(), "costs nothing")
	check(not tracker.calibrate_place(Transform3D.IDENTITY), "nothing to calibrate")
	tracker.full_squeeze = NAN
	tracker.full_squeeze = 0.0
	check_near(tracker.full_squeeze, 0.05, 1e-9, "full_squeeze stays")
	tracker.click_at = 2.0
	tracker.release_below = NAN
	check_near(tracker.click_at, 0.7, 1e-9, "click_at stays")
	check_near(tracker.release_below, 0.5, 1e-9, "release_below stays")
	tracker.free()


func _set_up(workspace_scale: float = 1.0) -> void:
	device = ideal_device()
	device.workspace_scale = workspace_scale
	tracker = Tracker.new()
	device.add_child(tracker)
	origin = XROrigin3D.new()
	controller = XRController3D.new()
	controller.tracker = &"right_hand"
	origin.add_child(controller)
	# Before the device in the tree.
	add(origin)
	add(device)
	controller.button_pressed.connect(func(input: String) -> void: pressed.append(input))
	controller.button_released.connect(func(input: String) -> void: released.append(input))
	controller.input_float_changed.connect(func(input: String, _value: float) -> void:
		floats[input] = floats.get(input, 0) + 1)
	var witness := Witness.new()
	witness.look = func() -> void:
		seen_apart_m = maxf(seen_apart_m, controller.global_position.distance_to(device.get_grip_transform().origin))
	origin.add_child(witness)
	await physics_frames(4)
	seen_apart_m = 0.0


func _leave() -> void:
	origin.free()
	device.free()
	XRServer.world_scale = 1.0
	at = Vector3.ZERO
	angle = 0.0
	await physics_frames(2)


func _swing(ticks: int) -> void:
	for i: int in ticks:
		var target := Transform3D(Basis(Vector3.UP, 0.3 * sin(0.2 * i)), Vector3(0.05 * sin(0.15 * i), 0.03, 0.0) * device.workspace_scale)
		device.set_simulated_hand_target(device.global_transform * target, 0.2)
		await physics_frames(1)


func _grasp_slowly(from: float, to: float) -> void:
	for i: int in 40:
		device.set_simulated_hand_target(device.transform, lerpf(from, to, (i + 1) / 40.0))
		await physics_frames(1)
	await physics_frames(30)
