extends RefCounted
## How far the pads, as they were last drawn, stand inside any body: measured with the pads' own shape.

const PadShape := preload("res://addons/spidar_g/nodes/pad_shape.gd")
const ShownPads := preload("res://addons/spidar_g/nodes/shown_pads.gd")

## The deepest so far.
var worst_m := 0.0
var _pad := PadShape.new()
var _finder := ShownPads.new()


## Once a physics tick, before anything moves: what was drawn last stands beside the bodies as they were drawn.
func measure(spidar: SpidarG, view: SpidarGView) -> void:
	var space := view.get_world_3d().direct_space_state
	var shape := _pad.shape_for(spidar.workspace_scale)
	for side in 2:
		for plane in _finder.overlaps(space, shape, view.get_drawn_pad(side)):
			worst_m = maxf(worst_m, -plane.separation_m)
