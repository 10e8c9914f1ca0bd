extends RefCounted
## Where the physics space has the device. Its bodies stand where the last physics step left them. A node that moves has gone
## on since then, and so has what is fixed to it: 17 mm at 1 m/s and 60 ticks a second.

## Physics engines move nothing faster, m/s.
const FASTEST_M_S: float = 200.0

var _device: SpidarG = null
## Of the device's node when the last physics step began.
var _stepped: Transform3D = Transform3D.IDENTITY
var _is_known: bool = false


## Once a physics tick: notes where the coming step finds the device, when all nodes have moved.
func note(device: SpidarG) -> void:
	if device != _device:
		_device = device
		_is_known = false
	_remember.call_deferred()


## A pose of the scene that moves with the device, as the physics space has it.
func in_space(pose: Transform3D) -> Transform3D:
	return pose if _rests() else _stepped * _device.global_transform.affine_inverse() * pose


## How far the device has gone on since then.
func gone_on() -> Transform3D:
	if _rests():
		return Transform3D.IDENTITY
	return _device.global_transform * _stepped.affine_inverse()


## True in the tick in which the device was put elsewhere, farther than the coming step of delta_s could sweep a body.
func has_jumped(delta_s: float) -> bool:
	return not _rests() and _device.global_position.distance_to(_stepped.origin) > FASTEST_M_S * delta_s


func _rests() -> bool:
	return not _is_known or _device.global_transform == _stepped


func _remember() -> void:
	_is_known = is_instance_valid(_device) and _device.is_inside_tree()
	if _is_known:
		_stepped = _device.global_transform
