extends "res://tasks/base/demo_task.gd"
## The first half minute: move, close, lift, forces on. It is shown until it has been finished or skipped once, and from the
## menu. Each step ends by itself when the user has done it; a key or a button skips them all.

const GuidePanel := preload("res://hub/guide_panel.gd")
const GuideSteps := preload("res://hub/guide_steps.gd")

## The end is shown for so long, then the menu opens.
const END_S := 5.0

var steps: GuideSteps

var _thing: TaskBody
var _end_s := 0.0
var _ended := false

@onready var _panel: GuidePanel = $Guide


func _ready() -> void:
	super()
	_hud.without_hints = true
	_hud.show_mode(Hud.Mode.OFF)
	_hud.help_shown.connect(func(shown: bool) -> void: _panel.visible = not shown)
	_panel.skipped.connect(_end)
	_panel.forces_wanted.connect(_controls.toggle_forces)
	left.connect(_remember)
	steps = GuideSteps.new(spidar, tool_hand, _thing, settings.may_have_forces())
	_show_step()


func _physics_process(delta: float) -> void:
	super(delta)
	if _ended:
		return
	if steps.watch():
		_feedback.sound.say(&"linked")
		_show_step()
	_panel.show_progress(steps.progress)
	if steps.step == GuideSteps.Step.DONE:
		_end_s += delta
		if _end_s >= END_S:
			_end()


func _lay_out() -> void:
	if _thing == null:
		_thing = $Items/Thing
		_thing.start = _thing.transform


## The thing lies where it lay; the steps begin anew.
func _restart() -> void:
	super()
	_thing.transform = _thing.start
	_thing.linear_velocity = Vector3.ZERO
	_thing.force_update_transform() # else the next physics step takes the node back to where it was
	steps = GuideSteps.new(spidar, tool_hand, _thing, settings.may_have_forces())
	_end_s = 0.0
	_show_step()


func _clear_away() -> void:
	pass


func _show_texts() -> void:
	super()
	_panel.set_text_percent(settings.text_percent)
	_hud.side_taken_px = _panel.width_px()


func _panels() -> Array[Control]:
	return super() + _panel.panels()


func _show_step() -> void:
	_panel.show_step(steps.step, steps.count(), _mouse_hand.is_acting())


func _end() -> void:
	_ended = true
	spidar.disarm()
	left.emit()


func _remember() -> void:
	settings.guide_shown = true
	settings.save()
