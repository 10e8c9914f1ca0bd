## What scenes do with nodes: copies, new parents, mirrors, process modes, one config for all.
extends "res://hand_scene.gd"

const View := preload("res://addons/spidar_g/nodes/spidar_g_view.gd")
const Monitors := preload("res://addons/spidar_g/nodes/spidar_g_monitors.gd")
const DevicePanel := preload("res://addons/spidar_g/nodes/spidar_g_panel.gd")
const CONFIG: String = "spidar_g/device/default_config"
const FILE: String = "user://scene_life.tres"


func test_a_copy_holds_nothing_and_draws_once() -> void:
	await set_up(Vector3(0.0, FLOOR_Y + 0.03, 0.0))
	device.add_child(View.new())
	var body: RigidBody3D = add_free_box(Vector3(0.04, 0.06, 0.04), 0.1)
	await grasp(body)
	await move_to(Vector3(0.0, 0.05, 0.0), SQUEEZE_ANGLE, 60)
	check(hand.get_held_body() == body, "held")
	var meshes: int = _meshes(device)
	var copy: SpidarG = device.duplicate()
	copy.position.x = 1.0
	add(copy)
	await physics_frames(5)
	check_equal(_meshes(copy), meshes, "the copy has as many meshes")
	var copied_hand: SpidarGHand = copy.get_child(0)
	check(copied_hand.get_held_body() == null, "and holds nothing")
	check_equal(copied_hand.get_child_count(), 0, "no part of the hold came along")
	device.free()
	await physics_frames(60)
	check(body.global_position.y < 0.0, "let go by the first, the body falls: y = %f" % body.global_position.y)
	device = copy


func test_a_held_body_that_leaves_the_physics_is_let_go() -> void:
	for way: String in ["disabled", "static", "frozen", "freed", "removed"]:
		at = Vector3.ZERO
		angle = 0.0
		await set_up(Vector3(0.0, FLOOR_Y + 0.03, 0.0))
		var released: Array = []
		hand.body_released.connect(func(_body: RigidBody3D) -> void: released.append(way))
		var body: RigidBody3D = add_free_box(Vector3(0.04, 0.06, 0.04), 0.1)
		await grasp(body)
		check(hand.get_held_body() == body, "%s: held" % way)
		match way:
			"disabled":
				body.process_mode = Node.PROCESS_MODE_DISABLED
			"static":
				body.disable_mode = CollisionObject3D.DISABLE_MODE_MAKE_STATIC
				body.process_mode = Node.PROCESS_MODE_DISABLED
			"frozen":
				body.freeze = true
			"freed":
				body.queue_free()
			"removed":
				body.get_parent().remove_child(body)
		await physics_frames(10)
		check(hand.get_held_body() == null, "%s: let go" % way)
		check_equal(released.size(), 1, "%s: told once" % way)
		await physics_frames(20)
		check(hand.is_physics_processing(), "%s: the hand goes on" % way)
		if way == "removed":
			body.free()
		for node: Node in tree.root.get_children():
			if node == device or node is PhysicsBody3D:
				node.free()
		await physics_frames(2)


func test_of_two_hands_on_one_body_the_last_gives_it_its_sleep() -> void:
	for order: Array in [[0, 1], [1, 0]]:
		var body: RigidBody3D = add_free_box(Vector3(0.03, 0.1, 0.03), 0.1)
		var devices: Array[SpidarG] = []
		var hands: Array[SpidarGHand] = []
		for upper: int in 2:
			var lone: SpidarG = ideal_device()
			lone.position = Vector3(0.0, 0.04 - 0.05 + 0.04 * upper, 0.0)
			lone.set_simulated_hand_target(lone.transform, 0.0)
			var holder := SpidarGHand.new()
			lone.add_child(holder)
			add(lone)
			devices.append(lone)
			hands.append(holder)
		body.position.y = 0.01
		body.gravity_scale = 0.0
		for frame: int in 90:
			for lone: SpidarG in devices:
				lone.set_simulated_hand_target(lone.transform, SQUEEZE_ANGLE * minf(frame / 40.0, 1.0))
			await physics_frames(1)
		check(hands[0].get_held_body() == body and hands[1].get_held_body() == body, "both hold it")
		check(not body.can_sleep, "a held body does not sleep")
		hands[order[0]].release()
		hands[order[0]].free()
		check(not body.can_sleep, "nor while the other holds it")
		hands[order[1]].release()
		hands[order[1]].free()
		check(body.can_sleep, "let go by both it may, as before")
		body.free()
		for lone: SpidarG in devices:
			lone.free()
		await physics_frames(1)


func test_a_mirrored_or_scaled_place_is_warned_about_and_turns_rightly() -> void:
	for kind: String in ["mirror", "mirrored parent", "scaled parent"]:
		var room := Node3D.new()
		var lone: SpidarG = ideal_device()
		lone.forces_enabled = true
		match kind:
			"mirror":
				lone.scale = Vector3(-1, 1, 1)
			"mirrored parent":
				room.scale = Vector3(1, 1, -1)
			"scaled parent":
				room.scale = Vector3(2, 2, 2)
		room.add_child(lone)
		add(room)
		await physics_frames(2)
		var warnings: String = "\n".join(lone.get_warnings())
		check(warnings.contains("mirror" if kind.begins_with("mirror") else "scaled"), "%s: warned: %s" % [kind, warnings])
		check(absf(lone.get_grip_transform().basis.determinant() - 1.0) < 1e-3, "%s: the grip is no mirror image" % kind)
		# A room that is only mirrored is not turned.
		var target := Transform3D(Basis(Vector3.UP, 0.3), Vector3(0.03, 0.02, 0.01))
		check(lone.get_grip_transform().basis.is_equal_approx(Basis.IDENTITY), "%s: the grip rests unturned" % kind)
		for _i: int in 90:
			lone.set_simulated_hand_target(target, 0.0)
			await physics_frames(1)
		var before: Basis = lone.get_grip_transform().basis
		check_near(lone.get_grip_transform().origin.distance_to(target.origin), 0.0, 1e-4, "%s: where its hand is" % kind)
		for _i: int in 60:
			lone.set_simulated_hand_target(target, 0.0)
			lone.request_wrench(Vector3(0, 0.5, 0), Vector3(0, 0.05, 0), 0.0)
			await physics_frames(1)
		var turned: Vector3 = (lone.get_grip_transform().basis * before.inverse()).get_euler()
		check_near(turned.y, 0.10, 0.005, "%s: turned as asked: %s" % [kind, turned])
		check(lone.get_grip_transform().origin.y > target.origin.y + 1e-4, "%s: moved as asked" % kind)
		# However a mirrored room turns, the grip turns with it and never jumps.
		var last: Basis = lone.get_grip_transform().basis
		for _i: int in 60 if kind == "mirrored parent" else 0:
			room.rotate_y(0.1)
			var now: Basis = lone.get_grip_transform().basis
			check(now.get_rotation_quaternion().angle_to(last.get_rotation_quaternion()) < 0.11, "%s: turns with the room" % kind)
			last = now
		room.free()


func test_view_hand_and_monitors_work_under_a_new_parent() -> void:
	var plain := Node3D.new()
	add(plain)
	var lone: SpidarG = ideal_device()
	add(lone)
	var view := View.new()
	var moved_hand := SpidarGHand.new()
	var monitors := Monitors.new()
	for node: Node in [view, moved_hand, monitors]:
		plain.add_child(node)
		var told: StringName = &"get_warnings" if node is SpidarGHand else &"_get_configuration_warnings"
		var warnings: PackedStringArray = node.call(told)
		check_equal(warnings.size() >= 1, true, "%s warns under a plain node" % node)
	await physics_frames(2)
	check(not view.is_processing() and not moved_hand.is_physics_processing(), "and does nothing there")
	for node: Node in [view, moved_hand, monitors]:
		node.reparent(lone)
	await physics_frames(3)
	await frames(2)
	check(view.is_processing() and view.spidar == lone and _meshes(view) > 0, "the view draws")
	check(moved_hand.is_physics_processing(), "the hand acts")
	check_equal(monitors.get_monitor_names().size(), 7, "the monitors show")
	view.reparent(plain)
	await frames(2)
	check(not view.is_processing(), "moved away it draws no more")
	view.reparent(lone)
	await frames(2)
	check(view.is_processing(), "and again")
	lone.free()
	plain.free()


func test_devices_of_one_name_have_monitors_each() -> void:
	var sizes: Array[int] = []
	for _i: int in 3:
		var room := Node3D.new()
		add(room)
		var lone: SpidarG = ideal_device()
		lone.name = "Device"
		var monitors := Monitors.new()
		lone.add_child(monitors)
		room.add_child(lone)
		await physics_frames(1)
		sizes.append(monitors.get_monitor_names().size())
	check_equal(sizes, [sizes[0], sizes[0], sizes[0]] as Array[int], "as many each")
	check(sizes[0] >= 6, "%s" % [sizes])


func test_a_panel_without_its_scene_says_so_once() -> void:
	var panel := DevicePanel.new()
	add(panel)
	await frames(10)
	check(not panel.is_processing(), "does not run")
	check(panel._get_configuration_warnings()[0].contains("spidar_g_panel.tscn"), "and names the scene")
	panel.toggle_recording()
	panel.free()


func test_hand_view_and_node_have_one_config() -> void:
	var config := SpidarGConfig.new()
	config.jaw_open = 0.04
	config.jaw_closed_angle = deg_to_rad(30.0)
	config.frame_size = Vector3(0.8, 0.6, 0.7)
	config.simulated_elastic = false
	config.simulated_friction = 0.0
	ResourceSaver.save(config, FILE)
	ProjectSettings.set_setting(CONFIG, FILE)
	var lone := SpidarG.new()
	lone.drive_mode = SpidarG.DRIVE_STEPPED
	lone.forces_enabled = true
	device = lone
	hand = SpidarGHand.new()
	lone.add_child(hand)
	var view := View.new()
	lone.add_child(view)
	add(lone)
	await physics_frames(80)
	check_equal(lone.get_effective_config().frame_size, Vector3(0.8, 0.6, 0.7), "the project's")
	check_equal(view._frame_size(), Vector3(0.8, 0.6, 0.7), "drawn so")
	for frame: int in 100:
		lone.set_simulated_hand_target(Transform3D.IDENTITY, deg_to_rad(60.0) * minf(frame / 60.0, 1.0))
		await physics_frames(1)
	check_near(rad_to_deg(hand.get_stop_angle()), 30.0, 0.01, "the jaws stop where they are closed")
	ProjectSettings.set_setting(CONFIG, "")
	DirAccess.remove_absolute(FILE)
	var rigid := SpidarGConfig.new()
	rigid.preset = 2
	lone.config = rigid
	check(lone.get_effective_config() == rigid, "the node's own goes before")
	await physics_frames(2)
	await frames(2)
	var size: Vector3 = view._frame_size()
	check(size.x < 0.2, "a preset's frame is drawn: %s" % size)
	var low := Vector3.INF
	var high := -Vector3.INF
	for string: int in 8:
		low = low.min(lone.get_string_start(string))
		high = high.max(lone.get_string_start(string))
	check(size.distance_to(high - low) < 1e-5, "as large as it is: %s, %s" % [size, high - low])


func test_what_is_drawn_is_not_interpolated() -> void:
	await set_up(Vector3.ZERO)
	var view := View.new()
	device.add_child(view)
	await frames(2)
	for child: Node in view.get_children(true):
		check(not child.is_physics_interpolated(), "%s is placed in each frame" % child)
	check(not view.is_physics_interpolated(), "the view as well")
	tree.physics_interpolation = true
	for i: int in 20:
		device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, Vector3(0.004 * i, 0, 0)), 0.0)
		await frames(1)
		var drawn: Vector3 = view._parts._poles[0].get_global_transform_interpolated().origin
		check_near(drawn.distance_to(view._drawn_grip.origin), 0.0, 1e-6, "drawn where the grip was when it was drawn, m")
	tree.physics_interpolation = false
	check(device.get_grip_transform().origin.x > 0.05, "it moved")


func test_a_hand_in_a_thread_group_rests_and_says_so() -> void:
	device = ideal_device()
	device.process_thread_group = Node.PROCESS_THREAD_GROUP_SUB_THREAD
	hand = SpidarGHand.new()
	device.add_child(hand)
	add(device)
	await physics_frames(10)
	check(not hand.get_touch_statistics()["acts"], "it rests")
	device.free()
	await set_up(Vector3.ZERO)
	check(hand.get_touch_statistics()["acts"], "in the main thread it acts")


func test_names_beyond_ascii_are_kept() -> void:
	var lone: SpidarG = ideal_device()
	lone.name = "Gerät_日本"
	var messages: PackedStringArray = []
	lone.request_rejected.connect(func(message: String) -> void: messages.append(message))
	add(lone)
	await physics_frames(1)
	lone.request_wrench(Vector3(NAN, 0, 0), Vector3.ZERO, 0.0)
	check(messages.size() == 1 and messages[0].contains("Gerät_日本"), "%s" % [messages])


func test_the_list_of_devices_can_be_asked_for() -> void:
	var listed: Array = SpidarG.list_devices()
	for device_listed: Dictionary in listed:
		check(device_listed.has_all(["kind", "product", "serial", "path", "owner"]), "%s" % device_listed)
		check_equal(device_listed.has("vendor_id"), device_listed["kind"] == "hid", "%s" % device_listed)
	check(listed.size() < 20, "%d devices" % listed.size())


func _meshes(of: Node) -> int:
	return of.find_children("*", "GeometryInstance3D", true, false).size() + _internal_meshes(of)


## find_children() passes internal children over.
func _internal_meshes(of: Node) -> int:
	var count: int = 0
	for child: Node in of.get_children(true):
		if not of.get_children().has(child):
			count += 1 if child is GeometryInstance3D else 0
			count += child.find_children("*", "GeometryInstance3D", true, false).size()
		count += _internal_meshes(child)
	return count
