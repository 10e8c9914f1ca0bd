@tool
class_name SpidarGPanel
extends PanelContainer
## Shows what a [SpidarG] does, and starts and stops recordings.
##
## Add the scene [code]spidar_g_panel.tscn[/code] under a [CanvasLayer] or as a child of the device, and set [member device].
## The panel shows the state of the device, its tensions, the requested and the achieved wrench, the contacts of its
## [SpidarGHand], the punctuality of the servo thread, and the last events. The panel does not change the device, except that
## its button starts and stops recordings. While the panel is hidden, it draws and computes no curves.
## [codeblock]
## var panel: SpidarGPanel = preload("res://addons/spidar_g/nodes/spidar_g_panel.tscn").instantiate()
## panel.device = $SpidarG
## add_child(panel)
## [/codeblock]

const _PlotStrip := preload("plot_strip.gd")
const _JitterPlot := preload("jitter_plot.gd")

## The folder in which [method toggle_recording] creates its files.
const RECORDING_FOLDER: String = "user://spidar_g_recordings"
## The largest number of lines that the log keeps; the oldest ones are removed.
const MOST_EVENTS: int = 100
## The numbers and the histogram are refreshed once in this many drawn frames.
const FRAMES_PER_REPORT: int = 10
## The curves of x, y and z are drawn in these colors.
const FORCE_COLOURS: PackedColorArray = [
	Color(0.95, 0.35, 0.30), Color(0.40, 0.80, 0.35), Color(0.35, 0.60, 1.0)
]
## The curve of the grasp torque is drawn in this color.
const GRASP_COLOUR: Color = Color(0.95, 0.80, 0.25)
## The curve of the number of contact points is drawn in this color.
const POINTS_COLOUR: Color = Color(0.80, 0.60, 1.0)
## The curve of the largest force of a contact point is drawn in this color.
const PUSH_COLOUR: Color = Color(0.95, 0.35, 0.65)
## The curve of the achieved force is drawn in this color.
const FELT_COLOUR: Color = Color(0.85, 0.87, 0.90)
## The log shows the events of this level: [constant SpidarG.EVENT_WARNING].
const WARNING: int = 1
## Achieved values are drawn with this alpha, so that they are paler than requested ones.
const GIVEN_ALPHA: float = 0.45

## Sets the device that the panel shows. If it is [code]null[/code] and the parent is a [SpidarG], the parent is used.
@export var device: SpidarG:
	set(value):
		if device != value:
			_disconnect()
			device = value
			_connect()
			update_configuration_warnings()

## The path of the current recording of this panel, or of the last one. It is empty before the first recording.
var recording_path: String = ""

# Whether this panel started the current recording. A recording that something else started goes on when the panel leaves.
var _records: bool = false
var _frames: int = 0
var _events: PackedStringArray = []
# The hand whose contacts are shown: the first one among the device's children.
var _hand: SpidarGHand = null

@onready var _state: Label = get_node_or_null(^"%State")
@onready var _tensions: _PlotStrip = get_node_or_null(^"%Tensions")
@onready var _force: _PlotStrip = get_node_or_null(^"%Force")
@onready var _moment: _PlotStrip = get_node_or_null(^"%Moment")
@onready var _points: _PlotStrip = get_node_or_null(^"%Points")
@onready var _push: _PlotStrip = get_node_or_null(^"%Push")
@onready var _jitter: _JitterPlot = get_node_or_null(^"%Jitter")
@onready var _numbers: Label = get_node_or_null(^"%Numbers")
@onready var _log: RichTextLabel = get_node_or_null(^"%Events")
@onready var _record: Button = get_node_or_null(^"%Record")
@onready var _recorded: Label = get_node_or_null(^"%Recorded")


func _ready() -> void:
	set_process(false)
	if Engine.is_editor_hint():
		return
	if _state == null:
		push_warning("SpidarGPanel shows nothing: add the scene spidar_g_panel.tscn in place of this node.")
		return
	if not ClassDB.class_exists(&"SpidarG"):
		# Without the add-on's library a SpidarG is a stand-in, which says so.
		_state.text = device.get_state_text() if device != null else ""
		return
	_tensions.title = "String tensions 1-8, N"
	_tensions.least_high = 2.0
	var tints: PackedColorArray = []
	for string: int in 8:
		tints.append(Color.from_hsv(string / 8.0, 0.55, 0.95))
	_tensions.colours = tints
	_force.title = "Force x y z, N: requested, achieved pale"
	_force.least_low = -1.0
	_force.colours = _pairs(FORCE_COLOURS)
	_moment.title = "Moment x y z, grasp, N m"
	_moment.least_low = -0.02
	_moment.least_high = 0.02
	_moment.colours = _pairs(FORCE_COLOURS + PackedColorArray([GRASP_COLOUR]))
	_points.title = "Contact points: pushing, near ones pale"
	_points.least_high = 4.0
	_points.colours = _pairs([POINTS_COLOUR])
	_push.title = "Largest push of a contact (pink), achieved force (white), N"
	_push.colours = [PUSH_COLOUR, FELT_COLOUR]
	_record.pressed.connect(toggle_recording)
	visibility_changed.connect(_visibility_changed)
	if device == null and get_parent() is SpidarG:
		device = get_parent()
	_connect()
	_visibility_changed()


func _get_configuration_warnings() -> PackedStringArray:
	if get_node_or_null(^"%State") == null:
		return ["SpidarGPanel needs its scene: add spidar_g_panel.tscn in place of this node."]
	if device == null and not get_parent() is SpidarG:
		return ["SpidarGPanel shows nothing here: set its device, or make it a child of a SpidarG node."]
	return []


func _exit_tree() -> void:
	if _records and is_recording():
		device.stop_recording()
	_records = false
	_disconnect()


func _enter_tree() -> void:
	_connect()
	update_configuration_warnings()


func _process(_delta: float) -> void:
	if not is_instance_valid(device):
		_state.text = "No device is shown: set the panel's device to a SpidarG."
		return
	_tensions.add_sample(device.get_string_tensions())
	var asked: PackedFloat64Array = device.get_requested_wrench()
	var given: PackedFloat64Array = device.get_achieved_wrench()
	_force.add_sample(asked.slice(0, 3) + given.slice(0, 3))
	_moment.add_sample(asked.slice(3, 7) + given.slice(3, 7))
	if _frames % FRAMES_PER_REPORT == 0:
		_report()
	if is_instance_valid(_hand) and _hand.get_parent() == device:
		_add_contacts(Vector3(given[0], given[1], given[2]).length())
	_frames += 1


## Returns the lines of the log, the newest one last.
func get_events() -> PackedStringArray:
	return _events


## Returns [code]true[/code] while the device records, no matter who started the recording.
func is_recording() -> bool:
	return is_instance_valid(device) and device.is_recording()


## Starts a recording into a new file in [constant RECORDING_FOLDER], or stops the recording of the device if one runs.
func toggle_recording() -> void:
	if not is_instance_valid(device):
		return
	if device.is_recording():
		device.stop_recording()
		_records = false
		_tell("recorded: %s" % ProjectSettings.globalize_path(recording_path))
	else:
		DirAccess.make_dir_recursive_absolute(RECORDING_FOLDER)
		var stamp: String = Time.get_datetime_string_from_system().replace(":", "-")
		var path: String = "%s/%s.rec" % [RECORDING_FOLDER, stamp]
		var number: int = 2
		while FileAccess.file_exists(path):
			path = "%s/%s %d.rec" % [RECORDING_FOLDER, stamp, number]
			number += 1
		if device.start_recording(path):
			_records = true
			recording_path = path
			_tell("recording: %s" % path.get_file())
	_report()


func _add_contacts(felt_n: float) -> void:
	var points: Array = _hand.get_touch_points()
	var pushing: int = 0
	var most_n: float = 0.0
	for point: Dictionary in points:
		var force: Vector3 = point["force"]
		var normal: Vector3 = point["normal"]
		var push_n: float = force.dot(normal)
		pushing += int(push_n > 0.0)
		most_n = maxf(most_n, push_n)
	_points.add_sample([pushing, points.size()])
	_push.add_sample([most_n, felt_n])


# Finds the hand. A device without a hand has no contacts to show.
func _find_hand() -> void:
	var found: SpidarGHand = null
	for child: Node in device.get_children():
		if found == null and child is SpidarGHand:
			found = child
	if found != _hand:
		_hand = found
		_points.clear()
		_push.clear()
	_points.visible = _hand != null
	_push.visible = _hand != null


# Shows the state, the numbers and the histogram.
func _report() -> void:
	if not is_instance_valid(device) or not is_visible_in_tree() or _state == null:
		return
	_find_hand()
	_state.text = "%s   %s" % [device.get_state_text(), device.get_fault_text()]
	var numbers: Dictionary = device.get_statistics()
	_numbers.text = (
		"servo %.0f Hz    late p50 %.0f, p99 %.0f, max %.0f us    step p99 %.1f us    missed %d    saturated %d"
		% [
			numbers["servo_rate_hz"], numbers["lateness_p50_us"], numbers["lateness_p99_us"],
			numbers["lateness_max_us"], numbers["step_p99_us"], numbers["missed_deadlines"],
			numbers["saturated_ticks"]
		]
	)
	_jitter.show_counts(device.get_lateness_histogram())
	var running: bool = device.is_recording()
	_record.text = "Stop recording" if running else "Record"
	if running:
		var recorded: Dictionary = device.get_recording_statistics()
		_recorded.text = "%d cycles, %.2f MB, %d lost" % [
			recorded["cycles"], recorded["bytes"] * 1e-6, recorded["lost_cycles"]]
	else:
		_recorded.text = recording_path.get_file()


func _visibility_changed() -> void:
	set_process(is_visible_in_tree() and not Engine.is_editor_hint())
	_report()


# Returns the colors of the requested values, followed by the same colors, paler, for the achieved ones.
func _pairs(colours: PackedColorArray) -> PackedColorArray:
	var both: PackedColorArray = colours.duplicate()
	for colour: Color in colours:
		both.append(Color(colour, GIVEN_ALPHA))
	return both


func _tell(text: String) -> void:
	_events.append("%s  %s" % [Time.get_time_string_from_system(), text])
	if _events.size() > MOST_EVENTS:
		_events = _events.slice(_events.size() - MOST_EVENTS)
	if is_node_ready() and _log != null:
		_log.text = "\n".join(_events)


# Returns the signals of the device and their handlers.
func _listeners() -> Dictionary[StringName, Callable]:
	return {
		&"device_connected": _connected,
		&"armed": _tell.bind("armed"),
		&"disarmed": _tell.bind("disarmed"),
		&"grasped": _tell.bind("grasped"),
		&"released": _tell.bind("released"),
		&"device_lost": _lost,
		&"fault_raised": _fault,
		&"request_rejected": _rejected,
		&"recording_failed": _rejected,
		&"replay_finished": _replayed,
		&"device_event": _event,
	}


func _connect() -> void:
	if not is_instance_valid(device) or not is_inside_tree() or Engine.is_editor_hint():
		return
	var listeners: Dictionary[StringName, Callable] = _listeners()
	for name_of_signal: StringName in listeners:
		if not device.is_connected(name_of_signal, listeners[name_of_signal]):
			device.connect(name_of_signal, listeners[name_of_signal])


func _disconnect() -> void:
	if not is_instance_valid(device):
		return
	var listeners: Dictionary[StringName, Callable] = _listeners()
	for name_of_signal: StringName in listeners:
		if device.is_connected(name_of_signal, listeners[name_of_signal]):
			device.disconnect(name_of_signal, listeners[name_of_signal])


func _connected() -> void:
	_tell("connected: %s" % device.get_device_text())


func _lost(reason: String) -> void:
	_tell("device lost: %s" % reason)


func _fault(_status: int, message: String) -> void:
	_tell("fault: %s" % message)


func _rejected(message: String) -> void:
	_tell(message)


# Logs warnings. Faults and refusals have signals of their own.
func _event(event: Dictionary) -> void:
	if event["level"] == WARNING and event["name"] != "request_refused":
		var where: String = " (string %d of 1-8)" % (event["string"] + 1) if event["string"] >= 0 else ""
		_tell("%s%s %s" % [event["message"], where, event["remedy"]])


func _replayed(identical: bool, message: String) -> void:
	_tell("replay %s: %s" % ["identical" if identical else "differs", message])
