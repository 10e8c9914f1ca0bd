## Requests of several owners add up: a script's beside a hand's, each replacing only its own.
extends "res://hand_scene.gd"

const PLANE: PackedFloat64Array = [0, 1, 0, -0.5, 0, 0, 0, 350, 2, 0, 0, 7]


func test_wrenches_of_two_owners_add_up_and_end_each_by_itself() -> void:
	var lone: SpidarG = await _active_device()
	lone.request_wrench(Vector3(0, 1, 0), Vector3.ZERO, 0.0, 1.0)
	lone.request_wrench(Vector3(0.5, 0, 0), Vector3.ZERO, 0.1, 0.1, "other")
	lone.advance_cycles(20)
	_check_requested(lone, Vector3(0.5, 1, 0), 0.1, "the sum")
	lone.request_wrench(Vector3(0, 2, 0), Vector3.ZERO, 0.0, 1.0)
	lone.advance_cycles(20)
	_check_requested(lone, Vector3(0.5, 2, 0), 0.1, "a new request replaces its owner's")
	await physics_frames(20)
	_check_requested(lone, Vector3(0, 2, 0), 0.0, "the short one is over, the long one stays")
	await physics_frames(80)
	_check_requested(lone, Vector3.ZERO, 0.0, "all over")
	lone.free()


func test_a_scripts_wrench_adds_to_the_weight_of_a_held_body() -> void:
	await set_up(Vector3(0.0, FLOOR_Y + 0.03, 0.0))
	var body: RigidBody3D = add_free_box(Vector3(0.04, 0.06, 0.04), 0.1)
	await grasp(body)
	check(hand.get_held_body() == body, "held")
	await move_to(Vector3(0.0, 0.05, 0.0), SQUEEZE_ANGLE, 60)
	await physics_frames(30)
	var before: PackedFloat64Array = await mean_felt(20)
	for _i: int in 30:
		device.request_wrench(Vector3(0.8, 0, 0), Vector3.ZERO, 0.0)
		await physics_frames(1)
	var felt := PackedFloat64Array([0, 0, 0])
	for _i: int in 20:
		device.request_wrench(Vector3(0.8, 0, 0), Vector3.ZERO, 0.0)
		await physics_frames(1)
		var now: PackedFloat64Array = device.get_simulated_truth()["strings_wrench"]
		for axis: int in 3:
			felt[axis] += now[axis] / 20.0
	check_near(felt[0] - before[0], 0.8, 0.08, "the script's push is felt")
	check_near(felt[1], before[1], 0.08, "and the weight as well")
	check(before[1] < -0.7, "which is there: %f N" % before[1])


func test_a_scripts_contacts_stay_beside_a_hands() -> void:
	await set_up(Vector3(0.0, 0.0, 0.0))
	check(device.set_contacts(PLANE), "a script's plane is taken")
	check_equal(device.get_free_contacts("another"), 7, "seven are left to the others")
	# Towards the floor: the hand publishes its own planes, tick by tick.
	for i: int in 60:
		device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, Vector3(0, FLOOR_Y + 0.007, 0) * (i / 59.0)), 0.0)
		var wall: PackedFloat64Array = PLANE.duplicate()
		wall[0] = 1.0
		wall[1] = 0.0
		wall[3] = 0.004
		check(device.set_contacts(wall), "renewed")
		await physics_frames(1)
	var felt: PackedFloat64Array = await mean_felt(1)
	check(felt[1] > 0.3, "the floor of the hand is felt: %f N" % felt[1])
	check(felt[0] > 0.3, "and the wall of the script: %f N" % felt[0])
	check_equal(device.get_touching_contacts(), PackedInt32Array([7]), "each owner hears of its own")
	check(device.get_contact_impulses().has(7) and device.get_contact_impulses().size() == 1, "and of no other")
	var many := PackedFloat64Array()
	for id: int in 8:
		var plane: PackedFloat64Array = PLANE.duplicate()
		plane[11] = id
		many.append_array(plane)
	var refusals: PackedStringArray = []
	device.request_rejected.connect(func(message: String) -> void: refusals.append(message))
	check(device.set_contacts(PLANE, "another"), "another owner has one")
	check(not device.set_contacts(many), "more than the device has are refused")
	check(refusals.size() == 1 and refusals[0].contains("get_free_contacts"), "with the remedy: %s" % [refusals])
	device.clear_contacts()
	await physics_frames(2)
	check((await mean_felt(1))[1] > 0.3, "clearing the script's leaves the hand's")


func test_a_limited_request_names_owner_value_and_limit() -> void:
	var lone: SpidarG = await _active_device()
	var messages: PackedStringArray = []
	lone.device_event.connect(
		func(event: Dictionary) -> void:
			if event["name"] == "request_limited":
				messages.append(event["message"])
	)
	lone.request_wrench(Vector3(0, 30, 0), Vector3.ZERO, 0.0, 0.5, "Crane")
	await physics_frames(3)
	if check(messages.size() == 1, "told once: %s" % [messages]):
		for part: String in ["Crane", "30.00 N", "8.00 N", "max_force"]:
			check(messages[0].contains(part), "names %s: %s" % [part, messages[0]])
	lone.free()


func test_of_two_hands_on_one_device_the_first_acts() -> void:
	await set_up(Vector3.ZERO)
	var second := SpidarGHand.new()
	second.name = "Second"
	second.contact_stiffness = 350.0
	hand.contact_stiffness = 350.0
	device.add_child(second)
	check(second.get_warnings().size() >= 1, "warned in the editor")
	await move_to(Vector3(0.0, FLOOR_Y + 0.007, 0.0), 0.0, 40)
	await physics_frames(30)
	check_near((await mean_felt(20))[1], 0.81, 0.1, "the floor is felt once, as with one hand")
	check(not second.get_touch_statistics()["acts"], "the second asks for nothing")
	hand.free()
	await physics_frames(30)
	check((await mean_felt(20))[1] > 0.3, "it acts once the first is gone")
	hand = second


func _active_device() -> SpidarG:
	var lone: SpidarG = ideal_device()
	lone.forces_enabled = true
	add(lone)
	await physics_frames(1)
	lone.advance_cycles(1600)
	return lone


func _check_requested(lone: SpidarG, force: Vector3, grasp_torque: float, what: String) -> void:
	var asked: PackedFloat64Array = lone.get_requested_wrench()
	check_near(Vector3(asked[0], asked[1], asked[2]).distance_to(force), 0.0, 1e-6, "%s: %s" % [what, asked])
	check_near(asked[6], grasp_torque, 1e-9, "%s, grasp" % what)
