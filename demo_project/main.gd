extends Node
## Start scene: reads the arguments after `--`, checks that the add-on is there, and opens the menu or a task.
##
## Exit codes of a scripted play: 0 all placed and felt right, 1 not, 2 the arguments or the add-on are wrong.

## Nothing here may name SpidarG: without the add-on's library such a script does not load, and this one has to say so.
const PlayArguments := preload("res://play/play_arguments.gd")
const TaskList := preload("res://hub/task_list.gd")

var _arguments: PlayArguments
var _settings: RefCounted
var _scene: Node
var _report: Node


func _ready() -> void:
	var arguments := PlayArguments.new()
	arguments.read(OS.get_cmdline_user_args(), TaskList.task_names(), TaskList.CARRYING)
	if arguments.problem != "":
		_refuse(arguments.problem + "\n" + PlayArguments.USAGE, true)
		return
	# Scripts that name SpidarG do not even compile without the library, so ask before loading any.
	if not ClassDB.class_exists(&"SpidarG"):
		_refuse(tr("MISSING_LIBRARY"), arguments.scripted())
		return
	_arguments = arguments
	_settings = (load("res://ui/demo_settings.gd") as Script).call(&"load_or_default")
	if arguments.simulates():
		_open("experiment")
	elif arguments.scripted():
		_open(arguments.task)
	else:
		_settings.set(&"level", arguments.level if arguments.open_task != "" else _settings.get(&"level"))
		_open(arguments.open_task if arguments.open_task != "" else _first_scene())


## The menu; at the very first start, and until it has been finished or skipped, the guided start.
func _first_scene() -> String:
	return "hub" if _settings.get(&"guide_shown") else "guided_start"


## Replaces what is open by a task, free play or the menu.
func _open(scene_name: String) -> void:
	if _scene != null:
		_scene.queue_free()
	_scene = TaskList.make(scene_name)
	if not _scene.has_signal(&"left"):
		_refuse(tr("NOT_IMPORTED") % scene_name, _arguments.scripted())
		return
	_scene.set(&"arguments", _arguments)
	_scene.set(&"settings", _settings)
	if scene_name == "hub":
		_scene.connect(&"chosen", _on_chosen)
		_scene.connect(&"left", get_tree().quit)
	else:
		_scene.connect(&"left", _open.bind("hub"))
	if scene_name == "experiment":
		_scene.set(&"task_names", TaskList.task_names())
		_scene.set(&"scene_of", TaskList.make)
		_scene.connect(&"ended", get_tree().quit)
	add_child(_scene)
	if _arguments.report != "" and _report == null:
		_report = (load("res://screen_report.gd") as Script).call(&"new")
		_report.set(&"path", _arguments.report)
		add_child(_report)
	if _report != null:
		_report.set(&"scene", _scene)


func _on_chosen(entry: StringName, level: int) -> void:
	_arguments.level = level
	_open(String(entry))


func _refuse(message: String, leave: bool) -> void:
	printerr(message)
	if leave or DisplayServer.get_name() == "headless":
		get_tree().quit(PlayArguments.EXIT_BAD_ARGUMENTS)
		return
	var label := Label.new()
	label.text = message
	label.horizontal_alignment = HORIZONTAL_ALIGNMENT_CENTER
	label.vertical_alignment = VERTICAL_ALIGNMENT_CENTER
	label.set_anchors_preset(Control.PRESET_FULL_RECT)
	add_child(label)
