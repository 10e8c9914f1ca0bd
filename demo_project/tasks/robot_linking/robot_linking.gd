extends "res://tasks/base/linking_task.gd"
## The task: build a robot by linking head, arms, legs and torso, in any order.
## Kim, Koike and Sato's experiment 3 ("SPIDAR-G", section 7.2).

const RobotLayout := preload("res://tasks/robot_linking/robot_layout.gd")
const RobotPlayer := preload("res://tasks/robot_linking/robot_player.gd")

## By level: how near a part has to come before it snaps in.
const LATCH_M: PackedFloat64Array = [0.003, 0.003, 0.002]
const LATCH_RAD: PackedFloat64Array = [deg_to_rad(5.0), deg_to_rad(5.0), deg_to_rad(3.0)]


func _make_player() -> TaskPlayer:
	var robot_player := RobotPlayer.new()
	robot_player.seats.sockets = sockets
	return robot_player


func _lay_out() -> void:
	_use_layout(RobotLayout.new())
	for socket in sockets:
		socket.latch_distance = LATCH_M[arguments.level - 1]
		socket.latch_angle = LATCH_RAD[arguments.level - 1]
