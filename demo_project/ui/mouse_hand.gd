extends Node
## Mouse and keyboard drive the simulated hand: the grip follows the cursor in the view plane, the wheel
## moves it in depth, dragging with the right button turns it, the left button closes the grasp.

const KEY_SPEED_M_S := 0.12
const KEY_TURN_RAD_S := 0.9
const WHEEL_STEP_M := 0.006
const DRAG_RAD_PER_PIXEL := 0.005
const REACH_M := 0.16
const TURN_LIMIT_RAD := deg_to_rad(40.0)
const CLOSE_SPEED_RAD_S := 1.2
const OPEN_ANGLE_RAD := deg_to_rad(4.0)
## Closing stops when the fingers push back this hard, or at the end of the jaw's way.
const SQUEEZE_NM := 0.10
const CLOSED_ANGLE_RAD := deg_to_rad(52.0)

const ModelHand := preload("res://play/model_hand.gd")

var spidar: SpidarG
## In place of the simulated device's own hand; null: that one.
var model: ModelHand
var camera: Camera3D
## Target in the device's frame.
var position_m := Vector3.ZERO
var yaw_rad := 0.0
var pitch_rad := 0.0
var roll_rad := 0.0
var grasp_angle_rad := OPEN_ANGLE_RAD

## The mouse chooses, it does not move the grip: see AutoAnimator.
var clicks_only := false
## Held: the cursor moves and the grip stays.
var clutched := false

var _closing := false
var _turning := false


func start(spidar_: SpidarG, camera_: Camera3D, position_: Vector3) -> void:
	spidar = spidar_
	camera = camera_
	recentre(position_)


func recentre(position_: Vector3) -> void:
	position_m = position_
	yaw_rad = 0.0
	pitch_rad = 0.0
	roll_rad = 0.0
	_closing = false
	grasp_angle_rad = OPEN_ANGLE_RAD


## Goes on from a pose that the grip was brought to.
func follow(pose: Transform3D, grasp_angle: float, closed: bool) -> void:
	var in_device := spidar.global_transform.orthonormalized().affine_inverse() * pose
	position_m = in_device.origin / spidar.workspace_scale
	var turn := in_device.basis.get_euler()
	pitch_rad = turn.x
	yaw_rad = turn.y
	roll_rad = turn.z
	grasp_angle_rad = grasp_angle
	_closing = closed


func _unhandled_input(event: InputEvent) -> void:
	if clicks_only or clutched:
		return
	if event is InputEventMouseMotion:
		_on_motion(event as InputEventMouseMotion)
	elif event is InputEventMouseButton:
		_on_button(event as InputEventMouseButton)


func _physics_process(delta: float) -> void:
	var move := Vector3(
		Input.get_axis(&"demo_move_left", &"demo_move_right"),
		Input.get_axis(&"demo_move_down", &"demo_move_up"),
		Input.get_axis(&"demo_move_away", &"demo_move_near")
	)
	position_m += move * KEY_SPEED_M_S * delta
	yaw_rad += Input.get_axis(&"demo_turn_right", &"demo_turn_left") * KEY_TURN_RAD_S * delta
	pitch_rad += Input.get_axis(&"demo_tilt_back", &"demo_tilt_forward") * KEY_TURN_RAD_S * delta
	roll_rad += Input.get_axis(&"demo_roll_right", &"demo_roll_left") * KEY_TURN_RAD_S * delta
	_clamp()
	_move_grasp(delta)
	var basis := Basis.from_euler(Vector3(pitch_rad, yaw_rad, roll_rad))
	var in_device := Transform3D(basis, position_m * spidar.workspace_scale)
	var target := spidar.global_transform.orthonormalized() * in_device
	if model == null:
		spidar.simulated_hand_target(target, grasp_angle_rad)
	else:
		model.aim(spidar, target, grasp_angle_rad)


func _on_motion(motion: InputEventMouseMotion) -> void:
	if _turning:
		yaw_rad += motion.relative.x * DRAG_RAD_PER_PIXEL
		pitch_rad += motion.relative.y * DRAG_RAD_PER_PIXEL
		return
	# The grip is under the cursor, at the depth where it is.
	var depth := -camera.to_local(spidar.to_global(position_m * spidar.workspace_scale)).z
	var under := camera.project_position(motion.position, depth)
	position_m = spidar.to_local(under) / spidar.workspace_scale
	_clamp()


func _on_button(button: InputEventMouseButton) -> void:
	if button.is_action(&"demo_grasp"):
		_closing = button.pressed
	elif button.is_action(&"demo_drag_turn"):
		_turning = button.pressed
		# Captured, the cursor stays where it was: the grip does not jump when the turn ends.
		Input.mouse_mode = Input.MOUSE_MODE_CAPTURED if _turning else Input.MOUSE_MODE_VISIBLE
	elif button.is_action_pressed(&"demo_wheel_away"): # A notch comes as a press and a release.
		_move_in_depth(WHEEL_STEP_M)
	elif button.is_action_pressed(&"demo_wheel_near"):
		_move_in_depth(-WHEEL_STEP_M)


func _move_in_depth(distance_m: float) -> void:
	# Along the ground, so that depth does not change the height over the table.
	var forward := -camera.global_basis.z
	forward.y = 0.0
	position_m += spidar.global_basis.orthonormalized().inverse() * forward.normalized() * distance_m


func _move_grasp(delta: float) -> void:
	if not _closing:
		grasp_angle_rad = maxf(grasp_angle_rad - CLOSE_SPEED_RAD_S * delta, OPEN_ANGLE_RAD)
		return
	var pushed_back := -spidar.get_achieved_wrench()[6] >= SQUEEZE_NM
	if not pushed_back:
		grasp_angle_rad = minf(grasp_angle_rad + CLOSE_SPEED_RAD_S * delta, CLOSED_ANGLE_RAD)


func _clamp() -> void:
	position_m = position_m.clamp(-Vector3.ONE * REACH_M, Vector3.ONE * REACH_M)
	yaw_rad = clampf(yaw_rad, -TURN_LIMIT_RAD, TURN_LIMIT_RAD)
	pitch_rad = clampf(pitch_rad, -TURN_LIMIT_RAD, TURN_LIMIT_RAD)
	roll_rad = clampf(roll_rad, -TURN_LIMIT_RAD, TURN_LIMIT_RAD)
