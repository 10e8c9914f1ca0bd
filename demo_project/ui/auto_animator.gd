extends Node
## What the paper gave its mouse users: a click on a thing moves the grip there and picks it up, a click on a target
## carries it to its own. The hand does it as the script does; only who chooses is different.

const MouseHand := preload("res://ui/mouse_hand.gd")
const ScriptedHand := preload("res://play/scripted_hand.gd")
const TaskBody := preload("res://scene/task_body.gd")
const TaskPlayer := preload("res://play/task_player.gd")

## A click counts for what is drawn within this of it.
const NEAR_PX := 60.0

var enabled := false
var busy := false

var _mouse: MouseHand
var _hand: ScriptedHand
var _player: TaskPlayer
var _held: TaskBody


func setup(mouse: MouseHand, hand: ScriptedHand, player: TaskPlayer, enabled_: bool) -> void:
	_mouse = mouse
	_hand = hand
	_player = player
	enabled = enabled_
	_mouse.clicks_only = enabled


## The trial starts again: whatever was going on ends.
func stop() -> void:
	_hand.stopped = busy
	_held = null


func _unhandled_input(event: InputEvent) -> void:
	var button := event as InputEventMouseButton
	if not enabled or busy or button == null or not button.is_action_pressed(&"demo_grasp"):
		return
	if _held != null and _player.tool_hand.get_held_body() == _held:
		if _on_screen(_player.target_of(_held, button.position, get_viewport().get_camera_3d())).distance_to(button.position) < NEAR_PX:
			_animate(_held)
		return
	var body := _nearest(button.position)
	if body != null:
		_animate(body)


func _nearest(at: Vector2) -> TaskBody:
	var best: TaskBody = null
	for body in _player.bodies:
		var far := _on_screen(body.global_position).distance_to(at)
		if far < NEAR_PX and (best == null or far < _on_screen(best.global_position).distance_to(at)):
			best = body
	return best


func _on_screen(point: Vector3) -> Vector2:
	return get_viewport().get_camera_3d().unproject_position(point)


func _animate(body: TaskBody) -> void:
	busy = true
	_mouse.process_mode = Node.PROCESS_MODE_DISABLED
	_hand.process_mode = Node.PROCESS_MODE_INHERIT
	_hand.stopped = false
	_hand.start(_player.spidar)
	_hand.grasp_angle_rad = _mouse.grasp_angle_rad
	if _held == body and _player.tool_hand.get_held_body() == body:
		await _player.bring(body)
		_held = null
	elif await _player.take(body):
		_held = body
	_mouse.follow(_hand.wanted, _hand.grasp_angle_rad, _held != null)
	_mouse.process_mode = Node.PROCESS_MODE_INHERIT
	_hand.stopped = false
	busy = false
