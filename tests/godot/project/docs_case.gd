## Base of the tests of docs/how_to: reads the GDScript blocks of a page and runs them as scenes.
extends "res://hand_scene.gd"

const FOLDER: String = "../../../docs/how_to/"

## The scene of the last block that was opened.
var scene: Node3D
## How the hand is turned in the world.
var turn := Basis.IDENTITY


## The names of the pages that have a GDScript block.
func pages() -> PackedStringArray:
	var names: PackedStringArray = []
	for name: String in DirAccess.get_files_at(ProjectSettings.globalize_path("res://") + FOLDER):
		if name.ends_with(".md") and not blocks(name).is_empty():
			names.append(name)
	return names


## The GDScript blocks of a page by the heading above them. Each heading has one block at most.
func blocks(page: String) -> Dictionary[String, String]:
	var file: FileAccess = FileAccess.open(ProjectSettings.globalize_path("res://") + FOLDER + page, FileAccess.READ)
	var found: Dictionary[String, String] = {}
	if not check(file != null, "%s is there" % page):
		return found
	var heading: String = ""
	var inside: bool = false
	while not file.eof_reached():
		var line: String = file.get_line()
		if line.begins_with("```"):
			inside = not inside and line == "```gdscript"
			if inside:
				check(not found.has(heading), "%s has one block below \"%s\"" % [page, heading])
				found[heading] = ""
		elif inside:
			found[heading] += line.replace("    ", "\t") + "\n"
		elif line.begins_with("#"):
			heading = line.lstrip("# ")
	return found


## The block below a heading as a script; null, and a failed check, when there is none or it does not compile.
func compiled(page: String, heading: String, around: String = "") -> GDScript:
	var source: String = blocks(page).get(heading, "")
	if not check(source != "", "%s has a block below \"%s\"" % [page, heading]):
		return null
	var script := GDScript.new()
	script.source_code = source if around == "" else around + source.indent("\t")
	var error: Error = script.reload()
	check(error == OK, "%s, %s compiles:\n%s" % [page, heading, source])
	return script if error == OK else null


## Runs the block below a heading as a scene, in simulated time, on devices without friction and stretch. The test moves
## the hand, so the mouse hands of the page are taken out. Waits until the forces are on.
func open_page(page: String, heading: String) -> bool:
	var script: GDScript = compiled(page, heading)
	if script == null:
		return false
	scene = script.new()
	for property: Dictionary in script.get_script_property_list():
		var value: Variant = scene.get(property["name"])
		if value is SpidarG:
			(value as SpidarG).drive_mode = SpidarG.DRIVE_STEPPED
	add(scene)
	for mouse: Node in scene.find_children("*", "SpidarGMouseHand", true, false):
		mouse.free()
	device = scene.find_children("*", "SpidarG", true, false)[0]
	hand = scene.find_children("*", "SpidarGHand", true, false).pop_front()
	for node: SpidarG in scene.find_children("*", "SpidarG", true, false):
		node.request_rejected.connect(func(message: String) -> void: check(false, "%s: %s" % [page, message]))
		node.config = _without_friction(node.get_effective_config())
	at = device.global_position
	turn = device.global_basis
	await move_to(at, 0.0, ARMING_FRAMES)
	return true


func close_page() -> void:
	scene.free()
	at = Vector3.ZERO
	angle = 0.0
	await physics_frames(2)


## Moves the target of the simulated hand in a straight line.
func move_to(to: Vector3, to_angle: float, frame_count: int) -> void:
	var from: Vector3 = at
	var from_angle: float = angle
	for i: int in frame_count:
		var part: float = float(i + 1) / frame_count
		at = from.lerp(to, part)
		angle = lerpf(from_angle, to_angle, part)
		device.set_simulated_hand_target(Transform3D(turn, at), angle)
		await physics_frames(1)


func _without_friction(config: SpidarGConfig) -> SpidarGConfig:
	var ideal: SpidarGConfig = config.duplicate()
	ideal.simulated_elastic = false
	ideal.simulated_friction = 0.0
	return ideal
