class_name WidthSense
extends RefCounted
## Feels a width as a person does: where, while closing, the fingers begin to push back. From samples of
## (grasp angle, torque that opens) it takes the level of free closing, then fits a line to the push and
## finds the angle at which the push begins. It knows nothing of the object or of the stop's stiffness.

## Push above the free level that counts as touch: well above the strings' friction.
const TOUCH_NM := 0.006
const FREE_SHARE := 0.25
const MIN_SAMPLES := 3

var _angles_rad := PackedFloat64Array()
var _torques_nm := PackedFloat64Array()


func add(angle_rad: float, opening_torque_nm: float) -> void:
	_angles_rad.append(angle_rad)
	_torques_nm.append(opening_torque_nm)


## Mean of the first quarter: closing on nothing yet.
func free_torque_nm() -> float:
	var count := maxi(int(_torques_nm.size() * FREE_SHARE), 1)
	var sum := 0.0
	for index in mini(count, _torques_nm.size()):
		sum += _torques_nm[index]
	return sum / count


## Push of the last sample, above free closing.
func push_nm() -> float:
	if _torques_nm.is_empty():
		return 0.0
	return _torques_nm[_torques_nm.size() - 1] - free_torque_nm()


## Angle at which the push begins; NaN when nothing pushed back.
func touch_angle_rad() -> float:
	var free := free_torque_nm()
	var count := 0
	var sum_t := 0.0
	var sum_a := 0.0
	var sum_tt := 0.0
	var sum_ta := 0.0
	for index in _angles_rad.size():
		var push := _torques_nm[index] - free
		if push < TOUCH_NM:
			continue
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
