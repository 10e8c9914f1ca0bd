extends Node
## Start scene: reads the arguments after `--`, checks that the add-on is there, and opens the task.
##
## Exit codes of a scripted play: 0 all placed and felt right, 1 not, 2 the arguments or the add-on are wrong.

const TASKS: Dictionary[String, String] = {
	"pick_and_place": "res://tasks/pick_and_place/pick_and_place.tscn",
}
const DEFAULT_TASK := "pick_and_place"
## By path: before the first import no class name is known, and this script must be able to say what is missing.
const Arguments := preload("res://common/play_arguments.gd")


func _ready() -> void:
	var arguments := Arguments.new()
	arguments.read(OS.get_cmdline_user_args(), PackedStringArray(TASKS.keys()))
	if arguments.problem != "":
		_refuse(arguments.problem + "\n" + Arguments.USAGE, true)
		return
	# Scripts that name SpidarG do not even compile without the library, so ask before loading any.
	if not ClassDB.class_exists(&"SpidarG"):
		_refuse(
			"The SPIDAR-G add-on is not loaded: addons/spidar_g/bin holds no library for this "
			+ "system.\nBuild it with `./dev build`, or unpack a release of the add-on into "
			+ "the project's addons folder.",
			arguments.scripted()
		)
		return
	var task_name := arguments.task if arguments.scripted() else DEFAULT_TASK
	var scene: PackedScene = load(TASKS[task_name])
	var task := scene.instantiate()
	task.set("arguments", arguments)
	add_child(task)


func _refuse(message: String, leave: bool) -> void:
	printerr(message)
	if leave or DisplayServer.get_name() == "headless":
		get_tree().quit(Arguments.EXIT_BAD_ARGUMENTS)
		return
	var label := Label.new()
	label.text = message
	label.horizontal_alignment = HORIZONTAL_ALIGNMENT_CENTER
	label.vertical_alignment = VERTICAL_ALIGNMENT_CENTER
	label.set_anchors_preset(Control.PRESET_FULL_RECT)
	add_child(label)
