extends "res://tasks/base/linking_task.gd"
## The task: link matches end to end into the shape shown.
## Kim, Koike and Sato's experiment 4 ("SPIDAR-G", section 7.2).

const MatchLayout := preload("res://tasks/match_linking/match_layout.gd")
const MatchPlayer := preload("res://tasks/match_linking/match_player.gd")
const MatchShape := preload("res://tasks/match_linking/match_shape.gd")
const MatchStick := preload("res://tasks/match_linking/match_stick.gd")

var shape: MatchShape


func _make_player() -> TaskPlayer:
	var match_player := MatchPlayer.new()
	match_player.seats.sockets = sockets
	return match_player


func _lay_out() -> void:
	var layout := MatchLayout.new()
	_use_layout(layout)
	shape = layout.shape
	if arguments.scripted():
		layout.choose_edges()


## Any match may lie on any edge, but only one on each.
func _judge(held: RigidBody3D) -> int:
	var free: Array[int] = []
	free.assign(range(shape.edges.size()))
	var count := 0
	for body in bodies:
		var stick := body as MatchStick
		stick.placed = false
		var edge := _nearest_edge(stick, free)
		if not arguments.scripted() and stick != held:
			stick.edge = edge
		if edge != stick.edge:
			continue
		if stick.is_placed(held):
			stick.placed = true
			free.erase(edge)
			count += 1
	for edge in shape.edges.size():
		shape.show_taken(edge, not free.has(edge))
	return count


func _nearest_edge(stick: MatchStick, free: Array[int]) -> int:
	var best := -1
	for edge in free:
		if best < 0 or shape.end_error_m(stick, edge) < shape.end_error_m(stick, best):
			best = edge
	return best
