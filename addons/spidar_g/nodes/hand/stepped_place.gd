extends RefCounted
## Where the device was at the last physics step. The bodies of the physics space stand where that step left them, while the
## node of a device on a lift has moved on: by 17 mm at 1 m/s and 60 ticks a second. Queries of the space need the earlier place.

## Physics engines cannot move a body much faster, m/s.
const FASTEST_M_S: float = 200.0

var _device: SpidarG = null
## Transform of the device's node when the last physics step began.
var _stepped: Transform3D = Transform3D.IDENTITY
var _is_known: bool = false


## Call it once a physics tick. Remembers the node's place at the end of the tick, when all nodes have moved.
func note(device: SpidarG) -> void:
	if device != _device:
		_device = device
		_is_known = false
	_remember.call_deferred()


## Where `pose`, which moves with the device, was at the last physics step.
func in_space(pose: Transform3D) -> Transform3D:
	return pose if _rests() else _stepped * _device.global_transform.affine_inverse() * pose


## The motion of the device since the last physics step.
func gone_on() -> Transform3D:
	if _rests():
		return Transform3D.IDENTITY
	return _device.global_transform * _stepped.affine_inverse()


## True in the tick in which the device was put so far away that a physics step of delta_s cannot carry a body there.
func has_jumped(delta_s: float) -> bool:
	return not _rests() and _device.global_position.distance_to(_stepped.origin) > FASTEST_M_S * delta_s


func _rests() -> bool:
	return not _is_known or _device.global_transform == _stepped


func _remember() -> void:
	_is_known = is_instance_valid(_device) and _device.is_inside_tree()
	if _is_known:
		_stepped = _device.global_transform
