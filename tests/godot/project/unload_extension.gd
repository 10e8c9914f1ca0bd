## Uses a device and a hand, frees them, unloads the add-on as a plugin manager may, and goes on before it quits. The Python
## runner looks at the exit code: what the library left with the engine's own objects would end the program.
extends SceneTree

const EXTENSION: String = "res://addons/spidar_g/spidar_g.gdextension"
const FRAMES: int = 20

var _frames: int = 0


func _initialize() -> void:
	var device: Node = ClassDB.instantiate("SpidarG")
	device.set("forces_enabled", true)
	device.add_child(ClassDB.instantiate("SpidarGHand"))
	root.add_child(device)


func _process(_delta: float) -> bool:
	_frames += 1
	if _frames == FRAMES:
		root.get_child(0).free()
		if GDExtensionManager.unload_extension(EXTENSION) == GDExtensionManager.LOAD_STATUS_OK \
				and not ClassDB.class_exists("SpidarG"):
			print("goes on without the add-on")
	if _frames == 2 * FRAMES:
		quit(0)
	return false
