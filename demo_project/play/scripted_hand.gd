extends Node
## Moves the simulated hand as a person would: smooth reaches (minimum jerk, Flash and Hogan 1985)
## and, when slow, a correction by eye so that the grip arrives where it is wanted although the hand
## is soft and the object heavy. It only sets the simulated hand's target.
##
## Every call that takes time is a coroutine that runs one step a physics tick.

## Correction by eye: share of the seen error taken up each second, and its bound.
const SIGHT_GAIN_1_S := 4.0
const SIGHT_LIMIT_M := 0.020
const SIGHT_SPEED_M_S := 0.02

## Physiological tremor: about 8 to 12 Hz, well under a millimetre at the hand.
const TREMOR_HZ: PackedFloat64Array = [8.3, 9.7, 11.9]
const TREMOR_M := 0.00012
## A clumsy hand aims this far beside at each reach, until it sees it, and trembles more.
const CLUMSY_MISS_M := 0.004
const CLUMSY_TREMOR := 2.0
const CLUMSY_HASTE := 0.85

## Emitted after each step of the hand, before the device steps.
signal stepped

const ModelHand := preload("res://play/model_hand.gd")

var spidar: SpidarG
## In place of the simulated device's own hand; null: that one.
var model: ModelHand
## Set from outside to make every coroutine return at its next step.
var stopped := false
## Where the grip is wanted, and what the hand aims at.
var wanted := Transform3D.IDENTITY
var grasp_angle_rad := 0.0

var _correction_m := Vector3.ZERO
var _tremor_m := 0.0
var _miss_m := 0.0
var _haste := 1.0
var _time_s := 0.0
var _random := RandomNumberGenerator.new()


func start(spidar_: SpidarG) -> void:
	spidar = spidar_
	wanted = spidar.get_grip_transform()


## One of PlayArguments.HANDS; the same seed trembles alike.
func be(kind: String, seed_number: int) -> void:
	_random.seed = seed_number
	_tremor_m = 0.0 if kind == "steady" else TREMOR_M
	if kind == "clumsy":
		_tremor_m *= CLUMSY_TREMOR
		_miss_m = CLUMSY_MISS_M
		_haste = CLUMSY_HASTE


## Reaches for a pose; the grasp angle stays.
func move_to(goal: Transform3D, duration_s: float) -> void:
	var from := wanted
	if from.origin.distance_to(goal.origin) > _miss_m:
		_correction_m += _anywhere(_miss_m)
		duration_s *= _haste
	var elapsed_s := 0.0
	while elapsed_s < duration_s and not stopped:
		elapsed_s = minf(elapsed_s + _tick_s(), duration_s)
		wanted = from.interpolate_with(goal, minimum_jerk(elapsed_s / duration_s))
		await _step(from.origin.distance_to(goal.origin) / duration_s < SIGHT_SPEED_M_S)


## Opens or closes smoothly.
func turn_grasp_to(goal_rad: float, duration_s: float) -> void:
	var from := grasp_angle_rad
	var elapsed_s := 0.0
	while elapsed_s < duration_s and not stopped:
		elapsed_s = minf(elapsed_s + _tick_s(), duration_s)
		grasp_angle_rad = lerpf(from, goal_rad, minimum_jerk(elapsed_s / duration_s))
		await _step(true)


## One tick on the way, too fast for a correction by eye.
func follow(pose: Transform3D) -> void:
	wanted = pose
	await _step(false)


## One tick with the grasp target moved by this much.
func nudge_grasp(by_rad: float) -> void:
	grasp_angle_rad += by_rad
	await _step(true)


func wait(duration_s: float) -> void:
	var elapsed_s := 0.0
	while elapsed_s < duration_s and not stopped:
		elapsed_s += _tick_s()
		await _step(true)


## Waits until the grip is seen where it is wanted. False when it is not within the time.
func settle(tolerance_m: float, limit_s: float) -> bool:
	var elapsed_s := 0.0
	while elapsed_s < limit_s and not stopped:
		elapsed_s += _tick_s()
		await _step(true)
		if spidar.get_grip_transform().origin.distance_to(wanted.origin) < tolerance_m:
			return true
	return false


## What really happens at the grip: grasp_angle, strings_wrench.
func truth() -> Dictionary:
	return spidar.get_simulated_truth() if model == null else model.truth


func set_firmness(firmness: SpidarG.HandFirmness) -> void:
	spidar.set_simulated_hand_firmness(firmness)
	if model != null:
		model.set_firmness(firmness)


static func minimum_jerk(x: float) -> float:
	return x * x * x * (10.0 + x * (6.0 * x - 15.0))


func _step(slow: bool) -> void:
	if slow:
		var error := wanted.origin - spidar.get_grip_transform().origin
		_correction_m += error * SIGHT_GAIN_1_S * _tick_s()
		_correction_m = _correction_m.limit_length(SIGHT_LIMIT_M)
	_time_s += _tick_s()
	var aim := Transform3D(wanted.basis, wanted.origin + _correction_m + _tremor())
	if model == null:
		spidar.set_simulated_hand_target(aim, grasp_angle_rad)
	else:
		model.aim(spidar, aim, grasp_angle_rad)
	await get_tree().physics_frame
	stepped.emit()


func _tremor() -> Vector3:
	var shake := Vector3.ZERO
	for axis in 3:
		shake[axis] = _tremor_m * sin(TAU * TREMOR_HZ[axis] * _time_s + axis)
	return shake


func _anywhere(within_m: float) -> Vector3:
	var way := Vector3(
		_random.randf_range(-1.0, 1.0), _random.randf_range(-1.0, 1.0), _random.randf_range(-1.0, 1.0)
	)
	return within_m * way.limit_length(1.0)


func _tick_s() -> float:
	return 1.0 / Engine.physics_ticks_per_second
