extends Node3D
## The demo's one view, seen from where a person sits; the middle button looks round the device.

const LOOK_RAD_PER_PIXEL := 0.004
const YAW_LIMIT_RAD := deg_to_rad(55.0)
const PITCH_RANGE_RAD := Vector2(deg_to_rad(-60.0), deg_to_rad(-4.0))

const CLOSE_FOV_DEG := 15.0

var _home := Vector3.ZERO
var _home_fov_deg := 0.0

@onready var _camera: Camera3D = $Camera


func _ready() -> void:
	_home = rotation
	_home_fov_deg = _camera.fov


## A close look at one point from the same place.
func look_closely(point: Vector3) -> void:
	_camera.fov = CLOSE_FOV_DEG
	_camera.look_at(point)


func look_at_all() -> void:
	_camera.fov = _home_fov_deg
	_camera.rotation = Vector3.ZERO


func _unhandled_input(event: InputEvent) -> void:
	var motion := event as InputEventMouseMotion
	if motion == null or not Input.is_action_pressed(&"demo_look_round"):
		return
	rotation.y = clampf(
		rotation.y - motion.relative.x * LOOK_RAD_PER_PIXEL,
		_home.y - YAW_LIMIT_RAD, _home.y + YAW_LIMIT_RAD
	)
	rotation.x = clampf(
		rotation.x - motion.relative.y * LOOK_RAD_PER_PIXEL, PITCH_RANGE_RAD.x, PITCH_RANGE_RAD.y
	)
