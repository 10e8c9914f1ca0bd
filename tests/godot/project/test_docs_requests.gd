## docs/how_to/request_by_script.md: each line runs as it stands there, is felt, and ends when it is no longer refreshed.
extends "res://docs_case.gd"

const PAGE: String = "request_by_script.md"
## The page's smallest scene, which is a script of its own.
const SCENE: String = "Every kind of request from a script"
## What stands around an example that is no script of its own.
const AROUND: String = "extends Node3D\nvar device: SpidarG\nfunc example() -> void:\n"
const FRAMES: int = 120
const MEASURED: int = 40


## By heading: where the hand goes (y or z, grasp angle, turn about y), and what it must feel there.
func _examples() -> Dictionary[String, Dictionary]:
	return {
		"A wall": {"y": -0.04, "felt": func(w: PackedFloat64Array) -> bool: return absf(w[1] - 3.2) < 0.1},
		"A width between the fingers": {"angle": 0.6, "felt": func(w: PackedFloat64Array) -> bool: return w[6] < -0.01},
		"A turn stop": {"turn": -0.5, "felt": func(w: PackedFloat64Array) -> bool: return w[4] > 0.05},
		"Something held or dragged": {"felt": func(w: PackedFloat64Array) -> bool: return w[0] > 1.0},
		"A weight": {"felt": func(w: PackedFloat64Array) -> bool: return absf(w[1] + 1.5) < 0.05},
		"A steady push": {"felt": func(w: PackedFloat64Array) -> bool: return absf(w[0] - 0.8) < 0.03},
		"A spring to a place": {"felt": func(w: PackedFloat64Array) -> bool: return w[2] > 0.5},
		# 5 cm/s upwards: it pulls down by 6 N s/m.
		"Honey": {"speed": 0.05, "felt": func(w: PackedFloat64Array) -> bool: return absf(w[1] + 0.3) < 0.1},
		"A buzz": {"swings": true, "felt": func(w: PackedFloat64Array) -> bool: return w[0] > 0.3},
		# 2 mm past a valley: back into it.
		"Clicks of a slider": {"z": 0.002, "felt": func(w: PackedFloat64Array) -> bool: return w[2] < -0.05},
		"Ask before you request": {"felt": func(w: PackedFloat64Array) -> bool: return absf(w[1] - 1.0) < 0.05},
	}


func test_the_smallest_scene_is_felt() -> void:
	if await open_page(PAGE, SCENE):
		await physics_frames(40)
		check_near((await mean_felt(20))[1], 0.5, 0.02, "half a newton upward")
		await close_page()


func test_each_example_is_felt() -> void:
	var examples: Dictionary[String, Dictionary] = _examples()
	check_equal(blocks(PAGE).size(), examples.size() + 1, "every example has its check, every check its example")
	for heading: String in examples:
		var script: GDScript = compiled(PAGE, heading, AROUND)
		if script != null:
			await _is_felt(heading, script, examples[heading])


func _is_felt(heading: String, script: GDScript, wanted: Dictionary) -> void:
	scene = script.new()
	device = ideal_device()
	device.forces_enabled = true
	device.request_rejected.connect(func(message: String) -> void: check(false, "%s: %s" % [heading, message]))
	scene.set("device", device)
	scene.add_child(device)
	add(scene)
	var place := Vector3(0.0, wanted.get("y", 0.0), wanted.get("z", 0.0))
	var speed: float = wanted.get("speed", 0.0)
	var turned := Basis(Vector3.UP, wanted.get("turn", 0.0) as float)
	var sum: PackedFloat64Array = [0, 0, 0, 0, 0, 0, 0]
	var most: PackedFloat64Array = [0, 0, 0, 0, 0, 0, 0]
	for frame: int in FRAMES:
		var moved := Vector3(0.0, speed * (frame - FRAMES / 2) / 60.0, 0.0)
		device.set_simulated_hand_target(Transform3D(turned, place + moved), wanted.get("angle", 0.0))
		scene.call("example")
		await physics_frames(1)
		if frame >= FRAMES - MEASURED:
			var wrench: PackedFloat64Array = device.get_achieved_wrench()
			for dof: int in 7:
				sum[dof] += wrench[dof] / MEASURED
				most[dof] = maxf(most[dof], wrench[dof])
	var felt: Callable = wanted["felt"]
	var measured: PackedFloat64Array = most if wanted.get("swings", false) else sum
	check(felt.call(measured), "%s: felt %s" % [heading, measured])
	# Not refreshed any more, it ends: effects last for a second.
	device.set_simulated_hand_target(Transform3D.IDENTITY, 0.0)
	await physics_frames(90)
	check(not felt.call(device.get_achieved_wrench()), "%s: and ends: %s" % [heading, device.get_achieved_wrench()])
	scene.free()
