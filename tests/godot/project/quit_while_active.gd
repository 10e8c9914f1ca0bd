## Quits in the middle of things: three devices with forces on, one of them stepped, requests under way. The Python
## runner looks at the exit code and for leaks.
extends SceneTree

const FRAMES: int = 40

var _frames: int = 0


func _initialize() -> void:
	for index: int in 3:
		var device := SpidarG.new()
		device.drive_mode = SpidarG.DRIVE_STEPPED if index == 2 else SpidarG.DRIVE_THREADED
		device.forces_enabled = true
		root.add_child(device)


func _process(_delta: float) -> bool:
	_frames += 1
	for device: SpidarG in root.get_children():
		device.request_wrench(Vector3(0, 1, 0), Vector3.ZERO, 0.01)
	OS.delay_msec(2)
	if _frames == FRAMES:
		print("quits while active")
		quit(0)
	return false
