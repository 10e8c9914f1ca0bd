extends RefCounted
## Least squares line through points added one by one.

const MIN_SAMPLES := 3

var _count := 0
var _mean_x := 0.0
var _mean_y := 0.0
var _sum_xx := 0.0
var _sum_xy := 0.0
var _sum_yy := 0.0


func add(x: float, y: float) -> void:
	_count += 1
	var from_mean := x - _mean_x
	_mean_x += from_mean / _count
	var above_mean := y - _mean_y
	_mean_y += above_mean / _count
	_sum_xx += from_mean * (x - _mean_x)
	_sum_xy += from_mean * (y - _mean_y)
	_sum_yy += above_mean * (y - _mean_y)


## NaN when the points do not make a line.
func slope() -> float:
	return NAN if _count < MIN_SAMPLES or not _sum_xx > 0.0 else _sum_xy / _sum_xx


func at(x: float) -> float:
	return _mean_y + slope() * (x - _mean_x)


## Root mean square of what the line leaves.
func ripple() -> float:
	if is_nan(slope()):
		return NAN
	return sqrt(maxf(_sum_yy - _sum_xy * _sum_xy / _sum_xx, 0.0) / _count)
