extends RefCounted
## Lets one [SpidarG] feel one [SpidarGZone]: keeps the strength of the zone, and requests the effects that the servo loop
## renders.

## The duration of the effects, in seconds. The zone requests them anew in each physics tick.
const RENEWED_FOR_S: float = 0.1
## If a device has no free effect, the zone tries again after this many physics ticks.
const TICKS_TO_RETRY: int = 15
## The servo loop uses the gain of one physics tick until it has moved on to the gain of the next one. The zone therefore
## limits a gain by the distance or speed that the grip will have in this many ticks.
const TICKS_AHEAD: float = 2.0
## An axis counts as parallel to an axis of the device if the sine of the angle between them is below this value.
const PARALLEL: float = 1e-3
## The largest stiffness of a magnet with an oblique axis, in N/m. The game computes the force of half of this stiffness, and
## a spring that the game computes is stable up to 150 N/m.
const MOST_OBLIQUE_N_M: float = 300.0

## If [code]true[/code], the center of the grip is inside the zone.
var is_inside: bool = false
## The share of the zone's force that acts, from 0 to 1.
var strength: float = 0.0

var _spidar: SpidarG
var _id: int
var _wait: int = 0
var _told: bool = false
var _last_speed: float = 0.0
var _was_oblique: bool = false


func _init(spidar: SpidarG, id: int) -> void:
	_spidar = spidar
	_id = id


## Ends the effects of the zone on this device within 16 ms.
func stop() -> void:
	strength = 0.0
	is_inside = false
	if is_instance_valid(_spidar):
		_spidar.clear_effect(_id)


## Refreshes the effects of the zone. Returns [code]false[/code] in the first tick in which the device refuses an effect,
## usually because none is free. Returns [code]true[/code] in all other ticks, also while the refusal lasts.
func renew(zone: SpidarGZone, tick_s: float) -> bool:
	if _wait > 0:
		_wait -= 1
		return true
	if _ask(zone, tick_s):
		_told = false
		return true
	_wait = TICKS_TO_RETRY
	var is_news: bool = not _told
	_told = true
	return not is_news


func _ask(zone: SpidarGZone, tick_s: float) -> bool:
	var axes: Basis = zone.global_basis.orthonormalized()
	match zone.kind:
		SpidarGZone.Kind.VISCOSITY:
			return _thicken(zone)
		SpidarGZone.Kind.WIND:
			var force: Vector3 = axes * zone.wind_force.limit_length(zone.max_force)
			return _spidar.set_force_effect(_id, strength * force, Vector3.ZERO, 0.0, RENEWED_FOR_S)
		SpidarGZone.Kind.MAGNET_POINT:
			var from: Vector3 = _from(zone)
			var ahead: Vector3 = from + _velocity() * (TICKS_AHEAD * tick_s)
			var gain: float = _magnet_gain(zone, maxf(from.length(), ahead.length()))
			return _pull(zone, gain, SpidarG.DOF_LINEAR)
		SpidarGZone.Kind.MAGNET_AXIS:
			return _pull_to_axis(zone, tick_s)
		SpidarGZone.Kind.VIBRATION:
			var force: Vector3 = axes * zone.vibration_force.limit_length(zone.max_force)
			return _spidar.set_vibration_effect(
				_id, strength * force, Vector3.ZERO, 0.0, zone.vibration_frequency, RENEWED_FOR_S
			)
	var notch: float = strength * minf(zone.detent_force, zone.max_force)
	var centre := Transform3D(Basis.IDENTITY, zone.global_position)
	return _spidar.set_detent_effect(
		_id, centre, 0.0, zone.detent_spacing, notch, 1 << _nearest_axis(axes.x), RENEWED_FOR_S
	)


func _thicken(zone: SpidarGZone) -> bool:
	var gain: float = zone.viscosity
	var speed: float = _velocity().length()
	var ahead: float = speed + TICKS_AHEAD * maxf(0.0, speed - _last_speed)
	_last_speed = speed
	if gain * ahead > zone.max_force:
		gain = zone.max_force / ahead
	return _spidar.set_viscous_effect(
		_id, strength * gain, strength * zone.viscosity_angular, strength * zone.viscosity_grasp, SpidarG.DOF_ALL, RENEWED_FOR_S
	)


# Returns the vector from the zone's origin to the grip, in the axes of the device (m of device motion).
func _from(zone: SpidarGZone) -> Vector3:
	var to_device: Basis = _device_axes().inverse()
	return to_device * (_spidar.get_grip_transform().origin - zone.global_position) / _spidar.workspace_scale


# Returns the velocity of the grip in the axes of the device (m/s of device motion).
func _velocity() -> Vector3:
	return _device_axes().inverse() * _spidar.get_linear_velocity() / _spidar.workspace_scale


func _device_axes() -> Basis:
	return _spidar.global_basis.orthonormalized()


# Returns the stiffness of the magnet, lowered so that the pull at the distance `away_m` is at most the zone's max_force.
static func _magnet_gain(zone: SpidarGZone, away_m: float) -> float:
	return zone.max_force / away_m if zone.stiffness * away_m > zone.max_force else zone.stiffness


func _pull(zone: SpidarGZone, gain: float, dof_mask: int) -> bool:
	var centre := Transform3D(Basis.IDENTITY, zone.global_position)
	return _spidar.set_spring_effect(_id, centre, 0.0, strength * gain, 0.0, 0.0, dof_mask, RENEWED_FOR_S)


# A spring of the servo loop pulls along the axes of the device alone. For an oblique axis, a spring with half of the
# stiffness pulls in all directions. A force that the game computes in each tick cancels this pull along the magnet's axis
# and doubles it at right angles to the axis.
func _pull_to_axis(zone: SpidarGZone, tick_s: float) -> bool:
	var axis: Vector3 = (_device_axes().inverse() * zone.global_basis.y).normalized()
	var from: Vector3 = _from(zone)
	var later: Vector3 = from + _velocity() * (TICKS_AHEAD * tick_s)
	var gain: float = _magnet_gain(zone, maxf(axis.cross(from).length(), axis.cross(later).length()))
	var along: int = _nearest_axis(zone.global_basis.y)
	var is_oblique: bool = Vector2(axis[(along + 1) % 3], axis[(along + 2) % 3]).length() > PARALLEL
	if _was_oblique and not is_oblique:
		_spidar.clear_effect(_id)
	_was_oblique = is_oblique
	if not is_oblique:
		return _pull(zone, gain, SpidarG.DOF_LINEAR & ~(1 << along))
	gain = minf(gain, MOST_OBLIQUE_N_M)
	# The servo loop moves to a new force in the time of one tick, so the force is computed for the next tick.
	var ahead: Vector3 = from + _velocity() * tick_s
	var across: Vector3 = ahead - axis * axis.dot(ahead)
	var force: Vector3 = _device_axes() * (strength * gain * (0.5 * ahead - across))
	return _pull(zone, 0.5 * gain, SpidarG.DOF_LINEAR) and _spidar.set_force_effect(
		_id, force, Vector3.ZERO, 0.0, RENEWED_FOR_S
	)


# Returns the number of the device's axis that is nearest to a direction of the world.
func _nearest_axis(direction: Vector3) -> int:
	return (_device_axes().inverse() * direction).abs().max_axis_index()
