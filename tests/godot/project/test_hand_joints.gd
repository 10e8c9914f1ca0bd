## SpidarGHand: what is held on a joint moves only as the joint lets it, and its springs, dampers, limits and motors are felt.
extends "res://hand_scene.gd"

const HANDLE := Vector3(0.03, 0.04, 0.03)
## From the hinge to the handle, along z.
const LEVER: float = 0.08
const SPRING: float = 0.25
const DAMPING: float = 0.08

var _turn := Basis.IDENTITY
var _body: RigidBody3D
var _joint: Joint3D


func test_a_doors_spring_is_felt_as_torque_against_angle() -> void:
	for held_is_first: bool in [false, true]:
		await _hold(_hinge_with_spring(0.0), held_is_first)
		for angle: float in [0.4, -0.3, 0.7]:
			await _swing_to(angle, 60)
			await physics_frames(60)
			var felt: float = await _torque_felt(30)
			var opened: float = _angle()
			print("INFO door at %.3f of %.1f rad: %.4f N m, spring %.4f N m" % [opened, angle, felt, -SPRING * opened])
			check_near(felt, -SPRING * opened, 0.05 * SPRING * absf(opened), "torque of the spring at %.1f rad" % angle)
			check_near(opened, angle, 0.12, "it follows the hand")
			_check_on_joint()
		_free_all()
		await physics_frames(2)


func test_a_door_that_is_tied_to_the_world_moves_and_feels_as_one_on_a_post() -> void:
	for held_is_first: bool in [false, true]:
		# The engine takes the world for the first body, whichever of the two is empty, and counts turns the other way round.
		var hinge: Generic6DOFJoint3D = _hinge_with_spring(0.0)
		hinge.set_flag_y(Generic6DOFJoint3D.FLAG_ENABLE_ANGULAR_LIMIT, true)
		hinge.set_param_y(Generic6DOFJoint3D.PARAM_ANGULAR_LOWER_LIMIT, -0.7)
		hinge.set_param_y(Generic6DOFJoint3D.PARAM_ANGULAR_UPPER_LIMIT, 0.2)
		await _hold(hinge, held_is_first, 0.05, LEVER, true)
		for angle: float in [0.4, -0.15]:
			await _swing_to(angle, 60)
			await physics_frames(60)
			var felt: float = await _torque_felt(30)
			check_near(felt, -SPRING * _angle(), 0.05 * SPRING * absf(_angle()), "torque of the spring at %.1f rad" % angle)
			check_near(_angle(), angle, 0.12, "it follows the hand")
			_check_on_joint()
		await _swing_to(-0.5, 60)
		await physics_frames(60)
		check_near(_angle(), -0.2, 0.01, "its limit")
		_check_on_joint()
		_free_all()
		await physics_frames(2)


func test_a_doors_damping_is_felt_at_speed() -> void:
	await _hold(_hinge_with_spring(DAMPING))
	(_joint as Generic6DOFJoint3D).set_param_y(Generic6DOFJoint3D.PARAM_ANGULAR_SPRING_STIFFNESS, 0.0)
	await physics_frames(5)
	# 0.6 rad/s, in the middle of the way.
	await _swing_to(0.2, 20)
	var felt: float = 0.0
	for i: int in 40:
		await _swing_to(0.2 + 0.01 * (i + 1), 1)
		felt += _torque_now() / 20.0 if i >= 20 else 0.0
	print("INFO door at 0.6 rad/s: %.4f N m, due %.4f" % [felt, -DAMPING * 0.6])
	check_near(felt, -DAMPING * 0.6, 0.05 * DAMPING * 0.6, "torque of the damper")
	_check_on_joint()


func test_a_doors_own_damping_counts_too() -> void:
	var hinge := HingeJoint3D.new()
	hinge.rotation.x = -0.5 * PI # its z axis is up
	await _hold(hinge)
	_body.angular_damp_mode = RigidBody3D.DAMP_MODE_REPLACE
	_body.angular_damp = 40.0
	_body.inertia = Vector3.ONE * 0.002
	await physics_frames(3)
	var state: PhysicsDirectBodyState3D = PhysicsServer3D.body_get_direct_state(_body.get_rid())
	var inertia: float = 1.0 / state.inverse_inertia_tensor.y.y
	var due: float = -40.0 * inertia * 0.6
	await _swing_to(0.2, 20)
	var felt: float = 0.0
	for i: int in 40:
		await _swing_to(0.2 + 0.01 * (i + 1), 1)
		felt += _torque_now() / 20.0 if i >= 20 else 0.0
	print("INFO door with angular_damp 40: %.4f N m, due %.4f" % [felt, due])
	check_near(felt, due, 0.05 * absf(due), "the body's own damping")


func test_a_hinges_limits_stop_the_hand_within_a_degree() -> void:
	for held_is_first: bool in [false, true]:
		var hinge := HingeJoint3D.new()
		hinge.rotation.x = -0.5 * PI
		hinge.set_flag(HingeJoint3D.FLAG_USE_LIMIT, true)
		hinge.set_param(HingeJoint3D.PARAM_LIMIT_LOWER, -0.2)
		hinge.set_param(HingeJoint3D.PARAM_LIMIT_UPPER, 0.5)
		await _hold(hinge, held_is_first)
		# The engine counts turns of the first body in the second one.
		var ends: Vector2 = Vector2(-0.2, 0.5) if held_is_first else Vector2(-0.5, 0.2)
		for end: float in [ends.x, ends.y]:
			await _swing_to(end + 0.25 * signf(end), 90)
			await physics_frames(30)
			check_near(_angle(), end, deg_to_rad(1.0), "limit at %.1f rad" % end)
			var felt: float = await _torque_felt(20)
			check(felt * signf(end) < -0.1, "and is felt: %.3f N m at %.1f rad" % [felt, end])
			_check_on_joint()
			await _swing_to(0.0, 60)
		_free_all()
		await physics_frames(2)


func test_a_drawer_slides_along_its_rail_alone() -> void:
	var slider := SliderJoint3D.new()
	slider.rotation.y = -0.5 * PI # its x axis is z
	slider.set_param(SliderJoint3D.PARAM_LINEAR_LIMIT_LOWER, -0.02)
	slider.set_param(SliderJoint3D.PARAM_LINEAR_LIMIT_UPPER, 0.04)
	await _hold(slider)
	var rest: Vector3 = _body.global_position
	await move_to(rest + Vector3(0.0, 0.0, 0.03), SQUEEZE_ANGLE, 60)
	await physics_frames(30)
	check_near(_body.global_position.z - rest.z, 0.03, 0.002, "it is pulled out")
	await move_to(at + Vector3(0.0, 0.006, 0.0), SQUEEZE_ANGLE, 30)
	await physics_frames(30)
	var felt: PackedFloat64Array = await mean_felt(20)
	check(felt[1] < -0.8, "lifted, it pulls down: %.2f N" % felt[1])
	check_near(felt[2], 0.0, 0.1, "and nothing along its way")
	check_near(_body.global_position.y, rest.y, 0.0003, "it stays on its rail")
	await move_to(rest + Vector3(0.0, 0.0, 0.06), SQUEEZE_ANGLE, 60)
	await physics_frames(30)
	check_near(_body.global_position.z - rest.z, 0.04, 0.0005, "its end")
	felt = await mean_felt(20)
	check(felt[2] < -0.8, "is felt: %.2f N" % felt[2])
	await move_to(rest - Vector3(0.0, 0.0, 0.04), SQUEEZE_ANGLE, 90)
	await physics_frames(30)
	check_near(_body.global_position.z - rest.z, -0.02, 0.0005, "the other end")


func test_a_lever_on_a_hinge_weighs_as_its_angle_says() -> void:
	var hinge := HingeJoint3D.new()
	hinge.rotation.y = 0.5 * PI # its z axis is x
	await _hold(hinge, false, 0.12)
	_body.gravity_scale = 1.0
	await physics_frames(60)
	var felt: PackedFloat64Array = await mean_felt(30)
	var weight: float = 0.12 * GRAVITY
	# Carried by the hinge and by the hand, whose torque about the hinge is all the weight's.
	var lever: Vector3 = device.get_grip_transform().origin - _joint.global_position
	var torque: float = (Vector3(felt[3], felt[4], felt[5]) + lever.cross(Vector3(felt[0], felt[1], felt[2]))).x
	var center: Vector3 = _body.to_global(PhysicsServer3D.body_get_direct_state(_body.get_rid()).center_of_mass_local) - _joint.global_position
	var due: float = center.cross(Vector3(0.0, -weight, 0.0)).x
	print("INFO lever: %.4f N m, weight %.4f N m" % [torque, due])
	check_near(torque, due, 0.05 * absf(due), "weight about the hinge")


func test_a_knob_turns_in_its_place() -> void:
	var knob := Generic6DOFJoint3D.new()
	knob.set_flag_y(Generic6DOFJoint3D.FLAG_ENABLE_ANGULAR_LIMIT, false)
	knob.set_flag_y(Generic6DOFJoint3D.FLAG_ENABLE_ANGULAR_SPRING, true)
	knob.set_param_y(Generic6DOFJoint3D.PARAM_ANGULAR_SPRING_STIFFNESS, 0.1)
	await _hold(knob, false, 0.05, 0.0)
	var rest: Vector3 = _body.global_position
	for i: int in 60:
		_turn = Basis(Vector3.UP, 0.8 * (i + 1) / 60.0)
		device.set_simulated_hand_target(Transform3D(_turn, at + Vector3(0.004, 0.0, 0.0) * (i + 1) / 60.0), angle)
		await physics_frames(1)
	await physics_frames(60)
	var felt: PackedFloat64Array = await mean_felt(20)
	check_near(felt[4], -0.1 * _angle(), 0.05 * 0.1 * _angle(), "its spring at %.2f rad" % _angle())
	check(felt[0] < -0.5, "it stays in its place: %.2f N" % felt[0])
	check_near(_body.global_position.distance_to(rest), 0.0, 0.0003, "and does not move from it")


func test_pulled_at_random_nothing_leaves_its_joint_or_jolts_or_gives_energy() -> void:
	for kind: String in ["door", "drawer", "lever", "knob"]:
		await _hold(_joint_of(kind), false, 0.05, 0.0 if kind == "knob" else LEVER)
		await _pull_at_random(kind, maxi(OS.get_environment("SPIDAR_JOINT_SECONDS").to_int(), 5))
		_free_all()
		await physics_frames(2)


func _pull_at_random(kind: String, seconds: int) -> void:
	var random := RandomNumberGenerator.new()
	random.seed = 3
	var from := Transform3D.IDENTITY
	var to := Transform3D.IDENTITY
	var worst: float = 0.0
	Engine.physics_ticks_per_second = 1000
	var before := Vector3.INF
	for i: int in 1000 * seconds:
		if i % 400 == 0:
			from = to
			to = Transform3D.IDENTITY if i + 400 >= 1000 * seconds else _random_pose(kind, random)
		device.set_simulated_hand_target(from.interpolate_with(to, minf((i % 400) / 300.0, 1.0)), angle)
		if i % 16 == 0:
			await physics_frames(1)
		else:
			device.advance_cycles(1)
		var felt: PackedFloat64Array = device.get_requested_wrench()
		var force := Vector3(felt[0], felt[1], felt[2])
		worst = maxf(worst, (force - before).length()) if before.is_finite() else 0.0
		before = force
	Engine.physics_ticks_per_second = 60
	var given: float = 0.0
	for energy: float in device.get_injected_energy():
		given += energy
	# At 60 ticks a second, so that the physics engine has its time.
	var off: float = 0.0
	for i: int in 60 * 10:
		if i % 24 == 0:
			from = to
			to = _random_pose(kind, random)
		device.set_simulated_hand_target(from.interpolate_with(to, minf((i % 24) / 18.0, 1.0)), angle)
		await physics_frames(1)
		off = maxf(off, _off_its_joint(kind))
	print("INFO %s, %d s at random: steps of the force up to %.3f N a servo cycle, %.2f mm off its joint, %.4f J given" % [
		kind, seconds, worst, 1e3 * off, given])
	check(worst < 0.5, "%s: no jolt: %.3f N" % [kind, worst])
	check(given < 0.001, "%s: no energy is given: %.4f J" % [kind, given])
	check(off < 0.001, "%s: off its joint by %.2f mm" % [kind, 1e3 * off])
	check_equal(hand.get_held_body(), _body, "%s: still held" % kind)
	check(device.get_state() == SpidarG.STATE_ACTIVE, "%s: forces go on: %s" % [kind, device.get_state_text()])


func _random_pose(kind: String, random: RandomNumberGenerator) -> Transform3D:
	var beside := Vector3(random.randfn(), random.randfn(), random.randfn()) * 0.0015
	var opened: float = random.randf_range(-0.6, 0.6)
	match kind:
		"door":
			return _opened(opened, beside)
		"drawer":
			return Transform3D(Basis.IDENTITY, beside + Vector3(0.0, 0.0, 0.05 * opened))
		"lever":
			var turn := Basis(Vector3.RIGHT, opened)
			return Transform3D(turn, Vector3(0.0, 0.0, -LEVER) + turn * Vector3(0.0, 0.0, LEVER) + beside)
		_:
			return Transform3D(Basis(Vector3.UP, opened), beside)


func _joint_of(kind: String) -> Joint3D:
	match kind:
		"door":
			return _hinge_with_spring(0.01)
		"drawer":
			var slider := SliderJoint3D.new()
			slider.rotation.y = -0.5 * PI
			slider.set_param(SliderJoint3D.PARAM_LINEAR_LIMIT_LOWER, -0.02)
			slider.set_param(SliderJoint3D.PARAM_LINEAR_LIMIT_UPPER, 0.02)
			return slider
		"lever":
			var hinge := HingeJoint3D.new()
			hinge.rotation.y = 0.5 * PI
			return hinge
		_:
			return _hinge_with_spring(0.0)


## How far the body's joint has come apart: where it ties the body, from where it stands.
func _off_its_joint(kind: String) -> float:
	var apart: Vector3 = _body.to_global(_joint.position) - _joint.global_position
	return Vector2(apart.x, apart.y).length() if kind == "drawer" else apart.length()


var _aimed: float = 0.0


func _hinge_with_spring(damping: float) -> Generic6DOFJoint3D:
	var hinge := Generic6DOFJoint3D.new()
	hinge.set_flag_y(Generic6DOFJoint3D.FLAG_ENABLE_ANGULAR_LIMIT, false)
	hinge.set_flag_y(Generic6DOFJoint3D.FLAG_ENABLE_ANGULAR_SPRING, true)
	hinge.set_param_y(Generic6DOFJoint3D.PARAM_ANGULAR_SPRING_STIFFNESS, SPRING)
	hinge.set_param_y(Generic6DOFJoint3D.PARAM_ANGULAR_SPRING_DAMPING, damping)
	return hinge


## A body with a handle at the origin, tied to a post at LEVER behind it, and held.
func _hold(joint: Joint3D, held_is_first: bool = false, mass: float = 0.05, lever: float = LEVER,
		to_the_world: bool = false) -> void:
	at = Vector3.ZERO
	angle = 0.0
	_turn = Basis.IDENTITY
	await set_up(Vector3.ZERO)
	hand.weight_scale = 1.0
	_body = add_box(HANDLE, Vector3.ZERO, mass) as RigidBody3D
	_body.gravity_scale = 0.0
	var post := StaticBody3D.new()
	post.position = Vector3(0.0, 0.0, -lever)
	add(post)
	_joint = joint
	joint.position = post.position
	add(joint)
	if not to_the_world or held_is_first:
		joint.node_a = joint.get_path_to(_body if held_is_first else post)
	if not to_the_world or not held_is_first:
		joint.node_b = joint.get_path_to(post if held_is_first else _body)
	await move_to(Vector3.ZERO, SQUEEZE_ANGLE, 40)
	await physics_frames(40)
	check_equal(hand.get_held_body(), _body, "the handle is held")


func _free_all() -> void:
	device.free()
	_joint.free()
	_body.free()


## Where the hand is with the door open by `opened`, beside it by `beside`.
func _opened(opened: float, beside: Vector3 = Vector3.ZERO) -> Transform3D:
	var turn := Basis(Vector3.UP, opened)
	return Transform3D(turn, Vector3(0.0, 0.0, -LEVER) + turn * Vector3(0.0, 0.0, LEVER) + beside)


func _swing_to(opened: float, frame_count: int) -> void:
	var from: float = _aimed if frame_count > 1 else opened
	for i: int in frame_count:
		device.set_simulated_hand_target(_opened(lerpf(from, opened, float(i + 1) / frame_count)), angle)
		await physics_frames(1)
	_aimed = opened


func _angle() -> float:
	return _body.global_rotation.y


## Of what the hand feels, about the door's hinge.
func _torque_now() -> float:
	var felt: PackedFloat64Array = device.get_simulated_truth()["strings_wrench"]
	var grip: Transform3D = device.get_simulated_truth()["grip_transform"]
	var lever: Vector3 = grip.origin - _joint.global_position
	return felt[4] + lever.cross(Vector3(felt[0], felt[1], felt[2])).y


func _torque_felt(frame_count: int) -> float:
	var sum: float = 0.0
	for _i: int in frame_count:
		await physics_frames(1)
		sum += _torque_now() / frame_count
	return sum


## The body is where its joint lets it be: on the arc, and upright.
func _check_on_joint() -> void:
	var lever: Vector3 = _body.global_position - _joint.global_position
	check_near(lever.length(), LEVER, 0.0004, "on its arc")
	check_near(lever.y, 0.0, 0.0004, "at its height")
	check_near(_body.global_basis.y.angle_to(Vector3.UP), 0.0, 0.01, "upright")
