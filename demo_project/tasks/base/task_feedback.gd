extends Node
## What a person sees and hears of a task: time and count on the display, held things as glass, a knock for what happens.

const ContactSound := preload("res://scene/contact_sound.gd")
const Hud := preload("res://ui/hud.gd")
const TaskBody := preload("res://scene/task_body.gd")
const Trial := preload("res://study/trial.gd")

var _trial: Trial
var _hud: Hud

@onready var sound: ContactSound = $Sound


func setup(trial: Trial, hud: Hud) -> void:
	process_physics_priority = trial.process_physics_priority + 1 # shows what this tick has judged
	_trial = trial
	_hud = hud
	_trial.tool_hand.body_grasped.connect(_on_grasped)
	_trial.tool_hand.body_released.connect(_on_released)
	_trial.struck.connect(sound.say.bind(&"struck"))
	if _trial.arguments.scripted() and DisplayServer.get_name() == "headless" and not _trial.arguments.display:
		_hud.mode = Hud.Mode.OFF # Nobody is there to read it.


func _physics_process(_delta: float) -> void:
	if _trial.timed:
		_hud.show_task(
			_trial.title, _trial.logger.task_time_s, _trial.placed_count, _trial.bodies,
			_trial.arguments.level, _trial.arguments.seed_number
		)


func _on_grasped(body: RigidBody3D) -> void:
	sound.say(&"grasped")
	if body is TaskBody:
		(body as TaskBody).show_held(true)


func _on_released(body: RigidBody3D) -> void:
	sound.say(&"released")
	if body is TaskBody:
		(body as TaskBody).show_held(false)
