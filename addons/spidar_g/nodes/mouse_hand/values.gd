extends RefCounted
## Checks the values that the properties of SpidarGMouseHand are set to. A refused value is reported as an error that names
## the field, the value, the unit and the remedy.


## Returns `value` if it is finite. Otherwise pushes an error and returns `old`.
static func finite(field: StringName, value: Vector3, old: Vector3, unit: String) -> Vector3:
	if value.is_finite():
		return value
	push_error("SpidarGMouseHand: %s = %s %s is not finite: give finite numbers; %s %s stays." % [
		field, value, unit, old, unit])
	return old


## Returns `value` if it is within `limits`. Otherwise pushes an error and returns `old`.
static func in_range(field: StringName, value: float, old: float, limits: Vector2, unit: String) -> float:
	# Written so that NAN is refused. A Vector2 rounds its numbers: what differs by that is taken.
	if value >= limits.x - 1e-6 and value <= limits.y + 1e-6:
		return value
	push_error("SpidarGMouseHand: %s = %s %s is out of range: give %s to %s %s; %s %s stays." % [
		field, value, unit, limits.x, limits.y, unit, old, unit])
	return old
