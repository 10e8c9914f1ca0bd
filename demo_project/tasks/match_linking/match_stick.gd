extends "res://scene/task_body.gd"
## A match: a thin stick along z with a ball at each end that links with other ends and with the pegs.

const DemoPalette := preload("res://scene/demo_palette.gd")
const LinkSocket := preload("res://scene/link_socket.gd")
const MatchShape := preload("res://tasks/match_linking/match_shape.gd")
const MatchStick := preload("res://tasks/match_linking/match_stick.gd")

const THICK_M := 0.003
## Between the middles of the balls.
const LENGTH_M := 0.056
## The wood stops short of the balls, so that sticks that meet do not push each other.
const INSET_M := 0.005
const BALL_M := 0.0026
const MASS_KG := 0.008

## The edge of the shape that a player has chosen for it; judged against any edge.
var shape: MatchShape
var edge := -1


static func make(number: int) -> MatchStick:
	var stick := MatchStick.new()
	stick.label = "match_%d" % number
	stick.kind = "match"
	stick.name = "Match%d" % number
	stick.mass = MASS_KG
	stick.width_m = THICK_M
	stick.felt.checks_weight = false # 0.08 N is at the strings' own friction.
	stick.felt.checks_detent = true
	stick.felt.detent_tolerance = FeltRecord.DETENT_TOLERANCE_THIN
	var box := BoxShape3D.new()
	box.size = Vector3(THICK_M, THICK_M, LENGTH_M - 2.0 * INSET_M)
	var mesh := BoxMesh.new()
	mesh.size = box.size
	stick.add_piece(box, mesh, Transform3D.IDENTITY, DemoPalette.BONE)
	var ball := SphereMesh.new()
	ball.radius = BALL_M
	ball.height = 2.0 * BALL_M
	for end: float in [-1.0, 1.0]:
		var at := Transform3D(Basis(), Vector3(0.0, 0.0, 0.5 * end * LENGTH_M))
		stick.add_piece(null, ball, at, DemoPalette.CORAL)
		var socket := LinkSocket.make(&"end", true, at)
		socket.meets_many = true
		socket.turns_freely = true
		stick.add_child(socket)
	return stick


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
