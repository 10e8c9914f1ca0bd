@tool
extends PanelContainer
## The keys, on screen.

const DemoPalette := preload("res://scene/demo_palette.gd")
const KeyNames := preload("res://ui/key_names.gd")

## Keys of the input map in braces, or keys of the translation; and what they do.
const KEYS: Dictionary[String, String] = {
	"HELP_MOUSE": "HELP_MOUSE_MOVES",
	"HELP_DRAG_TURN": "HELP_TURNS",
	"{demo_grasp}": "HELP_GRASPS",
	"HELP_DRAG_LOOK": "HELP_LOOKS",
	"{demo_move_away} {demo_move_left} {demo_move_near} {demo_move_right}, {demo_move_down} {demo_move_up}":
		"HELP_MOVE_KEYS",
	"{demo_turn_left}, {demo_turn_right}, {demo_tilt_back}, {demo_tilt_forward}": "HELP_TURN_KEYS",
	"{demo_roll_left}, {demo_roll_right}": "HELP_ROLL_KEYS",
	"{demo_forces}": "HELP_FORCES",
	"{demo_panic}": "HELP_PANIC",
	"{demo_restart}": "HELP_RESTART",
	"{demo_display}": "HELP_DISPLAY",
	"{demo_clutch}": "HELP_CLUTCH",
	"{demo_record}": "HELP_RECORD",
	"{demo_pause}, {demo_step}": "HELP_PAUSE",
	"{demo_help}, {demo_leave}": "HELP_LEAVE",
}


func _ready() -> void:
	var grid: GridContainer = $Rows/Grid
	for keys in KEYS:
		_add(grid, KeyNames.fill(tr(keys)), DemoPalette.ACCENT)
		_add(grid, tr(KEYS[keys]), DemoPalette.TEXT)


func _add(grid: GridContainer, text: String, colour: Color) -> void:
	var label := Label.new()
	label.text = text
	label.add_theme_color_override("font_color", colour)
	label.add_theme_font_size_override("font_size", 15)
	grid.add_child(label)
