extends "res://tasks/base/demo_task.gd"
## The start: three tasks, free play and settings, chosen by mouse, by keyboard, or with the grip itself, which
## touches a knob and closes on it.

const DemoPalette := preload("res://scene/demo_palette.gd")
const HubKnob := preload("res://hub/hub_knob.gd")
const HubMenu := preload("res://hub/hub_menu.gd")

signal chosen(entry: StringName, level: int)

## A knob counts as touched within this of the grip's centre, and as grasped when squeezed this long.
const TOUCH_M := 0.030
const GRASP_M := 0.016
const GRASP_NM := 0.010
const GRASP_S := 0.15
const PLACES_M: Dictionary[StringName, Vector2] = {
	&"pick_and_place": Vector2(-0.100, -0.070),
	&"robot_linking": Vector2(0.0, -0.070),
	&"match_linking": Vector2(0.100, -0.070),
	&"level": Vector2(-0.060, 0.075),
	&"free_play": Vector2(0.060, 0.075),
}
const COLOURS: Dictionary[StringName, Color] = {
	&"pick_and_place": DemoPalette.CORAL,
	&"robot_linking": DemoPalette.TEAL,
	&"match_linking": DemoPalette.MUSTARD,
	&"level": DemoPalette.PLUM,
	&"free_play": DemoPalette.SAGE,
}

var _knobs: Array[HubKnob] = []
var _squeezed_s := 0.0
var _was_squeezed := true

@onready var _menu: HubMenu = $Menu


func _ready() -> void:
	super()
	_hud.show_mode(Hud.Mode.OFF)
	_menu.setup(settings)
	_menu.chosen.connect(_on_chosen)
	_menu.applied.connect(_on_applied)
	_show_level()


func _lay_out() -> void:
	for entry in PLACES_M:
		var at := PLACES_M[entry]
		var knob := HubKnob.make(entry, COLOURS[entry])
		knob.position = Vector3(at.x, 0.0, at.y)
		_items.add_child(knob)
		_knobs.append(knob)


func _physics_process(delta: float) -> void:
	super(delta)
	var grip := spidar.get_grip_transform().origin
	var nearest: HubKnob = null
	for knob in _knobs:
		var near := knob.distance_to(grip) < TOUCH_M * spidar.workspace_scale
		knob.show_touched(near)
		if near and (nearest == null or knob.distance_to(grip) < nearest.distance_to(grip)):
			nearest = knob
	var squeezed := tool_hand.get_squeeze_torque_nm() > GRASP_NM
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
	PictureQuality.apply(self, settings.picture)
	_show_level()


func _show_level() -> void:
	for knob in _knobs:
		if knob.entry == &"level":
			knob.show_text("Level %d" % settings.level)
	_menu.show_level(settings.level)
