@tool
@icon("../icons/spidar_g_mouse_hand.svg")
class_name SpidarGMouseHand
extends Node
## Moves the simulated hand of a [SpidarG] by mouse, wheel and keys, so that a scene can be tried without a device.
##
## Add this node as a child of a [SpidarG], or set [member spidar]. It uses the current [Camera3D] of its viewport. It acts
## only while the device is the simulated one ([method SpidarG.is_simulated]). With a real device it does nothing and takes no
## time. A value outside its range, or one that is not finite, is refused with an error, and the old one stays.
## [codeblock]
## var device := SpidarG.new()
## add_child(device)
## device.add_child(SpidarGHand.new())
## device.add_child(SpidarGMouseHand.new())
## device.forces_enabled = true
## [/codeblock]
## These are the default bindings:
## [br]- The cursor moves the grip in the view plane, at its current depth and at 1 m/s of device motion or less. At the first
## motion, and after the wheel, the grip glides under the cursor at 0.25 m/s.
## [br]- The wheel moves the grip in depth, along the ground, or along the view if the camera looks straight down.
## [br]- The left button closes the fingers while it is held. They stop where something pushes them back by
## [member squeeze], or at their closed end.
## [br]- Dragging with the right button turns the grip.
## [br]- Shift is the clutch: while it is held, the cursor moves and the grip stays. Afterwards the grip keeps its distance to
## the cursor.
## [br]- A, D, W, S, Q and E move the grip along the axes of the device: left, right, away, near, down and up. Afterwards the
## grip keeps its distance to the cursor.
## [br]- The arrow keys turn and tilt the grip, and Page Up and Page Down roll it. Home turns it upright within 0.3 s.
## [br]Each binding is an action of the [InputMap]; its name is a property of this node, such as [code]spidar_g_grasp[/code].
## An action that the project does not have gets its default binding when the node begins to act, and never in the editor. An
## empty name switches an action off.
## [br]Mouse events are read in [method Node._unhandled_input], after the user interface. While a text field has the focus,
## keys do not move the grip.

const _Bindings := preload("mouse_hand/bindings.gd")
const _DepthCue := preload("mouse_hand/depth_cue.gd")
const _Fingers := preload("mouse_hand/fingers.gd")
const _Pointer := preload("mouse_hand/pointer.gd")
const _Turning := preload("mouse_hand/turning.gd")
const _Values := preload("mouse_hand/values.gd")

## The grasp angle of the open fingers, in radians.
const OPEN_ANGLE_RAD: float = _Fingers.OPEN_ANGLE_RAD
const _WITHOUT_DEVICE: String = (
	"SpidarGMouseHand moves nothing: make it a child of a SpidarG node, or set its property spidar to one."
)

## If [code]true[/code], mouse and keys move the hand. When it is switched on again, the hand continues from the current pose
## of the grip.
@export var enabled: bool = true:
	set(value):
		var acted: bool = is_acting()
		enabled = value
		_update_acting()
		if is_acting() and not acted:
			follow(_device.get_grip_transform(), _device.get_grasp_angle(), false)
## Sets the device whose hand is moved. If it is [code]null[/code], the parent is used.
@export var spidar: SpidarG = null:
	set(value):
		spidar = value
		if is_inside_tree():
			_detach()
			_attach()
## Sets the position of the grip at the start, in meters of device motion from the center of the frame.
@export_custom(PROPERTY_HINT_NONE, "suffix:m") var start: Vector3 = Vector3.ZERO:
	set(value):
		start = _Values.finite(&"start", value, start, "m")

@export_group("Limits")
## Sets how far the grip moves from the center along each axis, in meters of device motion, from 0.01 to 0.5.
@export_range(0.01, 0.5, 0.005, "suffix:m") var reach: float = 0.16:
	set(value):
		reach = _Values.in_range(&"reach", value, reach, Vector2(0.01, 0.5), "m")
## Sets how far the grip is turned about each axis, in radians, from 0 to PI/2. The inspector shows degrees.
@export_range(0.0, 90.0, 1.0, "radians_as_degrees") var turn_limit: float = deg_to_rad(40.0):
	set(value):
		turn_limit = _Values.in_range(&"turn_limit", value, turn_limit, Vector2(0.0, 0.5 * PI), "rad")
## Sets the grasp torque of the strings at which the fingers stop closing, in newton meters, from 0.001 to 1.
@export_range(0.001, 1.0, 0.001, "suffix:N m") var squeeze: float = 0.10:
	set(value):
		squeeze = _Values.in_range(&"squeeze", value, squeeze, Vector2(0.001, 1.0), "N m")

@export_group("Speeds")
## Sets how fast a key moves the grip, in meters of device motion per second, from 0 to 1.
@export_range(0.0, 1.0, 0.01, "suffix:m/s") var key_speed: float = 0.12:
	set(value):
		key_speed = _Values.in_range(&"key_speed", value, key_speed, Vector2(0.0, 1.0), "m/s")
## Sets how fast a key turns the grip, in radians per second, from 0 to TAU. The inspector shows degrees.
@export_range(0.0, 360.0, 1.0, "radians_as_degrees") var key_turn_speed: float = 0.9:
	set(value):
		key_turn_speed = _Values.in_range(&"key_turn_speed", value, key_turn_speed, Vector2(0.0, TAU), "rad/s")
## Sets how far one notch of the wheel moves the grip, in meters of device motion, from 0 to 0.1.
@export_range(0.0, 0.1, 0.001, "suffix:m") var wheel_step: float = 0.006:
	set(value):
		wheel_step = _Values.in_range(&"wheel_step", value, wheel_step, Vector2(0.0, 0.1), "m")
## Sets how far a drag by one pixel turns the grip, in radians, from 0 to 0.1.
@export_range(0.0, 0.1, 0.001, "suffix:rad/px") var drag_turn: float = 0.005:
	set(value):
		drag_turn = _Values.in_range(&"drag_turn", value, drag_turn, Vector2(0.0, 0.1), "rad")
## Sets how fast the fingers close and open, in radians of grasp angle per second, from 0.01 to 10.
@export_range(0.01, 10.0, 0.01, "suffix:rad/s") var close_speed: float = 1.2:
	set(value):
		close_speed = _Values.in_range(&"close_speed", value, close_speed, Vector2(0.01, 10.0), "rad/s")

@export_group("Depth Cue")
## If [code]true[/code], a line from the grip down to the first surface and a ring on it show the depth of the hand.
@export var show_depth_cue: bool = true:
	set(value):
		show_depth_cue = value
		_update_cue()
## Sets the color of the line and the ring of the depth cue.
@export var depth_cue_color: Color = Color(1.0, 0.80, 0.25):
	set(value):
		depth_cue_color = value
		_update_cue()
## Sets the physics layers on which the depth cue looks for surfaces.
@export_flags_3d_physics var depth_cue_mask: int = 1

@export_group("Actions")
## The action that closes the fingers while it is pressed. Default: left mouse button.
@export var grasp_action: StringName = &"spidar_g_grasp"
## The action that lets the mouse turn the grip while it is pressed. Default: right mouse button.
@export var turn_action: StringName = &"spidar_g_turn"
## The action that holds the grip while it is pressed and the cursor moves. Default: Shift.
@export var clutch_action: StringName = &"spidar_g_clutch"
## The action that moves the grip one step away from the viewer. Default: mouse wheel up.
@export var wheel_away_action: StringName = &"spidar_g_wheel_away"
## The action that moves the grip one step toward the viewer. Default: mouse wheel down.
@export var wheel_near_action: StringName = &"spidar_g_wheel_near"
## The action that moves the grip along -x of the device. Default: A.
@export var move_left_action: StringName = &"spidar_g_move_left"
## The action that moves the grip along +x of the device. Default: D.
@export var move_right_action: StringName = &"spidar_g_move_right"
## The action that moves the grip along -y of the device. Default: Q.
@export var move_down_action: StringName = &"spidar_g_move_down"
## The action that moves the grip along +y of the device. Default: E.
@export var move_up_action: StringName = &"spidar_g_move_up"
## The action that moves the grip along -z of the device. Default: W.
@export var move_away_action: StringName = &"spidar_g_move_away"
## The action that moves the grip along +z of the device. Default: S.
@export var move_near_action: StringName = &"spidar_g_move_near"
## The action that turns the grip to the left about y of the device. Default: Left.
@export var turn_left_action: StringName = &"spidar_g_turn_left"
## The action that turns the grip to the right about y of the device. Default: Right.
@export var turn_right_action: StringName = &"spidar_g_turn_right"
## The action that tilts the grip back about x of the device. Default: Up.
@export var tilt_back_action: StringName = &"spidar_g_tilt_back"
## The action that tilts the grip forward about x of the device. Default: Down.
@export var tilt_forward_action: StringName = &"spidar_g_tilt_forward"
## The action that rolls the grip to the left about z of the device. Default: Page Up.
@export var roll_left_action: StringName = &"spidar_g_roll_left"
## The action that rolls the grip to the right about z of the device. Default: Page Down.
@export var roll_right_action: StringName = &"spidar_g_roll_right"
## The action that turns the grip upright within 0.3 s, unless another action turns it meanwhile. Default: Home.
@export var upright_action: StringName = &"spidar_g_upright"

## The target position of the grip, in meters of device motion from the center, clamped to [member reach].
var position_m: Vector3 = Vector3.ZERO:
	set(value):
		position_m = _Values.finite(&"position_m", value, position_m, "m").clampf(-reach, reach)
## The target orientation of the grip: pitch, yaw and roll in radians, clamped to [member turn_limit].
var turn_rad: Vector3 = Vector3.ZERO:
	set(value):
		turn_rad = _Values.finite(&"turn_rad", value, turn_rad, "rad").clampf(-turn_limit, turn_limit)
## The grasp angle to which the hand moves the fingers, in radians, from -PI to PI. The next physics tick moves it on, unless
## it is where the grasp action moves it.
var grasp_angle_rad: float = OPEN_ANGLE_RAD:
	set(value):
		grasp_angle_rad = _Values.in_range(&"grasp_angle_rad", value, grasp_angle_rad, Vector2(-PI, PI), "rad")
## A clutch for scripts: while it is [code]true[/code], the grip stays as with [member clutch_action].
var clutched: bool = false

var _device: SpidarG = null
var _cue: _DepthCue = null
var _fingers: _Fingers = _Fingers.new()
var _pointer: _Pointer = _Pointer.new()
var _turning: _Turning = _Turning.new()


## Moves the hand to [param position], in meters of device motion, upright and open. At the next motion of the cursor the hand
## glides under it.
func recenter(position: Vector3 = start) -> void:
	position_m = position
	turn_rad = Vector3.ZERO
	grasp_angle_rad = OPEN_ANGLE_RAD
	_fingers.closing = false
	_pointer.forget()


## Continues from [param pose] in the world and [param grasp_angle] in radians, to which a script has moved the grip. If
## [param closed] is [code]true[/code], the fingers close on from this angle until something stops them, and open after the
## grasp action is pressed and released. Otherwise they open. Requires a device.
func follow(pose: Transform3D, grasp_angle: float, closed: bool) -> void:
	if not _has_device():
		push_error("SpidarGMouseHand.follow: there is no device. " + _WITHOUT_DEVICE)
		return
	if not pose.is_finite() or not is_finite(grasp_angle):
		push_error("SpidarGMouseHand.follow: pose = %s m, grasp_angle = %s rad: give finite numbers; the hand stays." % [
			pose, grasp_angle])
		return
	var in_device: Transform3D = _frame().affine_inverse() * pose
	position_m = in_device.origin / _device.workspace_scale
	turn_rad = in_device.basis.get_euler()
	grasp_angle_rad = grasp_angle
	_fingers.closing = closed
	_turning.end_upright()
	_pointer.forget()


## Returns [code]true[/code] while mouse and keys move the hand: the node is enabled and its device is the simulated one.
func is_acting() -> bool:
	return is_inside_tree() and is_physics_processing()


## Returns [code]true[/code] while the grip stays and the cursor moves, by [member clutched] or by the clutch action.
func is_clutched() -> bool:
	return clutched or _Bindings.strength(clutch_action) > 0.0


## Returns the pose in the world to which the hand moves the grip.
func get_target() -> Transform3D:
	var scale: float = _device.workspace_scale if _has_device() else 1.0
	return _frame() * Transform3D(Basis.from_euler(turn_rad), position_m * scale)


## Returns [code]true[/code] if there is a hand to move. A script that extends this node to move another hand overrides it
## together with [method _aim].
func _has_hand() -> bool:
	return _device.is_simulated()


## Moves the hand to [param target] in the world and to [param grasp_angle] in radians. It is called once per physics tick.
func _aim(target: Transform3D, grasp_angle: float) -> void:
	_device.set_simulated_hand_target(target, grasp_angle)


func _enter_tree() -> void:
	update_configuration_warnings()
	_attach()


func _ready() -> void:
	recenter()
	_update_acting()


func _exit_tree() -> void:
	_detach()


func _get_configuration_warnings() -> PackedStringArray:
	return [] if is_instance_valid(spidar) or get_parent() is SpidarG else [_WITHOUT_DEVICE]


func _notification(what: int) -> void:
	match what:
		NOTIFICATION_PAUSED, NOTIFICATION_WM_WINDOW_FOCUS_OUT, NOTIFICATION_APPLICATION_FOCUS_OUT:
			_turning.end_by_mouse()
		NOTIFICATION_DISABLED:
			_turning.end_by_mouse()
			if _cue != null:
				_cue.visible = false


func _attach() -> void:
	_device = spidar if is_instance_valid(spidar) else get_parent() as SpidarG
	if Engine.is_editor_hint():
		pass
	elif _device == null:
		push_warning(_WITHOUT_DEVICE)
	elif ClassDB.class_exists(&"SpidarG"):  # Without the add-on's library a SpidarG is a stand-in.
		_device.device_chosen.connect(_on_device_chosen)
		_device.device_lost.connect(_on_device_lost)
	_update_acting()


func _detach() -> void:
	if _has_device() and _device.device_chosen.is_connected(_on_device_chosen):
		_device.device_chosen.disconnect(_on_device_chosen)
		_device.device_lost.disconnect(_on_device_lost)
	_device = null
	_fingers.closing = false
	_update_acting()


func _on_device_chosen(_simulated: bool, _text: String, _reason: String) -> void:
	_update_acting()


func _on_device_lost(_reason: String) -> void:
	_update_acting()


func _has_device() -> bool:
	return is_instance_valid(_device)


# Switches everything on or off. The engine turns processing on just before _ready().
func _update_acting() -> void:
	var acts: bool = (
		enabled and _has_device() and not Engine.is_editor_hint() and ClassDB.class_exists(&"SpidarG") and _has_hand()
	)
	if acts:
		_Bindings.add_missing(self)
	else:
		_turning.end_by_mouse()
	set_physics_process(acts)
	set_process_unhandled_input(acts)
	_update_cue()


func _physics_process(delta: float) -> void:
	if not _has_device() or not _has_hand():
		_update_acting()
		return
	_move_by_keys(delta)
	turn_rad = _turning.step(turn_rad, delta)
	if is_clutched():
		_pointer.hold()
	else:
		position_m = _pointer.step(position_m, reach, delta)
	grasp_angle_rad = _fingers.step(grasp_angle_rad, close_speed * delta, squeeze, _device)
	_aim(get_target(), grasp_angle_rad)
	if _cue != null:
		_cue.show_below(_device, depth_cue_mask, get_viewport().get_camera_3d())


# Keys move and turn the grip along and about the device's axes.
func _move_by_keys(delta: float) -> void:
	var focus: Control = get_viewport().gui_get_focus_owner()
	if focus is LineEdit or focus is TextEdit:
		return
	var way: Vector3 = _Bindings.way(self)
	var turn: Vector3 = _Bindings.turn(self)
	position_m += delta * key_speed * way
	turn_rad += delta * key_turn_speed * turn
	if way != Vector3.ZERO:
		_pointer.keep_distance()
	if turn != Vector3.ZERO:
		_turning.end_upright()


func _unhandled_input(event: InputEvent) -> void:
	if event is InputEventMouseMotion:
		_on_motion(event as InputEventMouseMotion)
	elif _Bindings.is_pressed(event, grasp_action):
		_fingers.closing = true
	elif _Bindings.is_released(event, grasp_action):
		_fingers.closing = false
	elif _Bindings.is_released(event, turn_action):
		_turning.end_by_mouse()
	elif _Bindings.is_pressed(event, upright_action):
		_turning.begin_upright(turn_rad)
	elif is_clutched():
		return
	elif _Bindings.is_pressed(event, turn_action):
		_turning.begin_by_mouse()
	elif _Bindings.is_pressed(event, wheel_away_action):
		_move_in_depth(wheel_step)
	elif _Bindings.is_pressed(event, wheel_near_action):
		_move_in_depth(-wheel_step)


func _on_motion(motion: InputEventMouseMotion) -> void:
	var camera: Camera3D = get_viewport().get_camera_3d()
	if _turning.by_mouse and not is_clutched():
		turn_rad += drag_turn * Vector3(motion.relative.y, motion.relative.x, 0.0)
		_turning.end_upright()
	elif is_clutched() and not _turning.by_mouse:
		_pointer.note_cursor(motion)
	elif camera != null and not _turning.by_mouse:
		var to_world: Transform3D = _frame().scaled_local(Vector3.ONE * _device.workspace_scale)
		_pointer.follow(motion, camera, position_m, reach, to_world)


func _move_in_depth(distance_m: float) -> void:
	var camera: Camera3D = get_viewport().get_camera_3d()
	if camera != null:
		position_m += _frame().basis.inverse() * _Pointer.way_in_depth(camera) * distance_m


func _update_cue() -> void:
	var wanted: bool = show_depth_cue and is_acting()
	if not wanted and _cue != null:
		_cue.queue_free()
		_cue = null
	elif wanted and _cue == null:
		_cue = _DepthCue.new()
		# Internal: a copy of this node makes a cue of its own.
		add_child(_cue, false, Node.INTERNAL_MODE_FRONT)
	if _cue != null:
		_cue.set_color(depth_cue_color)


# The device's frame in the world, without a scale.
func _frame() -> Transform3D:
	return _device.global_transform.orthonormalized() if _has_device() else Transform3D.IDENTITY

