## The scene of docs/start/first_scene.md, built from the page's own tables and played by mouse: what the page promises is felt.
extends "res://mouse_hand_scene.gd"

const Page := preload("res://first_scene_page.gd")
const STEPS: int = 10
const FIRST_FRAMES: int = 90
const CLOSING_FRAMES: int = 120
const BALL_N: float = 0.1 * 9.8
## The strings of the simulated device rub: what the hand feels differs by this from what the tensions give.
const FRICTION_N: float = 0.15

var scene := Node3D.new()
var page := Page.new()


func test_each_step_can_be_done_and_warns_of_nothing() -> void:
	if not _build():
		return
	_take()
	await physics_frames(2)
	for node: Node in scene.find_children("*", "", true, false):
		var warnings: Variant = PackedStringArray()
		if node.has_method(&"_get_configuration_warnings"):
			warnings = node.call(&"_get_configuration_warnings")
		elif node.has_method(&"get_warnings"):
			warnings = node.call(&"get_warnings")
		check_equal(warnings, PackedStringArray(), "%s has no warning" % node.name)
	for step: int in range(1, STEPS + 1):
		var picture: String = Page.PAGE.get_base_dir() + "/../pictures/first_scene/step_%02d.png" % step
		check(FileAccess.file_exists(ProjectSettings.globalize_path("res://") + picture), "step %d has its picture" % step)


func test_the_table_and_the_ball_are_felt_and_the_ball_is_lifted() -> void:
	if not _build():
		return
	_take()
	await physics_frames(FIRST_FRAMES)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "the forces are on")

	point_at(Vector3(-0.06, -0.095, 0.0))
	await settle()
	var pressed: float = felt_n().y
	check(pressed > 0.5, "the table pushes the hand up: %.2f N" % pressed)
	check(_shown().contains("+"), "the label says so: %s" % _shown())

	point_at(Vector3(-0.06, 0.02, 0.0))
	await settle()
	var ball: RigidBody3D = scene.get_node(^"Ball")
	point_at(Vector3(ball.position.x, 0.02, 0.0))
	await settle()
	point_at(ball.global_position)
	await settle()
	button(MOUSE_BUTTON_LEFT, true)
	await physics_frames(CLOSING_FRAMES)
	check_equal(hand.get_held_body(), ball, "the ball is held")
	check(device.get_achieved_wrench()[6] < -0.02, "the ball pushes the fingers open: %.3f N m" % device.get_achieved_wrench()[6])

	var height: float = ball.global_position.y
	point_at(ball.global_position + Vector3(0.0, 0.08, 0.0))
	await settle()
	await settle()
	var lifted: float = ball.global_position.y - height
	check(lifted > 0.06, "the ball is lifted: %.3f m" % lifted)
	check_near(_shown().to_float(), -BALL_N, 0.05, "the label shows the weight of the ball, N")
	check_near(felt_n().y, -BALL_N, FRICTION_N, "the hand feels it, N")
	print("INFO pressed %.2f N, lifted %.1f mm, felt %.3f N, shown \"%s\"" % [pressed, 1e3 * lifted, felt_n().y, _shown()])
	button(MOUSE_BUTTON_LEFT, false)


## The ten steps, done outside of the tree as in an editor.
func _build() -> bool:
	if not check(page.read(), "the page is there"):
		return false
	check_equal(page.titles.size(), STEPS, "it has ten steps")
	for step: int in page.titles:
		check_equal(page.build(scene, step), PackedStringArray(), "step %d can be done" % step)
	if not failures.is_empty():
		scene.free()
	return failures.is_empty()


## The scene into the tree, in simulated time.
func _take() -> void:
	device = scene.get_node(^"SpidarG")
	hand = scene.get_node(^"SpidarG/SpidarGHand")
	mouse = scene.get_node(^"SpidarG/SpidarGMouseHand")
	camera = scene.get_node(^"Camera")
	device.drive_mode = SpidarG.DRIVE_STEPPED
	add(scene)


## The force on the simulated hand, N.
func felt_n() -> Vector3:
	var felt: PackedFloat64Array = device.get_simulated_truth()["strings_wrench"]
	return Vector3(felt[0], felt[1], felt[2])


## The number that the label shows, as text.
func _shown() -> String:
	return (scene.get_node(^"Force") as Label).text.get_slice(": ", 1)
