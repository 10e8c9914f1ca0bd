extends RefCounted
## What a held body pulls on the hand: weight and inertia at its centre of mass, as force and moment at the grip's centre.
##
## Contact of the held body with the world is not here: it comes as contact planes, in the device thread.

## Acceleration is differenced at game rate; above this it is noise and delay.
const ACCELERATION_CUTOFF_HZ: float = 10.0
## A game-rate inertia force acts about 30 ms late, like a mass added with delay: it swings when it nears the hand's own
## mass. A light hand with grip and rotors has 0.16 kg (gain margin above 4); at 0.1 kg a normal hand that squeezes hard in
## a far corner, where a string nears its limit, swung into the speed limit in simulation.
const MAX_INERTIA_MASS_KG: float = 0.05
## Part of the device's greatest force that inertia may use, so that weight is never masked by a jerk.
const INERTIA_FORCE_SHARE: float = 0.3
## Weight comes on over this time: a step would be felt as a knock.
const ONSET_TIME_S: float = 0.1

## Multiplies weight and inertia alike.
var gain: float = 1.0
## The device's own limit.
var max_force_n: float = 8.0
var with_weight: bool = true
var with_inertia: bool = true

var force_n: Vector3 = Vector3.ZERO
var moment_nm: Vector3 = Vector3.ZERO
## Mean velocity of the grip between the last two poses, relative to the device and in its axes, scene m/s.
var velocity: Vector3 = Vector3.ZERO
var _added_n: Vector3 = Vector3.ZERO
var _added_nm: Vector3 = Vector3.ZERO
var _centre: Vector3 = Vector3.INF
var _acceleration: Vector3 = Vector3.ZERO
var _since_s: float = 0.0
var _age_s: float = 0.0


## A body has just been caught.
func reset() -> void:
	_acceleration = Vector3.ZERO
	_age_s = 0.0
	force_n = Vector3.ZERO
	moment_nm = Vector3.ZERO


## A new frame: nothing else pulls yet.
func clear() -> void:
	_added_n = Vector3.ZERO
	_added_nm = Vector3.ZERO


## What else pulls in this frame, about the grip's centre; left out when it is not finite.
func add(added_n: Vector3, added_nm: Vector3) -> void:
	if added_n.is_finite() and added_nm.is_finite():
		_added_n += added_n
		_added_nm += added_nm


## Takes each new pose, whether a body is held or not. centre: the grip's centre, from the device's origin and in the device's
## axes, scene metres; so a device that is carried through the scene does not accelerate the hand. since_s: device time since the
## pose before; 0 is ignored.
func follow(centre: Vector3, since_s: float) -> void:
	if since_s <= 0.0:
		return
	if not _centre.is_finite():
		_centre = centre
	# The mean velocity: the device's own twist, sampled at game rate, would alias the strings' 100 Hz.
	var newest: Vector3 = (centre - _centre) / since_s
	# Each mean velocity belongs to the middle of its interval.
	var apart_s: float = 0.5 * (since_s + _since_s) if _since_s > 0.0 else since_s
	var blend: float = since_s / (since_s + 1.0 / (TAU * ACCELERATION_CUTOFF_HZ))
	_acceleration += blend * ((newest - velocity) / apart_s - _acceleration)
	velocity = newest
	_centre = centre
	_since_s = since_s
	_age_s += since_s


## Computes force and moment of a body that belongs at `place` when the grip's centre is at grip_centre. device: the device's axes
## in the scene. workspace_scale: scene metres per device metre.
func pull(
	body: RigidBody3D, place: Transform3D, grip_centre: Vector3, device: Basis, workspace_scale: float
) -> void:
	var state: PhysicsDirectBodyState3D = PhysicsServer3D.body_get_direct_state(body.get_rid())
	force_n = Vector3.ZERO
	if with_weight:
		force_n += gain * body.mass * state.total_gravity
	if with_inertia:
		# Of the hand's own motion, so that a large scale does not turn a small jerk into a large force.
		var mass: float = minf(gain * body.mass, MAX_INERTIA_MASS_KG)
		var inertia: Vector3 = mass * (device * _acceleration) / workspace_scale
		force_n -= inertia.limit_length(INERTIA_FORCE_SHARE * max_force_n)
	force_n *= clampf(_age_s / ONSET_TIME_S, 0.0, 1.0)
	var centre: Vector3 = place * state.center_of_mass_local
	moment_nm = ((centre - grip_centre) / workspace_scale).cross(force_n) + _added_nm
	force_n = (force_n + _added_n).limit_length(max_force_n)
