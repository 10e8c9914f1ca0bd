@tool
extends Control
## Grasp angle as a dial: 0 at the left, open; the band is where the device counts as grasping.

const DemoPalette := preload("res://scene/demo_palette.gd")

const SHOWN_DEG := 60.0
const WIDTH := 11.0
## At a text size of 100 %.
const SIZE_PX := Vector2(198.0, 160.0)
const TICK_DEG: PackedInt32Array = [0, 20, 50]

var angle_rad := 0.0
var band_from_rad := deg_to_rad(20.0)
var band_to_rad := deg_to_rad(50.0)
var inside := false
var caption := ""

var _text_scale := 1.0


func _ready() -> void:
	set_text_scale(_text_scale)


## text_scale: 1.0 for a text size of 100 %.
func set_text_scale(text_scale: float) -> void:
	_text_scale = text_scale
	custom_minimum_size = SIZE_PX + Vector2(90.0, 50.0) * (text_scale - 1.0)
	queue_redraw()


func show_grasp(angle: float, gap_m: float, grasped: bool) -> void:
	angle_rad = angle
	inside = grasped
	caption = tr("HUD_GAP") % (maxf(gap_m, 0.0) * 1000.0)
	queue_redraw()


func _draw() -> void:
	var font := get_theme_default_font()
	var heading_px := roundi(13 * _text_scale)
	var tick_px := roundi(11 * _text_scale)
	var center := Vector2(size.x * 0.5, size.y - 32.0 * _text_scale)
	var radius := minf(size.x * 0.5 - 18.0 * _text_scale, center.y - 30.0 * _text_scale)
	draw_string(
		font, Vector2(0, heading_px), tr("HUD_GRASP_ANGLE"), HORIZONTAL_ALIGNMENT_LEFT, -1, heading_px,
		DemoPalette.TEXT_SOFT
	)
	draw_arc(center, radius, PI, TAU, 48, DemoPalette.TRACK, WIDTH)
	var band := DemoPalette.GOOD if inside else Color(DemoPalette.GOOD, 0.45)
	draw_arc(center, radius, _turn(band_from_rad), _turn(band_to_rad), 32, band, WIDTH)
	for degrees in TICK_DEG:
		var way := Vector2.from_angle(_turn(deg_to_rad(degrees)))
		draw_string(
			font, center + way * (radius + 4.0 + tick_px) + Vector2(-tick_px, 0.36 * tick_px), str(degrees),
			HORIZONTAL_ALIGNMENT_CENTER, 2 * tick_px, tick_px, DemoPalette.TEXT_SOFT
		)
	var needle := Vector2.from_angle(_turn(angle_rad))
	draw_line(center + needle * radius * 0.15, center + needle * (radius + 5.0), DemoPalette.TEXT, 3.0, true)
	draw_circle(center, 4.0, DemoPalette.TEXT)
	draw_string(
		font, Vector2(0, size.y - 6.0), "%.0f°,  %s" % [rad_to_deg(angle_rad), caption],
		HORIZONTAL_ALIGNMENT_CENTER, size.x, roundi(14 * _text_scale), DemoPalette.TEXT
	)


func _turn(angle: float) -> float:
	return PI + clampf(rad_to_deg(angle) / SHOWN_DEG, 0.0, 1.0) * PI
