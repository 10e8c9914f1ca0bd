extends Node3D
## A scene in which one trial runs, as the study sees it: what is to be done, by whose arguments and settings, its clock, its
## judgement, its log and its end. A scene without a clock (the menu, free play) is one that never ends.

const DemoSettings := preload("res://ui/demo_settings.gd")
const FrameCost := preload("res://study/frame_cost.gd")
const PlayArguments := preload("res://play/play_arguments.gd")
const TaskBody := preload("res://scene/task_body.gd")
const TrialLogger := preload("res://study/trial_logger.gd")
const TrialResults := preload("res://study/trial_results.gd")

## The person goes back to the menu.
signal left
## In an experiment: the trial is over, as a whole when reason is empty.
signal ended(reason: String)
## Two of the things have struck each other.
signal struck

const DROP_HEIGHT_M := 0.015
## Everything must stay placed for this long.
const DWELL_S := 0.5

## In results and arguments: pick_and_place.
@export var task_name := ""
## On the display: Pick and place.
@export var title := ""
## What there is to do, as the help and the experiment say it.
@export_multiline var goal := ""
## Whether there is a clock and an end.
@export var timed := true

var arguments := PlayArguments.new()
var settings := DemoSettings.new()
## Results then go to the experiment, not to files of the trial.
var in_experiment := false
var forces_at_start := false
## Only so many things have to be placed; 0: all. For simulated participants.
var most_bodies := 0
var logger := TrialLogger.new()
var frame_cost := FrameCost.new()
## The things that have to be placed.
var bodies: Array[TaskBody] = []
var placed_count := 0

var _running := false
var _finished := false
var _placed_for_s := 0.0
var _attempt_open := false

@onready var spidar: SpidarG = $SpidarG
@onready var tool_hand: SpidarGHand = $SpidarG/SpidarGHand


func is_finished() -> bool:
	return _finished


func is_running() -> bool:
	return _running


## How deep a pad, as drawn, has stood inside a body; measured in a scripted play.
func max_penetration_m() -> float:
	return 0.0


func _physics_process(delta: float) -> void:
	if not timed:
		return
	placed_count = _judge(tool_hand.get_held_body())
	if _running:
		logger.sample(spidar, delta)
		frame_cost.sample()
		_placed_for_s = _placed_for_s + delta if placed_count == bodies.size() else 0.0
		_check_end()
	elif spidar.get_state() == SpidarG.STATE_ACTIVE:
		start_clock()


## Counts what the hand does. Call once, when the scene is ready.
func _watch_hand() -> void:
	spidar.grasped.connect(_note_closed)
	spidar.released.connect(func() -> void: _attempt_open = false)
	tool_hand.body_grasped.connect(_on_body_grasped)
	tool_hand.body_released.connect(_on_body_released)


## Counts blows between the bodies. Call after each layout.
func _watch_bodies() -> void:
	for body in bodies:
		body.struck.connect(_on_struck.bind(body))


## Starts when the device is armed; at the first grasp for a person who plays without forces.
func start_clock() -> void:
	if not _running and not _finished:
		_running = true
		logger.start(spidar)


func stop_clock() -> void:
	_running = false
	_finished = true


## How many things are where they belong, now.
func _judge(held: RigidBody3D) -> int:
	var count := 0
	for body in bodies:
		body.placed = body.is_placed(held)
		body.show_placed(body.placed)
		count += int(body.placed)
	return count


## A person's trial ends by itself; a script says when it has ended.
func _check_end() -> void:
	if _placed_for_s >= DWELL_S and not arguments.scripted():
		finish("")


## Makes ready for the same trial from its beginning.
func _reset_trial() -> void:
	bodies.clear()
	logger = TrialLogger.new()
	placed_count = 0
	_running = false
	_finished = false
	_placed_for_s = 0.0


## Ends the trial and keeps its results. Returns the sentence that tells a person where they are, if there is one.
func finish(reason: String) -> String:
	stop_clock()
	if in_experiment:
		ended.emit(reason)
		return ""
	var results := TrialResults.new(self)
	if arguments.scripted():
		get_tree().quit(results.save_scripted(reason))
		return ""
	return results.save_interactive()


func _note_closed() -> void:
	if not _attempt_open:
		_attempt_open = true
		logger.grasp_attempts += 1


func _on_body_grasped(_body: RigidBody3D) -> void:
	start_clock()
	_note_closed()
	logger.note_grasp()


func _on_body_released(released: RigidBody3D) -> void:
	_attempt_open = false
	if released is TaskBody:
		_note_release(released as TaskBody)


## Counts a drop, or a thing put where another one belongs.
func _note_release(body: TaskBody) -> void:
	var above := body.global_position.y - body.goal().origin.y
	if above > DROP_HEIGHT_M:
		logger.drops += 1
		return
	for other in bodies:
		var place := other.goal().origin
		if other != body and place.distance_to(body.global_position) < DROP_HEIGHT_M:
			logger.wrong_placements += 1


func _on_struck(other: TaskBody, body: TaskBody) -> void:
	# Both report the same blow; count it once.
	if body.get_index() < other.get_index():
		logger.collisions += 1
		struck.emit()
