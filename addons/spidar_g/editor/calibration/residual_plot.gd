@tool
extends Control
## Draws the residuals of each string length before and after the calibration: two bars for each string, on a logarithmic
## scale.

const LOW_M: float = 1e-6
const HIGH_M: float = 0.1
const FONT_SIZE: int = 11
const LEFT: float = 46.0
const BOTTOM: float = 18.0
const TOP: float = 18.0
const BEFORE: Color = Color(0.90, 0.55, 0.25)
const AFTER: Color = Color(0.35, 0.75, 0.50)
const LINES: Dictionary[float, String] = {1e-5: "0.01", 1e-4: "0.1", 1e-3: "1", 1e-2: "10"}

var _before_m: PackedFloat64Array = []
var _after_m: PackedFloat64Array = []


func _init() -> void:
	custom_minimum_size = Vector2(220, 150)


## Shows the residuals of the strings, in meters. NAN means that no pose fits, and an empty array means that there is nothing
## to show.
func show_residuals(before_m: PackedFloat64Array, after_m: PackedFloat64Array) -> void:
	_before_m = before_m
	_after_m = after_m
	queue_redraw()


## Returns the height of the bar for `value_m` as a share of the plot, from 0 to 1. NAN gives the full height.
static func height_of(value_m: float) -> float:
	if is_nan(value_m):
		return 1.0
	return clampf(log(maxf(value_m, LOW_M) / LOW_M) / log(HIGH_M / LOW_M), 0.0, 1.0)


func _draw() -> void:
	var font: Font = get_theme_default_font()
	var text: Color = get_theme_color("font_color", "Label")
	var area: Rect2 = Rect2(LEFT, TOP, size.x - LEFT - 4.0, size.y - TOP - BOTTOM)
	draw_string(font, Vector2(0, 12), "mm", HORIZONTAL_ALIGNMENT_LEFT, -1, FONT_SIZE, text)
	for line_m: float in LINES:
		var y: float = area.end.y - area.size.y * height_of(line_m)
		draw_line(Vector2(area.position.x, y), Vector2(area.end.x, y), Color(text, 0.2))
		draw_string(font, Vector2(0, y + 4.0), LINES[line_m], HORIZONTAL_ALIGNMENT_RIGHT, LEFT - 6.0, FONT_SIZE, text)
	draw_string(font, Vector2(LEFT, 12), "before", HORIZONTAL_ALIGNMENT_LEFT, -1, FONT_SIZE, BEFORE)
	draw_string(font, Vector2(LEFT + 48.0, 12), "after", HORIZONTAL_ALIGNMENT_LEFT, -1, FONT_SIZE, AFTER)
	var width: float = area.size.x / 8.0
	for string: int in 8:
		var x: float = area.position.x + width * string
		draw_string(
			font, Vector2(x, size.y - 4.0), str(string + 1), HORIZONTAL_ALIGNMENT_CENTER, width, FONT_SIZE, text
		)
		_draw_bar(area, x + 0.12 * width, 0.36 * width, _before_m, string, BEFORE)
		_draw_bar(area, x + 0.52 * width, 0.36 * width, _after_m, string, AFTER)


func _draw_bar(area: Rect2, x: float, width: float, values: PackedFloat64Array, string: int, colour: Color) -> void:
	if string >= values.size():
		return
	var height: float = area.size.y * height_of(values[string])
	draw_rect(Rect2(x, area.end.y - height, width, height), colour)
