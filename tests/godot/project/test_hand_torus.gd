## SpidarGHand: a torus is felt as one, from outside and from inside its hole, whatever it is made of.
extends "res://hand_shapes_scene.gd"

const KINDS: PackedStringArray = ["trimesh 3", "trimesh 6", "trimesh 12", "two-sided 6", "csg 6", "csg 12"]
const MIDDLE_M: float = 0.09
const TUBE_M: float = 0.02
const BALL_M: float = 0.02
const DEPTH_M: float = 0.008
## Between the corners of the meshes, which lie at quarters and at whole fractions of them.
const YAW: float = 0.353
const SAME: float = 0.05
const RIPPLE_N: float = 0.05
const SLIDING_TICKS: int = 960
## Single cycles differ by 0.1 N over a cylinder too, by the encoders' counts. So the ripple is that of means of 8 ms, beside
## a cylinder's. Without encoders it is in tests/device/contact/touch/test_touch_torus.cpp.
const MEAN_OF: int = 8
## The servo loop sees the grip 3 ms ahead, and a contact's damper (2 N s/m of 720 N/m) adds another 2.8 ms: what it asks for
## belongs to the depth so many ticks later.
const AHEAD: int = 6
## The flat faces of triangles of 12 mm lie up to 0.17 mm inside the torus and lean by up to 3.2 degrees from it. That alone
## makes a ripple of 0.13 N and 5.6 % sideways: no torus is felt, but what is there.
const COARSE_MM: int = 12

## Of the held ball's middle, in the grip.
var in_grip := Vector3.ZERO


## A pad's back on the outer rim: the finger gives way before the surface does.
func test_a_pad_on_the_outside_of_a_torus() -> void:
	await set_up_empty()
	for kind: String in KINDS:
		var torus: Node3D = _torus(kind, Vector3(0.1 + MIDDLE_M + TUBE_M, 0.0, 0.0))
		await go(Vector3(0.1 - REACH_M - 0.02, 0.0, 0.0), 20)
		await until_felt()
		await go(Vector3(0.1 - REACH_M + DEPTH_M, 0.0, 0.0), 40)
		await physics_frames(40)
		note_depth()
		var felt: Vector3 = force_of(await mean_felt(10))
		var face: float = device.get_grip_transform().origin.x + 0.5 * _gap(device.get_grasp_angle()) + 0.006
		# Of half a gap, m/rad: how the pad's face moves with the fingers.
		var slope: float = 0.5 * (_gap(0.1) - _gap(0.2)) / 0.1
		var limits: Vector3 = device.get_stiffness_limits()
		var due: float = (face - 0.1) / (1.0 / (0.6 * limits.x) + slope * slope / (0.6 * limits.z))
		_compare("pad outside, %s" % kind, felt, Vector3(-due, 0.0, 0.0))
		await go(Vector3.ZERO, 20)
		torus.free()
	check_equal(shakes, 0, "nothing shakes")
	check_shown_outside()


func test_a_ball_on_the_outside_and_in_the_hole() -> void:
	if not await _hold_a_ball():
		return
	for kind: String in KINDS:
		for outside: bool in [true, false]:
			var torus: Node3D = _torus(kind, Vector3(0.0, 0.0, 0.04 + MIDDLE_M + TUBE_M) if outside else Vector3.ZERO)
			var touch: float = 0.04 - BALL_M if outside else MIDDLE_M - TUBE_M - BALL_M
			await go(Vector3(0.0, 0.0, touch - 0.01), 20, Basis.IDENTITY, SQUEEZE_ANGLE)
			await until_felt()
			await go(Vector3(0.0, 0.0, touch + DEPTH_M), 40, Basis.IDENTITY, SQUEEZE_ANGLE)
			await physics_frames(40)
			note_depth()
			var felt: Vector3 = force_of(await mean_felt(10))
			var due: Vector3 = _due(torus.position)
			_compare("ball %s, %s" % ["outside" if outside else "in the hole", kind], felt, due, _lean(kind))
			await go(Vector3.ZERO, 20, Basis.IDENTITY, SQUEEZE_ANGLE)
			torus.free()
			await physics_frames(2)
	check(hand.get_held_body() != null, "the ball is still held")
	check_equal(shakes, 0, "nothing shakes")


## The fingers turn with the way, so that the ball alone touches.
func test_sliding_round_a_torus_is_smooth() -> void:
	if not await _hold_a_ball():
		return
	for speed: float in [0.1, 0.4]:
		# Its round side is the torus' outer rim.
		var own: float = await _slide("cylinder", true, speed, 0.0)
		check(own < RIPPLE_N, "a cylinder is smooth: %.4f N" % own)
		for kind: String in KINDS:
			for outside: bool in [true, false]:
				await _slide(kind, outside, speed, own)
	check(hand.get_held_body() != null, "the ball is still held")
	check_equal(shakes, 0, "nothing shakes")


## A ball slides on a part of the outer rim, or round in the hole. The ripple, N.
func _slide(kind: String, outside: bool, speed: float, own: float) -> float:
	var middle := Vector3(0.0, 0.0, 0.04 + MIDDLE_M + TUBE_M) if outside else Vector3.ZERO
	var radius: float = MIDDLE_M + TUBE_M + BALL_M - DEPTH_M if outside else MIDDLE_M - TUBE_M - BALL_M + DEPTH_M
	var half: float = 0.3 if outside else 0.9
	var place: Callable = func(angle_rad: float) -> Vector3:
		var out := Vector3(sin(angle_rad), 0.0, -cos(angle_rad) if outside else cos(angle_rad))
		return middle + radius * out
	var turned: Callable = func(angle_rad: float) -> Basis:
		return Basis(Vector3.UP, -angle_rad if outside else angle_rad)
	var torus: Node3D = _torus(kind, middle)
	await go(Vector3.ZERO, 20, turned.call(-half), SQUEEZE_ANGLE)
	await until_felt()
	await go(place.call(-half), 40, turned.call(-half), SQUEEZE_ANGLE)
	await physics_frames(30)
	Engine.max_physics_steps_per_frame = 100
	Engine.physics_ticks_per_second = SLIDING_TICKS
	await physics_frames(40)
	var asked: PackedFloat64Array = []
	var due: PackedFloat64Array = []
	var sum: float = 0.0
	var count: int = roundi(SLIDING_TICKS * 2.0 * half * radius / speed)
	for i: int in count:
		var angle_rad: float = half * (2.0 * (i + 1) / count - 1.0)
		at = place.call(angle_rad)
		turn = turned.call(angle_rad)
		device.set_simulated_hand_target(Transform3D(turn, at), SQUEEZE_ANGLE)
		await physics_frames(1)
		var due_now: Vector3 = _due(middle)
		if i > count / 8:  # once the hand is under way
			asked.append(force_of(device.get_requested_wrench()).dot(due_now.normalized()))
			due.append(due_now.length())
			sum += asked[-1]
	Engine.physics_ticks_per_second = 60
	Engine.max_physics_steps_per_frame = 8
	var errors: PackedFloat64Array = []
	for i: int in asked.size() - AHEAD:
		errors.append(asked[i] - due[i + AHEAD])
	var ripple: float = _ripple(errors)
	var name: String = "%s, %s at %.1f m/s" % ["outside" if outside else "in the hole", kind, speed]
	var faces_n: float = _sagitta(kind, MIDDLE_M + TUBE_M if outside else MIDDLE_M - TUBE_M) * _stiffness()
	print("INFO sliding %s: %.3f N, ripple %.4f N, of flat faces %.4f N" % [name, sum / asked.size(), ripple, faces_n])
	check(sum / asked.size() > 1.0, "%s is felt: %.3f N" % [name, sum / asked.size()])
	var most: float = own + RIPPLE_N + (faces_n if _is_coarse(kind) else 0.0)
	check(ripple <= most, "%s ripples by %.4f N, a cylinder by %.4f N" % [name, ripple, own])
	await go(Vector3.ZERO, 20, Basis.IDENTITY, SQUEEZE_ANGLE)
	torus.free()
	await physics_frames(2)
	return ripple


## A hand that holds a ball without weight at its centre.
func _hold_a_ball() -> bool:
	await set_up_empty()
	hand.render_weight = false
	hand.render_inertia = false
	var ball := RigidBody3D.new()
	var sphere := SphereShape3D.new()
	sphere.radius = BALL_M
	Solids.add_shape(ball, sphere)
	ball.mass = 0.02
	ball.gravity_scale = 0.0
	add(ball)
	await go(Vector3.ZERO, 40, Basis.IDENTITY, SQUEEZE_ANGLE)
	await physics_frames(40)
	in_grip = hand.get_proxy_transform().affine_inverse() * ball.global_position
	return check(hand.get_held_body() == ball, "the ball is held")


func _torus(kind: String, middle: Vector3) -> Node3D:
	var torus: Node3D
	if kind == "cylinder":
		var shape := CylinderShape3D.new()
		shape.radius = MIDDLE_M + TUBE_M
		shape.height = 2.0 * TUBE_M
		torus = Solids.static_body(shape)
	else:
		torus = Solids.torus(kind, MIDDLE_M, TUBE_M)
	torus.position = middle
	torus.rotation.y = YAW
	add(torus)
	return torus


## What the linear stiffness makes of the depth of the held ball, where the device is, in the true torus.
func _due(middle: Vector3) -> Vector3:
	var from: Vector3 = device.get_grip_transform() * in_grip - middle
	var ring: Vector3 = MIDDLE_M * Vector3(from.x, 0.0, from.z).normalized()
	var out: Vector3 = from - ring
	var depth: float = BALL_M + TUBE_M - out.length()
	return _stiffness() * maxf(depth, 0.0) * out.normalized()


func _stiffness() -> float:
	return 0.6 * device.get_stiffness_limits().x


func _is_coarse(kind: String) -> bool:
	return kind.get_slice(" ", 1).to_int() >= COARSE_MM


## Half of the angle between two faces round the torus.
func _half_turn(kind: String) -> float:
	return PI / Solids.edges_around(MIDDLE_M + TUBE_M, kind)


## How far a face's middle lies inside the circle of its corners.
func _sagitta(kind: String, radius: float) -> float:
	return radius * (1.0 - cos(_half_turn(kind))) if kind != "cylinder" else 0.0


## What of a force may be sideways for the faces of coarse triangles lean.
func _lean(kind: String) -> float:
	return _half_turn(kind) if _is_coarse(kind) else 0.0


func _ripple(errors: PackedFloat64Array) -> float:
	var least: float = INF
	var most: float = -INF
	for i: int in errors.size() - MEAN_OF + 1:
		var mean: float = 0.0
		for k: int in MEAN_OF:
			mean += errors[i + k] / MEAN_OF
		least = minf(least, mean)
		most = maxf(most, mean)
	return most - least


func _gap(angle_rad: float) -> float:
	var config: SpidarGConfig = device.get_effective_config()
	return config.jaw_open * maxf(0.0, 1.0 - angle_rad / config.jaw_closed_angle)


func _compare(name: String, felt: Vector3, due: Vector3, lean: float = 0.0) -> void:
	var apart: float = felt.distance_to(due) / due.length()
	print("INFO %s: %s N, %s N due, off by %.2f %%" % [name, felt, due, 100.0 * apart])
	check(due.length() > 0.2, "%s is felt: %s" % [name, felt])
	check(apart <= SAME + lean, "%s: %s N, %s N is due" % [name, felt, due])
