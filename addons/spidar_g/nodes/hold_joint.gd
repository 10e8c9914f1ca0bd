extends Node3D
## Holds a rigid body to the grip: a kinematic anchor without shape that follows the grip, and a 6-DOF joint,
## all axes locked, from it to the body. Squeezing by friction alone loses thin bodies in a game engine; this does not.

## The pads close on the middle of a body that was caught off-centre within this time.
const CENTRING_TIME_S: float = 0.08
## Speed left to a body that is let go (device m/s), so that a solver's last correction never throws it.
const MAX_RELEASE_SPEED_M_S: float = 2.0

var body: RigidBody3D = null
## True from detain() to the next advance().
var detained: bool = false
var _time_runs: bool = true
var _anchor: AnimatableBody3D = null
var _joint: Generic6DOFJoint3D = null
## From the anchor to the body, as it was when caught.
var _caught: Transform3D = Transform3D.IDENTITY
## Along the grip's x axis, how far the body sat from the middle, and how much of it is still there.
var _off_centre_m: float = 0.0
var _seat: Transform3D = Transform3D.IDENTITY
var _age_s: float = 0.0
var _key: int = 0
## How many hold a body, by its instance, and whether it could sleep before the first did.
static var _holds: Dictionary[int, int] = {}
static var _could_sleep: Dictionary[int, bool] = {}


func _init() -> void:
	top_level = true


## Catches `caught` as it is now. off_centre_m: its middle along the grip's x axis.
func attach(caught: RigidBody3D, grip: Transform3D, off_centre_m: float) -> void:
	body = caught
	_off_centre_m = off_centre_m
	_age_s = 0.0
	_caught = grip.affine_inverse() * body.global_transform
	var key: int = body.get_instance_id()
	if not _holds.has(key):
		_could_sleep[key] = body.can_sleep
	_holds[key] = _holds.get(key, 0) + 1
	_key = key
	body.can_sleep = false
	body.sleeping = false
	_tie(grip)


## False when the body was taken out of the physics, or made one that nothing moves: disabled, frozen or freed.
func is_movable() -> bool:
	if not is_instance_valid(body) or body.is_queued_for_deletion():
		return false
	var state: PhysicsDirectBodyState3D = PhysicsServer3D.body_get_direct_state(body.get_rid())
	var mode: PhysicsServer3D.BodyMode = PhysicsServer3D.body_get_mode(body.get_rid())
	return state != null and mode >= PhysicsServer3D.BODY_MODE_RIGID


## Moves on by one physics frame: call once, before where() and follow().
func advance(delta_s: float) -> void:
	_age_s += delta_s
	detained = false
	if _time_runs != (delta_s > 0.0):
		_time_runs = delta_s > 0.0
		if _time_runs:
			_tie_body()
		else:
			_untie_body()


## Until the next advance() the body stays at `seat`, wherever the grip goes.
func detain(seat: Transform3D) -> void:
	detained = seat.is_finite()
	if detained:
		_seat = seat


## Where the body belongs when the grip is at `grip` and nothing is in the way.
func where(grip: Transform3D) -> Transform3D:
	return _centred(grip) * _caught


## Carries the anchor to the grip, moved by `shift` where the body met something that does not give way. While the game's time
## stands still the body is neither tied nor carried: GodotPhysics divides by the length of the step, and the body's place becomes
## NAN.
func follow(grip: Transform3D, shift: Vector3) -> void:
	if not _time_runs:
		return
	var target: Transform3D = _centred(grip)
	target.origin += shift
	if detained:
		target = _seat * _caught.affine_inverse()
	_anchor.global_transform = target


## Puts body and anchor where they belong when the grip is at `grip`, farther away than a physics step can carry them.
func jump(grip: Transform3D) -> void:
	_untie()
	body.global_transform = where(grip)
	body.linear_velocity = Vector3.ZERO
	_tie(_centred(grip))


## Where the pads are that hold the body: with it, also where the grip itself has gone on through what stopped it.
func carried_grip() -> Transform3D:
	return _anchor.global_transform.translated_local(Vector3(_off_centre_moved(), 0.0, 0.0))


## Scene metres between the body and where the anchor last held it: large when something tears at it.
func stretch_m() -> float:
	return body.global_position.distance_to((_anchor.global_transform * _caught).origin)


## Lets go; safe when the body is leaving the tree. workspace_scale: scene metres per device metre.
func detach(workspace_scale: float) -> void:
	_untie()
	_holds[_key] = _holds.get(_key, 1) - 1
	var was_last: bool = _holds[_key] <= 0
	if is_instance_valid(body) and was_last:
		body.can_sleep = _could_sleep[_key]
	if was_last:
		_holds.erase(_key)
		_could_sleep.erase(_key)
	if is_instance_valid(body):
		body.linear_velocity = body.linear_velocity.limit_length(MAX_RELEASE_SPEED_M_S * workspace_scale)
	body = null


func _tie(anchor_at: Transform3D) -> void:
	_anchor = AnimatableBody3D.new()
	_anchor.sync_to_physics = false
	_anchor.collision_layer = 0
	_anchor.collision_mask = 0
	# Placed before it enters: a kinematic body that enters elsewhere sweeps to its place, and the caught body with it.
	_anchor.transform = anchor_at
	add_child(_anchor)
	_tie_body()


func _tie_body() -> void:
	_joint = Generic6DOFJoint3D.new()  # Its limits are all locked at zero as made.
	add_child(_joint)
	_joint.global_transform = body.global_transform
	_joint.node_a = _joint.get_path_to(_anchor)
	_joint.node_b = _joint.get_path_to(body)


func _untie() -> void:
	_untie_body()
	if _anchor != null:
		_anchor.queue_free()
	_anchor = null


func _untie_body() -> void:
	if _joint != null:
		_joint.node_a = NodePath()
		_joint.node_b = NodePath()
		_joint.queue_free()
	_joint = null


func _centred(grip: Transform3D) -> Transform3D:
	return grip.translated_local(Vector3(-_off_centre_moved(), 0.0, 0.0))


func _off_centre_moved() -> float:
	return _off_centre_m * smoothstep(0.0, CENTRING_TIME_S, _age_s)
