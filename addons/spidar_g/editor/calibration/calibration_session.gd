@tool
extends RefCounted
## Holds the state of one calibration: the current step, the running task and the result. It uses no controls, so that it can
## be tested without them.

## Emitted when anything else that the panel shows than the readings has changed.
signal changed

enum Step { WIRING, ZERO, RULER, MOTION, WEIGHTS, RESULT }

const STRINGS: int = 8
const STEP_NAMES: Array[String] = ["Wiring", "Zero at home", "Lengths by ruler", "Free motion", "Motor gain", "Result"]
## The free motion is complete after this many poses. The expected error falls with their square root.
const ENOUGH_POSES: int = 320
## The accuracy is estimated each time this many poses have been collected.
const ESTIMATE_EVERY: int = 80
## Readings of a simulated ruler are rounded to this step, in meters, as on a ruler with half millimeters.
const RULER_STEP_M: float = 0.0005

var calibrator: SpidarGCalibrator = SpidarGCalibrator.new()
## If [code]true[/code], the device is simulated, and only [method update] advances its time. Tests use this.
var stepped: bool = false
var step: Step = Step.WIRING
## The sentence that states the last result or problem. It is empty if there is none.
var message: String = ""
var message_is_problem: bool = false
## The SpidarGCalibrator.Verdict of each string, or -1 for a string that was not checked.
var wiring: PackedInt32Array = [-1, -1, -1, -1, -1, -1, -1, -1]
var moving: bool = false
var place: int = -1

var _wants_open: bool = false
var _config: SpidarGConfig
var _calibration: SpidarGCalibration
var _queue: Array[int] = []
var _task: SpidarGCalibrator.Task = SpidarGCalibrator.TASK_IDLE
var _weight_n: float = 0.0
var _task_runs: bool = false
var _estimated_at: int = 0
var _final: bool = false
var _was_computing: bool = false


## Requests that the next [method update] opens the device. Opening forgets the earlier measurements.
func open_device(config: SpidarGConfig, calibration: SpidarGCalibration) -> void:
	_config = config
	_calibration = calibration
	_wants_open = true
	_forget()
	_try_open()


## Switches the motors off and closes the device. The measurements are kept.
func close_device() -> void:
	_wants_open = false
	stop()
	calibrator.close()
	_say("")


func is_open() -> bool:
	return calibrator.get_device_state() == SpidarGCalibrator.DEVICE_OPEN and get_readings() > 0


## Returns [code]true[/code] while the device is being opened, open or being closed, and while a self-calibration or an access
## to the motor boards runs. Call [method update] in each frame meanwhile.
func is_busy() -> bool:
	var state: SpidarGCalibrator.DeviceState = calibrator.get_device_state()
	var at_rest: bool = state == SpidarGCalibrator.DEVICE_CLOSED or state == SpidarGCalibrator.DEVICE_FAILED
	return _wants_open or not at_rest or calibrator.is_computing() or calibrator.is_using_boards()


func get_readings() -> int:
	return calibrator.get_live()["readings"]


func is_simulated() -> bool:
	return calibrator.get_live()["simulated"]


## Advances the session by `delta_s` seconds. Call it in each frame while [method is_busy] is [code]true[/code].
func update(delta_s: float) -> void:
	if _wants_open and calibrator.get_device_state() == SpidarGCalibrator.DEVICE_CLOSED:
		_try_open()
	if stepped and is_open():
		calibrator.advance(delta_s)
	elif not calibrator.poll() and calibrator.get_device_state() == SpidarGCalibrator.DEVICE_FAILED and _wants_open:
		_wants_open = false
		_complain()
	if is_open():
		_run_queue()
		_watch_motion()
	_watch_computation()


## Stops the running task: the motors are switched off, the hand moves home, and no poses are collected any more.
func stop() -> void:
	_queue.clear()
	_task_runs = false
	if moving:
		stop_motion()
	calibrator.start_task(SpidarGCalibrator.TASK_IDLE)
	calibrator.move_simulated_hand(SpidarGCalibrator.HAND_HOME)
	changed.emit()


func is_task_running() -> bool:
	return _task_runs or not _queue.is_empty()


## Checks the wiring of all strings: pulls one after the other, and finds out whether the encoder of this string moves most
## and in the right direction.
func check_wiring() -> void:
	wiring.fill(-1)
	_start_queue(SpidarGCalibrator.TASK_WIRING, range(STRINGS), 0.0)


## With `taut`, pulls all strings with 0.5 N, which a real device needs while its grip is moved by hand. Without it, switches
## the motors off.
func set_taut(taut: bool) -> void:
	_report(calibrator.start_task(SpidarGCalibrator.TASK_TAUT if taut else SpidarGCalibrator.TASK_IDLE))


func read_zero() -> void:
	_report(calibrator.take_zero(), "The home pose was read. Take the grip out, put it back and read again to see the spread.")


func clear_zero() -> void:
	calibrator.clear_zero()
	_say("")


func read_length(string: int, length_m: float) -> void:
	_report(calibrator.take_length(string, length_m))


func clear_lengths(string: int) -> void:
	calibrator.clear_lengths(string)
	_say("")


## Moves the hand of a simulated device to the next of its places.
func move_to_next_place() -> void:
	place = (place + 1) % STRINGS
	_report(calibrator.move_simulated_hand(SpidarGCalibrator.HAND_PLACE, place))


## Returns the length that a ruler shows along a string of a simulated device, in meters.
func read_ruler(string: int) -> float:
	var ruler: PackedFloat64Array = calibrator.get_live().get("ruler_m", PackedFloat64Array())
	return snappedf(ruler[string], RULER_STEP_M) if string < ruler.size() else 0.0


func start_motion() -> void:
	if calibrator.get_zero()["repeats"] == 0:
		_say("Read the zero first: the fit starts from it.", true)
		return
	calibrator.clear_poses()
	_estimated_at = 0
	_final = false
	moving = true
	calibrator.move_simulated_hand(SpidarGCalibrator.HAND_FREE_MOTION)
	calibrator.set_collecting(true)
	_say("Move and turn the grip through the whole workspace, opening and closing it." if not is_simulated() else "")


func stop_motion() -> void:
	moving = false
	calibrator.set_collecting(false)
	calibrator.move_simulated_hand(SpidarGCalibrator.HAND_HOME)
	changed.emit()


## Returns how complete the free motion is, from 0 to 1.
func get_progress() -> float:
	return clampf(float(calibrator.get_coverage()["poses"]) / ENOUGH_POSES, 0.0, 1.0)


func weigh(string: int, weight_n: float) -> void:
	_start_queue(SpidarGCalibrator.TASK_WEIGHING, [string], weight_n)


## Weighs all strings of a simulated device one after the other. No weight has to be moved from string to string.
func weigh_all(weight_n: float) -> void:
	_start_queue(SpidarGCalibrator.TASK_WEIGHING, range(STRINGS), weight_n)


## Shows `text` as the message of the session. With `problem` it is shown as a problem.
func tell(text: String, problem: bool = false) -> void:
	_say(text, problem)


## Returns the calibration that can be accepted now. Returns [code]null[/code] if there is none; the message then states the
## reason.
func make_calibration() -> SpidarGCalibration:
	var made: SpidarGCalibration = calibrator.make_calibration()
	if made == null:
		_complain()
	else:
		_say("")
	return made


func go_to(next: int) -> void:
	if is_task_running() or moving:
		stop()
	step = clampi(next, 0, Step.size() - 1) as Step
	_say("")


## Returns [code]true[/code] if the step is complete, so that the next one can begin.
func is_done(of: Step) -> bool:
	match of:
		Step.WIRING:
			return wiring.count(SpidarGCalibrator.VERDICT_DONE) + wiring.count(SpidarGCalibrator.VERDICT_WRONG_SIGN) == STRINGS
		Step.ZERO:
			return calibrator.get_zero()["status"] >= 0
		Step.RULER:
			return range(STRINGS).all(func(i: int) -> bool: return calibrator.get_lengths(i)["status"] >= 0)
		Step.WEIGHTS:
			return range(STRINGS).all(func(i: int) -> bool: return calibrator.get_weights(i)["repeats"] > 0)
	return calibrator.get_result().get("usable", false)


func _try_open() -> void:
	if calibrator.get_device_state() == SpidarGCalibrator.DEVICE_CLOSED or (
		calibrator.get_device_state() == SpidarGCalibrator.DEVICE_FAILED
	):
		if not calibrator.open(_config, _calibration, stepped):
			_wants_open = false
			_complain()


func _forget() -> void:
	wiring.fill(-1)
	_queue.clear()
	_task_runs = false
	moving = false
	place = -1
	_final = false
	_say("")


func _start_queue(task: SpidarGCalibrator.Task, strings: Array, weight_n: float) -> void:
	_queue.assign(strings)
	_task = task
	_weight_n = weight_n
	calibrator.move_simulated_hand(SpidarGCalibrator.HAND_HOME)
	_say("")


# Runs the task on one string after the other. A simulated hand must have arrived first.
func _run_queue() -> void:
	if _task_runs:
		var told: Dictionary = calibrator.get_task()
		if told["verdict"] == SpidarGCalibrator.VERDICT_RUNNING:
			return
		_task_runs = false
		_take_verdict(told)
		changed.emit()
	if _queue.is_empty() or (is_simulated() and not calibrator.get_live()["hand_has_arrived"]):
		return
	var string: int = _queue.pop_front()
	_task_runs = calibrator.start_task(_task, string, _weight_n)
	if not _task_runs:
		_queue.clear()
		_complain()


func _take_verdict(told: Dictionary) -> void:
	var verdict: int = told["verdict"]
	var string: int = told["string"]
	var sound: bool = verdict == SpidarGCalibrator.VERDICT_DONE
	if told["task"] == SpidarGCalibrator.TASK_WIRING:
		wiring[string] = verdict
	if not sound:
		_say("String %d: %s" % [string + 1, told["text"]], true)
		if verdict >= SpidarGCalibrator.VERDICT_MOVED_TOO_FAST or _task == SpidarGCalibrator.TASK_WEIGHING:
			_queue.clear()
	elif not calibrator.get_problem().is_empty():
		_complain()


func _watch_motion() -> void:
	if not moving:
		return
	var poses: int = calibrator.get_coverage()["poses"]
	if poses >= ENOUGH_POSES and not calibrator.is_computing():
		stop_motion()
		_final = true
		_report(calibrator.compute())
	elif poses - _estimated_at >= ESTIMATE_EVERY and not calibrator.is_computing():
		_estimated_at = poses
		calibrator.compute()


func _watch_computation() -> void:
	var computing: bool = calibrator.is_computing()
	if _was_computing and not computing:
		if _final:
			var result: Dictionary = calibrator.get_result()
			var usable: bool = result["usable"]
			_say("The calibration is complete. Look at the result, then accept it." if usable else result["refusal"], not usable)
		changed.emit()
	_was_computing = computing


func _report(good: bool, done: String = "") -> void:
	if good:
		_say(done)
	else:
		_complain()


func _complain() -> void:
	_say(calibrator.get_problem(), true)


func _say(text: String, problem: bool = false) -> void:
	message = text
	message_is_problem = problem
	changed.emit()
