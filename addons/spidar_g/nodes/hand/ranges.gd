extends RefCounted
## What the numbers of a SpidarGHand may be. The inspector offers less; a script may go so far.

## Least, most, unit.
const RANGES: Dictionary[StringName, Array] = {
	&"contact_margin_m": [0.001, 1.0, "m"],
	&"contact_stiffness_n_m": [0.0, 1.0e4, "N/m"],
	&"contact_damping_n_s_m": [0.0, 100.0, "N s/m"],
	&"contact_friction": [0.0, 10.0, ""],
	&"pad_friction": [0.0, 10.0, ""],
	&"hold_torque_nm": [0.0, 10.0, "N m"],
	&"break_force_n": [0.0, 1000.0, "N"],
	&"weight_scale": [0.0, 100.0, ""],
}


## `value`, or `old` with an error for one that makes no sense.
static func checked(property: StringName, value: float, old: float) -> float:
	var least: float = RANGES[property][0]
	var most: float = RANGES[property][1]
	if value >= least and value <= most:
		return value
	push_error(
		"SpidarGHand.%s = %s %s: give %s to %s; the old value stays."
		% [property, value, RANGES[property][2], least, most]
	)
	return old
