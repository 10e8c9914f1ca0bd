extends RefCounted
## Computes the velocity of a moving frame of reference from its poses in the physics ticks. As in [SpidarG], only motion that
## lasts for two physics ticks counts, so a teleport adds no velocity.

## The velocity of the frame's origin, in m/s.
var linear := Vector3.ZERO
## The angular velocity of the frame, in rad/s.
var angular := Vector3.ZERO

var _place := Transform3D.IDENTITY
var _is_known: bool = false
var _linear_seen := Vector3.ZERO
var _angular_seen := Vector3.ZERO


## Forgets the last pose, so that the velocity is zero.
func forget() -> void:
	_is_known = false
	linear = Vector3.ZERO
	angular = Vector3.ZERO
	_linear_seen = Vector3.ZERO
	_angular_seen = Vector3.ZERO


## Takes the newest pose of the frame of reference, which must be orthonormal. It is `tick_s` seconds newer than the last one.
func note(place: Transform3D, tick_s: float) -> void:
	if _is_known and tick_s > 0.0:
		var moved: Vector3 = (place.origin - _place.origin) / tick_s
		linear = _shared(_linear_seen, moved)
		_linear_seen = moved
		var turn: Quaternion = (place.basis * _place.basis.inverse()).get_rotation_quaternion()
		var turned: Vector3 = turn.get_axis() * (wrapf(turn.get_angle(), -PI, PI) / tick_s)
		angular = _shared(_angular_seen, turned)
		_angular_seen = turned
	_place = place
	_is_known = true


## Returns the velocity, in m/s, of the point of the frame that is at `point` in the world.
func velocity_at(point: Vector3) -> Vector3:
	return linear + angular.cross(point - _place.origin)


static func _shared(last: Vector3, newest: Vector3) -> Vector3:
	if not last.dot(newest) > 0.0:
		return Vector3.ZERO
	return newest.limit_length(last.length())
