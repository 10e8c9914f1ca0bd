extends RefCounted
## Velocity of a frame of reference that moves through the scene, from its places in the physics ticks. As in [SpidarG], a
## frame that is put elsewhere in one tick has jumped and has no velocity: only what two ticks in a row share counts.

var linear := Vector3.ZERO
var angular := Vector3.ZERO

var _place := Transform3D.IDENTITY
var _is_known: bool = false
var _linear_seen := Vector3.ZERO
var _angular_seen := Vector3.ZERO


func forget() -> void:
	_is_known = false
	linear = Vector3.ZERO
	angular = Vector3.ZERO
	_linear_seen = Vector3.ZERO
	_angular_seen = Vector3.ZERO


## Takes the newest place (orthonormal), `tick_s` after the one before.
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


## Returns the velocity of the point of the frame that is at `point` of the world, in m/s.
func velocity_at(point: Vector3) -> Vector3:
	return linear + angular.cross(point - _place.origin)


static func _shared(last: Vector3, newest: Vector3) -> Vector3:
	if not last.dot(newest) > 0.0:
		return Vector3.ZERO
	return newest.limit_length(last.length())
