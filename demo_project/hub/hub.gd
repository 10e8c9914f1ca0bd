extends "res://tasks/base/demo_task.gd"
## The start: three tasks, free play and settings, chosen by mouse, by keyboard, or with the grip itself, which
## touches a knob and closes on it.

const HubKnob := preload("res://hub/hub_knob.gd")
const HubMenu := preload("res://hub/hub_menu.gd")

signal chosen(entry: StringName, level: int)

## A knob counts as touched within this of the grip's centre, and as grasped when squeezed this long.
const TOUCH_M := 0.030
const GRASP_M := 0.016
const GRASP_NM := 0.010
const GRASP_S := 0.15

var _knobs: Array[HubKnob] = []
var _squeezed_s := 0.0
var _was_squeezed := true

@onready var _menu: HubMenu = $Menu


func _ready() -> void:
	super()
	for child in _items.get_children():
		_knobs.append(child as HubKnob)
	_hud.show_mode(Hud.Mode.OFF)
	_hud.help_shown.connect(func(shown: bool) -> void: _menu.visible = not shown)
	_menu.setup(settings)
	_menu.chosen.connect(_on_chosen)
	_menu.applied.connect(_on_applied)
	_show_level()


## The knobs stay where they are.
func _clear_away() -> void:
	pass


func _physics_process(delta: float) -> void:
	super(delta)
	var grip := spidar.get_grip_transform().origin
	var nearest: HubKnob = null
	for knob in _knobs:
		var near := knob.distance_to(grip) < TOUCH_M * spidar.workspace_scale
		knob.show_touched(near)
		if near and (nearest == null or knob.distance_to(grip) < nearest.distance_to(grip)):
			nearest = knob
	var squeezed := tool_hand.get_squeeze_torque() > GRASP_NM
	var on_knob := nearest != null and nearest.distance_to(grip) < GRASP_M * spidar.workspace_scale
	# One choice a squeeze: the fingers have to open before the next.
	_squeezed_s = _squeezed_s + delta if squeezed and on_knob and not _was_squeezed else 0.0
	if not squeezed:
		_was_squeezed = false
	if _squeezed_s >= GRASP_S:
		_was_squeezed = true
		_on_chosen(nearest.entry)


func _on_chosen(entry: StringName) -> void:
	if entry == &"level":
		settings.level = settings.level % PlayArguments.LEVELS + 1
		_show_level()
		return
	settings.save()
	chosen.emit(entry, settings.level)


func _on_applied() -> void:
	settings.save()
	settings.apply(spidar)
	_show_picture()
	_show_texts()
	_show_level()


func _show_texts() -> void:
	super()
	_menu.set_text_percent(settings.text_percent)
	_hud.side_taken_px = _menu.width_px()


func _panels() -> Array[Control]:
	return super() + _menu.panels()


func _show_level() -> void:
	for knob in _knobs:
		if knob.entry == &"level":
			knob.text = tr("LEVEL") % settings.level
	_menu.show_level(settings.level)
