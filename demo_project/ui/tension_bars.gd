@tool
extends Control
## Eight bars, one a string: pull in newtons, coloured as the strings in the scene are.

const DemoPalette := preload("res://scene/demo_palette.gd")

const BAR_WIDTH := 18.0
const GAP := 9.0
const LABEL_HEIGHT := 16.0
const HEAD := 22.0

var tensions_n := PackedFloat64Array()
var limit_n := 10.0


func show_tensions(tensions: PackedFloat64Array, limit: float) -> void:
	tensions_n = tensions
	limit_n = maxf(limit, 0.1)
	queue_redraw()


func _draw() -> void:
	var font := get_theme_default_font()
	var height := size.y - HEAD - LABEL_HEIGHT
	draw_string(
		font, Vector2(0, 13), "String tension", HORIZONTAL_ALIGNMENT_LEFT, -1, 13,
		DemoPalette.TEXT_SOFT
	)
	draw_string(
		font, Vector2(0, 13), "0 - %.0f N" % limit_n, HORIZONTAL_ALIGNMENT_RIGHT, size.x, 12,
		DemoPalette.TEXT_SOFT
	)
	for index in tensions_n.size():
		var left := index * (BAR_WIDTH + GAP)
		var fraction := clampf(tensions_n[index] / limit_n, 0.0, 1.0)
		draw_rect(Rect2(left, HEAD, BAR_WIDTH, height), DemoPalette.TRACK)
		var filled := height * fraction
		draw_rect(
			Rect2(left, HEAD + height - filled, BAR_WIDTH, filled),
			SpidarGView.tension_colour(tensions_n[index], limit_n)
		)
		draw_string(
			font, Vector2(left, size.y - 2), str(index), HORIZONTAL_ALIGNMENT_CENTER, BAR_WIDTH,
			12, DemoPalette.TEXT_SOFT
		)
