## Nodes that come and go leave nothing behind: no thread, no device, no crash.
extends "res://test_case.gd"

const ROUNDS: int = 200


func test_random_lives_leave_no_thread() -> void:
	var random := RandomNumberGenerator.new()
	random.seed = 7
	await frames(2)
	var threads_before: int = _thread_count()
	check(threads_before > 0, "the thread count can be read")
	var home := Node3D.new()
	var other := Node3D.new()
	add(home)
	add(other)
	var most_threads: int = 0
	for round: int in ROUNDS:
		var device := SpidarG.new()
		device.drive_mode = SpidarG.DRIVE_THREADED if random.randf() < 0.7 else SpidarG.DRIVE_STEPPED
		device.forces_enabled = random.randf() < 0.7
		home.add_child(device)
		if round % 20 == 0:
			most_threads = maxi(most_threads, _thread_count())
		device.request_wrench(Vector3(0, random.randf_range(-5, 5), 0), Vector3.ZERO, 0.0)
		if random.randf() < 0.5:
			await frames(random.randi_range(1, 3))
		match random.randi_range(0, 6):
			0:
				device.free()
			1:
				device.queue_free()
			2:
				device.reparent(other)
				check(device.get_parent() == other, "reparented")
			3:
				home.remove_child(device)
				home.add_child(device)
			4:
				device.enabled = false
				check_equal(device.get_state(), SpidarG.STATE_CLOSED, "closed when not enabled")
			5:
				device.config = SpidarGConfig.new()
				device.drive_mode = SpidarG.DRIVE_THREADED
			6:
				home.remove_child(device)
				device.free()
		for child: Node in home.get_children() + other.get_children():
			if random.randf() < 0.8:
				child.queue_free()
	home.free()
	other.free()
	await frames(3)
	check(most_threads > threads_before, "devices do run threads of their own (%d > %d)" % [
		most_threads, threads_before])
	check(await until(func() -> bool: return _thread_count() == threads_before),
		"threads after %d rounds: %d, before %d" % [ROUNDS, _thread_count(), threads_before])


func test_changing_scenes_closes_and_opens_devices() -> void:
	var scene := PackedScene.new()
	var device := SpidarG.new()
	device.name = "Device"
	scene.pack(device)
	device.free()
	var threads_before: int = _thread_count()
	for _round: int in 20:
		tree.change_scene_to_packed(scene)
		await frames(3)
		check(tree.current_scene is SpidarG, "the scene is up")
		check(await until(is_open.bind(tree.current_scene)), "its device is open")
	tree.unload_current_scene()
	await frames(3)
	check(await until(func() -> bool: return _thread_count() == threads_before),
		"threads after the last scene: %d, before %d" % [_thread_count(), threads_before])


func test_threaded_device_runs_on_its_own() -> void:
	var device := SpidarG.new()
	add(device)
	# Real time: the loop must turn without any help of the game.
	await tree.process_frame
	var before: int = device.get_statistics()["ticks"]
	OS.delay_msec(300)
	await tree.process_frame
	var ticks: int = device.get_statistics()["ticks"] - before
	print("INFO %d servo cycles in 300 ms" % ticks)
	check(ticks > 30, "the servo loop turned: %d cycles" % ticks)


func test_stepped_runs_are_identical() -> void:
	var runs: Array[PackedFloat64Array] = []
	for _run: int in 2:
		await physics_frames(1) # both runs begin at the same point of a tick
		var device: SpidarG = ideal_device()
		device.config.simulated_elastic = true
		device.config.simulated_friction = 0.05
		device.forces_enabled = true
		add(device)
		var record := PackedFloat64Array()
		for frame: int in 120:
			await physics_frames(1)
			device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, Vector3(0.05 * sin(0.1 * frame), 0, 0)), 0.3)
			device.request_wrench(Vector3(1, 0, 0), Vector3.ZERO, 0.01)
			record.append_array(device.get_string_tensions())
			record.append_array(device.get_string_lengths())
		runs.append(record)
		device.free()
	check(runs[0].size() > 1000, "recorded")
	check(runs[0] == runs[1], "same inputs, same bits")


func test_stepped_mode_gives_one_simulated_second_in_sixty_ticks() -> void:
	var device: SpidarG = ideal_device()
	add(device)
	await physics_frames(2)
	var before: int = device.get_statistics()["ticks"]
	await physics_frames(60)
	check_equal(int(device.get_statistics()["ticks"]) - before, 1000, "cycles in 60 ticks")


func _thread_count() -> int:
	return DirAccess.get_directories_at("/proc/%d/task" % OS.get_process_id()).size()


## By the thread's name, which the tests of the editor look for too.
func test_a_threaded_device_has_one_thread_and_takes_it_along() -> void:
	if not OS.has_feature("linux"):
		check(true, "threads have no names here")
		return
	check_equal(_servo_threads(), 0, "none before")
	var device := SpidarG.new()
	add(device)
	check(await until(func() -> bool: return _servo_threads() == 1), "one while it runs: %d" % _servo_threads())
	device.free()
	check_equal(_servo_threads(), 0, "none after")


func _servo_threads() -> int:
	var count: int = 0
	for task: String in DirAccess.get_directories_at("/proc/self/task"):
		var file: FileAccess = FileAccess.open("/proc/self/task/%s/comm" % task, FileAccess.READ)
		if file != null and file.get_line() == "spidar_servo":
			count += 1
	return count
