extends RefCounted
## The cursor of SpidarGMouseHand: where it points, what the clutch leaves, and how it is hidden while it turns the grip.

## Below this cosine between the view and the ground, the wheel moves along the view instead of the ground.
const LEVEL_VIEW: float = 0.2

## Whether the mouse turns the grip instead of moving it.
var turning: bool = false

var _mode_before: Input.MouseMode = Input.MOUSE_MODE_VISIBLE
# Where the cursor was last, and how far the clutch left the grip from it, px.
var _cursor_px: Vector2 = Vector2.ZERO
var _offset_px: Vector2 = Vector2.ZERO
var _was_clutched: bool = false


## The place (world) to which the cursor brings a grip that is to be at `at`: under the cursor, at the same depth. With the
## clutch pressed, or where the cursor points nowhere, that is `at` itself.
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


## The direction (world) in which the wheel moves the grip away from the viewer.
static func way_in_depth(camera: Camera3D) -> Vector3:
	var forward: Vector3 = -camera.global_basis.orthonormalized().z
	# Along the ground, so that depth does not change the height over a table.
	if Vector2(forward.x, forward.z).length() > LEVEL_VIEW:
		forward.y = 0.0
	return forward.normalized()


## The grip is under the cursor again.
func forget_clutch() -> void:
	_was_clutched = false
	_offset_px = Vector2.ZERO


func begin_turn() -> void:
	if turning:
		return
	turning = true
	# Captured, the cursor stays where it was: the grip does not jump when the turn ends.
	_mode_before = Input.mouse_mode
	Input.mouse_mode = Input.MOUSE_MODE_CAPTURED


func end_turn() -> void:
	if turning:
		turning = false
		Input.mouse_mode = _mode_before
