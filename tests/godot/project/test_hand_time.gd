## SpidarGHand: squeeze, weight, inertia and the force that breaks a hold are the device's, whatever the game's time does.
extends "res://hand_time_scene.gd"

const RATES: Array[int] = [24, 30, 60, 120, 240]
## Drawn frames and physics ticks a second.
const FRAMES: Array[Vector2i] = [
	Vector2i(15, 60), Vector2i(15, 240), Vector2i(24, 60), Vector2i(30, 24), Vector2i(40, 60), Vector2i(60, 240), Vector2i(144, 60)
]


func test_at_full_speed() -> void:
	await _at_every_rate(1.0)


func test_in_slow_motion() -> void:
	await _at_every_rate(0.1)


func test_in_fast_motion() -> void:
	await _at_every_rate(3.0)


func test_while_time_stands_still() -> void:
	await _at_every_rate(0.0)


func test_drawn_at_any_rate_at_full_speed() -> void:
	await _at_every_frame_rate(1.0)


func test_drawn_at_any_rate_in_slow_motion() -> void:
	await _at_every_frame_rate(0.1)


func test_drawn_at_any_rate_in_fast_motion() -> void:
	await _at_every_frame_rate(3.0)


func test_drawn_at_any_rate_while_time_stands_still() -> void:
	await _at_every_frame_rate(0.0)


func test_nothing_is_newly_held_while_time_stands_still() -> void:
	await _prepare()
	await glide(body.global_position, 0.0, 0.5)
	Engine.time_scale = 0.0
	await glide(body.global_position, SQUEEZE_ANGLE, 0.5)
	await rest(0.5)
	check(hand.get_held_body() == null, "not held")
	check(hand.get_squeeze_torque() > 0.05, "though squeezed: %f N m" % hand.get_squeeze_torque())
	Engine.time_scale = 1.0
	await rest(0.2)
	check(hand.get_held_body() == body, "held when time goes on")
	check_equal(rejected, PackedStringArray(), "nothing was refused")


func test_a_hand_that_moves_while_time_stands_still_takes_the_body_along_afterwards() -> void:
	await _prepare()
	await glide(body.global_position, 0.0, 0.5)
	await glide(body.global_position, SQUEEZE_ANGLE, 0.5)
	await glide(at + Vector3(0.0, 0.05, 0.0), SQUEEZE_ANGLE, 0.5)
	await rest(0.3)
	Engine.time_scale = 0.0
	await glide(at + Vector3(0.1, 0.03, 0.0), SQUEEZE_ANGLE, 0.3)
	await rest(0.2)
	check(body.global_position.distance_to(at) > 0.09, "the body stays: %s" % body.global_position)
	check_near(asked(1), -MASS * GRAVITY, TOLERANCE, "its weight is felt")
	for turn: int in [3, 4, 5]:
		check_near(asked(turn), 0.0, 0.005, "and has no lever, N m")
	Engine.time_scale = 1.0
	await rest(0.3)
	check(hand.get_held_body() == body, "held")
	check_near(body.global_position.distance_to(hand.get_wanted_pose().origin), 0.0, 0.001, "and where the hand is")
	check_equal(rejected, PackedStringArray(), "nothing was refused")


func test_what_is_too_heavy_to_hold_stays_so_at_every_time_scale() -> void:
	for time_scale: float in [0.0, 0.1, 3.0]:
		await _prepare()
		body.mass = 3.0
		hand.pad_friction = 0.05
		await glide(body.global_position, 0.0, 0.5)
		Engine.time_scale = time_scale
		await glide(body.global_position, 0.72, 0.5)
		await rest(0.5)
		check(hand.get_held_body() == null, "time scale %s: not held" % time_scale)
		Engine.time_scale = 1.0
		await rest(0.3)
		check(hand.get_held_body() == null, "time scale %s: nor after it" % time_scale)
		device.free()
		body.free()


func test_poses_of_one_frame_count_as_one() -> void:
	var lone: SpidarG = ideal_device()
	var clocked := SpidarGHand.new()
	lone.add_child(clocked)
	add(lone)
	lone.set_physics_process_internal(false)
	lone.advance_cycles(1)
	var since := func() -> float: return clocked.get_touch_statistics()["since_s"]
	await physics_frames(2)
	check_near(since.call(), 0.0, 1e-9, "the first pose has none before it")
	# Cycles of 1 ms until a tick reads, and how far it is then from the last pose: half a tick of 16.7 ms is too near, and so is
	# half the way between the last two.
	for row: Array in [[17, 0.017], [5, 0.0], [12, 0.017], [60, 0.060], [3, 0.0], [20, 0.0], [37, 0.060], [16, 0.0], [16, 0.032], [16, 0.016]]:
		lone.advance_cycles(row[0])
		await physics_frames(1)
		check_near(since.call(), row[1], 1e-9, "%d cycles" % row[0])
	lone.free()


func test_device_time_goes_on_over_openings() -> void:
	var lone: SpidarG = ideal_device()
	add(lone)
	await physics_frames(1)
	var began_s: float = lone.get_device_time()
	Engine.time_scale = 0.0
	await physics_frames(60)
	check_near(lone.get_device_time() - began_s, 1.0, 0.002, "60 ticks, whatever the game's time does")
	Engine.time_scale = 1.0
	var last_s: float = lone.get_device_time()
	for round: int in 3:
		lone.enabled = false
		check(lone.get_device_time() >= last_s, "closed: not back")
		lone.enabled = true
		for _i: int in 5:
			await physics_frames(1)
			check(lone.get_device_time() >= last_s, "never back: %f s" % lone.get_device_time())
			last_s = lone.get_device_time()
	check_near(last_s - began_s, 1.25, 0.02, "closed, it stands still")


func _at_every_rate(time_scale: float) -> void:
	for rate: int in RATES:
		Engine.physics_ticks_per_second = rate
		await play(time_scale, "time scale %s, %d ticks a second" % [time_scale, rate])
	Engine.physics_ticks_per_second = 60


func _at_every_frame_rate(time_scale: float) -> void:
	for rates: Vector2i in FRAMES:
		frames_per_s = rates.x
		Engine.physics_ticks_per_second = rates.y
		await play(time_scale, "time scale %s, %d frames and %d ticks a second" % [time_scale, rates.x, rates.y])
	Engine.physics_ticks_per_second = 60
