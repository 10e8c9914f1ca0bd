## The whole calibration of motor boards by SpidarGCalibrator: -- PORT UDP_PORT. The boards' model has errors that only it
## knows, and plays the hand; what is found is compared with its truth. Prints "ok" and "FAIL" lines, then "calibrated".
extends "calibrator_script.gd"

const ZERO_READINGS := 3
const POSES := 320
## Its counts run the other way than the config says.
const REVERSED := 3
const RULED := 4
const RULER_STEP_M := 0.0005
const NOMINAL_M_PER_COUNT := TAU * 0.008 / 2000.0
const WEIGHED: PackedInt32Array = [0, 5]
const WEIGHT_N := 2.0
## Of the lengths of all strings at eight places, rms: what 300 poses leave (0.12 mm at home) and their scales 10 cm away.
const LENGTH_LIMIT_M := 0.2e-3
const GAIN_LIMIT := 0.02
const RULER_LIMIT := 0.004
const LIMIT_S := 5.0
const TASK_LIMIT_S := 20.0
## A busy machine holds the boards' answers up; the rig then ends the task, and it is asked for again.
const TRIES := 5

## What an attempt has checked, until it counts.
var _waits := false
var _later := PackedStringArray()


func _initialize() -> void:
	_run()


func _run() -> void:
	var words := OS.get_cmdline_user_args()
	_model = BoardModel.new(words[1].to_int())
	_model.tell("script home")
	var config := SpidarGConfig.new()
	config.transport = SpidarGConfig.TRANSPORT_SERIAL
	config.serial_port = words[0]
	config.serial_motors = _motors()
	_check(not _calibrator.open(config, null, true), "simulated time is refused: %s" % _calibrator.get_problem())
	_check(_calibrator.open(config, null), "asks for the boards %s" % _calibrator.get_problem())
	var open := await _until(func() -> bool: return _calibrator.get_live()["readings"] > 0, LIMIT_S)
	_check(open, "opened %s" % _calibrator.get_problem())
	if open:
		_check(not _calibrator.get_live()["simulated"], "it is no simulated device")
		_check(_calibrator.get_live()["remarks"] == "", "remarks: %s" % _calibrator.get_live()["remarks"])
		await _check_wiring()
		await _lose_the_zero()
		await _measure()
	_calibrator.close()
	var closed := await _until(func() -> bool: return _calibrator.get_device_state() == SpidarGCalibrator.DEVICE_CLOSED, LIMIT_S)
	_check(closed, "closed")
	_check(_model.tell()["flash_writes"] == 0, "nothing was written to the boards' flash")
	print("calibrated")
	quit()


func _motors() -> PackedInt32Array:
	var motors := PackedInt32Array()
	for string in 8:
		motors.append_array([1, string, -1 if string == REVERSED else 1, 1])
	return motors


func _check_wiring() -> void:
	for string in 8:
		var told := await _task(SpidarGCalibrator.TASK_WIRING, string, 0.0)
		var expected := SpidarGCalibrator.VERDICT_WRONG_SIGN if string == REVERSED else SpidarGCalibrator.VERDICT_DONE
		_check(told["verdict"] == expected, "wiring of string %d: %s" % [string, told["text"]])
		_check(_calibrator.is_reversed(string) == (string == REVERSED), "sign of string %d" % string)


## Once more when a busy machine held the boards up for so long that they were lost: then the zero is forgotten, as it must be.
func _measure() -> void:
	for attempt in TRIES:
		_later = PackedStringArray()
		_waits = attempt + 1 < TRIES
		await _read_zero()
		await _read_ruler()
		await _move_freely()
		await _weigh()
		await _compare(_calibrator.make_calibration())
		if _calibrator.get_zero()["repeats"] > 0:
			break
		print("again: %s" % _calibrator.get_problem())
		_calibrator.clear_zero()
	_waits = false
	for line in _later:
		print(line)


func _lose_the_zero() -> void:
	await _wait_still()
	_check(_calibrator.take_zero(), "a zero %s" % _calibrator.get_problem())
	_model.tell("unplug")
	await _wait_s(0.3)
	_model.tell("plug")
	await _until(func() -> bool: return _calibrator.get_zero()["repeats"] == 0, LIMIT_S)
	_check(_calibrator.get_zero()["repeats"] == 0, "unplugged, the zero is forgotten: %s" % _calibrator.get_problem())
	await _until(func() -> bool: return _calibrator.take_zero(), LIMIT_S)
	_calibrator.clear_zero()


func _read_zero() -> void:
	await _wait_still()
	for reading in ZERO_READINGS:
		await _wait_s(0.2)
		_check(_calibrator.take_zero(), "zero %d %s" % [reading, _calibrator.get_problem()])


func _read_ruler() -> void:
	for place: int in [0, 7, 0, 7]:
		_model.tell("script place %d" % place)
		await _wait_still()
		var read_m := snappedf(_model.tell()["lengths_m"][RULED], RULER_STEP_M)
		_check(_calibrator.take_length(RULED, read_m), "length %.1f mm %s" % [1e3 * read_m, _calibrator.get_problem()])
	var scale: float = _calibrator.get_lengths(RULED)["scale_m_per_count"]
	var truth: float = NOMINAL_M_PER_COUNT / (1.0 + _model.tell()["gain_errors"][RULED])
	_check(absf(scale / truth - 1.0) <= RULER_LIMIT, "scale by the ruler: off by %.2f %%" % (100.0 * (scale / truth - 1.0)))


func _move_freely() -> void:
	_model.tell("script home")
	await _wait_still()
	_check(_calibrator.start_task(SpidarGCalibrator.TASK_TAUT), "motors hold the strings taut")
	_calibrator.set_collecting(true)
	_model.tell("script free")
	await _until(func() -> bool: return _calibrator.get_coverage()["poses"] >= POSES, 60.0)
	_calibrator.set_collecting(false)
	_model.tell("script home")
	_check(_calibrator.get_coverage()["poses"] >= POSES, "%d poses" % _calibrator.get_coverage()["poses"])
	_calibrator.start_task(SpidarGCalibrator.TASK_IDLE)
	_check(_calibrator.compute(), "computes %s" % _calibrator.get_problem())
	await _until(func() -> bool: return not _calibrator.is_computing(), 120.0)
	var result := _calibrator.get_result()
	_check(result["usable"], "result: %s grip %.4f mm expected" % [result["refusal"], 1e3 * result["grip_error_rms_m"]])


func _weigh() -> void:
	var errors := _model.tell()
	for string in WEIGHED:
		_model.tell("hang %d %f" % [string, WEIGHT_N])
		await _wait_s(0.2)
		var told := await _task(SpidarGCalibrator.TASK_WEIGHING, string, WEIGHT_N)
		_check(told["verdict"] == SpidarGCalibrator.VERDICT_DONE, "weighed: %s" % told["text"])
		_model.tell("hang -1 0")
		await _wait_s(0.3) # it is let down
		var gain: float = _calibrator.get_weights(string)["gain"]
		# With the drum's nominal radius: the smaller one pulls harder.
		var truth: float = errors["tension_gains"][string] * (1.0 + errors["gain_errors"][string])
		_check(absf(gain / truth - 1.0) <= GAIN_LIMIT, "motor gain of string %d: %.3f, truth %.3f" % [string, gain, truth])


func _compare(found: SpidarGCalibration) -> void:
	_check(found != null and found.get_problem() == "", "a sound calibration %s" % _calibrator.get_problem())
	if found == null:
		return
	var square := 0.0
	for place in 8:
		_model.tell("script place %d" % place)
		await _wait_still()
		var counts: PackedInt32Array = _calibrator.get_live()["counts"]
		var lengths: Array = _model.tell()["lengths_m"]
		for string in 8:
			var read_m := found.string_offsets[string] + found.string_scales[string] * (counts[string] - found.zero_counts[string])
			square += pow(read_m - lengths[string], 2) / 64.0
	for string in WEIGHED:
		var truth: float = _model.tell()["tension_gains"][string]
		var gain := found.tension_gains[string]
		_check(absf(gain / truth - 1.0) <= GAIN_LIMIT, "motor gain of string %d with its own radius: %.3f, truth %.3f" % [string, gain, truth])
	_check(sqrt(square) <= LENGTH_LIMIT_M, "lengths at 8 places: %.4f mm rms, limit %.1f" % [1e3 * sqrt(square), 1e3 * LENGTH_LIMIT_M])


func _task(task: SpidarGCalibrator.Task, string: int, weight_n: float) -> Dictionary:
	for attempt in TRIES:
		_calibrator.start_task(task, string, weight_n)
		await _until(func() -> bool: return _calibrator.get_task()["verdict"] != SpidarGCalibrator.VERDICT_RUNNING, TASK_LIMIT_S)
		var verdict: int = _calibrator.get_task()["verdict"]
		if verdict != SpidarGCalibrator.VERDICT_STOPPED and verdict != SpidarGCalibrator.VERDICT_NOT_READY:
			break
		print("again: %s" % _calibrator.get_task()["text"])
		await _wait_s(0.5)
	return _calibrator.get_task()


func _wait_still() -> void:
	await _wait_s(0.7)
	await _until(func() -> bool: return _model.tell().get("still", false), LIMIT_S)
	await _wait_s(0.3)


func _wait_s(time_s: float) -> void:
	await _until(func() -> bool: return false, time_s)


func _check(good: bool, what: String) -> void:
	var line := "%s calibration: %s" % ["ok  " if good else "FAIL", what]
	if _waits:
		_later.append(line)
	else:
		print(line)
