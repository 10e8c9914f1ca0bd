@tool
extends "res://scene/task_body.gd"
## A match: a thin stick along z with a ball at each end that links with other ends and with the pegs. The wood stops short of
## the balls, so that sticks that meet do not push each other.

const MatchShape := preload("res://tasks/match_linking/match_shape.gd")

## Of the wood, and between the middles of the balls; as in the scene.
const THICK_M := 0.003
const LENGTH_M := 0.056

## The edge of the shape that a player has chosen for it; judged against any edge.
var shape: MatchShape
var edge := -1


func _init() -> void:
	felt.checks_weight = false # 0.08 N is at the strings' own friction.
	felt.checks_detent = true
	felt.detent_tolerance = FeltRecord.DETENT_TOLERANCE_THIN


func _width_m() -> float:
	return THICK_M


## World position of end 0 (at -z) or 1.
func end_position(end: int) -> Vector3:
	return to_global(Vector3(0.0, 0.0, (end - 0.5) * LENGTH_M))


func goal() -> Transform3D:
	return start if edge < 0 else shape.edge_pose(edge)


func position_error_m() -> float:
	return INF if edge < 0 else shape.end_error_m(self, edge)


## A match looks the same from both ends and at any turn about its length: only its line counts.
func rotation_error_rad() -> float:
	var between := global_basis.z.normalized().angle_to(goal().basis.z.normalized())
	return minf(between, PI - between)
