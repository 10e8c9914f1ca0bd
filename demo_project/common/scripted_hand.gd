class_name ScriptedHand
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

## Emitted after each step of the hand, before the device steps.
signal stepped

var spidar: SpidarG
## Set from outside to make every coroutine return at its next step.
var stopped := false
## Where the grip is wanted, and what the hand aims at.
var wanted := Transform3D.IDENTITY
var grasp_angle_rad := 0.0

var _correction_m := Vector3.ZERO


func start(spidar_: SpidarG) -> void:
	spidar = spidar_
	wanted = spidar.get_grip_transform()


## Reaches for a pose; the grasp angle stays.
func move_to(goal: Transform3D, duration_s: float) -> void:
	var from := wanted
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


static func minimum_jerk(x: float) -> float:
	return x * x * x * (10.0 + x * (6.0 * x - 15.0))


func _step(slow: bool) -> void:
	if slow:
		var error := wanted.origin - spidar.get_grip_transform().origin
		_correction_m += error * SIGHT_GAIN_1_S * _tick_s()
		_correction_m = _correction_m.limit_length(SIGHT_LIMIT_M)
	var aim := Transform3D(wanted.basis, wanted.origin + _correction_m)
	spidar.simulated_hand_target(aim, grasp_angle_rad)
	await get_tree().physics_frame
	stepped.emit()


func _tick_s() -> float:
	return 1.0 / Engine.physics_ticks_per_second
