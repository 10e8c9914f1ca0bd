@tool
extends Node3D
## The rack of the matches: two rails across, the matches on them side by side.

const Block := preload("res://scene/block.gd")

## The way from one match to the next.
const PITCH_M := 0.042

@export var places := 4:
	set(value):
		places = value
		for rail: Block in [get_node_or_null(^"BackRail"), get_node_or_null(^"FrontRail")]:
			if rail != null:
				rail.size_m.x = places * PITCH_M


## Of a place from the middle of the rack.
func place_x_m(number: int) -> float:
	return (number - 0.5 * (places - 1)) * PITCH_M
