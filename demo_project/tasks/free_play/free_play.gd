extends "res://tasks/base/linking_task.gd"
## Nothing to achieve: one sample of everything that can be felt. Hard and soft blocks, a heavy and a light box of
## the same size, a rough and a smooth floor, a ball on a spring, a socket that snaps, and six blocks of air, one for each
## kind of force that the device gives by itself. All of it is in things.tscn.

const FieldZone := preload("res://tasks/free_play/field_zone.gd")
const THINGS := preload("res://tasks/free_play/things.tscn")

const SPRING_N_M := 80.0
const SPRING_MOST_N := 4.0

var zones: Array[FieldZone] = []

var _ball: TaskBody
var _ball_home := Vector3.ZERO


func _ready() -> void:
	super()
	_hud.show_free(title)
	tool_hand.carrying.connect(_on_carrying)


func _physics_process(delta: float) -> void:
	super(delta)
	for zone in zones:
		zone.act(spidar, tool_hand.get_held_body() != null)


## The things are in the scene already, unless they were taken away to start again.
func _lay_out() -> void:
	var things := _items.get_node_or_null(^"Things")
	if things == null:
		things = THINGS.instantiate()
		_items.add_child(things)
	zones.assign(things.get_node(^"Zones").get_children())
	_ball = things.get_node(^"BallOnSpring")
	_ball_home = _ball.global_position
	_know_sockets([things.get_node(^"Peg"), things.get_node(^"Cap")])


## Held, the ball pulls back to where it was.
func _on_carrying(_delta: float) -> void:
	if tool_hand.get_held_body() != _ball:
		return
	var way := (_ball_home - tool_hand.get_wanted_pose().origin) / spidar.workspace_scale
	tool_hand.add_load((SPRING_N_M * way).limit_length(SPRING_MOST_N))
