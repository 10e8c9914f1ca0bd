extends RefCounted
## Measures how fast a hand approached a body before it touched the body. The touch stops the hand, so the motion of the hands
## and of the body is kept for the last physics ticks.

## The motion is kept for this many physics ticks.
const TICKS: int = 4

var _hands: Dictionary[int, Array] = {}
var _body: Array[Motion] = []


## Holds the position and the velocity of a rigid body or grip, in world coordinates.
class Motion:
	var at: Vector3
	var linear: Vector3
	var angular: Vector3

	func _init(place: Vector3, velocity: Vector3, turn_rate: Vector3) -> void:
		at = place
		linear = velocity
		angular = turn_rate

	func velocity_of(point: Vector3) -> Vector3:
		return linear + angular.cross(point - at)


## Records the motion of the body and of all hands. Call it once per physics tick.
func note(body: PhysicsBody3D, hands: Array[SpidarGHand]) -> void:
	_keep(_body, _motion_of_body(body))
	for id: int in _hands.keys():
		if not is_instance_id_valid(id):
			_hands.erase(id)
	for hand: SpidarGHand in hands:
		var spidar: SpidarG = hand.spidar
		if spidar == null or spidar.get_state() == SpidarG.STATE_CLOSED:
			_hands.erase(hand.get_instance_id())
			continue
		var motion := Motion.new(
			spidar.get_grip_transform().origin, spidar.get_linear_velocity(), spidar.get_angular_velocity()
		)
		_keep(_hands.get_or_add(hand.get_instance_id(), [] as Array[Motion]), motion)


## Forgets all recorded motion of the body and the hands.
func forget() -> void:
	_hands.clear()
	_body.clear()


## Returns the largest speed, within the kept ticks, at which hand and body approached each other at `point`, in meters of
## device motion per second. The speed is measured along `normal`, which points out of the body.
func speed(hand: SpidarGHand, point: Vector3, normal: Vector3) -> float:
	var of_hand: Array = _hands.get(hand.get_instance_id(), [])
	var most: float = 0.0
	for back: int in range(1, mini(of_hand.size(), _body.size()) + 1):
		var apart: Vector3 = (of_hand[-back] as Motion).velocity_of(point) - _body[-back].velocity_of(point)
		most = maxf(most, -apart.dot(normal))
	return most / hand.spidar.workspace_scale


static func _keep(motions: Array, newest: Motion) -> void:
	motions.append(newest)
	if motions.size() > TICKS:
		motions.remove_at(0)


static func _motion_of_body(body: PhysicsBody3D) -> Motion:
	if body is StaticBody3D and not body is AnimatableBody3D:
		return Motion.new(body.global_position, Vector3.ZERO, Vector3.ZERO)
	var rid: RID = body.get_rid()
	return Motion.new(
		body.global_position,
		PhysicsServer3D.body_get_state(rid, PhysicsServer3D.BODY_STATE_LINEAR_VELOCITY),
		PhysicsServer3D.body_get_state(rid, PhysicsServer3D.BODY_STATE_ANGULAR_VELOCITY)
	)
