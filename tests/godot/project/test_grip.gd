## SpidarGGrip: where it stands in a physics tick, between ticks, on a moving device, and what it refuses.
extends "res://hand_scene.gd"

const Grip := preload("res://addons/spidar_g/nodes/spidar_g_grip.gd")
## Rounding of floats near the origin, m.
const ROUNDING_M: float = 1e-6

var grip: Grip
## Largest distance between the node and what it should follow, as a script below the node saw it in its tick, m.
var seen_apart_m: float = 0.0
var seen_ticks: int = 0


## Looks at the node in its own _physics_process, and as the frame shows it.
class Witness extends Node3D:
	var look: Callable
	var look_when_drawn: Callable

	func _process(_delta: float) -> void:
		if look_when_drawn.is_valid():
			look_when_drawn.call()

	func _physics_process(_delta: float) -> void:
		look.call()


## Moves its parent by so much in each tick, after all nodes of ordinary priority.
class LateMover extends Node:
	var step := Vector3.ZERO

	func _init() -> void:
		process_physics_priority = 1000

	func _physics_process(_delta: float) -> void:
		(get_parent() as Node3D).position += step


func test_in_a_tick_it_stands_exactly_at_the_grip() -> void:
	for place: String in ["child", "below a scaled child", "earlier in the tree"]:
		await _set_up(place, 3.0)
		await _swing(40)
		check(seen_ticks >= 40, "%s: a script below the node ran" % place)
		check_near(seen_apart_m, 0.0, ROUNDING_M, "%s: apart in a tick" % place)
		check(device.get_grip_transform().origin.length() > 0.01, "%s: the hand moved" % place)
		check_near(grip.global_basis.determinant(), 1.0, 1e-4, "%s: children are not scaled" % place)
		await _leave()


func test_the_offset_is_in_the_frame_of_the_grip_and_not_scaled() -> void:
	await _set_up("child", 3.0)
	grip.offset = Transform3D(Basis(Vector3.RIGHT, 0.5), Vector3(0.1, 0.2, 0.3))
	device.set_simulated_hand_target(Transform3D(Basis(Vector3.UP, 0.4), Vector3.ZERO), 0.0)
	await physics_frames(60)
	var wanted: Transform3D = device.get_grip_transform() * grip.offset
	check_near(grip.global_position.distance_to(wanted.origin), 0.0, ROUNDING_M, "placed by the offset")
	check_near((grip.global_basis.inverse() * wanted.basis).get_rotation_quaternion().get_angle(), 0.0, 1e-3, "turned by it")
	check_near(grip.global_position.distance_to(device.get_grip_transform().origin), grip.offset.origin.length(), 1e-5, "in scene metres")
	var good: Transform3D = grip.offset
	for bad: Transform3D in [Transform3D(Basis.IDENTITY, Vector3(NAN, 0, 0)), Transform3D(Basis.from_scale(Vector3.ZERO), Vector3.ZERO)]:
		grip.offset = bad
		check_equal(grip.offset, good, "a bad offset is refused")
	await _leave()


func test_it_follows_a_device_that_moves() -> void:
	for place: String in ["child", "earlier in the tree"]:
		for late: bool in [false, true]:
			await _set_up(place, 1.0)
			var step := Vector3(1.0, 0.5, 0.0) / 60.0
			var mover := LateMover.new()
			mover.step = step if late else Vector3.ZERO
			device.add_child(mover)
			for _i: int in 40:
				if not late:
					device.position += step
				await physics_frames(1)
				# When all nodes of the tick before have moved.
				var apart: float = grip.global_position.distance_to(device.get_grip_transform().origin)
				if late:
					seen_apart_m = maxf(seen_apart_m, apart)
			check(device.position.length() > 0.5, "the device moved")
			check_near(seen_apart_m if not late else 0.0, 0.0, 2e-6, "%s: apart in a tick" % place)
			await tree.process_frame
			check_near(grip.global_position.distance_to(device.get_grip_transform().origin), 0.0, 2e-6, "%s, late: %s: after the tick" % [place, late])
			await _leave()


func test_a_jump_of_the_device_is_not_drawn_as_motion() -> void:
	Engine.physics_ticks_per_second = 20
	await _set_up("child", 1.0)
	await frames(12)
	device.position.x += 100.0
	for _i: int in 9:
		await frames(1)
		check_near(grip.global_position.distance_to(device.get_grip_transform().origin), 0.0, 0.01, "beside the device in each frame")
	await _leave()


func test_between_ticks_it_is_drawn_smoothly() -> void:
	Engine.physics_ticks_per_second = 20
	await _set_up("child", 1.0)
	var steps: PackedFloat64Array = await _steps_of_frames(func() -> float: return grip.global_position.x)
	var raw: PackedFloat64Array = await _steps_of_frames(func() -> float: return device.get_grip_transform().origin.x)
	print("INFO steps of frames: %s, of the ticks' poses: %s" % [_spread(steps), _spread(raw)])
	check(_spread(raw) > 1.5, "the poses of the ticks jump: %f" % _spread(raw))
	check(_spread(steps) < 0.2, "the node does not: %f" % _spread(steps))
	var late: float = device.get_grip_transform().origin.x - grip.global_position.x
	check(late > -ROUNDING_M and late < 0.1 / 20.0 * 1.05, "at most one tick late: %f m at 0.1 m/s" % late)
	await _leave()


func test_where_each_frame_has_its_tick_nothing_is_late() -> void:
	await _set_up("child", 1.0)
	for i: int in 40:
		device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, Vector3(0.1 * i / 60.0, 0, 0)), 0.0)
		await frames(1)
		check_near(grip.global_position.distance_to(device.get_grip_transform().origin), 0.0, ROUNDING_M, "in the frame of the tick")
	await _leave()


func test_the_newest_pose_is_drawn_if_that_is_wanted() -> void:
	Engine.physics_ticks_per_second = 20
	await _set_up("child", 1.0)
	grip.smoothing = Grip.Smoothing.NEWEST
	device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, Vector3(0.05, 0, 0)), 0.0)
	for _i: int in 20:
		device.advance_cycles(5)
		await frames(1)
		check_near(grip.global_position.distance_to(device.get_grip_transform().origin), 0.0, ROUNDING_M, "as new as the device's pose")
	await _leave()


func test_with_the_engines_interpolation_it_interpolates_once() -> void:
	Engine.physics_ticks_per_second = 20
	tree.physics_interpolation = true
	await _set_up("child", 1.0)
	grip.physics_interpolation_mode = Node.PHYSICS_INTERPOLATION_MODE_ON
	var off: Array[float] = [0.0]
	var steps: PackedFloat64Array = await _steps_of_frames(func() -> float:
		off[0] = maxf(off[0], absf(grip.global_position.x - device.get_grip_transform().origin.x))
		return grip.get_global_transform_interpolated().origin.x)
	print("INFO steps of frames by the engine: %s" % _spread(steps))
	check_near(off[0], 0.0, ROUNDING_M, "the node itself stands at the tick's pose")
	check(_spread(steps) < 0.2, "what is drawn is smooth: %f" % _spread(steps))
	await _leave()
	tree.physics_interpolation = false


func test_it_follows_the_proxy_where_surfaces_stop_it() -> void:
	for order: String in ["child", "earlier in the tree"]:
		await set_up(Vector3.ZERO)
		_add_grip(order, func() -> Transform3D: return hand.get_proxy_transform())
		grip.follow = Grip.Follow.PROXY
		await move_to(Vector3(0, FLOOR_Y - 0.01, 0), 0.0, 60)
		await physics_frames(30)
		var sunk: float = grip.global_position.y - device.get_grip_transform().origin.y
		check(sunk > 0.003, "%s: the proxy stays above the device: %f m" % [order, sunk])
		check_near(seen_apart_m, 0.0, ROUNDING_M, "%s: apart in a tick" % order)
		await _leave()


func test_it_follows_a_held_body_to_the_tick() -> void:
	await set_up(Vector3(0.0, FLOOR_Y + 0.03, 0.0))
	# The hand carries in its own tick, and comes after this node in the tree.
	device.move_child(hand, -1)
	_add_grip("child", func() -> Transform3D: return hand.get_proxy_transform())
	device.move_child(grip, 0)
	grip.follow = Grip.Follow.PROXY
	grip.get_child(0).process_physics_priority = grip.process_physics_priority
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1)
	await grasp(body)
	check(hand.get_held_body() == body, "held")
	seen_apart_m = 0.0
	seen_ticks = 0
	await move_to(Vector3(0.05, 0.05, 0.0), SQUEEZE_ANGLE, 60)
	check(seen_ticks >= 60 and hand.get_held_body() == body, "still held")
	check_near(seen_apart_m, 0.0, ROUNDING_M, "apart in a tick")
	await _leave()


func test_without_a_device_it_stays_and_says_why() -> void:
	grip = Grip.new()
	grip.position = Vector3(1, 2, 3)
	add(grip)
	check(grip._get_configuration_warnings()[0].contains("spidar_path"), "the remedy is named")
	await physics_frames(3)
	check_equal(grip.position, Vector3(1, 2, 3), "it stays")
	check(not grip.is_physics_processing() and not grip.is_processing(), "and costs nothing")
	grip.spidar_path = ^"nowhere"
	check(grip._get_configuration_warnings()[0].contains("nowhere"), "the path is named")
	device = ideal_device()
	add(device)
	grip.spidar_path = grip.get_path_to(device)
	grip.follow = Grip.Follow.PROXY
	check(grip._get_configuration_warnings()[0].contains("SpidarGHand"), "no proxy without a hand")
	await physics_frames(3)
	check_near(grip.global_position.distance_to(device.get_grip_transform().origin), 0.0, ROUNDING_M, "it follows the grip then")
	device.free()
	await physics_frames(3)
	check(not grip.is_physics_processing(), "a freed device is no longer followed")
	grip.free()


func _set_up(place: String, scale_of_scene: float) -> void:
	device = ideal_device()
	device.workspace_scale = scale_of_scene
	device.transform = Transform3D(Basis(Vector3.UP, 0.3), Vector3(0.1, 0.2, -0.1))
	_add_grip(place, func() -> Transform3D: return device.get_grip_transform())
	await physics_frames(3)
	seen_apart_m = 0.0
	seen_ticks = 0


## The device is added to the tree as well, unless it is there.
func _add_grip(place: String, wanted: Callable) -> void:
	grip = Grip.new()
	var witness := Witness.new()
	witness.look = func() -> void:
		var where: Transform3D = wanted.call()
		seen_ticks += 1
		seen_apart_m = maxf(seen_apart_m, grip.global_position.distance_to(where.origin))
		seen_apart_m = maxf(seen_apart_m, (grip.global_basis.x - where.basis.x).length())
	grip.add_child(witness)
	match place:
		"child":
			device.add_child(grip)
		"below a scaled child":
			var between := Node3D.new()
			between.scale = Vector3(2, 2, 2)
			between.position.x = 4.0
			between.add_child(grip)
			device.add_child(between)
		"earlier in the tree":
			var elsewhere := Node3D.new()
			elsewhere.position = Vector3(5, 6, 7)
			elsewhere.add_child(grip)
			add(elsewhere)
			tree.root.move_child(elsewhere, 0)
	if not device.is_inside_tree():
		add(device)
	if place == "earlier in the tree":
		grip.spidar_path = grip.get_path_to(device)
		# After the node, which had to be put behind the device.
		witness.process_physics_priority = grip.process_physics_priority
	seen_apart_m = 0.0


func _leave() -> void:
	if grip.get_parent() != device:
		grip.get_parent().free()
	device.free()
	for node: Node in tree.root.get_children():
		if node is PhysicsBody3D:
			node.free()
	Engine.physics_ticks_per_second = 60
	at = Vector3.ZERO
	angle = 0.0
	await physics_frames(2)


func _swing(ticks: int) -> void:
	for i: int in ticks:
		var turn := Basis(Vector3(1, 2, 0.5).normalized(), 0.3 * sin(0.2 * i))
		var target := Transform3D(turn, Vector3(0.05 * sin(0.15 * i), 0.03, 0.0))
		device.set_simulated_hand_target(device.transform * target, 0.2)
		await physics_frames(1)


## How far `value` moves from frame to frame while the hand goes at 0.1 m/s.
func _steps_of_frames(value: Callable) -> PackedFloat64Array:
	var steps: PackedFloat64Array = []
	var start: Vector3 = device.position
	var last: float = 0.0
	var now: Array[float] = [0.0]
	var witness: Witness = grip.get_child(0)
	witness.process_priority = grip.process_priority
	witness.look_when_drawn = func() -> void: now[0] = value.call()
	for i: int in 60:
		var target := Transform3D(device.basis, start + Vector3(0.1 * (i + 1) / 60.0 - 0.05, 0, 0))
		device.set_simulated_hand_target(target, 0.0)
		await frames(1)
		if i >= 36:
			steps.append(now[0] - last)
		last = now[0]
	witness.look_when_drawn = Callable()
	return steps


## Largest step less smallest, as a part of the mean step.
func _spread(steps: PackedFloat64Array) -> float:
	var least: float = INF
	var most: float = -INF
	var sum: float = 0.0
	for step: float in steps:
		least = minf(least, step)
		most = maxf(most, step)
		sum += step
	return (most - least) * steps.size() / sum
