class_name CameraRig
extends Node3D
## The demo's one view, seen from where a person sits; the middle button looks round the device.

const LOOK_RAD_PER_PIXEL := 0.004
const YAW_LIMIT_RAD := deg_to_rad(55.0)
const PITCH_RANGE_RAD := Vector2(deg_to_rad(-60.0), deg_to_rad(-4.0))

var _home := Vector3.ZERO


func _ready() -> void:
	_home = rotation


func _unhandled_input(event: InputEvent) -> void:
	var motion := event as InputEventMouseMotion
	if motion == null or not motion.button_mask & MOUSE_BUTTON_MASK_MIDDLE:
		return
	rotation.y = clampf(
		rotation.y - motion.relative.x * LOOK_RAD_PER_PIXEL,
		_home.y - YAW_LIMIT_RAD, _home.y + YAW_LIMIT_RAD
	)
	rotation.x = clampf(
		rotation.x - motion.relative.y * LOOK_RAD_PER_PIXEL, PITCH_RANGE_RAD.x, PITCH_RANGE_RAD.y
	)
