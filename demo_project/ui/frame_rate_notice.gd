extends PanelContainer
## Says so when few frames are drawn, and offers the one setting that helps: the plain picture.

const KeyNames := preload("res://ui/key_names.gd")

## The user has chosen the plain picture.
signal plain_wanted

## Fewer frames a second than this are low.
const LOW_HZ := 30.0
## The rate has to be low for this long before the notice comes, and not low for this long before it goes.
const PATIENCE_S := 2.0
## The rate is the mean over so long a time.
const MEAN_S := 0.5
## A longer frame counts as one of this length: a scene that loads is not a low rate.
const LONGEST_FRAME_S := 0.25
const WIDTH_PX := 600.0

## Whether the plain picture is on already.
var is_plain := false
var rate_hz := 0.0

var _frames := 0
var _time_s := 0.0
var _low_s := 0.0
var _fine_s := 0.0

@onready var _text: Label = $Rows/Text
@onready var _button: Button = $Rows/Plain


func _ready() -> void:
	_button.pressed.connect(_choose_plain)


## most_px: the width that the text may have.
func limit_width(most_px: float) -> void:
	_text.custom_minimum_size.x = minf(WIDTH_PX, most_px)


## Counts one drawn frame that took delta_s.
func note_frame(delta_s: float) -> void:
	_frames += 1
	_time_s += minf(delta_s, LONGEST_FRAME_S)
	if _time_s < MEAN_S:
		return
	rate_hz = _frames / _time_s
	var low := rate_hz < LOW_HZ
	_low_s = _low_s + _time_s if low else 0.0
	_fine_s = 0.0 if low else _fine_s + _time_s
	_frames = 0
	_time_s = 0.0
	if _low_s >= PATIENCE_S:
		_show_rate()
	elif _fine_s >= PATIENCE_S:
		visible = false


func _process(delta: float) -> void:
	note_frame(delta)


func _show_rate() -> void:
	_text.text = tr("RATE_LOW_PLAIN" if is_plain else "RATE_LOW") % roundi(rate_hz)
	_button.text = KeyNames.fill(tr("RATE_BUTTON"))
	_button.visible = not is_plain
	visible = true


func _unhandled_key_input(event: InputEvent) -> void:
	if visible and not is_plain and event.is_action_pressed(&"demo_plain"):
		_choose_plain()


func _choose_plain() -> void:
	visible = false
	_low_s = 0.0
	plain_wanted.emit()
