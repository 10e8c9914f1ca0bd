extends SceneTree
## Runs every case of the listed scripts, one by one, and prints the totals as the last line. A case
## that stops at a script error counts as failed: its function never sets done.

const TestCase: GDScript = preload("res://test_case.gd")
const SCRIPTS: Array[String] = [
	"res://test_values.gd",
	"res://test_objects.gd",
	"res://test_hooks.gd",
	"res://test_signals.gd",
	"res://test_hardening.gd",
]
## Only with the in-tree binding.
const IN_TREE_SCRIPTS: Array[String] = ["res://test_misuse.gd"]

var passed: int = 0
var failed: int = 0


func _initialize() -> void:
	_run()


func _run() -> void:
	await process_frame
	var scripts: Array[String] = SCRIPTS.duplicate()
	if ClassDB.class_exists("ProbeFaults"):
		scripts.append_array(IN_TREE_SCRIPTS)
	for path: String in scripts:
		await _run_script(path)
	print("%d passed, %d failed" % [passed, failed])
	quit(1 if failed > 0 or passed == 0 else 0)


func _run_script(path: String) -> void:
	var script: GDScript = load(path)
	if script == null or not script.can_instantiate():
		print("FAIL %s: does not load" % path)
		failed += 1
		return
	for method: Dictionary in script.get_script_method_list():
		var name: String = method["name"]
		if not name.begins_with("test_"):
			continue
		var case: TestCase = script.new()
		case.tree = self
		var state: Dictionary = {"done": false}
		_run_case(case, name, state)
		for frame: int in 120:
			if state["done"]:
				break
			await process_frame
		var failures: PackedStringArray = case.failures
		if not state["done"]:
			failures.append("stopped before its end")
		elif case.checks == 0:
			failures.append("checked nothing")
		if failures.is_empty():
			passed += 1
		else:
			failed += 1
			for failure: String in failures:
				print("FAIL %s %s: %s" % [path.get_file(), name, failure])


func _run_case(case: TestCase, name: String, state: Dictionary) -> void:
	@warning_ignore("redundant_await")
	await case.call(name)
	state["done"] = true
