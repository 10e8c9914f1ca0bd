extends RefCounted
## Turns the grip of SpidarGMouseHand: hides the cursor while the mouse turns the grip, and turns it upright by steps.

## The grip is upright so long after the key, in seconds: soon, and slowly enough to be followed by the eye.
const UPRIGHT_S: float = 0.3

## If [code]true[/code], the mouse turns the grip and does not move it.
var by_mouse: bool = false

var _mode_before: Input.MouseMode = Input.MOUSE_MODE_VISIBLE
# How fast the grip turns upright, in radians per second; 0 if it does not.
var _upright_rad_s: float = 0.0


## Starts to turn the grip by the mouse, and captures the cursor.
func begin_by_mouse() -> void:
	if by_mouse:
		return
	by_mouse = true
	# Captured, the cursor stays where it was: the grip does not jump when the turn ends.
	_mode_before = Input.mouse_mode
	Input.mouse_mode = Input.MOUSE_MODE_CAPTURED


## Stops turning the grip by the mouse, and frees the cursor where it was.
func end_by_mouse() -> void:
	if by_mouse:
		by_mouse = false
		Input.mouse_mode = _mode_before


## Starts to turn the grip upright from `turn_rad`.
func begin_upright(turn_rad: Vector3) -> void:
	_upright_rad_s = turn_rad.length() / UPRIGHT_S


## Leaves the grip as it is turned.
func end_upright() -> void:
	_upright_rad_s = 0.0


## Returns how the grip is turned after `delta` seconds, if it is turned by `turn_rad` now.
func step(turn_rad: Vector3, delta: float) -> Vector3:
	var next_rad: Vector3 = turn_rad.move_toward(Vector3.ZERO, _upright_rad_s * delta)
	if next_rad.is_zero_approx():
		end_upright()
	return next_rad
