@tool
extends Control
## Requested against achieved wrench, seven axes: the thin bar is what the game requested, the thick one what the strings
## achieved.

const DemoPalette := preload("res://scene/demo_palette.gd")

## Symbols of the axes; the last one is a word, which is translated.
const NAMES: PackedStringArray = ["Fx", "Fy", "Fz", "Mx", "My", "Mz", "HUD_GRASP_AXIS"]
## At a text size of 100 %.
const SIZE_PX := Vector2(226.0, 176.0)
const HEAD := 26.0
const ROW := 21.0
const NAME_WIDTH := 42.0
const VALUE_WIDTH := 62.0
const BAR_PX := 16.0
const HEADING_PX := 13
const SMALL_PX := 12

var asked := PackedFloat64Array()
var given := PackedFloat64Array()
## Full width of a bar, per axis.
var force_scale_n := 4.0
var moment_scale_nm := 0.2

var _text_scale := 1.0


func _ready() -> void:
	set_text_scale(_text_scale)


## text_scale: 1.0 for a text size of 100 %.
func set_text_scale(text_scale: float) -> void:
	_text_scale = text_scale
	var width := SIZE_PX.x + (NAME_WIDTH + VALUE_WIDTH) * (text_scale - 1.0)
	custom_minimum_size = Vector2(maxf(width, _heading_width()), HEAD * text_scale + 7.0 * _row())
	queue_redraw()


func show_wrenches(asked_: PackedFloat64Array, given_: PackedFloat64Array) -> void:
	asked = asked_
	given = given_
	queue_redraw()


func _draw() -> void:
	var font := get_theme_default_font()
	var small_px := roundi(SMALL_PX * _text_scale)
	var heading_px := roundi(HEADING_PX * _text_scale)
	draw_string(
		font, Vector2(0, heading_px), tr("HUD_WRENCH"), HORIZONTAL_ALIGNMENT_LEFT, -1, heading_px,
		DemoPalette.TEXT_SOFT
	)
	_draw_key(font, tr("HUD_REQUESTED"), DemoPalette.ASKED, _draw_key(font, tr("HUD_ACHIEVED"), DemoPalette.GIVEN, size.x))
	if asked.size() < 7 or given.size() < 7:
		return
	for axis in 7:
		_draw_axis(font, axis, HEAD * _text_scale + axis * _row(), small_px)


func _draw_axis(font: Font, axis: int, top: float, small_px: int) -> void:
	var name_width := NAME_WIDTH * _text_scale
	var value_width := VALUE_WIDTH * _text_scale
	var half := (size.x - name_width - value_width) * 0.5
	var middle := name_width + half
	var bar_top := top + 0.5 * (_row() - BAR_PX)
	var base := top + 0.5 * _row() + 0.36 * small_px
	var full := force_scale_n if axis < 3 else moment_scale_nm
	draw_string(font, Vector2(0, base), tr(NAMES[axis]), HORIZONTAL_ALIGNMENT_LEFT, -1, small_px, DemoPalette.TEXT)
	draw_rect(Rect2(name_width, bar_top + 2, half * 2.0, 13), DemoPalette.TRACK)
	_draw_bar(middle, bar_top + 2, 5.0, asked[axis] / full * half, half, DemoPalette.ASKED)
	_draw_bar(middle, bar_top + 8, 7.0, given[axis] / full * half, half, DemoPalette.GIVEN)
	draw_rect(Rect2(middle - 0.5, bar_top, 1, 17), DemoPalette.TEXT_SOFT)
	# Adding zero turns a rounded -0 into 0.
	var value := (
		"%.2f N" % (snappedf(given[axis], 0.01) + 0.0) if axis < 3
		else "%.0f mNm" % (roundf(given[axis] * 1000.0) + 0.0)
	)
	draw_string(
		font, Vector2(size.x - value_width, base), value, HORIZONTAL_ALIGNMENT_RIGHT, value_width, small_px,
		DemoPalette.TEXT
	)


## Of the heading and the two names beside it.
func _heading_width() -> float:
	var font := get_theme_default_font()
	var width := font.get_string_size(tr("HUD_WRENCH"), HORIZONTAL_ALIGNMENT_LEFT, -1, roundi(HEADING_PX * _text_scale)).x
	for key: String in ["HUD_REQUESTED", "HUD_ACHIEVED"]:
		width += font.get_string_size(tr(key), HORIZONTAL_ALIGNMENT_LEFT, -1, roundi(SMALL_PX * _text_scale)).x
		width += 0.75 * roundi(SMALL_PX * _text_scale) + 12.0
	return width + 8.0


func _row() -> float:
	return maxf(ROW, 17.0 * _text_scale)


func _draw_bar(
	middle: float, top: float, height: float, length: float, limit: float, colour: Color
) -> void:
	var clamped := clampf(length, -limit, limit)
	draw_rect(Rect2(minf(middle, middle + clamped), top, absf(clamped), height), colour)


## One colored square with its name, which ends at `right`. Returns where the next one to its left ends.
func _draw_key(font: Font, text: String, colour: Color, right: float) -> float:
	var font_px := roundi(SMALL_PX * _text_scale)
	var square := 0.75 * font_px
	var left := right - font.get_string_size(text, HORIZONTAL_ALIGNMENT_LEFT, -1, font_px).x - square - 4.0
	draw_rect(Rect2(left, font_px + 1.0 - square, square, square), colour)
	draw_string(font, Vector2(left + square + 4.0, font_px + 1.0), text, HORIZONTAL_ALIGNMENT_LEFT, -1, font_px,
		DemoPalette.TEXT_SOFT)
	return left - 8.0
