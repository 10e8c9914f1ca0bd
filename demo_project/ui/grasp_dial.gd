@tool
extends Control
## Grasp angle as a dial: 0 at the left, open; the band is where the device counts as grasping.

const DemoPalette := preload("res://scene/demo_palette.gd")

const SHOWN_DEG := 60.0
const WIDTH := 11.0
const TICK_DEG: PackedInt32Array = [0, 20, 50]

var angle_rad := 0.0
var band_from_rad := deg_to_rad(20.0)
var band_to_rad := deg_to_rad(50.0)
var inside := false
var caption := ""


func show_grasp(angle: float, gap_m: float, grasped: bool) -> void:
	angle_rad = angle
	inside = grasped
	caption = "gap %.0f mm" % (maxf(gap_m, 0.0) * 1000.0)
	queue_redraw()


func _draw() -> void:
	var font := get_theme_default_font()
	var centre := Vector2(size.x * 0.5, size.y - 32.0)
	var radius := minf(size.x * 0.5 - 18.0, size.y - 62.0)
	draw_string(
		font, Vector2(0, 13), "Grasp angle", HORIZONTAL_ALIGNMENT_LEFT, -1, 13,
		DemoPalette.TEXT_SOFT
	)
	draw_arc(centre, radius, PI, TAU, 48, DemoPalette.TRACK, WIDTH)
	var band := DemoPalette.GOOD if inside else Color(DemoPalette.GOOD, 0.45)
	draw_arc(centre, radius, _turn(band_from_rad), _turn(band_to_rad), 32, band, WIDTH)
	for degrees in TICK_DEG:
		var way := Vector2.from_angle(_turn(deg_to_rad(degrees)))
		draw_string(
			font, centre + way * (radius + 15.0) + Vector2(-10, 4), str(degrees),
			HORIZONTAL_ALIGNMENT_CENTER, 20, 11, DemoPalette.TEXT_SOFT
		)
	var needle := Vector2.from_angle(_turn(angle_rad))
	draw_line(centre + needle * radius * 0.15, centre + needle * (radius + 5.0), DemoPalette.TEXT, 3.0, true)
	draw_circle(centre, 4.0, DemoPalette.TEXT)
	draw_string(
		font, Vector2(0, size.y - 6.0), "%.0f deg,  %s" % [rad_to_deg(angle_rad), caption],
		HORIZONTAL_ALIGNMENT_CENTER, size.x, 14, DemoPalette.TEXT
	)


func _turn(angle: float) -> float:
	return PI + clampf(rad_to_deg(angle) / SHOWN_DEG, 0.0, 1.0) * PI
