@tool
extends Node3D
## Where a part of the robot belongs: a faint copy that goes when the part is there.

const DemoPalette := preload("res://scene/demo_palette.gd")
const PartGhost := preload("res://tasks/robot_linking/part_ghost.gd")
const RobotPart := preload("res://tasks/robot_linking/robot_part.gd")

const ALPHA := 0.14


static func make(part: RobotPart) -> PartGhost:
	var ghost := PartGhost.new()
	ghost.transform = part.robot.transform * part.place()
	for child in part.get_children():
		var piece := child as MeshInstance3D
		if piece == null:
			continue
		var copy := MeshInstance3D.new()
		copy.mesh = piece.mesh
		copy.transform = piece.transform
		copy.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
		var colour: Color = (piece.material_override as StandardMaterial3D).albedo_color
		copy.material_override = DemoPalette.flat(Color(colour, ALPHA))
		ghost.add_child(copy)
	part.ghost = ghost
	return ghost
