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
## [br]- The cursor moves the grip in the view plane, at its current depth.
## [br]- The wheel moves the grip in depth, along the ground, or along the view if the camera looks straight down.
## [br]- The left button closes the fingers while it is held. They stop where something pushes them back by
## [member squeeze_nm], or at their closed end.
## [br]- Dragging with the right button turns the grip.
## [br]- Shift is the clutch: while it is held, the cursor moves and the grip stays. Afterwards the grip keeps its distance to
## the cursor.
## [br]- A, D, W, S, Q and E move the grip along the axes of the device: left, right, away, near, down and up.
## [br]- The arrow keys turn and tilt the grip, and Page Up and Page Down roll it.
## [br]Each binding is an action of the [InputMap]; its name is a property of this node, such as [code]spidar_g_grasp[/code].
## An action that the project does not have gets its default binding when the node begins to act, and never in the editor. An
## empty name switches an action off.
## [br]Mouse events are read in [method Node._unhandled_input], after the user interface. While a text field has the focus,
## keys do not move the grip.

const _Bindings := preload("mouse_hand/bindings.gd")
const _DepthCue := preload("mouse_hand/depth_cue.gd")
const _Pointer := preload("mouse_hand/pointer.gd")
const _Values := preload("mouse_hand/values.gd")

## The grasp angle of the open fingers, in radians.
const OPEN_ANGLE_RAD: float = deg_to_rad(4.0)
## Empty fingers close this much further than [member SpidarGConfig.jaw_closed_angle], in radians.
const OVERCLOSE_RAD: float = deg_to_rad(2.0)
## If the strings push the fingers back by more than this grasp torque, in newton meters, the fingers close up to
## [constant PRESSING_RAD], so that a thin body can be squeezed as hard as a wide one.
const PUSHED_NM: float = 0.008
## The largest grasp angle of fingers that squeeze a body, in radians.
const PRESSING_RAD: float = deg_to_rad(80.0)
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
@export_custom(PROPERTY_HINT_NONE, "suffix:m") var start_m: Vector3 = Vector3.ZERO:
	set(value):
		start_m = _Values.finite(&"start_m", value, start_m, "m")

@export_group("Limits")
## Sets how far the grip moves from the center along each axis, in meters of device motion, from 0.01 to 0.5.
@export_range(0.01, 0.5, 0.005, "suffix:m") var reach_m: float = 0.16:
	set(value):
		reach_m = _Values.in_range(&"reach_m", value, reach_m, Vector2(0.01, 0.5), "m")
## Sets how far the grip is turned about each axis, in radians, from 0 to PI/2. The inspector shows degrees.
@export_range(0.0, 90.0, 1.0, "radians_as_degrees") var turn_limit_rad: float = deg_to_rad(40.0):
	set(value):
		turn_limit_rad = _Values.in_range(&"turn_limit_rad", value, turn_limit_rad, Vector2(0.0, 0.5 * PI), "rad")
## Sets the grasp torque of the strings at which the fingers stop closing, in newton meters, from 0.001 to 1.
@export_range(0.001, 1.0, 0.001, "suffix:N m") var squeeze_nm: float = 0.10:
	set(value):
		squeeze_nm = _Values.in_range(&"squeeze_nm", value, squeeze_nm, Vector2(0.001, 1.0), "N m")

@export_group("Speeds")
## Sets how fast a key moves the grip, in meters of device motion per second, from 0 to 1.
@export_range(0.0, 1.0, 0.01, "suffix:m/s") var key_speed_m_s: float = 0.12:
	set(value):
		key_speed_m_s = _Values.in_range(&"key_speed_m_s", value, key_speed_m_s, Vector2(0.0, 1.0), "m/s")
## Sets how fast a key turns the grip, in radians per second, from 0 to TAU. The inspector shows degrees.
@export_range(0.0, 360.0, 1.0, "radians_as_degrees") var key_turn_rad_s: float = 0.9:
	set(value):
		key_turn_rad_s = _Values.in_range(&"key_turn_rad_s", value, key_turn_rad_s, Vector2(0.0, TAU), "rad/s")
## Sets how far one notch of the wheel moves the grip, in meters of device motion, from 0 to 0.1.
@export_range(0.0, 0.1, 0.001, "suffix:m") var wheel_step_m: float = 0.006:
	set(value):
		wheel_step_m = _Values.in_range(&"wheel_step_m", value, wheel_step_m, Vector2(0.0, 0.1), "m")
## Sets how far a drag by one pixel turns the grip, in radians, from 0 to 0.1.
@export_range(0.0, 0.1, 0.001, "suffix:rad/px") var drag_turn_rad: float = 0.005:
	set(value):
		drag_turn_rad = _Values.in_range(&"drag_turn_rad", value, drag_turn_rad, Vector2(0.0, 0.1), "rad")
## Sets how fast the fingers close and open, in radians of grasp angle per second, from 0.01 to 10.
@export_range(0.01, 10.0, 0.01, "suffix:rad/s") var close_speed_rad_s: float = 1.2:
	set(value):
		close_speed_rad_s = _Values.in_range(&"close_speed_rad_s", value, close_speed_rad_s, Vector2(0.01, 10.0), "rad/s")

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

## The target position of the grip, in meters of device motion from the center, clamped to [member reach_m].
var position_m: Vector3 = Vector3.ZERO:
	set(value):
		position_m = _Values.finite(&"position_m", value, position_m, "m").clampf(-reach_m, reach_m)
## The target orientation of the grip: pitch, yaw and roll in radians, clamped to [member turn_limit_rad].
var turn_rad: Vector3 = Vector3.ZERO:
	set(value):
		turn_rad = _Values.finite(&"turn_rad", value, turn_rad, "rad").clampf(-turn_limit_rad, turn_limit_rad)
## The grasp angle to which the hand moves the fingers, in radians, from -PI to PI. The next physics tick moves it on, unless
## it is where the grasp action moves it.
var grasp_angle_rad: float = OPEN_ANGLE_RAD:
	set(value):
		grasp_angle_rad = _Values.in_range(&"grasp_angle_rad", value, grasp_angle_rad, Vector2(-PI, PI), "rad")
## A clutch for scripts: while it is [code]true[/code], the grip stays as with [member clutch_action].
var clutched: bool = false

var _device: SpidarG = null
var _cue: _DepthCue = null
var _closing: bool = false
var _pointer: _Pointer = _Pointer.new()


## Moves the hand to [param position], in meters of device motion, upright and open, under the cursor again.
func recenter(position: Vector3 = start_m) -> void:
	position_m = position
	turn_rad = Vector3.ZERO
	grasp_angle_rad = OPEN_ANGLE_RAD
	_closing = false
	_pointer.forget_clutch()


## Continues from [param pose] in the world and [param grasp_angle] in radians, to which a script has moved the grip. If
## [param closed] is [code]true[/code], the fingers stay closed until the grasp action is pressed and released. Requires a
## device.
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
	_closing = closed


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
			_pointer.end_turn()
		NOTIFICATION_DISABLED:
			_pointer.end_turn()
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
	_closing = false
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
		_pointer.end_turn()
	set_physics_process(acts)
	set_process_unhandled_input(acts)
	_update_cue()


func _physics_process(delta: float) -> void:
	if not _has_device() or not _has_hand():
		_update_acting()
		return
	_move_by_keys(delta)
	_move_fingers(delta)
	_aim(get_target(), grasp_angle_rad)
	if _cue != null:
		_cue.show_below(_device, depth_cue_mask, get_viewport().get_camera_3d())


# Keys move and turn the grip along and about the device's axes.
func _move_by_keys(delta: float) -> void:
	var focus: Control = get_viewport().gui_get_focus_owner()
	if focus is LineEdit or focus is TextEdit:
		return
	position_m += delta * key_speed_m_s * Vector3(
		_Bindings.axis(move_left_action, move_right_action),
		_Bindings.axis(move_down_action, move_up_action),
		_Bindings.axis(move_away_action, move_near_action)
	)
	turn_rad += delta * key_turn_rad_s * Vector3(
		_Bindings.axis(tilt_back_action, tilt_forward_action),
		_Bindings.axis(turn_right_action, turn_left_action),
		_Bindings.axis(roll_right_action, roll_left_action)
	)


func _move_fingers(delta: float) -> void:
	var pushed_nm: float = -_device.get_achieved_wrench()[6]
	var end_rad: float = _device.get_effective_config().jaw_closed_angle + OVERCLOSE_RAD
	if not _closing:
		grasp_angle_rad = maxf(minf(grasp_angle_rad, end_rad) - close_speed_rad_s * delta, OPEN_ANGLE_RAD)
	elif pushed_nm < squeeze_nm:
		end_rad = PRESSING_RAD if pushed_nm > PUSHED_NM else end_rad
		grasp_angle_rad = minf(grasp_angle_rad + close_speed_rad_s * delta, end_rad)


func _unhandled_input(event: InputEvent) -> void:
	if event is InputEventMouseMotion:
		_on_motion(event as InputEventMouseMotion)
	elif _Bindings.is_pressed(event, grasp_action):
		_closing = true
	elif _Bindings.is_released(event, grasp_action):
		_closing = false
	elif _Bindings.is_released(event, turn_action):
		_pointer.end_turn()
	elif is_clutched():
		return
	elif _Bindings.is_pressed(event, turn_action):
		_pointer.begin_turn()
	elif _Bindings.is_pressed(event, wheel_away_action):
		_move_in_depth(wheel_step_m)
	elif _Bindings.is_pressed(event, wheel_near_action):
		_move_in_depth(-wheel_step_m)


func _on_motion(motion: InputEventMouseMotion) -> void:
	var camera: Camera3D = get_viewport().get_camera_3d()
	if _pointer.turning and not is_clutched():
		turn_rad += drag_turn_rad * Vector3(motion.relative.y, motion.relative.x, 0.0)
	elif camera != null and not _pointer.turning:
		var under: Vector3 = _pointer.point(motion, camera, get_target().origin, is_clutched())
		position_m = _frame().affine_inverse() * under / _device.workspace_scale


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

