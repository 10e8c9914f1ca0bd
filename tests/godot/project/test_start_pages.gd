## The scripts of README.md and of docs/start run as they stand there, and are felt on the simulated device.
extends "res://test_case.gd"

const ROOT: String = "../../../"
const README: String = ROOT + "README.md"
const FIRST_DAY: String = ROOT + "docs/start/first_day_with_a_usb_device.md"
const FRAMES: int = 120
## Half a second draws the strings taut; the rest is for the hand to arrive.
const TAUT_FRAMES: int = 60
## Places of the hand, in meters, whose motion checks a zero.
const MOTION: PackedVector3Array = [Vector3(0.05, 0.03, 0.0), Vector3(-0.05, 0.0, 0.04), Vector3(0.0, -0.04, -0.03), Vector3.ZERO]

var device: SpidarG


func test_the_script_of_the_readme_is_felt() -> void:
	var script: GDScript = _compiled(README)
	if script == null:
		return
	var scene: Node3D = script.new()
	device = scene.get("device")
	device.drive_mode = SpidarG.DRIVE_STEPPED
	add(scene)
	check_equal(device.get_warnings(), PackedStringArray(), "no warning")
	var mouse: SpidarGMouseHand = null
	for child: Node in device.get_children():
		mouse = child if mouse == null and child is SpidarGMouseHand else mouse
	if not check(mouse != null, "a mouse hand moves the hand"):
		return
	await physics_frames(FRAMES)
	check(absf(device.get_achieved_wrench()[1]) < 0.2, "in free air: %s" % device.get_achieved_wrench())
	mouse.position_m = Vector3(0.0, -0.09, 0.0)
	await physics_frames(FRAMES)
	check(device.get_achieved_wrench()[1] > 0.5, "the box pushes up: %s" % device.get_achieved_wrench())


## The table of the page, line by line. The simulated device arms itself, a real one does not.
func test_the_first_force_of_2_newtons() -> void:
	var script: GDScript = _compiled(FIRST_DAY)
	if script == null:
		return
	var scene := Node3D.new()
	device = ideal_device()
	device.name = "SpidarG"
	device.config.max_force = 2.0
	scene.add_child(device)
	var status := Label.new()
	status.name = "Status"
	scene.add_child(status)
	scene.set_script(script)
	add(scene)
	await physics_frames(2)
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "no forces at first")
	await _tap(KEY_F)
	await physics_frames(FRAMES)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "the simulated device arms itself")
	await _tap(KEY_H)
	await physics_frames(5)
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "H: as a real device is after F")
	await _tap(KEY_Z)
	await physics_frames(TAUT_FRAMES)
	check_equal(device.get_state(), SpidarG.STATE_TAUT, "Z draws the strings taut")
	for place: Vector3 in MOTION:
		device.set_simulated_hand_target(Transform3D(Basis(Vector3.UP, 4.0 * place.x), place), 0.0)
		await physics_frames(TAUT_FRAMES)
	check(device.get_statistics()["zero_known"], "the motion confirms the zero: %s" % device.get_state_text())
	await _tap(KEY_G)
	await physics_frames(FRAMES)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "G arms")
	check(status.text.contains(device.get_state_text()), "the label shows the state: %s" % status.text)
	_key(KEY_SPACE, true)
	await physics_frames(FRAMES)
	check_near(device.get_achieved_wrench()[1], 2.0, 0.05, "Space: the upward force, N")
	_key(KEY_SPACE, false)
	await physics_frames(12)
	check_near(device.get_achieved_wrench()[1], 0.0, 0.05, "without Space the force fades, N")
	await _tap(KEY_H)
	await physics_frames(5)
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "H switches the motors off")
	device.panic_stop()
	await physics_frames(2)
	check_equal(device.get_state(), SpidarG.STATE_FAULT, "a panic stop is latched")
	await _tap(KEY_C)
	await physics_frames(5)
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "C clears the fault")


func _tap(code: Key) -> void:
	_key(code, true)
	await frames(1)
	_key(code, false)
	await frames(1)


func _key(code: Key, pressed: bool) -> void:
	var event := InputEventKey.new()
	event.physical_keycode = code
	event.pressed = pressed
	Input.parse_input_event(event)
	Input.flush_buffered_events()


## The one GDScript block of a page, compiled.
func _compiled(path: String) -> GDScript:
	var page: String = FileAccess.get_file_as_string(ProjectSettings.globalize_path("res://") + path)
	if not check(page.count("```gdscript\n") == 1, "%s has one script" % path):
		return null
	var script := GDScript.new()
	script.source_code = page.get_slice("```gdscript\n", 1).get_slice("```", 0).replace("    ", "\t")
	return script if check(script.reload() == OK, "the script of %s compiles" % path) else null
