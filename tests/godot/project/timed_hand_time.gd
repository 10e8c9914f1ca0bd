## The same with a device in a thread of its own, in real time: physics ticks of one drawn frame read one pose.
extends "res://hand_time_scene.gd"


func test_drawn_at_15_frames_a_second() -> void:
	await _drawn(15, 60, 1.0)


func test_drawn_at_30_frames_a_second_in_slow_motion() -> void:
	await _drawn(30, 60, 0.1)


func test_drawn_at_144_frames_a_second_in_fast_motion() -> void:
	await _drawn(144, 60, 3.0)


func test_four_ticks_a_frame() -> void:
	await _drawn(60, 240, 1.0)


func _drawn(frame_rate: int, rate: int, time_scale: float) -> void:
	with_inertia = false
	drive_mode = SpidarG.DRIVE_THREADED
	Engine.max_fps = frame_rate
	Engine.physics_ticks_per_second = rate
	await play(time_scale, "%d frames and %d ticks a second, time scale %s" % [frame_rate, rate, time_scale])
