extends "res://study/trial.gd"
## What every task shares: the device, the table, a person's or a script's hand, and starting again. A task lays out its
## things (_lay_out) and fills `bodies`; each body knows where it belongs.

const AutoAnimator := preload("res://ui/auto_animator.gd")
const CarryPlayer := preload("res://play/carry_player.gd")
const DemoControls := preload("res://ui/demo_controls.gd")
const FrameRateNotice := preload("res://ui/frame_rate_notice.gd")
const HandShadow := preload("res://scene/hand_shadow.gd")
const Hud := preload("res://ui/hud.gd")
const ModelHand := preload("res://play/model_hand.gd")
const MouseHand := preload("res://ui/mouse_hand.gd")
const PictureQuality := preload("res://scene/picture_quality.gd")
const PictureTaker := preload("res://play/picture_taker.gd")
const SceneLabels := preload("res://ui/scene_labels.gd")
const ScriptedHand := preload("res://play/scripted_hand.gd")
const ScriptedRun := preload("res://tasks/base/scripted_run.gd")
const TaskFeedback := preload("res://tasks/base/task_feedback.gd")
const TaskLayout := preload("res://tasks/base/task_layout.gd")
const TaskPlayer := preload("res://play/task_player.gd")

const HOME_ABOVE_TABLE_M := 0.12
## What a device with a small frame reaches is enlarged by this much.
const SMALL_FRAME_SCALE := 2.5

## Whether a recording can stand in for the hand; the menu has to be worked.
@export var may_replay := true

var player: TaskPlayer

@onready var _items: Node3D = $Items
@onready var _scripted_hand: ScriptedHand = $ScriptedHand
@onready var _mouse_hand: MouseHand = $MouseHand
@onready var _animator: AutoAnimator = $AutoAnimator
@onready var _pictures: PictureTaker = $PictureTaker
@onready var _hud: Hud = $Hud
@onready var _controls: DemoControls = $Controls
@onready var _feedback: TaskFeedback = $Feedback
@onready var _script_run: ScriptedRun = $ScriptedRun
@onready var _labels: SceneLabels = $SceneLabels
@onready var _frame_rate: FrameRateNotice = $Hud/%FrameRate


## Builds the things of arguments.level from arguments.seed_number under _items, and fills `bodies`.
func _lay_out() -> void:
	pass


## Lays the things out and takes over those that have to be placed.
func _use_layout(layout: TaskLayout) -> void:
	layout.lay_out(_items, arguments.level, arguments.seed_number)
	bodies.assign(layout.bodies)


## Takes away what _lay_out built.
func _clear_away() -> void:
	for child in _items.get_children():
		_items.remove_child(child)
		child.queue_free()


## The hand that plays this task by script.
func _make_player() -> TaskPlayer:
	return TaskPlayer.new()


func max_penetration_m() -> float:
	return player.penetration.worst_m


func _enter_tree() -> void:
	# Before the device opens: a scripted play steps simulated time, so that equal seeds play equally.
	var device: SpidarG = $SpidarG
	if arguments.source == DemoSettings.SERIAL:
		settings.source = DemoSettings.SERIAL
		settings.serial_port = arguments.serial_port
		settings.workspace_scale = 1.0 if arguments.scripted() else settings.workspace_scale
		device.release_on_focus_loss = not arguments.scripted()
		if DisplayServer.get_name() == "headless":
			Engine.max_fps = Engine.physics_ticks_per_second # else frames without end take a processor from the model
		settings.apply(device)
	elif arguments.scripted():
		device.drive_mode = SpidarG.DRIVE_STEPPED
		device.config.transport = SpidarGConfig.TRANSPORT_SIMULATED # A script never moves a real hand.
	else:
		settings.apply(device)
	if arguments.preset >= 0:
		_apply_preset(device.config)


func _apply_preset(config: SpidarGConfig) -> void:
	config.preset = arguments.preset
	if config.has_rigid_grip(): # jaws and pads as large as with the paper's device
		($SpidarG as SpidarG).workspace_scale = SMALL_FRAME_SCALE
		config.jaw_open /= SMALL_FRAME_SCALE


func _ready() -> void:
	process_physics_priority = 10 # after the device and the tool have stepped
	if arguments.model_port > 0:
		_scripted_hand.model = ModelHand.new(arguments.model_port)
		_mouse_hand.model = _scripted_hand.model
	_watch_hand()
	_feedback.setup(self, _hud)
	_hud.setup(spidar, tool_hand, goal)
	_hud.help_shown.connect(func(shown: bool) -> void: _labels.visible = not shown)
	_labels.obstacles = _panels
	_frame_rate.plain_wanted.connect(_choose_plain)
	($HandShadow as HandShadow).setup(spidar, tool_hand)
	_controls.setup(spidar, _hud, _mouse_hand, settings, task_name)
	_controls.restart_wanted.connect(_restart)
	_controls.leave_wanted.connect(left.emit)
	player = _make_player() if arguments.carries == 0 else _make_carry_player()
	add_child(player)
	_start_layout()
	_show_texts()
	if arguments.scripted():
		_start_script()
	else:
		_start_person()


func _start_layout() -> void:
	_lay_out()
	if arguments.scripted() and arguments.things > 0:
		most_bodies = arguments.things
	if most_bodies > 0:
		bodies.resize(mini(bodies.size(), most_bodies))
	if spidar.config.has_rigid_grip():
		for body in bodies: # Nothing pushes its fingers open.
			body.felt.checks_width = false
	_watch_bodies()
	_equip_player()
	_labels.watch(_items, spidar, tool_hand, settings.text_percent)


## Shows all text at the size that the settings say.
func _show_texts() -> void:
	_hud.set_text_percent(settings.text_percent)
	_labels.set_text_percent(settings.text_percent)


## What is on the screen and must not be covered by the labels of things.
func _panels() -> Array[Control]:
	return _hud.panels()


func _show_picture() -> void:
	PictureQuality.apply(self, settings.picture)
	_frame_rate.is_plain = PictureQuality.is_plain(settings.picture, RenderingServer.get_video_adapter_name())


func _choose_plain() -> void:
	settings.picture = PictureQuality.PLAIN
	settings.save()
	_show_picture()


func _restart() -> void:
	tool_hand.release()
	_clear_away()
	_reset_trial()
	_hud.show_result("")
	_mouse_hand.recenter(_home_in_device())
	_animator.stop()
	_start_layout()


func _start_person() -> void:
	_show_picture()
	_controls.interactive = true
	spidar.forces_enabled = forces_at_start
	if forces_at_start:
		spidar.arm()
	_scripted_hand.process_mode = Node.PROCESS_MODE_DISABLED
	_mouse_hand.recenter(_home_in_device())
	if settings.source == DemoSettings.REPLAY and may_replay:
		_start_replay()
	_animator.setup(_mouse_hand, _scripted_hand, player, settings.auto_animation)
	if in_experiment: # The picture is the same in all trials.
		_frame_rate.process_mode = Node.PROCESS_MODE_DISABLED


func _start_replay() -> void:
	spidar.replay_finished.connect(func(_identical: bool, message: String) -> void:
		_hud.show_notice(tr("NOTICE_REPLAY_ENDED") % [settings.recording, message]))
	if settings.recording == "":
		_hud.show_notice("NOTICE_NO_RECORDING")
	elif spidar.start_replay(DemoSettings.RECORDINGS.path_join(settings.recording)):
		_hud.show_notice(tr("NOTICE_REPLAY") % settings.recording)


func _start_script() -> void:
	_mouse_hand.process_mode = Node.PROCESS_MODE_DISABLED
	_animator.process_mode = Node.PROCESS_MODE_DISABLED
	_frame_rate.process_mode = Node.PROCESS_MODE_DISABLED
	_script_run.trial = self
	_script_run.player = player
	_script_run.hud = _hud
	_script_run.play(spidar.global_transform.translated_local(_home_in_device()))


func _check_end() -> void:
	super()
	if _script_run.is_overdue():
		_scripted_hand.stopped = true


func finish(reason: String) -> String:
	if player is CarryPlayer:
		logger.drops = (player as CarryPlayer).dropped
	var told := super(reason)
	if told != "":
		_hud.show_result(told)
	return told


func _make_carry_player() -> TaskPlayer:
	var carry_player := CarryPlayer.new()
	carry_player.carries = arguments.carries
	carry_player.seed_number = arguments.seed_number
	return carry_player


func _equip_player() -> void:
	player.spidar = spidar
	player.tool_hand = tool_hand
	player.view = $SpidarG/SpidarGView
	player.hand = _scripted_hand
	player.bodies = bodies
	player.pictures = _pictures
	player.camera_rig = $CameraRig
	player.table_height_m = _items.global_position.y
	if not arguments.scripted() or in_experiment:
		for body in bodies:
			body.felt.check_nothing()


func _home_in_device() -> Vector3:
	return (
		spidar.to_local(_items.global_position + Vector3.UP * HOME_ABOVE_TABLE_M)
		/ spidar.workspace_scale
	)
