extends CanvasLayer
## What a haptics person wants in sight: task and time, device state and servo rate, tensions, wrench asked
## and given, grasp angle. Three modes: off, short, full.

const DemoPalette := preload("res://scene/demo_palette.gd")
const GraspDial := preload("res://ui/grasp_dial.gd")
const KeyNames := preload("res://ui/key_names.gd")
const TaskBody := preload("res://scene/task_body.gd")
const TensionBars := preload("res://ui/tension_bars.gd")
const WrenchBars := preload("res://ui/wrench_bars.gd")

enum Mode { OFF, SHORT, FULL }

const HINT_FORCES_OFF := (
	"Forces are off.  {demo_forces}  turns them on (they ramp up while the device arms).   {demo_help}  help"
)
## In the order of SpidarG.State.
const STATE_NAMES: PackedStringArray = [
	"closed", "connected", "arming", "active", "fading", "fault", "taut", "calibrated"
]
const HINT_ON := "{demo_grasp}  closes the grasp    {demo_panic}  stops the forces    {demo_help}  help"

## Numbers that change faster are not read, and every new text is laid out anew.
const REFRESH_S := 0.05

@export var mode := Mode.FULL

var _shown_for_s := INF
var _spidar: SpidarG
var _tool_hand: SpidarGHand
var _notice := ""
var _result := ""
## As _hint_text() gave it last.
var _hint_shown := ""

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
	(%Help.get_node(^"Rows/Heading") as Label).text = goal
	process_mode = Node.PROCESS_MODE_ALWAYS # A pause has to be told, too.
	if spidar.config != null:
		_dial.band_from_rad = spidar.config.grasp_enter_angle
		_dial.band_to_rad = spidar.config.over_closed_leave_angle
	_apply_mode()


func next_mode() -> void:
	show_mode(((mode + 1) % Mode.size()) as Mode)


func show_mode(mode_: Mode) -> void:
	mode = mode_
	_apply_mode()


func toggle_help() -> void:
	_help.visible = not _help.visible


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
	_title.text = "%s   level %d   seed %d" % [title, level, seed_number]
	_time.text = "%d:%04.1f" % [floori(time_s / 60.0), fmod(time_s, 60.0)]
	var text := "%d of %d placed" % [placed, bodies.size()]
	if not bodies.is_empty():
		text += ", within %.0f mm, %.0f°" % [
			1000.0 * bodies[0].position_tolerance_m, rad_to_deg(bodies[0].rotation_tolerance_rad)
		]
	_placed.text = text


## Where nothing is timed or placed.
func show_free(title: String) -> void:
	_title.text = title
	_time.visible = false
	_placed.visible = false
	(%Task as Control).size.y = 0.0 # as low as its text


func _process(delta: float) -> void:
	_shown_for_s += delta
	if _shown_for_s < REFRESH_S:
		return
	_shown_for_s = 0.0
	if _spidar == null:
		_hint_panel.visible = false
		return
	if mode == Mode.OFF:
		_hint_panel.visible = _hint_text() != HINT_ON
		_show_hint()
		return
	_hint_panel.visible = true
	_show_hint()
	_state.text = STATE_NAMES[_spidar.get_state()]
	_dot.color = _state_colour()
	var statistics := _spidar.get_statistics()
	_servo.text = "servo %.0f Hz" % float(statistics.get("servo_rate_hz", 0.0))
	var held := _tool_hand.get_held_body()
	_held.text = "empty" if held == null else (
		"%d g,  %d mm" % [roundi(held.mass * 1000.0), roundi(_tool_hand.get_held_width() * 1000.0)]
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
	for panel: Control in [%Task, _device, %DialPanel]:
		panel.visible = mode != Mode.OFF
	for panel: Control in [_bars_panel, _wrench_panel]:
		panel.visible = mode == Mode.FULL


## Actions in braces become their keys, and only when the text has changed.
func _show_hint() -> void:
	var text := _hint_text()
	if text != _hint_shown:
		_hint_shown = text
		_hint.text = KeyNames.fill(text)


func _hint_text() -> String:
	if _result != "":
		return _result
	if _spidar.get_state() == SpidarG.STATE_FAULT:
		return "Fault: %s   {demo_forces}  clears it and arms again" % _spidar.get_fault_text()
	if get_tree().paused and _notice != "":
		return _notice
	if _spidar.is_recording():
		return "Recording.  {demo_record}  stops it    {demo_panic}  stops the forces"
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
