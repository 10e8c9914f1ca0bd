extends RefCounted
## Decides when the world takes a held body away: when it has pressed on the body, or torn it from the grip, for long enough.

const ContactPlane := preload("contact_plane.gd")
const ContactSet := preload("contact_set.gd")
const HoldJoint := preload("hold_joint.gd")

## A held body torn this far from the grip (device metres) is stuck behind something.
const MAX_STRETCH_M: float = 0.015
## How long it takes to break a hold, s: a load by the device's time, a stretch by the number of physics ticks.
const BREAK_TIME_S: float = 0.05

var _overload_s: float = 0.0
var _torn_s: float = 0.0


## A body has just been caught.
func reset() -> void:
	_overload_s = 0.0
	_torn_s = 0.0


## Call it once a physics tick. since_s: the device time in which the planes gained their impulses; 0 when nothing new is known
## of them.
func breaks(
	hold: HoldJoint, contacts: ContactSet, break_force_n: float, workspace_scale: float, since_s: float
) -> bool:
	if since_s > 0.0:
		var impulse: Vector3 = Vector3.ZERO
		for plane: ContactPlane in contacts.planes:
			if plane.through_held_body:
				impulse += contacts.gained(plane.id)
		var overloaded: bool = impulse.length() > break_force_n * since_s
		_overload_s = _overload_s + since_s if overloaded else 0.0
	var torn: bool = hold.stretch_m() > MAX_STRETCH_M * workspace_scale
	_torn_s = _torn_s + 1.0 / Engine.physics_ticks_per_second if torn else 0.0
	return maxf(_overload_s, _torn_s) >= BREAK_TIME_S
