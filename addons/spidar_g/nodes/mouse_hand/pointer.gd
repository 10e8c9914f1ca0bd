extends RefCounted
## Handles the cursor of SpidarGMouseHand: computes where the cursor wants the grip, and how the grip goes there. Positions and
## ways whose names end with _m are in the device's frame, in meters of device motion.

## The grip glides under the cursor at this speed, in meters of device motion per second. The keys are half as fast
## (SpidarGMouseHand.key_speed): the glide ends soon, and what the grip meets on its way is touched and not hit.
const GLIDE_M_S: float = 0.25
## The cursor moves the grip no faster than this, in meters of device motion per second. A cursor can cross the window in one
## event, and no hand moves the grip of a device so fast.
const HAND_M_S: float = 1.0
## If the cosine of the angle between the view and the ground is below this value, the wheel moves along the view and not
## along the ground.
const LEVEL_VIEW: float = 0.2

# The last position of the cursor, if it has moved, and the distance that the grip keeps to it, in pixels.
var _has_cursor: bool = false
var _cursor_px: Vector2 = Vector2.ZERO
var _offset_px: Vector2 = Vector2.ZERO
# If true, the grip keeps the distance that it has to the cursor at the next motion.
var _keeps_distance: bool = false
# Where the cursor wants the grip; it may be out of reach.
var _goal_m: Vector3 = Vector3.ZERO
# What is left of the glide: the grip goes to this distance from the goal.
var _lag_m: Vector3 = Vector3.ZERO
# Where the last step left the grip. If the grip is elsewhere, a key, the wheel or a script has moved it.
var _left_m: Vector3 = Vector3.INF


## Returns the direction in the world in which the wheel moves the grip away from the viewer.
static func way_in_depth(camera: Camera3D) -> Vector3:
	var forward: Vector3 = -camera.global_basis.orthonormalized().z
	# Along the ground, so that depth does not change the height over a table.
	if Vector2(forward.x, forward.z).length() > LEVEL_VIEW:
		forward.y = 0.0
	return forward.normalized()


## The cursor wants the grip, which has the target `at_m`, in the view plane; `reach` limits each axis. `to_world` transforms
## meters of device motion to the world. The grip goes the way of the cursor at once. The distance that the grip has to the
## cursor before, as at the first motion or after the wheel, is left to the glide.
func follow(motion: InputEventMouseMotion, camera: Camera3D, at_m: Vector3, reach: float, to_world: Transform3D) -> void:
	var from_px: Vector2 = _cursor_px if _has_cursor else motion.position
	note_cursor(motion)
	_go_along(at_m)
	var goal: Vector3 = to_world * _goal_m
	var depth: float = -camera.to_local(goal).z
	if depth <= camera.near:
		return
	if _keeps_distance:
		_keeps_distance = false
		_offset_px = camera.unproject_position(goal) - from_px
	var before: Vector3 = camera.project_position(from_px + _offset_px, depth)
	var after: Vector3 = camera.project_position(_cursor_px + _offset_px, depth)
	if before.is_finite() and after.is_finite():
		var before_m: Vector3 = to_world.affine_inverse() * before
		_lag_m += _goal_m.clampf(-reach, reach) - before_m.clampf(-reach, reach)
		_goal_m = to_world.affine_inverse() * after


## Notes where the cursor is, and moves nothing.
func note_cursor(motion: InputEventMouseMotion) -> void:
	_has_cursor = true
	_cursor_px = motion.position


## Returns where the grip is after `delta` seconds, within `reach` along each axis, if it is at `at_m` now.
func step(at_m: Vector3, reach: float, delta: float) -> Vector3:
	if not _has_cursor:
		return at_m
	_go_along(at_m)
	_lag_m = _lag_m.move_toward(Vector3.ZERO, GLIDE_M_S * delta)
	var to_m: Vector3 = (_goal_m.clampf(-reach, reach) + _lag_m).clampf(-reach, reach)
	_left_m = at_m.move_toward(to_m, HAND_M_S * delta)
	return _left_m


## The grip stays where it is, and then keeps its distance to the cursor.
func hold() -> void:
	_lag_m = Vector3.ZERO
	_left_m = Vector3.INF
	_keeps_distance = true


## From now on the grip keeps the distance to the cursor to which a key moves it.
func keep_distance() -> void:
	_keeps_distance = true


## Forgets the cursor: at its next motion the grip glides under it.
func forget() -> void:
	_has_cursor = false
	_keeps_distance = false
	_offset_px = Vector2.ZERO
	_lag_m = Vector3.ZERO
	_left_m = Vector3.INF


# A grip that something else has moved since the last step is at the goal now, but for the glide. The cursor does not pull it
# back.
func _go_along(at_m: Vector3) -> void:
	if at_m != _left_m:
		_goal_m = at_m - _lag_m
		_left_m = at_m
