## Every example of docs/how_to/use_in_your_game.md runs as it stands there, and is felt.
extends "res://test_case.gd"

const PAGE: String = "../../../docs/how_to/use_in_your_game.md"
const LISTING: String = "Ten lines to a felt object"
## It opens a scene of the reader's; tests/package/missing_library is the game that does so.
const NOT_FELT: String = "Where there is no library"
## It is for a table of the reader's; what it does is measured in test_material.gd.
const MATERIAL: String = "How things feel"
## What stands around an example that is no script of its own.
const AROUND: String = "extends Node3D\nvar device: SpidarG\nfunc example() -> void:\n"
const FRAMES: int = 120
const MEASURED: int = 40


## By heading: where the hand goes (y or z, grasp angle), and what it must feel there.
func _examples() -> Dictionary[String, Dictionary]:
	return {
		"A wall": {"y": -0.04, "felt": func(w: PackedFloat64Array) -> bool: return w[1] > 1.0},
		"A width between the fingers": {"angle": 0.6, "felt": func(w: PackedFloat64Array) -> bool: return w[6] < -0.01},
		"Something held or dragged": {"felt": func(w: PackedFloat64Array) -> bool: return w[0] > 1.0},
		"A weight": {"felt": func(w: PackedFloat64Array) -> bool: return absf(w[1] + 1.5) < 0.05},
		"A steady push": {"felt": func(w: PackedFloat64Array) -> bool: return absf(w[0] - 0.8) < 0.03},
		"A spring to a place": {"felt": func(w: PackedFloat64Array) -> bool: return w[2] > 0.5},
		# 5 cm/s upwards: it pulls down by 6 N s/m.
		"Honey": {"speed": 0.05, "felt": func(w: PackedFloat64Array) -> bool: return absf(w[1] + 0.3) < 0.1},
		"A buzz": {"swings": true, "felt": func(w: PackedFloat64Array) -> bool: return w[0] > 0.3},
		# 2 mm past a valley: back into it.
		"Clicks of a slider": {"z": 0.002, "felt": func(w: PackedFloat64Array) -> bool: return w[2] < -0.05},
	}


func test_the_listing_is_felt() -> void:
	var listing: String = _blocks().get(LISTING, "")
	var script: GDScript = _compiled(LISTING, listing)
	if script == null:
		return
	var scene: Node3D = script.new()
	var device: SpidarG = scene.get("device")
	device.drive_mode = SpidarG.DRIVE_STEPPED
	add(scene)
	await physics_frames(FRAMES)
	check(device.get_achieved_wrench()[1] > 0.5, "the table pushes up: %s" % device.get_achieved_wrench())


func test_each_example_is_felt() -> void:
	var blocks: Dictionary[String, String] = _blocks()
	var examples: Dictionary[String, Dictionary] = _examples()
	check_equal(blocks.size(), examples.size() + 3, "every example has its check, every check its example")
	_compiled(NOT_FELT, blocks.get(NOT_FELT, ""))
	await _gives_a_table_ribs(blocks.get(MATERIAL, ""))
	for heading: String in examples:
		if not check(blocks.has(heading), "the page has \"%s\"" % heading):
			continue
		var lines: String = blocks[heading].indent("\t")
		var script: GDScript = _compiled(heading, AROUND + lines)
		if script != null:
			await _is_felt(heading, script, examples[heading])


func _gives_a_table_ribs(lines: String) -> void:
	var script: GDScript = _compiled(MATERIAL, "extends Node3D\nvar table := StaticBody3D.new()\nfunc example() -> void:\n" + lines.indent("\t"))
	if script == null:
		return
	var scene: Node3D = script.new()
	var table: StaticBody3D = scene.get("table")
	add(scene)
	scene.add_child(table)
	scene.call("example")
	var surface: SpidarGSurface = table.get_child(0)
	check_equal(surface.get_warnings().size(), 0, "the table has ribs")
	check_near(surface.material.texture_wavelength, 0.004, 1e-9, "of 4 mm")
	scene.free()


func _is_felt(heading: String, script: GDScript, told: Dictionary) -> void:
	var scene: Node3D = script.new()
	var device: SpidarG = ideal_device()
	device.forces_enabled = true
	device.request_rejected.connect(func(message: String) -> void: check(false, "%s: %s" % [heading, message]))
	scene.set("device", device)
	scene.add_child(device)
	add(scene)
	var place := Vector3(0.0, told.get("y", 0.0), told.get("z", 0.0))
	var speed: float = told.get("speed", 0.0)
	var sum: PackedFloat64Array = [0, 0, 0, 0, 0, 0, 0]
	var most: PackedFloat64Array = [0, 0, 0, 0, 0, 0, 0]
	for frame: int in FRAMES:
		var moved := Vector3(0.0, speed * (frame - FRAMES / 2) / 60.0, 0.0)
		device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, place + moved), told.get("angle", 0.0))
		scene.call("example")
		await physics_frames(1)
		if frame >= FRAMES - MEASURED:
			var wrench: PackedFloat64Array = device.get_achieved_wrench()
			for dof: int in 7:
				sum[dof] += wrench[dof] / MEASURED
				most[dof] = maxf(most[dof], wrench[dof])
	var felt: Callable = told["felt"]
	var measured: PackedFloat64Array = most if told.get("swings", false) else sum
	check(felt.call(measured), "%s: felt %s" % [heading, measured])
	# It has to do with the request: without it the hand feels nothing.
	device.clear_contacts()
	device.clear_coupling()
	device.clear_effects()
	device.set_simulated_hand_target(Transform3D.IDENTITY, 0.0)
	await physics_frames(90)
	check(not felt.call(device.get_achieved_wrench()), "%s: and ends: %s" % [heading, device.get_achieved_wrench()])
	scene.free()


func _compiled(heading: String, source: String) -> GDScript:
	var script := GDScript.new()
	script.source_code = source
	var error: Error = script.reload()
	check(error == OK, "%s compiles:\n%s" % [heading, source])
	return script if error == OK else null


## The GDScript blocks of the page by the heading above them.
func _blocks() -> Dictionary[String, String]:
	var page: FileAccess = FileAccess.open(ProjectSettings.globalize_path("res://") + PAGE, FileAccess.READ)
	var blocks: Dictionary[String, String] = {}
	if not check(page != null, "the page is there"):
		return blocks
	var heading: String = ""
	var inside: bool = false
	while not page.eof_reached():
		var line: String = page.get_line()
		if line.begins_with("```"):
			inside = line == "```gdscript"
			if inside:
				blocks[heading] = ""
		elif inside:
			blocks[heading] += line.replace("    ", "\t") + "\n"
		elif line.begins_with("#"):
			heading = line.lstrip("# ")
	return blocks
