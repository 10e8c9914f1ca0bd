extends Node3D
## What every task shares: the device, the table, clock and log, a person's or a script's hand, restart and
## results. A task lays out its things (_lay_out) and fills `bodies`; each body knows where it belongs.

const AutoAnimator := preload("res://ui/auto_animator.gd")
const CarryPlayer := preload("res://play/carry_player.gd")
const ContactSound := preload("res://scene/contact_sound.gd")
const DemoControls := preload("res://ui/demo_controls.gd")
const DemoSettings := preload("res://ui/demo_settings.gd")
const FrameCost := preload("res://study/frame_cost.gd")
const Hud := preload("res://ui/hud.gd")
const MouseHand := preload("res://ui/mouse_hand.gd")
const PictureQuality := preload("res://scene/picture_quality.gd")
const PictureTaker := preload("res://play/picture_taker.gd")
const PlayArguments := preload("res://play/play_arguments.gd")
const ScriptedHand := preload("res://play/scripted_hand.gd")
const TaskBody := preload("res://scene/task_body.gd")
const TaskPlayer := preload("res://play/task_player.gd")
const TrialLogger := preload("res://study/trial_logger.gd")
const TrialResults := preload("res://study/trial_results.gd")

## Esc: back to the menu.
signal left
## In an experiment: the trial is over, as a whole when reason is empty.
signal ended(reason: String)

## A scripted play that takes longer than this has gone wrong.
const TIME_LIMIT_S := 240.0
## And for each carry that was asked for.
const CARRY_LIMIT_S := 15.0
## The device needs its arming time before it can be felt; this is more than enough.
const READY_LIMIT_S := 5.0
const DROP_HEIGHT_M := 0.015
const HOME_ABOVE_TABLE_M := 0.12
## Everything must stay placed for this long.
const DWELL_S := 0.5
## What there is to do, by task_name(): told by the help and by an experiment.
const GOALS: Dictionary[String, String] = {
	"pick_and_place": "Put each thing on the outline of its own shape and colour.",
	"robot_linking": "Build the robot: each part snaps in where its ghost is.",
	"match_linking": "Link the matches into the shape shown.",
	"free_play": "Touch, hold and lift what is there.",
	"": "Touch a block and close on it, or choose in the menu.",
}

var arguments := PlayArguments.new()
var settings := DemoSettings.new()
## Results then go to the experiment, not to files of the trial.
var in_experiment := false
var forces_at_start := false
## Only so many things have to be placed; 0: all. For simulated participants.
var most_bodies := 0
var logger := TrialLogger.new()
var bodies: Array[TaskBody] = []
var player: TaskPlayer
var frame_cost := FrameCost.new()
var sound := ContactSound.new()

var _running := false
var _finished := false
var _placed_for_s := 0.0
var _attempt_open := false

@onready var _spidar: SpidarG = $SpidarG
@onready var _tool_hand: SpidarGHand = $SpidarG/SpidarGHand
@onready var _items: Node3D = $Items
@onready var _scripted_hand: ScriptedHand = $ScriptedHand
@onready var _mouse_hand: MouseHand = $MouseHand
@onready var _animator: AutoAnimator = $AutoAnimator
@onready var _pictures: PictureTaker = $PictureTaker
@onready var _hud: Hud = $Hud
@onready var _controls: DemoControls = $Controls


func task_name() -> String:
	return ""


func title() -> String:
	return ""


## Whether there is a clock and an end; the menu and free play have neither.
func is_trial() -> bool:
	return true


## Whether a recording can stand in for the hand; the menu has to be worked.
func may_replay() -> bool:
	return true


func is_finished() -> bool:
	return _finished


func is_running() -> bool:
	return _running


## Builds the things of arguments.level from arguments.seed_number under _items, and fills `bodies`.
func _lay_out() -> void:
	pass


## The hand that plays this task by script.
func _make_player() -> TaskPlayer:
	return TaskPlayer.new()


func _make_carry_player() -> TaskPlayer:
	var carry_player := CarryPlayer.new()
	carry_player.carries = arguments.carries
	carry_player.seed_number = arguments.seed_number
	return carry_player


func _time_limit_s() -> float:
	return TIME_LIMIT_S + CARRY_LIMIT_S * arguments.carries


func _enter_tree() -> void:
	# Before the device opens: a scripted play steps simulated time, so that equal seeds play equally.
	var spidar: SpidarG = $SpidarG
	if arguments.scripted():
		spidar.drive_mode = SpidarG.DRIVE_STEPPED
		spidar.config.transport = SpidarGConfig.TRANSPORT_SIMULATED # A script never moves a real hand.
	else:
		settings.apply(spidar)


func _ready() -> void:
	process_physics_priority = 10 # after the device and the tool have stepped
	_tool_hand.body_grasped.connect(_on_body_grasped)
	_tool_hand.body_released.connect(_on_body_released)
	_spidar.grasped.connect(_on_closed)
	_spidar.released.connect(func() -> void: _attempt_open = false)
	if arguments.scripted() and DisplayServer.get_name() == "headless" and not arguments.display:
		_hud.mode = Hud.Mode.OFF # Nobody is there to read it.
	_hud.setup(_spidar, _tool_hand, GOALS.get(task_name(), ""))
	_controls.setup(_spidar, _hud, _mouse_hand, settings, task_name())
	_controls.restart_wanted.connect(_restart)
	_controls.leave_wanted.connect(left.emit)
	player = _make_player() if arguments.carries == 0 else _make_carry_player()
	add_child(player)
	add_child(sound)
	_lay_out()
	if most_bodies > 0:
		bodies.resize(mini(bodies.size(), most_bodies))
	_watch_bodies()
	_equip_player()
	if arguments.scripted():
		_start_script()
	else:
		PictureQuality.apply(self, settings.picture)
		_controls.interactive = true
		_spidar.forces_enabled = forces_at_start
		if forces_at_start:
			_spidar.arm()
		_scripted_hand.process_mode = Node.PROCESS_MODE_DISABLED
		_mouse_hand.start(_spidar, $CameraRig/Camera, _home_in_device())
		if settings.source == DemoSettings.REPLAY and may_replay():
			_start_replay()
		_animator.setup(_mouse_hand, _scripted_hand, player, settings.auto_animation)


func _physics_process(delta: float) -> void:
	if not is_trial():
		return
	var placed := _judge()
	_hud.show_task(
		title(), logger.task_time_s, placed, bodies, arguments.level, arguments.seed_number
	)
	if not _running:
		if _spidar.get_state() == SpidarG.STATE_ACTIVE:
			_start_clock()
		return
	logger.sample(_spidar, delta)
	frame_cost.sample()
	_placed_for_s = _placed_for_s + delta if placed == bodies.size() else 0.0
	if _placed_for_s >= DWELL_S and not arguments.scripted():
		_finish("")
	elif arguments.scripted() and logger.task_time_s > _time_limit_s():
		_scripted_hand.stopped = true


## When the device is armed; at the first grasp for a person who plays without forces.
func _start_clock() -> void:
	if not _running and not _finished:
		_running = true
		logger.start(_spidar)


func _stop_clock() -> void:
	_running = false
	_finished = true


## How many things are where they belong, now.
func _judge() -> int:
	var held := _tool_hand.get_held_body()
	var count := 0
	for body in bodies:
		body.placed = body.is_placed(held)
		body.show_placed(body.placed)
		count += int(body.placed)
	return count


func _watch_bodies() -> void:
	for body in bodies:
		body.struck.connect(_on_struck.bind(body))


func _restart() -> void:
	_tool_hand.release()
	for child in _items.get_children():
		_items.remove_child(child)
		child.queue_free()
	bodies.clear()
	logger = TrialLogger.new()
	_running = false
	_finished = false
	_placed_for_s = 0.0
	_hud.show_result("")
	_mouse_hand.recentre(_home_in_device())
	_animator.stop()
	_lay_out()
	_watch_bodies()
	_equip_player()


func _start_script() -> void:
	_mouse_hand.process_mode = Node.PROCESS_MODE_DISABLED
	_animator.process_mode = Node.PROCESS_MODE_DISABLED
	var error := OK if in_experiment else DirAccess.make_dir_recursive_absolute(arguments.out_dir)
	if error != OK:
		printerr("--out %s: cannot be made: %s" % [arguments.out_dir, error_string(error)])
		get_tree().quit(PlayArguments.EXIT_BAD_ARGUMENTS)
		return
	if arguments.pictures or arguments.movie:
		_pictures.start(arguments.out_dir)
		_pictures.filming = arguments.movie
	_hud.show_result("Played by script, layout %d" % arguments.seed_number)
	_spidar.forces_enabled = not in_experiment or forces_at_start
	_scripted_hand.be(arguments.hand, arguments.seed_number)
	var reason := await _wait_until_ready()
	if reason == "":
		if arguments.cut_output:
			_spidar.inject_simulated_fault(SpidarG.FAULT_OUTPUT_CUT)
		if arguments.freeze_pose:
			_spidar.inject_simulated_fault(SpidarG.FAULT_FROZEN_COUNTS)
		await player.play()
		reason = player.verdict()
		if _scripted_hand.stopped:
			reason = "time limit of %d s simulated time" % int(_time_limit_s())
	_stop_clock()
	_hud.show_result("Played by script in %.1f s" % logger.task_time_s)
	await _pictures.take("done")
	_finish(reason)


func _start_replay() -> void:
	_spidar.replay_finished.connect(func(_identical: bool, message: String) -> void:
		_hud.show_notice("Replay of %s has ended: %s" % [settings.recording, message]))
	if settings.recording == "":
		_hud.show_notice("No recording is chosen in the settings. {demo_record} records a run.")
	elif _spidar.start_replay(DemoSettings.RECORDINGS.path_join(settings.recording)):
		_hud.show_notice("Replay of %s.   {demo_leave}  leaves" % settings.recording)


func _equip_player() -> void:
	player.spidar = _spidar
	player.tool_hand = _tool_hand
	player.view = $SpidarG/SpidarGView
	player.hand = _scripted_hand
	player.bodies = bodies
	player.pictures = _pictures
	player.camera_rig = $CameraRig
	player.table_height_m = _items.global_position.y
	var checked := arguments.scripted() and not in_experiment
	for item in bodies:
		item.felt.checks_weight = item.felt.checks_weight and checked
		item.felt.checks_width = item.felt.checks_width and checked
		item.felt.checks_detent = item.felt.checks_detent and checked
		item.felt.checks_release = item.felt.checks_release and checked


func _wait_until_ready() -> String:
	var home := _spidar.global_transform.translated_local(_home_in_device())
	_scripted_hand.start(_spidar)
	await _scripted_hand.move_to(home, 1.0)
	var waited_s := 0.0
	if not _spidar.forces_enabled:
		_start_clock()
	while not _running:
		await _scripted_hand.wait(0.1)
		waited_s += 0.1
		if waited_s > READY_LIMIT_S:
			return "device not active: %s %s" % [_spidar.get_state_text(), _spidar.get_fault_text()]
	return ""


func _finish(reason: String) -> void:
	_stop_clock()
	if in_experiment:
		ended.emit(reason)
		return
	var results := TrialResults.new(self, _spidar)
	if not arguments.scripted():
		_hud.show_result(results.save_interactive())
		return
	var code := results.save_scripted(reason)
	get_tree().quit(code)


func _home_in_device() -> Vector3:
	return (
		_spidar.to_local(_items.global_position + Vector3.UP * HOME_ABOVE_TABLE_M)
		/ _spidar.workspace_scale
	)


func _on_closed() -> void:
	if not _attempt_open:
		_attempt_open = true
		logger.grasp_attempts += 1


func _on_body_grasped(body: RigidBody3D) -> void:
	_start_clock()
	_on_closed()
	logger.note_grasp()
	sound.say(&"grasped")
	if body is TaskBody:
		(body as TaskBody).show_held(true)


func _on_body_released(released: RigidBody3D) -> void:
	_attempt_open = false
	sound.say(&"released")
	var body := released as TaskBody
	if body == null:
		return
	body.show_held(false)
	_note_release(body)


## Counts a drop, or a thing put where another one belongs.
func _note_release(body: TaskBody) -> void:
	var above := body.global_position.y - body.goal().origin.y
	if above > DROP_HEIGHT_M:
		logger.drops += 1
		return
	for other in bodies:
		var goal := other.goal().origin
		if other != body and goal.distance_to(body.global_position) < DROP_HEIGHT_M:
			logger.wrong_placements += 1


func _on_struck(other: TaskBody, body: TaskBody) -> void:
	# Both report the same blow; count it once.
	if body.get_index() < other.get_index():
		logger.collisions += 1
		sound.say(&"struck")
