class_name PickAndPlace
extends Node3D
## The task: pick every object up and put it on the outline of its own shape, colour and size.
## Kim, Koike and Sato's experiment 2 ("SPIDAR-G", section 7.2), at life size.

const TASK_NAME := "pick_and_place"
const TITLE := "Pick and place"
## A scripted play that takes longer than this has gone wrong.
const TIME_LIMIT_S := 180.0
## The device needs its arming time before it can be felt; this is more than enough.
const READY_LIMIT_S := 5.0
const DROP_HEIGHT_M := 0.015
const HOME_ABOVE_TABLE_M := 0.12

var arguments := PlayArguments.new()
var logger := TrialLogger.new()
var objects: Array[TaskObject] = []

var _running := false
var _finished := false
var _placed_for_s := 0.0
var _attempt_open := false

@onready var _spidar: SpidarG = $SpidarG
@onready var _tool_hand: SpidarGHand = $SpidarG/SpidarGHand
@onready var _items: Node3D = $Items
@onready var _scripted_hand: ScriptedHand = $ScriptedHand
@onready var _mouse_hand: MouseHand = $MouseHand
@onready var _player: PickAndPlacePlayer = $Player
@onready var _pictures: PictureTaker = $PictureTaker
@onready var _hud: Hud = $Hud
@onready var _controls: DemoControls = $Controls


func _enter_tree() -> void:
	# Before the device opens: a scripted play steps simulated time, so that equal seeds play equally.
	var spidar: SpidarG = $SpidarG
	if arguments.scripted():
		spidar.drive_mode = SpidarG.DRIVE_STEPPED


func _ready() -> void:
	process_physics_priority = 10 # after the device and the tool have stepped
	_tool_hand.body_grasped.connect(_on_body_grasped)
	_tool_hand.body_released.connect(_on_body_released)
	_spidar.grasped.connect(_on_closed)
	_spidar.released.connect(func() -> void: _attempt_open = false)
	_hud.setup(_spidar, _tool_hand)
	_controls.setup(_spidar, _hud)
	_controls.restart_wanted.connect(_restart)
	_lay_out()
	if arguments.scripted():
		_start_script()
	else:
		_controls.interactive = true
		_scripted_hand.process_mode = Node.PROCESS_MODE_DISABLED
		_mouse_hand.start(_spidar, $CameraRig/Camera, _home_in_device())


func _physics_process(delta: float) -> void:
	var placed := _judge()
	_hud.show_task(TITLE, logger.task_time_s, placed, objects.size(), arguments.seed_number)
	if not _running:
		if _spidar.get_state() == SpidarG.STATE_ACTIVE:
			_start_clock()
		return
	logger.sample(_spidar, delta)
	_placed_for_s = _placed_for_s + delta if placed == objects.size() else 0.0
	if _placed_for_s >= PlacementJudge.DWELL_S and not arguments.scripted():
		_finish("")
	elif arguments.scripted() and logger.task_time_s > TIME_LIMIT_S:
		_scripted_hand.stopped = true


## When the device is armed; at the first grasp for a person who plays without forces.
func _start_clock() -> void:
	if not _running and not _finished:
		_running = true
		logger.start(_spidar)


func _stop_clock() -> void:
	_running = false
	_finished = true


## How many objects lie where they belong, now.
func _judge() -> int:
	var held := _tool_hand.get_held_body()
	var count := 0
	for object in objects:
		object.placed = PlacementJudge.is_placed(object, held)
		object.target.show_placed(object.placed)
		count += int(object.placed)
	return count


func _lay_out() -> void:
	var specs := ObjectCatalogue.all()
	var layout := TaskLayout.make(arguments.seed_number, specs)
	for index in specs.size():
		var target := TargetOutline.new()
		target.setup(specs[index], layout.targets[index])
		_items.add_child(target)
		var stand := StandBuilder.build(specs[index], DemoPalette.STAND)
		if stand != null:
			var pose := layout.starts[index]
			stand.transform = pose.translated_local(Vector3.DOWN * specs[index].rest_height_m())
			_items.add_child(stand)
		var object := TaskObject.new()
		object.setup(specs[index], layout.starts[index], target)
		object.struck.connect(_on_struck.bind(object))
		_items.add_child(object)
		objects.append(object)


func _restart() -> void:
	_tool_hand.release()
	for child in _items.get_children():
		child.queue_free()
	objects.clear()
	logger = TrialLogger.new()
	_running = false
	_finished = false
	_placed_for_s = 0.0
	_hud.show_result("")
	_mouse_hand.recentre(_home_in_device())
	_lay_out()


func _start_script() -> void:
	_mouse_hand.process_mode = Node.PROCESS_MODE_DISABLED
	var error := DirAccess.make_dir_recursive_absolute(arguments.out_dir)
	if error != OK:
		printerr("--out %s: cannot be made: %s" % [arguments.out_dir, error_string(error)])
		get_tree().quit(PlayArguments.EXIT_BAD_ARGUMENTS)
		return
	if arguments.pictures:
		_pictures.start(arguments.out_dir)
	_hud.show_result("Played by script, layout %d" % arguments.seed_number)
	_spidar.forces_enabled = true
	_player.spidar = _spidar
	_player.tool_hand = _tool_hand
	_player.hand = _scripted_hand
	_player.objects = objects
	_player.pictures = _pictures
	_player.camera_rig = $CameraRig
	_player.table_height_m = _items.global_position.y
	var reason := await _wait_until_ready()
	if reason == "":
		if arguments.cut_output:
			_spidar.inject_simulated_fault(SpidarG.FAULT_OUTPUT_CUT)
		if arguments.freeze_pose:
			_spidar.inject_simulated_fault(SpidarG.FAULT_FROZEN_COUNTS)
		await _player.play()
		if _scripted_hand.stopped:
			reason = "time limit of %d s simulated time" % int(TIME_LIMIT_S)
	_stop_clock()
	_hud.show_result("Played by script in %.1f s" % logger.task_time_s)
	await _pictures.take("done")
	_finish(reason)


func _wait_until_ready() -> String:
	var home := _spidar.global_transform.translated_local(_home_in_device())
	_scripted_hand.start(_spidar)
	await _scripted_hand.move_to(home, 1.0)
	var waited_s := 0.0
	while not _running:
		await _scripted_hand.wait(0.1)
		waited_s += 0.1
		if waited_s > READY_LIMIT_S:
			return "device not active: %s %s" % [_spidar.get_state_text(), _spidar.get_fault_text()]
	return ""


func _finish(reason: String) -> void:
	_stop_clock()
	var results := TrialResults.new(self, _player, _spidar)
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
	if body is TaskObject:
		(body as TaskObject).show_held(true)


func _on_body_released(body: RigidBody3D) -> void:
	_attempt_open = false
	var object := body as TaskObject
	if object == null:
		return
	object.show_held(false)
	var above := object.global_position.y - object.target.goal().origin.y
	if above > DROP_HEIGHT_M:
		logger.drops += 1
		return
	for other in objects:
		var goal := other.target.goal().origin
		if other != object and goal.distance_to(object.global_position) < DROP_HEIGHT_M:
			logger.wrong_placements += 1


func _on_struck(_other: TaskObject, _object: TaskObject) -> void:
	# Both report the same blow; count it once.
	if _object.get_index() < _other.get_index():
		logger.collisions += 1
