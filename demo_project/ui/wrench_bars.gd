@tool
extends Control
## Asked against given wrench, seven axes: the thin bar is what the game asked for, the thick one what the
## strings could give.

const DemoPalette := preload("res://scene/demo_palette.gd")

const NAMES: PackedStringArray = ["Fx", "Fy", "Fz", "Mx", "My", "Mz", "grasp"]
const HEAD := 26.0
const ROW := 21.0
const NAME_WIDTH := 42.0
const VALUE_WIDTH := 62.0

var asked := PackedFloat64Array()
var given := PackedFloat64Array()
## Full width of a bar, per axis.
var force_scale_n := 4.0
var moment_scale_nm := 0.2


func show_wrenches(asked_: PackedFloat64Array, given_: PackedFloat64Array) -> void:
	asked = asked_
	given = given_
	queue_redraw()


func _draw() -> void:
	var font := get_theme_default_font()
	draw_string(
		font, Vector2(0, 13), "Wrench", HORIZONTAL_ALIGNMENT_LEFT, -1, 13, DemoPalette.TEXT_SOFT
	)
	_draw_key(font, "asked", DemoPalette.ASKED, size.x - 106)
	_draw_key(font, "given", DemoPalette.GIVEN, size.x - 48)
	if asked.size() < 7 or given.size() < 7:
		return
	var half := (size.x - NAME_WIDTH - VALUE_WIDTH) * 0.5
	for axis in 7:
		var top := HEAD + axis * ROW
		var middle := NAME_WIDTH + half
		var full := force_scale_n if axis < 3 else moment_scale_nm
		draw_string(
			font, Vector2(0, top + 13), NAMES[axis], HORIZONTAL_ALIGNMENT_LEFT, -1, 12,
			DemoPalette.TEXT
		)
		draw_rect(Rect2(NAME_WIDTH, top + 2, half * 2.0, 13), DemoPalette.TRACK)
		_draw_bar(middle, top + 2, 5.0, asked[axis] / full * half, half, DemoPalette.ASKED)
		_draw_bar(middle, top + 8, 7.0, given[axis] / full * half, half, DemoPalette.GIVEN)
		draw_rect(Rect2(middle - 0.5, top, 1, 17), DemoPalette.TEXT_SOFT)
		# Adding zero turns a rounded -0 into 0.
		var value := (
			"%.2f N" % (snappedf(given[axis], 0.01) + 0.0) if axis < 3
			else "%.0f mNm" % (roundf(given[axis] * 1000.0) + 0.0)
		)
		draw_string(
			font, Vector2(size.x - VALUE_WIDTH, top + 13), value, HORIZONTAL_ALIGNMENT_RIGHT,
			VALUE_WIDTH, 12, DemoPalette.TEXT
		)


func _draw_bar(
	middle: float, top: float, height: float, length: float, limit: float, colour: Color
) -> void:
	var clamped := clampf(length, -limit, limit)
	draw_rect(Rect2(minf(middle, middle + clamped), top, absf(clamped), height), colour)


func _draw_key(font: Font, text: String, colour: Color, left: float) -> void:
	draw_rect(Rect2(left, 5, 9, 9), colour)
	draw_string(
		font, Vector2(left + 13, 13), text, HORIZONTAL_ALIGNMENT_LEFT, -1, 12,
		DemoPalette.TEXT_SOFT
	)
