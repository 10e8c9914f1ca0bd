## A game that has nothing but the unpacked add-on: the extension loads and the simulated device moves and pulls.
extends SceneTree

const CYCLES: int = 3000
const TARGET: Vector3 = Vector3(0.03, -0.02, 0.01)
const NEAR_M: float = 0.01
const SLACK_N: float = 0.1


func _initialize() -> void:
	_run.call_deferred()


func _run() -> void:
	if not ClassDB.class_exists(&"SpidarG"):
		print("SMOKE failed: no class SpidarG")
		quit(1)
		return
	# By name: this script must be readable where the extension is refused.
	var device: Node3D = ClassDB.instantiate(&"SpidarG")
	device.set(&"drive_mode", 1) # stepped
	device.set(&"forces_enabled", true)
	root.add_child(device)
	await physics_frame
	device.call(&"set_simulated_hand_target", Transform3D(Basis.IDENTITY, TARGET), 0.2)
	device.call(&"advance_cycles", CYCLES)
	var grip: Transform3D = device.call(&"get_grip_transform")
	var tensions: PackedFloat64Array = device.call(&"get_string_tensions")
	var least: float = tensions[0]
	for tension: float in tensions:
		least = minf(least, tension)
	var good: bool = grip.origin.distance_to(TARGET) < NEAR_M and least > SLACK_N
	print("SMOKE %s: grip at %s, tensions %s N" % ["passed" if good else "failed", grip.origin, tensions])
	device.free()
	quit(0 if good else 1)
