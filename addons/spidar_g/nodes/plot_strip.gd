@tool
## Draws curves that run from right to left, with the newest value at the right edge.
extends Control

## The largest number of samples that are kept and drawn for each curve.
const SAMPLES: int = 240
const HEAD_HEIGHT: float = 18.0
const FONT_SIZE: int = 12
const BACKGROUND: Color = Color(0.10, 0.11, 0.13, 0.9)
const GRID: Color = Color(1, 1, 1, 0.12)
const TEXT: Color = Color(0.85, 0.87, 0.90)

## The title that is drawn above the curves.
var title: String = ""
## The lower end of the range of values that is shown, in the unit of the values. The range is extended down to the smallest
## value that is kept.
var least_low: float = 0.0
## The upper end of the range of values that is shown, in the unit of the values. The range is extended up to the largest
## value that is kept.
var least_high: float = 1.0
## Sets the color of each curve. The size of the array is the number of curves. A change removes all samples.
var colours: PackedColorArray = []:
	set(value):
		colours = value
		clear()

var _values: PackedFloat32Array = []
var _count: int = 0
var _next: int = 0


## Removes all samples and redraws the empty strip.
func clear() -> void:
	_values.resize(SAMPLES * colours.size())
	_count = 0
	_next = 0
	queue_redraw()


## Adds one sample: one value for each curve. A value that is not finite becomes 0. Ignored if the number of values is not the
## number of curves.
func add_sample(values: PackedFloat64Array) -> void:
	if values.size() != colours.size() or colours.is_empty():
		return
	for curve: int in values.size():
		_values[_next * colours.size() + curve] = values[curve] if is_finite(values[curve]) else 0.0
	_next = (_next + 1) % SAMPLES
	_count = mini(_count + 1, SAMPLES)
	queue_redraw()


## Returns the number of samples that are drawn, at most [constant SAMPLES].
func get_sample_count() -> int:
	return _count


## Returns the kept values of the curve with the index `curve`, the oldest first.
func get_curve(curve: int) -> PackedFloat32Array:
	var values: PackedFloat32Array = []
	for i: int in _count:
		values.append(_values[_place(i) * colours.size() + curve])
	return values


# Formats a number with three digits, for ranges of some newtons or hundredths of a newton meter.
func _short(value: float) -> String:
	return "%.1f" % value if absf(value) >= 1.0 or is_zero_approx(value) else "%.3f" % value


# Returns the index in the ring of the sample that is `i` after the oldest one.
func _place(i: int) -> int:
	return (_next - _count + i + SAMPLES) % SAMPLES


func _draw() -> void:
	draw_rect(Rect2(Vector2.ZERO, size), BACKGROUND)
	var low: float = least_low
	var high: float = least_high
	for value: float in _values:
		low = minf(low, value)
		high = maxf(high, value)
	var font: Font = get_theme_default_font()
	draw_string(font, Vector2(6, 13), title, HORIZONTAL_ALIGNMENT_LEFT, -1, FONT_SIZE, TEXT)
	draw_string(font, Vector2(0, 13), "%s to %s" % [_short(low), _short(high)], HORIZONTAL_ALIGNMENT_RIGHT,
		size.x - 6, FONT_SIZE, TEXT)
	var area := Rect2(4, HEAD_HEIGHT, size.x - 8, size.y - HEAD_HEIGHT - 4)
	if area.size.y <= 0.0 or area.size.x <= 0.0:
		return
	var scale_y: float = area.size.y / maxf(high - low, 1e-9)
	var zero_y: float = area.end.y + low * scale_y
	draw_line(Vector2(area.position.x, zero_y), Vector2(area.end.x, zero_y), GRID)
	if _count < 2:
		return
	var step: float = area.size.x / (SAMPLES - 1)
	var left: float = area.end.x - step * (_count - 1)
	var points: PackedVector2Array = []
	points.resize(_count)
	for curve: int in colours.size():
		for i: int in _count:
			var value: float = _values[_place(i) * colours.size() + curve]
			points[i] = Vector2(left + step * i, area.end.y - (value - low) * scale_y)
		draw_polyline(points, colours[curve], 1.5, true)
