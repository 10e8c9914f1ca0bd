extends CanvasLayer
## What a haptics person wants in sight: task and time, device state and servo rate, tensions, the wrench requested and the
## wrench achieved, grasp angle. Three modes: off, short, full.

const DemoPalette := preload("res://scene/demo_palette.gd")
const FrameRateNotice := preload("res://ui/frame_rate_notice.gd")
const GraspDial := preload("res://ui/grasp_dial.gd")
const KeyNames := preload("res://ui/key_names.gd")
const TaskBody := preload("res://scene/task_body.gd")
const TextSize := preload("res://ui/text_size.gd")
const TensionBars := preload("res://ui/tension_bars.gd")
const WrenchBars := preload("res://ui/wrench_bars.gd")

## The help is shown, or hidden again.
signal help_shown(shown: bool)

enum Mode { OFF, SHORT, FULL }

## Keys of the translation, in the order of SpidarG.State.
const STATE_NAMES: PackedStringArray = [
	"STATE_CLOSED", "STATE_CONNECTED", "STATE_ARMING", "STATE_ACTIVE", "STATE_FADING", "STATE_FAULT", "STATE_TAUT",
	"STATE_CALIBRATED",
]
const HINT_FORCES_OFF := "HINT_FORCES_OFF"
const HINT_ON := "HINT_ON"
## Between panels, and between a panel and the edge of the screen.
const MARGIN_PX := 20.0
## At a text size of 100 %; larger text makes the left column wider by the second number for each further 100 %.
const LEFT_WIDTH_PX := Vector2(284.0, 76.0)
const HELP_WIDTH_PX := 560.0

## Numbers that change faster are not read, and every new text is laid out anew.
const REFRESH_S := 0.05

@export var mode := Mode.FULL

## Whether the hints about keys stay away. Notices, faults and results are shown all the same.
var without_hints := false
## Width that another panel takes at a side of the screen; the hint keeps clear of it.
var side_taken_px := 0.0

var _shown_for_s := INF
var _spidar: SpidarG
var _tool_hand: SpidarGHand
var _notice := ""
var _result := ""
## As _hint_text() returned it last.
var _hint_shown := ""
var _text_percent := 100

@onready var _title: Label = %Title
@onready var _time: Label = %Time
@onready var _placed: Label = %Placed
@onready var _device: PanelContainer = %Device
@onready var _state: Label = %State
@onready var _dot: ColorRect = %Dot
@onready var _servo: Label = %Servo
@onready var _held: Label = %Held
@onready var _tensions: TensionBars = %Tensions
@onready var _wrench: WrenchBars = %Wrench
@onready var _dial: GraspDial = %Dial
@onready var _bars_panel: PanelContainer = %BarsPanel
@onready var _wrench_panel: PanelContainer = %WrenchPanel
@onready var _hint: Label = %Hint
@onready var _hint_panel: PanelContainer = %HintPanel
@onready var _help: Control = %Help


func setup(spidar: SpidarG, tool_hand: SpidarGHand, goal: String) -> void:
	_spidar = spidar
	_tool_hand = tool_hand
	(%Help.get_node(^"Rows/Heading") as Label).text = tr(goal)
	($Screen as Control).resized.connect(_fit)
	process_mode = Node.PROCESS_MODE_ALWAYS # A pause has to be told, too.
	if spidar.config != null:
		_dial.band_from_rad = spidar.config.grasp_enter_angle
		_dial.band_to_rad = spidar.config.over_closed_leave_angle
	_apply_mode()


## percent: one of TextSize.CHOICES_PERCENT.
func set_text_percent(percent: int) -> void:
	_text_percent = percent
	TextSize.apply($Screen, percent)
	(%Task as Control).custom_minimum_size.x = LEFT_WIDTH_PX.x + LEFT_WIDTH_PX.y * (percent / 100.0 - 1.0)
	($Screen/Help/Rows/Heading as Control).custom_minimum_size.x = HELP_WIDTH_PX * (0.4 + 0.6 * percent / 100.0)
	_fit()


## The panels that are on the screen now.
func panels() -> Array[Control]:
	var shown: Array[Control] = []
	for panel: Control in [%Task, %DialPanel, _device, _bars_panel, _wrench_panel, _hint_panel, %FrameRate, _help]:
		if panel.is_visible_in_tree():
			shown.append(panel)
	return shown


func next_mode() -> void:
	show_mode(((mode + 1) % Mode.size()) as Mode)


func show_mode(mode_: Mode) -> void:
	mode = mode_
	_apply_mode()


func is_help_shown() -> bool:
	return _help.visible


## The help takes the place of all other panels.
func toggle_help() -> void:
	_help.visible = not _help.visible
	for column: Control in [%Left, %Right]:
		column.visible = not _help.visible
	(%Bottom as Control).visible = not _help.visible
	help_shown.emit(_help.visible)


func show_notice(text: String) -> void:
	_notice = text
	_shown_for_s = INF


func show_result(text: String) -> void:
	_result = text
	_shown_for_s = INF


func show_task(
	title: String, time_s: float, placed: int, bodies: Array[TaskBody], level: int, seed_number: int
) -> void:
	if mode == Mode.OFF:
		return
	_title.text = tr("HUD_TASK") % [tr(title), level, seed_number]
	_time.text = "%d:%04.1f" % [floori(time_s / 60.0), fmod(time_s, 60.0)]
	if bodies.is_empty():
		_placed.text = tr("HUD_PLACED") % [placed, 0]
		return
	_placed.text = tr("HUD_PLACED_WITHIN") % [
		placed, bodies.size(), 1000.0 * bodies[0].position_tolerance_m, rad_to_deg(bodies[0].rotation_tolerance_rad)
	]


## Where nothing is timed or placed.
func show_free(title: String) -> void:
	_title.text = tr(title)
	_time.visible = false
	_placed.visible = false
	_fit()


func _process(delta: float) -> void:
	_shown_for_s += delta
	if _shown_for_s < REFRESH_S:
		return
	_shown_for_s = 0.0
	if _spidar == null:
		_hint_panel.visible = false
		return
	if mode == Mode.OFF:
		_hint_panel.visible = _has_news()
		_show_hint()
		return
	_hint_panel.visible = true
	_show_hint()
	_state.text = tr(STATE_NAMES[_spidar.get_state()])
	_dot.color = _state_colour()
	var statistics := _spidar.get_statistics()
	_servo.text = tr("HUD_SERVO") % float(statistics.get("servo_rate_hz", 0.0))
	var held := _tool_hand.get_held_body()
	_held.text = tr("HUD_EMPTY") if held == null else (
		tr("HUD_HELD") % [roundi(held.mass * 1000.0), roundi(_tool_hand.get_held_width() * 1000.0)]
	)
	_dial.show_grasp(
		_spidar.get_grasp_angle(), _spidar.get_jaw_gap() * _spidar.workspace_scale,
		_spidar.get_grasp_phase() == SpidarG.GRASP_GRASPED
	)
	if mode == Mode.FULL:
		var limit := 10.0 if _spidar.config == null else float(_spidar.config.tension_max)
		_tensions.show_tensions(_spidar.get_string_tensions(), limit)
		_wrench.show_wrenches(_spidar.get_requested_wrench(), _spidar.get_achieved_wrench())


func _apply_mode() -> void:
	_shown_for_s = INF
	_fit.call_deferred()
	for panel: Control in [%Task, _device, %DialPanel]:
		panel.visible = mode != Mode.OFF
	for panel: Control in [_bars_panel, _wrench_panel]:
		panel.visible = mode == Mode.FULL


## Whether there is something to say although the display is off.
func _has_news() -> bool:
	var text := _hint_text()
	return text != HINT_ON and not (without_hints and text == HINT_FORCES_OFF)


## Actions in braces become their keys, and only when the text has changed.
func _show_hint() -> void:
	var text := _hint_text()
	if text != _hint_shown:
		_hint_shown = text
		_hint.text = KeyNames.fill(tr(text))
		_fit()


## Makes hint and notice as wide as the space between the columns lets them be.
func _fit() -> void:
	var side := side_taken_px
	if mode != Mode.OFF:
		side = maxf((%Left as Control).get_combined_minimum_size().x, (%Right as Control).get_combined_minimum_size().x)
	var frame := _hint_panel.get_theme_stylebox(&"panel").get_minimum_size().x
	var most := ($Screen as Control).size.x - 2.0 * (MARGIN_PX + side + (MARGIN_PX if side > 0.0 else 0.0)) - frame
	(%FrameRate as FrameRateNotice).limit_width(most)
	var font := _hint.get_theme_font(&"font")
	var font_px := _hint.get_theme_font_size(&"font_size")
	var one_line := font.get_string_size(_hint.text, HORIZONTAL_ALIGNMENT_LEFT, -1, font_px).x
	_hint.custom_minimum_size.x = minf(ceilf(one_line) + 1.0, most)


func _hint_text() -> String:
	if _result != "":
		return _result
	if _spidar.get_state() == SpidarG.STATE_FAULT:
		return tr("HINT_FAULT") % _spidar.get_fault_text()
	if get_tree().paused and _notice != "":
		return _notice
	if _spidar.is_recording():
		return "HINT_RECORDING"
	if not _spidar.forces_enabled:
		return _notice if _notice != "" else HINT_FORCES_OFF
	return HINT_ON


func _state_colour() -> Color:
	match _spidar.get_state():
		SpidarG.STATE_ACTIVE:
			return DemoPalette.GOOD
		SpidarG.STATE_FAULT:
			return DemoPalette.BAD
		SpidarG.STATE_ARMING, SpidarG.STATE_FADING:
			return DemoPalette.ACCENT
	return DemoPalette.TEXT_SOFT
