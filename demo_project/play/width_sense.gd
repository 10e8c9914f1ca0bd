extends RefCounted
## Feels a width as a person does: where, while closing, the fingers begin to push back. From samples of
## (grasp angle, torque that opens) it finds the knee where free closing, which drifts with the angle, becomes a
## push: there the squeeze is nothing. It knows nothing of the body or of the stop.

const FitLine := preload("res://play/fit_line.gd")

## Closing has broken the strings away after this much.
const FREE_FROM_RAD := deg_to_rad(3.0)
## Free closing is known after this much more; a line through less follows its ripple.
const KNOWN_AFTER_RAD := deg_to_rad(2.0)
## Free closing is judged over this much before the first risen sample, the push over this much after it.
const BEFORE_RAD := deg_to_rad(4.0)
const AFTER_RAD := deg_to_rad(1.6)
## A push: this many samples in a row above free closing by this much, and by so many times its ripple.
const RISING_SAMPLES := 3
## The line leaves out what came just before: a soft thing's slow push would bend it and hide in it.
const GUARD_RAD := deg_to_rad(1.0)
const RISE_NM := 0.0005
const RISE_RIPPLES := 4.0
## The knee is looked for round the first risen sample.
const KNEE_BEFORE_RAD := deg_to_rad(1.5)
const KNEE_AFTER_RAD := deg_to_rad(0.5)
const KNEE_STEP_RAD := deg_to_rad(0.05)

var _angles_rad := PackedFloat64Array()
var _torques_nm := PackedFloat64Array()


func add(angle_rad: float, opening_torque_nm: float) -> void:
	_angles_rad.append(angle_rad)
	_torques_nm.append(opening_torque_nm)


## Push of the last sample, above free closing at the knee; NaN before any is felt.
func push_nm() -> float:
	var first := _first_risen()
	return NAN if first < 0 else _torques_nm[-1] - _line_before(first).at(_angles_rad[first])


## Angle at which the push begins; NaN when nothing pushed back.
func touch_angle_rad() -> float:
	var first := _first_risen()
	if first < 0:
		return NAN
	var best_rad := NAN
	var best_sum := INF
	var knee := _angles_rad[first] - KNEE_BEFORE_RAD
	while knee < _angles_rad[first] + KNEE_AFTER_RAD:
		var sum := _misfit(knee, _angles_rad[first])
		if sum < best_sum:
			best_sum = sum
			best_rad = knee
		knee += KNEE_STEP_RAD
	return best_rad


## The first of RISING_SAMPLES that all stand above the line of the free closing GUARD_RAD before them; -1: none.
func _first_risen() -> int:
	for first in range(1, _angles_rad.size() - RISING_SAMPLES + 1):
		if _angles_rad[first] - _angles_rad[0] < FREE_FROM_RAD + KNOWN_AFTER_RAD + GUARD_RAD:
			continue
		var line := _line_before(first)
		var rise := maxf(RISE_NM, RISE_RIPPLES * line.ripple())
		var risen := not is_nan(line.slope())
		for index in range(first, first + RISING_SAMPLES):
			risen = risen and _torques_nm[index] - line.at(_angles_rad[index]) > rise
		if risen:
			return first
	return -1


func _line_before(first: int) -> FitLine:
	var line := FitLine.new()
	var until := _angles_rad[first] - GUARD_RAD
	for index in first:
		var angle := _angles_rad[index]
		var free := angle - _angles_rad[0] >= FREE_FROM_RAD
		if free and angle >= until - BEFORE_RAD and angle <= until:
			line.add(angle, _torques_nm[index])
	return line


## Sum of squares left by free closing up to `knee` and a straight rise from its end. Every knee is judged by the same
## samples: when an earlier one left out the last of them, it won by having less to explain.
func _misfit(knee: float, around: float) -> float:
	var free := FitLine.new()
	for index in _angles_rad.size():
		var angle := _angles_rad[index]
		if angle - _angles_rad[0] >= FREE_FROM_RAD and angle >= around - BEFORE_RAD and angle <= knee:
			free.add(angle, _torques_nm[index])
	if is_nan(free.slope()):
		return INF
	var across := 0.0
	var along := 0.0
	for index in _angles_rad.size():
		var past := _angles_rad[index] - knee
		if past > 0.0 and _angles_rad[index] < around + AFTER_RAD:
			across += past * (_torques_nm[index] - free.at(_angles_rad[index]))
			along += past * past
	var rise := across / along if along > 0.0 else 0.0
	var sum := 0.0
	for index in _angles_rad.size():
		var angle := _angles_rad[index]
		if angle - _angles_rad[0] >= FREE_FROM_RAD and angle >= around - BEFORE_RAD and angle < around + AFTER_RAD:
			var left := _torques_nm[index] - free.at(angle) - rise * maxf(angle - knee, 0.0)
			sum += left * left
	return sum
