## Two devices, two hands, one scene: what one does to a body that both hold, the other feels.
extends "res://test_case.gd"

const FLOOR_Y: float = -0.08
const SQUEEZE_ANGLE: float = 1.4
const BAR := Vector3(0.03, 0.03, 0.2)
const APART_M: float = 0.07

var _devices: Array[SpidarG] = []
var _hands: Array[SpidarGHand] = []
var _at: Array[Vector3] = []
var _angle: Array[float] = []
var _bar: RigidBody3D


func test_pulled_apart_each_feels_the_other() -> void:
	await _hold_both()
	# Along the bar, until each pulls with 2 N.
	var pull: float = 0.0
	while absf(_felt(0).z) < 2.0 and pull < 0.03:
		pull += 0.0002
		_aim(0, Vector3(0.0, 0.0, -APART_M - pull))
		_aim(1, Vector3(0.0, 0.0, APART_M + pull))
		await physics_frames(1)
	await physics_frames(40)
	var felt: Array[Vector3] = await _mean_felt(30)
	print("INFO pulled apart by %.1f mm each: %s and %s N" % [1e3 * pull, felt[0], felt[1]])
	check_near(felt[0].z, 2.0, 0.2, "the one is pulled forth")
	check_near(felt[1].z, -felt[0].z, 0.05 * felt[0].z, "the other as hard back")
	check_near(_bar.global_position.z, 0.0, 0.0005, "the bar stays in the middle")
	# One lets go.
	var before: PackedFloat64Array = _devices[0].get_requested_wrench()
	var worst: float = 0.0
	Engine.physics_ticks_per_second = 1000
	for i: int in 1200:
		_angle[1] = maxf(0.0, SQUEEZE_ANGLE * (1.0 - i / 300.0))
		_aim(1, _at[1])
		for device: SpidarG in _devices:
			if i % 16 != 0:
				device.advance_cycles(1)
		if i % 16 == 0:
			await physics_frames(1)
		var now: PackedFloat64Array = _devices[0].get_requested_wrench()
		worst = maxf(worst, Vector3(now[0] - before[0], now[1] - before[1], now[2] - before[2]).length())
		before = now
	Engine.physics_ticks_per_second = 60
	print("INFO one lets go: steps of the other's force up to %.3f N a servo cycle" % worst)
	check_equal(_hands[1].get_held_body(), null, "it has let go")
	check_equal(_hands[0].get_held_body(), _bar, "the other holds on")
	check(worst < 0.5, "no jolt: %.3f N" % worst)
	await physics_frames(30)
	felt = await _mean_felt(20)
	check_near(felt[0].z, 0.0, 0.1, "and is not pulled any more")


func test_both_carry_the_weight_together() -> void:
	await _hold_both(0.2)
	for i: int in 60:
		for k: int in 2:
			_aim(k, _at[k] + Vector3(0.0, 0.0005, 0.0))
		await physics_frames(1)
	await physics_frames(60)
	var felt: Array[Vector3] = await _mean_felt(40)
	print("INFO carried by both: %.3f and %.3f N of %.3f" % [felt[0].y, felt[1].y, -0.2 * 9.8])
	check_near(felt[0].y + felt[1].y, -0.2 * 9.8, 0.05 * 0.2 * 9.8, "all of its weight is felt")
	check_near(felt[0].y, felt[1].y, 0.2, "by both alike")
	check(_bar.global_position.y > FLOOR_Y + 0.5 * BAR.y + 0.02, "it is off the floor")


func test_one_moves_it_and_the_other_is_taken_along() -> void:
	await _hold_both()
	var start: Vector3 = _devices[1].get_grip_transform().origin
	for i: int in 60:
		_aim(0, _at[0] + Vector3(0.0002, 0.0, 0.0))
		await physics_frames(1)
	await physics_frames(60)
	var felt: Array[Vector3] = await _mean_felt(20)
	var taken: float = _devices[1].get_grip_transform().origin.x - start.x
	print("INFO one went 12 mm aside: %s N, the other was taken %.1f mm along: %s N" % [felt[0], 1e3 * taken, felt[1]])
	check(felt[0].x < -0.1, "the one feels the other's hand: %.2f N" % felt[0].x)
	check(felt[1].x > 0.1, "the other is pulled along: %.2f N" % felt[1].x)
	check(taken > 0.0003, "and follows: %.2f mm" % (1e3 * taken))


func _hold_both(mass: float = 0.05) -> void:
	_devices.clear()
	_hands.clear()
	_at = [Vector3(0.0, 0.0, -APART_M), Vector3(0.0, 0.0, APART_M)]
	_angle = [0.0, 0.0]
	var floor_body := StaticBody3D.new()
	var floor_shape := CollisionShape3D.new()
	floor_shape.shape = WorldBoundaryShape3D.new()
	floor_body.add_child(floor_shape)
	floor_body.position.y = FLOOR_Y
	add(floor_body)
	_bar = RigidBody3D.new()
	_bar.mass = mass
	var shape := CollisionShape3D.new()
	var box := BoxShape3D.new()
	box.size = BAR
	shape.shape = box
	_bar.add_child(shape)
	_bar.position.y = FLOOR_Y + 0.5 * BAR.y
	add(_bar)
	for k: int in 2:
		_at[k].y = _bar.position.y
		var device: SpidarG = ideal_device()
		device.forces_enabled = true
		device.position = Vector3(0.0, 0.0, 0.0)
		_hands.append(SpidarGHand.new())
		device.add_child(_hands[k])
		add(device)
		_devices.append(device)
		_aim(k, _at[k] + Vector3(0.0, 0.06, 0.0))
	await physics_frames(80)
	for i: int in 60:
		for k: int in 2:
			_aim(k, Vector3(0.0, lerpf(_bar.position.y + 0.06, _bar.position.y, (i + 1) / 60.0), (2 * k - 1) * APART_M))
		await physics_frames(1)
	for i: int in 60:
		for k: int in 2:
			_angle[k] = SQUEEZE_ANGLE * (i + 1) / 60.0
			_aim(k, _at[k])
		await physics_frames(1)
	await physics_frames(40)
	for k: int in 2:
		check_equal(_hands[k].get_held_body(), _bar, "hand %d holds the bar" % k)


func _aim(k: int, at: Vector3) -> void:
	_at[k] = at
	_devices[k].set_simulated_hand_target(Transform3D(Basis.IDENTITY, at), _angle[k])


func _felt(k: int) -> Vector3:
	var felt: PackedFloat64Array = _devices[k].get_simulated_truth()["strings_wrench"]
	return Vector3(felt[0], felt[1], felt[2])


func _mean_felt(frame_count: int) -> Array[Vector3]:
	var sum: Array[Vector3] = [Vector3.ZERO, Vector3.ZERO]
	for _i: int in frame_count:
		await physics_frames(1)
		for k: int in 2:
			sum[k] += _felt(k) / frame_count
	return sum
