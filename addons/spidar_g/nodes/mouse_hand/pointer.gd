extends RefCounted
## Handles the cursor of SpidarGMouseHand: computes where it points and what the clutch leaves, and hides the cursor while it
## turns the grip.

## If the cosine of the angle between the view and the ground is below this value, the wheel moves along the view and not
## along the ground.
const LEVEL_VIEW: float = 0.2

## If [code]true[/code], the mouse turns the grip and does not move it.
var turning: bool = false

var _mode_before: Input.MouseMode = Input.MOUSE_MODE_VISIBLE
# The last position of the cursor, and the distance that the clutch left between it and the grip, in pixels.
var _cursor_px: Vector2 = Vector2.ZERO
var _offset_px: Vector2 = Vector2.ZERO
var _was_clutched: bool = false


## Returns the position in the world to which the cursor moves a grip with the target `at`: under the cursor, at the same
## depth. Returns `at` while the clutch is pressed or if the cursor points nowhere.
func point(motion: InputEventMouseMotion, camera: Camera3D, at: Vector3, clutched: bool) -> Vector3:
	var from_px: Vector2 = _cursor_px
	_cursor_px = motion.position
	if clutched:
		_was_clutched = true
		return at
	if _was_clutched:
		_was_clutched = false
		_offset_px = camera.unproject_position(at) - from_px
	var depth: float = -camera.to_local(at).z
	var under: Vector3 = camera.project_position(motion.position + _offset_px, depth)
	return under if depth > camera.near and under.is_finite() else at


## Returns the direction in the world in which the wheel moves the grip away from the viewer.
static func way_in_depth(camera: Camera3D) -> Vector3:
	var forward: Vector3 = -camera.global_basis.orthonormalized().z
	# Along the ground, so that depth does not change the height over a table.
	if Vector2(forward.x, forward.z).length() > LEVEL_VIEW:
		forward.y = 0.0
	return forward.normalized()


## Puts the grip under the cursor again, without the distance that the clutch left.
func forget_clutch() -> void:
	_was_clutched = false
	_offset_px = Vector2.ZERO


## Starts to turn the grip, and captures the cursor.
func begin_turn() -> void:
	if turning:
		return
	turning = true
	# Captured, the cursor stays where it was: the grip does not jump when the turn ends.
	_mode_before = Input.mouse_mode
	Input.mouse_mode = Input.MOUSE_MODE_CAPTURED


## Stops turning the grip, and frees the cursor where it was.
func end_turn() -> void:
	if turning:
		turning = false
		Input.mouse_mode = _mode_before
