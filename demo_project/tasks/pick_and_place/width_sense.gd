class_name WidthSense
extends RefCounted
## Feels a width as a person does: where, while closing, the fingers begin to push back. From samples of
## (grasp angle, torque that opens) it takes the level of free closing, then fits a line to the first of
## the push and finds the angle at which the push begins. It knows nothing of the object or of the stop.

## Free closing is judged between these angles after the start: past the strings' break-away, before any
## touch that the clearance of the opened fingers allows.
const FREE_FROM_RAD := deg_to_rad(2.0)
const FREE_TO_RAD := deg_to_rad(6.0)
## Push above the free level that counts as the first of the touch: above the ripple of free closing
## (below 1 mN m), and before a body off the middle has been pushed into it.
const TOUCH_FROM_NM := 0.0015
const TOUCH_TO_NM := 0.010
const MIN_SAMPLES := 3

var _angles_rad := PackedFloat64Array()
var _torques_nm := PackedFloat64Array()


func add(angle_rad: float, opening_torque_nm: float) -> void:
	_angles_rad.append(angle_rad)
	_torques_nm.append(opening_torque_nm)


## Median torque of free closing; NaN before there is any.
func free_torque_nm() -> float:
	var free := PackedFloat64Array()
	for index in _angles_rad.size():
		var way := _angles_rad[index] - _angles_rad[0]
		if way >= FREE_FROM_RAD and way <= FREE_TO_RAD:
			free.append(_torques_nm[index])
	if free.is_empty():
		return NAN
	free.sort()
	return free[free.size() >> 1]


## Push of the last sample, above free closing.
func push_nm() -> float:
	return NAN if _torques_nm.is_empty() else _torques_nm[-1] - free_torque_nm()


## Angle at which the push begins; NaN when nothing pushed back.
func touch_angle_rad() -> float:
	var free := free_torque_nm()
	var count := 0
	var sum_t := 0.0
	var sum_a := 0.0
	var sum_tt := 0.0
	var sum_ta := 0.0
	for index in range(_first_touch(free), _angles_rad.size()):
		var push := _torques_nm[index] - free
		if push > TOUCH_TO_NM:
			break
		count += 1
		sum_t += push
		sum_a += _angles_rad[index]
		sum_tt += push * push
		sum_ta += push * _angles_rad[index]
	var spread := count * sum_tt - sum_t * sum_t
	if count < MIN_SAMPLES or not spread > 0.0:
		return NAN
	var slope := (count * sum_ta - sum_t * sum_a) / spread
	return (sum_a - slope * sum_t) / count


## Index after the last sample that was still free.
func _first_touch(free_nm: float) -> int:
	var index := _torques_nm.size()
	while index > 0 and _torques_nm[index - 1] - free_nm >= TOUCH_FROM_NM:
		index -= 1
	return index
