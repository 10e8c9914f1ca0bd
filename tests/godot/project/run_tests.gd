## Runs every res://test_*.gd headless. Prints one line a test, "N passed, N failed" last. With the user argument
## --real-time it runs res://timed_*.gd instead: those need a game in real time, without --fixed-fps.
## A test that stops on a script error never returns from its await: the frame limit catches it, and the Python
## runner looks for SCRIPT ERROR. User argument: a part of the names to run.
extends SceneTree

const FRAME_LIMIT: int = 12000

var _done: bool = false


func _initialize() -> void:
	_run_all()


func _run_all() -> void:
	await process_frame
	if not ClassDB.class_exists("SpidarG"):
		printerr("The spidar_g library is not loaded: class SpidarG does not exist.")
		print("0 passed, 1 failed")
		quit(1)
		return
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	var prefix: String = "timed_" if arguments.has("--real-time") else "test_"
	var last: String = arguments[-1] if arguments.size() > 0 else ""
	var wanted: String = last if last != "--real-time" else ""
	var passed: int = 0
	var failed: int = 0
	var files: PackedStringArray = DirAccess.get_files_at("res://")
	files.sort()
	for file: String in files:
		if not (file.begins_with(prefix) and file.ends_with(".gd")) or file == "test_case.gd":
			continue
		var script: GDScript = load("res://" + file)
		if script == null or not script.can_instantiate():
			print("FAIL %s: does not compile" % file)
			failed += 1
			continue
		for method: Dictionary in script.get_script_method_list():
			var name: String = method["name"]
			var skipped: bool = wanted != "" and not (file + ":" + name).contains(wanted)
			if not name.begins_with("test_") or skipped:
				continue
			if await _run_one(script, file.get_basename(), name):
				passed += 1
			else:
				failed += 1
	print("%d passed, %d failed" % [passed, failed])
	quit(0 if failed == 0 and passed > 0 else 1)


func _run_one(script: GDScript, file: String, method: String) -> bool:
	print("RUN  %s:%s" % [file, method])
	var case: RefCounted = script.new()
	case.tree = self
	var nodes_before: Array[Node] = root.get_children()
	_done = false
	_call(case, method)
	var frames: int = 0
	while not _done and frames < FRAME_LIMIT:
		await process_frame
		frames += 1
	Engine.time_scale = 1.0
	Engine.physics_ticks_per_second = 60
	Engine.max_fps = 0
	var failures: PackedStringArray = case.failures
	if not _done:
		failures.append("did not finish within %d frames" % FRAME_LIMIT)
	if case.check_count == 0:
		failures.append("checked nothing")
	for node: Node in root.get_children():
		if not nodes_before.has(node):
			node.queue_free()
	await process_frame
	await process_frame
	for failure: String in failures:
		print("     %s" % failure)
	print("%s %s:%s (%d checks)" % ["FAIL" if failures.size() > 0 else "PASS", file, method, case.check_count])
	return failures.size() == 0


func _call(case: RefCounted, method: String) -> void:
	await case.call(method)
	_done = true
