class_name PenetrationMeter
extends RefCounted
## How far the pads, as they are shown, stand inside any body: measured with the pads' own shape.

const PadShape := preload("res://addons/spidar_g/nodes/pad_shape.gd")
## Pairs of points per pad that the query may give.
const MAX_PAIRS := 8

## The deepest so far.
var worst_m := 0.0
var _pad := PadShape.new()
var _query := PhysicsShapeQueryParameters3D.new()


## Once a physics tick.
func measure(spidar: SpidarG, tool_hand: SpidarGHand) -> void:
	var space := tool_hand.get_world_3d().direct_space_state
	var grip := spidar.get_grip_transform()
	_query.shape = _pad.shape_for(spidar.workspace_scale)
	for side in 2:
		_query.transform = _pad.transform_of(side, grip, 0.0)
		_query.transform.origin = tool_hand.get_pad_position(side)
		var pairs := space.collide_shape(_query, MAX_PAIRS)
		for index in range(0, pairs.size() - 1, 2):
			worst_m = maxf(worst_m, pairs[index].distance_to(pairs[index + 1]))
