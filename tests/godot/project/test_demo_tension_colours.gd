## The colors of string tension are told apart by people with deuteranopia and protanopia: what their eyes see of the colors
## is computed, and the distances between them are measured in CIELAB.
extends "res://test_case.gd"

const View := preload("res://addons/spidar_g/nodes/spidar_g_view.gd")

## Smallest distance (CIELAB, 1976) between two of the four steps. 2.3 is just noticeable side by side; strings are thin and
## lie far apart, hence 15 times that.
const MINIMUM_DISTANCE := 35.0
## Smallest distance from a step to the color of a slack string, whose bar in the demo is empty as well.
const MINIMUM_TO_SLACK := 25.0
## Linear RGB to linear RGB as seen: Machado, Oliveira and Fernandes 2009, severity 1.0. Rows.
const SEEN: Dictionary[String, Array] = {
	"full color vision": [Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)],
	"protanopia": [
		Vector3(0.152286, 1.052583, -0.204868), Vector3(0.114503, 0.786281, 0.099216), Vector3(-0.003882, -0.048116, 1.051998),
	],
	"deuteranopia": [
		Vector3(0.367322, 0.860646, -0.227968), Vector3(0.280085, 0.672501, 0.047413), Vector3(-0.011820, 0.042940, 0.968881),
	],
}


func test_the_steps_of_tension_look_different_to_color_blind_people() -> void:
	var steps: Array[Color] = [View.LOW_COLOUR]
	for part: int in [1, 2, 3]:
		# tension_colour() has its steps at thirds of the square root.
		steps.append(View.tension_colour(10.0 * part * part / 9.0, 10.0))
	for eyes: String in SEEN:
		for one: int in steps.size():
			for other: int in one:
				var distance: float = _seen(eyes, steps[one]).distance_to(_seen(eyes, steps[other]))
				check(distance >= MINIMUM_DISTANCE, "%s: steps %d and %d are %.1f apart" % [eyes, other, one, distance])
			var slack: float = _seen(eyes, steps[one]).distance_to(_seen(eyes, View.SLACK_COLOUR))
			check(slack >= MINIMUM_TO_SLACK, "%s: step %d is %.1f from slack" % [eyes, one, slack])


func test_the_measure_finds_the_palette_from_green_to_red_wanting() -> void:
	var green := Color(0.10, 0.70, 0.45)
	var red := Color(0.95, 0.18, 0.15)
	var distance: float = _seen("protanopia", green).distance_to(_seen("protanopia", red))
	check(distance < MINIMUM_DISTANCE, "green and red are %.1f apart to a protanope" % distance)
	check(_seen("full color vision", green).distance_to(_seen("full color vision", red)) > 100.0, "but not to others")


func test_the_measure_knows_white_and_black() -> void:
	check_near(_seen("full color vision", Color.WHITE).x, 100.0, 0.01, "lightness of white")
	check_near(_seen("full color vision", Color.BLACK).x, 0.0, 0.01, "lightness of black")
	check_near(_seen("deuteranopia", Color.WHITE).distance_to(_seen("full color vision", Color.WHITE)), 0.0, 0.1, "white stays white")


## CIELAB (D65) of the color as such eyes see it: x lightness, y and z the color.
func _seen(eyes: String, color: Color) -> Vector3:
	var linear: Color = color.srgb_to_linear()
	var rgb := Vector3(linear.r, linear.g, linear.b)
	var rows: Array = SEEN[eyes]
	rgb = Vector3((rows[0] as Vector3).dot(rgb), (rows[1] as Vector3).dot(rgb), (rows[2] as Vector3).dot(rgb))
	rgb = rgb.clamp(Vector3.ZERO, Vector3.ONE)
	var x: float = _bent(Vector3(0.4124564, 0.3575761, 0.1804375).dot(rgb) / 0.95047)
	var y: float = _bent(Vector3(0.2126729, 0.7151522, 0.0721750).dot(rgb))
	var z: float = _bent(Vector3(0.0193339, 0.1191920, 0.9503041).dot(rgb) / 1.08883)
	return Vector3(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))


func _bent(value: float) -> float:
	return pow(value, 1.0 / 3.0) if value > 0.008856 else 7.787 * value + 16.0 / 116.0
