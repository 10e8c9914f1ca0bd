## The pages of docs/how_to on devices, recordings and exports: each example runs as it stands there, and does what its page
## promises.
extends "res://docs_case.gd"

## Radius of a pad at the default settings, m, and the top of the stage's table.
const PAD: float = 0.012
const TABLE: float = -0.08


func test_tune_stiffness() -> void:
	if not await open_page("tune_stiffness.md", "Tune the stiffness"):
		return
	check_near(hand.contact_stiffness, 600.0, 0.1, "half of the limit")
	await move_to(Vector3(0.0, TABLE + PAD - 0.01, 0.0), 0.0, 60)
	await physics_frames(40)
	var felt: float = (await mean_felt(20))[1]
	check_near(felt / (TABLE + PAD - device.get_grip_transform().origin.y), 600.0, 6.0, "stiffness of the table")
	# The page's table: latency in ms, limits.
	for row: PackedFloat64Array in [[0.5, 1600, 3, 0.75], [1, 1200, 2.4, 0.6], [2, 800, 1.6, 0.4], [4, 480, 0.96, 0.24]]:
		device.config.link_latency = 0.001 * row[0]
		await physics_frames(2)
		var limits: Vector3 = device.get_stiffness_limits()
		check(limits.is_equal_approx(Vector3(row[1], row[2], row[3])), "limits at %.1f ms: %s" % [row[0], limits])
	await close_page()


func test_measure_latency() -> void:
	if not await open_page("measure_latency.md", "Measure latency"):
		return
	var report: String = scene.call("report")
	for words: String in ["Simulated device", "link: assumed 1.00 ms, measured not yet", "allowed: 1200 N/m, 2.40 N m/rad"]:
		check(report.contains(words), "\"%s\" in: %s" % [words, report])
	await physics_frames(120) # it prints it once
	await close_page()


func test_forces_and_safety() -> void:
	if not await open_page("forces_and_safety.md", "Switch forces on and off in a game"):
		return
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "no forces before the player asks for them")
	_press(KEY_F)
	await physics_frames(ARMING_FRAMES)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "forces after F")
	check((scene.get("status") as Label).text == device.get_state_text(), "the state is shown")
	_press(KEY_SPACE)
	await physics_frames(1)
	check_equal(device.get_state(), SpidarG.STATE_FAULT, "stopped by the space bar")
	check(Array(device.get_string_tensions()).max() == 0.0, "and no string pulls")
	_press(KEY_C)
	await physics_frames(ARMING_FRAMES)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "forces after C")
	_press(KEY_F)
	await physics_frames(5)
	check(Array(device.get_string_tensions()).max() == 0.0, "F switches them off")
	await close_page()


func test_record_and_replay() -> void:
	if not await open_page("record_and_replay.md", "Record and replay a run"):
		return
	var ends: Array = []
	# Before the page's own answer, which opens the device again.
	device.replay_finished.disconnect(scene.get("_finished") as Callable)
	device.replay_finished.connect(func(identical: bool, message: String) -> void:
		ends.append([identical, message, device.get_replay_statistics()])
		scene.call("_finished", identical, message))
	for _i: int in 3:
		await move_to(Vector3(0.0, -0.075, 0.0), 0.3, 30)
		await move_to(Vector3.ZERO, 0.0, 30)
	for _i: int in 300:
		await physics_frames(1)
		if not ends.is_empty():
			break
	if check(ends.size() == 1 and ends[0][0], "the replay is identical: %s" % [ends]):
		check_equal(ends[0][2]["lost_cycles"], 0, "no cycle is lost")
		check_near(ends[0][2]["cycles"], 3000.0, 20.0, "3 s are recorded")
	await physics_frames(3)
	check(is_open(device) and not device.is_replaying(), "the device is open again")
	await close_page()


func test_calibrate() -> void:
	var saved := SpidarGCalibration.new()
	saved.string_scales = PackedFloat64Array([1, 1, 1, 1, 1, 1, 1, 1].map(func(_one: int) -> float: return 2.52e-5))
	ResourceSaver.save(saved, "user://calibration.tres")
	if await open_page("calibrate.md", "From a script"):
		check(is_open(device), "the device opens with it")
		check(device.calibration.string_scales == saved.string_scales, "the saved calibration is used")
		await close_page()
	DirAccess.remove_absolute("user://calibration.tres")


func test_run_a_study() -> void:
	if not await open_page("run_a_study.md", "A task of your own"):
		return
	await move_to(Vector3(0.0, -0.08, 0.0), 0.0, 60)
	for _i: int in 1200:
		if scene.get("finished"):
			break
		await physics_frames(1)
	check(scene.get("finished"), "all trials are done")
	var table: FileAccess = FileAccess.open("user://trials.csv", FileAccess.READ)
	check_equal(Array(table.get_csv_line()), ["condition", "trial", "path_m", "peak_force_n", "recording"], "the columns")
	for condition: String in ["forces_on", "forces_off"]:
		for trial: int in 3:
			var row: PackedStringArray = table.get_csv_line()
			check(row[0] == condition and row[1].to_int() == trial + 1, "%s, trial %d: %s" % [condition, trial + 1, row])
			var peak_n: float = row[3].to_float()
			check(peak_n > 1.0 if condition == "forces_on" else peak_n == 0.0, "its peak force: %s" % row)
			check(FileAccess.file_exists(row[4]), "and its recording")
			DirAccess.remove_absolute(row[4])
	await close_page()


func test_export() -> void:
	# It opens a scene of the reader's; tests/package/missing_library is a game that does so.
	compiled("export.md", "Where there is no library")


## Every block of every page is one that a test runs.
func test_every_page_has_its_test() -> void:
	var tested: String = ""
	for file: String in ["test_docs.gd", "test_docs_requests.gd", "test_docs_devices.gd"]:
		tested += FileAccess.get_file_as_string("res://" + file)
	for page: String in pages():
		for heading: String in blocks(page):
			check(tested.contains("\"%s\"" % page) and tested.contains("\"%s\"" % heading), "a test runs %s, %s" % [page, heading])


func _press(key: Key) -> void:
	var event := InputEventKey.new()
	event.keycode = key
	event.pressed = true
	scene.call("_unhandled_key_input", event)
