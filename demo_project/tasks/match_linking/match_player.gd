extends "res://play/link_player.gd"
## Links the matches by script: each on its edge, both ends.

const MatchStick := preload("res://tasks/match_linking/match_stick.gd")

func _init() -> void:
	let_go_m = 0.006
	# A match is light and thin: a squeeze that leaves the fingers inside the grasp range.
	hold_squeeze_nm = 0.014


## Any edge will do that no other match lies on: the one nearest to the click.
func target_of(body: TaskBody, at: Vector2, camera: Camera3D) -> Vector3:
	var stick := body as MatchStick
	var best := INF
	for edge in stick.shape.edges.size():
		if bodies.any(func(other: MatchStick) -> bool: return other != stick and other.placed and other.edge == edge):
			continue
		var far := camera.unproject_position(stick.shape.edge_pose(edge).origin).distance_to(at)
		if far < best:
			best = far
			stick.edge = edge
	return body.goal().origin
