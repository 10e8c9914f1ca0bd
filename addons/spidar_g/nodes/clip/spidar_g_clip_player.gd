@tool
@icon("../../icons/spidar_g_clip_player.svg")
class_name SpidarGClipPlayer
extends Node
## Plays a [SpidarGClip] in the hand: by script, or when the hand touches, slips, hits, grasps or lets go.
##
## Make this node a child of the node that its [member event] comes from, and set its [member clip]. To play the clip by
## script, call [method play].
## [codeblock]
## # A body that knocks when the hand hits it.
## var body := StaticBody3D.new()
## body.add_child(SpidarGSurface.new())
## var player := SpidarGClipPlayer.new()
## player.clip = SpidarGClip.new()
## player.event = SpidarGClipPlayer.Event.IMPACT
## body.add_child(player)
## add_child(body)
## [/codeblock]
## [b]Source.[/b] The source of the events is the nearest ancestor that is a [SpidarG], a [SpidarGHand], a [SpidarGSurface] or
## a physics body, or the node at [member source_path]. Touches, slips and impacts come from a [SpidarGSurface], which is the
## source or a child of the source. Grasps come from the hand that is the source (of a [SpidarG], its hand), or from every
## hand that grasps the body.[br]
## [b]Device.[/b] The clip is played on the device of the hand that caused the event. [method play] plays it on the device
## above the player, or on every open device of the same world if there is none above it.[br]
## [b]Repetition.[/b] A device plays the clip of one player at most once at a time. [method play] starts the clip from its
## beginning.[br]
## [b]Limits.[/b] A device renders 6 effects at once, including those of zones, sockets and scripts. If none is free, the clip
## is not played, and one warning says so. Players use the effect ids from [constant FIRST_ID] to 999999. The vibration ends
## within 0.1 s when the clip is over, when the player is paused or disabled or leaves the scene tree, and (at 50 or more
## physics ticks per second) when the game hangs. A player takes no time between its events, except that one for
## [constant IMPACT] reads the speed of each hand in each physics tick.

## Emitted when [param spidar] begins to play the clip.
signal started(spidar: SpidarG)
## Emitted once for each [signal started], when [param spidar] no longer plays the clip: at its end, after [method stop],
## before it is started again, and when the player is paused, disabled or removed. [param spidar] is [code]null[/code] if it
## was freed.
signal finished(spidar: SpidarG)

## Selects the event of a hand that starts the clip.
enum Event {
	## No event starts the clip; only [method play] does.
	NONE,
	## The clip starts when a hand begins to press on the surface.
	TOUCH,
	## The clip starts when a hand no longer presses on the surface.
	TOUCH_END,
	## The clip is repeated while a hand slips along the surface.
	SLIP,
	## The clip starts when a hand begins to hold the body, or when the hand above the player begins to hold any body.
	GRASP,
	## The clip starts when a hand lets go of the body, or when the hand above the player lets go of any body.
	RELEASE,
	## The clip starts when a hand hits the surface: it begins to press on it and came with [member least_impact_speed] or
	## faster. Fingers that close on a body do not count as fast.
	IMPACT,
}

const _Devices := preload("../zone/devices_in_tree.gd")
const _InRange := preload("../values/in_range.gd")
const _Events := preload("clip_events.gd")
const _Run := preload("clip_run.gd")
const _Source := preload("clip_source.gd")
## The smallest effect id that players use. Use smaller ids for effects of your own.
const FIRST_ID: int = 500000
## The number of effect ids that players use. After the last one the first one is used again.
const ID_COUNT: int = 500000
## An event counts as a bounce of the hand, and starts no clip, if the last event of the hand was less than this time ago, in
## seconds of [method SpidarG.get_device_time].
const BOUNCE_S: float = 0.1

static var _made: int = 0

## Sets the clip that is played. If it is [code]null[/code], nothing is played, and a configuration warning says so. Setting
## another clip ends the clip that is playing.
@export var clip: SpidarGClip:
	set(value):
		if clip != value:
			stop()
		if clip != null and clip.changed.is_connected(update_configuration_warnings):
			clip.changed.disconnect(update_configuration_warnings)
		clip = value
		if clip != null:
			clip.changed.connect(update_configuration_warnings)
		update_configuration_warnings()
## Selects the event that starts the clip. A clip that is playing continues if this property is changed, unless the clip is
## repeated for a [constant SLIP].
@export var event := Event.NONE:
	set(value):
		event = value
		notify_property_list_changed()
		_look_and_warn()
## Sets the [SpidarG], [SpidarGHand], [SpidarGSurface] or physics body that the event comes from. With an empty path the
## nearest ancestor of these types is used. The source is looked for when the player enters the scene tree, when this property
## is set, when the children of the source change, and when a device or a hand enters or leaves. A path to a node of another
## type causes a warning, and no event comes.
@export_node_path("Node") var source_path: NodePath:
	set(value):
		source_path = value
		_look_and_warn()
## Sets the time after the end of a clip in which no event starts it again on the same device, in seconds of the device, from
## 0 to 60. Another value is refused with an error, and the old one stays.[br]
## A strong clip can shake a light finger off the surface and onto it again, which causes new events. Therefore no event
## starts a clip that is playing, and an event is ignored if another one occurred, or the hand left the surface, less than 0.1
## s before. A slow and strong clip (2 N at 15 Hz) throws a very loose hand off for longer: set the cooldown to 0.5 s. [method
## play] and [constant SLIP] ignore the cooldown and these rules.
@export_range(0.0, 60.0, 0.01, "suffix:s") var cooldown: float = 0.1:
	set(value):
		cooldown = _checked("cooldown", value, cooldown, "s", 0.0, 60.0)
## If [code]true[/code], the strength of an [constant IMPACT] is proportional to the speed of the hand, up to the full
## strength of the clip at [member full_impact_speed]. If [code]false[/code], each impact has the full strength. Ignored for
## other events.
@export var scale_by_impulse: bool = true
## Sets the speed at which an [constant IMPACT] has the full strength of the clip, in meters of device motion per second, from
## 0.01 to 5. The speed is that at which hand and body approached each other along the normal of the surface, before the
## touch. Another value is refused with an error, and the old one stays.
@export_range(0.01, 5.0, 0.01, "suffix:m/s") var full_impact_speed: float = 0.3:
	set(value):
		full_impact_speed = _checked("full_impact_speed", value, full_impact_speed, "m/s", 0.01, 5.0)
## Sets the minimum speed of an [constant IMPACT], in meters of device motion per second, from 0.001 to 5. A slower hand
## starts no clip. Another value is refused with an error, and the old one stays.
@export_range(0.001, 5.0, 0.001, "suffix:m/s") var least_impact_speed: float = 0.03:
	set(value):
		least_impact_speed = _checked("least_impact_speed", value, least_impact_speed, "m/s", 0.001, 5.0)

var _id: int = FIRST_ID
var _devices: _Devices = null
var _events := _Events.new()
# The run of each device, by the instance id of the device. The two below are by the same key: the time of the device at
# which its last clip ended, and at which the hand last did anything that an event may come from, in seconds.
var _runs: Dictionary[int, _Run] = {}
var _ended_s: Dictionary[int, float] = {}
var _heard_s: Dictionary[int, float] = {}
# Whether the warning that no effect is free was given since the last clip was played.
var _is_told: bool = false


func _init() -> void:
	_id = FIRST_ID + _made % ID_COUNT
	_made += 1
	_events.occurred.connect(_on_occurred)
	_events.left.connect(_on_left)
	_events.slip_ended.connect(_on_slip_ended)
	_events.source_changed.connect(_look)


## Plays the clip from its beginning on [param spidar]. If that is [code]null[/code], the clip is played on the device above
## the player or at [member source_path], or on every open device of the same world if there is none. Returns
## [code]true[/code] if a device plays the clip. Otherwise a warning says why, unless no device is open. The warning that no
## effect is free is given only once until a clip is played again.
func play(spidar: SpidarG = null) -> bool:
	if _devices == null:
		if ClassDB.class_exists(&"SpidarG"):
			push_warning("SpidarGClipPlayer \"%s\" plays nothing: it is outside of the scene tree. Add it first." % name)
		return false
	var chosen: Array[SpidarG] = _devices.devices.duplicate()
	var only: SpidarG = spidar if spidar != null else _Source.find(self, source_path).spidar
	if only != null:
		chosen = [only]
	var plays: bool = false
	for device: SpidarG in chosen:
		var is_here: bool = device == only or device.get_world_3d() == get_viewport().find_world_3d()
		if is_here and device.get_state() != SpidarG.STATE_CLOSED:
			plays = _start(device, _touched_direction(device), 1.0, false) or plays
	return plays


## Ends the clip on all devices. The vibration fades in less than 0.1 s. Does nothing if no clip is playing.
func stop() -> void:
	for id: int in _runs.keys():
		_drop(id)


## Returns [code]true[/code] while a device plays the clip.
func is_playing() -> bool:
	return not _runs.is_empty()


## Returns the id of the effect that the player uses on each device, for [method SpidarG.clear_effect].
func get_effect_id() -> int:
	return _id


func _enter_tree() -> void:
	if Engine.is_editor_hint():
		get_parent().child_order_changed.connect(update_configuration_warnings)
		return
	if not ClassDB.class_exists(&"SpidarG"):
		return
	_devices = _Devices.of(get_tree())
	_devices.changed.connect(_look)


# Called each time the player and its neighbors have entered the tree. The engine turns processing on just before.
func _ready() -> void:
	_look_and_warn()


func _exit_tree() -> void:
	stop()
	_events.leave()
	_ended_s.clear()
	_heard_s.clear()
	request_ready()
	if Engine.is_editor_hint():
		get_parent().child_order_changed.disconnect(update_configuration_warnings)
	if _devices != null:
		_devices.changed.disconnect(_look)
		_devices = null


func _notification(what: int) -> void:
	if what == NOTIFICATION_PAUSED or what == NOTIFICATION_DISABLED:
		stop()


func _validate_property(property: Dictionary) -> void:
	var of_impact: bool = ["scale_by_impulse", "full_impact_speed", "least_impact_speed"].has(property["name"])
	var is_limited: bool = event != Event.NONE and event != Event.SLIP
	if (of_impact and event != Event.IMPACT) or (property["name"] == "cooldown" and not is_limited):
		property["usage"] = PROPERTY_USAGE_NO_EDITOR


func _get_configuration_warnings() -> PackedStringArray:
	var warnings: PackedStringArray = []
	if clip == null:
		warnings.append("The SpidarGClipPlayer plays nothing: its clip is empty. Give it a SpidarGClip.")
	elif not clip.get_problem().is_empty():
		warnings.append("The clip of the SpidarGClipPlayer is not played: " + clip.get_problem())
	if is_inside_tree():
		var problem: String = _Source.find(self, source_path).problem(event, source_path)
		if not problem.is_empty():
			warnings.append(problem)
	return warnings


func _physics_process(_delta: float) -> void:
	if event == Event.IMPACT:
		_events.note_motion(_devices.hands)
	var tick_s: float = 1.0 / Engine.physics_ticks_per_second
	for id: int in _runs.keys():
		if not _runs.has(id): # a listener of `finished` stopped it
			continue
		if _runs[id].loops and not _events.has_surface():
			_runs[id].end()
		if not _runs[id].step(tick_s):
			_drop(id)


# Connects the events again, and turns processing on only if it is needed.
func _look() -> void:
	update_configuration_warnings()
	if _devices == null:
		set_physics_process(false)
		return
	var old: Node = _events.source.surface if _events.has_surface() else null
	_events.connect_to(event, _Source.find(self, source_path), _devices.hands)
	for run: _Run in _runs.values():
		if run.loops and (event != Event.SLIP or _events.source.surface != old):
			run.end()
	_choose()


func _look_and_warn() -> void:
	_look()
	if _devices != null and is_node_ready():
		_warn.call_deferred() # what else is added or set in the same frame counts


func _choose() -> void:
	var watches: bool = event == Event.IMPACT and _events.has_surface()
	set_physics_process(watches or not _runs.is_empty())


func _warn() -> void:
	if is_inside_tree():
		for warning: String in _get_configuration_warnings():
			push_warning("SpidarGClipPlayer \"%s\": %s" % [name, warning])


func _on_occurred(hand: SpidarGHand, along: Vector3, speed: float) -> void:
	var spidar: SpidarG = hand.spidar
	if spidar == null or not can_process() or not _get_problem().is_empty():
		return
	if event == Event.SLIP:
		_start(spidar, along, 1.0, true)
		return
	if not _is_new(spidar) or (event == Event.IMPACT and speed < least_impact_speed):
		return
	var is_scaled: bool = event == Event.IMPACT and scale_by_impulse
	_start(spidar, along, minf(1.0, speed / full_impact_speed) if is_scaled else 1.0, false)


# Returns whether the event may start the clip: it is neither a bounce of the hand nor caused by the clip itself.
func _is_new(spidar: SpidarG) -> bool:
	var id: int = spidar.get_instance_id()
	var now_s: float = spidar.get_device_time()
	var before_s: float = _heard_s.get(id, -INF)
	_heard_s[id] = now_s
	return not _runs.has(id) and now_s - before_s >= BOUNCE_S and now_s - _ended_s.get(id, -INF) >= cooldown


func _on_left(hand: SpidarGHand) -> void:
	if is_instance_valid(hand) and hand.spidar != null:
		_heard_s[hand.spidar.get_instance_id()] = hand.spidar.get_device_time()


func _on_slip_ended(hand: SpidarGHand) -> void:
	var run: _Run = _runs.get(hand.spidar.get_instance_id()) if is_instance_valid(hand) and hand.spidar != null else null
	if run != null and run.loops:
		run.end()


func _touched_direction(spidar: SpidarG) -> Vector3:
	for hand: SpidarGHand in _devices.hands:
		if hand.spidar == spidar:
			return _Events.normal_at(hand, null)
	return Vector3.ZERO


# along: the normal, or zero if nothing is touched. share: of the clip's strength, above 0.
func _start(spidar: SpidarG, along: Vector3, share: float, loops: bool) -> bool:
	if not _get_problem().is_empty():
		push_warning("SpidarGClipPlayer \"%s\" plays nothing: %s" % [name, _get_problem()])
		return false
	var id: int = spidar.get_instance_id()
	var direction: Vector3 = along if clip.along_normal and not along.is_zero_approx() else clip.direction
	var run := _Run.new(spidar, clip, _id, direction, share, loops)
	if _runs.has(id):
		_runs.erase(id)
		finished.emit(spidar)
	if not run.step(1.0 / Engine.physics_ticks_per_second):
		if not _is_told:
			push_warning("SpidarGClipPlayer \"%s\" is not felt: 6 effects act on \"%s\" already, of zones, sockets or scripts. End one, or play fewer clips at once." % [name, spidar.name])
		_is_told = true
		_choose()
		return false
	_is_told = false
	_runs[id] = run
	_choose()
	started.emit(spidar)
	return true


func _get_problem() -> String:
	if not can_process():
		return "it is paused or disabled. Enable it."
	return "its clip is empty. Give it a SpidarGClip." if clip == null else clip.get_problem()


func _drop(id: int) -> void:
	var run: _Run = _runs[id]
	_runs.erase(id)
	run.stop()
	_choose()
	var is_there: bool = is_instance_valid(run.spidar)
	if is_there:
		_ended_s[id] = run.spidar.get_device_time()
	finished.emit(run.spidar if is_there else null)


func _checked(field: String, value: float, old: float, unit: String, least: float, most: float) -> float:
	return _InRange.checked("SpidarGClipPlayer \"%s\"" % name, field, value, old, unit, least, most)
