extends PanelContainer
## The keys, on screen.

const DemoPalette := preload("res://scene/demo_palette.gd")

const KEYS: Dictionary[String, String] = {
	"Mouse": "moves the grip in the view plane",
	"Wheel": "moves it in depth",
	"Right button + drag": "turns it",
	"Left button": "closes the grasp while held",
	"Middle button + drag": "looks round",
	"W A S D, Q E": "move the grip, down and up",
	"Arrows, Page Up/Down": "turn the grip",
	"F": "forces on and off",
	"Space": "panic stop: forces off at once",
	"R": "starts again, same layout",
	"Tab": "display: off, short, full",
	"H": "this help",
	"C": "clutch: the hand moves, the grip stays",
	"L": "records the run, for a replay",
	"P, O": "pause, single step",
	"Esc": "back to the menu; there: quits",
}


func _ready() -> void:
	var grid: GridContainer = $Rows/Grid
	for key in KEYS:
		_add(grid, key, DemoPalette.ACCENT)
		_add(grid, KEYS[key], DemoPalette.TEXT)


func _add(grid: GridContainer, text: String, colour: Color) -> void:
	var label := Label.new()
	label.text = text
	label.add_theme_color_override("font_color", colour)
	label.add_theme_font_size_override("font_size", 15)
	grid.add_child(label)
