## Recording and replay from GDScript: what was played comes again, bit for bit, and errors name their remedy.
extends "res://test_case.gd"

const PATH: String = "user://test_recording.rec"
const FRAMES: int = 90

var ends: Array = []


func test_a_recorded_run_replays_to_the_bit() -> void:
	var device := ideal_device()
	device.forces_enabled = true
	add(device)
	await physics_frames(70)
	check(not device.is_recording(), "no recording before it is started")
	check(device.start_recording(PATH), "the recording starts")
	check(device.is_recording(), "it runs")
	var poses: Array[Transform3D] = []
	for frame: int in FRAMES:
		device.set_simulated_hand_target(
			Transform3D(Basis(), Vector3(0.0, -0.04 if frame % 30 < 15 else 0.02, 0.0)), 0.3)
		device.set_contacts(PackedFloat64Array(
			[0, 1, 0, -0.01 - 0.0001 * frame, 0, 0, 0, 350, 2, 0.3, SpidarG.CONTACT_CENTER, 1]))
		await physics_frames(1)
		poses.append(device.get_grip_transform())
	var statistics: Dictionary = device.get_recording_statistics()
	device.stop_recording()
	check(not device.is_recording(), "no recording after it was stopped")
	check_equal(statistics["lost_cycles"], 0, "nothing is lost in stepped time")
	check(statistics["cycles"] >= FRAMES * 16, "a cycle a millisecond: %d" % statistics["cycles"])
	var last_tensions: PackedFloat64Array = device.get_string_tensions()

	device.replay_finished.connect(
		func(identical: bool, message: String) -> void: ends.append([identical, message]))
	check(device.start_replay(PATH), "the replay starts")
	check(device.is_replaying(), "it runs")
	check(not device.set_simulated_hand_target(Transform3D(), 0.0), "no hand while a recording plays")
	var seen: Array[Transform3D] = []
	for frame: int in FRAMES + 5:
		await physics_frames(1)
		seen.append(device.get_grip_transform())
	check_equal(ends.size(), 1, "the end is told once")
	if ends.size() == 1:
		check(ends[0][0], "identical: %s" % ends[0][1])
	var report: Dictionary = device.get_replay_statistics()
	check(report["finished"], "finished")
	check_equal(report["differing_cycles"], 0, "cycles of other bits")
	check_equal(report["cycles"], statistics["cycles"], "cycles replayed")
	check_equal(device.get_string_tensions(), last_tensions, "the tensions of the last cycle")
	# The ticks may fall otherwise on the cycles (16 or 17), so the poses are looked up, not counted.
	check(seen.has(poses[FRAMES - 1]), "the last recorded pose is reached")
	device.stop_replay()
	check(not device.is_replaying(), "stopped")
	await physics_frames(3)
	check(is_open(device), "the device is open again")
	check(device.set_simulated_hand_target(Transform3D(), 0.0), "and its hand too")
	device.free()


## Whatever the game asked for came between two recorded commands, and the replay differed from there on.
func test_a_game_that_goes_on_asking_does_not_disturb_a_replay() -> void:
	var device := ideal_device()
	device.forces_enabled = true
	add(device)
	await physics_frames(70)
	check(device.start_recording(PATH), "the recording starts")
	for frame: int in 30:
		if frame % 5 == 0: # so that there are frames with no recorded command
			device.request_wrench(Vector3(0.0, 1.0, 0.0), Vector3.ZERO, 0.0, 0.1)
		await physics_frames(1)
	device.stop_recording()
	var answers: Array = []
	device.replay_finished.connect(
		func(identical: bool, message: String) -> void: answers.append([identical, message]))
	check(device.start_replay(PATH), "the replay starts")
	for frame: int in 35:
		device.request_wrench(Vector3(2.0, 0.0, 0.0), Vector3.ZERO, 0.0)
		await physics_frames(1)
	check(answers.size() == 1 and answers[0][0], "identical: %s" % [answers])
	device.free()


func test_a_threaded_recording_plays_in_real_time() -> void:
	var device := SpidarG.new()
	device.forces_enabled = true
	add(device)
	await until(func() -> bool: return is_open(device))
	check(device.start_recording(PATH), "the recording starts")
	check(await until(func() -> bool: return device.get_recording_statistics()["cycles"] > 300),
		"cycles are recorded by the thread")
	device.enabled = false # closes the device, and with it the recording
	check(not device.is_recording(), "closed")
	device.enabled = true
	device.replay_finished.connect(
		func(identical: bool, message: String) -> void: ends.append([identical, message]))
	check(device.start_replay(PATH), "the replay starts")
	check(await until(func() -> bool: return not ends.is_empty()), "and ends")
	if not ends.is_empty():
		check(ends[0][0], "identical: %s" % ends[0][1])
	device.free()


func test_bad_paths_and_states_are_refused() -> void:
	var rejected: Array[String] = []
	var device := ideal_device()
	device.request_rejected.connect(func(message: String) -> void: rejected.append(message))
	check(not device.start_recording(PATH), "no device is open yet")
	check(not device.start_replay(PATH), "not in the tree yet")
	add(device)
	await physics_frames(2)
	check(not device.start_recording("user://no/such/folder/a.rec"), "no such folder")
	check(not device.start_replay("user://no_such.rec"), "no such file")
	var file := FileAccess.open("user://noise.rec", FileAccess.WRITE)
	file.store_string("this is no recording")
	file.close()
	check(not device.start_replay("user://noise.rec"), "another file")
	check_equal(rejected.size(), 5, "each refusal is told")
	for i: int in rejected.size():
		var words: String = ["no device", "running scene", "folder", "does not exist", "not a recording"][i]
		check(rejected[i].contains(words), "\"%s\" in: %s" % [words, rejected[i]])
	check(is_open(device), "the device stays open")
	device.stop_recording() # neither runs: nothing happens
	device.stop_replay()
	check(is_open(device), "still open")
	device.free()


func test_two_devices_never_record_into_one_file() -> void:
	var first := ideal_device()
	var second := ideal_device()
	var messages: PackedStringArray = []
	second.request_rejected.connect(func(message: String) -> void: messages.append(message))
	add(first)
	add(second)
	await physics_frames(2)
	check(first.start_recording("user://same.rec"), "the first records")
	await physics_frames(5)
	check(not second.start_recording("user://same.rec"), "the second is refused")
	check(messages.size() == 1 and messages[0].contains("same.rec"), "and told why: %s" % [messages])
	first.stop_recording()
	check(second.start_recording("user://same.rec"), "when the first has ended it may")
	second.stop_recording()
	DirAccess.remove_absolute("user://same.rec")
	first.free()
	second.free()


func test_a_recording_of_another_build_plays_as_poses() -> void:
	var device := ideal_device()
	device.forces_enabled = true
	add(device)
	await physics_frames(70)
	check(device.start_recording(PATH), "the recording starts")
	var poses: Array[Transform3D] = []
	for frame: int in 60:
		device.set_simulated_hand_target(Transform3D(Basis(), Vector3(0.0, 0.0005 * frame, 0.0)), 0.2)
		await physics_frames(1)
		poses.append(device.get_grip_transform())
	device.stop_recording()
	# The head's line "build=" with another first digit, and its checksum.
	var bytes: PackedByteArray = FileAccess.get_file_as_bytes(PATH)
	var size: int = bytes.decode_u32(13)
	var at: int = bytes.slice(17, 17 + size).get_string_from_ascii().find("\nbuild=") + 17 + 7
	bytes[at] = 0x31 if bytes[at] == 0x30 else 0x30
	bytes.encode_u32(17 + size, _crc32(bytes.slice(8, 17 + size)))
	var file := FileAccess.open("user://other_build.rec", FileAccess.WRITE)
	file.store_buffer(bytes)
	file.close()
	device.replay_finished.connect(
		func(identical: bool, message: String) -> void: ends.append([identical, message]))
	check(device.start_replay("user://other_build.rec"), "the replay starts")
	check(device.get_replay_statistics()["poses_only"], "and says that it has poses only")
	var worst_m: float = 0.0
	for frame: int in 60:
		await physics_frames(1)
		check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "the recorded state, frame %d" % frame)
		worst_m = maxf(worst_m, device.get_grip_transform().origin.distance_to(poses[frame].origin))
	check(worst_m < 2e-5, "the poses of then, tick for tick: %.7f m" % worst_m)
	await physics_frames(3)
	check(ends.size() == 1 and not ends[0][0] and ends[0][1].contains("another build"), "the end: %s" % [ends])
	device.free()


func _crc32(bytes: PackedByteArray) -> int:
	var value: int = 0xFFFFFFFF
	for byte: int in bytes:
		value ^= byte
		for _bit: int in 8:
			value = (value >> 1) ^ (0xEDB88320 if value & 1 else 0)
	return value ^ 0xFFFFFFFF


func test_a_cut_recording_plays_up_to_the_cut() -> void:
	var device := ideal_device()
	add(device)
	await physics_frames(2)
	check(device.start_recording(PATH), "the recording starts")
	for frame: int in 60:
		device.set_simulated_hand_target(Transform3D(Basis(), Vector3(0.0, 0.0005 * frame, 0.0)), 0.0)
		await physics_frames(1)
	device.stop_recording()
	var whole: PackedByteArray = FileAccess.get_file_as_bytes(PATH)
	var file := FileAccess.open("user://cut.rec", FileAccess.WRITE)
	file.store_buffer(whole.slice(0, whole.size() - 2000))
	file.close()
	device.replay_finished.connect(
		func(identical: bool, message: String) -> void: ends.append([identical, message]))
	check(device.start_replay("user://cut.rec"), "the replay starts")
	await physics_frames(70)
	check_equal(ends.size(), 1, "the end is told")
	if ends.size() == 1:
		check(not ends[0][0], "a cut recording is not identical")
		check(ends[0][1].contains("cut off"), "it says so: %s" % ends[0][1])
		check(device.get_replay_statistics()["cycles"] > 100, "what came before is played")
		check_equal(device.get_replay_statistics()["differing_cycles"], 0, "to the bit")
	device.free()
