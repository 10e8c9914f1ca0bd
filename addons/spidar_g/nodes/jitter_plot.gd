@tool
## Draws a histogram of how late the servo thread woke up. Both scales are logarithmic. Two bars cover each doubling of the
## lateness.
extends Control

const PlotStrip := preload("plot_strip.gd")

const BAR_COLOUR: Color = Color(0.30, 0.62, 0.95)
const LATE_COLOUR: Color = Color(0.95, 0.55, 0.15)
## Bars that begin at this lateness or later, in microseconds, are drawn in LATE_COLOUR.
const LATE_US: float = 500.0
## The first bar covers this lateness, in microseconds. Wake-ups that were less late are added to this bar.
const FIRST_US: float = 1.0
## The last bar begins at about this lateness, in microseconds. Wake-ups that were later are added to this bar.
const LAST_US: float = 20000.0

## Half the width of a bar, in decades of the lateness. A bar that begins less than this from a power of ten gets its label.
const HALF_BAR_DECADES: float = 0.0753

## The counts of [method SpidarG.get_lateness_histogram]: bucket i counts the wake-ups that were 2^(i/2) to 2^((i+1)/2) ns
## late.
var counts: PackedInt32Array = []


## Shows other counts, in the form of [method SpidarG.get_lateness_histogram].
func show_counts(new_counts: PackedInt32Array) -> void:
	if counts == new_counts:
		return
	counts = new_counts
	queue_redraw()


## Returns the smallest lateness that the bucket with this index counts, in microseconds.
static func bucket_begin_us(bucket: int) -> float:
	return pow(2.0, 0.5 * bucket) * 1e-3


## Returns the counts of the bars that are shown. Counts of buckets outside their range are added to the first or the last
## bar.
func bars() -> PackedInt32Array:
	var first: int = int(floor(2.0 * log(FIRST_US * 1000.0) / log(2.0)))
	var last: int = int(ceil(2.0 * log(LAST_US * 1000.0) / log(2.0)))
	var shown: PackedInt32Array = []
	shown.resize(last - first + 1)
	for bucket: int in counts.size():
		shown[clampi(bucket, first, last) - first] += counts[bucket]
	return shown


func _draw() -> void:
	draw_rect(Rect2(Vector2.ZERO, size), PlotStrip.BACKGROUND)
	var font: Font = get_theme_default_font()
	draw_string(font, Vector2(6, 13), "Wake-up after the deadline, us", HORIZONTAL_ALIGNMENT_LEFT, -1,
		PlotStrip.FONT_SIZE, PlotStrip.TEXT)
	var shown: PackedInt32Array = bars()
	var total: int = 0
	var most: int = 1
	for count: int in shown:
		total += count
		most = maxi(most, count)
	if total == 0:
		draw_string(font, Vector2(0, 13), "no thread", HORIZONTAL_ALIGNMENT_RIGHT, size.x - 6,
			PlotStrip.FONT_SIZE, PlotStrip.TEXT)
		return
	var first: int = int(floor(2.0 * log(FIRST_US * 1000.0) / log(2.0)))
	var area := Rect2(4, PlotStrip.HEAD_HEIGHT, size.x - 8, size.y - PlotStrip.HEAD_HEIGHT - 16)
	var width: float = area.size.x / shown.size()
	# The bar of a single wake-up has a tenth of the full height.
	var decades: float = maxf(1.0, log(float(most)) / log(10.0))
	for i: int in shown.size():
		var begin_us: float = bucket_begin_us(first + i)
		if shown[i] > 0:
			var part: float = 0.1 + 0.9 * (log(float(shown[i])) / log(10.0)) / decades
			var height: float = clampf(part, 0.0, 1.0) * area.size.y
			draw_rect(Rect2(area.position.x + i * width, area.end.y - height, width - 1.0, height),
				LATE_COLOUR if begin_us >= LATE_US else BAR_COLOUR)
	var placed: Dictionary[String, Vector2] = labels(area)
	for text: String in placed:
		draw_string(font, placed[text], text, HORIZONTAL_ALIGNMENT_LEFT, -1, PlotStrip.FONT_SIZE, PlotStrip.TEXT)


## Returns the labels of the powers of ten, in microseconds, with the position at which each label begins. A label is below
## its bar and within the plot.
func labels(area: Rect2) -> Dictionary[String, Vector2]:
	var font: Font = get_theme_default_font()
	var placed: Dictionary[String, Vector2] = {}
	var first: int = int(floor(2.0 * log(FIRST_US * 1000.0) / log(2.0)))
	var count: int = bars().size()
	for i: int in count:
		var decade: float = log(bucket_begin_us(first + i)) / log(10.0)
		if absf(decade - roundf(decade)) < HALF_BAR_DECADES:
			var text: String = "%d" % int(round(pow(10.0, roundf(decade))))
			var wide: float = font.get_string_size(text, HORIZONTAL_ALIGNMENT_LEFT, -1, PlotStrip.FONT_SIZE).x
			var middle: float = area.position.x + i * area.size.x / count
			placed[text] = Vector2(clampf(middle - 0.5 * wide, 0.0, size.x - wide), size.y - 3)
	return placed
