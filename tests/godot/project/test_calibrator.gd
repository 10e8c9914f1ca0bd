## SpidarGCalibrator on a simulated device in simulated time: what was injected is found, what is wrong is refused.
extends "res://test_case.gd"

const HOME_REPEATS: int = 3
const POSES: int = 320
## research figures for 300 poses with 0.1 mm noise: offsets 0.117 mm, scales 5.7e-4, rms over the strings.
const OFFSET_LIMIT_M: float = 0.117e-3
const GAIN_LIMIT: float = 5.7e-4


func _wrong_config(seed_number: int) -> SpidarGConfig:
	var random := RandomNumberGenerator.new()
	random.seed = seed_number
	var offsets := PackedFloat64Array()
	var gains := PackedFloat64Array()
	var tensions := PackedFloat64Array()
	var common: float = random.randf_range(-0.04, 0.04)
	for _i: int in 8:
		offsets.append(clampf(random.randfn(0.0, 0.005), -0.02, 0.02))
		gains.append(common + clampf(random.randfn(0.0, 0.005), -0.02, 0.02))
		tensions.append(random.randf_range(0.85, 1.15))
	var config := SpidarGConfig.new()
	config.transport = SpidarGConfig.TRANSPORT_SIMULATED
	config.simulated_offset_errors = offsets
	config.simulated_gain_errors = gains
	config.simulated_tension_gains = tensions
	return config


func _collect(calibrator: SpidarGCalibrator) -> void:
	calibrator.move_simulated_hand(SpidarGCalibrator.HAND_FREE_MOTION)
	calibrator.set_collecting(true)
	var poses: int = 0
	for _second: int in 60:
		calibrator.advance(1.0)
		poses = calibrator.get_coverage()["poses"]
		if poses >= POSES:
			break
	calibrator.set_collecting(false)
	check(poses >= POSES, "%d poses in a minute" % poses)


func _compute(calibrator: SpidarGCalibrator) -> Dictionary:
	check(calibrator.compute(), "computes: %s" % calibrator.get_problem())
	await until(
		func() -> bool:
			calibrator.poll()
			return not calibrator.is_computing(),
		60000
	)
	return calibrator.get_result()


func _run_task(calibrator: SpidarGCalibrator, task: SpidarGCalibrator.Task, string: int, weight_n: float) -> Dictionary:
	check(calibrator.start_task(task, string, weight_n), "starts: %s" % calibrator.get_problem())
	for _i: int in 100:
		calibrator.advance(0.1)
		if calibrator.get_task()["verdict"] != SpidarGCalibrator.VERDICT_RUNNING:
			break
	return calibrator.get_task()


## Rms over the strings of how wrong `calibration` reads the home pose (m), and of its scales (relative).
func _errors(config: SpidarGConfig, calibration: SpidarGCalibration) -> Vector2:
	var nominal: float = 2.513274122871834e-5
	var home_m: float = sqrt(0.24 * 0.24 + 0.24 * 0.24 + 0.2 * 0.2)  # half sizes of the frame, one less the pole
	var square := Vector2.ZERO
	for i: int in 8:
		var gain: float = 1.0 + config.simulated_gain_errors[i]
		var count: float = roundf((home_m * gain + config.simulated_offset_errors[i]) / nominal)
		var read: float = (
			calibration.string_offsets[i] + calibration.string_scales[i] * (count - calibration.zero_counts[i])
		)
		square += Vector2(pow(read - home_m, 2), pow(calibration.string_scales[i] * gain / nominal - 1.0, 2)) / 8.0
	return Vector2(sqrt(square.x), sqrt(square.y))


func test_errors_of_a_simulated_device_are_found() -> void:
	for seed_number: int in [1, 2, 3]:
		var config: SpidarGConfig = _wrong_config(seed_number)
		var calibrator := SpidarGCalibrator.new()
		check(calibrator.open(config, null, true), "opens: %s" % calibrator.get_problem())
		for _i: int in HOME_REPEATS:
			calibrator.advance(0.5)
			check(calibrator.take_zero(), "zero: %s" % calibrator.get_problem())
		_collect(calibrator)
		var result: Dictionary = await _compute(calibrator)
		check_equal(result["usable"], true, "usable: %s" % result["refusal"])
		calibrator.move_simulated_hand(SpidarGCalibrator.HAND_HOME)
		calibrator.advance(2.0)
		var weighed: Dictionary = _run_task(calibrator, SpidarGCalibrator.TASK_WEIGHING, 3, 2.0)
		check_equal(weighed["verdict"], SpidarGCalibrator.VERDICT_DONE, "weighed: %s" % weighed["text"])
		var calibration: SpidarGCalibration = calibrator.make_calibration()
		check_equal(calibration.get_problem(), "", "sound")
		var errors: Vector2 = _errors(config, calibration)
		print(
			"INFO seed %d: offsets %.4f mm, scales %.1f e-5, grip expected %.4f mm, parity %.4f mm"
			% [seed_number, 1e3 * errors.x, 1e5 * errors.y, 1e3 * result["grip_error_rms_m"], 1e3 * result["parity_rms_m"]]
		)
		check(errors.x <= OFFSET_LIMIT_M, "offsets: %f mm" % (1e3 * errors.x))
		check(errors.y <= GAIN_LIMIT, "scales: %f" % errors.y)
		var before: PackedFloat64Array = result["residuals_before_m"]
		var after: PackedFloat64Array = result["residuals_after_m"]
		for i: int in 8:
			check(after[i] < 2e-4 and before[i] > after[i], "string %d: %f, then %f m" % [i, before[i], after[i]])
		check_near(calibration.tension_gains[3], config.simulated_tension_gains[3], 0.02, "motor gain")
		calibrator.close()


func test_the_motors_rest_until_a_task_asks() -> void:
	var calibrator := SpidarGCalibrator.new()
	check(calibrator.open(null, null, true), "opens")
	calibrator.advance(1.0)
	check_equal(calibrator.get_live()["motors_on"], false, "off at first")
	var wired: Dictionary = _run_task(calibrator, SpidarGCalibrator.TASK_WIRING, 5, 0.0)
	check_equal(wired["verdict"], SpidarGCalibrator.VERDICT_DONE, wired["text"])
	calibrator.advance(0.5)
	check_equal(calibrator.get_live()["motors_on"], false, "off after the task")
	calibrator.start_task(SpidarGCalibrator.TASK_TAUT)
	calibrator.advance(0.2)
	check_equal(calibrator.get_live()["motors_on"], true, "taut")
	calibrator.close()
	check_equal(calibrator.get_device_state(), SpidarGCalibrator.DEVICE_CLOSED, "closed")
	check_equal(calibrator.start_task(SpidarGCalibrator.TASK_TAUT), false, "nothing to pull with")


func test_bad_data_is_refused_with_the_reason() -> void:
	var calibrator := SpidarGCalibrator.new()
	check_equal(calibrator.take_zero(), false, "no device")
	check(calibrator.get_problem().contains("open"), calibrator.get_problem())
	check_equal(calibrator.make_calibration(), null, "nothing measured")
	var config := SpidarGConfig.new()
	config.simulated_gain_errors = PackedFloat64Array([0.1])
	check_equal(calibrator.open(config, null, true), false, "one value for eight strings")
	check(calibrator.get_problem().contains("simulated_gain_errors"), calibrator.get_problem())
	config.simulated_gain_errors = PackedFloat64Array()
	config.transport = SpidarGConfig.TRANSPORT_DEVICE
	check_equal(calibrator.open(config, null, true), false, "a real device in simulated time")
	check(calibrator.open(null, null, true), "the simulated one")
	calibrator.advance(0.1)
	check_equal(calibrator.take_length(2, -1.0), false, "a length below zero")
	check(calibrator.get_problem().contains("length_m"), calibrator.get_problem())
	check_equal(calibrator.take_length(9, 0.3), false, "a string that is not")
	check_equal(calibrator.start_task(SpidarGCalibrator.TASK_WEIGHING, 0, 50.0), false, "5 kg")
	check(calibrator.get_problem().contains("weight_n"), calibrator.get_problem())
	check_equal(calibrator.make_calibration(), null, "no zero yet")
	var still: Dictionary = await _compute(calibrator)
	check_equal(still["usable"], false, "no poses")
	check(calibrator.get_problem().length() > 10, calibrator.get_problem())
	check_equal(calibrator.make_calibration(), null, "refused data makes no calibration")


func test_lengths_by_the_ruler_give_scale_and_spread() -> void:
	var config: SpidarGConfig = _wrong_config(5)
	var calibrator := SpidarGCalibrator.new()
	check(calibrator.open(config, null, true), "opens")
	var read_m: Dictionary[int, float] = {}
	for place: int in [0, 7, 0, 7]:
		calibrator.move_simulated_hand(SpidarGCalibrator.HAND_PLACE, place)
		calibrator.advance(3.0)
		check_equal(calibrator.get_live()["hand_has_arrived"], true, "at place %d" % place)
		var ruler: PackedFloat64Array = calibrator.get_live()["ruler_m"]
		read_m[place] = read_m.get(place, snappedf(ruler[4], 0.0005))
		check(calibrator.take_length(4, read_m[place]), calibrator.get_problem())
	var told: Dictionary = calibrator.get_lengths(4)
	check_equal(told["repeated_points"], 2, "each length twice")
	var spread: float = told["repeat_spread_m"]
	check(spread >= 0.0 and spread < 0.5e-3, "spread %f m" % spread)
	var truth: float = 2.513274122871834e-5 / (1.0 + config.simulated_gain_errors[4])
	check_near(told["scale_m_per_count"] / truth, 1.0, 0.004, "scale by a ruler of half millimetres")


func test_a_device_in_use_is_refused() -> void:
	var config := SpidarGConfig.new()
	config.transport = SpidarGConfig.TRANSPORT_SIMULATED
	config.device_name = "calibrated"
	var device := SpidarG.new()
	device.config = config
	device.drive_mode = SpidarG.DRIVE_STEPPED
	add(device)
	await frames(2)
	var calibrator := SpidarGCalibrator.new()
	check_equal(calibrator.open(config, null), true, "asks in its own thread")
	await until(func() -> bool: return calibrator.get_device_state() == SpidarGCalibrator.DEVICE_FAILED)
	calibrator.poll()
	check(calibrator.get_problem().contains("belongs to"), calibrator.get_problem())
	device.queue_free()
	await frames(2)
	check(calibrator.open(config, null), "free now")
	await until(
		func() -> bool:
			calibrator.poll()
			return calibrator.get_live()["readings"] > 0
	)
	check_equal(calibrator.get_device_state(), SpidarGCalibrator.DEVICE_OPEN, "open")
	calibrator.close()
	check(
		await until(func() -> bool: return calibrator.get_device_state() == SpidarGCalibrator.DEVICE_CLOSED),
		"closes by itself"
	)
