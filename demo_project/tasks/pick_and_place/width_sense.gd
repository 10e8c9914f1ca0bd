class_name WidthSense
extends RefCounted
## Feels a width as a person does: where, while closing, the fingers begin to push back. From samples of
## (grasp angle, torque that opens) it takes free closing as a line, then fits another to the first of the
## push and finds the angle at which the push begins. It knows nothing of the object or of the stop.

## Free closing is judged between these angles after the start: past the strings' break-away, before any
## touch that the clearance of the opened fingers allows. Far from the middle it drifts with the angle.
const FREE_FROM_RAD := deg_to_rad(3.0)
const FREE_TO_RAD := deg_to_rad(7.0)
## Push above free closing that counts as the first of the touch: above its ripple (about 1 mN m), and
## before a body off the middle has been pushed into it.
const TOUCH_FROM_NM := 0.0015
const TOUCH_TO_NM := 0.010
const MIN_SAMPLES := 3

var _angles_rad := PackedFloat64Array()
var _torques_nm := PackedFloat64Array()


func add(angle_rad: float, opening_torque_nm: float) -> void:
	_angles_rad.append(angle_rad)
	_torques_nm.append(opening_torque_nm)


## Push of the last sample, above free closing; NaN before there is any.
func push_nm() -> float:
	return NAN if _torques_nm.is_empty() else _torques_nm[-1] - _free_line().at(_angles_rad[-1])


## Angle at which the push begins; NaN when nothing pushed back.
func touch_angle_rad() -> float:
	var free := _free_line()
	var first := _angles_rad.size()
	while first > 0 and _push_nm(first - 1, free) >= TOUCH_FROM_NM:
		first -= 1
	var touch := Line.new() # angle over push: at no push it is the angle of the touch
	for index in range(first, _angles_rad.size()):
		var push := _push_nm(index, free)
		if push > TOUCH_TO_NM:
			break
		touch.add(push, _angles_rad[index])
	return touch.at(0.0)


func _push_nm(index: int, free: Line) -> float:
	return _torques_nm[index] - free.at(_angles_rad[index])


func _free_line() -> Line:
	var line := Line.new()
	for index in _angles_rad.size():
		var way := _angles_rad[index] - _angles_rad[0]
		if way >= FREE_FROM_RAD and way <= FREE_TO_RAD:
			line.add(_angles_rad[index], _torques_nm[index])
	return line


## Least squares line through points added one by one.
class Line:
	var _count := 0
	var _mean_x := 0.0
	var _mean_y := 0.0
	var _sum_xx := 0.0
	var _sum_xy := 0.0


	func add(x: float, y: float) -> void:
		_count += 1
		var from_mean := x - _mean_x
		_mean_x += from_mean / _count
		_mean_y += (y - _mean_y) / _count
		_sum_xx += from_mean * (x - _mean_x)
		_sum_xy += from_mean * (y - _mean_y)


	## NaN when the points do not make a line.
	func at(x: float) -> float:
		if _count < MIN_SAMPLES or not _sum_xx > 0.0:
			return NAN
		return _mean_y + _sum_xy / _sum_xx * (x - _mean_x)
