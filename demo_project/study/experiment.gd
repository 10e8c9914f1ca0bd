extends Node
## Runs a participant through the plan: instructions, practice, trials, questionnaires, breaks; a key aborts a trial,
## which is then done again. A simulated participant does the same by script.

const DemoSettings := preload("res://ui/demo_settings.gd")
const ExperimentPlan := preload("res://study/experiment_plan.gd")
const ExperimentScreen := preload("res://study/experiment_screen.gd")
const ExperimentStore := preload("res://study/experiment_store.gd")
const KeyNames := preload("res://ui/key_names.gd")
const PlayArguments := preload("res://play/play_arguments.gd")
const TraceRecorder := preload("res://study/trace_recorder.gd")
const TrialLogger := preload("res://study/trial_logger.gd")
const Trial := preload("res://study/trial.gd")
const TrialResults := preload("res://study/trial_results.gd")

signal left
signal ended(exit_code: int)

const TRIALS := 3
## By condition: keys of the translation.
const TEXTS: Dictionary[String, String] = {
	"forces_on": "CONDITION_FORCES_ON",
	"forces_off": "CONDITION_FORCES_OFF",
	"mouse": "CONDITION_MOUSE",
	"mouse_auto": "CONDITION_MOUSE_AUTO",
}

var arguments := PlayArguments.new()
var settings := DemoSettings.new()
## The tasks by name, and what makes the scene of one; given by main.
var task_names: PackedStringArray = []
var scene_of: Callable

var _store := ExperimentStore.new()
var _plan: Array[ExperimentPlan.Step] = []
var _at := -1
var _task: Trial
var _trace: TraceRecorder
var _participant := 1
var _random := RandomNumberGenerator.new()

@onready var _screen: ExperimentScreen = $Screen


func _ready() -> void:
	_screen.text_percent = settings.text_percent
	_participant = arguments.participant if arguments.simulates() else settings.participant.to_int()
	if _participant < 1:
		_screen.show_text("EXPERIMENT_PARTICIPANT", "EXPERIMENT_NO_NUMBER", "EXPERIMENT_BACK", left.emit)
		return
	_random.seed = _participant
	_plan = ExperimentPlan.make(
		_participant, arguments.trials if arguments.simulates() else TRIALS, task_names
	)
	var folder := arguments.out_dir
	if folder == "":
		folder = ProjectSettings.globalize_path("user://experiments/participant_%d" % _participant)
	var problem := _store.open(folder, "participant-%d" % _participant)
	if problem != "":
		printerr(problem)
		ended.emit(PlayArguments.EXIT_BAD_ARGUMENTS)
		return
	_next()


## The task of the trial in progress, or null.
func open_task() -> Trial:
	return _task


func _physics_process(_delta: float) -> void:
	if _task != null and _trace != null and _task.is_running():
		_trace.sample(_task, _head(_plan[_at]))


func _unhandled_key_input(event: InputEvent) -> void:
	if _task == null and event.is_action_pressed(&"demo_leave"):
		left.emit() # What is on file stays there; the next start goes on behind it.
	if _task == null or not event.is_action_pressed(&"demo_abort_trial"):
		return
	_keep("aborted by the participant")
	_close_task()
	_screen.show_text("EXPERIMENT_ABORTED", "EXPERIMENT_AGAIN", "GO_ON", _open_task)


## Goes to the first step that is not on file yet.
func _next() -> void:
	var trials := _store.done("summary.csv")
	var ratings := _store.done("ratings.csv")
	_at += 1
	while _at < _plan.size() and _is_done(_plan[_at], trials, ratings):
		_at += 1
	if _at >= _plan.size():
		ended.emit(PlayArguments.EXIT_DONE)
		return
	var step := _plan[_at]
	if arguments.simulates() and step.kind in [ExperimentPlan.Kind.INSTRUCTION, ExperimentPlan.Kind.BREAK]:
		_next.call_deferred()
		return
	match step.kind:
		ExperimentPlan.Kind.INSTRUCTION:
			_instruct(step)
		ExperimentPlan.Kind.BREAK:
			_screen.show_text("EXPERIMENT_BREAK", "EXPERIMENT_REST", "GO_ON", _next)
		ExperimentPlan.Kind.RATINGS:
			_ask(step)
		ExperimentPlan.Kind.END:
			if arguments.simulates():
				ended.emit(PlayArguments.EXIT_DONE)
			else:
				_screen.show_text("EXPERIMENT_THANKS", tr("EXPERIMENT_RESULTS") % _store.folder, "EXPERIMENT_TO_MENU", left.emit)
		_:
			_open_task()


func _instruct(step: ExperimentPlan.Step) -> void:
	var shown: Trial = scene_of.call(step.task)
	var text := "%s\n\n%s\n\n%s" % [tr(shown.goal), tr(TEXTS[step.condition]), tr("EXPERIMENT_PRACTICE") % TRIALS]
	_screen.show_text(shown.title, KeyNames.fill(text), "EXPERIMENT_START", _next)
	shown.free()


## What comes before a finished trial or rating is done with it.
func _is_done(
	step: ExperimentPlan.Step, trials: Dictionary[String, bool], ratings: Dictionary[String, bool]
) -> bool:
	var both := "%s/%s" % [step.task, step.condition]
	match step.kind:
		ExperimentPlan.Kind.TRIAL:
			return trials.has("%s/%d" % [both, step.trial])
		ExperimentPlan.Kind.RATINGS:
			return ratings.has(both)
		ExperimentPlan.Kind.INSTRUCTION, ExperimentPlan.Kind.PRACTICE:
			return ratings.has(both) or trials.has(both + "/1") or (
				arguments.simulates() and step.kind == ExperimentPlan.Kind.PRACTICE
			)
	return false


func _open_task() -> void:
	var step := _plan[_at]
	_screen.hide_all()
	var trial_arguments := PlayArguments.new()
	trial_arguments.level = arguments.level
	trial_arguments.seed_number = step.seed_number
	if arguments.simulates():
		trial_arguments.task = step.task
		trial_arguments.hand = PlayArguments.HANDS[_random.randi_range(0, 2)]
	var trial_settings := DemoSettings.new()
	trial_settings.source = DemoSettings.MOUSE
	if not step.condition.begins_with("mouse"):
		var device := settings.source == DemoSettings.DEVICE
		trial_settings.source = DemoSettings.DEVICE if device else DemoSettings.SIMULATED
	trial_settings.device_serial = settings.device_serial
	trial_settings.forces_allowed = step.condition == "forces_on"
	trial_settings.auto_animation = step.condition == "mouse_auto"
	trial_settings.picture = settings.picture
	trial_settings.text_percent = settings.text_percent
	trial_settings.participant = str(_participant)
	_task = scene_of.call(step.task)
	_task.arguments = trial_arguments
	_task.settings = trial_settings
	_task.in_experiment = true
	_task.forces_at_start = trial_settings.forces_allowed
	_task.most_bodies = arguments.things
	_task.ended.connect(_on_trial_ended)
	_task.left.connect(left.emit)
	_trace = TraceRecorder.new()
	add_child(_task)


func _on_trial_ended(reason: String) -> void:
	_keep(reason)
	_close_task.call_deferred()
	_next.call_deferred()


func _keep(reason: String) -> void:
	var step := _plan[_at]
	if step.kind == ExperimentPlan.Kind.TRIAL:
		var row: Dictionary = TrialResults.new(_task).row_of(reason)
		row.merge(_head(step), true)
		row["participant_id"] = _participant
		row["grip_source"] = "simulated" if arguments.simulates() else _task.settings.source
		row["started_utc"] = Time.get_datetime_string_from_system(true)
		var trace := _trace.rows
		if _store.append("trace.csv", trace) != OK or _store.append("summary.csv", [row]) != OK:
			push_error("%s: a trial could not be written" % _store.folder)


func _head(step: ExperimentPlan.Step) -> Dictionary:
	return {
		"session_id": _store.session_id, "task": step.task, "condition": step.condition, "trial": step.trial,
	}


func _close_task() -> void:
	if _task != null:
		_task.queue_free()
		remove_child(_task)
	_task = null
	_trace = null


func _ask(step: ExperimentPlan.Step) -> void:
	if not arguments.simulates():
		_screen.ask_ratings(step.condition, func(answers: Dictionary) -> void: _rate(step, answers))
		return
	var answers := {}
	for question in ExperimentScreen.questions(step.condition):
		answers[question] = _random.randi_range(2, 5)
	_rate.call_deferred(step, answers)


func _rate(step: ExperimentPlan.Step, answers: Dictionary) -> void:
	var row := answers.duplicate()
	row.merge({
		"schema_version": TrialLogger.SCHEMA_VERSION, "session_id": _store.session_id,
		"participant_id": _participant, "task": step.task, "condition": step.condition,
		"computer_experience": settings.computer_experience,
		"haptic_experience": settings.haptic_experience,
		"rated_utc": Time.get_datetime_string_from_system(true),
	})
	if _store.append("ratings.csv", [row]) != OK:
		push_error("%s: a rating could not be written" % _store.folder)
	_next()
