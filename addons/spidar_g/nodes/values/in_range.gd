@tool
extends RefCounted
## Checks a number that a property is set to. For a number out of range it pushes an error that names the node, the property,
## the value, the unit and the remedy.


## Returns `value` if it lies from `least` to `most`. Otherwise pushes an error that begins with `who`, and returns `old`.
static func checked(
	who: String, field: StringName, value: float, old: float, unit: String, least: float, most: float
) -> float:
	if value >= least and value <= most: # false for NAN
		return value
	push_error("%s: %s = %s %s: give %s to %s; the old value stays." % [who, field, value, unit, least, most])
	return old
