extends SceneTree
## Uses engine objects that live on, unloads the probe, loads and unloads it again, and quits. Whoever left something of
## the library with the engine crashes at the end, when the library is gone. Prints "unloaded N times". With a godot-cpp,
## only singletons are used: it ends no other wrappers.

const EXTENSION: String = "res://probe.gdextension"


func _initialize() -> void:
	var unloaded: int = 0
	for round: int in 3:
		if round > 0 and GDExtensionManager.load_extension(EXTENSION) != GDExtensionManager.LOAD_STATUS_OK:
			break
		_use()
		if GDExtensionManager.unload_extension(EXTENSION) != GDExtensionManager.LOAD_STATUS_OK:
			break
		if ClassDB.class_exists("Probe") or _is_mapped():
			break
		unloaded += 1
	print("unloaded %d times" % unloaded)
	quit(0)


## Wraps singletons, the root window and a node that outlives the library.
func _use() -> void:
	var stays: Node = Node.new()
	root.add_child(stays)
	var probe: Node = ClassDB.instantiate("Probe")
	root.add_child(probe)
	var facts: Dictionary = probe.call("engine_facts")
	if facts["os"] != OS.get_name():
		print("the probe does not work")
	if ClassDB.class_exists("ProbeFaults") and (probe.call("same", root) != root or probe.call("same", stays) != stays):
		print("objects do not come back")
	probe.free()


func _is_mapped() -> bool:
	var maps: FileAccess = FileAccess.open("/proc/self/maps", FileAccess.READ)
	var mapped: bool = false
	var lines: int = 0
	while maps != null and lines < 5000 and not maps.eof_reached():
		mapped = maps.get_line().contains("probe_library") or mapped
		lines += 1
	return mapped or lines < 10
