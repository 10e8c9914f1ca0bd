extends Node
## A task played by script from its start to its end: results folder and pictures, the faults that the arguments ask for, the
## wait until the device can be felt, the play, and the reason why it stopped.

const Hud := preload("res://ui/hud.gd")
const PictureTaker := preload("res://play/picture_taker.gd")
const PlayArguments := preload("res://play/play_arguments.gd")
const ScriptedHand := preload("res://play/scripted_hand.gd")
const TaskPlayer := preload("res://play/task_player.gd")
const Trial := preload("res://study/trial.gd")

## A scripted play that takes longer than this has gone wrong.
const TIME_LIMIT_S := 240.0
## And for each carry that was asked for.
const CARRY_LIMIT_S := 15.0
## Motor boards are zeroed first, by a motion; a busy computer may need several tries.
const ZERO_LIMIT_S := 60.0
const ZERO_STILL_S := 1.5
const ZERO_WAY_M := 0.045
const RECOVERIES := 10
const RECOVERY_S := 1.5
## The device needs its arming time before it can be felt; this is more than enough.
const READY_LIMIT_S := 5.0

var trial: Trial
var player: TaskPlayer
var hud: Hud

@onready var _hand: ScriptedHand = $"../ScriptedHand"
@onready var _pictures: PictureTaker = $"../PictureTaker"


## Whether a play is going on that should have ended by now.
func is_overdue() -> bool:
	return trial != null and trial.logger.task_time_s > _time_limit_s()


## Coroutine: ends the trial when it is done. home: where the hand waits until the device is armed, world.
func play(home: Transform3D) -> void:
	var arguments := trial.arguments
	if not _open_folder(arguments):
		return
	hud.show_result(tr("RESULT_PLAYING") % arguments.seed_number)
	trial.spidar.forces_enabled = not trial.in_experiment or trial.forces_at_start
	_hand.be(arguments.hand, arguments.seed_number)
	var reason := await _wait_until_ready(home)
	if reason == "":
		_inject_faults(arguments)
		if _hand.model != null:
			player.be_ready = _recover
		await player.play()
		reason = player.verdict()
		if _hand.stopped:
			reason = "time limit of %d s simulated time" % int(_time_limit_s())
	trial.stop_clock()
	hud.show_result(tr("RESULT_PLAYED") % trial.logger.task_time_s)
	await _pictures.take("done")
	trial.finish(reason)


func _open_folder(arguments: PlayArguments) -> bool:
	var error := OK if trial.in_experiment else DirAccess.make_dir_recursive_absolute(arguments.out_dir)
	if error != OK:
		printerr("--out %s: cannot be made: %s" % [arguments.out_dir, error_string(error)])
		get_tree().quit(PlayArguments.EXIT_BAD_ARGUMENTS)
		return false
	if arguments.pictures or arguments.movie:
		_pictures.start(arguments.out_dir)
		_pictures.filming = arguments.movie
	return true


## The reason why there is no play; empty when there is one.
func _wait_until_ready(home: Transform3D) -> String:
	_hand.start(trial.spidar)
	if _hand.model != null:
		trial.spidar.fault_raised.connect(func(_code: int, message: String) -> void: print("fault: %s" % message))
	if _hand.model != null and not await _zero():
		return "device not zeroed: %s %s" % [trial.spidar.get_state_text(), trial.spidar.get_fault_text()]
	await _hand.move_to(home, 1.0)
	var waited_s := 0.0
	if not trial.spidar.forces_enabled:
		trial.start_clock()
	while not trial.is_running():
		await _hand.wait(0.1)
		waited_s += 0.1
		if waited_s > READY_LIMIT_S:
			return "device not active: %s %s" % [trial.spidar.get_state_text(), trial.spidar.get_fault_text()]
	return ""


## Motor boards count from anywhere. The grip is held still at its rest pose, then moved so that the zero is confirmed.
func _zero() -> bool:
	var device := trial.spidar
	_hand.wanted = device.global_transform.orthonormalized()
	var waited_s := 0.0
	while device.get_state() != SpidarG.STATE_CALIBRATED and waited_s < ZERO_LIMIT_S:
		if device.get_state() == SpidarG.STATE_FAULT:
			device.clear_fault()
		await _hand.move_to(device.global_transform.orthonormalized(), ZERO_STILL_S)
		waited_s += ZERO_STILL_S
		if device.get_state() == SpidarG.STATE_CONNECTED:
			device.zero_at_home()
			await _hand.wait(ZERO_STILL_S)
		var angle_rad := 0.0
		while device.get_state() == SpidarG.STATE_TAUT and angle_rad < 2.0 * TAU:
			angle_rad += 0.1
			waited_s += 1.0 / Engine.physics_ticks_per_second
			var way := Vector3(sin(angle_rad), sin(0.75 * angle_rad), -sin(0.875 * angle_rad))
			await _hand.follow(device.global_transform.orthonormalized().translated_local(ZERO_WAY_M * way))
	await _hand.move_to(device.global_transform.orthonormalized(), 1.0)
	if device.get_state() == SpidarG.STATE_CALIBRATED:
		device.arm()
	return device.get_state() in [SpidarG.STATE_CALIBRATED, SpidarG.STATE_ARMING, SpidarG.STATE_ACTIVE]


## A busy computer holds the boards' answers up, and the device stops itself: it is armed again, and zeroed where it was lost.
func _recover() -> void:
	var device := trial.spidar
	for attempt in RECOVERIES:
		if device.get_state() == SpidarG.STATE_ACTIVE or _hand.stopped:
			return
		if device.get_state() == SpidarG.STATE_FAULT:
			device.clear_fault()
			await _hand.wait(RECOVERY_S)
			device.arm()
			await _hand.wait(RECOVERY_S)
		elif device.get_state() in [SpidarG.STATE_CLOSED, SpidarG.STATE_CONNECTED]:
			await _zero()
		await _hand.wait(RECOVERY_S)


func _inject_faults(arguments: PlayArguments) -> void:
	if arguments.cut_output:
		trial.spidar.inject_simulated_fault(SpidarG.FAULT_OUTPUT_CUT)
	if arguments.freeze_pose:
		trial.spidar.inject_simulated_fault(SpidarG.FAULT_FROZEN_COUNTS)


func _time_limit_s() -> float:
	return TIME_LIMIT_S + CARRY_LIMIT_S * trial.arguments.carries
