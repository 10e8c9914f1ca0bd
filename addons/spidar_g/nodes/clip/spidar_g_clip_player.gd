@tool
@icon("../../icons/spidar_g_clip_player.svg")
class_name SpidarGClipPlayer
extends Node
## Plays a [SpidarGClip] in the hand: by script, or when the hand touches, slips, hits, grasps or lets go.
##
## Make it a child of what its [member event] comes from, and give it a [member clip].
## [codeblock]
## RigidBody3D                  a cup
## ├─ CollisionShape3D
## ├─ SpidarGSurface            tells of touch and slip
## └─ SpidarGClipPlayer         event: Impact, clip: a knock of 50 Hz
## [/codeblock]
## [codeblock]
## func _on_button_pressed() -> void:
##     $SpidarGClipPlayer.play() # event None: by script alone
## [/codeblock]
## [b]Where it stands.[/b] Its nearest ancestor that is a [SpidarG], a [SpidarGHand], a [SpidarGSurface] or a physics body is
## its source, or the node at [member source_path]. Touches, slips and impacts come from a [SpidarGSurface], which is the
## source itself or a child of it. Grasps come from the hand, or from every hand that grasps the body.[br]
## [b]Who feels it.[/b] The device of the hand that the event is about. [method play] plays on the device above the player, or on
## every open device of the same world if there is none above it.[br]
## [b]Once.[/b] A device plays a player's clip once at a time: [method play] begins it anew.[br]
## [b]Limits.[/b] A device renders 6 effects at once, those of zones, sockets and scripts included. If none is free, the clip is
## not played, and one warning says so. Players use the effect ids from [constant FIRST_ID] to 999999. The vibration ends within
## 0.1 s when the clip is over, when the player is paused or disabled or leaves the scene tree, and when the game hangs. A
## player costs nothing between its events, except that one for [constant IMPACT] reads the speed of each hand in each
## physics tick.

## Emitted when [param spidar] begins to play the clip.
signal started(spidar: SpidarG)
## Emitted once for each [signal started], when [param spidar] plays the clip no more: at its end, after [method stop], before it
## begins anew, and when the player is paused, disabled or removed. [param spidar] is [code]null[/code] if it was freed.
signal finished(spidar: SpidarG)

## What starts the clip.
enum Event {
	## Nothing: the clip is started by [method play] alone.
	NONE,
	## A hand begins to press on the surface.
	TOUCH,
	## A hand presses on the surface no more.
	TOUCH_END,
	## A hand slips along the surface. The clip is repeated until the hand slips no more.
	SLIP,
	## A hand holds the body, or the hand above the player holds any body.
	GRASP,
	## A hand lets go of the body, or the hand above the player lets go of any body.
	RELEASE,
	## A hand hits the surface: it begins to press on it, and came at [member least_impact_speed] or faster. Fingers that close
	## on a body do not count as fast.
	IMPACT,
}

const _Devices := preload("../zone/devices_in_tree.gd")
const _InRange := preload("../values/in_range.gd")
const _Events := preload("clip_events.gd")
const _Run := preload("clip_run.gd")
const _Source := preload("clip_source.gd")
## Effect ids of players begin here. Zones have those from 1000000 on, sockets negative ones; a game's own should be smaller.
const FIRST_ID: int = 500000
## How many effect ids players have; after the last one they begin again.
const ID_COUNT: int = 500000
## A hand that was quiet for less than this bounces, s.
const BOUNCE_S: float = 0.1

static var _made: int = 0

## What is played. If it is [code]null[/code], nothing is played, and a configuration warning says so. Another clip ends the one
## that is being played.
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
## What starts the clip. A clip that is being played goes on when this is changed, unless it is one of a slip.
@export var event := Event.NONE:
	set(value):
		event = value
		notify_property_list_changed()
		_look_and_warn()
## The [SpidarG], [SpidarGHand], [SpidarGSurface] or physics body that the event comes from. If it is empty, the nearest
## ancestor that is one of them counts. It is looked for when the player enters the scene tree, when this is set, and when a
## device or a hand enters or leaves. A path that leads to something else gives a warning, and no event comes.
@export_node_path("Node") var source_path: NodePath:
	set(value):
		source_path = value
		_look_and_warn()
## Time after the end of a clip in which no event starts it again on the same device, in seconds of the device, from 0 to 60. Any
## other value is refused with an error, and the old one stays.[br]
## A strong clip shakes a light finger off the surface and onto it again, which must not start the clip anew. So two more rules
## hold: no event starts a clip that is being played, and an event counts only if the hand was quiet for the last 0.1 s, without
## another such event and without leaving the surface. A slow and strong clip (2 N at 15 Hz) throws a very loose hand off for
## longer: set the cooldown to 0.5 s there. Nothing of this counts for [method play] and for [constant SLIP].
@export_range(0.0, 60.0, 0.01, "suffix:s") var cooldown: float = 0.1:
	set(value):
		cooldown = _checked("cooldown", value, cooldown, "s", 0.0, 60.0)
## Whether a harder [constant IMPACT] is felt more: the strength is that of the clip times the speed at which the hand came,
## divided by [member full_impact_speed], and never more than that of the clip. If it is [code]false[/code], each impact has the
## full strength. Ignored for other events.
@export var scale_by_impulse: bool = true
## Speed of an [constant IMPACT] with the clip's full strength, in device meters a second, from 0.01 to 5. It is that of the hand
## against the body, along the normal of the surface, in the ticks before the touch. Any other value is refused with an error,
## and the old one stays.
@export_range(0.01, 5.0, 0.01, "suffix:m/s") var full_impact_speed: float = 0.3:
	set(value):
		full_impact_speed = _checked("full_impact_speed", value, full_impact_speed, "m/s", 0.01, 5.0)
## A hand that comes more slowly makes no [constant IMPACT], in device meters a second, from 0.001 to 5. Any other value is refused
## with an error, and the old one stays.
@export_range(0.001, 5.0, 0.001, "suffix:m/s") var least_impact_speed: float = 0.03:
	set(value):
		least_impact_speed = _checked("least_impact_speed", value, least_impact_speed, "m/s", 0.001, 5.0)

var _id: int = FIRST_ID
var _devices: _Devices = null
var _events := _Events.new()
# By the instance of the device, as below: when the last clip ended there, and when the hand last did anything that an event
# may come from, s of the device.
var _runs: Dictionary[int, _Run] = {}
var _ended_s: Dictionary[int, float] = {}
var _heard_s: Dictionary[int, float] = {}
# Whether it was said that no effect is free, since a clip was last played.
var _is_told: bool = false


func _init() -> void:
	_id = FIRST_ID + _made % ID_COUNT
	_made += 1
	_events.occurred.connect(_on_occurred)
	_events.left.connect(_on_left)
	_events.slip_ended.connect(_on_slip_ended)
	_events.source_changed.connect(_look)


## Plays the clip now, from its beginning, on [param spidar]. If that is [code]null[/code], it plays on the device above the player
## or at [member source_path], or on every open device of the same world if there is none. Returns whether a device plays it. A
## warning says why not, unless there is no open device.
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


## Ends the clip on all devices. What is left of the vibration fades in less than 0.1 s. Does nothing if nothing is played.
func stop() -> void:
	for id: int in _runs.keys():
		_drop(id)


## Returns whether a device plays the clip now.
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


# Each time that the player has entered the tree, and its neighbors too. The engine turns processing on just before.
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


# Connects the events anew, and runs only where something is to be done.
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


# Whether an event that comes now is more than a bounce of the hand, or of what the clip itself does to it.
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


# along: the normal, or zero where nothing is touched. share: of the clip's strength, more than 0.
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
