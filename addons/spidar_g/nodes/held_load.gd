extends RefCounted
## What a held body pulls on the hand: weight and inertia at its centre of mass, as force and moment at the grip's centre.
##
## Contact of the held body with the world is not here: it comes as contact planes, in the device thread.

## Acceleration is differenced at game rate; above this it is noise and delay.
const ACCELERATION_CUTOFF_HZ: float = 10.0
## A game-rate inertia force acts about 30 ms late, like a mass added with delay. Rendered masses above the hand's
## own would swing; 0.1 kg keeps a light hand's loop (0.16 kg with grip and rotors) at a gain margin above 2.
const MAX_INERTIA_MASS_KG: float = 0.1
## Part of the device's greatest force that inertia may use, so that weight is never masked by a jerk.
const INERTIA_FORCE_SHARE: float = 0.3
## Weight comes on over this time: a step would be felt as a knock.
const ONSET_TIME_S: float = 0.1

var force_n: Vector3 = Vector3.ZERO
var moment_nm: Vector3 = Vector3.ZERO
var _velocity: Vector3 = Vector3.ZERO
var _acceleration: Vector3 = Vector3.ZERO
var _age_s: float = 0.0


func reset(velocity_m_s: Vector3) -> void:
	_velocity = velocity_m_s
	_acceleration = Vector3.ZERO
	_age_s = 0.0
	force_n = Vector3.ZERO
	moment_nm = Vector3.ZERO


## velocity_m_s: of the grip, device metres per second on world axes. arm_m: from the grip's centre to the
## body's centre of mass, device metres. gravity: scene m/s^2. scale: multiplies weight and inertia alike.
func advance(
	delta_s: float,
	mass_kg: float,
	gravity: Vector3,
	velocity_m_s: Vector3,
	arm_m: Vector3,
	max_force_n: float,
	scale: float,
	with_weight: bool,
	with_inertia: bool
) -> void:
	var blend: float = delta_s / (delta_s + 1.0 / (TAU * ACCELERATION_CUTOFF_HZ))
	_acceleration += blend * ((velocity_m_s - _velocity) / delta_s - _acceleration)
	_velocity = velocity_m_s
	_age_s += delta_s
	force_n = Vector3.ZERO
	if with_weight:
		force_n += scale * mass_kg * gravity
	if with_inertia:
		var mass: float = minf(scale * mass_kg, MAX_INERTIA_MASS_KG)
		force_n -= (mass * _acceleration).limit_length(INERTIA_FORCE_SHARE * max_force_n)
	force_n *= clampf(_age_s / ONSET_TIME_S, 0.0, 1.0)
	moment_nm = arm_m.cross(force_n)
