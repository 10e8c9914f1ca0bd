extends RefCounted
## Closes and opens the fingers of SpidarGMouseHand by steps. Angles are grasp angles.

## The grasp angle of the open fingers, in radians.
const OPEN_ANGLE_RAD: float = deg_to_rad(4.0)
## Empty fingers close this much further than SpidarGConfig.jaw_closed_angle, in radians.
const OVERCLOSE_RAD: float = deg_to_rad(2.0)
## If the strings push the fingers back by more than this grasp torque, in newton meters, the fingers close up to PRESSING_RAD,
## so that a thin body can be squeezed as hard as a wide one.
const PUSHED_NM: float = 0.008
## The largest grasp angle of fingers that squeeze a body, in radians.
const PRESSING_RAD: float = deg_to_rad(80.0)

## If [code]true[/code], the fingers close until something stops them. If [code]false[/code], they open.
var closing: bool = false


## Returns the grasp angle of the fingers of `device` after the way `by_rad`, if it is `angle_rad` now. Closing fingers stay
## where they are if the strings push them back by `squeeze_nm`.
func step(angle_rad: float, by_rad: float, squeeze_nm: float, device: SpidarG) -> float:
	var pushed_nm: float = -device.get_achieved_wrench()[6]
	var end_rad: float = device.get_effective_config().jaw_closed_angle + OVERCLOSE_RAD
	if not closing:
		return maxf(minf(angle_rad, end_rad) - by_rad, OPEN_ANGLE_RAD)
	if pushed_nm >= squeeze_nm:
		return angle_rad
	return minf(angle_rad + by_rad, PRESSING_RAD if pushed_nm > PUSHED_NM else end_rad)
