extends RefCounted
## What the command line asks for, after `--`. No arguments: an interactive session.

const EXIT_DONE := 0
const EXIT_NOT_DONE := 1
const EXIT_BAD_ARGUMENTS := 2
const LEVELS := 3
const SOURCES: PackedStringArray = ["simulated", "serial"]
const HANDS: PackedStringArray = ["steady", "trembling", "clumsy"]
## Names of SpidarGConfig.preset.
const DEVICES: PackedStringArray = ["custom", "paper", "x3r", "x3l", "x5r", "x5l", "x4"]
const USAGE := (
	"usage: ... -- --play TASK [--level L] [--seed N] --out DIR [--hand steady|trembling|clumsy]\n"
	+ "              [--device paper|x3r|x3l|x5r|x5l|x4] [--source serial --serial-port PATH --model-port N]\n"
	+ "              [--carries N] [--things N] [--display] [--pictures] [--movie] [--cut-output] [--freeze-pose]\n"
	+ "       ... -- --participant N --out DIR [--trials K] [--things K] [--level L]    (simulated)\n"
	+ "       ... -- [--task TASK] [--level L] [--seed N] [--device NAME] [--report FILE]    (interactive)\n"
	+ "              [--source serial [--serial-port PATH] [--model-port N]]"
)

## Task to play by script; empty: interactive.
var task := ""
## Task that an interactive session opens at once; empty: the menu.
var open_task := ""
## 1 to LEVELS, rising in difficulty.
var level := 1
## Whose hand plays: one of HANDS.
var hand := HANDS[0]
## SpidarGConfig.preset; -1: that of the demo.
var preset := -1
## One of SOURCES; empty: the simulated device for a script, the settings' for a person.
var source := ""
## Of the motor boards; empty: the only one of a USB bridge.
var serial_port := ""
## Where spidar_board_model hears what its hand does; 0: a person moves the grip.
var model_port := 0
## Layout of the trial.
var seed_number := 1
## Absolute folder for the results.
var out_dir := ""
## Carry things about so many times, and back, instead of playing the task; 0: play it.
var carries := 0
## Keep the HUD up to date although nobody sees it: what a frame costs is measured with it.
var display := false
## Save pictures of the run into out_dir.
var pictures := false
## Absolute path of a file that says where things are on the screen; for a scripted user. Empty: none.
var report := ""
## How many things have to be placed; 0: all.
var things := 0
## A simulated participant of the experiment; 0: none. With it, counted trials per task and condition.
var participant := 0
var trials := 1
## Save the frames of a short movie there, too.
var movie := false
## Cut the motor currents inside the simulated device: nothing can be felt.
var cut_output := false
## Freeze the simulated encoders: the grip's pose never changes.
var freeze_pose := false
## What is wrong with the arguments; empty when nothing is.
var problem := ""


func simulates() -> bool:
	return participant > 0


func scripted() -> bool:
	return task != ""


## Reads the words after `--`; what is wrong with them goes into `problem`. carrying: tasks that know --carries.
func read(words: PackedStringArray, tasks: PackedStringArray, carrying: PackedStringArray) -> void:
	var index := 0
	while index < words.size() and problem == "":
		var word := words[index]
		match word:
			"--pictures":
				pictures = true
			"--movie":
				movie = true
			"--display":
				display = true
			"--cut-output":
				cut_output = true
			"--freeze-pose":
				freeze_pose = true
			"--play", "--task", "--level", "--seed", "--device", "--out", "--hand", "--report", "--participant", "--trials", "--things", "--carries", "--source", "--serial-port", "--model-port":
				index += 1
				if index >= words.size():
					problem = "%s needs a value after it" % word
				else:
					_set_value(word, words[index], tasks)
			_:
				problem = "%s is not an argument of the demo" % word
		index += 1
	if problem == "":
		problem = _find_conflict(carrying)


func _set_value(word: String, value: String, tasks: PackedStringArray) -> void:
	match word:
		"--play", "--task":
			if not tasks.has(value):
				problem = "%s %s: no such task; there is: %s" % [word, value, ", ".join(tasks)]
			if word == "--play":
				task = value
			else:
				open_task = value
		"--level":
			if not value.is_valid_int() or value.to_int() < 1 or value.to_int() > LEVELS:
				problem = "--level %s: must be a whole number from 1 to %d" % [value, LEVELS]
			level = value.to_int()
		"--device":
			preset = DEVICES.find(value)
			if preset < 0:
				problem = "--device %s: no such device; there is: %s" % [value, ", ".join(DEVICES)]
		"--hand":
			if not HANDS.has(value):
				problem = "--hand %s: no such hand; there is: %s" % [value, ", ".join(HANDS)]
			hand = value
		"--source":
			if not SOURCES.has(value):
				problem = "--source %s: no such source; there is: %s" % [value, ", ".join(SOURCES)]
			source = value
		"--serial-port":
			serial_port = value
		"--model-port":
			if not value.is_valid_int() or value.to_int() < 1 or value.to_int() > 65535:
				problem = "--model-port %s: must be a port, 1 to 65535" % value
			model_port = value.to_int()
		"--seed":
			if not value.is_valid_int() or value.to_int() < 0:
				problem = "--seed %s: must be a whole number of 0 or more" % value
			seed_number = value.to_int()
		"--participant", "--trials", "--things", "--carries":
			if not value.is_valid_int() or value.to_int() < 1:
				problem = "%s %s: must be a whole number of 1 or more" % [word, value]
			set(word.trim_prefix("--"), value.to_int())
		"--report":
			if not value.is_absolute_path():
				problem = "--report %s: must be an absolute path of a file" % value
			report = value
		"--out":
			if not value.is_absolute_path():
				problem = "--out %s: must be an absolute path of a folder" % value
			out_dir = value


func _find_conflict(carrying: PackedStringArray) -> String:
	if scripted() and out_dir == "":
		return "--play needs --out DIR: the folder for summary.csv and objects.csv"
	if carries > 0 and not carrying.has(task):
		return "--carries needs --play %s: elsewhere things link on the way" % " or ".join(carrying)
	if source != "serial" and (serial_port != "" or model_port != 0):
		return "--serial-port and --model-port need --source serial"
	if scripted() and source == "serial" and model_port == 0:
		return "--play with --source serial needs --model-port: a script never moves a real hand"
	if model_port > 0 and preset > DEVICES.find("paper"):
		return "--device with --model-port: the model of the boards is the paper's device"
	if source == "serial" and (cut_output or freeze_pose or simulates()):
		return "--cut-output, --freeze-pose and --participant are for the simulated device"
	if simulates() and (scripted() or out_dir == ""):
		return "--participant needs --out DIR, and no --play"
	if simulates():
		return ""
	if not scripted() and (pictures or movie or cut_output or freeze_pose or out_dir != "" or hand != HANDS[0]):
		return "--hand, --out, --pictures, --movie, --cut-output and --freeze-pose need --play TASK"
	if (pictures or movie) and DisplayServer.get_name() == "headless":
		return "--pictures and --movie need a display: run without --headless (under Xvfb where there is none)"
	return ""
