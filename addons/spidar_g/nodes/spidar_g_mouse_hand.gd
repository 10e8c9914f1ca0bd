@tool
@icon("../icons/spidar_g_mouse_hand.svg")
class_name SpidarGMouseHand
extends Node
## Moves the simulated hand of a [SpidarG] by mouse, wheel and keys, so that a scene can be tried without a device.
##
## Add it as a child of a [SpidarG], or set [member spidar]. It uses the current [Camera3D] of its viewport. It acts only
## while the device is the simulated one ([method SpidarG.is_simulated]); a real device has a hand of its own, and the node
## then does nothing and costs nothing.
## [codeblock]
## var device := SpidarG.new()
## add_child(device)
## device.add_child(SpidarGHand.new())
## device.add_child(SpidarGMouseHand.new())
## device.forces_enabled = true
## [/codeblock]
## What the mouse and the keys do, where the project does not bind the actions to other keys:
## [br]- The cursor moves the grip in the view plane, at its present depth.
## [br]- The wheel moves it in depth, along the ground; where the camera looks straight down, along the view.
## [br]- The left button closes the fingers while it is held. They stop where something pushes them back by
## [member squeeze_nm], or at the end of their way.
## [br]- Dragging with the right button turns the grip.
## [br]- Shift is the clutch: while it is held, the cursor moves and the grip stays. Afterwards the grip keeps its distance
## to the cursor.
## [br]- A, D, W, S, Q and E move the grip along the device's axes: left, right, away, near, down and up.
## [br]- The arrow keys turn and tilt it, Page Up and Page Down roll it.
## [br]Each of these is an action of the [InputMap], whose name is a property of this node, [code]spidar_g_grasp[/code] for
## example. An action that the project does not have gets the key above when the node begins to act; this never happens in
## the editor. An empty name switches an action off.
## [br]Mouse events are taken in [method Node._unhandled_input], after the user interface. While a text field has the focus,
## keys move nothing.

const _Bindings := preload("mouse_hand/bindings.gd")
const _DepthCue := preload("mouse_hand/depth_cue.gd")
const _Pointer := preload("mouse_hand/pointer.gd")
const _Values := preload("mouse_hand/values.gd")

## How far the open fingers are closed, rad.
const OPEN_ANGLE_RAD: float = deg_to_rad(4.0)
## Empty fingers close this much farther than the jaws do, rad.
const OVERCLOSE_RAD: float = deg_to_rad(2.0)
## Fingers that are pushed back by more than closed pads push each other, N m, close on to this angle, rad: so that a thin
## body can be pressed as hard as a wide one.
const PUSHED_NM: float = 0.008
const PRESSING_RAD: float = deg_to_rad(80.0)
const WITHOUT_DEVICE: String = (
	"SpidarGMouseHand moves nothing: make it a child of a SpidarG node, or set its property spidar to one."
)

## Whether mouse and keys move the hand. When it is switched on again, the hand goes on from where the grip is.
@export var enabled: bool = true:
	set(value):
		var acted: bool = is_acting()
		enabled = value
		_update_acting()
		if is_acting() and not acted:
			follow(_device.get_grip_transform(), _device.get_grasp_angle(), false)
## The device whose hand is moved. Without one it is the parent.
@export var spidar: SpidarG = null:
	set(value):
		spidar = value
		if is_inside_tree():
			_detach()
			_attach()
## Where the grip is to be at the start, in device metres from the center of the device's frame, along the device's axes.
## A value that is not finite is refused with an error.
@export_custom(PROPERTY_HINT_NONE, "suffix:m") var start_m: Vector3 = Vector3.ZERO:
	set(value):
		start_m = _Values.finite(&"start_m", value, start_m, "m")

@export_group("Limits")
## How far the grip is moved from the center of the frame along each axis, in device metres. From 0.01 to 0.5 m.
@export_range(0.01, 0.5, 0.005, "suffix:m") var reach_m: float = 0.16:
	set(value):
		reach_m = _Values.in_range(&"reach_m", value, reach_m, Vector2(0.01, 0.5), "m")
## How far the grip is turned about each axis, in rad. From 0 to pi/2; the inspector shows degrees.
@export_range(0.0, 90.0, 1.0, "radians_as_degrees") var turn_limit_rad: float = deg_to_rad(40.0):
	set(value):
		turn_limit_rad = _Values.in_range(&"turn_limit_rad", value, turn_limit_rad, Vector2(0.0, 0.5 * PI), "rad")
## The fingers stop closing where the strings push them back by this grasp torque, in N m. From 0.001 to 1 N m.
@export_range(0.001, 1.0, 0.001, "suffix:N m") var squeeze_nm: float = 0.10:
	set(value):
		squeeze_nm = _Values.in_range(&"squeeze_nm", value, squeeze_nm, Vector2(0.001, 1.0), "N m")

@export_group("Speeds")
## How fast a key moves the grip, in device metres a second. From 0 to 1 m/s.
@export_range(0.0, 1.0, 0.01, "suffix:m/s") var key_speed_m_s: float = 0.12:
	set(value):
		key_speed_m_s = _Values.in_range(&"key_speed_m_s", value, key_speed_m_s, Vector2(0.0, 1.0), "m/s")
## How fast a key turns the grip, in rad/s. From 0 to 2 pi; the inspector shows degrees.
@export_range(0.0, 360.0, 1.0, "radians_as_degrees") var key_turn_rad_s: float = 0.9:
	set(value):
		key_turn_rad_s = _Values.in_range(&"key_turn_rad_s", value, key_turn_rad_s, Vector2(0.0, TAU), "rad/s")
## How far one notch of the wheel moves the grip, in device metres. From 0 to 0.1 m.
@export_range(0.0, 0.1, 0.001, "suffix:m") var wheel_step_m: float = 0.006:
	set(value):
		wheel_step_m = _Values.in_range(&"wheel_step_m", value, wheel_step_m, Vector2(0.0, 0.1), "m")
## How far dragging by one pixel turns the grip, in rad. From 0 to 0.1.
@export_range(0.0, 0.1, 0.001, "suffix:rad/px") var drag_turn_rad: float = 0.005:
	set(value):
		drag_turn_rad = _Values.in_range(&"drag_turn_rad", value, drag_turn_rad, Vector2(0.0, 0.1), "rad")
## How fast the fingers close and open, in rad of grasp angle a second. From 0.01 to 10 rad/s.
@export_range(0.01, 10.0, 0.01, "suffix:rad/s") var close_speed_rad_s: float = 1.2:
	set(value):
		close_speed_rad_s = _Values.in_range(&"close_speed_rad_s", value, close_speed_rad_s, Vector2(0.01, 10.0), "rad/s")

@export_group("Depth Cue")
## Whether a line from the grip to the first surface below it, and a ring on that surface, show where the hand is.
@export var show_depth_cue: bool = true:
	set(value):
		show_depth_cue = value
		_update_cue()
## The color of line and ring.
@export var depth_cue_color: Color = Color(1.0, 0.80, 0.25):
	set(value):
		depth_cue_color = value
		_update_cue()
## The physics layers on which the depth cue looks for surfaces.
@export_flags_3d_physics var depth_cue_mask: int = 1

@export_group("Actions")
## Closes the fingers while it is pressed. Default key: left mouse button.
@export var grasp_action: StringName = &"spidar_g_grasp"
## Turns the grip by the mouse while it is pressed. Default key: right mouse button.
@export var turn_action: StringName = &"spidar_g_turn"
## Holds the grip while it is pressed and the cursor moves. Default key: Shift.
@export var clutch_action: StringName = &"spidar_g_clutch"
## Moves the grip one step away from the viewer. Default key: mouse wheel up.
@export var wheel_away_action: StringName = &"spidar_g_wheel_away"
## Moves the grip one step towards the viewer. Default key: mouse wheel down.
@export var wheel_near_action: StringName = &"spidar_g_wheel_near"
## Moves the grip towards -x of the device. Default key: A.
@export var move_left_action: StringName = &"spidar_g_move_left"
## Moves the grip towards +x of the device. Default key: D.
@export var move_right_action: StringName = &"spidar_g_move_right"
## Moves the grip towards -y of the device. Default key: Q.
@export var move_down_action: StringName = &"spidar_g_move_down"
## Moves the grip towards +y of the device. Default key: E.
@export var move_up_action: StringName = &"spidar_g_move_up"
## Moves the grip towards -z of the device. Default key: W.
@export var move_away_action: StringName = &"spidar_g_move_away"
## Moves the grip towards +z of the device. Default key: S.
@export var move_near_action: StringName = &"spidar_g_move_near"
## Turns the grip to the left about y of the device. Default key: Left.
@export var turn_left_action: StringName = &"spidar_g_turn_left"
## Turns the grip to the right about y of the device. Default key: Right.
@export var turn_right_action: StringName = &"spidar_g_turn_right"
## Tilts the grip back about x of the device. Default key: Up.
@export var tilt_back_action: StringName = &"spidar_g_tilt_back"
## Tilts the grip forward about x of the device. Default key: Down.
@export var tilt_forward_action: StringName = &"spidar_g_tilt_forward"
## Rolls the grip to the left about z of the device. Default key: Page Up.
@export var roll_left_action: StringName = &"spidar_g_roll_left"
## Rolls the grip to the right about z of the device. Default key: Page Down.
@export var roll_right_action: StringName = &"spidar_g_roll_right"

## Where the hand wants the grip to be, in device metres from the center of the frame; kept within [member reach_m]. A value
## that is not finite is refused with an error.
var position_m: Vector3 = Vector3.ZERO:
	set(value):
		position_m = _Values.finite(&"position_m", value, position_m, "m").clampf(-reach_m, reach_m)
## How the hand wants the grip to be turned: pitch, yaw and roll in rad, as in [method Basis.from_euler]; kept within
## [member turn_limit_rad]. A value that is not finite is refused with an error.
var turn_rad: Vector3 = Vector3.ZERO:
	set(value):
		turn_rad = _Values.finite(&"turn_rad", value, turn_rad, "rad").clampf(-turn_limit_rad, turn_limit_rad)
## How far the hand wants the fingers to be closed, rad of grasp angle; kept from -pi to pi. A value that is not finite is
## refused with an error. The next physics tick moves it on, unless it is where the grasp action wants it.
var grasp_angle_rad: float = OPEN_ANGLE_RAD:
	set(value):
		grasp_angle_rad = _Values.in_range(&"grasp_angle_rad", value, grasp_angle_rad, Vector2(-PI, PI), "rad")
## A clutch for scripts: while it is [code]true[/code], the grip stays as with [member clutch_action].
var clutched: bool = false

var _device: SpidarG = null
var _cue: _DepthCue = null
var _closing: bool = false
var _pointer: _Pointer = _Pointer.new()


## Sends the hand to [param position] in device metres, upright and open, under the cursor again. Without an argument to
## [member start_m]. A position that is not finite is refused with an error.
func recenter(position: Vector3 = start_m) -> void:
	position_m = position
	turn_rad = Vector3.ZERO
	grasp_angle_rad = OPEN_ANGLE_RAD
	_closing = false
	_pointer.forget_clutch()


## Goes on from [param pose] (world) and [param grasp_angle] (rad), where a script has brought the grip. The fingers stay
## closed if [param closed] is [code]true[/code], until the grasp action is pressed and let go. Needs a device; values that
## are not finite are refused with an error.
func follow(pose: Transform3D, grasp_angle: float, closed: bool) -> void:
	if not _has_device():
		push_error("SpidarGMouseHand.follow: there is no device. " + WITHOUT_DEVICE)
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


## Returns whether mouse and keys move the hand now: the node is enabled and its device is the simulated one.
func is_acting() -> bool:
	return is_inside_tree() and is_physics_processing()


## Returns whether the grip stays while the cursor moves: by [member clutched], or by the clutch action.
func is_clutched() -> bool:
	return clutched or _Bindings.strength(clutch_action) > 0.0


## Where the hand wants the grip to be, in the world.
func get_target() -> Transform3D:
	var scale: float = _device.workspace_scale if _has_device() else 1.0
	return _frame() * Transform3D(Basis.from_euler(turn_rad), position_m * scale)


# Whether there is a hand to move. A script that extends this node and moves another hand overrides it with [method _aim].
func _has_hand() -> bool:
	return _device.is_simulated()


# Gives the hand its target once a physics tick: a pose in the world and a grasp angle in rad.
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
	return [] if is_instance_valid(spidar) or get_parent() is SpidarG else [WITHOUT_DEVICE]


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
		push_warning(WITHOUT_DEVICE)
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

