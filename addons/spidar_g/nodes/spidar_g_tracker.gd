@tool
@icon("../icons/spidar_g_tracker.svg")
class_name SpidarGTracker
extends Node
## Makes a [SpidarG] an XR controller: an [XRController3D] follows its grip, and scenes that were made for XR controllers work
## with it unchanged, without an XR headset.
##
## Make this node a descendant of a [SpidarG], or set [member spidar_path], and set the tracker of an [XRController3D] below
## an [XROrigin3D] to [code]right_hand[/code].
## [codeblock]
## var tracker := SpidarGTracker.new()
## $SpidarG.add_child(tracker)
## var origin := XROrigin3D.new()
## add_child(origin)
## var controller := XRController3D.new()
## controller.tracker = tracker.get_tracker_name() # right_hand
## origin.add_child(controller)
## [/codeblock]
## The tracker has the poses [code]default[/code] and [code]grip[/code], which are the grip, and [code]aim[/code], which is
## [member aim_offset] away from the grip. All poses have velocities. They are set in each physics tick, after the [SpidarG]
## has read its device, and in each drawn frame. Their confidence is high, but low while a real device does not know its zero.
## [br][br]
## The inputs have the names of Godot's default action map:
## [br]- [code]grip[/code], a float: how far the grasp is closed, from 0 for open to 1 at
## [member SpidarGConfig.jaw_closed_angle].
## [br]- [code]trigger[/code], a float from 0 to 1: see [member trigger_source].
## [br]- [code]grip_click[/code] and [code]trigger_click[/code], booleans: pressed from [member click_at] on, until the float
## falls below [member release_below].
## [br]- The buttons of the device, booleans: see [member buttons].
## [br][br]
## While the device is closed or in [constant SpidarG.STATE_FAULT], all buttons are released, the poses are invalid, and the
## tracker is removed from the [XRServer]; [method XRNode3D.get_is_active] is then [code]false[/code]. Haptic pulses of
## [method XRNode3D.trigger_haptic_pulse] go to the XR interface and not to the device: use
## [method SpidarG.set_vibration_effect].

## Selects the tracker that the device becomes.
enum Hand {
	## The tracker [code]right_hand[/code]: Godot's XR interfaces use this name for the right controller.
	RIGHT,
	## The tracker [code]left_hand[/code]: Godot's XR interfaces use this name for the left controller.
	LEFT,
	## A tracker with any other name, which [member custom_name] sets.
	OTHER,
}
## Selects what the input [code]trigger[/code] measures.
enum TriggerSource {
	## Acts as [constant ACTION] if the grip is rigid and the project has the action, otherwise as [constant SQUEEZE] if the
	## [SpidarG] has a [SpidarGHand], and otherwise as [constant GRASP].
	AUTOMATIC,
	## Measures how hard the fingers press the body between the pads, or the closed pads on each other:
	## [method SpidarGHand.get_squeeze_torque] divided by [member full_squeeze].
	SQUEEZE,
	## Measures how far the input action [member SpidarGConfig.grasp_action] is pressed.
	ACTION,
	## Measures how far the grasp is closed, as the input [code]grip[/code] does.
	GRASP,
}

const _Finder := preload("follow/spidar_finder.gd")
const _FrameMotion := preload("follow/frame_motion.gd")
const _PlaySpace := preload("follow/play_space.gd")
const _Inputs := preload("follow/tracker_inputs.gd")
## The group that contains all nodes of this class in the scene tree.
const GROUP: StringName = &"spidar_g_trackers"
## The interaction profile that a tracker has unless [member profile] is set.
const DEFAULT_PROFILE: String = "/interaction_profiles/oculus/touch_controller"
## The names of the poses that a tracker has.
const POSES: Array[StringName] = [&"default", &"grip", &"aim"]

## Selects the tracker that the device becomes. If two nodes select the same tracker, the second one pushes an error and does
## nothing, and a configuration warning says so.
@export var hand := Hand.RIGHT:
	set(value):
		hand = value
		notify_property_list_changed()
		_restart()
## Sets the name of the tracker if [member hand] is Other. It must not be empty.
@export var custom_name: StringName = &"":
	set(value):
		custom_name = value
		_restart()
## Sets the [SpidarG] that is published. With an empty path the nearest ancestor that is a [SpidarG] is used.
@export_node_path("SpidarG") var spidar_path: NodePath:
	set(value):
		spidar_path = value
		_restart()
## Sets the OpenXR interaction profile that the tracker reports. Some scenes choose the model of the controller by it.
@export var profile: String = DEFAULT_PROFILE:
	set(value):
		profile = value
		_restart()
@export_group("Place")
## If [code]true[/code], the controller is at the place of the [SpidarG]'s grip in the scene, for any
## [member XROrigin3D.world_scale], origin and [member SpidarG.workspace_scale]. If [code]false[/code], the device is at
## [member device_transform] in the play space, as it must be if a headset shows where the real hands are.
@export var place_from_scene: bool = true
## Sets the pose of the center of the device's frame in the play space, relative to the XR origin, in meters of the play
## space. Ignored while [member place_from_scene] is on. [method calibrate_place] sets it. A transform that is not finite or
## no rotation is refused with an error, and the old one stays.
@export_custom(PROPERTY_HINT_NONE, "suffix:m") var device_transform := Transform3D.IDENTITY:
	set(value):
		device_transform = _checked_place("device_transform", value, device_transform)
## Sets the pose [code]aim[/code] in the frame of the grip, in meters. It points along its -z axis. A transform that is not
## finite or no rotation is refused with an error, and the old one stays.
@export_custom(PROPERTY_HINT_NONE, "suffix:m") var aim_offset := Transform3D.IDENTITY:
	set(value):
		aim_offset = _checked_place("aim_offset", value, aim_offset)
@export_group("Inputs")
## Selects what the input [code]trigger[/code] measures.
@export var trigger_source := TriggerSource.AUTOMATIC
## Sets the grasp torque at which the input [code]trigger[/code] is 1, in newton meters. A value that is not above 0 is
## refused with an error, and the old one stays.
@export_range(0.001, 1.0, 0.001, "or_greater", "suffix:N m") var full_squeeze: float = 0.05:
	set(value):
		if not (value > 0.0 and is_finite(value)):
			push_error("SpidarGTracker.full_squeeze = %s N m: give a finite number above 0; the old one stays." % value)
			return
		full_squeeze = value
## Sets the value of [code]grip[/code] or [code]trigger[/code] from which on [code]grip_click[/code] or
## [code]trigger_click[/code] is pressed. A value outside 0 to 1 is refused with an error, and the old one stays.
@export_range(0.0, 1.0, 0.01) var click_at: float = 0.7:
	set(value):
		click_at = _checked_part("click_at", value, click_at)
## Sets the value of [code]grip[/code] or [code]trigger[/code] below which [code]grip_click[/code] or
## [code]trigger_click[/code] is released. A value above [member click_at] acts as [member click_at]. A value outside 0 to 1
## is refused with an error, and the old one stays.
@export_range(0.0, 1.0, 0.01) var release_below: float = 0.5:
	set(value):
		release_below = _checked_part("release_below", value, release_below)
## Sets the names of the inputs for the buttons 0 to 7 of the device, in this order. A button that has no name here, or an
## empty one, is not sent to the tracker.
@export var buttons: PackedStringArray = [
	"ax_button", "by_button", "menu_button", "select_button", "primary_click", "secondary_click", "", "",
]

## The device whose pose and buttons are published. It is [code]null[/code] in the editor, if no [SpidarG] is found (a
## configuration warning says why), and if the [XRServer] has another tracker of this name (an error says so). There is no
## tracker, although this property is set, while the device is closed or in [constant SpidarG.STATE_FAULT], and if the name of
## the tracker is empty or taken by another node of this class. See [method is_published].
var spidar: SpidarG = null

var _hand: SpidarGHand = null
var _tracker: XRControllerTracker = null
var _claim: StringName = &""
# The motion of the XR origin, or of the device if place_from_scene is off.
var _base := _FrameMotion.new()
var _base_is_origin: bool = true


## Returns the name of the tracker: that of [member hand], or [member custom_name].
func get_tracker_name() -> StringName:
	match hand:
		Hand.RIGHT:
			return &"right_hand"
		Hand.LEFT:
			return &"left_hand"
	return custom_name


## Returns [code]true[/code] while the [XRServer] has the tracker of this node.
func is_published() -> bool:
	return _tracker != null


## Computes [member device_transform] from one pose of an XR controller, and sets [member place_from_scene] to
## [code]false[/code]. Hold the grip at the controller, in the same orientation, and pass the pose of the controller's tracker
## ([code]XRServer.get_tracker(&"left_hand").get_pose(&"grip").transform[/code]). With [param keep_upright] the device stays
## upright, as it stands on a desk, and only its heading is computed. Returns [code]false[/code] with a warning, and changes
## nothing, if no device is open or if [param tracker_pose] is not finite or no rotation.
func calibrate_place(tracker_pose: Transform3D, keep_upright: bool = true) -> bool:
	if spidar == null or spidar.get_state() == SpidarG.STATE_CLOSED:
		push_warning("SpidarGTracker.calibrate_place: no device is open. Open one, hold its grip at the controller, and call this again.")
		return false
	if not _PlaySpace.is_rigid(tracker_pose):
		push_warning("SpidarGTracker.calibrate_place: tracker_pose = %s: give a finite transform (m) without scale." % tracker_pose)
		return false
	device_transform = _PlaySpace.place_of_device(tracker_pose, _PlaySpace.grip_in_device(spidar), keep_upright)
	place_from_scene = false
	return true


## Returns the pose in the world that the [SpidarG] node needs while [member place_from_scene] is off, if its grip is to be at
## the same place as the [XRController3D]. The place of the controller is right for any [member SpidarG.workspace_scale].
func get_scene_place() -> Transform3D:
	var place := Transform3D(device_transform.basis, device_transform.origin * XRServer.world_scale)
	return _PlaySpace.origin_in_world() * place


func _enter_tree() -> void:
	add_to_group(GROUP)
	if is_node_ready():
		_restart()


func _ready() -> void:
	_restart()
	if spidar == null and not Engine.is_editor_hint() and ClassDB.class_exists(&"SpidarG"):
		push_warning(_Finder.problem(self, spidar_path, "SpidarGTracker"))


func _exit_tree() -> void:
	remove_from_group(GROUP)
	_stop()


func _validate_property(property: Dictionary) -> void:
	if property["name"] == "custom_name" and hand != Hand.OTHER:
		property["usage"] = PROPERTY_USAGE_NO_EDITOR


func _get_configuration_warnings() -> PackedStringArray:
	var warnings: PackedStringArray = []
	var problem: String = _Finder.problem(self, spidar_path, "SpidarGTracker")
	if not problem.is_empty():
		warnings.append(problem)
	if get_tracker_name().is_empty():
		warnings.append("SpidarGTracker publishes nothing: custom_name is empty. Give a name, or choose the right or left hand.")
	var rival: SpidarGTracker = _rival()
	if rival != null:
		warnings.append("Only one SpidarGTracker can be \"%s\", and \"%s\" already is. Give one of them another hand or custom_name."
			% [get_tracker_name(), rival.name])
	return warnings


func _physics_process(delta: float) -> void:
	if not is_instance_valid(spidar) or not spidar.is_inside_tree():
		_restart()
		return
	if not _is_there():
		_withdraw()
		return
	if _tracker == null and not _publish():
		return
	_note_base(delta)
	_set_poses()
	_set_inputs()


func _process(_delta: float) -> void:
	if _tracker != null and is_instance_valid(spidar) and spidar.is_inside_tree() and _is_there():
		_set_poses()


# Finds the device, and claims the name. The engine turns processing on just before _ready().
func _restart() -> void:
	if not is_inside_tree():
		return
	update_configuration_warnings()
	if not is_node_ready():
		return
	_stop()
	if Engine.is_editor_hint():
		return
	spidar = _Finder.find(self, spidar_path)
	if spidar == null or get_tracker_name().is_empty():
		return
	var rival: SpidarGTracker = _rival()
	if rival != null and not rival._claim.is_empty():
		push_error("SpidarGTracker \"%s\" does nothing: \"%s\" is published as \"%s\" already. Give one of them another hand or custom_name." % [name, rival.name, rival._claim])
		return
	_claim = get_tracker_name()
	spidar.button_changed.connect(_on_button_changed)
	_hand = _Finder.find_hand(spidar)
	_Finder.run_after(self, spidar)
	_Finder.run_after(self, _hand)
	_base.forget()
	set_process(true)
	set_physics_process(true)


func _stop() -> void:
	_withdraw()
	_claim = &""
	if is_instance_valid(spidar) and spidar.button_changed.is_connected(_on_button_changed):
		spidar.button_changed.disconnect(_on_button_changed)
	spidar = null
	_hand = null
	set_process(false)
	set_physics_process(false)


# Returns another node with the same tracker name in the tree, or null.
func _rival() -> SpidarGTracker:
	if not is_inside_tree():
		return null
	for node: Node in get_tree().get_nodes_in_group(GROUP):
		var other := node as SpidarGTracker
		if other != null and other != self and other.get_tracker_name() == get_tracker_name():
			return other
	return null


func _is_there() -> bool:
	var state: SpidarG.State = spidar.get_state()
	return state != SpidarG.STATE_CLOSED and state != SpidarG.STATE_FAULT


# Returns false, with one error, if an XR interface has a tracker of this name, such as a real controller.
func _publish() -> bool:
	if XRServer.get_tracker(_claim) != null:
		push_error("SpidarGTracker \"%s\" does nothing: XRServer has a tracker \"%s\" already, perhaps a real controller. Choose the other hand or a custom_name." % [name, _claim])
		_stop()
		return false
	_tracker = XRControllerTracker.new()
	_tracker.name = _claim
	_tracker.description = "SPIDAR-G: %s" % spidar.device_text
	_tracker.hand = _tracker_hand()
	_tracker.profile = profile
	XRServer.add_tracker(_tracker)
	return true


func _tracker_hand() -> XRPositionalTracker.TrackerHand:
	match hand:
		Hand.RIGHT:
			return XRPositionalTracker.TRACKER_HAND_RIGHT
		Hand.LEFT:
			return XRPositionalTracker.TRACKER_HAND_LEFT
	return XRPositionalTracker.TRACKER_HAND_UNKNOWN


func _withdraw() -> void:
	if _tracker == null:
		return
	for input: String in ["grip_click", "trigger_click"] + Array(buttons):
		if not input.is_empty() and _tracker.get_input(input) == true:
			_tracker.set_input(input, false)
	_tracker.set_input(&"grip", 0.0)
	_tracker.set_input(&"trigger", 0.0)
	for pose: StringName in POSES:
		_tracker.invalidate_pose(pose)
	XRServer.remove_tracker(_tracker)
	_tracker = null
	_base.forget()


static func _checked_place(field: String, value: Transform3D, old: Transform3D) -> Transform3D:
	if _PlaySpace.is_rigid(value):
		return value
	push_error("SpidarGTracker.%s = %s: give a finite transform (m) without scale; the old one stays." % [field, value])
	return old


static func _checked_part(field: String, value: float, old: float) -> float:
	if value >= 0.0 and value <= 1.0:
		return value
	push_error("SpidarGTracker.%s = %s: give 0 to 1; the old one stays." % [field, value])
	return old


func _set_inputs() -> void:
	if not is_instance_valid(_hand) or _hand.get_parent() != spidar:
		_hand = _Finder.find_hand(spidar)
	_Inputs.set_with_click(_tracker, "grip", _Inputs.closed_part(spidar), click_at, release_below)
	var trigger: float = _Inputs.trigger(trigger_source, spidar, _hand, full_squeeze)
	_Inputs.set_with_click(_tracker, "trigger", trigger, click_at, release_below)


func _on_button_changed(button: int, pressed: bool) -> void:
	if _tracker != null and button < buttons.size() and not buttons[button].is_empty():
		_tracker.set_input(buttons[button], pressed)


func _note_base(delta: float) -> void:
	if _base_is_origin != place_from_scene:
		_base_is_origin = place_from_scene
		_base.forget()
	_base.note(_PlaySpace.origin_in_world() if place_from_scene else spidar.global_transform.orthonormalized(), delta)


# Sets all poses relative to the XR origin: XRNode3D multiplies their place by XRServer.world_scale.
func _set_poses() -> void:
	var world_to_space: Basis
	var grip: Transform3D
	if place_from_scene:
		var origin: Transform3D = _PlaySpace.origin_in_world()
		grip = origin.inverse() * spidar.get_grip_transform()
		grip.origin /= XRServer.world_scale
		world_to_space = origin.basis.inverse()
	else:
		grip = device_transform * _PlaySpace.grip_in_device(spidar)
		world_to_space = device_transform.basis * spidar.global_basis.orthonormalized().inverse()
	var at: Vector3 = spidar.get_grip_transform().origin
	var velocity: Vector3 = world_to_space * (spidar.get_linear_velocity() - _base.velocity_at(at)) / XRServer.world_scale
	var turning: Vector3 = world_to_space * (spidar.get_angular_velocity() - _base.angular)
	var aim: Transform3D = grip * aim_offset
	var aim_velocity: Vector3 = velocity + turning.cross(aim.origin - grip.origin)
	var confidence: XRPose.TrackingConfidence = _confidence()
	_tracker.set_pose(&"default", grip, velocity, turning, confidence)
	_tracker.set_pose(&"grip", grip, velocity, turning, confidence)
	_tracker.set_pose(&"aim", aim, aim_velocity, turning, confidence)


# Only a device without forces can lack its zero, so the statistics are read in these states only.
func _confidence() -> XRPose.TrackingConfidence:
	var may_lack_zero: bool = spidar.get_state() in [SpidarG.STATE_CONNECTED, SpidarG.STATE_TAUT]
	if may_lack_zero and not spidar.is_simulated() and not spidar.get_statistics()["zero_known"]:
		return XRPose.XR_TRACKING_CONFIDENCE_LOW
	return XRPose.XR_TRACKING_CONFIDENCE_HIGH
