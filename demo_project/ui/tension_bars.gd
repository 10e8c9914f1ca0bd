@tool
extends Control
## Eight bars, one for each string from 1 to 8: its tension in newtons, in the color that the string has in the scene.

const DemoPalette := preload("res://scene/demo_palette.gd")

## At a text size of 100 %.
const SIZE_PX := Vector2(226.0, 156.0)
const GAP_SHARE := 0.33
const HEADING_PX := 13
const SMALL_PX := 12

var tensions_n := PackedFloat64Array()
var limit_n := 10.0

var _text_scale := 1.0


func _ready() -> void:
	set_text_scale(_text_scale)


## text_scale: 1.0 for a text size of 100 %.
func set_text_scale(text_scale: float) -> void:
	_text_scale = text_scale
	custom_minimum_size = Vector2(SIZE_PX.x * (0.5 + 0.5 * text_scale), SIZE_PX.y + 36.0 * (text_scale - 1.0))
	queue_redraw()


func show_tensions(tensions: PackedFloat64Array, limit: float) -> void:
	tensions_n = tensions
	limit_n = maxf(limit, 0.1)
	queue_redraw()


func _draw() -> void:
	var font := get_theme_default_font()
	var small_px := roundi(SMALL_PX * _text_scale)
	var heading_px := roundi(HEADING_PX * _text_scale)
	var head := 22.0 * _text_scale
	var height := size.y - head - 16.0 * _text_scale
	draw_string(
		font, Vector2(0, heading_px), tr("HUD_TENSION"), HORIZONTAL_ALIGNMENT_LEFT, -1, heading_px,
		DemoPalette.TEXT_SOFT
	)
	draw_string(
		font, Vector2(0, heading_px), "0 - %.0f N" % limit_n, HORIZONTAL_ALIGNMENT_RIGHT, size.x, small_px,
		DemoPalette.TEXT_SOFT
	)
	var step := size.x / maxi(tensions_n.size(), 1)
	var width := step * (1.0 - GAP_SHARE)
	for index in tensions_n.size():
		var left := index * step
		var filled := height * clampf(tensions_n[index] / limit_n, 0.0, 1.0)
		draw_rect(Rect2(left, head, width, height), DemoPalette.TRACK)
		draw_rect(
			Rect2(left, head + height - filled, width, filled),
			SpidarGView.tension_colour(tensions_n[index], limit_n)
		)
		draw_string(
			font, Vector2(left, size.y - 2), str(index + 1), HORIZONTAL_ALIGNMENT_CENTER, width, small_px,
			DemoPalette.TEXT_SOFT
		)
