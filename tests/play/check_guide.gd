extends "check_case.gd"
## The guided start: each step goes on when its thing has been done and not before, for a mouse and for a hand that is no
## mouse; the whole takes no longer than half a minute; it is shown once, and from the menu again.

const GuidedStart := preload("res://hub/guided_start.gd")
const GuideSteps := preload("res://hub/guide_steps.gd")

## By a user who does at once what is asked, in simulated time.
const LIMIT_S := 30.0
const OPEN_RAD := 0.1
const CLOSED_RAD := 0.9
## A user reads for so long before doing a step.
const READING_S := 2.0


func _run() -> void:
	about = "guide"
	root.size = SIZES[0]
	await _check_steps_by_mouse()
	await _check_steps_by_hand()
	await _check_without_forces()
	await _check_restart()
	await _check_shown_once()


func _open_guide(settings: DemoSettings = DemoSettings.new()) -> GuidedStart:
	var guide := open("guided_start", settings) as GuidedStart
	await frames(3)
	return guide


func _ticks(count: int) -> void:
	for _tick in count:
		await physics_frame


## With events of a mouse: a motion, a button held down, a wheel.
func _check_steps_by_mouse() -> void:
	var guide := await _open_guide()
	await _ticks(90)
	check(guide.steps.step == GuideSteps.Step.MOVE, "the first step is done by nobody")
	await _move_mouse(guide, Vector3(0.06, 0.05, 0.0))
	check(guide.steps.step == GuideSteps.Step.CLOSE, "the mouse was moved, and the step is %d" % guide.steps.step)
	await _press_mouse(true)
	await _ticks(60)
	check(guide.steps.step == GuideSteps.Step.LIFT, "the fingers were closed, and the step is %d" % guide.steps.step)
	await _press_mouse(false)
	await _ticks(60)
	var thing: Node3D = guide.get_node(^"Items/Thing")
	for above: float in [0.08, 0.0]:
		await _move_mouse(guide, guide.to_local(thing.global_position) + Vector3.UP * above)
	await _press_mouse(true)
	await _ticks(90)
	check(guide.tool_hand.get_held_body() == thing, "the block is not held by the mouse hand")
	await _move_mouse(guide, guide.to_local(thing.global_position) + Vector3.UP * 0.06)
	check(guide.steps.step == GuideSteps.Step.FORCES, "the block was lifted, and the step is %d" % guide.steps.step)
	await press(KEY_F)
	for _tick in 240:
		await physics_frame
	check(guide.steps.step == GuideSteps.Step.DONE, "the forces are on, and the step is %d" % guide.steps.step)
	await _press_mouse(false)
	await close(guide)


## Brings the cursor to where `to` (m, the scene) is seen, and the grip to its depth, as the wheel does.
func _move_mouse(guide: GuidedStart, to: Vector3) -> void:
	var mouse := guide.get_node(^"MouseHand") as SpidarGMouseHand
	for _step in 3:
		var event := InputEventMouseMotion.new()
		event.position = root.get_final_transform() * root.get_camera_3d().unproject_position(to)
		event.global_position = event.position
		Input.parse_input_event(event)
		await frames(2)
		mouse.position_m.z = guide.spidar.to_local(to).z / guide.spidar.workspace_scale
	await _ticks(50)


func _press_mouse(down: bool) -> void:
	var event := InputEventMouseButton.new()
	event.button_index = MOUSE_BUTTON_LEFT
	event.pressed = down
	event.position = Vector2(root.size) * Vector2(0.75, 0.2)
	event.global_position = event.position
	Input.parse_input_event(event)
	await frames(2)


## As from a device: the hand is moved past the mouse and the keys; the forces come on by the button of the panel.
func _check_steps_by_hand() -> void:
	var guide := await _open_guide()
	(guide.get_node(^"MouseHand") as Node).process_mode = Node.PROCESS_MODE_DISABLED
	var began := Engine.get_physics_frames()
	var home := guide.spidar.get_grip_transform().origin
	await move_hand(guide, home, OPEN_RAD, READING_S)
	await move_hand(guide, home + Vector3(0.015, 0.0, 0.0), OPEN_RAD, 0.5)
	check(guide.steps.step == GuideSteps.Step.MOVE, "15 mm count as a move")
	await move_hand(guide, home + Vector3(0.06, 0.0, 0.0), OPEN_RAD)
	check(guide.steps.step == GuideSteps.Step.CLOSE, "moved, and the step is %d" % guide.steps.step)
	await move_hand(guide, home, OPEN_RAD, READING_S)
	check(guide.steps.step == GuideSteps.Step.CLOSE, "open fingers count as closed")
	await move_hand(guide, home, CLOSED_RAD)
	check(guide.steps.step == GuideSteps.Step.LIFT, "closed, and the step is %d" % guide.steps.step)
	await move_hand(guide, home, OPEN_RAD, READING_S)
	await move_hand(guide, home + Vector3.UP * 0.05, OPEN_RAD)
	check(guide.steps.step == GuideSteps.Step.LIFT, "an empty hand counts as a lift")
	var thing: RigidBody3D = guide.get_node(^"Items/Thing")
	thing.linear_velocity = Vector3.UP # thrown up by about 5 cm
	await _ticks(60)
	check(guide.steps.step == GuideSteps.Step.LIFT, "a block that jumps by itself counts as a lift")
	var at := thing.global_position
	await move_hand(guide, at + Vector3.UP * 0.08, OPEN_RAD)
	await move_hand(guide, at, OPEN_RAD)
	await move_hand(guide, at, CLOSED_RAD)
	check(guide.steps.step == GuideSteps.Step.LIFT, "held is not lifted")
	await move_hand(guide, at + Vector3.UP * 0.06, CLOSED_RAD)
	check(guide.steps.step == GuideSteps.Step.FORCES, "lifted, and the step is %d" % guide.steps.step)
	await move_hand(guide, at + Vector3.UP * 0.06, CLOSED_RAD, READING_S)
	check(not guide.spidar.forces_enabled, "the forces are on by themselves")
	var button: Button = guide.get_node(^"Guide/Panel/Rows/Forces")
	check(button.is_visible_in_tree() and button.has_focus(), "the button of the forces is not there")
	button.pressed.emit()
	await move_hand(guide, at + Vector3.UP * 0.06, CLOSED_RAD, 3.0)
	check(guide.steps.step == GuideSteps.Step.DONE, "forces on, and the step is %d" % guide.steps.step)
	var took_s := (Engine.get_physics_frames() - began) / float(Engine.physics_ticks_per_second)
	check(took_s <= LIMIT_S, "the steps took %.1f s" % took_s)
	print("guide: all steps by a hand that reads %.0f s for each: %.1f s" % [READING_S, took_s])
	var left := [0]
	guide.left.connect(func() -> void: left[0] += 1)
	await _ticks(roundi(GuidedStart.END_S * 60.0) + 10)
	check(left[0] == 1, "the menu opens %d times by itself" % left[0])
	await close(guide)


## Where the settings keep the forces off there is no step for them.
func _check_without_forces() -> void:
	var settings := DemoSettings.new()
	settings.forces_allowed = false
	var guide := await _open_guide(settings)
	check(guide.steps.count() == 3, "%d steps without forces" % guide.steps.count())
	guide.steps.step = GuideSteps.Step.LIFT
	(guide.get_node(^"MouseHand") as Node).process_mode = Node.PROCESS_MODE_DISABLED
	var at := (guide.get_node(^"Items/Thing") as Node3D).global_position
	await move_hand(guide, at + Vector3.UP * 0.08, OPEN_RAD)
	await move_hand(guide, at, OPEN_RAD)
	await move_hand(guide, at, CLOSED_RAD)
	await move_hand(guide, at + Vector3.UP * 0.06, CLOSED_RAD)
	check(guide.steps.step == GuideSteps.Step.DONE, "without forces the step after the lift is %d" % guide.steps.step)
	await close(guide)


func _check_restart() -> void:
	var guide := await _open_guide()
	var thing: RigidBody3D = guide.get_node(^"Items/Thing")
	var start := thing.position
	thing.position += Vector3(0.05, 0.05, 0.0)
	guide.steps.step = GuideSteps.Step.FORCES
	await press(KEY_R)
	await _ticks(30)
	check(thing.position.distance_to(start) < 0.002, "the block is not back at its start: %s" % thing.position)
	check(guide.steps.step == GuideSteps.Step.MOVE, "the steps do not begin anew")
	await close(guide)


## The very first start opens the guide; skipped, the menu; the next start opens the menu, from which the guide opens again.
func _check_shown_once() -> void:
	DirAccess.remove_absolute(DemoSettings.PATH)
	var main: Node = await _open_main()
	check(_name_of_scene(main) == "GuidedStart", "the first start opens " + _name_of_scene(main))
	await press(KEY_G)
	await frames(5)
	check(_name_of_scene(main).begins_with("Hub"), "after the guide comes " + _name_of_scene(main))
	await close(main)
	check(DemoSettings.load_or_default().guide_shown, "it is not remembered that the guide was shown")
	main = await _open_main()
	check(_name_of_scene(main) == "Hub", "the second start opens " + _name_of_scene(main))
	await press(KEY_8)
	await frames(5)
	check(_name_of_scene(main) == "GuidedStart", "the menu's entry opens " + _name_of_scene(main))
	await close(main)
	DirAccess.remove_absolute(DemoSettings.PATH)


func _open_main() -> Node:
	var main: Node = (load("res://main.tscn") as PackedScene).instantiate()
	root.add_child(main)
	await frames(5)
	return main


## Of what was opened last.
func _name_of_scene(main: Node) -> String:
	return String(main.get_child(main.get_child_count() - 1).name)
