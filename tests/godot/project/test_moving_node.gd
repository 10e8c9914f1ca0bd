## A device on something that moves: what is fixed to the same thing rests for the hand, and a jump is no motion.
extends "res://hand_scene.gd"

var car: Node3D
## Of the hand's target, seen from the car.
var here := Transform3D.IDENTITY
## How the car is moved each tick; may hold on to this test, so _leave() takes it back.
var drive := Callable()


func test_a_table_on_the_same_lift_feels_as_at_rest() -> void:
	var rest: float = 0.0
	for velocity: Vector3 in [
		Vector3.ZERO, Vector3(0, 0.1, 0), Vector3(0, 1, 0), Vector3(0, 3, 0), Vector3(0, -3, 0), Vector3(2, 0, -1)
	]:
		var felt: PackedFloat64Array = await _ride(velocity, AnimatableBody3D.new())
		print("INFO lift at %s m/s: %.3f N" % [velocity, felt[1]])
		rest = felt[1] if velocity == Vector3.ZERO else rest
		check_near(felt[1], 0.81, 0.03, "lift at %s m/s" % velocity)
		check_near(felt[1], rest, 0.01, "lift at %s m/s: as at rest" % velocity)
		check_near(Vector2(felt[0], felt[2]).length(), 0.0, 0.02, "lift at %s m/s: nothing sideways" % velocity)


func test_so_does_a_static_table_and_a_lift_that_is_moved_by_frames() -> void:
	for in_frames: bool in [false, true]:
		for table: StaticBody3D in [AnimatableBody3D.new(), StaticBody3D.new()]:
			var kind: String = table.get_class()
			for velocity: Vector3 in [Vector3(0, 1, 0), Vector3(0, -2, 1)]:
				var felt: PackedFloat64Array = await _ride(velocity, table.duplicate(), in_frames)
				check_near(felt[1], 0.81, 0.03, "%s at %s m/s, moved by frames: %s" % [kind, velocity, in_frames])
			table.free()


func test_a_lift_feels_the_same_at_every_time_scale() -> void:
	for time_scale: float in [0.1, 3.0]:
		for table: StaticBody3D in [AnimatableBody3D.new(), StaticBody3D.new()]:
			Engine.time_scale = time_scale
			var kind: String = table.get_class()
			var felt: PackedFloat64Array = await _ride(time_scale * Vector3(0, 1, 0), table)
			check_near(felt[1], 0.81, 0.03, "%s on a lift at time scale %s" % [kind, time_scale])
	Engine.time_scale = 1.0


func test_a_floor_of_the_scene_is_where_it_is_for_a_vehicle() -> void:
	await _set_up_car(Vector3.ZERO, AnimatableBody3D.new(), 0.2)
	var floor_body := StaticBody3D.new()
	_put_box(floor_body, Vector3(60.0, 0.1, 60.0), Vector3(0, FLOOR_Y - 0.05, 0))
	add(floor_body)
	hand.contact_friction = 0.0
	drive = func() -> void: car.position += Vector3(1.5, 0, 0.5) / 60.0
	await _press()
	check_near((await _mean_felt(60))[1], 0.81, 0.03, "driven along")
	# Down by 4 mm: as much deeper.
	drive = func() -> void: car.position += Vector3(1.5, -0.004 / 30.0 if car.position.y > -0.004 else 0.0, 0.5) / Vector3(60, 1, 60)
	await _ticks(60)
	var felt: PackedFloat64Array = await _mean_felt(60)
	check_near(felt[1], 0.81 * 9.0 / 5.0, 0.05, "and lower")
	floor_body.free()
	await _leave()


func test_a_table_on_the_same_turntable_feels_as_at_rest() -> void:
	for turn: Vector3 in [Vector3(0, 0.5, 0), Vector3(0, 2, 0), Vector3(0.3, 1, -0.2)]:
		await _set_up_car(Vector3(0.5, 0, 0.3))
		drive = func() -> void:
			car.basis = Basis(turn.normalized(), turn.length() / 60.0) * car.basis.orthonormalized()
		await _press()
		var along: float = 0.0
		for _i: int in 60:
			await _tick()
			var felt: PackedFloat64Array = device.get_simulated_truth()["strings_wrench"]
			along += car.basis.y.dot(Vector3(felt[0], felt[1], felt[2])) / 60.0
		print("INFO turntable at %s rad/s: %.3f N" % [turn, along])
		check_near(along, 0.81, 0.03, "turntable at %s rad/s" % turn)
		await _leave()


func test_a_body_is_grasped_and_weighs_the_same_on_a_lift() -> void:
	for velocity: Vector3 in [Vector3(0, 1, 0), Vector3(0, 3, 0), Vector3(1, 0, 1)]:
		await _set_up_car()
		drive = func() -> void: car.position += velocity / 60.0
		var body := add_box(Vector3(0.03, 0.04, 0.03), Vector3(0, FLOOR_Y + 0.0205, 0), 0.1) as RigidBody3D
		body.linear_velocity = velocity
		await _ticks(80)
		await _grasp()
		check(hand.get_held_body() == body, "%s m/s: held" % velocity)
		await _carry_to(Vector3(0, 0.02, 0), 40)
		await _ticks(30)
		var felt: PackedFloat64Array = await _mean_felt(30)
		print("INFO held on a lift at %s m/s: %.3f N" % [velocity, felt[1]])
		check_near(felt[1], -0.1 * GRAVITY, 0.03, "%s m/s: its weight" % velocity)
		check_near(Vector2(felt[0], felt[2]).length(), 0.0, 0.03, "%s m/s: nothing sideways" % velocity)
		body.free()
		await _leave()


func test_a_jump_of_the_node_is_not_felt() -> void:
	for jump: Transform3D in [
		Transform3D(Basis.IDENTITY, Vector3(0.05, 0, 0)), Transform3D(Basis.IDENTITY, Vector3(0, 0.5, 0.5)),
		Transform3D(Basis.IDENTITY, Vector3(300, 40, 0)), Transform3D(Basis(Vector3.UP, 0.7), Vector3(2, 0, 0)),
	]:
		await _set_up_car()
		var body := add_box(Vector3(0.03, 0.04, 0.03), Vector3(0, FLOOR_Y + 0.0205, 0), 0.1) as RigidBody3D
		await _ticks(80)
		await _grasp()
		await _carry_to(Vector3(0, 0.03, 0), 40)
		await _ticks(40)
		check(hand.get_held_body() == body, "held")
		car.transform = jump * car.transform
		var off: float = 0.0
		for _i: int in 60:
			await _tick()
			var felt: PackedFloat64Array = device.get_simulated_truth()["strings_wrench"]
			off = maxf(off, (Vector3(felt[0], felt[1], felt[2]) - Vector3(0, -0.1 * GRAVITY, 0)).length())
		print("INFO jump by %s: %.3f N" % [jump.origin, off])
		check(off <= 0.1, "jump by %s m: off by %f N" % [jump.origin, off])
		check(hand.get_held_body() == body, "jump by %s m: still held" % jump.origin)
		var apart: float = body.global_position.distance_to(hand.get_wanted_pose().origin)
		check(apart < 0.001, "jump by %s m: the body came along, %f m off" % [jump.origin, apart])
		body.free()
		await _leave()


func test_velocities_of_the_scene_have_the_nodes_own_in_them() -> void:
	await _set_up_car(Vector3(0.5, 0, 0))
	var velocity := Vector3(0.4, 1, -0.3)
	drive = func() -> void: car.position += velocity / 60.0
	await _ticks(100)
	check_near(device.get_linear_velocity().distance_to(velocity), 0.0, 0.01, "moved: %s" % device.get_linear_velocity())
	drive = func() -> void: car.rotation.y += 1.0 / 60.0
	await _ticks(30)
	var expected: Vector3 = Vector3.UP.cross(device.get_grip_transform().origin - car.position)
	check_near(device.get_linear_velocity().distance_to(expected), 0.0, 0.02, "turned: %s" % device.get_linear_velocity())
	check_near(device.get_angular_velocity().distance_to(Vector3.UP), 0.0, 0.02, "turning: %s" % device.get_angular_velocity())
	drive = Callable()
	car.position += Vector3(3, 0, 0)
	for _i: int in 3:
		await _tick()
		check(device.get_linear_velocity().length() < 0.02, "a jump is no velocity: %s" % device.get_linear_velocity())
	await _leave()


func test_a_plane_and_a_coupling_that_move_along_do_not_drag() -> void:
	var velocity := Vector3(0.7, 1, 0)
	for tied: bool in [false, true]:
		await _set_up_car()
		drive = func() -> void: car.position += velocity / 60.0
		if tied:
			device.set_coupling_gains(PackedFloat64Array([200, 200, 200, 0, 0, 0, 0]), PackedFloat64Array([2, 2, 2, 0, 0, 0, 0]))
		await _ticks(80)
		var most: float = 0.0
		for i: int in 90:
			await _tick()
			if tied:
				device.set_coupling(car.global_transform, 0.0, velocity)
			else:
				# 4 mm into the hand, rough.
				device.set_contacts(PackedFloat64Array([
					0, 1, 0, car.position.y + 0.004, velocity.x, velocity.y, velocity.z, 300, 2, 0.5, SpidarG.CONTACT_CENTER, 7
				]))
			var felt: PackedFloat64Array = device.get_requested_wrench()
			if i >= 30:
				most = maxf(most, Vector2(felt[0], felt[2]).length() if not tied else Vector3(felt[0], felt[1], felt[2]).length())
		check(most < 0.03, "%s: dragged with %f N" % ["coupling" if tied else "plane", most])
		await _leave()


func test_a_step_of_a_platform_feels_alike_whatever_body_it_is() -> void:
	for step_mm: float in [2.0, 10.0]:
		var peaks: Array[float] = []
		for kind: String in ["static", "animatable", "animatable in step with physics"]:
			at = Vector3.ZERO
			angle = 0.0
			device = ideal_device()
			device.forces_enabled = true
			hand = SpidarGHand.new()
			device.add_child(hand)
			add(device)
			var platform: PhysicsBody3D = StaticBody3D.new() if kind == "static" else AnimatableBody3D.new()
			if platform is AnimatableBody3D:
				platform.set("sync_to_physics", kind != "animatable")
			_put_box(platform, Vector3(0.6, 0.05, 0.6), Vector3(0, FLOOR_Y - 0.025, 0))
			add(platform)
			await move_to(at, 0.0, ARMING_FRAMES + 10)
			await move_to(Vector3(0, FLOOR_Y + 0.002, 0), 0.0, 60)
			await physics_frames(40)
			# All are seen at the same time of the device, whose ticks have 16 or 17 cycles: what physics moves a tick later.
			while device.get_device_time() < (3.475 if kind == "static" else 3.46):
				await physics_frames(1)
			platform.position.y += 0.001 * step_mm
			var peak: float = 0.0
			for _i: int in 30:
				await physics_frames(1)
				var felt: PackedFloat64Array = device.get_simulated_truth()["strings_wrench"]
				peak = maxf(peak, felt[1])
			peaks.append(peak)
			device.free()
			platform.free()
			await physics_frames(2)
		print("INFO step of %.0f mm: %s N" % [step_mm, peaks])
		check_near(peaks[1], peaks[0], 0.03 * peaks[0], "step of %.0f mm: animatable as static" % step_mm)
		check_near(peaks[2], peaks[0], 0.03 * peaks[0], "step of %.0f mm: in step with physics" % step_mm)


## What is felt on a table of this kind that moves along. velocity: in the device's time.
func _ride(velocity: Vector3, table: StaticBody3D, in_frames: bool = false) -> PackedFloat64Array:
	await _set_up_car(Vector3.ZERO, table)
	var move: Callable = func() -> void: car.position += velocity / 60.0
	if in_frames:
		tree.process_frame.connect(move)
	else:
		drive = move
	await _press()
	var felt: PackedFloat64Array = await _mean_felt(60)
	if in_frames:
		tree.process_frame.disconnect(move)
	await _leave()
	return felt


## A car with a device and a table, its hand in the middle. below_m: how far the table is beneath its place.
func _set_up_car(
	offset: Vector3 = Vector3.ZERO, table: StaticBody3D = AnimatableBody3D.new(), below_m: float = 0.0
) -> void:
	drive = Callable()
	car = Node3D.new()
	add(car)
	device = ideal_device()
	device.forces_enabled = true
	device.position = offset
	hand = SpidarGHand.new()
	hand.contact_stiffness = 350.0
	device.add_child(hand)
	car.add_child(device)
	if table is AnimatableBody3D:
		table.set("sync_to_physics", false)
	_put_box(table, Vector3(1.0, 0.1, 1.0), offset + Vector3(0, FLOOR_Y - 0.05 - below_m, 0))
	car.add_child(table)
	here = Transform3D(Basis.IDENTITY, offset)
	angle = 0.0
	await _ticks(3)


func _leave() -> void:
	drive = Callable()
	car.free()
	await physics_frames(2)


func _put_box(to: PhysicsBody3D, size: Vector3, position: Vector3) -> void:
	var shape := CollisionShape3D.new()
	var box := BoxShape3D.new()
	box.size = size
	shape.shape = box
	to.add_child(shape)
	to.position = position


func _tick() -> void:
	if drive.is_valid():
		drive.call()
	device.set_simulated_hand_target(car.global_transform * here, angle)
	await physics_frames(1)


func _ticks(count: int) -> void:
	for _i: int in count:
		await _tick()


## Lowers the pads 5 mm into the table.
func _press() -> void:
	await _ticks(80)
	await _carry_to(Vector3(0, FLOOR_Y + 0.007, 0), 60)
	await _ticks(100)


func _grasp() -> void:
	await _carry_to(Vector3(0, FLOOR_Y + 0.02, 0), 60)
	for i: int in 40:
		angle = SQUEEZE_ANGLE * (i + 1) / 40.0
		await _tick()
	await _ticks(40)


## Seen from the device.
func _carry_to(to: Vector3, count: int) -> void:
	var from: Vector3 = here.origin
	for i: int in count:
		here.origin = from.lerp(device.position + to, float(i + 1) / count)
		await _tick()


func _mean_felt(count: int) -> PackedFloat64Array:
	var sum: PackedFloat64Array = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
	for _i: int in count:
		await _tick()
		var felt: PackedFloat64Array = device.get_simulated_truth()["strings_wrench"]
		for k: int in 7:
			sum[k] += felt[k] / count
	return sum
