## Base of the SpidarGMouseHand tests: the scene of the hand's tests, a mouse hand, a camera, and a user with mouse and keys.
extends "res://hand_scene.gd"

const DepthCue := preload("res://addons/spidar_g/nodes/mouse_hand/depth_cue.gd")
## Frames in which the simulated hand gets to where it is sent.
const REACH_FRAMES: int = 60
## How near the hand comes, m.
const NEAR_M: float = 0.002

var mouse: SpidarGMouseHand
var camera: Camera3D


## A device with forces on, a floor below, and a camera in front of it, 0.6 m away at scale 1.
func set_up_mouse(configure: Callable = Callable()) -> void:
	await set_up(Vector3.ZERO)
	add_camera(Vector3(0.0, 0.0, 0.6), Vector3.ZERO)
	mouse = SpidarGMouseHand.new()
	if configure.is_valid():
		configure.call(mouse)
	device.add_child(mouse)
	await physics_frames(2)


func add_camera(from: Vector3, to: Vector3, up: Vector3 = Vector3.UP) -> void:
	if camera == null:
		camera = Camera3D.new()
		add(camera)
	camera.near = 0.02
	camera.look_at_from_position(from, to, up)
	camera.make_current()


## Where the grip really is, world.
func grip() -> Transform3D:
	return device.get_simulated_truth()["grip_transform"]


func grip_closed() -> float:
	return device.get_simulated_truth()["grasp_angle"]


## The cursor goes to where a point of the world is seen.
func point_at(world: Vector3) -> void:
	move_cursor(camera.unproject_position(world))


func move_cursor(to_px: Vector2, by_px: Vector2 = Vector2.ZERO) -> void:
	var motion := InputEventMouseMotion.new()
	motion.position = to_px
	motion.global_position = to_px
	motion.relative = by_px
	tree.root.push_input(motion, true)


func button(index: MouseButton, pressed: bool, at_px: Vector2 = Vector2.ZERO) -> void:
	var event := InputEventMouseButton.new()
	event.button_index = index
	event.pressed = pressed
	event.position = at_px
	event.global_position = at_px
	tree.root.push_input(event, true)


func notch(index: MouseButton, times: int) -> void:
	for _i: int in times:
		button(index, true)
		button(index, false)


## A key of the keyboard, by its place.
func key(code: Key, pressed: bool) -> void:
	var event := InputEventKey.new()
	event.physical_keycode = code
	event.pressed = pressed
	Input.parse_input_event(event)
	Input.flush_buffered_events()


func hold_key(code: Key, frame_count: int) -> void:
	key(code, true)
	await physics_frames(frame_count)
	key(code, false)


func settle() -> void:
	await physics_frames(REACH_FRAMES)


func check_grip_at(wanted: Vector3, message: String) -> void:
	check_near(grip().origin.distance_to(wanted), 0.0, NEAR_M, "%s: the grip is at %s" % [message, grip().origin])


func cue() -> DepthCue:
	for child: Node in mouse.get_children(true):
		if child is DepthCue:
			return child as DepthCue
	return null
