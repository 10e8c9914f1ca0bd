@tool
extends PanelContainer
## The keys, on screen.

const DemoPalette := preload("res://scene/demo_palette.gd")
const KeyNames := preload("res://ui/key_names.gd")

## Keys or motions, and what they do.
const KEYS: Dictionary[String, String] = {
	"Mouse": "moves the grip in the view plane",
	"Wheel": "moves it in depth",
	"{demo_drag_turn} + drag": "turns it",
	"{demo_grasp}": "closes the grasp while held",
	"{demo_look_round} + drag": "looks round",
	"{demo_move_away} {demo_move_left} {demo_move_near} {demo_move_right}, {demo_move_down} {demo_move_up}":
		"move the grip, down and up",
	"{demo_turn_left}, {demo_turn_right}, {demo_tilt_back}, {demo_tilt_forward}": "turn and tilt the grip",
	"{demo_roll_left}, {demo_roll_right}": "roll it",
	"{demo_forces}": "forces on and off",
	"{demo_panic}": "panic stop: forces off at once",
	"{demo_restart}": "starts again, same layout",
	"{demo_display}": "display: off, short, full",
	"{demo_help}": "this help",
	"{demo_clutch}": "clutch: the hand moves, the grip stays",
	"{demo_record}": "records the run, for a replay",
	"{demo_pause}, {demo_step}": "pause, single step",
	"{demo_leave}": "back to the menu; there: quits",
}


func _ready() -> void:
	var grid: GridContainer = $Rows/Grid
	for keys in KEYS:
		_add(grid, KeyNames.fill(keys), DemoPalette.ACCENT)
		_add(grid, KEYS[keys], DemoPalette.TEXT)


func _add(grid: GridContainer, text: String, colour: Color) -> void:
	var label := Label.new()
	label.text = text
	label.add_theme_color_override("font_color", colour)
	label.add_theme_font_size_override("font_size", 15)
	grid.add_child(label)
