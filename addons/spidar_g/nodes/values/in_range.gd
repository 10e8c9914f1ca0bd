@tool
extends RefCounted
## What a property takes as a number: else an error that names node, field, value, unit and remedy, and the old value.


## Returns `value`, or `old` when it is outside of `least` to `most`. `who` begins the error.
static func checked(
	who: String, field: StringName, value: float, old: float, unit: String, least: float, most: float
) -> float:
	if value >= least and value <= most: # false for NAN
		return value
	push_error("%s: %s = %s %s: give %s to %s; the old value stays." % [who, field, value, unit, least, most])
	return old
